"""Surfaces of bodies for contact: triangles, their search trees and intersections."""

from collections import OrderedDict
from dataclasses import dataclass
from functools import cached_property
from typing import TypeAlias

import fcl
import numpy as np
from embreex.mesh_construction import TriangleMesh
from embreex.rtcore_scene import EmbreeScene
from jaxtyping import Bool, Float, Int, Num

from capar.model import geometry
from capar.model.capture import Shape
from capar.model.geometry import Vector

Mesh: TypeAlias = tuple[np.ndarray, np.ndarray]
"""Corners [m], and triangles as the numbers of their corners."""

PER_METRE = 1e8
"""Corners are one that are equal to parts of a metre, so many [1/m]."""

NOTHING = 1e-13
"""A vector that is no longer has no direction [m, of a triangle m2]."""

STEP_M, STEP = 1e-8, 1e-6
"""How far behind a triangle a ray goes on: at least so many metres, and that share of the diagonal
of its surface."""

GLIDES = 1e-5
"""A ray does not go through a triangle with whose normal it has a smaller cosine [1]."""

MOST_HITS = 100
"""How often a ray goes on [1]."""

SIGHTS = (
    (0.4395064455, 0.617598629942, 0.652231566745),
    (0.652231566745, -0.4395064455, 0.617598629942),
)
"""Unit vectors along which a point is judged to be inside, the second where the first fails."""


@dataclass(frozen=True, eq=False)
class Surface:
    """A shape's triangles with what questions of contact need of them, made once."""

    shape: Shape

    @cached_property
    def mesh(self) -> Mesh:
        """Corners [m] and triangles, corners that coincide joined."""
        return joined(np.asarray(self.shape.vertices, float), np.asarray(self.shape.faces))

    @cached_property
    def tree(self) -> fcl.BVHModel:
        """The triangles for the proximity library."""
        vertices, faces = self.mesh
        model = fcl.BVHModel()
        model.beginModel(len(faces), len(vertices))
        model.addSubModel(np.ascontiguousarray(vertices), np.ascontiguousarray(faces))
        model.endModel()
        return model

    @cached_property
    def triangles(self) -> Float[np.ndarray, "faces 3 3"]:
        """Corners of each triangle of that tree [m]."""
        vertices, faces = self.mesh
        return vertices[faces]

    @cached_property
    def corners(self) -> Float[np.ndarray, "corners 3"]:
        """Its corners from the middle of its box [m], in the body's frame."""
        return self.mesh[0] - self.centre

    @cached_property
    def crosses(self) -> Float[np.ndarray, "faces 3"]:
        """The cross product of two edges of each triangle, outwards [m2]."""
        edges = np.diff(self.triangles, axis=1)
        return np.cross(edges[:, 0], edges[:, 1])

    @cached_property
    def normals(self) -> Float[np.ndarray, "faces 3"]:
        """Unit normals of the triangles, outwards; zero of one without area."""
        area = _length(self.crosses)
        inverse = np.divide(1.0, area, where=area > NOTHING, out=np.zeros_like(area))
        return self.crosses * inverse[:, None]

    @cached_property
    def triangle_boxes(self) -> Float[np.ndarray, "2 faces 3"]:
        """Lowest and highest corner of each triangle [m], in the body's frame."""
        return triangle_boxes(self.triangles)

    @cached_property
    def closed(self) -> bool:
        """Whether it bounds a solid: each edge is one of two triangles, once in either sense."""
        vertices, faces = self.mesh
        edges = faces[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2)
        named = edges.min(axis=1) * len(vertices) + edges.max(axis=1)
        order = np.argsort(named, kind="stable")
        named = named[order]
        if (
            len(named) % 2
            or (named[::2] != named[1::2]).any()
            or (named[1:-1:2] == named[2::2]).any()
        ):
            return False
        return bool((edges[order[::2], 1] == edges[order[1::2], 0]).all())

    @cached_property
    def inverted(self) -> bool:
        """Whether its triangles, which bound a solid, all face inwards."""
        volume = np.sum(self.crosses[:, 0] * self.triangles.sum(axis=1)[:, 0])
        return bool(self.closed and volume < 0.0)

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
            inside[inside] = self._within(points[inside])
            return np.asarray(inside)
        return np.zeros(len(points), dtype=bool)

    def _within(self, points: Float[np.ndarray, "points 3"]) -> Bool[np.ndarray, "points"]:
        """Whether rays from points of its box go through its triangles an odd number of times.

        Forwards and backwards have to agree; else it is asked by another direction, and a point
        from which a ray meets nothing is outside.
        """
        low, high = self.mesh[0].min(axis=0), self.mesh[0].max(axis=0)
        inside = ((points > low) & (points < high)).all(axis=1)
        open_ = np.flatnonzero(inside)
        inside[:] = False
        for way in SIGHTS:
            ways = np.tile(way, (len(open_), 1))
            _, rays = self.hits(np.tile(points[open_], (2, 1)), np.concatenate([ways, -ways]))
            count = np.bincount(rays, minlength=2 * len(open_)).reshape(2, -1)
            odd = count % 2 == 1
            agree = odd[0] == odd[1]
            inside[open_[agree]] = odd[0][agree]
            open_ = open_[~agree & (count > 0).all(axis=0)]
            if not open_.size:
                break
        return inside

    @cached_property
    def _scene(self) -> tuple[EmbreeScene, Vector, float]:
        """The triangles for the library of rays, from their lowest corner, a hundred across."""
        vertices, faces = self.mesh
        low = vertices.min(axis=0)
        scale = 100.0 / self._across
        scene = EmbreeScene()
        scaled = ((vertices - low) * scale).astype(np.float32)
        TriangleMesh(scene=scene, vertices=scaled, indices=faces.astype(np.int32))
        return scene, low, scale

    @cached_property
    def _across(self) -> float:
        """The diagonal of its box [m]."""
        diagonal = float((np.ptp(self.mesh[0], axis=0) ** 2).sum() ** 0.5)
        return diagonal if diagonal > NOTHING else 1.0

    def hits(
        self,
        origins: Float[np.ndarray, "rays 3"],
        directions: Float[np.ndarray, "rays 3"],
        *,
        first: bool = False,
    ) -> tuple[Float[np.ndarray, "hits 3"], Int[np.ndarray, "hits"]]:
        """The places at which rays go through the triangles [m], and the ray of each place.

        A ray goes on a step behind each place, and twice as far each time that it meets the same
        triangle again. One that glides along a triangle does not go through it.

        Args:
            origins: Where each ray begins [m], in the body's frame.
            directions: Where each goes; of any length.
            first: Whether only the nearest place of each ray is sought.
        """
        scene, low, scale = self._scene
        at, ways = np.array(origins, float), np.asarray(directions, float)
        far = _length(ways)
        ways = ways * np.divide(1.0, far, where=far > NOTHING, out=far)[:, None]
        step = ways * max(STEP_M, STEP * self._across)
        steps = step.copy()
        before = np.full(len(at), -1)
        going = np.arange(len(at))
        places, rays = [np.zeros((0, 3))], [np.zeros(0, np.int64)]
        for _ in range(MOST_HITS):
            scaled = ((at[going] - low) * scale).astype(np.float32)
            face = scene.run(scaled, ways[going].astype(np.float32))
            going, face = going[face != -1], face[face != -1]
            if not going.size:
                break
            again = before[going] == face
            before[going] = face
            stuck, going, face = going[again], going[~again], face[~again]
            slope = _along(ways[going], self.normals[face])
            through = np.abs(slope) > GLIDES
            going, face, slope = going[through], face[through], slope[through]
            ahead = _along(self.triangles[face, 0] - at[going], self.normals[face])
            place = ways[going] * (ahead / slope)[:, None] + at[going]
            places.append(place)
            rays.append(going)
            if first:
                break
            at[going], steps[going] = place + steps[going], step[going]
            steps[stuck] *= 2.0
            at[stuck] += steps[stuck]
            going = np.concatenate([going, stuck])
        return np.concatenate(places), np.concatenate(rays)


def joined(vertices: Float[np.ndarray, "vertices 3"], faces: Int[np.ndarray, "faces 3"]) -> Mesh:
    """The same triangles with each corner once, in its order; corners of none are left out."""
    used = np.unique(faces)
    rounded = (vertices[used] * PER_METRE).round().astype(np.int64)
    which, first = equal_rows(rounded)
    order = np.argsort(first)
    number = np.empty(len(vertices), np.int64)
    number[used] = np.argsort(order)[which]
    return vertices[used[first[order]]], number[faces]


def equal_rows(
    rows: Num[np.ndarray, "rows columns"],
) -> tuple[Int[np.ndarray, "rows"], Int[np.ndarray, "different"]]:
    """The number of each row, equal ones having one, and where each number stands first.

    ``numpy.unique`` compares rows field by field, in six times the time.
    """
    order = np.lexsort(rows.T)
    new = np.ones(len(rows), dtype=bool)
    new[1:] = ~geometry.every(rows[order[1:]] == rows[order[:-1]])
    which = np.empty(len(rows), np.int64)
    which[order] = np.cumsum(new) - 1
    return which, order[new]


def _along(
    one: Float[np.ndarray, "some 3"], other: Float[np.ndarray, "some 3"]
) -> Float[np.ndarray, "some"]:
    return np.asarray((one * other) @ np.ones(3))


def _length(vectors: Float[np.ndarray, "some 3"]) -> Float[np.ndarray, "some"]:
    return np.asarray(np.sqrt(_along(vectors, vectors)))


def triangle_boxes(
    triangles: Float[np.ndarray, "triangles 3 3"],
) -> Float[np.ndarray, "2 triangles 3"]:
    """Lowest and highest corner of each triangle; a minimum along an axis takes ten times as long.

    ``triangles``: their corners [m].
    """
    one, two, three = triangles[:, 0], triangles[:, 1], triangles[:, 2]
    low = np.minimum(np.minimum(one, two), three)
    return np.stack([low, np.maximum(np.maximum(one, two), three)])


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
