"""Offset surfaces: all points at a distance of a surface, as loose sets of triangles.

The offset surface at distance r bounds all points within r of a surface: two bodies come within r
exactly if one meets the other's offset surface, or lies inside it. A tree of triangles answers
whether two sets meet far faster than it computes a distance. The triangles need not be joined:
every face moved out by r, an arc of a cylinder along each edge, a part of a ball about each
corner. That is the Minkowski sum with a ball before its union, which the question does not need;
so it costs milliseconds where the sum takes seconds, and an open surface has one as well.
"""

from collections.abc import Iterator
from functools import lru_cache

import numpy as np
import trimesh
from jaxtyping import Bool, Float, Int

EXACTNESS_M = 0.00004
"""How far an offset surface may lie from its true distance [m]."""


def offset_surface(
    mesh: trimesh.Trimesh, distance_m: float, *, closed: bool, exactness_m: float = EXACTNESS_M
) -> Float[np.ndarray, "triangles 3 3"]:
    """Triangles that bound all points within a distance [m] of a surface, as a loose set.

    None lies further out than that distance and the exactness; together they leave no way in
    that is not within the exactness of that distance.

    Args:
        mesh: The surface.
        distance_m: The distance [m].
        closed: Whether it bounds a solid, so that nothing is needed on its inner side.
        exactness_m: How far the offset surface may lie from its true distance [m].
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
