"""Flicker is resolved in bounded windows: parts resolved by themselves agree with the whole."""

from dataclasses import replace

import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from capar.model.facts import Fact, FlickerCorrection, Frames, Link, RateMhz, Resting, Tag, Touching
from capar_rules.borders.deflicker import steady
from capar_rules.borders.ticks import times

RATE_HZ = 20
FLICKER = 3
"""Frames of 150 ms at 20 Hz."""

WINDOW = times().flicker_window_ms * RATE_HZ // 1000
LAST = 3 * WINDOW
SCENE = (
    RateMhz(RATE_HZ * 1000),
    Link("hand", "hand", "right"),
    Tag("mug", "mobile"),
    Tag("jar", "mobile"),
)

Interval = Touching | Resting


def doubts(facts: tuple[Fact, ...]) -> set[Fact]:
    return {each for each in steady(facts) if isinstance(each, FlickerCorrection)}


def scene(intervals: list[Interval], first: int, last: int) -> tuple[Fact, ...]:
    """What was measured from the first to the last frame of a longer capture."""
    cut = [
        replace(each, first=max(each.first, first), last=min(each.last, last))
        for each in intervals
        if each.first <= last and each.last >= first
    ]
    return (Frames(first, last), *SCENE, *cut)


def changes(intervals: list[Interval]) -> set[int]:
    return {frame for each in intervals for frame in (each.first, each.last + 1)}


@st.composite
def courses(draw: st.DrawFn) -> list[Interval]:
    """Contacts and rest of a hand that flicker, with longer stretches between."""
    found: list[Interval] = []
    for name in ("mug", "jar", "hand"):
        frame = draw(st.integers(0, 9))
        for _ in range(draw(st.integers(1, 9))):
            length = draw(st.integers(1, 2 * FLICKER))
            last = frame + length - 1
            rest = name == "hand"
            found.append(
                Resting("hand", frame, last) if rest else Touching("hand", name, frame, last)
            )
            frame += length + draw(st.sampled_from([1, 2, 2, FLICKER, 4 * FLICKER]))
    return found


@settings(max_examples=60, deadline=None)
@given(intervals=courses(), data=st.data())
def test_where_nothing_changes_for_two_flickers_both_sides_are_resolved_alone(
    intervals: list[Interval], data: st.DataObject
) -> None:
    end = max(changes(intervals)) + 2 * FLICKER
    cuts = [
        frame
        for frame in range(FLICKER, end - FLICKER)
        if not changes(intervals) & set(range(frame - FLICKER + 1, frame + FLICKER + 1))
    ]
    assume(cuts)
    cut = data.draw(st.sampled_from(cuts))
    parts = doubts(scene(intervals, 0, cut)) | doubts(scene(intervals, cut + 1, end))
    assert parts == doubts(scene(intervals, 0, end))


def chatter(draw_lengths: list[int]) -> list[Interval]:
    """A contact that is lost and found every few frames, throughout."""
    found: list[Interval] = []
    frame = FLICKER
    while frame < LAST - 4 * FLICKER:
        length, gap = (draw_lengths[(len(found) + shift) % len(draw_lengths)] for shift in (0, 1))
        found.append(Touching("hand", "mug", frame, frame + length - 1))
        frame += length + gap
    return found


@settings(max_examples=8, deadline=None)
@given(lengths=st.lists(st.integers(1, FLICKER - 1), min_size=1, max_size=6))
def test_flicker_that_never_ends_is_resolved_a_window_at_a_time(lengths: list[int]) -> None:
    """What comes after a window and two flickers does not change what is doubted in it."""
    intervals = chatter(lengths)
    whole = doubts(scene(intervals, 0, LAST))
    for windows in (1, 2):
        end = windows * WINDOW + FLICKER
        seen = doubts(scene(intervals, 0, end + 2 * FLICKER))
        assert {each for each in seen if last(each) < end} == {
            each for each in whole if last(each) < end
        }


def last(fact: Fact) -> int:
    assert isinstance(fact, FlickerCorrection)
    return fact.last


@pytest.mark.parametrize("windows", [1, 2])
def test_what_holds_at_the_end_of_a_window_is_believed(windows: int) -> None:
    intervals = chatter([1])
    end = intervals[0].first + windows * WINDOW - 1
    found = [
        each for each in doubts(scene(intervals, 0, LAST)) if isinstance(each, FlickerCorrection)
    ]
    assert [each for each in found if each.first <= end <= each.last] == []
    assert found, "the rest of the flicker is resolved"
