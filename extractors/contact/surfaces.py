"""Surfaces of bodies for contact: triangles, intersections, surfaces offset by a tolerance."""

from collections import OrderedDict
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import cached_property, lru_cache

import fcl
import numpy as np
import trimesh
from jaxtyping import Bool, Float, Int

from capar.model.capture import Shape
from capar.model.geometry import Vector

EXACTNESS_M = 0.00004
"""How far an offset surface may lie from its true distance [m]."""


def offset_surface(
    mesh: trimesh.Trimesh, distance_m: float, *, closed: bool, exactness_m: float = EXACTNESS_M
) -> Float[np.ndarray, "triangles 3 3"]:
    """Triangles that bound all points within a distance [m] of a surface, as a loose set.

    None lies further out than that distance and the exactness; together they leave no way in
    that is not within the exactness of that distance.

    ``mesh``: the surface. ``distance_m``: the distance [m]. ``closed``: whether it bounds a solid,
    so that nothing is needed on its inner side. ``exactness_m``: how far the offset surface may lie
    from its true distance [m].
    """
    vertices = np.asarray(mesh.vertices, float)
    faces = np.asarray(mesh.faces)
    normals = _normals(vertices[faces])
    real = np.linalg.norm(normals, axis=1) > 0.5
    faces, normals = faces[real], normals[real]
    outer = normals if closed else None
    sides = (1.0,) if closed else (1.0, -1.0)
    return np.concatenate(
        [
            *(vertices[faces] + side * distance_m * normals[:, None] for side in sides),
            _strips(vertices, faces, normals, distance_m, exactness_m, closed=closed),
            _caps(vertices, faces, outer, distance_m, exactness_m),
        ]
    )


def _normals(corners: Float[np.ndarray, "faces 3 3"]) -> Float[np.ndarray, "faces 3"]:
    return _unit(np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]))


def _unit(vectors: Float[np.ndarray, "many 3"]) -> Float[np.ndarray, "many 3"]:
    """The vectors at length one; those of no length stay."""
    length = np.linalg.norm(vectors, axis=1, keepdims=True)
    return np.divide(vectors, length, out=np.zeros_like(vectors), where=length > 1e-20)


def _strips(
    vertices: Float[np.ndarray, "vertices 3"],
    faces: Int[np.ndarray, "faces 3"],
    normals: Float[np.ndarray, "faces 3"],
    distance_m: float,
    exactness_m: float,
    *,
    closed: bool,
) -> Float[np.ndarray, "triangles 3 3"]:
    """Flats of a cylinder about each edge, where no adjacent face is nearer than the edge."""
    pairs = np.sort(faces[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2), axis=1)
    edges, owner, counts = np.unique(pairs, axis=0, return_inverse=True, return_counts=True)
    owner = owner.reshape(-1)
    along = _unit(vertices[edges[:, 1]] - vertices[edges[:, 0]])
    inward = vertices[faces[:, [2, 0, 1]].reshape(-1)] - vertices[edges[owner, 0]]
    inward -= np.einsum("ij,ij->i", inward, along[owner])[:, None] * along[owner]
    inward = _unit(inward)
    one = np.argsort(owner, kind="stable")[np.r_[0, np.cumsum(counts)[:-1]]] // 3
    x, y = normals[one], np.cross(normals[one], along)
    count = _flats(distance_m, exactness_m)
    width = 2.0 * np.pi / count
    angles = width * np.arange(count)
    cosine, sine = np.cos(angles + 0.5 * width)[:, None], np.sin(angles + 0.5 * width)[:, None]
    middles = cosine * x[:, None] + sine * y[:, None]
    margin = np.sin(0.5 * width) + 1e-9
    fits = np.einsum("isj,ij->is", middles[owner], inward) <= margin
    free = np.ones((len(edges), count), dtype=bool)
    np.logical_and.at(free, owner, fits)
    if closed:
        outward = np.zeros((len(edges), count), dtype=bool)
        outer = np.einsum("isj,ij->is", middles[owner], np.repeat(normals, 3, axis=0)) >= -margin
        np.logical_or.at(outward, owner, outer)
        free &= outward & _bent(owner, normals, len(edges), distance_m, exactness_m)[:, None]
    edge, flat = np.nonzero(free)
    radius = distance_m * 2.0 / (1.0 + np.cos(0.5 * width))
    left, right = (
        radius * (np.cos(angle)[:, None] * x[edge] + np.sin(angle)[:, None] * y[edge])
        for angle in (angles[flat], angles[flat] + width)
    )
    begin, end = vertices[edges[edge, 0]], vertices[edges[edge, 1]]
    lower = np.stack([begin + left, end + left, end + right], axis=1)
    upper = np.stack([begin + left, end + right, begin + right], axis=1)
    return np.concatenate([lower, upper])


def _bent(
    owner: Int[np.ndarray, "sides"],
    normals: Float[np.ndarray, "faces 3"],
    edges: int,
    distance_m: float,
    exactness_m: float,
) -> Bool[np.ndarray, "edges"]:
    """Edges whose faces, moved out, leave a slit wider than the exactness."""
    total = np.zeros((edges, 3))
    np.add.at(total, owner, np.repeat(normals, 3, axis=0))
    # Two unit normals at an angle sum to twice the cosine of its half.
    slit = 2.0 * np.sqrt(np.maximum(1.0 - 0.25 * (total**2).sum(axis=1), 0.0)) * distance_m
    return slit > 0.5 * exactness_m


def _flats(distance_m: float, exactness_m: float) -> int:
    """Into how many flats a circle is cut to stay within the exactness."""
    share = min(2.0 * exactness_m / distance_m, 1.0)
    return max(8, int(np.ceil(np.pi / np.arccos(1.0 - share))))


@lru_cache(maxsize=16)
def _ball(level: int) -> tuple[np.ndarray, np.ndarray, float, float]:
    """Corners and middles of a unit ball's faces, their angular radius, and the least depth."""
    corners = np.asarray(trimesh.creation.icosphere(level).triangles, float)
    middles = corners.mean(axis=1)
    depth = np.linalg.norm(middles, axis=1)
    middles /= depth[:, None]
    spread = np.arccos(np.clip(np.einsum("ikj,ij->ik", corners, middles), -1.0, 1.0)).max()
    return corners, middles, float(spread), float(depth.min())


def _caps(
    vertices: Float[np.ndarray, "vertices 3"],
    faces: Int[np.ndarray, "faces 3"],
    outer: Float[np.ndarray, "faces 3"] | None,
    distance_m: float,
    exactness_m: float,
) -> Float[np.ndarray, "triangles 3 3"]:
    """Parts of a ball about each corner, where no adjacent edge is nearer than the corner."""
    level = next(
        (n for n in range(1, 6) if (1.0 - _ball(n)[3]) / 2.0 * distance_m <= exactness_m), 5
    )
    corners, middles, spread, depth = _ball(level)
    margin = np.sin(spread) + 1e-9
    rays = np.concatenate([faces[:, [0, 1]], faces[:, [1, 2]], faces[:, [2, 0]]])
    rays = np.unique(np.concatenate([rays, rays[:, ::-1]]), axis=0)
    along = _unit(vertices[rays[:, 1]] - vertices[rays[:, 0]])
    found = []
    for some in _blocks(rays[:, 0]):
        own, starts = np.unique(rays[some, 0], return_index=True)
        free = np.logical_and.reduceat(along[some] @ middles.T <= margin, starts, axis=0)
        found.append((own, free))
    own = np.concatenate([each for each, _ in found])
    free = np.concatenate([each for _, each in found])
    vertex, part = np.nonzero(free)
    vertex = own[vertex]
    if outer is not None:
        keep = _outward(vertex, middles[part], faces, outer, margin)
        vertex, part = vertex[keep], part[keep]
    return vertices[vertex][:, None] + distance_m * 2.0 / (1.0 + depth) * corners[part]


def _blocks(owners: Int[np.ndarray, "many"], *, size: int = 4096) -> Iterator[slice]:
    """Slices of sorted owners, none of whom is in two."""
    low = 0
    while low < len(owners):
        high = min(low + size, len(owners))
        high = int(np.searchsorted(owners, owners[high - 1], side="right"))
        yield slice(low, high)
        low = high


def _outward(
    vertex: Int[np.ndarray, "parts"],
    directions: Float[np.ndarray, "parts 3"],
    faces: Int[np.ndarray, "faces 3"],
    normals: Float[np.ndarray, "faces 3"],
    margin: float,
) -> Bool[np.ndarray, "parts"]:
    """Whether a direction at a corner is on the outer side of some face there."""
    order = np.argsort(faces.reshape(-1), kind="stable")
    sorted_corners = faces.reshape(-1)[order]
    first = np.searchsorted(sorted_corners, vertex, side="left")
    last = np.searchsorted(sorted_corners, vertex, side="right")
    out = np.zeros(len(vertex), dtype=bool)
    for step in range(int((last - first).max(initial=0))):
        here = np.minimum(first + step, last - 1)
        normal = normals[order[here] // 3]
        out |= np.einsum("ij,ij->i", normal, directions) >= -margin
    return out


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


_NEXT, _LAST = np.array([1, 2, 0]), np.array([2, 0, 1])


def meeting_points(
    first: Float[np.ndarray, "pairs 3 3"], second: Float[np.ndarray, "pairs 3 3"]
) -> Float[np.ndarray, "pairs 3"]:
    """A point on both triangles of each pair; NaN where they do not cut each other.

    It is the middle of the places at which an edge of one goes through the other, which lies on
    the line that the two share. Triangles in one plane count as not cutting.
    """
    edges = np.stack([first, second], axis=1)
    others = np.stack([second, first], axis=1)
    direction = edges[:, :, _NEXT] - edges
    base = others[:, :, :1]
    one, two = others[:, :, 1:2] - base, others[:, :, 2:] - base
    normal = _cross(one, two)
    offset = edges - base
    with np.errstate(divide="ignore", invalid="ignore"):
        slope = np.einsum("...i,...i", direction, normal)
        parameter = -np.einsum("...i,...i", offset, normal) / slope
        point = offset + parameter[..., None] * direction
        area = np.einsum("...i,...i", normal, normal)
        u = np.einsum("...i,...i", _cross(point, two), normal) / area
        v = np.einsum("...i,...i", _cross(one, point), normal) / area
        hit = (parameter >= 0.0) & (parameter <= 1.0) & (u >= 0.0) & (v >= 0.0) & (u + v <= 1.0)
        places = np.where(hit[..., None], point + base, 0.0)
        return places.sum(axis=(1, 2)) / hit.sum(axis=(1, 2))[:, None]


Point = tuple[float, float, float]


def meeting_point(
    first: Sequence[Sequence[float]], second: Sequence[Sequence[float]]
) -> Point | None:
    """The same for one pair of triangles given as plain numbers, twenty times as fast."""
    found = [*_piercings(first, second), *_piercings(second, first)]
    if not found:
        return None
    count = len(found)
    return (
        sum(point[0] for point in found) / count,
        sum(point[1] for point in found) / count,
        sum(point[2] for point in found) / count,
    )


def _piercings(
    edges: Sequence[Sequence[float]], other: Sequence[Sequence[float]]
) -> Iterator[Point]:
    """Where edges of one triangle go through the other (Moeller and Trumbore's test)."""
    (ax, ay, az), (bx, by, bz), (cx, cy, cz) = other
    ux, uy, uz, vx, vy, vz = bx - ax, by - ay, bz - az, cx - ax, cy - ay, cz - az
    nx, ny, nz = uy * vz - uz * vy, uz * vx - ux * vz, ux * vy - uy * vx
    area = nx * nx + ny * ny + nz * nz
    for index in range(3):
        px, py, pz = edges[index]
        qx, qy, qz = edges[index - 2]
        wx, wy, wz = qx - px, qy - py, qz - pz
        slope = wx * nx + wy * ny + wz * nz
        if slope == 0.0 or area == 0.0:
            continue
        ox, oy, oz = px - ax, py - ay, pz - az
        parameter = -(ox * nx + oy * ny + oz * nz) / slope
        if not 0.0 <= parameter <= 1.0:
            continue
        x, y, z = ox + parameter * wx, oy + parameter * wy, oz + parameter * wz
        u = ((y * vz - z * vy) * nx + (z * vx - x * vz) * ny + (x * vy - y * vx) * nz) / area
        v = ((uy * z - uz * y) * nx + (uz * x - ux * z) * ny + (ux * y - uy * x) * nz) / area
        if u >= 0.0 and v >= 0.0 and u + v <= 1.0:
            yield x + ax, y + ay, z + az


def _cross(
    one: Float[np.ndarray, "*some 3"], two: Float[np.ndarray, "*others 3"]
) -> Float[np.ndarray, "*broadcast 3"]:
    """The cross product; for few vectors, which come by the thousand, faster than the library's."""
    return one[..., _NEXT] * two[..., _LAST] - one[..., _LAST] * two[..., _NEXT]
