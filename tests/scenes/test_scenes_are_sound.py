"""The scenes themselves: what they claim is what they perform. Nothing is observed here."""

from collections.abc import Iterator
from dataclasses import replace
from itertools import combinations

import numpy as np
import pytest

from capar.model.capture import TagType
from scenes.batteries import SOME
from scenes.hands.clearance import Placed, gap, moving
from scenes.hands.performer import Hand
from scenes.hands.scene import Scene
from scenes.hands.stage import Stage
from scenes.hands.things import Thing
from scenes.people.stage import Limb, planted_m
from scenes.score import judged

NAMES = frozenset({
    "Reach", "Touch", "TouchWith", "MoveObj", "MoveObjTo", "Hit", "ResumePosture", "Rest",
    "PostureChange", "Withdraw", "Lift", "Carry", "Lower", "Raise", "PutDown", "Push", "Pull",
    "Slide", "Turn", "Tilt", "Pour", "Shake", "Stir", "Wipe", "Roll", "Throw", "Catch", "Give",
    "Receive", "Accept", "HandOver", "Drink", "Clap", "Salute", "TouchOneself", "Kick", "LetGo",
    "HitAway", "Open", "Close", "Cut", "Stand", "Step", "Walk", "StandOnOneLeg", "RestFoot",
    "Wave", "Point",
})  # fmt: skip
"""The vocabulary of hands and feet."""

ABOUT_NOTHING = frozenset({"Rest", "PostureChange", "Wave", "Point"})
"""Steps that have no object."""


HELD_M = 0.003
"""A hand is no further from what it touches [m]."""

DEEP_M = 0.0025
"""Nothing is deeper in anything else [m]."""

FREE_M = 0.008
"""A hand is further from everything that it does not touch [m]."""

SLIDES_M = 0.002
"""No foot that stands slides further [m]."""

BESIDE_S = 0.12
"""So long before and after a contact a hand may be near what it touches [s]."""

FASTEST_M_S = 2.6
"""No hand is faster [m/s]."""

FASTEST_FOOT_M_S = 6.0
"""No foot is faster [m/s]."""

each_scene = pytest.mark.parametrize("scene", SOME.values(), ids=SOME)


def moments(stage: Stage, step_s: float = 0.2) -> list[float]:
    """Times at which a scene is looked at [s]."""
    return [float(each) for each in np.arange(0.0, stage.duration_s, step_s)]


def touching(hand: Hand, thing: Thing, time: float, margin: float = 0.0) -> bool:
    """Whether a hand touches a thing at a time, or so long before or after it [s]."""
    return any(
        each is thing and start - margin <= time <= end + margin
        for each, start, end in hand.touches
    )


def beside(hand: Hand) -> float:
    """So long before and after a contact a hand may be near what it touches [s]."""
    return hand.beside_s if isinstance(hand, Limb) else BESIDE_S


def pairs(stage: Stage) -> Iterator[tuple[Hand | Thing, Hand | Thing]]:
    """All pairs of bodies of which one can move."""
    bodies: list[Hand | Thing] = [*stage.hands]
    bodies.extend(each for each in stage.things if each.tag is TagType.MOBILE)
    rest = [each for each in stage.things if each.tag is not TagType.MOBILE]
    for index, first in enumerate(bodies):
        for second in [*bodies[index + 1 :], *rest]:
            yield first, second


@each_scene
@pytest.mark.parametrize("rate_hz", [60.0, 100.0])
def test_steps_cover_the_capture(scene: Scene, rate_hz: float) -> None:
    """Steps follow each other from the first frame to the last, with known names and objects."""
    capture, expectation = scene(rate_hz, 0.0005, 0.002, 0)
    assert [unit.ee for unit in expectation.units] == [each.name for each in capture.acting]
    known = {each.name for each in capture.objects} | {each.name for each in capture.acting}
    for unit in expectation.units:
        for steps in filter(None, (unit.steps, unit.alternative)):
            starts = [each.start_s for each in steps]
            ends = [each.end_s for each in steps]
            assert starts[0] == 0.0
            assert starts[1:] == ends[:-1]
            assert ends[-1] == pytest.approx(capture.times[-1])
            for each in steps:
                assert each.end_s - each.start_s > 0.15
                assert each.name in NAMES
                assert set(each.objects) <= known
                assert len(each.objects) == len(set(each.objects))
                assert bool(each.objects) == (each.name not in ABOUT_NOTHING)
        assert unit.alternative != unit.steps


@each_scene
def test_the_truth_itself_is_counted_as_right(scene: Scene) -> None:
    """Steps as written score, and steps with a border too late score by their names only."""
    for unit in scene.stage.expectation(100.0).units:
        for steps in filter(None, (unit.steps, unit.alternative)):
            outcome = judged(scene.name, unit, steps)
            assert outcome.named
            assert outcome.placed
            late = tuple(replace(each, end_s=each.end_s + 0.2) for each in steps)
            outcome = judged(scene.name, unit, late)
            assert outcome.named
            assert not outcome.placed
        assert not judged(scene.name, unit, unit.steps[:-1]).named


@each_scene
def test_same_seed_same_capture(scene: Scene) -> None:
    """The noise is drawn from the seed alone."""
    first, again, other = (scene(100.0, 0.0005, 0.002, seed)[0] for seed in (0, 0, 1))
    positions = [each.sensors[0].stream.positions for each in (first, again, other)]
    assert np.array_equal(positions[0], positions[1])
    assert not np.array_equal(positions[0], positions[2])


@each_scene
def test_hands_are_on_what_they_touch_and_off_what_they_do_not(scene: Scene) -> None:
    """Contact as it is written down is contact of the surfaces."""
    stage = scene.stage
    for time in moments(stage):
        for finger in stage.fingers:
            for thing, start, end in finger.touches:
                if start <= time <= end:
                    far = gap(Placed.at(finger, time), Placed.at(thing, time))
                    assert -DEEP_M <= far <= HELD_M, (finger.name, thing.name, time)
        for hand in stage.hands:
            palm = Placed.at(hand, time)
            for thing in stage.things:
                if touching(hand, thing, time):
                    far = gap(palm, Placed.at(thing, time))
                    assert far <= HELD_M, (hand.name, thing.name, time)
                elif not touching(hand, thing, time, beside(hand)):
                    far = gap(palm, Placed.at(thing, time))
                    assert far >= FREE_M, (hand.name, thing.name, time)


@each_scene
def test_nothing_goes_through_anything(scene: Scene) -> None:
    """No two bodies overlap by more than a pressed hand does."""
    stage = scene.stage
    for time in moments(stage, 0.33):
        bodies: list[Hand | Thing] = [*stage.hands, *stage.things]
        placed = {each.name: Placed.at(each, time) for each in bodies}
        for first, second in pairs(stage):
            deep = -gap(placed[first.name], placed[second.name])
            assert deep <= DEEP_M, (first.name, second.name, time)


@each_scene
def test_nothing_moves_by_itself(scene: Scene) -> None:
    """A thing moves only rigidly with a hand that touches something, or where it is told free."""
    stage = scene.stage
    times = stage.times(50.0)
    for thing in (each for each in stage.things if each.tag is not TagType.SELF):
        own = thing.body.poses(times)
        for time in moving(thing, times):
            if any(start <= time <= end + 0.02 for start, end in thing.free):
                continue
            frame = int(np.searchsorted(times, time))
            holders = [
                hand.body.poses(times)[frame - 1 : frame + 1]
                for hand in (*stage.hands, *stage.fingers)
                if any(start - 1e-9 <= time <= end + 0.02 for _, start, end in hand.touches)
            ]
            kept = [
                np.abs(
                    np.linalg.inv(hand[1]) @ own[frame] - np.linalg.inv(hand[0]) @ own[frame - 1]
                ).max()
                for hand in holders
            ]
            assert kept, (thing.name, time)
            assert min(kept) < 0.004, (thing.name, time)


@each_scene
def test_things_rest_on_something(scene: Scene) -> None:
    """What no hand holds stands on another thing, at the first frame and at the last."""
    stage = scene.stage
    for time in (0.0, stage.duration_s):
        for thing in (each for each in stage.things if each.tag is TagType.MOBILE):
            others = [each for each in stage.things if each is not thing]
            held = any(touching(hand, thing, time) for hand in stage.hands)
            if not held:
                own = Placed.at(thing, time)
                assert min(gap(own, Placed.at(each, time)) for each in others) < 0.001, thing.name


@each_scene
def test_hands_are_not_too_fast(scene: Scene) -> None:
    """Hands and feet move as people's do."""
    stage = scene.stage
    times = stage.times(100.0)
    for hand in stage.hands:
        places = hand.body.poses(times)[:, :3, 3]
        fastest = FASTEST_FOOT_M_S if hand.form.kind == "foot" else FASTEST_M_S
        speeds = np.linalg.norm(np.diff(places, axis=0), axis=1) * 100.0
        assert speeds.max() < fastest, hand.name


@each_scene
def test_hands_that_meet_touch_and_others_do_not(scene: Scene) -> None:
    """Contact of two limbs as it is written down is contact of their surfaces."""
    limbs = [each for each in scene.stage.hands if isinstance(each, Limb)]
    for first, second in combinations(limbs, 2):
        met = [(start, end) for other, start, end in first.others if other is second]
        for time in (each for pair in met for each in pair):
            assert gap(Placed.at(first, time), Placed.at(second, time)) <= HELD_M
        for time in moments(scene.stage):
            if not any(start - BESIDE_S <= time <= end + BESIDE_S for start, end in met):
                far = gap(Placed.at(first, time), Placed.at(second, time))
                assert far >= FREE_M, (first.name, second.name, time)


@each_scene
def test_a_foot_that_stands_does_not_slide(scene: Scene) -> None:
    """While a foot touches what it stands on, it stays there; its heel may rise."""
    stage = scene.stage
    for foot in (each for each in stage.hands if each.form.kind == "foot"):
        fixed = (each for each in foot.touches if each[0].tag is TagType.FIXED)
        for _, start, end in fixed:
            assert planted_m(foot, start, end) < SLIDES_M, (foot.name, start, end)
