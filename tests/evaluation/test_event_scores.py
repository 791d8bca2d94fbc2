"""What was seen is paired with what was found: of one event and hand, near in time, each once."""

from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from measured_bodies import pick_and_place
from motion_files import recordings_folder

from capar.evaluation.events import Event, EventCounts, compare_events
from capar.evaluation.labels import Label, Labels
from capar.evaluation.metrics import report
from capar.evaluation.plan import read_plan
from capar.evaluation.running import evaluate

EXAMPLES = Path(__file__).parents[2] / "examples"


def seen(start_s: float, end_s: float, *, sure: bool = True, other: str = "") -> Label:
    return Label("right_hand", start_s, end_s, "regrasp", other, sure)


def found(start_s: float, end_s: float, hand: str = "right_hand", *others: str) -> Event:
    return Event(start_s, end_s, "regrasp", hand, others)


def compared(marks: list[Label], events: list[Event]) -> EventCounts:
    labels = Labels(Path("l.csv"), tuple(marks), in_frames=False)
    whole = compare_events("take", labels, events, pick_and_place(), watched=["regrasp"]).whole
    assert isinstance(whole, EventCounts)
    return whole


def test_each_is_paired_once_and_with_the_nearest() -> None:
    marks = [seen(1.0, 1.5), seen(2.0, 2.5), seen(8.0, 8.5, sure=False)]
    events = [found(1.7, 2.3), found(5.0, 5.2), found(8.1, 8.2), found(2.1, 2.2, "left_hand")]
    got = compared(marks, events)
    assert (got.seen, got.found, got.open, got.extra) == (2, 1, 1, 2)


def test_an_event_with_another_object_is_none() -> None:
    assert (
        compared([seen(1.0, 1.5, other="mug")], [found(1.0, 1.5, "right_hand", "cup")]).found == 0
    )
    assert (
        compared([seen(1.0, 1.5, other="mug")], [found(1.0, 1.5, "right_hand", "mug")]).found == 1
    )


# Eighths of a second, which no sum rounds.
spans = st.lists(
    st.tuples(st.integers(0, 400), st.integers(0, 20)).map(
        lambda each: (each[0] / 8, (each[0] + each[1]) / 8)
    ),
    max_size=8,
    unique=True,
)


@given(spans)
def test_what_was_seen_exactly_so_is_all_found(marks: list[tuple[float, float]]) -> None:
    got = compared([seen(*each) for each in marks], [found(*each) for each in marks])
    assert (got.found, got.extra) == (len(marks), 0)
    assert got.scores()["f1"] == (100.0 if marks else None)


@given(spans, spans, st.integers(0, 100))
def test_another_origin_of_time_changes_no_count(
    marks: list[tuple[float, float]], events: list[tuple[float, float]], shift: int
) -> None:
    def moved(by: int) -> EventCounts:
        return compared(
            [seen(one + by, two + by) for one, two in marks],
            [found(one + by, two + by) for one, two in events],
        )

    here, there = moved(0), moved(shift)
    assert here == there


@given(spans, spans)
def test_no_event_counts_twice(
    marks: list[tuple[float, float]], events: list[tuple[float, float]]
) -> None:
    got = compared([seen(*each) for each in marks], [found(*each) for each in events])
    assert got.found <= min(len(marks), len(events))
    assert got.found + got.open + got.extra == len(events)


def test_a_soft_pillow_is_touched_at_each_descent_and_never_moved(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """Twenty minima of the hand's height, and one more descent at the very end."""
    monkeypatch.setenv("CAPAR_DATA", str(recordings_folder()))
    plan = read_plan(EXAMPLES / "hand_embodiment_pillow" / "evaluation.toml")
    events = report(evaluate(plan))["events"]
    assert events["Touch"]["seen"] == events["Touch"]["found"] == 20
    assert [each["extra"] for each in events.values()] == [0, 0, 0]
    assert np.isfinite(events["Touch"]["away_ms"]["p95"])
