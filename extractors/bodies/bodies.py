"""Bodies of a capture as extractors see them: geometry in the world, objects, and the trunk."""

from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass, replace
from functools import cached_property
from typing import TypeVar
from weakref import WeakKeyDictionary

import numpy as np
from jaxtyping import Float, Int
from scipy.spatial import ConvexHull, QhullError

from capar.model.calibration import BodyCalibration, Calibration
from capar.model.capture import Capture, Sensor, Shape, TagObject, TagType
from capar.model.geometry import Places, Turns, Vector
from capar.model.observation import ObservedObject
from extractors.bodies.poses import Poses, poses_of, rotation_matrices
from extractors.thresholds import Thresholds

DIRECTIONS = 64
"""Directions in which a body's outermost corners are taken [1]: 25 degrees lie between them."""


BLOCK = 4096
"""How many frames are worked on at once where each takes kilobytes."""


def _around() -> Float[np.ndarray, "162 3"]:
    """Unit directions all around, evenly: the corners of an icosahedron, its edges halved twice."""
    short, long = 0.5257311121191336, 0.85065080835204
    corners = np.array([[s, t, 0.0] for s in (-short, short) for t in (-long, long)])
    around = np.concatenate([corners, np.roll(corners, 1, axis=1), np.roll(corners, 2, axis=1)])
    for _ in range(2):
        apart = np.linalg.norm(around[:, None] - around, axis=2) + 2.0 * np.eye(len(around))
        one, other = np.nonzero(np.triu(apart < 1.3 * apart.min()))
        around = np.concatenate([around, (around[one] + around[other]) / 2.0])
        length = np.sqrt(around**2 @ np.ones(3))[:, None]
        around += around / length * (1.0 - length)
    return around


AROUND = _around()
"""Unit directions all around, evenly."""


@dataclass(frozen=True, eq=False)
class BodyGeometry:
    """A body with its shape and its poses; what follows from them is computed once, when asked."""

    name: str
    shape: Shape | None
    poses: Poses

    @cached_property
    def orientations(self) -> Turns:
        """Unit quaternions w x y z, low-passed."""
        return (self.poses.settled if self.poses.rests else self.poses.smooth).orientations

    @cached_property
    def middles(self) -> Places:
        """The middle of its box in the world [m], or its origin where it has no shape.

        Those of a body that rests are one row, repeated without memory of its own.
        """
        places = (self.poses.settled if self.poses.rests else self.poses.smooth).positions
        if self.shape is None:
            return places
        offset = self.shape.bounds.mean(axis=0)
        frames = slice(0, 1) if self.poses.rests else slice(None)
        middles = places[frames] + self.turns_at(frames) @ offset
        return np.broadcast_to(middles, places.shape)

    def turns_at(self, frames: Int[np.ndarray, "some"] | slice) -> Float[np.ndarray, "some 3 3"]:
        """Rotation matrices from the body's axes to the world's; made again, being large."""
        return rotation_matrices(self.orientations[frames])

    def turn(self, frame: int) -> Float[np.ndarray, "3 3"]:
        """That matrix at one frame."""
        return self.turns_at(slice(frame, frame + 1))[0]

    @cached_property
    def corners(self) -> Float[np.ndarray, "corners 3"]:
        """Its outermost points from its middle [m], in its own axes; one point without a shape."""
        if self.shape is None:
            return np.zeros((1, 3))
        return once(_CORNERS, self.shape, _corners)

    @cached_property
    def planes(self) -> Float[np.ndarray, "planes 4"] | None:
        """Its convex hull as outward normals and offsets from its middle; None without volume.

        A hull of very many sides, as of a scan, is described by the planes that lean on it from
        directions all around, which stand off it by no more than a hundredth of its size.
        """
        return None if self.shape is None else once(_HULLS, self.shape, _hull)[0]

    @property
    def volume_m3(self) -> float:
        """The volume of its convex hull [m3]; zero without one."""
        return 0.0 if self.shape is None else once(_HULLS, self.shape, _hull)[1]

    @cached_property
    def boxes(self) -> tuple[Places, Places]:
        """Lowest and highest corner of its box along the world's axes at each frame [m].

        Those of a body that rests are one row, repeated without memory of its own.
        """
        middles = self.middles[:1] if self.poses.rests else self.middles
        low, high = middles.copy(), middles.copy()
        for block in blocks(len(low)):
            spread = self.turns_at(block) @ self.corners.T
            low[block] += spread.min(axis=2)
            high[block] += spread.max(axis=2)
        shape = self.middles.shape
        return np.broadcast_to(low, shape), np.broadcast_to(high, shape)


def geometry_of(
    body: Sensor | TagObject, thresholds: Thresholds, known: BodyCalibration | None = None
) -> BodyGeometry:
    """The geometry of a sensor or an object, with the poses that its stream gives."""
    return BodyGeometry(body.name, body.shape, poses_of(body, thresholds, known))


def blocks(count: int) -> Iterator[slice]:
    """So many things in few at a time, for what takes much memory for each."""
    for first in range(0, count, BLOCK):
        yield slice(first, min(first + BLOCK, count))


def _directions() -> Float[np.ndarray, "directions 3"]:
    """Directions spread evenly over a ball (a spiral of equal areas), and the six of the axes."""
    index = np.arange(DIRECTIONS) + 0.5
    height = 1.0 - 2.0 * index / DIRECTIONS
    angle = np.pi * (1.0 + np.sqrt(5.0)) * index
    radius = np.sqrt(1.0 - height**2)
    ball = np.stack([radius * np.cos(angle), radius * np.sin(angle), height], axis=1)
    corners = np.array([[x, y, z] for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)], float)
    return np.concatenate([ball, np.eye(3), -np.eye(3), corners / np.sqrt(3.0)])


_CORNERS: WeakKeyDictionary[Shape, Float[np.ndarray, "corners 3"]] = WeakKeyDictionary()
_Hull = tuple[Float[np.ndarray, "planes 4"] | None, float]
_HULLS: WeakKeyDictionary[Shape, _Hull] = WeakKeyDictionary()
"""Of shapes that were asked for before: every window of a live recording asks again."""

_Found = TypeVar("_Found")


def once(
    known: WeakKeyDictionary[Shape, _Found], shape: Shape, find: Callable[[Shape], _Found]
) -> _Found:
    """What is found of a shape: sought once, and kept as long as the shape is.

    ``shape``: the surface of a body, in the body's own frame. ``find``: what finds it by nothing
    but the shape.
    """
    if shape not in known:
        known[shape] = find(shape)
    return known[shape]


def _corners(shape: Shape) -> Float[np.ndarray, "corners 3"]:
    points = np.asarray(shape.vertices) - shape.bounds.mean(axis=0)
    best = np.argmax(_directions() @ points.T, axis=1)
    return np.asarray(points[np.unique(best)])


def _hull(shape: Shape) -> _Hull:
    points = np.asarray(shape.vertices) - shape.bounds.mean(axis=0)
    try:
        hull = ConvexHull(points)
    except (QhullError, ValueError):
        return None, 0.0
    rounded = hull.equations.round(6)
    # A scan's hull has thousands of planes, of which some are many already.
    planes = np.unique(rounded[: 8 * len(AROUND)], axis=0)
    if len(planes) <= len(AROUND):
        planes = np.unique(rounded, axis=0)
    if len(planes) > len(AROUND):
        planes = np.hstack([AROUND, -(points @ AROUND.T).max(axis=0)[:, None]])
    return planes, float(hull.volume)


@dataclass(frozen=True, eq=False)
class Bodies:
    """The bodies of one capture; an object that is also a sensor is in both."""

    sensors: dict[str, BodyGeometry]
    objects: dict[str, BodyGeometry]
    parts: dict[str, tuple[str, ...]]
    """Names of the sensors on each end-effector that several ride on, its own first."""

    def on_end_effector(self, name: str) -> tuple[BodyGeometry, ...]:
        """What rides on the end-effector that a sensor acts for: its own body, then its parts."""
        return tuple(self.sensors[part] for part in self.parts.get(name, (name,)))

    @property
    def poses(self) -> dict[str, Poses]:
        """The poses of every body by name; of an object that is also a sensor, the object's."""
        return {name: body.poses for name, body in (self.sensors | self.objects).items()}

    def without_caches(self) -> "Bodies":
        """The same bodies without what was computed of them, which takes more memory than poses."""
        return Bodies(
            {name: replace(body) for name, body in self.sensors.items()},
            {name: replace(body) for name, body in self.objects.items()},
            self.parts,
        )

    def forget_smooth_poses(self) -> None:
        """Keep no low-passed poses until they are asked for again."""
        for poses in self.poses.values():
            poses.forget()

    def named(self, name: str) -> BodyGeometry:
        """The object of that name, or else the sensor."""
        return self.objects[name] if name in self.objects else self.sensors[name]


def bodies_of(
    capture: Capture, thresholds: Thresholds, calibration: Calibration | None = None
) -> Bodies:
    """The bodies of a capture, gaps filled and noise taken out.

    Raises:
        UnknownNameError: The calibration lacks one of them.
    """
    sensors, objects = {}, {}
    for sensor in capture.sensors:
        known = calibration.sensor(sensor.name) if calibration else None
        sensors[sensor.name] = geometry_of(sensor, thresholds, known)
    for thing in capture.objects:
        known = calibration.tag_object(thing.name) if calibration else None
        sensor_of_it = next((one for one in capture.sensors if one.stream is thing.stream), None)
        if sensor_of_it and thing.tag is not TagType.FIXED:
            poses = sensors[sensor_of_it.name].poses
            objects[thing.name] = BodyGeometry(thing.name, thing.shape, poses)
        else:
            objects[thing.name] = geometry_of(thing, thresholds, known)
    wholes = {sensor.part_of for sensor in capture.sensors if sensor.part_of}
    parts = {name: tuple(part.name for part in capture.parts_of(name)) for name in sorted(wholes)}
    return Bodies(sensors, objects, parts)


def observed_object(each: TagObject) -> ObservedObject:
    """A tag object with its size and its pose in the first frame in which it is known."""
    known = np.flatnonzero(~each.stream.lost)
    frame = int(known[0]) if known.size else 0
    position = each.stream.positions[frame] if known.size else np.zeros(3)
    turn = each.stream.orientations[frame] if known.size else np.array([1.0, 0.0, 0.0, 0.0])
    size = each.shape.size if each.shape else np.zeros(3)
    x, y, z = map(float, position)
    w, i, j, k = map(float, turn)
    length, width, height = map(float, size)
    return ObservedObject(
        name=each.name,
        kind=each.kind or each.name,
        tag=each.tag.value,
        size_m=(length, width, height),
        shape=each.shape.description if each.shape else "",
        assumed=each.assumed,
        position_m=(x, y, z),
        orientation=(w, i, j, k),
    )


TRUNK = ("pelvis", "l5", "hips", "waist", "spine", "torso", "trunk", "chest", "neck")
"""General types of sensors on the trunk, those first that are nearest to the body's middle."""


def trunk_sensor(sensors: Iterable[Sensor]) -> Sensor | None:
    """The trunk's sensor that is nearest to the body's middle, of one agent's; None without one."""
    by_type = {sensor.end_effector: sensor for sensor in sensors if sensor.end_effector in TRUNK}
    return next((by_type[kind] for kind in TRUNK if kind in by_type), None)


def from_trunk(body: BodyGeometry, trunk: BodyGeometry, upright: Vector) -> Places:
    """The middle of a body from the trunk's origin [m], by axes that turn with the trunk.

    They turn about the vertical only, and do not lean: who bends has not raised a hand.

    ``trunk``: the trunk; where either is lost, the answer is NaN. ``upright``: the axis of the
    trunk that points up while it stands, in its own frame.
    """
    stream = trunk.poses.smooth
    offset = body.middles - stream.positions
    ahead = _levelled(rotation_matrices(stream.orientations), upright)
    x = ahead[:, 0] * offset[:, 0] + ahead[:, 1] * offset[:, 1]
    y = ahead[:, 0] * offset[:, 1] - ahead[:, 1] * offset[:, 0]
    return np.stack([x, y, offset[:, 2]], axis=1)


def _levelled(
    rotations: Float[np.ndarray, "frames 3 3"], upright: Vector
) -> Float[np.ndarray, "frames 2"]:
    """The direction on the level of some axis across ``upright``, as if it had been righted.

    The shortest rotation from ``a`` to ``b`` takes ``v``, which is across ``a``, to
    ``v - (b v) (a + b) / (1 + a b)``.
    """
    across = np.eye(3)[int(np.argmin(np.abs(upright)))]
    across = across - (across @ upright) * upright
    up, side = rotations @ upright, rotations @ (across / np.linalg.norm(across))
    with np.errstate(divide="ignore", invalid="ignore"):
        share = side[:, 2] / (1.0 + up[:, 2])
    level = side[:, :2] - share[:, None] * up[:, :2]
    return np.asarray(level / np.linalg.norm(level, axis=1, keepdims=True))
