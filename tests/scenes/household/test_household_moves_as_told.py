"""Furniture keeps to rails and hinges, and names of motions hold. Nothing is observed."""

from collections.abc import Iterator

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from scenes.batteries import SOME
from scenes.hands.clearance import Placed, gap
from scenes.hands.expectation import Step
from scenes.hands.performer import Hand
from scenes.hands.scene import Scene
from scenes.hands.stage import Stage
from scenes.hands.things import Thing
from scenes.household import SCENES
from scenes.objects.forms import WALL_M

RISE_M = 0.05
"""A transit of three steps rises and sinks by so much where it is steep (spec 10) [m]."""

LEVEL_M = 0.1
"""Between them it goes so far aside (spec 10) [m]."""

OWN = {name: scene for name, scene in SOME.items() if name.startswith("household-")}
each_scene = pytest.mark.parametrize("scene", OWN.values(), ids=OWN)


def acted(stage: Stage, *names: str) -> Iterator[tuple[Hand, Step, Thing]]:
    """Steps of those names, with the hand and the first object."""
    by_name = {each.name: each for each in stage.things}
    for hand in stage.hands:
        for step in hand.steps:
            if step.name in names:
                yield hand, step, by_name[step.objects[0]]


def parts(stage: Stage) -> dict[str, tuple[Thing, list[Step]]]:
    """Parts of furniture that are opened or closed, each with these steps."""
    found: dict[str, tuple[Thing, list[Step]]] = {}
    for _, step, part in acted(stage, "Open", "Close"):
        found.setdefault(part.name, (part, []))[1].append(step)
    return found


@pytest.fixture(scope="module")
def furnished() -> dict[str, Stage]:
    """Every scene in which furniture is opened or closed, as it is performed."""
    stages = {name: scene.stage() for name, scene in SCENES.items()}
    return {name: stage for name, stage in stages.items() if parts(stage)}


def travelled(thing: Thing, step: Step) -> np.ndarray:
    """Displacement of a thing's origin during a step [m]."""
    ends = [thing.body.at(time)[:3, 3] for time in (step.start_s, step.end_s)]
    return np.asarray(ends[1] - ends[0])


def test_most_kinds_of_furniture_are_there(furnished: dict[str, Stage]) -> None:
    """Drawers, doors, lids, flaps and gates are opened or closed."""
    kinds = {part.form.kind for stage in furnished.values() for part, _ in parts(stage).values()}
    assert {"drawer", "door", "lid", "flap"} <= kinds


def test_parts_keep_to_a_rail_or_to_a_hinge(furnished: dict[str, Stage]) -> None:
    """A part goes along one level axis, or turns about one axis through its origin."""
    every = [(stage, each) for stage in furnished.values() for each in parts(stage).values()]
    for stage, (part, _) in every:
        poses = part.body.poses(stage.times(20.0))
        ranges = np.ptp(poses[:, :3, 3], axis=0)
        if ranges.max() > 1e-6:
            assert sorted(ranges)[1] < 1e-9
            assert ranges[2] < 1e-9
            assert np.abs(poses[:, :3, :3] - poses[0, :3, :3]).max() < 1e-9
        else:
            turns = Rotation.from_matrix(poses[:, :3, :3]).as_rotvec()
            assert (np.ptp(turns, axis=0) > 1e-6).sum() == 1


def test_open_leads_away_from_the_closed_place_and_close_back(
    furnished: dict[str, Stage],
) -> None:
    """At the end of Open a part is further from its closed place, at the end of Close nearer."""
    every = [(stage, each) for stage in furnished.values() for each in parts(stage).values()]
    for stage, (part, steps) in every:
        poses = {time: part.body.at(time) for step in steps for time in (step.start_s, step.end_s)}
        shut = poses[steps[0].start_s] if steps[0].name == "Open" else poses[steps[-1].end_s]

        def openness(
            time: float, shut: np.ndarray = shut, poses: dict[float, np.ndarray] = poses
        ) -> float:
            moved = np.linalg.inv(shut) @ poses[time]
            turned = Rotation.from_matrix(moved[:3, :3]).magnitude()
            return float(np.linalg.norm(moved[:3, 3]) + turned)

        for step in steps:
            change = openness(step.end_s) - openness(step.start_s)
            assert (change > 0.05) if step.name == "Open" else (change < -0.05)
        assert is_shut(stage, steps[0], part, shut)


def is_shut(stage: Stage, step: Step, part: Thing, pose: np.ndarray) -> bool:
    """Whether a part is in its closed place: unturned, its front flush, or over its own half."""
    body = next(each for each in stage.things if each.name == step.objects[1])
    if np.ptp(part.body.poses(stage.times(20.0))[:, :3, 3], axis=0).max() < 1e-6:
        return bool(np.allclose(pose[:3, :3], np.eye(3), atol=1e-9))
    offset = pose[:3, 3] - body.body.first[:3, 3]
    if part.form.kind == "drawer":
        return bool(abs(offset[0]) < 1e-9)
    half = np.abs(body.form.vertices[:, 1]).max() - WALL_M
    edge = abs(offset[1]) + np.abs(part.form.vertices[:, 1]).max()
    return bool(abs(edge - half) < 1e-9)


@each_scene
def test_words_for_up_and_down_hold(scene: Scene) -> None:
    """Lift and Raise go up more than aside, Lower down, and Carry goes aside more than either."""
    stage = scene.stage()
    for _, step, thing in acted(stage, "Lift", "Raise", "Lower", "Carry"):
        x, y, up = travelled(thing, step)
        aside = float(np.hypot(x, y))
        if step.name == "Carry":
            assert aside > max(abs(up), LEVEL_M)
        else:
            steep = -up if step.name == "Lower" else up
            assert steep > max(aside, RISE_M)


@each_scene
def test_lift_begins_in_contact_and_raise_in_the_air(scene: Scene) -> None:
    """What is lifted touches something that stays at the start; what is raised touches nothing."""
    stage = scene.stage()
    for hand, step, _ in acted(stage, "Lift", "Raise"):
        held = [each for each in stage.things if each.name in step.objects]
        bodies: list[Hand | Thing] = [*stage.things, *stage.hands]
        bearers = [each for each in bodies if each not in (*held, hand)]
        carried = [
            each for each in bearers if isinstance(each, Thing) and rides(held[0], each, step)
        ]
        near = min(
            gap(Placed.at(thing, step.start_s), Placed.at(other, step.start_s))
            for thing in held
            for other in bearers
            if other not in carried and not (isinstance(other, Hand) and joins(stage, other, step))
        )
        assert (near < 0.002) == (step.name == "Lift"), (step, near)


def rides(thing: Thing, load: Thing, step: Step) -> bool:
    """Whether two things move as one during a step."""
    before, after = (
        np.linalg.inv(thing.body.at(time)) @ load.body.at(time)
        for time in (step.start_s, step.end_s)
    )
    return bool(np.allclose(before, after, atol=1e-6))


def joins(stage: Stage, other: Hand, step: Step) -> bool:
    """Whether another hand does the same step to the same things."""
    return any(
        each.name == step.name and each.objects == step.objects and each.start_s == step.start_s
        for each in other.steps
    )
