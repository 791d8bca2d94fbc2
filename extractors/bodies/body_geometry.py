"""A body as seen from outside: its middle, its outermost points and its box in the world."""

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from functools import cached_property
from typing import TypeVar
from weakref import WeakKeyDictionary

import numpy as np
import trimesh
from jaxtyping import Float, Int
from scipy.spatial import ConvexHull, QhullError

from capar.model.calibration import BodyCalibration
from capar.model.capture import Sensor, Shape, TagObject
from extractors.bodies.poses import Poses, poses_of, rotation_matrices
from extractors.thresholds import Thresholds

DIRECTIONS = 64
"""Directions in which a body's outermost corners are taken [1]: 25 degrees lie between them."""


BLOCK = 4096
"""How many frames are worked on at once where each takes kilobytes."""

AROUND = np.asarray(trimesh.creation.icosphere(subdivisions=2).vertices)
"""Unit directions all around, evenly."""


@dataclass(frozen=True, eq=False)
class BodyGeometry:
    """A body with its shape and its poses; what follows from them is computed once, when asked."""

    name: str
    shape: Shape | None
    poses: Poses

    @cached_property
    def orientations(self) -> Float[np.ndarray, "frames 4"]:
        """Unit quaternions w x y z, low-passed."""
        return self.poses.settled.orientations if self.poses.rests else self._smooth[1]

    @cached_property
    def middles(self) -> Float[np.ndarray, "frames 3"]:
        """The middle of its box in the world [m], or its origin where it has no shape.

        Those of a body that rests are one row, repeated without memory of its own.
        """
        places = self.poses.settled.positions if self.poses.rests else self._smooth[0]
        if self.shape is None:
            return places
        offset = self.shape.bounds.mean(axis=0)
        frames = slice(0, 1) if self.poses.rests else slice(None)
        middles = places[frames] + self.turns_at(frames) @ offset
        return np.broadcast_to(middles, places.shape)

    @property
    def _smooth(self) -> tuple[np.ndarray, np.ndarray]:
        return self.poses.smooth.positions, self.poses.smooth.orientations

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
        if self.shape is None:
            return None
        return once(_PLANES, self.shape, _planes)

    @cached_property
    def boxes(self) -> tuple[Float[np.ndarray, "frames 3"], Float[np.ndarray, "frames 3"]]:
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
_PLANES: WeakKeyDictionary[Shape, Float[np.ndarray, "planes 4"] | None] = WeakKeyDictionary()
"""Of shapes that were asked for before: every window of a live recording asks again."""

_Found = TypeVar("_Found")


def once(
    known: WeakKeyDictionary[Shape, _Found], shape: Shape, find: Callable[[Shape], _Found]
) -> _Found:
    """What is found of a shape: sought once, and kept as long as the shape is.

    Args:
        known: What was found of shapes before; it is kept there.
        shape: The surface of a body, in the body's own frame.
        find: What finds it by nothing but the shape.
    """
    if shape not in known:
        known[shape] = find(shape)
    return known[shape]


def _corners(shape: Shape) -> Float[np.ndarray, "corners 3"]:
    points = np.asarray(shape.vertices) - shape.bounds.mean(axis=0)
    best = np.argmax(_directions() @ points.T, axis=1)
    return np.asarray(points[np.unique(best)])


def _planes(shape: Shape) -> Float[np.ndarray, "planes 4"] | None:
    points = np.asarray(shape.vertices) - shape.bounds.mean(axis=0)
    try:
        equations = ConvexHull(points).equations
    except (QhullError, ValueError):
        return None
    planes = np.unique(equations.round(6), axis=0)
    if len(planes) <= len(AROUND):
        return np.asarray(planes)
    return np.hstack([AROUND, -(points @ AROUND.T).max(axis=0)[:, None]])
