"""What an action needs before it that its scene may lack (thesis 4.6.1.1, 5.3.2)."""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass

from scipy.spatial.transform import RigidTransform

from capar.model.observation import Observation
from capar.pipelines.instantiation import Instance
from capar.pipelines.ways import steps_of
from capar.regeneration.bindings import Kinds
from capar.regeneration.free_places import Room
from capar.regeneration.scenes import Scene
from capar.regeneration.thing_goals import put_down_poses

Condition = tuple[str, ...]
"""``touch`` with a hand and a thing, ``free`` with a hand, ``stand`` with a thing and its support,
``clear`` with the thing whose goal it is, or ``bare`` with a thing."""

Touching = frozenset[tuple[str, str]]
"""Hands, by their sides, with the things that they touch."""

MEANING = {
    "touch": "contact({} hand, {})",
    "free": "no contact of the {} hand",
    "stand": "contact({}, {})",
    "clear": "nothing else where {!r} is put",
    "bare": "nothing on {!r}",
}


@dataclass(frozen=True)
class World:
    """A scene with who touches what in it, as measured."""

    scene: Scene
    touching: Touching = frozenset()


@dataclass(frozen=True, eq=False)
class Problem:
    """A world, and what is wanted of it."""

    world: World
    wanted: tuple[Condition, ...]
    goals: Mapping[str, RigidTransform]
    """Where the action puts things in the end, by the scene's names."""

    parts: frozenset[str]
    """The things of the scene that take part in the action."""

    room: Room
    kinds: Kinds


def told(condition: Condition) -> str:
    """A condition in words."""
    return MEANING[condition[0]].format(*condition[1:])


def problem_of(instance: Instance, world: World, kinds: Kinds) -> Problem:
    """What a bound action needs of a world.

    Hands touch what they touch when the recording begins, and nothing else; things stand as its
    preparatory specifications say; where things are put there is room; what is moved bears nothing
    that it did not bear.

    Args:
        instance: The action.
        world: As it is.
        kinds: The hierarchy of kinds.

    Raises:
        PlanError: Something would be put down where nothing supports it.
    """
    source, where, _ = instance.placed(world.scene)
    parts = instance.parts
    goals = {}
    for role, pose in put_down_poses(source, where).items():
        if role in parts:  # as the frame of the scene's thing, of which the part's is moved
            own = world.scene.thing(parts[role])
            goals[own.name] = pose * where.thing(role).pose.inv() * own.pose
    began = {(h.side, parts[h.thing]) for h in source.holds if h.first == 0 and h.thing in parts}
    acting = {side for side, _ in began}
    sides = {*source.hands, *(side for side, _ in world.touching)}
    wanted: list[Condition] = [("touch", side, thing) for side, thing in sorted(began)]
    wanted += [("free", side) for side in sorted(sides - acting)]
    wanted += [
        ("stand", parts[first], parts[second])
        for first, second in _stands(source.observation)
        if first in parts and second in parts and first not in source.scene.fastened
    ]
    wanted += [("clear", name) for name in sorted(goals)]
    bare = (role for role in instance.roles if role.moved and not role.bears)
    wanted += [("bare", parts[role.name]) for role in bare]
    room = Room(instance.asked.human, world.scene)
    return Problem(world, tuple(wanted), goals, frozenset(parts.values()), room, kinds)


def _stands(observation: Observation) -> Iterator[tuple[str, str]]:
    """What stands on what by preparatory specifications that no earlier step makes true."""
    known: set[tuple[str, ...]] = set()
    for step in sorted(steps_of(observation).steps, key=lambda one: one.step.begin):
        for preparation in step.ipar.preparation:
            needed, pair = preparation.condition, preparation.condition.arguments
            if needed.kind == "contact" and pair[0] != step.ipar.ee and pair not in known:
                known.add(pair)
                yield pair[0], pair[1]
        known |= {one.arguments for one in step.ipar.post_assertions if one.holds}
