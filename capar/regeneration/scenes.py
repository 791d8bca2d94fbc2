"""The scene of a motion: objects, floor and stance, and changes to it by file or by seed."""

import itertools
import tomllib
from collections.abc import Iterable, Mapping, Set
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any

import numpy as np
from jaxtyping import Float

from capar.body.virtual_scenes import Thing, Things
from capar.model.capture import Shape, TagType
from capar.model.errors import CaparError, FileError

FEET = ("_foot", "_toes")
LOWER_ARMS = ("_hand", "_fingers", "_fingertips", "_thumb", "_forearm", "_1", "_2", "_3")
"""How the names of these parts of the body end; bones of fingers are numbered."""

ON_M = 0.02  # An object whose lowest point is this near above another one's top stands on it [m].


@dataclass(frozen=True, eq=False)
class Scene(Things):
    """Objects, the floor, and the stance."""

    place: tuple[float, float]
    """Where the performer stands [m]."""

    heading: float
    """Which way the performer faces, from x towards y [rad]."""

    floor_m: float = 0.0
    """Height of the floor [m]."""

    stays: bool = False
    """Whether the performer has to stand just there."""

    goals: Mapping[str, str] = field(default_factory=dict)
    """What an object is put on in the end, where that is not what the recording says."""

    spots: Mapping[str, tuple[float, float, float]] = field(default_factory=dict)
    """Where the frame of an object is in the end, where that is stated [m]."""

    entered: frozenset[str] = frozenset()
    """Objects that stop neither hands nor forearms, since their sizes are only assumed."""

    fastened: Mapping[str, str] = field(default_factory=dict)
    """By the name of what is on a hinge or a rail, the fixed object that bears that."""

    together: Mapping[str, str] = field(default_factory=dict)
    """By the name of what lies in a hand beside another object, that object."""

    def stops(self, part: str, name: str) -> bool:
        """Whether an object stops a part of the body: no ground stops the feet that stand on it."""
        if part.endswith(FEET):
            thing = self.thing(name)
            top = _corners(thing)[1, 2]
            return thing.tag is not TagType.FIXED or abs(top - self.floor_m) >= ON_M
        return not (part.endswith(LOWER_ARMS) and name in self.entered)

    def support(self, name: str) -> str:
        """What an object stands on; empty where nothing is beneath it."""
        thing = self.thing(name)
        low, middle = _corners(thing)[0, 2], np.asarray(thing.place)[:2]
        for other in self.things.values():
            near, far = _corners(other)
            beneath = abs(low - far[2]) < ON_M and other.name != name
            if beneath and (near[:2] <= middle).all() and (middle <= far[:2]).all():
                return other.name
        return ""


class PlanError(CaparError):
    """A motion that this body cannot do in this scene, or that the capture does not determine."""


def moved(scene: Scene, name: str, place: tuple[float, float, float], heading: float) -> Scene:
    """The scene with an object elsewhere; what stands on it stays where it is."""
    thing = replace(scene.thing(name), place=place, heading=heading)
    return replace(scene, things={**scene.things, name: thing})


def moved_with(scene: Scene, name: str, place: tuple[float, float, float], heading: float) -> Scene:
    """The scene with an object elsewhere, and what goes with it as it was beside it."""
    old = scene.thing(name)
    changed = moved(scene, name, place, heading)
    by = changed.thing(name).pose * old.pose.inv()
    for rider in _riders(scene, name):
        thing = scene.thing(rider)
        x, y, z = (float(value) for value in by.apply(thing.place))
        changed = moved(changed, rider, (x, y, z), thing.heading + heading - old.heading)
    return changed


def resized(scene: Scene, name: str, factor: float) -> Scene:
    """The scene with an object of another size, its lowest point as high as before.

    What stands on it stands on its new top.
    """
    thing = scene.thing(name)
    shape = scaled(thing.shape, factor)
    x, y, z = thing.place
    z += float(thing.shape.bounds[0, 2] - shape.bounds[0, 2])
    higher = _lifted(scene, stack(scene, name), float(shape.size[2] - thing.shape.size[2]))
    changed = replace(thing, shape=shape, place=(x, y, z))
    return replace(higher, things={**higher.things, name: changed})


def resized_with(scene: Scene, name: str, factor: float) -> Scene:
    """The scene with an object of another size, and what goes with it likewise."""
    old = scene.thing(name)
    changed = resized(scene, name, factor)
    for rider in _riders(scene, name):
        local = factor * old.pose.inv().apply(scene.thing(rider).place)
        x, y, z = (float(value) for value in changed.thing(name).pose.apply(local))
        thing = replace(resized(scene, rider, factor).thing(rider), place=(x, y, z))
        changed = replace(changed, things={**changed.things, rider: thing})
    return changed


def raised(scene: Scene, name: str, by_m: float) -> Scene:
    """The scene with an object, and all that stands or is fastened on it, higher by so much [m]."""
    fastened = [thing for thing in scene.things if scene.fastened.get(thing) == name]
    return _lifted(scene, dict.fromkeys((name, *stack(scene, name), *fastened)), by_m)


def _lifted(scene: Scene, names: Iterable[str], by_m: float) -> Scene:
    for name in names:
        x, y, z = scene.thing(name).place
        scene = moved(scene, name, (x, y, z + by_m), scene.thing(name).heading)
    return scene


def stack(scene: Scene, name: str) -> list[str]:
    """What stands on an object, and what stands on that, from below."""
    out, below = list[str](), [name]
    while below:
        below = [above for above in scene.things if scene.support(above) in below]
        out += below
    return out


def taken_with(scene: Scene, name: str) -> list[str]:
    """What a hand takes together with an object by which it is led."""
    return [other for other, lead in scene.together.items() if lead == name]


def _riders(scene: Scene, name: str) -> list[str]:
    fastened = [rider for rider, base in scene.fastened.items() if base == name]
    return [*fastened, *taken_with(scene, name)]


def scaled(shape: Shape, factor: float) -> Shape:
    """A shape enlarged about its frame's origin."""
    description = f"{shape.description} x {factor:g}"
    vertices = np.array(shape.vertices) * factor
    return Shape(vertices, np.array(shape.faces), shape.source, description)


def mobile(scene: Scene) -> list[str]:
    """Names of what can be moved and is not fastened to something, sorted."""
    free = (thing for name, thing in scene.things.items() if name not in scene.fastened)
    return sorted(thing.name for thing in free if thing.tag is TagType.MOBILE)


def _corners(thing: Thing) -> Float[np.ndarray, "2 3"]:
    spots = thing.pose.apply(np.array(thing.shape.vertices))
    return np.stack([spots.min(axis=0), spots.max(axis=0)])


HEIGHTS_M, SIZES, ASIDE_M = (0.6, 1.1), (0.7, 1.4), 0.1
"""Scenes are drawn with tables so high [m], objects of so many times their size [1], and so far
from their places along each axis [m]."""

ATTEMPTS = 200
APART_M = 0.02  # How far drawn objects are apart at least [m].

KEYS = {"position", "turn_deg", "size", "raise_m"}
STANCE_KEYS = {"place", "heading_deg", "floor_m"}


def read_scene(path: Path, scene: Scene) -> Scene:
    """The recorded scene with the changes that a TOML file states.

    ``[stance]`` has ``place`` [m], ``heading_deg`` and ``floor_m``; ``[object.NAME]`` has ``size``
    (a factor), ``position`` of its origin [m], ``turn_deg`` about the vertical, and ``raise_m``,
    which takes along what stands on it.

    Raises:
        FileError: The file cannot be read, or says something else.
        UnknownNameError: It names an object that is not there.
    """
    return read_scenes(path, {"": scene})[""]


def read_scenes(path: Path, scenes: Mapping[str, Scene]) -> dict[str, Scene]:
    """Likewise of several performers: ``[stance]`` is the first one's, ``[stance.NAME]`` of NAME.

    Raises:
        FileError: The file cannot be read, or says something else.
        UnknownNameError: It names an object that is not there.
    """
    table = read_toml(path, {"stance", "object"})
    stance = dict(table.get("stance", {}))
    own = {name: stance.pop(name) for name in scenes if name in stance}
    check_keys(path, "[stance]", stance, STANCE_KEYS | {name for name in scenes if name})
    first, out = next(iter(scenes)), dict(scenes)
    for name, stated in own.items():
        check_keys(path, f"[stance.{name}]", stated, STANCE_KEYS)
    own[first] = {**stance, **own.get(first, {})}
    for name in scenes:
        for thing, row in table.get("object", {}).items():
            out[name] = _changed(path, out[name], thing, row)
        scene, here = out[name], own.get(name, {})
        x, y = _numbers(path, "stance.place", here.get("place", scene.place), 2)
        degrees = here.get("heading_deg", np.degrees(scene.heading))
        out[name] = replace(
            scene,
            place=(x, y),
            heading=float(np.radians(_number(path, "heading_deg", degrees))),
            floor_m=_number(path, "floor_m", here.get("floor_m", scene.floor_m)),
            stays=scene.stays or "place" in here,
        )
    return out


def read_toml(path: Path, keys: Set[str]) -> dict[str, Any]:
    """The table of a TOML file that has some keys at most.

    Raises:
        FileError: It cannot be read, or has another key.
    """
    try:
        table = tomllib.loads(path.read_text("utf-8"))
    except (OSError, tomllib.TOMLDecodeError, UnicodeDecodeError) as error:
        raise FileError(path, f"is no TOML: {error}.", "See `capar regenerate --help`.") from None
    check_keys(path, "the file", table, keys)
    return table


def drawn_scene(scene: Scene, rng: np.random.Generator) -> Scene:
    """A scene with other sizes and places, its first fixed object as high as a table may be.

    What bears a door or a drawer is drawn with it, in size and place, and as much higher or lower;
    objects that a hand takes together are drawn as one.
    """
    for name in mobile(scene):
        if name not in scene.together:
            scene = resized_with(scene, name, float(rng.uniform(*SIZES)))
    bases = sorted(set(scene.fastened.values()))
    for name in bases:
        scene = resized_with(scene, name, float(rng.uniform(*SIZES)))
        x, y, z = (
            float(value) for value in scene.thing(name).place + rng.uniform(-ASIDE_M, ASIDE_M, 3)
        )
        scene = moved_with(scene, name, (x, y, z), scene.thing(name).heading)
    fixed = [
        n for n, thing in scene.things.items() if thing.tag is TagType.FIXED and n not in bases
    ]
    if fixed:
        top = scene.thing(fixed[0]).place[2] + float(scene.thing(fixed[0]).shape.bounds[1, 2])
        scene = raised(scene, fixed[0], float(rng.uniform(*HEIGHTS_M)) - top)
    for _ in range(ATTEMPTS):
        found = scene
        for name in mobile(scene):
            dx, dy = rng.uniform(-ASIDE_M, ASIDE_M, 2)
            if scene.support(name) in mobile(scene) or name in scene.together:
                continue  # it goes along with what bears it, or with what is taken together
            for each in (name, *taken_with(scene, name)):
                for shifted in (each, *stack(scene, each)):
                    x, y, z = scene.thing(shifted).place
                    heading = scene.thing(shifted).heading
                    found = moved(found, shifted, (x + dx, y + dy, z), heading)
        if _sound(scene, found):
            return found
    return scene


def _sound(before: Scene, after: Scene) -> bool:
    """Whether everything stands on what it stood on, and apart from the others."""
    names = mobile(after)
    if any(after.support(name) != before.support(name) for name in names):
        return False
    corners = {name: _corners(after.thing(name))[:, :2] for name in names}
    for first, second in itertools.combinations(names, 2):
        (low, high), (other_low, other_high) = corners[first], corners[second]
        goes_along = (
            second in (*stack(after, first), after.together.get(first))
            or first in (*stack(after, second), after.together.get(second))
        )  # fmt: skip
        if not goes_along and np.maximum(low - other_high, other_low - high).max() < APART_M:
            return False
    return True


def _changed(path: Path, scene: Scene, name: str, row: Any) -> Scene:
    scene.thing(name)
    if name in scene.fastened:
        base = scene.fastened[name]
        raise FileError(
            path, f"{name!r} hangs on {base!r} and keeps its place on that.",
            f"Change [object.{base}]; {name!r} goes along.",
        )  # fmt: skip
    if not isinstance(row, dict):
        raise FileError(path, f"object.{name} is no table.", f"Write [object.{name}].")
    check_keys(path, f"[object.{name}]", row, KEYS)
    if "size" in row:
        factor = _number(path, "size", row["size"])
        if factor <= 0.0:
            raise FileError(path, f"size = {factor} of {name!r}.", "A size is a factor above zero.")
        scene = resized_with(scene, name, factor)
    if "raise_m" in row:
        scene = raised(scene, name, _number(path, "raise_m", row["raise_m"]))
    thing = scene.thing(name)
    x, y, z = _numbers(path, f"{name}.position", row.get("position", thing.place), 3)
    turn = np.radians(_number(path, "turn_deg", row.get("turn_deg", 0.0)))
    return moved_with(scene, name, (x, y, z), thing.heading + float(turn))


def check_keys(path: Path, where: str, row: Mapping[str, Any], known: Set[str]) -> None:
    """A table of a file has known keys only.

    Raises:
        FileError: It has another one.
    """
    for key in row:
        if key not in known:
            raise FileError(
                path, f"unknown key {key!r} in {where}.", f"There are: {', '.join(sorted(known))}."
            )


def _number(path: Path, key: str, value: Any) -> float:
    return _numbers(path, key, [value], 1)[0]


def _numbers(path: Path, key: str, value: Any, count: int) -> tuple[float, ...]:
    many = "a number" if count == 1 else f"a list of {count} numbers"
    try:
        out = tuple(float(each) for each in value)
    except (TypeError, ValueError):
        out = ()
    if len(out) != count or not np.isfinite(out).all():
        raise FileError(path, f"{key} = {value!r}.", f"It is {many}.")
    return out
