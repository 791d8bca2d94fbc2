"""Scenes of a performer: the shapes and places of objects, and how palms lie on them."""

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from types import MappingProxyType

import numpy as np
import trimesh
from jaxtyping import Float
from scipy.spatial.transform import RigidTransform, Rotation

from capar.body.anthropometry import Measures
from capar.body.human import axes_turn
from capar.body.shapes import PALM, PALM_FROM_WRIST
from capar.model.capture import Shape, TagType
from capar.model.errors import CaparError, UnknownNameError

#: How thick, wide and high a cupboard door is, how far its hinge is to the left of where it is
#: pushed, and how thick the posts next to it are [m]
LEAF_M, HINGE_M, JAMB_M = (0.04, 0.60, 0.50), 0.42, 0.06
#: How deep, wide and high a drawer is, and how thick the boards of its chest are [m]
DRAWER_M, BOARD_M = (0.36, 0.30, 0.12), 0.02
GAP_M = 0.003  # between what moves and what guides it [m]

#: What is left between palm and object, so that surfaces touch and do not cut; how far a hand at an
#: object's side stays above what that stands on; how far the wrist of a hand at a box's side is out
#: of the box, and with it the forearm [m]
AIR_M, CLEAR_M, WRIST_OUT_M = 0.0005, 0.014, 0.022
#: Directions of the fingers tried on a round object, outwards positive [rad]
YAWS = (0.0, -0.35, -0.7, -1.05, 0.35)
#: How far the fingers on an object's near side lean outwards from upright, and how far they rise
#: above the level at its side [rad]
ROLLS, PITCHES = (0.0, 0.7, 1.2, 1.4, 1.57), (0.25, 0.5)


class SceneError(CaparError):
    """A scene that cannot be, or that a performer cannot act in."""


@dataclass(frozen=True, eq=False)
class Thing:
    """One object; its frame is in the middle of its bottom, z up."""

    name: str
    shape: Shape
    place: tuple[float, float, float]  #: Where its bottom's middle stands [m]
    heading: float = 0.0  #: Turn about z [rad]
    tag: TagType = TagType.MOBILE
    kind: str = ""
    round: bool = False  #: Whether it may be taken from any side
    mass_kg: float | None = None

    @property
    def pose(self) -> RigidTransform:
        """``T_world_thing`` at the beginning."""
        return RigidTransform.from_components(self.place, Rotation.from_euler("z", self.heading))

    @property
    def size(self) -> Float[np.ndarray, "3"]:
        """Of its box [m]."""
        return self.shape.size


@dataclass(frozen=True, eq=False)
class Things:
    """Objects by name."""

    things: Mapping[str, Thing]

    def __post_init__(self) -> None:
        """Make the objects read-only."""
        object.__setattr__(self, "things", MappingProxyType(dict(self.things)))

    def thing(self, name: str) -> Thing:
        """The object of that name; UnknownNameError where there is none."""
        if name not in self.things:
            raise UnknownNameError("thing", name, self.things, where="scene")
        return self.things[name]


@dataclass(frozen=True, eq=False)
class Scene(Things):
    """What is there; the floor is z = 0."""

    things: Mapping[str, Thing] = field(default_factory=dict)

    @property
    def table(self) -> Thing | None:
        """The first fixed object, on which the others stand."""
        fixed = (each for each in self.things.values() if each.tag is TagType.FIXED)
        return next(fixed, None)


def scene(*things: Thing) -> Scene:
    """A scene of these objects."""
    return Scene({each.name: each for each in things})


def box(x_m: float, y_m: float, z_m: float) -> Shape:
    """A box standing on its frame's origin."""
    made = trimesh.creation.box(extents=(x_m, y_m, z_m))
    made.apply_translation((0.0, 0.0, 0.5 * z_m))
    return _shape(made, f"box {x_m:g} x {y_m:g} x {z_m:g} m")


def cup(radius_m: float, height_m: float, *, wall_m: float = 0.004) -> Shape:
    """A cup without a handle, open above."""
    wall = trimesh.creation.annulus(radius_m - wall_m, radius_m, height_m, sections=48)
    wall.apply_translation((0.0, 0.0, 0.5 * height_m))
    floor = trimesh.creation.cylinder(radius_m - 0.5 * wall_m, wall_m, sections=48)
    floor.apply_translation((0.0, 0.0, 0.5 * wall_m))
    return _shape(wall + floor, f"cup {2 * radius_m:g} m wide, {height_m:g} m high")


def table(
    height_m: float,
    *,
    near_m: float = 0.30,
    depth_m: float = 0.60,
    width_m: float = 1.20,
    name: str = "table",
) -> Thing:
    """A table top whose near edge is a distance ahead of x = 0 [m]."""
    top = box(depth_m, width_m, 0.03)
    place = (near_m + 0.5 * depth_m, 0.0, height_m - 0.03)
    return Thing(name, top, place, tag=TagType.FIXED, kind="table")


def door_scene(tall_m: float) -> Scene:
    """A closed door between two posts, for a stature [m]; its origin is where it is pushed."""
    thick, wide, high = LEAF_M
    place = (0.30 * tall_m, -0.06 * tall_m, 0.55 * tall_m)
    middle, beside = HINGE_M - 0.5 * wide, 0.5 * (wide + JAMB_M) + GAP_M
    posts = [
        ((thick, JAMB_M, high), (0.5 * thick, middle + aside, 0.5 * high))
        for aside in (beside, -beside)
    ]
    beam = ((thick, wide + 2.0 * (JAMB_M + GAP_M), JAMB_M),
            (0.5 * thick, middle, high + GAP_M + 0.5 * JAMB_M))  # fmt: skip
    leaf = ((thick, wide, high), (0.5 * thick, middle, 0.5 * high))
    return scene(
        Thing("frame", _boxes([*posts, beam], "posts and beam"), place,
              tag=TagType.FIXED, kind="frame"),
        Thing("door", _boxes([leaf], "door leaf"), place, kind="door"),
    )  # fmt: skip


def drawer_scene(tall_m: float) -> Scene:
    """A closed drawer in a chest without a top, for a stature [m]."""
    deep, wide, high = DRAWER_M
    place = (0.32 * tall_m, -0.10 * tall_m, 0.50 * tall_m)
    x, below = 0.5 * deep - 0.1, BOARD_M + GAP_M
    sides = [
        ((deep, BOARD_M, high), (x, sign * (0.5 * (wide + BOARD_M) + GAP_M), 0.5 * high - below))
        for sign in (1.0, -1.0)
    ]
    floor = ((deep, wide + 2.0 * (BOARD_M + GAP_M), BOARD_M), (x, 0.0, -0.5 * BOARD_M - GAP_M))
    back = ((BOARD_M, wide, high), (deep - 0.1 + 0.5 * BOARD_M + GAP_M, 0.0, 0.5 * high - below))
    chest = _boxes([*sides, floor, back], "chest without a top")
    drawer = _boxes([((deep, wide, high), (x, 0.0, 0.5 * high))], "drawer")
    return scene(
        Thing("chest", chest, place, tag=TagType.FIXED, kind="chest"),
        Thing("drawer", drawer, place, kind="drawer"),
    )


def _boxes(
    parts: Sequence[tuple[tuple[float, float, float], tuple[float, float, float]]], description: str
) -> Shape:
    """Boxes of some sizes with their middles somewhere, as one shape [m]."""
    vertices, faces = [], []
    for number, (extents, middle) in enumerate(parts):
        made = trimesh.creation.box(extents=extents)
        vertices.append(np.array(made.vertices) + middle)
        faces.append(np.array(made.faces) + number * len(made.vertices))
    return Shape(np.concatenate(vertices), np.concatenate(faces), description=description)


def _shape(mesh: trimesh.Trimesh, description: str) -> Shape:
    return Shape(np.array(mesh.vertices), np.array(mesh.faces), description=description)


def grips(thing: Thing, side: str, kind: str, measures: Measures) -> list[RigidTransform]:
    """``T_thing_palm`` of the grips that a hand may take, the easiest to state first.

    They are at the ``side`` (thumb up, fingers forward), on ``top``, or on the ``back`` that faces
    the performer (fingers upwards); the object's x axis leads away from the performer.
    """
    sign, hand_m = 1.0 if side == "right" else -1.0, measures["hand_length"]
    low, high = thing.shape.bounds
    out = []
    if kind == "top":  # fingers forward, turned outwards
        for yaw in YAWS:
            fingers = Rotation.from_euler("z", sign * yaw).apply([1.0, 0.0, 0.0])
            place = np.array([0.0, 0.0, high[2] + AIR_M]) - 0.1 * hand_m * fingers
            out.append(_grip(place, fingers, [0.0, 0.0, -1.0]))
    elif kind == "back":  # fingers leaning outwards from upright
        for roll in ROLLS:
            place = np.array([low[0] - AIR_M, 0.0, _clear_height(thing, hand_m, roll)])
            fingers = np.array([0.0, -sign * np.sin(roll), np.cos(roll)])
            out.append(_grip(place, fingers, [1.0, 0.0, 0.0]))
    else:  # turned outwards, then with the fingers raised
        yaws = YAWS if thing.round else YAWS[:1]
        tried = [(yaw, 0.0) for yaw in yaws]
        for yaw, pitch in [*tried, *((yaw, pitch) for yaw in yaws for pitch in PITCHES)]:
            turn = Rotation.from_euler("z", -sign * yaw)
            inwards = turn.apply([0.0, sign, 0.0])
            reach = (-low[1] if side == "right" else high[1]) + AIR_M
            place = np.array([0.0, 0.0, _clear_height(thing, hand_m, pitch)]) - inwards * reach
            if not thing.round:
                wrist = PALM_FROM_WRIST * np.cos(pitch) * hand_m
                place[0] = min(0.0, low[0] - WRIST_OUT_M + wrist)
            if not pitch or place[2] < high[2]:
                fingers = turn.apply([np.cos(pitch), 0.0, np.sin(pitch)])
                out.append(_grip(place, fingers, inwards))
    return out


def _grip(place: np.ndarray, fingers: np.ndarray, inwards: Iterable[float]) -> RigidTransform:
    return RigidTransform.from_components(place, axes_turn(fingers, inwards))


def _clear_height(thing: Thing, hand_m: float, tilt: float) -> float:
    """The middle of an object, or higher if the heel of the hand would be too low [m]."""
    low, high = thing.shape.bounds
    heel = PALM[0] * np.cos(tilt) + 0.44 * np.sin(tilt)
    return float(max(0.5 * (low[2] + high[2]), low[2] + heel * hand_m + CLEAR_M))
