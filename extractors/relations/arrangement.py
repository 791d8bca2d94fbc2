"""How a body lies to another through time: inside, above, below, beside, along, between."""

from collections.abc import Callable

import numpy as np
from jaxtyping import Bool, Float, Int

from extractors.bodies.body_geometry import BodyGeometry, blocks
from extractors.signals.filters import derivative
from extractors.thresholds import Thresholds

Holds = Bool[np.ndarray, "frames"]


def inside(body: BodyGeometry, other: BodyGeometry, thresholds: Thresholds) -> Holds:
    """At least half of the body lies in the other's hull.

    The share is that of the body's outermost points, those halfway to its middle, and its middle.
    """
    points = np.concatenate([body.corners, 0.5 * body.corners, np.zeros((1, 3))])
    return _share(points, body, other, depth_m=0.0) >= thresholds.inside_share


def dips(body: BodyGeometry, other: BodyGeometry, thresholds: Thresholds) -> Holds:
    """One end of it is in the other's hull, deeper than bodies that touch cut each other."""
    return _share(body.corners, body, other, depth_m=_give(thresholds)) > 0.0


def _share(
    points: Float[np.ndarray, "points 3"],
    body: BodyGeometry,
    other: BodyGeometry,
    *,
    depth_m: float,
) -> Float[np.ndarray, "frames"]:
    """Share of a body's points, from its middle, that lie so deep in the other's hull."""
    out = np.zeros(len(body.middles))
    planes = other.planes
    frames = np.flatnonzero(_overlaps(body, other, 0.0))
    if planes is not None:
        for block in blocks(len(frames)):
            some = frames[block]
            world = points @ np.swapaxes(body.turns_at(some), 1, 2) + body.middles[some, None]
            local = (world - other.middles[some, None]) @ other.turns_at(some)
            within = np.ones(local.shape[:2], dtype=bool)
            for plane in planes:
                within &= local @ plane[:3] + plane[3] <= -depth_m
            out[some] = within.mean(axis=1)
    return out


def above(body: BodyGeometry, other: BodyGeometry, thresholds: Thresholds) -> Holds:
    """It is higher than the other's top, within 45 degrees of the vertical from its shadow."""
    low, high = body.boxes[0][:, 2], other.boxes[1][:, 2]
    aside = beyond_shadow(body.middles, *other.boxes)
    rise = body.middles[:, 2] - high
    with np.errstate(invalid="ignore"):
        return np.asarray((low >= high - _give(thresholds)) & (rise > 0.0) & (aside <= rise))


def below(body: BodyGeometry, other: BodyGeometry, thresholds: Thresholds) -> Holds:
    """It is lower than the other's bottom, under its shadow."""
    high, low = body.boxes[1][:, 2], other.boxes[0][:, 2]
    aside = beyond_shadow(body.middles, *other.boxes)
    with np.errstate(invalid="ignore"):
        return np.asarray((high <= low + _give(thresholds)) & (aside <= 0.0))


def beside(body: BodyGeometry, other: BodyGeometry, thresholds: Thresholds) -> Holds:
    """It is near, at the same height, and not in its shadow."""
    low, high = body.boxes
    bottom, top = other.boxes
    heights = (low[:, 2] <= top[:, 2]) & (high[:, 2] >= bottom[:, 2])
    aside = beyond_shadow(body.middles, bottom, top)
    near = _overlaps(body, other, thresholds.near_m)
    with np.errstate(invalid="ignore"):
        return np.asarray(heights & near & (aside > 0.0))


def along(body: BodyGeometry, other: BodyGeometry, thresholds: Thresholds) -> Holds:
    """It moves near the other, in the direction of its longest axis if it has one."""
    out = np.zeros(len(body.middles), dtype=bool)
    if other.shape is None:
        return out
    sizes = np.sort(other.shape.size)
    if sizes[2] < 2.0 * sizes[1]:
        return out
    axis = other.turns_at(slice(None))[:, :, int(np.argmax(other.shape.size))]
    times = body.poses.smooth.times
    step = derivative(body.middles, times)
    pace = np.linalg.norm(step, axis=1)
    with np.errstate(invalid="ignore"):
        straight = np.abs(np.einsum("ij,ij->i", step, axis)) >= np.cos(thresholds.along_rad) * pace
        moves = pace > thresholds.rest_speed_mps
        return np.asarray(straight & moves & _overlaps(body, other, thresholds.near_m))


def between(body: BodyGeometry, one: BodyGeometry, other: BodyGeometry) -> Holds:
    """Its middle is in a straight tube that joins two bodies, in neither of their boxes."""
    line = other.middles - one.middles
    with np.errstate(invalid="ignore", divide="ignore"):
        share = np.einsum("ij,ij->i", body.middles - one.middles, line) / np.einsum(
            "ij,ij->i", line, line
        )
        off = np.linalg.norm(body.middles - one.middles - share[:, None] * line, axis=1)
        wide = np.minimum(_radius(one), _radius(other))
        tube = (share > 0.0) & (share < 1.0) & (off <= wide)
        return np.asarray(tube & ~_holds(one, body.middles) & ~_holds(other, body.middles))


def gap(body: BodyGeometry, other: BodyGeometry) -> Float[np.ndarray, "frames"]:
    """Distance of the boxes of two bodies along the world's axes [m]; zero where they overlap."""
    low, high = body.boxes
    bottom, top = other.boxes
    outside = np.maximum(np.maximum(low - top, bottom - high), 0.0)
    return np.asarray(np.linalg.norm(outside, axis=1))


def sides(body: BodyGeometry, other: BodyGeometry, frames: Int[np.ndarray, "two"]) -> str:
    """Whether a body is at opposite sides of another at two frames, or merely at other ones."""
    ends = [
        other.turn(frame).T @ (body.middles[frame] - other.middles[frame])
        for frame in map(int, frames)
    ]
    size = np.ones(3) if other.shape is None else np.maximum(other.shape.size, 1e-6)
    first, last = (each / size for each in ends)
    axis = int(np.argmax(np.abs(first - last)))
    return "opposite" if first[axis] * last[axis] < 0.0 else "other"


ARRANGEMENTS: dict[str, Callable[[BodyGeometry, BodyGeometry, Thresholds], Holds]] = {
    "inside": inside,
    "dips": dips,
    "above": above,
    "below": below,
    "beside": beside,
    "along": along,
}
"""Every arrangement of two bodies by its name in facts."""


def _give(thresholds: Thresholds) -> float:
    """How far bodies may cut each other where they touch [m]."""
    return thresholds.tolerance_most_m


def _overlaps(body: BodyGeometry, other: BodyGeometry, reach_m: float) -> Holds:
    with np.errstate(invalid="ignore"):
        return np.asarray(gap(body, other) <= reach_m)


def beyond_shadow(
    point: Float[np.ndarray, "frames 3"],
    low: Float[np.ndarray, "frames 3"],
    high: Float[np.ndarray, "frames 3"],
) -> Float[np.ndarray, "frames"]:
    """How far a point is outside a box's shadow on the ground [m]."""
    outside = np.maximum(np.maximum(low - point, point - high), 0.0)
    return np.asarray(np.linalg.norm(outside[:, :2], axis=1))


def _radius(body: BodyGeometry) -> float:
    return float(np.linalg.norm(body.corners, axis=1).max())


def _holds(box: BodyGeometry, points: Float[np.ndarray, "frames 3"]) -> Holds:
    low, high = box.boxes
    return np.asarray(((points >= low) & (points <= high)).all(axis=1))
