"""How a body lies to the fixed one that guides it: inside, flush, at its edge, kept between."""

from collections.abc import Iterable
from functools import cache

import numpy as np
from jaxtyping import Bool, Float

from extractors.bodies.body_geometry import BodyGeometry
from extractors.contact.surfaces import surface
from extractors.motion.guide_fitting import GuideFit
from extractors.thresholds import Thresholds

CELLS = 8
"""Into how many cells a body's box is divided along each axis, to take shares of it [1]."""

ALONG = 5
"""At how many points of a hinge its distance is taken [1]."""

PARALLEL = 1e-9
"""A direction whose part along a plane's normal is smaller runs beside the plane [1]."""


def inside_share(body: BodyGeometry, base: BodyGeometry, frame: int) -> float:
    """Share of a body's volume that lies in another's convex hull at a frame [1]."""
    if base.planes is None:
        return 0.0
    return float((_outside(_points(body, frame), base, frame) <= 0.0).mean())


def flush_share(
    body: BodyGeometry,
    base: BodyGeometry,
    frame: int,
    way: Float[np.ndarray, "3"],
    thresholds: Thresholds,
) -> float:
    """Share of a body that is flush against another's convex hull, seen along a direction [1].

    Args:
        body: The body.
        base: The other one, which stands fixed.
        frame: The frame.
        way: Unit direction in the world in which the body closes.
        thresholds: How near is flush.
    """
    points = _points(body, frame)
    _, front = _through(points, way, body, frame)
    enters, leaves = _through(points, way, base, frame)
    meets = (enters <= leaves) & (leaves >= 0.0)
    return float((meets & (enters - front <= thresholds.flush_m)).mean())


def covers_a_hollow(
    body: BodyGeometry,
    base: BodyGeometry,
    frame: int,
    way: Float[np.ndarray, "3"],
    thresholds: Thresholds,
) -> bool:
    """Whether behind most of a body, along a direction, the other's true surface is not flush."""
    points = _points(body, frame)
    _, front = _through(points, way, body, frame)
    deep = _surface_ahead(points, way, base, frame) - front > thresholds.flush_m
    return bool(deep.mean() > 0.5)


def borne_from_below(
    body: BodyGeometry, others: Iterable[BodyGeometry], frame: int, thresholds: Thresholds
) -> bool:
    """Whether a true surface of another body is so near below a body that it may lie on it.

    What of the body is within the other's hull, as noise has it, lies beside that and not on it.
    """
    down = np.array([0.0, 0.0, -1.0])
    points = _points(body, frame)
    _, front = _through(points, down, body, frame)
    for other in others:
        beside = np.full(len(points), True)
        if other.planes is not None:
            beside = _outside(points, other, frame) > 0.0
        below = (_surface_ahead(points, down, other, frame) - front)[beside]
        if (below <= thresholds.tolerance_most_m).any():
            return True
    return False


def edge_gap(
    body: BodyGeometry, base: BodyGeometry, frame: int, way: Float[np.ndarray, "3"]
) -> float:
    """How far a body's outermost point along a direction is from that of another [m]."""
    one, two = (
        float(((each.corners @ each.turn(frame).T + each.middles[frame]) @ way).max())
        for each in (body, base)
    )
    return abs(one - two)


def hinge_at_own_edge(
    body: BodyGeometry, fit: GuideFit, frame: int, thresholds: Thresholds
) -> bool:
    """Whether a body turns about its own edge, or a line beside it."""
    arm = body.middles[frame] - fit.point
    reach = float(np.linalg.norm(arm))
    if reach <= 0.0:
        return False
    outward = arm / reach
    corners = body.corners @ body.turn(frame).T + arm
    beside = corners @ np.cross(fit.axis, outward)
    breadth = corners @ outward
    near = thresholds.hinge_near_m
    within = -thresholds.hinge_edge_share * float(np.ptp(breadth))
    return bool(within <= breadth.min() <= near and beside.min() <= near and beside.max() >= -near)


def hinge_near(
    body: BodyGeometry, base: BodyGeometry, fit: GuideFit, frame: int, thresholds: Thresholds
) -> bool:
    """Whether a body's hinge is in another's convex hull, or near to it."""
    line = _hinge_line(body, fit, frame)
    return bool(_outside(line, base, frame).min() <= thresholds.hinge_near_m)


def hinge_at_edge_of(
    body: BodyGeometry,
    base: BodyGeometry,
    fit: GuideFit,
    frame: int,
    way: Float[np.ndarray, "3"],
    thresholds: Thresholds,
) -> bool:
    """Whether a body's hinge is at the edge of another's hull, as seen along a direction."""
    arm = body.middles[frame] - fit.point
    outward = arm / np.linalg.norm(arm)
    beyond = _hinge_line(body, fit, frame) - thresholds.hinge_near_m * outward
    enters, leaves = _through(beyond, way, base, frame)
    return bool((enters > leaves).all())


def confined(
    body: BodyGeometry,
    base: BodyGeometry,
    axis: Float[np.ndarray, "3"],
    frame: int,
    thresholds: Thresholds,
) -> bool:
    """Whether another's surface stands close by on both sides of a body, or fills its place.

    The sides are those to which it could go level with the ground, across the axis; of an upright
    axis either of two directions.
    """
    side = np.cross(axis, [0.0, 0.0, 1.0])
    if np.linalg.norm(side) < thresholds.steep:
        one = np.cross(axis, [1.0, 0.0, 0.0])
        return any(
            _kept(body, base, direction, frame, thresholds)
            for direction in (one, np.cross(axis, one))
        )
    return _kept(body, base, side, frame, thresholds)


def _kept(
    body: BodyGeometry,
    base: BodyGeometry,
    side: Float[np.ndarray, "3"],
    frame: int,
    thresholds: Thresholds,
) -> bool:
    side = side / np.linalg.norm(side)
    points = _points(body, frame)
    if base.shape is not None and surface(base.shape).contains(_local(points, base, frame)).any():
        return True
    for way in (side, -side):
        _, front = _through(points, way, body, frame)
        if float((_surface_ahead(points, way, base, frame) - front).min()) > thresholds.rail_play_m:
            return False
    return True


def _points(body: BodyGeometry, frame: int) -> Float[np.ndarray, "points 3"]:
    """Points spread evenly in a body's convex hull, in the world [m]."""
    size = body.shape.size if body.shape else np.zeros(3)
    points = _grid() * size
    if body.planes is not None:
        points = points[(points @ body.planes[:, :3].T + body.planes[:, 3] <= 0.0).all(axis=1)]
    return np.asarray(points @ body.turn(frame).T + body.middles[frame])


@cache
def _grid() -> Float[np.ndarray, "points 3"]:
    steps = (np.arange(CELLS) + 0.5) / CELLS - 0.5
    return np.stack(np.meshgrid(steps, steps, steps), axis=-1).reshape(-1, 3)


def _hinge_line(body: BodyGeometry, fit: GuideFit, frame: int) -> Float[np.ndarray, "points 3"]:
    """Points of a hinge's line, as far as its body extends along it, in the world [m]."""
    heights = (body.corners @ body.turn(frame).T + body.middles[frame] - fit.point) @ fit.axis
    along = np.linspace(heights.min(), heights.max(), ALONG)
    return np.asarray(fit.point + along[:, None] * fit.axis)


def _local(
    points: Float[np.ndarray, "points 3"], base: BodyGeometry, frame: int
) -> Float[np.ndarray, "points 3"]:
    """Points of the world in the frame of a body's shape [m]."""
    centre = base.shape.bounds.mean(axis=0) if base.shape else np.zeros(3)
    return np.asarray((points - base.middles[frame]) @ base.turn(frame) + centre)


def _outside(
    points: Float[np.ndarray, "points 3"], base: BodyGeometry, frame: int
) -> Float[np.ndarray, "points"]:
    """How far points of the world are outside a body's hull, at least; negative inside [m]."""
    assert base.planes is not None
    local = (points - base.middles[frame]) @ base.turn(frame)
    return np.asarray((local @ base.planes[:, :3].T + base.planes[:, 3]).max(axis=1))


def _through(
    points: Float[np.ndarray, "points 3"],
    way: Float[np.ndarray, "3"],
    body: BodyGeometry,
    frame: int,
) -> tuple[Float[np.ndarray, "points"], Float[np.ndarray, "points"]]:
    """Where lines from points along a direction enter and leave a body's hull [m].

    The line misses the hull where it would enter it after it leaves.
    """
    assert body.planes is not None
    local = (points - body.middles[frame]) @ body.turn(frame)
    height = local @ body.planes[:, :3].T + body.planes[:, 3]
    slope = body.planes[:, :3] @ (way @ body.turn(frame))
    with np.errstate(divide="ignore", invalid="ignore"):
        at = -height / slope
    enters = np.where(slope < -PARALLEL, at, -np.inf).max(axis=1)
    leaves = np.where(slope > PARALLEL, at, np.inf).min(axis=1)
    beside: Bool[np.ndarray, "points"] = ((np.abs(slope) <= PARALLEL) & (height > 0.0)).any(axis=1)
    return np.where(beside, np.inf, enters), leaves


def _surface_ahead(
    points: Float[np.ndarray, "points 3"],
    way: Float[np.ndarray, "3"],
    base: BodyGeometry,
    frame: int,
) -> Float[np.ndarray, "points"]:
    """How far ahead of each point a body's true surface is [m]; infinite where there is none."""
    out = np.full(len(points), np.inf)
    if base.shape is None:
        return out
    local, direction = _local(points, base, frame), way @ base.turn(frame)
    rays = np.broadcast_to(direction, local.shape)
    places, index, _ = surface(base.shape).mesh.ray.intersects_location(
        local, rays, multiple_hits=False
    )
    if len(index):
        out[index] = (places - local[index]) @ direction
    return out
