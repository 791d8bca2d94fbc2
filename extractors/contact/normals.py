"""Patches of surfaces in contact and their normals."""

from collections import OrderedDict
from dataclasses import dataclass
from functools import lru_cache
from itertools import product

import numpy as np
from jaxtyping import Float, Int
from scipy.spatial import cKDTree

from capar.model import geometry
from capar.model.geometry import Vector
from extractors.bodies.bodies import BodyGeometry
from extractors.contact.surfaces import Surface, surface, triangle_boxes
from extractors.thresholds import Thresholds

SPACING_M = 0.0025
"""How far places on a surface are apart at least [m]: half of what skin gives way."""

MANY_PLACES = 400
"""So many places on the side of the box in which bodies meet are enough [1]."""

MOST_STEPS = 256
"""Into so many steps an edge is divided at most [1]: a table of more than a metre more coarsely."""

BOX_DEPTHS = 3.0
"""Places further from the other body's box than so many depths of a patch are left out [1]."""

SAMPLED = 16
"""One place in so many says how near the surfaces are at least."""

ROUNDED = 1e-9
"""By this share bounds are wider than what is sought within them [1], as numbers are rounded."""

LEAST_SHARE = 0.01
"""Faces that cancel each other to less than this share of the patch's area press nowhere [1]."""

Box = Float[np.ndarray, "2 3"]
"""Lowest and highest corner [m]."""


@dataclass(frozen=True, eq=False)
class Places:
    """Places spread over a surface, each with the unit normal and the area that it stands for."""

    points: Float[np.ndarray, "places 3"]
    normals: Float[np.ndarray, "places 3"]
    areas: Float[np.ndarray, "places"]
    outward: bool = True
    """Whether normals point out of a solid; of an open sheet nobody knows."""


def facing_normal(
    body: Float[np.ndarray, "triangles 3 3"],
    other: Float[np.ndarray, "others 3 3"],
    *,
    depth_m: float,
    solid: tuple[bool, bool] = (True, True),
    box: Box | None = None,
) -> Vector | None:
    """The mean normal of the patch where two surfaces meet, from the other to the body.

    Each place counts with its area, and as far as it faces the nearest place of the other
    surface. None where nothing faces, or all sides alike: a peg in its hole.

    ``depth_m``: the patch holds what is no further from the other surface than this beyond the
    nearest of all [m]. ``solid``: whether either bounds a solid, so that its normals point outward.
    ``box``: where they may meet; None for where the boxes of these triangles do.
    """
    if box is None:
        box = meeting_box(body.reshape(-1, 3), other.reshape(-1, 3), depth_m=depth_m)
    # No more places than enough on the largest side of the box.
    sides = np.sort(np.maximum(box[1] - box[0], 0.0))
    spacing_m = max(SPACING_M, float(np.sqrt(sides[1] * sides[2] / MANY_PLACES)))
    one = places(body, box, spacing_m=spacing_m, outward=solid[0])
    two = places(other, box, spacing_m=spacing_m, outward=solid[1])
    if not len(one.points) or not len(two.points):
        return None
    depth_m = max(depth_m, spacing_m)
    # Trees that are built faster than they could be searched, as few points ask them.
    trees = [cKDTree(each.points, balanced_tree=False, compact_nodes=False) for each in (one, two)]
    bound = (float(trees[1].query(one.points[::SAMPLED])[0].min()) + depth_m) * (1.0 + ROUNDED)
    far_one, to_two = trees[1].query(one.points, distance_upper_bound=bound)
    far_two, to_one = trees[0].query(two.points, distance_upper_bound=bound)
    # The nearest pair is the same from either side.
    reach = float(far_one.min()) + depth_m
    some_one, some_two = np.flatnonzero(far_one <= reach), np.flatnonzero(far_two <= reach)
    total = _faced(two, one, some_two, to_one[some_two])
    total = total - _faced(one, two, some_one, to_two[some_one])
    length = float(np.linalg.norm(total))
    area = float(one.areas[some_one].sum() + two.areas[some_two].sum())
    return total / length if length > LEAST_SHARE * area else None


def meeting_box(
    body: Float[np.ndarray, "corners 3"], other: Float[np.ndarray, "others 3"], *, depth_m: float
) -> Box:
    """Where two bodies may have a patch so deep, by their corners in one frame [m]."""
    low = np.maximum(body.min(axis=0), other.min(axis=0)) - BOX_DEPTHS * depth_m
    high = np.minimum(body.max(axis=0), other.max(axis=0)) + BOX_DEPTHS * depth_m
    return np.stack([low, high])


def places(
    triangles: Float[np.ndarray, "triangles 3 3"],
    box: Box,
    *,
    spacing_m: float = SPACING_M,
    outward: bool = True,
) -> Places:
    """Places on triangles [m] within a box, spread evenly over each."""
    low, high = triangle_boxes(triangles)
    some = triangles[geometry.every((low <= box[1]) & (high >= box[0]))]
    # The corner first that the longest edge does not touch.
    sides = geometry.lengths(some[:, [1, 2, 0]] - some)
    order = (sides.argmax(axis=1)[:, None] + np.array([2, 0, 1])) % 3
    some = np.take_along_axis(some, order[:, :, None], axis=1)
    one, two = some[:, 1] - some[:, 0], some[:, 2] - some[:, 0]
    normal = np.cross(one, two)
    length = geometry.lengths(normal)
    steps = _steps(one, spacing_m) * (2 * MOST_STEPS) + _steps(two, spacing_m)
    found = [(np.zeros((0, 3)), np.zeros((0, 3)), np.zeros(0))]
    for both in np.unique(steps).tolist():
        along, across = divmod(both, 2 * MOST_STEPS)
        rows = np.flatnonzero((steps == both) & (length > 0.0))
        u, v = _spread(along, across)
        # Axis by axis: of a large triangle few places are in the box along the first.
        row, cell = rows[:, None], np.arange(len(u))
        columns: list[np.ndarray] = []
        for axis in range(3):
            column = some[row, 0, axis] + u[cell] * one[row, axis] + v[cell] * two[row, axis]
            inside = (column >= box[0, axis]) & (column <= box[1, axis])
            row, cell = (np.broadcast_to(each, inside.shape)[inside] for each in (row, cell))
            columns = [each[inside] for each in (*columns, column)]
        areas = 0.5 * length[row] / len(u)
        found.append((np.stack(columns, axis=1), normal[row] / length[row, None], areas))
    points, normals, areas = (np.concatenate(each) for each in zip(*found, strict=True))
    return Places(points, normals, areas, outward)


def _steps(edges: Float[np.ndarray, "edges 3"], spacing_m: float) -> np.ndarray:
    """Into how many steps each edge is divided [1]: a power of two, so that few differ."""
    ratio = geometry.lengths(edges) / spacing_m
    return np.clip(2 ** np.ceil(np.log2(np.maximum(ratio, 1.0))), 1, MOST_STEPS).astype(int)


@lru_cache(maxsize=128)
def _spread(along: int, across: int) -> tuple[np.ndarray, np.ndarray]:
    """Shares of two edges at even places of a triangle: the thirds of each cell's two halves."""
    grid = np.mgrid[0:along, 0:across].reshape(2, -1)
    both = np.concatenate([grid + 1.0 / 3.0, grid + 2.0 / 3.0], axis=1)
    u, v = both[0] / along, both[1] / across
    inside = u + v < 1.0
    return u[inside], v[inside]


def _faced(
    own: Places, others: Places, some: Int[np.ndarray, "near"], nearest: Int[np.ndarray, "near"]
) -> Vector:
    """The sum of a patch's normals by area, as far as each faces the nearest of the others."""
    if not own.outward:
        return np.zeros(3)
    normals = own.normals[some]
    faces = -np.einsum("ij,ij->i", normals, others.normals[nearest])
    if others.outward:
        faces = np.maximum(faces, 0.0)
    else:
        ahead = np.einsum("ij,ij->i", normals, others.points[nearest] - own.points[some])
        faces = np.where(ahead >= -SPACING_M, np.abs(faces), 0.0)
    return np.asarray((own.areas[some] * faces) @ normals)


SLACK_M = 1e-6
"""By so much the box is larger in which triangles are sought, since turning it rounds [m]."""

_KEPT: OrderedDict[tuple[object, ...], Vector | None] = OrderedDict()
"""Normals of the patches that were sought last, by shapes and poses: contacts and seats ask for the
same ones, and windows of a recording begin at the same frames again and again."""

_MOST_KEPT = 4096


def contact_normal(
    body: BodyGeometry, other: BodyGeometry, frame: int, thresholds: Thresholds
) -> Vector | None:
    """The unit normal of a contact, from the other to the body, in the world; None if unknown.

    It is the mean normal of the patch where the true surfaces meet: what stands in a bowl lies on
    the bowl's bottom, however high the bowl's rim. Where either body has no shape, or the patch
    has no direction, it is the axis along which their outlines are furthest apart.
    """
    if np.isnan(body.middles[frame] - other.middles[frame]).any():
        return None
    found = _patch_normal(body, other, frame, thresholds.patch_m)
    return _between_outlines(body, other, frame) if found is None else found


def _patch_normal(
    body: BodyGeometry, other: BodyGeometry, frame: int, depth_m: float
) -> Vector | None:
    """The mean normal of the patch where two surfaces meet; None where either has no shape."""
    if body.shape is None or other.shape is None:
        return None
    one, two = (
        (
            each.shape.digest if each.shape else b"",
            each.middles[frame].tobytes(),
            each.orientations[frame].tobytes(),
        )
        for each in (body, other)
    )
    if (two, one, depth_m) in _KEPT:
        opposite = _KEPT[two, one, depth_m]
        return None if opposite is None else -opposite
    key = one, two, depth_m
    if key not in _KEPT:
        _KEPT[key] = _sought_normal(
            surface(body.shape), surface(other.shape), body, other, frame, depth_m
        )
        if len(_KEPT) > _MOST_KEPT:
            _KEPT.popitem(last=False)
    return _KEPT[key]


def _sought_normal(
    one: Surface, two: Surface, body: BodyGeometry, other: BodyGeometry, frame: int, depth_m: float
) -> Vector | None:
    corners = _placed(one.corners, body, frame), _placed(two.corners, other, frame)
    box = meeting_box(*corners, depth_m=depth_m)
    return facing_normal(
        _triangles(one, body, frame, box),
        _triangles(two, other, frame, box),
        depth_m=depth_m,
        solid=(one.closed, two.closed),
        box=box,
    )


def _triangles(
    of: Surface, body: BodyGeometry, frame: int, box: Box
) -> Float[np.ndarray, "triangles 3 3"]:
    """The triangles that may reach into a box, in the world at a frame [m], facing outward."""
    ends = np.array(list(product(*box.T))) - body.middles[frame]
    local = ends @ body.turn(frame) + of.centre
    low, high = of.triangle_boxes
    near = (low <= local.max(axis=0) + SLACK_M) & (high >= local.min(axis=0) - SLACK_M)
    some = of.triangles[geometry.every(near)] - of.centre
    return _placed(some[:, ::-1] if of.inverted else some, body, frame)


def _placed(
    points: Float[np.ndarray, "*some 3"], body: BodyGeometry, frame: int
) -> Float[np.ndarray, "*some 3"]:
    """Points from the middle of a body [m] where they are in the world at a frame [m]."""
    return np.asarray(points @ body.turn(frame).T + body.middles[frame])


def _between_outlines(body: BodyGeometry, other: BodyGeometry, frame: int) -> Vector:
    """The direction along which two bodies' outermost points are furthest apart."""
    offset = body.middles[frame] - other.middles[frame]
    length = float(np.linalg.norm(offset))
    axes = np.concatenate([np.eye(3), body.turn(frame).T, other.turn(frame).T])
    directions = np.concatenate([axes, -axes, [offset / length] if length else axes[:1]])
    own = body.corners @ body.turn(frame).T
    others = other.corners @ other.turn(frame).T
    apart = (
        directions @ offset + (own @ directions.T).min(axis=0) - (others @ directions.T).max(axis=0)
    )
    return np.asarray(directions[int(np.argmax(np.round(apart, 6)))])
