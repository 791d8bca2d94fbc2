"""Scenes that are not as they were recorded: from a file, or drawn at random by a seed."""

import tomllib
from collections.abc import Mapping
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np

from capar.model.capture import TagType
from capar.model.errors import FileError
from capar.regeneration.fastening import bases, moved_with, resized_with
from capar.regeneration.scenes import Scene, mobile, moved, raised, stack, taken_with


@dataclass(frozen=True)
class Draw:
    """The ranges from which a scene is drawn."""

    heights_m: tuple[float, float]
    """Of the table [m]."""

    sizes: tuple[float, float]
    """Of what can be moved, of the recorded [1]."""

    aside_m: float
    """How far from its place a thing is drawn along each axis [m]."""


USUAL = Draw((0.6, 1.1), (0.7, 1.4), 0.1)
WIDE = Draw((0.5, 1.25), (0.6, 1.5), 0.3)
"""Wide enough that not everything is in reach of every body."""

DRAWS = {"usual": USUAL, "wide": WIDE}
"""By the names under which they are asked for."""

ATTEMPTS = 200
APART_M = 0.02
"""How far drawn things are apart at least [m]."""

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
    table = _table(path)
    return _standing(path, _with_objects(path, table, scene), table.get("stance", {}), "[stance]")


def read_scenes(path: Path, scenes: Mapping[str, Scene]) -> dict[str, Scene]:
    """Likewise of several performers: ``[stance]`` is the first one's, ``[stance.NAME]`` of NAME.

    Args:
        path: Of the file.
        scenes: As recorded, by the agent's name, the first one first.

    Raises:
        FileError: The file cannot be read, or says something else.
        UnknownNameError: It names an object that is not there.
    """
    table = _table(path)
    stance = dict(table.get("stance", {}))
    own = {name: stance.pop(name) for name in scenes if name in stance}
    first = next(iter(scenes))
    _check_keys(path, "[stance]", stance, STANCE_KEYS | set(scenes))
    own[first] = {**stance, **own.get(first, {})}
    return {
        name: _standing(
            path, _with_objects(path, table, scene), own.get(name, {}), f"[stance.{name}]"
        )
        for name, scene in scenes.items()
    }


def _table(path: Path) -> dict[str, Any]:
    try:
        table = tomllib.loads(path.read_text("utf-8"))
    except (tomllib.TOMLDecodeError, UnicodeDecodeError) as error:
        raise FileError(path, f"is no TOML: {error}.", "See `capar regenerate --help`.") from None
    _check_keys(path, "the file", table, {"stance", "object"})
    return table


def _with_objects(path: Path, table: dict[str, Any], scene: Scene) -> Scene:
    for name, row in table.get("object", {}).items():
        scene = _changed(path, scene, name, row)
    return scene


def _standing(path: Path, scene: Scene, stance: dict[str, Any], where: str) -> Scene:
    """The scene with the performer where a table says."""
    _check_keys(path, where, stance, STANCE_KEYS)
    x, y = _numbers(path, "stance.place", stance.get("place", scene.place), 2)
    heading = _number(path, "heading_deg", stance.get("heading_deg", np.degrees(scene.heading)))
    floor = _number(path, "floor_m", stance.get("floor_m", scene.floor_m))
    stays = scene.stays or "place" in stance
    turn = float(np.radians(heading))
    return replace(scene, place=(x, y), heading=turn, floor_m=floor, stays=stays)


def drawn_scene(scene: Scene, rng: np.random.Generator, draw: Draw = USUAL) -> Scene:
    """A scene with other sizes and places, its first fixed thing as high as a table may be.

    Args:
        scene: As it was recorded.
        rng: What draws.
        draw: The ranges from which it draws.

    What bears a door or a drawer is drawn with it, in size and place, and as much higher or lower;
    things that a hand takes together are drawn as one.
    """
    for name in mobile(scene):
        if name not in scene.together:
            scene = resized_with(scene, name, float(rng.uniform(*draw.sizes)))
    for name in bases(scene):
        scene = _drawn_base(scene, name, rng, draw)
    fixed = [
        name
        for name, thing in scene.things.items()
        if thing.tag is TagType.FIXED and name not in scene.fastened.values()
    ]
    if fixed:
        thing = scene.thing(fixed[0])
        top = thing.place[2] + float(thing.shape.bounds[1, 2])
        scene = raised(scene, fixed[0], float(rng.uniform(*draw.heights_m)) - top)
    for _ in range(ATTEMPTS):
        found = scene
        for name in mobile(scene):
            dx, dy = rng.uniform(-draw.aside_m, draw.aside_m, 2)
            if scene.support(name) in mobile(scene) or name in scene.together:
                continue  # it goes along with what bears it, or with what is taken together
            beside = [o for n in taken_with(scene, name) for o in (n, *stack(scene, n))]
            for shifted in (name, *stack(scene, name), *beside):
                x, y, z = scene.thing(shifted).place
                heading = scene.thing(shifted).heading
                found = moved(found, shifted, (x + dx, y + dy, z), heading)
        if _sound(scene, found):
            return found
    return scene


def _drawn_base(scene: Scene, name: str, rng: np.random.Generator, draw: Draw) -> Scene:
    scene = resized_with(scene, name, float(rng.uniform(*draw.sizes)))
    thing = scene.thing(name)
    dx, dy, dz = (float(value) for value in rng.uniform(-draw.aside_m, draw.aside_m, 3))
    x, y, z = thing.place
    return moved_with(scene, name, (x + dx, y + dy, z + dz), thing.heading)


def _sound(before: Scene, after: Scene) -> bool:
    """Whether everything stands on what it stood on, and apart from the others."""
    names = mobile(after)
    boxes = {
        n: after.thing(n).pose.apply(np.array(after.thing(n).shape.vertices))[:, :2] for n in names
    }
    for number, first in enumerate(names):
        if after.support(first) != before.support(first):
            return False
        for second in names[number + 1 :]:
            if second in stack(after, first) or first in stack(after, second):
                continue
            if after.together.get(second) == first or after.together.get(first) == second:
                continue
            one, two = boxes[first], boxes[second]
            gaps = np.maximum(one.min(axis=0) - two.max(axis=0), two.min(axis=0) - one.max(axis=0))
            if gaps.max() < APART_M:
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
    _check_keys(path, f"[object.{name}]", row, KEYS)
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


def _check_keys(path: Path, where: str, row: dict[str, Any], known: set[str]) -> None:
    for key in row:
        if key not in known:
            raise FileError(
                path, f"unknown key {key!r} in {where}.", f"There are: {', '.join(sorted(known))}."
            )


def _number(path: Path, key: str, value: Any) -> float:
    return _numbers(path, key, [value], 1)[0]


def _numbers(path: Path, key: str, value: Any, count: int) -> tuple[float, ...]:
    many = "a number" if count == 1 else f"a list of {count} numbers"
    fault = FileError(path, f"{key} = {value!r}.", f"It is {many}.")
    try:
        out = tuple(float(each) for each in value)
    except (TypeError, ValueError):
        raise fault from None
    if len(out) != count or not np.isfinite(out).all():
        raise fault
    return out
