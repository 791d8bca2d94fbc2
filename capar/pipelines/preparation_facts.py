"""A preparation as facts for the solver: places, what meets where, and what recordings can do."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np
from scipy.spatial.transform import RigidTransform, Rotation

from capar.body.scenes import Thing
from capar.pipelines.preparing import Problem
from capar.pipelines.ways import Way
from capar.regeneration.bindings import kind_of
from capar.regeneration.free_places import ROOM_M, standing_places
from capar.regeneration.mirroring import OTHER
from capar.regeneration.scenes import mobile, moved
from capar_rules.engine.solver import Term, text_of


@dataclass(frozen=True, eq=False)
class Place:
    """Where a thing may be put."""

    term: Term
    thing: str
    support: str
    pose: RigidTransform
    way: str = ""
    """The only recording that puts it there; empty where any one may."""


def places_of(problem: Problem, ways: Sequence[Way]) -> tuple[Place, ...]:
    """Where things may be put: free places, and as far from where they stand as was recorded.

    Args:
        problem: The scene, and what has to stay clear.
        ways: What can be done.
    """
    scene = problem.world.scene
    found = []
    for name in mobile(scene):
        for support in standing_places(scene):
            for number, spot in enumerate(problem.room.places(name, support, problem.goals)):
                pose = RigidTransform.from_components(spot, scene.thing(name).pose.rotation)
                found.append(Place(("spot", name, support, number), name, support, pose))
        for way in ways:
            if any(way.relations(number).get("stand") == ("1", "1") for number in _moving(way)):
                found += _slid(problem, way, scene.thing(name))
    return tuple(found)


def _moving(way: Way) -> list[int]:
    return [number for number in range(len(way.steps)) if way.moves(number)]


def _slid(problem: Problem, way: Way, thing: Thing) -> list[Place]:
    """Where a thing is that goes as far along its support as the recorded one did."""
    scene, path = problem.world.scene, way.source.paths[way.part].translation
    turn = Rotation.from_euler("z", scene.heading - way.source.scene.heading)
    x, y = np.asarray(thing.place)[:2] + turn.apply(path[-1] - path[0])[:2]
    support = scene.support(thing.name)
    there = moved(scene, thing.name, (x, y, thing.place[2]), thing.heading)
    if not support or there.support(thing.name) != support:
        return []
    pose = there.thing(thing.name).pose
    name = way.recording.name
    return [Place(("slid", name, thing.name), thing.name, support, pose, name)]


def world_facts(problem: Problem, places: Sequence[Place]) -> Iterator[str]:
    """Where everything is, what is wanted, and what has no room beside what.

    Args:
        problem: The world.
        places: Where things may be put.
    """
    scene = problem.world.scene
    for side, thing in sorted(problem.world.touching):
        yield _fact("touches_first", side, thing)
    held = {thing for _, thing in problem.world.touching}
    for name in sorted(scene.things):
        support = scene.support(name)
        in_air = name in held and not support
        yield _fact("at_first", name, "air" if in_air else ("start", name))
        if support:
            yield _fact("on", ("start", name), support)
    for condition in problem.wanted:
        yield _fact("wanted", condition)
    for place in places:
        yield _fact("on", place.term, place.support)
        far = np.linalg.norm(place.pose.translation - np.asarray(scene.thing(place.thing).place))
        yield _fact("far", place.term, round(1000.0 * float(far)))
    yield from _meetings(problem, [*_goals(problem), *places])


def _goals(problem: Problem) -> Iterator[Place]:
    for name, pose in problem.goals.items():
        x, y, z = (float(value) for value in pose.translation)
        support = moved(problem.world.scene, name, (x, y, z), 0.0).support(name)
        yield Place(("goal", name), name, support, pose)


def _meetings(problem: Problem, places: Sequence[Place]) -> Iterator[str]:
    """Which places of things have no room beside which of others, or beside where these are."""
    for place in places:
        near = problem.room.near({place.thing: place.pose}, ROOM_M)
        for pair in near:
            for other in pair - {place.thing, place.support}:
                if place.thing in pair and not _agreed(problem, place, other):
                    yield _fact("meets", place.thing, place.term, other, ("start", other))
        for there in places:
            if _may_meet(problem, place, there) and problem.room.meet(
                place.thing, place.pose, there.thing, there.pose
            ):
                yield _fact("meets", place.thing, place.term, there.thing, there.term)


def _agreed(problem: Problem, place: Place, other: str) -> bool:
    """Whether a recording itself puts the thing beside the other one."""
    return place.term == ("goal", place.thing) and other in problem.parts


def _may_meet(problem: Problem, place: Place, there: Place) -> bool:
    things = [problem.world.scene.thing(one.thing) for one in (place, there)]
    apart = np.linalg.norm(place.pose.translation - there.pose.translation)
    far = sum(float(np.linalg.norm(thing.size)) for thing in things) + ROOM_M
    return place.thing != there.thing and bool(apart < far)


def way_facts(problem: Problem, ways: Sequence[Way], places: Sequence[Place]) -> Iterator[str]:
    """What recordings can do with either hand and anything that can be moved.

    Args:
        problem: The world.
        ways: The recordings.
        places: Where things may be put.
    """
    scene = problem.world.scene
    for way in ways:
        name = way.recording.name
        for number, step in enumerate(way.steps):
            yield _fact("step", name, number, step.step.action)
            for relation, (start, end) in way.relations(number).items():
                yield _fact("before", name, number, relation, int(start))
                yield _fact("after", name, number, relation, int(end))
            if way.moves(number):
                yield _fact("moves", name, number)
        yield _fact("mirrored", name, OTHER[way.side])
        for thing in mobile(scene):
            for side in sorted(OTHER):
                yield _fact("way", name, side, thing)
            yield _fact("strange", name, thing, _strangeness(problem, way, scene.thing(thing)))
        lifts = any(way.relations(number).get("stand") == ("0", "1") for number in _moving(way))
        for place in places:
            if place.way == name or (lifts and not place.way):
                yield _fact("room", name, place.thing, place.term)


def _strangeness(problem: Problem, way: Way, thing: Thing) -> int:
    """How many levels up the hierarchy a thing and the recorded one have a kind in common."""
    above = problem.kinds(kind_of(way.source.scene.thing(way.part)))
    own = problem.kinds(kind_of(thing))
    return next((level for level, kind in enumerate(above) if kind in own), len(above))


def _fact(name: str, *arguments: Term) -> str:
    return f"{text_of((name, *arguments))}."
