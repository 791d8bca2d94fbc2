"""Contacts are compared with labels frame by frame, pair by pair and for any body together."""

from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from motion_files import recordings_folder

from capar.evaluation.contacts import ContactCounts, compare_contacts, read_contact_arrays
from capar.evaluation.labels import Label, Labels
from capar.evaluation.metrics import report, summed
from capar.evaluation.plan import ContactArrays, read_plan
from capar.evaluation.running import evaluate
from capar.model.errors import CaparError
from capar.model.facts import Touching
from capar.model.geometry import runs

CLIPS = Path(__file__).parents[2] / "examples" / "omomo_intermimic" / "evaluation.toml"
RATE_HZ = 50.0
FRAMES = 40
BODIES = ("left_hand", "right_hand")

masks = st.lists(st.booleans(), min_size=FRAMES, max_size=FRAMES).map(np.array)
hands = st.tuples(masks, masks)


def clock(start_s: float = 0.0) -> np.ndarray:
    return start_s + np.arange(FRAMES) / RATE_HZ


def labels(per_body: tuple[np.ndarray, ...], *, start_s: float = 0.0, sure: bool = True) -> Labels:
    marks = [
        Label(
            body, start_s + first / RATE_HZ, start_s + (last + 1) / RATE_HZ, "contact", "mug", sure
        )
        for body, mask in zip(BODIES, per_body, strict=True)
        for first, last in runs(mask)
    ]
    return Labels(Path("l.csv"), tuple(sorted(marks)), in_frames=False)


def facts(per_body: tuple[np.ndarray, ...]) -> list[Touching]:
    return [
        Touching(body, "mug", first, last)
        for body, mask in zip(BODIES, per_body, strict=True)
        for first, last in runs(mask)
    ]


PAIRS = tuple((body, "mug") for body in BODIES)


def counts(
    true: tuple[np.ndarray, ...], found: tuple[np.ndarray, ...], start_s: float = 0.0
) -> ContactCounts:
    marks = labels(true, start_s=start_s)
    return compare_contacts("take", marks, facts(found), clock(start_s), PAIRS).whole


@given(hands)
def test_labels_equal_to_what_was_found_score_100(true: tuple[np.ndarray, ...]) -> None:
    scores = counts(true, true).scores()
    assert scores["f1"] == (100.0 if np.logical_or(*true).any() else None)
    assert scores["onset_ms"]["median"] in {0.0, None}


@given(hands, hands)
def test_the_whole_is_whether_any_body_touches(
    true: tuple[np.ndarray, ...], found: tuple[np.ndarray, ...]
) -> None:
    one, other = np.logical_or(*true), np.logical_or(*found)
    got = counts(true, found)
    assert got.right == (one & other).sum()
    assert got.wrong == (other & ~one).sum()
    assert got.missed == (one & ~other).sum()
    assert got.right + got.wrong + got.missed + got.apart == FRAMES


@given(hands, hands, st.integers(0, 50))
def test_another_origin_of_time_changes_no_count(
    true: tuple[np.ndarray, ...], found: tuple[np.ndarray, ...], seconds: int
) -> None:
    here, there = counts(true, found), counts(true, found, float(seconds))
    assert (here.right, here.wrong, here.missed) == (there.right, there.wrong, there.missed)
    assert np.allclose(here.onsets_s, there.onsets_s)


@given(st.lists(st.tuples(hands, hands), min_size=1, max_size=4))
def test_pooled_scores_are_those_of_all_frames_together(takes: list) -> None:
    every = [counts(true, found) for true, found in takes]
    right = sum(each.right for each in every)
    wrong = sum(each.wrong + each.missed for each in every)
    f1 = summed(every).scores()["f1"]
    assert f1 == (None if right + wrong == 0 else round(100 * 2 * right / (2 * right + wrong), 2))


@given(hands, hands)
def test_what_the_labels_leave_open_counts_neither_way(
    true: tuple[np.ndarray, ...], found: tuple[np.ndarray, ...]
) -> None:
    everything = tuple(np.ones(FRAMES, dtype=bool) for _ in BODIES)
    marks = labels(everything, sure=False)
    got = compare_contacts("take", marks, facts(found), clock(), PAIRS).whole
    assert (got.right, got.wrong, got.missed, got.apart) == (0, 0, 0, 0)


def test_labels_of_one_hand_count_that_hand_alone() -> None:
    both = facts((np.arange(FRAMES) < 10, np.arange(FRAMES) >= 20))
    mark = Label("right_hand", 0.4, 0.8, "contact", "mug")
    scored = compare_contacts(
        "take", Labels(Path("l.csv"), (mark,), in_frames=False), both, clock()
    )
    assert set(scored.parts) == {"right_hand"}
    assert scored.whole.scores()["f1"] == 100.0


def arrays(folder: Path, values: np.ndarray) -> Path:
    path = folder / "clip.npz"
    np.savez(path, contact=values, names=np.array(["L_Hand", "R_Hand"]))
    return path


ENTRY = ContactArrays(labels="contact", bodies="names", other="{object}", open=-1)


def test_arrays_of_contact_become_intervals_with_the_names_of_sensors(tmp_path: Path) -> None:
    values = np.array([[0, -1], [1, -1], [1, 1]])
    read, pairs = read_contact_arrays(
        arrays(tmp_path, values), ENTRY, {"object": "mug"}, np.array([0.0, 0.1, 0.2])
    )
    spans = [
        (each.link, round(each.start, 3), round(each.end, 3), each.sure) for each in read.marks
    ]
    assert spans == [
        ("l_hand", 0.1, 0.3, True),
        ("r_hand", 0.0, 0.2, False),
        ("r_hand", 0.2, 0.3, True),
    ]
    assert pairs == (("l_hand", "mug"), ("r_hand", "mug"))


def test_arrays_of_another_length_are_refused(tmp_path: Path) -> None:
    path = arrays(tmp_path, np.zeros((5, 2)))
    with pytest.raises(CaparError, match=r"has the shape \(5, 2\)\. For 3 frames and 2 bodies"):
        read_contact_arrays(path, ENTRY, {"object": "mug"}, np.array([0.0, 0.1, 0.2]))


def test_an_array_that_is_not_there_lists_those_that_are(tmp_path: Path) -> None:
    path = arrays(tmp_path, np.zeros((3, 2)))
    entry = ENTRY.model_copy(update={"labels": "contacts"})
    with pytest.raises(CaparError, match="no array 'contacts'; there are: contact, names"):
        read_contact_arrays(path, entry, {}, np.array([0.0, 0.1, 0.2]))


def test_bodies_touch_a_carried_table_when_the_labels_say_so(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """Two of the sixteen clips that the evaluation file beside the example scores."""
    monkeypatch.setenv("CAPAR_DATA", str(recordings_folder()))
    plan = read_plan(CLIPS, takes=["sub2_largetable_00[01]"])
    found = report(evaluate(plan))
    assert found["all"]["f1"] >= 97.0
    assert found["all"]["onset_ms"]["median"] <= 1000 * 2 / 30
    assert len(found["bodies"]) == 52
