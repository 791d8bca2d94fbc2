"""Another scene's things in the parts of the recorded ones."""

from collections.abc import Container, Mapping
from dataclasses import replace

import numpy as np
from scipy.spatial.transform import RigidTransform

from capar.body.anthropometry import measures_of
from capar.body.human import Human
from capar.body.scenes import Thing
from capar.model.capture import Capture, Shape, TagType
from capar.regeneration.errors import PlanError
from capar.regeneration.scenes import Scene
from capar.regeneration.sources import Source, moves, scene_of

ASIDE = "_beside"
"""What is put after the name of a thing that has no part and the name of one that has."""

Cast = Mapping[str, str]
"""The thing of the scene that takes each recorded thing's part."""


def captured_scene(capture: Capture) -> Scene:
    """The scene that a capture was recorded in: its things, and where the performer stood.

    Raises:
        PlanError: A thing has no shape, or there is no sensor of the head.
    """
    return scene_of(capture, Human.of(measures_of(capture.agent)))


def cast(
    source: Source, scene: Scene, parts: Cast, goals: Mapping[str, str] | None = None
) -> tuple[Source, Scene]:
    """A recorded performance, and a scene in which others have the parts of its things.

    In both the things bear their recorded names; a thing without a part keeps its own and stands
    in the way.

    Args:
        source: What was recorded.
        scene: Where it is performed.
        parts: The thing of the scene for each recorded one.
        goals: The thing of the scene that each one, by its recorded name, is put on in the end,
            where that is another one than its part says.

    Raises:
        PlanError: A recorded thing has no part, or a fixed one is to be moved.
    """
    check_movable(source, scene, parts)
    named: dict[str, str] = {}
    things: dict[str, Thing] = {}
    for name, thing in source.scene.things.items():
        if name not in parts:
            raise PlanError(f"nothing in the scene has the part of {name!r}")
        actor = scene.thing(parts[name])
        things[name] = replace(_fitted(actor, thing), name=name)
        named[actor.name] = name
    extras = {}
    for name, thing in scene.things.items():
        if name not in named:
            own = name if name not in things else name + ASIDE
            extras[own] = replace(thing, name=own)
            named[name] = own
    count = len(source.times)
    still = {
        name: RigidTransform.concatenate([thing.pose] * count) for name, thing in extras.items()
    }
    ends = {name: named[goal] for name, goal in (goals or {}).items()}
    spots = {
        name: _shifted(scene.spots[parts[name]], scene.thing(parts[name]), things[name])
        for name in things
        if parts[name] in scene.spots
    }
    where = replace(scene, things={**things, **extras}, goals=ends, spots=spots)
    recorded = replace(source.scene, things={**source.scene.things, **extras})
    return replace(source, scene=recorded, paths={**source.paths, **still}), where


def _shifted(
    spot: tuple[float, float, float], actor: Thing, fitted: Thing
) -> tuple[float, float, float]:
    """Where the fitted thing's origin is when the thing's own is at a spot."""
    x, y, z = np.asarray(spot) + np.asarray(fitted.place) - np.asarray(actor.place)
    return float(x), float(y), float(z)


def with_only(source: Source, names: Container[str]) -> Source:
    """A recorded performance without the things that take no part in it.

    Args:
        source: What was recorded.
        names: Of the things that take part.
    """
    scene = source.scene
    things = {name: thing for name, thing in scene.things.items() if name in names}
    paths = {name: path for name, path in source.paths.items() if name in names}
    return replace(source, scene=replace(scene, things=things), paths=paths)


def check_movable(source: Source, scene: Scene, parts: Cast) -> None:
    """Check that nothing fixed has the part of what is taken and moved.

    Raises:
        PlanError: Something has.
    """
    for name, actor in parts.items():
        if scene.thing(actor).tag is TagType.FIXED and moves(source.paths[name]):
            raise PlanError(f"{actor!r} is fixed and cannot be moved; {_movable(scene)}")


def own_names(source: Source, scene: Scene, parts: Cast) -> dict[str, str]:
    """The scene's names of the things that a performance calls by their recorded ones."""
    taken = set(parts.values())
    found = {name: parts[name] for name in source.scene.things if name in parts}
    for name in scene.things:
        if name not in taken:
            found[name if name not in parts else name + ASIDE] = name
    return found


def _movable(scene: Scene) -> str:
    names = sorted(each.name for each in scene.things.values() if each.tag is TagType.MOBILE)
    return f"what can be moved is {', '.join(names)}" if names else "nothing there can be moved"


def _fitted(actor: Thing, part: Thing) -> Thing:
    """The thing with its frame's origin at the same share of its box as the recorded one's."""
    low, high = part.shape.bounds
    share = -low / np.maximum(high - low, 1e-9)
    origin = actor.shape.bounds[0] + share * actor.size
    shape = Shape(
        np.array(actor.shape.vertices) - origin,
        np.array(actor.shape.faces),
        actor.shape.source,
        actor.shape.description,
    )
    x, y, z = (float(each) for each in actor.pose.apply(origin))
    return replace(actor, shape=shape, place=(x, y, z))
