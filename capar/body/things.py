"""Things in a performer's scene: what they look like, where they stand, where hands take them."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from types import MappingProxyType

import numpy as np
import trimesh
from jaxtyping import Float
from scipy.spatial.transform import RigidTransform, Rotation

from capar.model.capture import Shape, TagType
from capar.model.errors import CaparError, UnknownNameError


class SceneError(CaparError):
    """A scene that cannot be, or that a performer cannot act in."""


@dataclass(frozen=True, eq=False)
class Thing:
    """One object; its frame is in the middle of its bottom, z up."""

    name: str
    shape: Shape
    place: tuple[float, float, float]
    """Where its bottom's middle stands [m]."""

    heading: float = 0.0
    """Turn about z [rad]."""

    tag: TagType = TagType.MOBILE
    kind: str = ""
    round: bool = False
    """Whether it may be taken from any side."""

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
    """Things by name."""

    things: Mapping[str, Thing]

    def __post_init__(self) -> None:
        """Make the things read-only."""
        object.__setattr__(self, "things", MappingProxyType(dict(self.things)))

    def thing(self, name: str) -> Thing:
        """The thing of that name.

        Raises:
            UnknownNameError: There is none.
        """
        if name not in self.things:
            raise UnknownNameError("thing", name, self.things, where="scene")
        return self.things[name]


@dataclass(frozen=True, eq=False)
class Scene(Things):
    """What is there; the floor is z = 0."""

    things: Mapping[str, Thing] = field(default_factory=dict)

    @property
    def table(self) -> Thing | None:
        """The first fixed thing, on which the others stand."""
        fixed = (each for each in self.things.values() if each.tag is TagType.FIXED)
        return next(fixed, None)


def scene(*things: Thing) -> Scene:
    """A scene of these things."""
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


def _shape(mesh: trimesh.Trimesh, description: str) -> Shape:
    return Shape(np.array(mesh.vertices), np.array(mesh.faces), description=description)
