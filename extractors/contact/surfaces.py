"""Surfaces ready for questions of contact: trees of triangles, offsets, point tests."""

from collections import OrderedDict
from dataclasses import dataclass
from functools import cached_property

import fcl
import numpy as np
import trimesh
from jaxtyping import Bool, Float, Int

from capar.model.capture import Shape
from extractors.contact.offset_surfaces import EXACTNESS_M, offset_surface


@dataclass(frozen=True, eq=False)
class OffsetSurface:
    """Triangles at a distance of a surface, and their tree for the proximity library."""

    tree: fcl.BVHModel
    triangles: Float[np.ndarray, "triangles 3 3"]


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
        return tree(np.asarray(self.mesh.vertices), np.asarray(self.mesh.faces))

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
    def centre(self) -> Float[np.ndarray, "3"]:
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

    @cached_property
    def _offset_surfaces(self) -> dict[tuple[float, float], OffsetSurface]:
        return {}

    def offset(self, distance_m: float, *, exactness_m: float = EXACTNESS_M) -> OffsetSurface:
        """The offset surface at a distance [m], made at the first call; at zero, the surface."""
        key = distance_m, exactness_m
        if key not in self._offset_surfaces:
            self._offset_surfaces[key] = self._made_offset(distance_m, exactness_m)
        return self._offset_surfaces[key]

    def _made_offset(self, distance_m: float, exactness_m: float) -> OffsetSurface:
        if distance_m <= 0.0:
            return OffsetSurface(self.tree, self.triangles)
        parts = offset_surface(self.mesh, distance_m, closed=self.closed, exactness_m=exactness_m)
        faces = np.arange(3 * len(parts)).reshape(-1, 3)
        return OffsetSurface(tree(parts.reshape(-1, 3), faces), parts)

    @property
    def keeps_offsets(self) -> bool:
        """Whether offset surfaces are kept for whoever asks again."""
        return bool(self._offset_surfaces)

    def forget_offsets(self) -> None:
        """Keep no offset surfaces until they are asked for again."""
        self._offset_surfaces.clear()

    def contains(self, points: Float[np.ndarray, "points 3"]) -> Bool[np.ndarray, "points"]:
        """Whether points [m, body's frame] lie in the solid; never, if it bounds none."""
        low, high = self.shape.bounds
        inside = ((points >= low) & (points <= high)).all(axis=1)
        if self.closed and inside.any():
            inside[inside] = self.mesh.contains(points[inside])
            return np.asarray(inside)
        return np.zeros(len(points), dtype=bool)


_KEPT: OrderedDict[bytes, Surface] = OrderedDict()
"""Surfaces by what they are made of, the latest last."""

_MOST_KEPT = 256


def surface(shape: Shape) -> Surface:
    """The surface of a shape; equal triangles share one, with its trees and offset surfaces."""
    found = _KEPT.pop(shape.digest, None) or Surface(shape)
    _KEPT[shape.digest] = found
    while len(_KEPT) > _MOST_KEPT:
        _KEPT.popitem(last=False)
    return found


def tree(
    vertices: Float[np.ndarray, "vertices 3"], faces: Int[np.ndarray, "faces 3"]
) -> fcl.BVHModel:
    """Triangles for the proximity library."""
    model = fcl.BVHModel()
    model.beginModel(len(faces), len(vertices))
    model.addSubModel(np.ascontiguousarray(vertices, float), np.ascontiguousarray(faces))
    model.endModel()
    return model
