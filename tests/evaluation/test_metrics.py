"""Scores are those of temporal action segmentation, proven on cases counted by hand."""

from collections import Counter

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from capar.evaluation.metrics import (
    THRESHOLDS,
    Interval,
    accuracy,
    edit_score,
    frame_f1,
    frame_labels,
    merged,
    segment_f1,
    summed,
    tally,
)


def line(*parts: tuple[str, float]) -> list[Interval]:
    """Intervals one after the other from labels and lengths [s]."""
    out, now = [], 0.0
    for label, length in parts:
        out.append(Interval(now, now + length, label))
        now += length
    return out


TIMES = np.arange(10) + 0.5
TRUE = line(("a", 4.0), ("b", 4.0), ("c", 2.0))
GUESS = line(("a", 5.0), ("b", 2.0), ("a", 1.0), ("c", 2.0))
"""Of ten frames eight are right; at 4.5 and at 7.5 a stands where b is true."""


def test_the_hand_counted_frames() -> None:
    found = tally(TRUE, GUESS, TIMES)
    assert found.confusion == Counter({("a", "a"): 4, ("b", "a"): 2, ("b", "b"): 2, ("c", "c"): 2})
    assert accuracy(found.confusion) == pytest.approx(80.0)
    classes = frame_f1(found.confusion)
    assert classes == {
        "a": pytest.approx(100 * 2 * 4 / (4 + 6)),
        "b": pytest.approx(100 * 2 * 2 / (4 + 2)),
        "c": pytest.approx(100.0),
    }


def test_the_hand_counted_segments() -> None:
    found = tally(TRUE, GUESS, TIMES)
    # a: 4 / 5 = 0.8; b: 2 / 4 = 0.5; the second a meets no a (a false positive); c: 1.
    assert found.hits == Counter({10: 3, 25: 3, 50: 3})
    assert (found.true, found.predicted) == (3, 4)
    assert segment_f1(found, 50) == pytest.approx(100 * 2 * 3 / 7)
    assert found.inserted == Counter({"a": 1})
    assert found.missed == Counter()
    assert found.onsets_s == pytest.approx((0.0, 1.0, 0.0))
    assert found.offsets_s == pytest.approx((1.0, -1.0, 0.0))


def test_the_hand_counted_edit_score() -> None:
    # a b c against a b a c: one deletion, the longer has four.
    assert tally(TRUE, GUESS, TIMES).edits == (pytest.approx(75.0),)
    assert edit_score("kitten", "sitting") == pytest.approx(100 * (1 - 3 / 7))
    assert edit_score("", "abc") == 0.0
    assert edit_score("", "") == 100.0


def test_neighbours_of_one_label_are_one_segment() -> None:
    cut = line(("a", 1.0), ("a", 2.0), ("b", 1.0), ("a", 1.0))
    assert merged(cut) == (
        Interval(0.0, 3.0, "a"),
        Interval(3.0, 4.0, "b"),
        Interval(4.0, 5.0, "a"),
    )
    assert merged([Interval(0.0, 1.0, "a"), Interval(2.0, 3.0, "a")]) == (
        Interval(0.0, 1.0, "a"),
        Interval(2.0, 3.0, "a"),
    )


def test_intervals_are_half_open_but_the_last_frame_closes_the_last() -> None:
    times = np.array([0.0, 1.0, 2.0])
    assert frame_labels(line(("a", 1.0), ("b", 1.0)), times) == ("a", "b", "b")


parts = st.lists(
    st.tuples(st.sampled_from("abcd"), st.integers(1, 20).map(float)), min_size=1, max_size=8
)


@given(parts)
def test_a_perfect_prediction_scores_100_everywhere(given_parts: list[tuple[str, float]]) -> None:
    true = line(*given_parts)
    found = tally(true, true, np.arange(0.0, true[-1].end_s, 0.5))
    assert accuracy(found.confusion) == 100.0
    assert set(frame_f1(found.confusion).values()) == {100.0}
    assert [segment_f1(found, each) for each in THRESHOLDS] == [100.0] * 3
    assert found.edits == (100.0,)
    assert set(found.onsets_s + found.offsets_s) == {0.0}
    assert not found.missed
    assert not found.inserted


@given(parts, parts)
def test_scores_are_percentages_and_f1_falls_with_the_threshold(
    one: list[tuple[str, float]], other: list[tuple[str, float]]
) -> None:
    found = tally(line(*one), line(*other), np.arange(0.5, 160.0))
    values = [segment_f1(found, each) for each in THRESHOLDS]
    assert values == sorted(values, reverse=True)
    for value in [*values, *found.edits, accuracy(found.confusion)]:
        assert 0.0 <= value <= 100.0


@given(st.lists(st.tuples(parts, parts), min_size=1, max_size=4))
def test_pooling_adds_counts_and_does_not_depend_on_order(
    cases: list[tuple[list[tuple[str, float]], list[tuple[str, float]]]],
) -> None:
    times = np.arange(0.5, 160.0)
    tallies = [tally(line(*one), line(*other), times) for one, other in cases]
    whole, turned = summed(tallies), summed(reversed(tallies))
    assert whole.confusion == turned.confusion
    assert whole.hits == turned.hits
    assert sorted(whole.edits) == sorted(turned.edits)
    assert whole.true == sum(each.true for each in tallies)
    assert whole.confusion.total() == sum(each.confusion.total() for each in tallies)
