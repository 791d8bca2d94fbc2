"""Drafts of marker sets and skeletons make a person of them, with a floor, and no objects."""

import os
from pathlib import Path

import numpy as np
import pytest
from marker_people import walker, write_trc
from scipy.signal import find_peaks
from scipy.spatial.transform import Rotation

from capar.model.capture import Capture, TagType
from capar.model.observation import Observation
from capar.pipelines.observation import observe
from extractors.readers.bundle.capture_toml import read_capture
from extractors.readers.drafting.draft import EDIT, draft
from extractors.readers.registry import read_recording

DATA = Path(os.environ.get("CAPAR_DATA", Path(__file__).parents[4] / "shared" / "data"))
FOREIGN = DATA / "foreign_files"
recorded = pytest.mark.skipif(not FOREIGN.exists(), reason=f"no recordings at {FOREIGN}")

STEPS = {"Step", "Walk"}
NOBODY_DID = {"Kick", "HandOver", "Give", "Receive"}
SENSORS = {
    "cmu_walk.bvh": 5, "test3.bvh": 5, "propulsion.c3d": 3, "racing.c3d": 3, "sgi_int.c3d": 2,
    "dataWithNaNsOfDifferentCases.trc": 1, "gait10dof18musc_walk_CRLF_line_ending.trc": 5,
    "pyomeca.trc": 1, "std_walking2_markers.trc": 3, "walk_free_01.trc": 5,
}  # fmt: skip
"""How many hands, feet and heads have joints or three markers beside each other."""

WALKS = {
    "cmu_walk.bvh": (3, 3), "std_walking2_markers.trc": (2, 2), "walk_free_01.trc": (0, 1),
    "sgi_int.c3d": (2, 2),
}  # fmt: skip
"""Steps that the right and the left foot make at least: so often it comes down on the ground.

In ``walk_free_01.trc`` the right foot is still in the air at the end, where it goes forwards at
0.3 m/s over a belt that goes backwards at 1.1 m/s.
"""

TALL = ("cmu_walk.bvh", "test3.bvh", "walk_free_01.trc", "std_walking2_markers.trc")
WHEELS = """
[[object]]
name = "{side}_wheel"
kind = "wheel"
tag = "fixed"
position = [-0.75, {at}, 0.66]
orientation = [0.7071068, 0.7071068, 0.0, 0.0]
shape = {{ cylinder = [0.33, 0.05] }}
"""


def drafted(source: Path, folder: Path, more: str = "") -> tuple[str, Capture]:
    """The draft of a file as text, and as it reads back."""
    folder.mkdir(exist_ok=True)
    text = draft([read_recording(source)], folder, source.name.split(".")[0])
    (folder / "capture.toml").write_text(text + more)
    return text, read_capture(folder)


def steps_of(seen: Observation, foot: str) -> int:
    (link,) = [each for each in seen.links if each.ee == foot]
    return sum(each.name in STEPS for each in link.segments)


@pytest.mark.parametrize("prefix", ["", "Anna:"])
@pytest.mark.parametrize("up", ["z", "y"])
def test_plug_in_gait_is_drafted_as_a_person_who_walks_on_a_floor(
    tmp_path: Path, prefix: str, up: str
) -> None:
    turn = Rotation.identity() if up == "z" else Rotation.from_euler("x", -90.0, degrees=True)
    markers = {prefix + name: 1000.0 * turn.apply(at) for name, at in walker().items()}
    write_trc(tmp_path / "walk.trc", markers)
    text, capture = drafted(tmp_path / "walk.trc", tmp_path)
    assert f'up = "{up}"' in text
    assert EDIT not in text
    assert {each.name for each in capture.sensors} == {
        "right_hand", "left_hand", "right_foot", "left_foot", "head",
    }  # fmt: skip
    (floor,) = capture.objects
    assert (floor.name, floor.tag) == ("floor", TagType.FIXED)
    gaze = Rotation.from_quat(
        capture.sensor("head").stream.orientations[0], scalar_first=True
    ).apply(capture.sensor("head").gaze)
    assert gaze == pytest.approx([1.0, 0.0, 0.0], abs=0.02)
    seen = observe(capture)
    assert (steps_of(seen, "right_foot"), steps_of(seen, "left_foot")) == (2, 3)


def test_every_marker_is_accounted_for_and_only_other_things_are_objects(tmp_path: Path) -> None:
    markers = {f"Anna:{name}": 1000.0 * at for name, at in walker().items()}
    frames = len(markers["Anna:C7"])
    for number, place in enumerate([(0.0, 0.0), (80.0, 0.0), (0.0, 60.0)]):
        carried = markers["Anna:RFIN"] + [0.0, 0.0, 40.0 * number]
        markers[f"mug:{number}"] = carried + np.array([*place, 0.0])
    markers["Anna:LKneeAngles"] = np.zeros((frames, 3))
    markers["Anna:RTHI"] = np.full((frames, 3), np.nan)
    markers["*17"] = markers["Anna:C7"] + 50.0 * np.sin(np.arange(frames))[:, None]
    write_trc(tmp_path / "walk.trc", markers)
    text, capture = drafted(tmp_path / "walk.trc", tmp_path)
    assert {each.name: each.tag for each in capture.objects} == {
        "mug": TagType.MOBILE, "floor": TagType.FIXED,
    }  # fmt: skip
    for said, name in (
        ("computed quantities, no markers", "Anna:LKneeAngles"),
        ("never seen", "Anna:RTHI"),
        ("left out", "*17"),
    ):
        (line,) = [each for each in text.splitlines() if said in each]
        assert name in line
    for name in markers:
        assert name in text, name


def test_two_people_in_one_file_are_two_agents(tmp_path: Path) -> None:
    anna = {f"Anna:{name}": 1000.0 * at for name, at in walker().items()}
    bert = {
        f"Bert:{name}": 1000.0 * (at + np.array([0.0, 2.0, 0.0])) for name, at in walker().items()
    }
    write_trc(tmp_path / "walk.trc", anna | bert)
    _, capture = drafted(tmp_path / "walk.trc", tmp_path)
    assert [each.name for each in capture.agents] == ["anna", "bert"]
    assert {capture.agent_of(each) for each in capture.sensors} == {"anna", "bert"}
    assert len(capture.sensors) == 10


def test_a_unit_that_makes_no_person_is_doubted(tmp_path: Path) -> None:
    write_trc(tmp_path / "walk.trc", {name: at * 100.0 for name, at in walker().items()})
    text, _ = drafted(tmp_path / "walk.trc", tmp_path)
    (line,) = [each for each in text.splitlines() if EDIT in each]
    assert "the person is 0.17" in line
    assert "cm would make it 1.7" in line


@recorded
@pytest.mark.parametrize("file", SENSORS)
def test_a_recorded_file_is_drafted_as_a_person_of_a_persons_size(
    file: str, tmp_path: Path
) -> None:
    text, capture = drafted(FOREIGN / file, tmp_path / "drafted")
    assert len(capture.sensors) == SENSORS[file]
    assert not any(each.tag is TagType.MOBILE for each in capture.objects)
    assert text.count(EDIT) <= 2
    for name in read_recording(FOREIGN / file).names:
        assert name in text, name
    if file in TALL:
        head, foot = (capture.sensor(n).stream.positions for n in ("head", "right_foot"))
        assert 0.85 < float(np.nanmedian(head[:, 2] - foot[:, 2])) < 2.0


@recorded
@pytest.mark.parametrize("file", WALKS)
def test_recorded_walks_step_left_and_right_without_an_edit(file: str, tmp_path: Path) -> None:
    _, capture = drafted(FOREIGN / file, tmp_path / "drafted")
    seen = observe(capture)
    for foot, steps in zip(("right_foot", "left_foot"), WALKS[file], strict=True):
        assert steps_of(seen, foot) >= steps
        (link,) = [each for each in seen.links if each.ee == foot]
        assert any(each.name == "Stand" for each in link.segments)
    assert not {each.name for each in seen.segments} & NOBODY_DID


@recorded
def test_on_a_treadmill_a_foot_that_swings_low_does_not_stand_and_the_belt_is_said(
    tmp_path: Path,
) -> None:
    _, capture = drafted(FOREIGN / "walk_free_01.trc", tmp_path / "drafted")
    seen = observe(capture)
    (belt,) = [each for each in seen.notices if each.code == "moving-ground"]
    assert belt.bodies == ("floor",)
    assert belt["speed_mps"] == pytest.approx(1.13, abs=0.03)
    (right,) = [each for each in seen.links if each.ee == "right_foot"]
    stands = [each for each in right.segments if each.name == "Stand"]
    assert [each.start_s for each in stands] == [0.0]
    assert stands[0].end_s == pytest.approx(0.75, abs=0.05)


@recorded
def test_who_stands_is_observed_to_stand(tmp_path: Path) -> None:
    _, capture = drafted(FOREIGN / "test3.bvh", tmp_path / "drafted")
    feet = {
        each.ee: [one.name for one in each.segments]
        for each in observe(capture).links
        if each.ee.endswith("foot")
    }
    assert feet == {"right_foot": ["Stand"], "left_foot": ["Stand"]}


@recorded
@pytest.mark.parametrize("file", ["propulsion.c3d", "racing.c3d"])
def test_with_two_wheels_added_every_stroke_of_a_wheelchair_is_counted(
    file: str, tmp_path: Path
) -> None:
    wheels = WHEELS.format(side="right", at=-0.11) + WHEELS.format(side="left", at=0.475)
    _, capture = drafted(FOREIGN / file, tmp_path / "drafted", wheels)
    seen = observe(capture)
    for side in ("right", "left"):
        heights = capture.sensor(f"{side}_hand").stream.positions[:, 2]
        seen_at = ~np.isnan(heights)
        whole = np.interp(capture.times, capture.times[seen_at], heights[seen_at])
        lowest, _ = find_peaks(-whole, prominence=0.3)
        (link,) = [each for each in seen.links if each.ee == f"{side}_hand"]
        # The slower ones, under a metre a second towards the wheel, are no blows.
        strokes = [each for each in link.segments if each.name in ("Hit", "Reach")]
        assert {each.objects for each in strokes} == {(f"{side}_wheel",)}
        assert len(strokes) == len(lowest) == 18
