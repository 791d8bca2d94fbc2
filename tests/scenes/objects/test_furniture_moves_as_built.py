"""Drawers move along their rails, doors and lids about their hinges, and names say which way."""

from math import radians

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from scenes.hands.expectation import Step
from scenes.hands.performer import PRESS
from scenes.hands.stage import Stage
from scenes.hands.things import Thing
from scenes.objects import SCENES
from scenes.objects.furniture import cabinet, cupboard
from scenes.objects.handling import NEAR, UP, Grip

BODIES = {"drawer": "cabinet", "door": "cupboard", "lid": "chest"}
"""Furniture's moving parts, each with what it belongs to."""


def named(stage: Stage, name: str) -> Thing | None:
    """The thing of that name, if the scene has it."""
    return next((each for each in stage.things if each.name == name), None)


def parts(stage: Stage) -> list[tuple[Thing, Thing]]:
    """Moving parts with the furniture that they belong to."""
    pairs = [(named(stage, part), named(stage, body)) for part, body in BODIES.items()]
    return [(part, body) for part, body in pairs if part and body]


@pytest.fixture(scope="module")
def furnished() -> dict[str, Stage]:
    """Every scene with furniture, as it is performed."""
    stages = {name: scene.stage() for name, scene in SCENES.items()}
    return {name: stage for name, stage in stages.items() if parts(stage)}


def openness(part: Thing, body: Thing, time: float) -> float:
    """How far a part is from its closed place [m, or rad for hinges]."""
    pose = part.body.at(time)
    turned = Rotation.from_matrix(pose[:3, :3]).magnitude()
    out = pose[0, 3] - body.body.first[0, 3] if part.name == "drawer" else 0.0
    return float(abs(out) + turned)


def steps_of(stage: Stage, part: Thing, *names: str) -> list[Step]:
    """Steps of those names that are about a part."""
    steps = [step for hand in stage.hands for step in hand.steps]
    return [each for each in steps if each.name in names and each.objects[0] == part.name]


def test_most_kinds_of_furniture_are_there(furnished: dict[str, Stage]) -> None:
    """Drawers, doors and chests' lids each have several scenes."""
    found = [part.name for stage in furnished.values() for part, _ in parts(stage)]
    assert all(found.count(part) >= 4 for part in BODIES)


def test_open_leads_away_from_the_closed_place_and_close_back(
    furnished: dict[str, Stage],
) -> None:
    """At the end of Open a part is further from its closed place, at the end of Close nearer."""
    every = [(stage, each) for stage in furnished.values() for each in parts(stage)]
    for stage, (part, body) in every:
        for step in steps_of(stage, part, "Open", "Close"):
            change = openness(part, body, step.end_s) - openness(part, body, step.start_s)
            assert (change > 0.05) if step.name == "Open" else (change < -0.05)


def test_pull_is_said_only_where_the_closed_place_is_never_seen(
    furnished: dict[str, Stage],
) -> None:
    """A part is closed at some time exactly where its motion is called Open or Close."""
    every = [(stage, each) for stage in furnished.values() for each in parts(stage)]
    for stage, (part, body) in every:
        if steps := steps_of(stage, part, "Open", "Close", "Pull"):
            nearest = min(openness(part, body, time) for time in stage.times(20.0))
            assert (nearest < 1e-6) == all(each.name != "Pull" for each in steps)


def test_parts_keep_to_their_rails_and_hinges(
    furnished: dict[str, Stage],
) -> None:
    """A drawer moves along x only and never turns; a hinge's axis never moves."""
    every = [(stage, each) for stage in furnished.values() for each in parts(stage)]
    for stage, (part, _) in every:
        poses = part.body.poses(stage.times(20.0))
        if part.name == "drawer":
            assert np.ptp(poses[:, 1:3, 3], axis=0).max() < 1e-9
            assert np.abs(poses[:, :3, :3] - np.eye(3)).max() < 1e-9
        else:
            assert np.ptp(poses[:, :3, 3], axis=0).max() < 1e-9


@given(angle_deg=st.floats(5.0, 100.0), side=st.sampled_from(["right", "left"]))
@settings(max_examples=25, deadline=None)
def test_a_door_opens_towards_the_performer_and_shuts_again(angle_deg: float, side: str) -> None:
    """Opening by an angle brings the handle nearer; shutting by the same angle undoes it."""
    stage = Stage("law")
    press = cupboard(stage, (0.7, 0.0, 0.75), side=side)
    hand = stage.right()
    shut = press.leaf.body.at(0.0)
    hand.body.first = press.grip.on(press.leaf, 0.0)
    handle = hand.now[0, 3]
    hand.meet(press.leaf)
    hand.take(press.leaf)
    press.hinge.turn(hand, angle_deg, 1.0)
    opened = press.leaf.body.at(hand.clock)
    turned = Rotation.from_matrix(shut[:3, :3].T @ opened[:3, :3]).magnitude()
    assert turned == pytest.approx(radians(angle_deg))
    assert hand.now[0, 3] < handle
    press.hinge.turn(hand, -angle_deg, 1.0)
    assert np.allclose(press.leaf.body.at(hand.clock), shut, atol=1e-9)


@given(out=st.floats(0.0, 0.3), up=st.floats(0.0, 0.1))
@settings(max_examples=25, deadline=None)
def test_a_grip_goes_with_its_thing(out: float, up: float) -> None:
    """A palm lies on the same point of a drawer, pressed on it, however far that stands out."""
    stage = Stage("law")
    chest = cabinet(stage, (0.7, 0.1, 0.75), out=out)
    pose = Grip((0.0, 0.0, up), NEAR, UP).on(chest.drawer, 0.0)
    place = chest.drawer.body.first[:3, 3]
    assert np.allclose(pose[:3, 3] - place, (PRESS, 0.0, up))
    assert np.allclose(pose[:3, 0], (1.0, 0.0, 0.0))
    assert np.allclose(pose[:3, 1], (0.0, 0.0, 1.0))
