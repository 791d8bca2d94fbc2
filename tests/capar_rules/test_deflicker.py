"""Flicker is resolved to the fewest changes that explain what was measured, and told."""

from collections.abc import Callable
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
)
from capar.pipelines.explanation import explained
from capar.pipelines.observation import observe
from capar_rules.borders.deflicker import steady
from capar_rules.engine.profiles import profile
from capar_rules.explain.explanation import Explainer
from capar_rules.pars.inference import infer
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


def test_a_short_loss_of_contact_is_bridged_and_told() -> None:
    found = steady((*SCENE, *touches((50, 100), (111, 200))))
    assert contacts(found) == [(50, 200)]
    assert doubts(found) == [FlickerCorrection("hand", "mug", 101, 110, "touching")]


def test_a_loss_as_long_as_letting_go_and_taking_again_stays() -> None:
    measured = (*SCENE, *touches((50, 100), (101 + FLICKER, 200)))
    assert steady(measured) == measured


def test_a_lone_contact_stays_however_short_it_is() -> None:
    measured = (*SCENE, *touches((50, 54), (90, 94), (200, 300)))
    assert steady(measured) == measured


def test_chatter_before_a_grasp_is_one_beginning() -> None:
    found = steady((*SCENE, *touches((50, 51), (60, 62), (70, 200))))
    assert contacts(found) == [(70, 200)]
    assert {each.taken for each in doubts(found)} == {"apart"}


def test_a_thing_that_stops_for_a_moment_moves_on() -> None:
    found = steady((*SCENE, *touches((50, 300)), Moving("mug", 80, 120), Moving("mug", 125, 200)))
    assert Moving("mug", 80, 200) in found
    assert doubts(found) == [FlickerCorrection("mug", "mug", 121, 124, "moving")]


def test_a_hand_that_twitches_rests_on() -> None:
    found = steady((*SCENE, Resting("hand", 0, 100), Resting("hand", 110, 300)))
    assert Resting("hand", 0, 300) in found
    assert doubts(found) == [FlickerCorrection("hand", "hand", 101, 109, "resting")]


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


def test_it_can_be_switched_off_and_is_off_in_the_thesis() -> None:
    assert profile().steady
    assert not profile("thesis").steady
    assert not profile(steady=False).steady
    assert profile(steady=False).fingerprint != profile().fingerprint


def test_an_explanation_says_what_was_doubted() -> None:
    capture = motions.touch_cycle(motions.WOMAN).capture
    facts = steady(flickering(measure(capture).facts, capture.rate_hz))
    (link,) = infer(facts, profile=profile()).links
    explainer = Explainer(facts, profile=profile())
    noted = {each.name: explainer.explain(each).notes for each in link.segments}
    assert "contact is assumed" in noted["Touch"][0]
    assert not noted["Reach"]


def test_nothing_is_said_of_doubt_where_nothing_flickers() -> None:
    capture = motions.touch_cycle(motions.WOMAN).capture
    seen = explained(capture, rules=profile())
    assert not [each for each in seen.observation.notices if each.code == "flicker"]
    plain = observe(capture, rules=profile(steady=False))
    assert plain.links == seen.observation.links
