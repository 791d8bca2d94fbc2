"""The scene that a motion is made for: things where they stand, and where the performer stands."""

from collections.abc import Mapping
from dataclasses import dataclass, field, replace

import numpy as np
from jaxtyping import Float

from capar.body.scenes import Thing, Things
from capar.model.capture import Shape, TagType

FEET = ("_foot", "_toes")
LOWER_ARMS = ("_hand", "_fingers", "_fingertips", "_thumb", "_forearm")
"""How the names of these parts of the body end."""

ON_M = 0.02
"""A thing whose lowest point is this near above another one's top stands on it [m]."""


@dataclass(frozen=True, eq=False)
class Scene(Things):
    """Things, the floor, and the stance."""

    place: tuple[float, float]
    """Where the performer stands [m]."""

    heading: float
    """Which way the performer faces, from x towards y [rad]."""

    floor_m: float = 0.0
    """Height of the floor [m]."""

    stays: bool = False
    """Whether the performer has to stand just there."""

    goals: Mapping[str, str] = field(default_factory=dict)
    """What a thing is put on in the end, where that is not what the recording says."""

    spots: Mapping[str, tuple[float, float, float]] = field(default_factory=dict)
    """Where the frame of a thing is in the end, where that is stated [m]."""

    entered: frozenset[str] = frozenset()
    """Things that stop neither hands nor forearms, since their sizes are only assumed."""

    fastened: Mapping[str, str] = field(default_factory=dict)
    """By the name of what is on a hinge or a rail, the fixed thing that bears that."""

    together: Mapping[str, str] = field(default_factory=dict)
    """By the name of what lies in a hand beside another thing, that thing."""

    def stops(self, part: str, name: str) -> bool:
        """Whether a thing stops a part of the body: no ground stops the feet that stand on it."""
        if part.endswith(FEET):
            thing = self.thing(name)
            top = _corners(thing)[1, 2]
            return thing.tag is not TagType.FIXED or abs(top - self.floor_m) >= ON_M
        return not (part.endswith(LOWER_ARMS) and name in self.entered)

    def support(self, name: str) -> str:
        """What a thing stands on; empty where nothing is beneath it."""
        thing = self.thing(name)
        low, middle = _corners(thing)[0, 2], np.asarray(thing.place)[:2]
        for other in self.things.values():
            near, far = _corners(other)
            beneath = abs(low - far[2]) < ON_M and other.name != name
            if beneath and (near[:2] <= middle).all() and (middle <= far[:2]).all():
                return other.name
        return ""


def moved(scene: Scene, name: str, place: tuple[float, float, float], heading: float) -> Scene:
    """The scene with a thing elsewhere; what stands on it stays where it is."""
    thing = replace(scene.thing(name), place=place, heading=heading)
    return replace(scene, things={**scene.things, name: thing})


def resized(scene: Scene, name: str, factor: float) -> Scene:
    """The scene with a thing of another size, its lowest point as high as before.

    What stands on it stands on its new top.
    """
    thing, riders = scene.thing(name), stack(scene, name)
    shape = scaled(thing.shape, factor)
    x, y, z = thing.place
    z += float(thing.shape.bounds[0, 2] - shape.bounds[0, 2])
    changed = replace(thing, shape=shape, place=(x, y, z))
    higher = float(shape.size[2] - thing.shape.size[2])
    scene = replace(scene, things={**scene.things, name: changed})
    for rider in riders:
        scene = _lifted(scene, rider, higher)
    return scene


def taken_with(scene: Scene, name: str) -> list[str]:
    """What a hand takes together with a thing by which it is led."""
    return [other for other, lead in scene.together.items() if lead == name]


def raised(scene: Scene, name: str, by_m: float) -> Scene:
    """The scene with a thing, and all that stands or is fastened on it, higher by so much [m]."""
    fastened = [thing for thing in scene.things if scene.fastened.get(thing) == name]
    for raised_one in dict.fromkeys((name, *stack(scene, name), *fastened)):
        scene = _lifted(scene, raised_one, by_m)
    return scene


def stack(scene: Scene, name: str) -> list[str]:
    """What stands on a thing, and what stands on that, from below."""
    out: list[str] = []
    below = [name]
    while below:
        below = [above for above in scene.things if scene.support(above) in below]
        out += below
    return out


def _lifted(scene: Scene, name: str, by_m: float) -> Scene:
    thing = scene.thing(name)
    x, y, z = thing.place
    return moved(scene, name, (x, y, z + by_m), thing.heading)


def scaled(shape: Shape, factor: float) -> Shape:
    """A shape enlarged about its frame's origin."""
    return Shape(
        np.array(shape.vertices) * factor,
        np.array(shape.faces),
        shape.source,
        f"{shape.description} x {factor:g}",
    )


def mobile(scene: Scene) -> list[str]:
    """Names of what can be moved and is not fastened to something, sorted."""
    return sorted(
        thing.name
        for thing in scene.things.values()
        if thing.tag is TagType.MOBILE and thing.name not in scene.fastened
    )


def _corners(thing: Thing) -> Float[np.ndarray, "2 3"]:
    spots = thing.pose.apply(np.array(thing.shape.vertices))
    return np.stack([spots.min(axis=0), spots.max(axis=0)])
