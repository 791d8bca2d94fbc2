"""Borders: numbered, shared, idle, and contacts that flicker."""

from collections.abc import Callable
from dataclasses import replace
from itertools import chain, combinations
from random import Random

import motions
import pytest
from flickering import flickering
from hypothesis import given, settings
from hypothesis import strategies as st

from capar.model.facts import (
    Fact,
    FlickerCorrection,
    Frames,
    Link,
    Moving,
    RateMhz,
    Resting,
    Tag,
    Touching,
    Travelled,
)
from capar_rules.borders.deflicker import steady
from capar_rules.borders.numbering import by_object, overlapping, shared, undisturbed
from capar_rules.borders.ticks import Meanwhile, Undisturbed, times
from capar_rules.engine.profiles import profile
from capar_rules.pars.inference import infer
from capar_rules.pars.pars import allen
from extractors.measure import measure

FLICKER = 15
"""Frames of 150 ms at 100 Hz: nobody lets go and takes again in less."""

SCENE = (Frames(0, 399), RateMhz(100000), Link("hand", "hand", "right"), Tag("mug", "mobile"))

Span = tuple[int, int]


def touches(*spans: Span, body: str = "hand", other: str = "mug") -> tuple[Fact, ...]:
    return tuple(Touching(body, other, *each) for each in spans)


def contacts(facts: tuple[Fact, ...], body: str = "hand", other: str = "mug") -> list[Span]:
    return [
        (each.first, each.last)
        for each in facts
        if isinstance(each, Touching) and (each.body, each.other) == (body, other)
    ]


def doubts(facts: tuple[Fact, ...]) -> list[FlickerCorrection]:
    return [each for each in facts if isinstance(each, FlickerCorrection)]


@pytest.mark.parametrize(
    ("spans", "left", "taken"),
    [
        (((50, 100), (111, 200)), [(50, 200)], "touching"),
        (((50, 100), (101 + FLICKER, 200)), [(50, 100), (101 + FLICKER, 200)], None),
        (((50, 54), (90, 94), (200, 300)), [(50, 54), (90, 94), (200, 300)], None),
        (((50, 51), (60, 62), (70, 200)), [(70, 200)], "apart"),
    ],
    ids=["short loss", "long loss", "lone contacts", "chatter before a grasp"],
)
def test_contact_that_flickers_is_resolved_and_other_contact_stays(
    spans: tuple[Span, ...], left: list[Span], taken: str | None
) -> None:
    found = steady((*SCENE, *touches(*spans)))
    assert contacts(found) == left
    assert {each.taken for each in doubts(found)} == ({taken} if taken else set())


@pytest.mark.parametrize(
    ("one", "other", "whole"),
    [
        (Moving("mug", 80, 120), Moving("mug", 125, 200), Moving("mug", 80, 200)),
        (Resting("hand", 0, 100), Resting("hand", 110, 300), Resting("hand", 0, 300)),
    ],
)
def test_motion_and_rest_that_are_lost_for_a_moment_go_on(one: Fact, other: Fact, whole: Fact):
    assert whole in steady((*SCENE, *touches((50, 300)), one, other))


def test_what_passes_from_one_thing_to_another_changes_once() -> None:
    """Each pair alone could as well begin earlier: over the whole link, one exchange explains."""
    first = touches((50, 100), (107, 112), other="mug")
    second = touches((101, 106), (113, 200), other="jar")
    found = steady((*SCENE, Tag("jar", "mobile"), *first, *second))
    (mug,), (jar,) = contacts(found), contacts(found, other="jar")
    assert mug[1] + 1 == jar[0]


@st.composite
def courses(draw: st.DrawFn) -> tuple[Fact, ...]:
    """Two contacts of a hand that chatter."""
    facts: list[Fact] = list(SCENE)
    for other in ("mug", "jar"):
        frame = draw(st.integers(0, 60))
        for _ in range(draw(st.integers(0, 4))):
            length = draw(st.integers(1, 25))
            facts.append(Touching("hand", other, frame, frame + length - 1))
            frame += length + draw(st.integers(1, 25))
    return tuple(facts)


def stretches(spans: list[Span]) -> list[tuple[int, int, int]]:
    found, free = [], 0
    for first, last in spans:
        found += [(0, free, first - 1)] * (first > free)
        found.append((1, first, last))
        free = last + 1
    return [*found, (0, free, 399)] if free < 400 else found


def cost(measured: dict[str, list[tuple[int, int, int]]], doubted: set[tuple[str, int]]) -> int:
    """Half a flicker for each frame in which something changes, and what is contradicted, twice."""
    changes, contradicted = set(), 0
    for name, course in measured.items():
        believed = [holds ^ ((name, place) in doubted) for place, (holds, *_) in enumerate(course)]
        changes |= {
            course[place][1]
            for place in range(1, len(course))
            if believed[place] != believed[place - 1]
        }
        contradicted += sum(
            last - first + 1
            for place, (_, first, last) in enumerate(course)
            if (name, place) in doubted
        )
    return FLICKER * len(changes) + 2 * contradicted


def may_be_doubted(course: list[tuple[int, int, int]], place: int) -> bool:
    def short(at: int) -> bool:
        return course[at][2] - course[at][1] + 1 < FLICKER

    inner = 0 < place < len(course) - 1
    return inner and short(place) and (not course[place][0] or short(place - 1) or short(place + 1))


@settings(max_examples=60, deadline=None)
@given(facts=courses())
def test_no_other_course_costs_less(facts: tuple[Fact, ...]) -> None:
    """Against every set of stretches that could be doubted."""
    measured = {name: stretches(contacts(facts, other=name)) for name in ("mug", "jar")}
    doubtful = [
        (name, place)
        for name, course in measured.items()
        for place in range(len(course))
        if may_be_doubted(course, place)
    ]
    chosen = {
        (name, place)
        for each in doubts(steady(facts))
        for name, course in measured.items()
        for place, (_, first, last) in enumerate(course)
        if (each.other, each.first, each.last) == (name, first, last)
    }
    subsets = chain.from_iterable(combinations(doubtful, size) for size in range(len(doubtful) + 1))
    assert cost(measured, chosen) == min(cost(measured, set(each)) for each in subsets)


@settings(max_examples=30, deadline=None)
@given(facts=courses(), random=st.randoms(use_true_random=False))
def test_the_measurements_can_be_told_again_and_their_order_does_not_matter(
    facts: tuple[Fact, ...], random: Random
) -> None:
    found = steady(facts)
    for name in ("mug", "jar"):
        frames = {
            frame for first, last in contacts(found, other=name) for frame in range(first, last + 1)
        }
        for each in doubts(found):
            if each.other == name:
                frames ^= set(range(each.first, each.last + 1))
        assert frames == {
            frame for first, last in contacts(facts, other=name) for frame in range(first, last + 1)
        }
    shuffled = list(facts)
    random.shuffle(shuffled)
    assert set(steady(shuffled)) == set(found)


@pytest.mark.parametrize("every_s", [0.21, 0.34, 0.55])
@pytest.mark.parametrize(
    "action",
    [motions.drink_from_mug, motions.touch_cycle, motions.pick_up_with_both_hands],
    ids=lambda each: each.__name__,
)
def test_lost_contact_does_not_change_the_steps(
    action: Callable[..., motions.Trial], every_s: float
) -> None:
    """Without the rules, the same losses cut every hold in pieces."""
    capture = action(motions.WOMAN).capture
    facts = measure(capture).facts
    lost = flickering(facts, capture.rate_hz, every_s=every_s)
    whole, mended, cut = (
        [[each.name for each in link.segments] for link in infer(each, profile=profile()).links]
        for each in (facts, steady(lost), lost)
    )
    assert mended == whole
    assert cut != whole


def test_what_a_hand_brushes_as_it_lets_go_does_not_change_the_name_of_its_hold() -> None:
    mug_on_box = touches((200, 399), body="mug", other="box")
    hold = (*SCENE, Tag("box", "mobile"), *touches((50, 300)), *mug_on_box, Moving("mug", 100, 180))
    brush = touches((305, 330), other="box")
    (alone,), (beside,) = (infer((*hold, *more), profile=profile()).links for more in ((), brush))
    names = [each.name for each in alone.segments]
    assert names == ["Reach", "Touch", "MoveObj", "Touch", "TouchWith", "ResumePosture"]
    assert [each.name for each in beside.segments] == [*names[:5], "Withdraw", names[5]]
    assert beside.segments[4].features == alone.segments[4].features


@pytest.mark.parametrize(("further_mm", "step"), [(3, "TouchWith"), (30, "MoveObj")])
def test_what_settles_while_it_is_let_go_is_not_moved_once_more(further_mm: int, step: str) -> None:
    ways = {50: 0, 100: 5, 280: 600, 320: 600 + further_mm}
    (link,) = infer(
        (*SCENE, Tag("shelf", "mobile"), *touches((50, 320)), Moving("mug", 100, 330),
         *touches((280, 399), body="mug", other="shelf"),
         *(Travelled("mug", frame, way, 0) for frame, way in ways.items())),
        profile=profile(),
    ).links  # fmt: skip
    names = [each.name for each in link.segments]
    assert names == ["Reach", "Touch", "MoveObjTo", step, "ResumePosture"]


def test_it_can_be_switched_off_and_is_off_in_the_thesis() -> None:
    assert profile().steady
    assert not profile("thesis").steady
    assert not profile(steady=False).steady
    assert profile(steady=False).fingerprint != profile().fingerprint


RATE_HZ = 20
FLICKER_WINDOWS_FLICKER = 3
"""Frames of 150 ms at 20 Hz."""

WINDOW = times().flicker_window_ms * RATE_HZ // 1000
LAST = 3 * WINDOW
FLICKER_WINDOWS_SCENE = (
    RateMhz(RATE_HZ * 1000),
    Link("hand", "hand", "right"),
    Tag("mug", "mobile"),
    Tag("jar", "mobile"),
)

Interval = Touching | Resting


def flicker_windows_doubts(facts: tuple[Fact, ...]) -> set[Fact]:
    return {each for each in steady(facts) if isinstance(each, FlickerCorrection)}


def scene(intervals: list[Interval], first: int, last: int) -> tuple[Fact, ...]:
    """What was measured from the first to the last frame of a longer capture."""
    cut = [
        replace(each, first=max(each.first, first), last=min(each.last, last))
        for each in intervals
        if each.first <= last and each.last >= first
    ]
    return (Frames(first, last), *FLICKER_WINDOWS_SCENE, *cut)


def chatter(draw_lengths: list[int]) -> list[Interval]:
    """A contact that is lost and found every few frames, throughout."""
    found: list[Interval] = []
    frame = FLICKER_WINDOWS_FLICKER
    while frame < LAST - 4 * FLICKER_WINDOWS_FLICKER:
        length, gap = (draw_lengths[(len(found) + shift) % len(draw_lengths)] for shift in (0, 1))
        found.append(Touching("hand", "mug", frame, frame + length - 1))
        frame += length + gap
    return found


@settings(max_examples=8, deadline=None)
@given(lengths=st.lists(st.integers(1, FLICKER_WINDOWS_FLICKER - 1), min_size=1, max_size=6))
def test_flicker_that_never_ends_is_resolved_a_window_at_a_time(lengths: list[int]) -> None:
    """What comes after a window and two flickers does not change what is doubted in it."""
    intervals = chatter(lengths)
    whole = flicker_windows_doubts(scene(intervals, 0, LAST))
    for windows in (1, 2):
        end = windows * WINDOW + FLICKER_WINDOWS_FLICKER
        seen = flicker_windows_doubts(scene(intervals, 0, end + 2 * FLICKER_WINDOWS_FLICKER))
        assert {each for each in seen if last(each) < end} == {
            each for each in whole if last(each) < end
        }


def last(fact: Fact) -> int:
    assert isinstance(fact, FlickerCorrection)
    return fact.last


SPANS = st.lists(
    st.tuples(st.integers(0, 60), st.integers(0, 20)).map(lambda each: (each[0], sum(each))),
    max_size=8,
)


@given(SPANS, SPANS, st.sets(st.integers(0, 80)))
def test_a_rest_counts_from_the_last_tick_of_it_that_lies_in_a_contact(rests, contacts, others):
    ticks = sorted(others | {0, 80} | {frame for span in contacts for frame in span})
    own = sorted(Touching("hand", "box", *each) for each in contacts)
    found = set(undisturbed("hand", ticks, [Resting("hand", *each) for each in rests], own))
    expected = set()
    for first, last in rests:
        inside = [at for at, frame in enumerate(ticks) if first <= frame <= last]
        touched = [at for at in inside if any(a <= ticks[at] <= b for a, b in contacts)]
        if inside and not touched:
            expected.add(Undisturbed("hand", inside[0], inside[-1]))
        elif touched and inside[0] < touched[-1] < inside[-1]:
            expected.add(Undisturbed("hand", touched[-1], inside[-1]))
    assert found == expected


FRAMES = 200


def sharing_contacts(ee: str) -> st.SearchStrategy[list[Touching]]:
    """Contacts of an end-effector with two things, those with the same one apart."""
    ends = st.lists(st.integers(0, FRAMES), min_size=2, max_size=8, unique=True).map(sorted)

    def made(mug: list[int], box: list[int]) -> list[Touching]:
        pairs = [
            (name, first, last)
            for name, frames in (("mug", mug), ("box", box))
            for first, last in zip(frames[::2], frames[1::2], strict=False)
        ]
        return sorted(
            (Touching(ee, name, first, last) for name, first, last in pairs),
            key=lambda each: each.first,
        )

    return st.builds(made, ends, ends)


ticks_of = st.sets(st.integers(1, FRAMES - 1)).map(lambda each: sorted({0, FRAMES} | each))


@given(sharing_contacts("right_hand"), sharing_contacts("left_hand"))
def test_every_pair_that_shares_object_and_frame_is_found(
    own: list[Touching], others: list[Touching]
) -> None:
    found = overlapping(own, [by_object(others)])
    assert sorted(found) == sorted(
        (one, other)
        for one in own
        for other in others
        if one.other == other.other and one.first <= other.last and other.first <= one.last
    )


@given(sharing_contacts("right_hand"), sharing_contacts("left_hand"), ticks_of)
def test_a_change_meanwhile_lies_between_its_tick_and_the_next(
    own: list[Touching], others: list[Touching], ticks: list[int]
) -> None:
    pairs = overlapping(own, [by_object(others)])
    facts = list(shared("right_hand", ticks, pairs, rate_hz=100.0))
    spans = {(each.other, each.first): each for each in others}
    for each in facts:
        if isinstance(each, Meanwhile):
            contact = spans[each.object, each.since]
            frame = contact.first if each.kind == "begins" else contact.last
            assert ticks[each.tick] <= frame <= ticks[each.tick + 1]
            assert any(one.other == each.object and one.first <= frame <= one.last for one in own)
    inside = [each for each in pairs if each[0].first <= each[1].first]
    begins = [each for each in facts if isinstance(each, Meanwhile) and each.kind == "begins"]
    assert len(begins) == len(inside)


INVERSE = {
    "meets": "metBy", "starts": "startedBy", "finishes": "finishedBy", "during": "contains",
    "overlaps": "overlappedBy", "equals": "equals",
}  # fmt: skip
BOTH = INVERSE | {other: one for one, other in INVERSE.items()}


@given(st.lists(st.integers(0, 6), min_size=4, max_size=4))
def test_of_two_intervals_each_has_the_inverse_relation_to_the_other(ends: list[int]):
    first, last, begin, end = ends
    if first < last and begin < end:
        relation = allen(first, last, begin, end)
        back = allen(begin, end, first, last)
        assert back == (BOTH | {"before": "after", "after": "before"})[relation]
