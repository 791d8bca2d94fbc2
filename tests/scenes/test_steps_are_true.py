"""What steps say of rest, of contact and of the air is what bodies do. Nothing is observed here."""

from collections.abc import Iterator

import numpy as np
import pytest

from scenes.batteries import SOME
from scenes.hands.clearance import Placed, gap
from scenes.hands.performer import Hand
from scenes.hands.scene import Scene
from scenes.hands.stage import Finger, Stage
from scenes.hands.things import Step, Thing
from scenes.parts.builders import Jointed
from scenes.people.stage import planted_m

STILL = frozenset(
    {"Rest", "Touch", "TouchWith", "TouchOneself", "Stand", "StandOnOneLeg", "RestFoot", "Point"}
)
"""Steps in which a hand or a foot stays where it is."""

FROM = frozenset({"Reach", "ResumePosture", "Step", "Kick", "Accept", "Receive"})
"""Steps whose last object may be what was left."""

IN_THE_AIR = frozenset({"Lift", "Carry", "Raise"})
"""Steps at whose end a thing is off everything, if it is their only object."""

STAYS_M = 0.0015
"""A hand that goes no further about a place rests [m]."""

REST_S = 0.4
"""A hand that rests for so long does so in a step of its own (spec 10) [s]."""

STILL_M_S, STILL_RAD_S = 0.003, 0.005
"""A hand that is slower rests [m/s, rad/s]."""

TOUCHING_M = 0.002
"""Things that touch are no further apart [m]."""

OFF_M = 0.005
"""Things that do not touch are further apart [m]."""

RATE_HZ = 100.0
"""How finely motion is looked at."""

each_scene = pytest.mark.parametrize("scene", SOME.values(), ids=SOME)


def steps(stage: Stage) -> Iterator[tuple[Hand, Step]]:
    """Every step of every hand."""
    for hand, unit in zip(stage.hands, stage.expectation(RATE_HZ).units, strict=True):
        for step in unit.steps:
            yield hand, step


def resting(hand: Hand | Finger, start_s: float, end_s: float) -> float:
    """The longest time that a hand stays where it is between two times [s]."""
    poses = hand.body.poses(np.arange(start_s, end_s, 1.0 / RATE_HZ))
    change = np.abs(np.diff(poses, axis=0)) * RATE_HZ
    still = (change[:, :3, 3].max(axis=1) < STILL_M_S) & (
        change[:, :3, :3].max(axis=(1, 2)) < STILL_RAD_S
    )
    moves = np.flatnonzero(~np.concatenate([[False], still, [False]]))
    return float((np.diff(moves) - 1).max() / RATE_HZ)


def stays(hand: Hand, step: Step) -> bool:
    """Whether a hand stays within a millimetre and a half throughout, and a foot on its toes."""
    if hand.form.kind == "foot":
        return planted_m(hand, step.start_s, step.end_s) < STAYS_M
    places = hand.body.poses(np.arange(step.start_s, step.end_s, 1.0 / RATE_HZ))[:, :3, 3]
    return float(np.ptp(places, axis=0).max()) < STAYS_M


def things_of(stage: Stage, step: Step) -> list[Thing]:
    """The objects of a step as things."""
    by_name = {each.name: each for each in stage.things}
    return [by_name[each] for each in step.objects]


def apart(first: Hand | Thing, second: Thing, time: float) -> float:
    """Distance of two bodies at a time [m]."""
    return gap(Placed.at(first, time), Placed.at(second, time))


def rides(thing: Thing, load: Thing, step: Step) -> bool:
    """Whether two things move as one during a step, or one is a part of the other."""
    if isinstance(load.body, Jointed) and load.body.base is thing.body:
        return True
    before, after = (
        np.linalg.inv(thing.body.at(time)) @ load.body.at(time)
        for time in (step.start_s, step.end_s)
    )
    return bool(np.allclose(before, after, atol=1e-6))


@each_scene
def test_a_long_rest_is_a_step_of_its_own(scene: Scene) -> None:
    """No hand rests with its fingers for 0.4 s within a reach, a return or any other motion."""
    for hand, step in steps(scene.stage):
        if step.name not in STILL:
            own = [hand, *(each for each in scene.stage.fingers if each.hand is hand)]
            still = min(resting(each, step.start_s, step.end_s) for each in own)
            assert still < REST_S, (hand.name, step)


@each_scene
def test_a_hold_is_at_rest(scene: Scene) -> None:
    """A hand that rests, or holds something, stays where it is throughout."""
    for hand, step in steps(scene.stage):
        if step.name in STILL:
            still = resting(hand, step.start_s, step.end_s)
            long = still > step.end_s - step.start_s - 0.05
            assert long or stays(hand, step), (hand.name, step)


@each_scene
def test_the_last_of_several_objects_is_touched(scene: Scene) -> None:
    """What a step names beside its first object touches that object, or the hand, at its end."""
    stage = scene.stage
    for hand, step in steps(stage):
        if len(step.objects) > 1 and step.name not in FROM:
            first, *_, last = things_of(stage, step)
            near = min(apart(body, last, step.end_s) for body in (first, hand))
            assert near < TOUCHING_M, (hand.name, step)


@each_scene
def test_what_is_in_the_air_touches_nothing_but_its_load(scene: Scene) -> None:
    """A thing that was lifted, carried or raised ends off everything that does not ride on it."""
    stage = scene.stage
    for hand, step in steps(stage):
        if step.name in IN_THE_AIR and len(step.objects) == 1:
            (thing,) = things_of(stage, step)
            for other in stage.things:
                if other is not thing and not rides(thing, other, step):
                    assert apart(thing, other, step.end_s) > OFF_M, (hand.name, step, other.name)
