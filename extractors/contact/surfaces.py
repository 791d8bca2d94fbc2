"""Surfaces of bodies for contact: triangles, their search trees and intersections."""

from collections import OrderedDict
from dataclasses import dataclass
from functools import cached_property

import fcl
import numpy as np
import trimesh
from jaxtyping import Bool, Float

from capar.model import geometry
from capar.model.capture import Shape
from capar.model.geometry import Vector


@dataclass(frozen=True, eq=False)
class Surface:
    """A shape's triangles with what questions of contact need of them, made once."""

    shape: Shape

    @cached_property
    def mesh(self) -> trimesh.Trimesh:
        """The triangles, corners that coincide joined."""
        out = trimesh.Trimesh(
            np.array(self.shape.vertices), np.array(self.shape.faces), process=False
        )
        out.merge_vertices()
        return out

    @cached_property
    def tree(self) -> fcl.BVHModel:
        """The triangles for the proximity library."""
        model = fcl.BVHModel()
        model.beginModel(len(self.mesh.faces), len(self.mesh.vertices))
        vertices = np.ascontiguousarray(self.mesh.vertices, float)
        model.addSubModel(vertices, np.ascontiguousarray(self.mesh.faces))
        model.endModel()
        return model

    @cached_property
    def triangles(self) -> Float[np.ndarray, "faces 3 3"]:
        """Corners of each triangle of that tree [m]."""
        return np.array(self.mesh.triangles, float)

    @cached_property
    def corners(self) -> Float[np.ndarray, "corners 3"]:
        """Its corners from the middle of its box [m], in the body's frame."""
        return np.asarray(self.mesh.vertices, float) - self.centre

    @cached_property
    def triangle_boxes(self) -> Float[np.ndarray, "2 faces 3"]:
        """Lowest and highest corner of each triangle [m], in the body's frame."""
        return np.stack([self.triangles.min(axis=1), self.triangles.max(axis=1)])

    @cached_property
    def closed(self) -> bool:
        """Whether it bounds a solid."""
        return bool(self.mesh.is_watertight and self.mesh.is_winding_consistent)

    @cached_property
    def inverted(self) -> bool:
        """Whether its triangles, which bound a solid, all face inwards."""
        return bool(self.closed and self.mesh.volume < 0.0)

    @cached_property
    def centre(self) -> Vector:
        """Middle of its box [m], in the body's frame."""
        return np.asarray(self.shape.bounds.mean(axis=0))

    @cached_property
    def radius(self) -> float:
        """Distance of the corner furthest from that middle [m]."""
        return float(np.linalg.norm(self.shape.vertices - self.centre, axis=1).max())

    @cached_property
    def faces(self) -> int:
        """The number of triangles."""
        return len(self.shape.faces)

    def contains(self, points: Float[np.ndarray, "points 3"]) -> Bool[np.ndarray, "points"]:
        """Whether points [m, body's frame] lie in the solid; never, if it bounds none."""
        low, high = self.shape.bounds
        inside = geometry.every((points >= low) & (points <= high))
        if self.closed and inside.any():
            inside[inside] = self.mesh.contains(points[inside])
            return np.asarray(inside)
        return np.zeros(len(points), dtype=bool)


_KEPT: OrderedDict[bytes, Surface] = OrderedDict()
"""Surfaces by what they are made of, the latest last."""

_MOST_KEPT = 256


def surface(shape: Shape) -> Surface:
    """The surface of a shape; equal triangles share one, with its search tree."""
    found = _KEPT.pop(shape.digest, None) or Surface(shape)
    _KEPT[shape.digest] = found
    while len(_KEPT) > _MOST_KEPT:
        _KEPT.popitem(last=False)
    return found


def meeting_points(
    first: Float[np.ndarray, "pairs 3 3"], second: Float[np.ndarray, "pairs 3 3"]
) -> Float[np.ndarray, "pairs 3"]:
    """A point on both triangles of each pair; NaN where they do not cut each other.

    It is the middle of the places at which an edge of one goes through the other, which lies on
    the line that the two share. Triangles in one plane count as not cutting.
    """
    edges = np.stack([first, second], axis=1)
    others = np.stack([second, first], axis=1)
    direction = np.roll(edges, -1, axis=2) - edges
    base = others[:, :, :1]
    one, two = others[:, :, 1:2] - base, others[:, :, 2:] - base
    normal = np.cross(one, two)
    offset = edges - base
    with np.errstate(divide="ignore", invalid="ignore"):
        slope = np.einsum("...i,...i", direction, normal)
        parameter = -np.einsum("...i,...i", offset, normal) / slope
        point = offset + parameter[..., None] * direction
        area = np.einsum("...i,...i", normal, normal)
        u = np.einsum("...i,...i", np.cross(point, two), normal) / area
        v = np.einsum("...i,...i", np.cross(one, point), normal) / area
        hit = (parameter >= 0.0) & (parameter <= 1.0) & (u >= 0.0) & (v >= 0.0) & (u + v <= 1.0)
        places = np.where(hit[..., None], point + base, 0.0)
        return places.sum(axis=(1, 2)) / hit.sum(axis=(1, 2))[:, None]
