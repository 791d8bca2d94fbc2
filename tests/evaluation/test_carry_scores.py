"""Printed carries are compared with labelled ones, by each end and both."""

from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from measured_bodies import pick_and_place
from motion_files import recordings_folder
from observations import drink_from_mug

from capar.evaluation.labels import Label, Labels
from capar.evaluation.metrics import Interval, report, summed
from capar.evaluation.objects import (
    CarryCounts,
    CarryEnds,
    carry_captures,
    compare_carries,
    printed_carries,
)
from capar.evaluation.plan import CarryOptions, read_plan
from capar.evaluation.running import evaluate
from capar.model.capture import Capture
from capar.pipelines.observation import observe

EXAMPLE = Path(__file__).parents[2] / "examples" / "boxed_vr"
NAMES = ("MoveObj", "MoveObjTo")


def labels(thing: str, *spans: tuple[float, float]) -> Labels:
    marks = tuple(Label("", start, end, "carry", thing) for start, end in spans)
    return Labels(Path("l.csv"), marks, in_frames=False)


@pytest.fixture(scope="module")
def placed() -> tuple[Capture, str]:
    capture = pick_and_place()
    (thing,) = [each.name for each in capture.objects if each.tag == "mobile"]
    return capture, thing


def test_a_carry_lasts_from_the_first_moving_segment_to_the_last_of_one_run() -> None:
    """Out of the mug's moves to the mouth and back, with a sip between, one carry is made."""
    seen = drink_from_mug()
    moves = [each for each in seen.segments if {each.name, *each.general} & set(NAMES)]
    assert len(moves) > 1
    assert printed_carries(seen.segments, NAMES) == (
        Interval(moves[0].start_s, moves[-1].end_s, "carry"),
    )


def test_segments_that_carry_nothing_make_no_carry() -> None:
    assert printed_carries(drink_from_mug().segments, ["Throw"]) == ()


def test_labels_at_the_printed_ends_are_found_at_both(placed: tuple[Capture, str]) -> None:
    capture, thing = placed
    seen = observe(capture)
    own = [each for each in seen.segments if each.objects[:1] == (thing,)]
    (carry,) = printed_carries(own, NAMES)
    for late_s, share in ((0.0, 100.0), (0.09, 100.0), (0.11, 0.0)):
        marks = labels(thing, (carry.start_s - late_s, carry.end_s + late_s))
        scores = compare_carries("take", marks, seen, capture, CarryOptions()).whole.scores()
        assert (scores["start"], scores["end"], scores["both"]) == (share, share, share)
        assert scores["start_ms"]["bias"] == pytest.approx(1000 * late_s, abs=0.01)
        assert scores["end_ms"]["bias"] == pytest.approx(-1000 * late_s, abs=0.01)


def test_what_does_not_move_in_its_carry_is_excluded_and_counted(
    placed: tuple[Capture, str],
) -> None:
    capture, thing = placed
    seen = observe(capture)
    scores = compare_carries(
        "take", labels(thing, (0.0, 0.05)), seen, capture, CarryOptions()
    ).whole.scores()
    assert (scores["carries"], scores["excluded"], scores["counted"]) == (1, 1, 0)
    assert scores["both"] is None
    assert scores["extra"] == 1


errors = st.floats(-1.0, 1.0).map(lambda each: round(each, 3))
ends = st.builds(CarryEnds, errors, errors, st.booleans(), st.booleans())


@given(st.lists(ends, min_size=1, max_size=30), st.integers(1, 5))
def test_pooled_shares_are_those_of_all_carries_together(
    carries: list[CarryEnds], parts: int
) -> None:
    pieces = [CarryCounts(0.1, tuple(carries[part::parts])) for part in range(parts)]
    moved = [each for each in carries if each.moved]
    both = [max(abs(each.start_error_s), abs(each.end_error_s)) <= 0.1 for each in moved]
    scores = summed(pieces).scores()
    assert scores["both"] == (round(100.0 * sum(both) / len(both), 2) if both else None)
    assert scores["excluded"] == len(carries) - len(moved)
    if moved:
        assert scores["both"] <= min(scores["start"], scores["end"])


def test_where_samples_begin_and_end_tells_nothing(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Before and after its recorded poses an object rests for two seconds, with the hand at it."""
    monkeypatch.setenv("CAPAR_DATA", str(recordings_folder()))
    options = read_plan(EXAMPLE / "evaluation.toml", takes=["p64_s1"]).carries
    found = list(carry_captures(f"{EXAMPLE / 'scenes.toml'}:p64_s1", options))
    assert len(found) == 18
    for each in found:
        thing = each.capture.tag_object(each.object).stream
        hand = each.capture.sensor("right_hand").stream
        assert each.start_s == 2.0
        assert each.capture.times[-1] == pytest.approx(each.end_s + 2.0, abs=0.03)
        assert not thing.lost.any()
        assert np.array_equal(thing.positions, hand.positions)
        rests = thing.times < each.start_s
        assert np.ptp(thing.positions[rests], axis=0).max() == 0.0


def test_a_scene_is_scored_by_its_printed_segments(monkeypatch: pytest.MonkeyPatch) -> None:
    """The floor is 80 % of both ends over all scenes; it is missed, so none is claimed here."""
    monkeypatch.setenv("CAPAR_DATA", str(recordings_folder()))
    found = report(evaluate(read_plan(EXAMPLE / "evaluation.toml", takes=["p64_s1"])))
    everything = found["all"]
    assert everything["carries"] == 18
    assert everything["start_ms"]["matched"] == everything["counted"]
    assert everything["start_ms"]["median"] <= 200.0
    assert everything["end_ms"]["median"] <= 200.0
