"""Recordings that others made: reach, hold, carry and return; touches; contacts as labelled."""

import tomllib
from collections.abc import Iterable
from itertools import pairwise
from pathlib import Path
from statistics import median

import numpy as np
import pytest
from combinations import EVERY
from motion_files import recordings_folder
from observed import observed
from scipy.signal import find_peaks

from capar.model.capture import Stream
from capar.model.facts import Moving, Touching
from capar.model.observation import Observation, Segment
from extractors.measure import measure
from extractors.readers.bundle.capture_toml import read_capture, takes

pytestmark = pytest.mark.long

EXAMPLES = Path(__file__).parents[1] / "examples"
MOVES = {"MoveObj", "MoveObjTo"}


@pytest.fixture
def recordings(monkeypatch: pytest.MonkeyPatch) -> Path:
    folder = recordings_folder()
    monkeypatch.setenv("CAPAR_DATA", str(folder))
    return folder


def is_a(segment: Segment, *names: str) -> bool:
    return bool({segment.name, *segment.general} & set(names))


def lies_from_s(stream: Stream) -> float:
    """From when on an object is within 2 mm of where it lies in the end [s]."""
    last = np.nanmedian(stream.positions[-100:], axis=0)
    away = np.linalg.norm(stream.positions - last, axis=1) > 0.002
    return float(stream.times[np.flatnonzero(away)[-1] + 1])


def test_a_box_is_reached_held_moved_to_a_shelf_and_left(
    recordings: Path, tmp_path_factory: pytest.TempPathFactory
) -> None:
    """It starts at about 1.6 s; table and shelf are assumed."""
    capture = read_capture(EXAMPLES / "pyomeca_box_lift")
    observation = observed(EXAMPLES / "pyomeca_box_lift", tmp_path_factory)
    (link,) = observation.links
    moves = [each for each in link.segments if is_a(each, *MOVES)]
    before = [each for each in link.segments if each.last <= moves[0].first]
    after = [each for each in link.segments if each.first >= moves[-1].last]
    assert is_a(before[-2], "Reach")
    assert is_a(before[-1], "Touch")
    assert is_a(after[-1], "ResumePosture")
    assert all(one.last == two.first for one, two in pairwise(moves))
    assert any(each.name == "MoveObjTo" or "MoveObjTo" in each.general for each in moves)
    assert moves[0].start_s == pytest.approx(1.6, abs=0.15)
    assert moves[-1].end_s == pytest.approx(lies_from_s(capture.tag_object("box").stream), abs=0.1)
    assert {each.name for each in observation.objects if each.assumed} == {"table", "shelf"}
    assert sum(each.code == "assumed-support" for each in observation.notices) == 2


def test_one_watched_hand_alone_is_not_both(
    recordings: Path, tmp_path_factory: pytest.TempPathFactory
) -> None:
    """The crate is lifted with two hands, of which one carries markers: nothing is made up."""
    assert observed(EXAMPLES / "pyomeca_box_lift", tmp_path_factory).joint == ()


def test_a_large_table_is_lifted_and_put_down_with_both_hands(
    recordings: Path, tmp_path_factory: pytest.TempPathFactory
) -> None:
    """Both hands hold it from its first motion to its last, as it goes up and comes down."""
    place = EXAMPLES / "omomo_intermimic" / "hands.toml:sub2_largetable_008"
    observation = observed(place, tmp_path_factory)
    (moving,) = [each for each in observation.facts if isinstance(each, Moving)]
    joint = [each for each in observation.joint if each.first < moving.last > moving.first]
    assert {observation.who(each) for each in joint} == {"both hands"}
    assert all(one.last == two.first for one, two in pairwise(joint))
    assert joint[0].first <= moving.first + 2
    assert joint[-1].last >= moving.last - 2
    names = [each.name for each in joint]
    assert names.index("Lift") < names.index("Lower")


def test_a_soft_pillow_is_touched_at_each_descent_and_never_moves(
    recordings: Path, tmp_path_factory: pytest.TempPathFactory
) -> None:
    """Twenty minima of the hand's height deeper than 5 cm, and one more descent at the very end."""
    capture = read_capture(EXAMPLES / "hand_embodiment_pillow")
    (hand,) = capture.sensors
    height = hand.stream.positions[:, 2]
    minima, _ = find_peaks(-height, prominence=0.05)
    observation = observed(EXAMPLES / "hand_embodiment_pillow", tmp_path_factory)
    touches = [each for each in observation.segments if is_a(each, "Touch")]
    assert len(minima) == 20
    for minimum in capture.times[minima]:
        near = [each for each in touches if each.start_s - 0.3 <= minimum <= each.end_s + 0.3]
        assert len(near) == 1
    during = [any(each.first <= minimum <= each.last for minimum in minima) for each in touches]
    assert during == [True] * 20 + [False]
    assert touches[-1].last == observation.frames - 1
    assert not [each for each in observation.facts if isinstance(each, Moving)]


def test_bodies_touch_when_the_labels_say_so(recordings: Path) -> None:
    """Pooled over clips: F1 of "any body touches the object", and onsets and offsets.

    Every third of the 16 clips of tables and chairs; `CAPAR_SCENES=all` takes each, and so does
    `capar evaluate examples/omomo_intermimic/evaluation.toml`.
    """
    right, wrong, missed = 0, 0, 0
    onsets: list[int] = []
    offsets: list[int] = []
    for take in list(takes(EXAMPLES / "omomo_intermimic"))[:: 1 if EVERY else 3]:
        labels, touched = _labels_and_touches(recordings, take)
        counted = labels >= 0
        known, true = counted.any(axis=1), (labels == 1).any(axis=1)
        seen = (touched & counted).any(axis=1)
        right += int((seen & true & known).sum())
        wrong += int((seen & ~true & known).sum())
        missed += int((~seen & true & known).sum())
        onsets += _nearest(_edges(true, 1), _edges(seen, 1))
        offsets += _nearest(_edges(true, -1), _edges(seen, -1))
    assert 2 * right / (2 * right + wrong + missed) >= 0.95
    assert median(onsets) <= 2
    assert median(offsets) <= 2


@pytest.mark.parametrize("take", ["take0", "take5"])
def test_both_hands_of_a_cook_are_observed(
    recordings: Path, take: str, tmp_path_factory: pytest.TempPathFactory
) -> None:
    observation = observed(f"{EXAMPLES / 'bimacs_optitrack'}:{take}", tmp_path_factory)
    names = _names(observation)
    assert set(names) == {"right_hand", "left_hand"}
    for segments in names.values():
        assert "Reach" in segments
        assert MOVES & set(segments)


def _names(observation: Observation) -> dict[str, set[str]]:
    return {
        link.ee: {name for each in link.segments for name in (each.name, *each.general)}
        for link in observation.links
    }


def _labels_and_touches(recordings: Path, take: str) -> tuple[np.ndarray, np.ndarray]:
    """Per frame and body: the label (-1 ignored), and whether a contact with the object is seen."""
    text = (EXAMPLES / "omomo_intermimic" / "capture.toml").read_text()
    (called,) = (entry["names"] for entry in tomllib.loads(text)["sensors_from"])
    with np.load(recordings / "omomo_intermimic" / "npz" / f"{take}.npz") as content:
        labels = content["contact_body"]
        names = [called.get(str(name), str(name)) for name in content["body_names"]]
        bodies = {name.lower(): index for index, name in enumerate(names)}
    touched = np.zeros(labels.shape, dtype=bool)
    thing = take.split("_")[1]
    capture = read_capture(f"{EXAMPLES / 'omomo_intermimic'}:{take}")
    assert {each.name.lower() for each in capture.sensors} == set(bodies)
    for fact in measure(capture).facts:
        if isinstance(fact, Touching) and fact.other == thing and fact.body.lower() in bodies:
            touched[fact.first : fact.last + 1, bodies[fact.body.lower()]] = True
    return labels, touched


def _edges(values: np.ndarray, step: int) -> Iterable[int]:
    return [int(each) for each in np.flatnonzero(np.diff(values.astype(int)) == step)]


def _nearest(wanted: Iterable[int], found: Iterable[int]) -> list[int]:
    """How far each wanted frame is from the nearest found one; a clip's length if there is none."""
    return [min((abs(each - other) for other in found), default=1000) for each in wanted]
