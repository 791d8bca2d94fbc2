"""Feet walk in turn, bodies stay over their feet, hands within reach. Nothing is observed."""

from collections.abc import Iterator
from itertools import pairwise

import numpy as np
import pytest

from scenes.batteries import SOME, performed
from scenes.hands.scene import Scene
from scenes.hands.stage import Stage
from scenes.people import SCENES
from scenes.people.limbs import Limb
from scenes.people.stage import PeopleStage

REACH_M = 0.47
"""How far a hand gets from the head, for each metre of stature and beside 0.2 m [m]."""

OVER_M = 0.42
"""The lower back of a person of 1.74 m is no further from between the feet, sitting too [m]."""

OWN = {name: scene for name, scene in SOME.items() if name.startswith("people-")}
each_scene = pytest.mark.parametrize("scene", OWN.values(), ids=OWN)


def crowd(scene: Scene) -> PeopleStage:
    """A scene as it is performed."""
    stage = performed(scene)
    assert isinstance(stage, PeopleStage)
    return stage


def feet(stage: Stage) -> Iterator[tuple[str, list[Limb]]]:
    """Both feet of everybody."""
    limbs = [each for each in stage.hands if isinstance(each, Limb) and each.member == "foot"]
    for agent in dict.fromkeys(each.agent for each in limbs):
        yield agent, [each for each in limbs if each.agent == agent]


@pytest.mark.long
def test_a_third_of_the_scenes_are_of_virtual_bodies() -> None:
    """Performers who solve inverse kinematics, or turn their hinges, do a third of all."""
    virtual = [name for name, scene in SCENES.items() if _made_by(scene).endswith("virtual")]
    assert len(virtual) >= len(SCENES) / 3


def _made_by(scene: Scene) -> str:
    body = scene.stage().hands[0].body
    return type(body).__module__


@each_scene
def test_feet_walk_in_turn_and_never_both_in_the_air(scene: Scene) -> None:
    """Of three steps in turn each is walked, and one foot always bears."""
    stage = crowd(scene)
    for agent, pair in feet(stage):
        swings = sorted(
            (step.start_s, step.end_s, foot.side, step.name)
            for foot in pair
            for step in foot.steps
            if step.name in ("Walk", "Step")
        )
        for (_, end, side, name), (start, _, other, then) in pairwise(swings):
            assert start >= end - 1e-9, agent
            if name == then == "Walk":
                assert side != other or start > end + 0.4, agent


@each_scene
def test_walks_are_three_steps_or_more(scene: Scene) -> None:
    """Whoever walks does at least three steps."""
    for agent, pair in feet(crowd(scene)):
        count = sum(step.name == "Walk" for foot in pair for step in foot.steps)
        assert count == 0 or count >= 3, agent


@each_scene
def test_bodies_stay_over_their_feet(scene: Scene) -> None:
    """The lower back is never far from the middle between the feet."""
    stage = crowd(scene)
    times = stage.times(10.0)
    backs = {each.agent: each.body for each in stage.watchers if each.part == "l5"}
    for agent, pair in feet(stage):
        middle = np.mean([each.body.poses(times)[:, :2, 3] for each in pair], axis=0)
        far = np.linalg.norm(backs[agent].poses(times)[:, :2, 3] - middle, axis=1)
        assert far.max() < OVER_M * stage.people[agent] / 1.74 + 0.1, agent


@each_scene
def test_hands_are_within_an_arms_reach_of_the_head(scene: Scene) -> None:
    """No hand is further from the own head than an arm and half the shoulders allow."""
    stage = crowd(scene)
    times = stage.times(10.0)
    heads = {each.agent: each.body for each in stage.watchers if each.part == "head"}
    for hand in stage.hands:
        if isinstance(hand, Limb) and hand.member == "hand":
            places = hand.body.poses(times)[:, :3, 3] - heads[hand.agent].poses(times)[:, :3, 3]
            far = np.linalg.norm(places, axis=1).max()
            assert far < REACH_M * stage.people[hand.agent] + 0.2, (hand.name, far)
