"""Hinges and rails that guide an object: found, fitted and placed."""

from collections.abc import Collection, Iterable
from dataclasses import dataclass
from functools import cache
from typing import NamedTuple, TypeAlias

import numpy as np
from jaxtyping import Bool, Float
from scipy.spatial.transform import Rotation

from capar.model import geometry
from capar.model.geometry import Holds, Quaternion, Series, Vector
from capar.model.locations import GuideLocation, Nlt, local_point, normalised, relative_orientation
from extractors.bodies.bodies import BodyGeometry
from extractors.contact.surfaces import surface
from extractors.motion.object_motion import Floor
from extractors.signals.intervals import Interval
from extractors.thresholds import Thresholds

HINGE, RAIL = "hinge", "rail"

ROUNDS = 3
"""How often the orientation that angles are counted from is averaged anew [1]: the first round
takes it from one frame, the second from all, the third changes it by less than a microradian."""

ROUNDED = 1e-9
"""By this share a bound is wider than what it bounds [1], as numbers are rounded."""

_INVERSE = np.array([1.0, -1.0, -1.0, -1.0])
"""What a unit quaternion's parts are multiplied with to make it the opposite rotation's [1]."""

_Vector: TypeAlias = Vector
_Frames: TypeAlias = Series


@dataclass(frozen=True, eq=False)
class GuideFit:
    """The line about which, or along which, a body moves, and how far it strays from that."""

    kind: str
    """``hinge`` or ``rail``."""

    axis: _Vector
    """Unit direction of the line in the world; its largest part is positive."""

    point: _Vector
    """A point of the line in the world [m]; of a rail, the mean place of the body's middle."""

    course: _Frames
    """How far the body has turned [rad] or gone [m] at each frame; NaN where it was lost."""

    stray_m: _Frames
    """How far its middle is from where the guide would have it [m]; NaN where it was lost."""

    stray_rad: _Frames
    """By which angle its orientation is off [rad]; NaN where it was lost."""

    lever_m: float
    """Distance of the body's outermost point from its middle [m]."""

    radius_m: float
    """Distance of its middle from the line [m]."""

    @property
    def span(self) -> float:
        """From one end of its range to the other [rad] or [m]."""
        return float(np.nanmax(self.course) - np.nanmin(self.course))

    @property
    def residual_m(self) -> float:
        """Root mean square of what is left [m]: stray of the middle, and of the rim by turning."""
        left = self.stray_m**2 + (self.lever_m * self.stray_rad) ** 2
        return float(np.sqrt(np.nanmean(left)))


def in_one_plane(body: BodyGeometry, within_m: float) -> bool:
    """Whether a body's middle may be within a distance [m] of some plane at every frame.

    On a hinge or a rail it is; where the mean square from the best plane is more, it never is.
    """
    _, middles, _ = _known(body)
    if not len(middles):
        return True
    offset = middles - middles.mean(axis=0)
    least = np.linalg.eigvalsh(offset.T @ offset / len(offset))[0]
    return bool(least <= within_m**2 * (1.0 + ROUNDED))


def fit_hinge(body: BodyGeometry) -> GuideFit | None:
    """The fixed line about which a body turns; None where it was never seen to turn.

    The axis is the main direction of the vector parts of the rotations from one orientation, the
    angle of each frame the turn about it. The middle then goes on a circle, m = c + R(angle) q
    plus a height along the axis, which is linear in c and q.
    """
    known, middles, turns = _known(body)
    found = _axis_and_angles(turns)
    if found is None:
        return None
    axis, angles, stray_rad = found
    across = _across(axis)
    places = middles @ across[0] + 1j * (middles @ across[1])
    terms = np.stack([np.ones_like(places), np.exp(1j * angles)], axis=1)
    solved = np.linalg.lstsq(terms, places, rcond=None)[0]
    heights = middles @ axis
    height = float(heights.mean())
    stray_m = np.hypot(np.abs(places - terms @ solved), heights - height)
    point = solved[0].real * across[0] + solved[0].imag * across[1] + height * axis
    return GuideFit(
        HINGE,
        axis,
        point,
        _spread(known, angles),
        _spread(known, stray_m),
        _spread(known, stray_rad),
        _lever(body),
        float(np.abs(solved[1])),
    )


def fit_rail(body: BodyGeometry) -> GuideFit | None:
    """The line along which a body goes without turning; None where it never went anywhere."""
    known, middles, turns = _known(body)
    mean = middles.mean(axis=0) if len(middles) else np.zeros(3)
    axis = _main_direction(middles - mean)
    if axis is None:
        return None
    course = (middles - mean) @ axis
    stray_m = np.linalg.norm(middles - mean - course[:, None] * axis, axis=1)
    usual = geometry.quaternions(geometry.rotations(turns).mean())
    stray_rad = geometry.angle_between(turns, usual[None])
    return GuideFit(
        RAIL,
        axis,
        mean,
        _spread(known, course),
        _spread(known, stray_m),
        _spread(known, stray_rad),
        _lever(body),
        0.0,
    )


def _known(
    body: BodyGeometry,
) -> tuple[Holds, Float[np.ndarray, "known 3"], Float[np.ndarray, "known 4"]]:
    known = ~(np.isnan(body.middles).any(axis=1) | np.isnan(body.orientations).any(axis=1))
    return known, body.middles[known], body.orientations[known]


def _axis_and_angles(
    turns: Float[np.ndarray, "known 4"],
) -> tuple[_Vector, Float[np.ndarray, "known"], Float[np.ndarray, "known"]] | None:
    """The axis, the angle about it at each frame, and by how much the orientation is off it."""
    if not len(turns):
        return None
    base = turns[:1]
    for _ in range(ROUNDS):
        moved = geometry.continuous(geometry.products(turns, base * _INVERSE))
        found = _main_direction(moved[:, 1:])
        if found is None:
            return None
        axis = found
        angles = np.unwrap(2.0 * np.arctan2(moved[:, 1:] @ axis, moved[:, 0]))
        back = geometry.products(_about(axis, -angles), turns)
        base = geometry.quaternions(geometry.rotations(back).mean())[None]
    stray_rad = geometry.angle_between(back, base)
    return axis, angles, stray_rad


def _about(axis: _Vector, angles: Float[np.ndarray, "known"]) -> Float[np.ndarray, "known 4"]:
    """Quaternions of turns about an axis [rad]."""
    half = 0.5 * angles[:, None]
    return np.hstack([np.cos(half), np.sin(half) * axis])


def _main_direction(vectors: Float[np.ndarray, "known 3"]) -> _Vector | None:
    """The unit direction of the largest sum of squares; its largest part is positive."""
    values, directions = np.linalg.eigh(vectors.T @ vectors)
    if not len(vectors) or values[-1] <= 0.0:
        return None
    direction = directions[:, -1]
    return np.asarray(direction * np.sign(direction[np.argmax(np.abs(direction))]))


def _across(axis: _Vector) -> Float[np.ndarray, "2 3"]:
    """Two unit directions that make a right-handed frame with an axis."""
    one = np.cross(axis, np.eye(3)[int(np.argmin(np.abs(axis)))])
    one /= np.linalg.norm(one)
    return np.stack([one, np.cross(axis, one)])


def _spread(known: Holds, values: Float[np.ndarray, "known"]) -> _Frames:
    out = np.full(len(known), np.nan)
    out[known] = values
    return out


def _lever(body: BodyGeometry) -> float:
    return float(np.linalg.norm(body.corners, axis=1).max())


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
    body: BodyGeometry, base: BodyGeometry, frame: int, way: Vector, thresholds: Thresholds
) -> float:
    """Share of a body that is flush against another's convex hull, seen along a direction [1].

    ``way``: unit direction in the world in which the body closes.
    """
    points = _points(body, frame)
    _, front = _through(points, way, body, frame)
    enters, leaves = _through(points, way, base, frame)
    meets = (enters <= leaves) & (leaves >= 0.0)
    return float((meets & (enters - front <= thresholds.flush_m)).mean())


def covers_a_hollow(
    body: BodyGeometry, base: BodyGeometry, frame: int, way: Vector, thresholds: Thresholds
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


def edge_gap(body: BodyGeometry, base: BodyGeometry, frame: int, way: Vector) -> float:
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
    way: Vector,
    thresholds: Thresholds,
) -> bool:
    """Whether a body's hinge is at the edge of another's hull, as seen along a direction."""
    arm = body.middles[frame] - fit.point
    outward = arm / np.linalg.norm(arm)
    beyond = _hinge_line(body, fit, frame) - thresholds.hinge_near_m * outward
    enters, leaves = _through(beyond, way, base, frame)
    return bool((enters > leaves).all())


def confined(
    body: BodyGeometry, base: BodyGeometry, axis: Vector, frame: int, thresholds: Thresholds
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
    body: BodyGeometry, base: BodyGeometry, side: Vector, frame: int, thresholds: Thresholds
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
    points: Float[np.ndarray, "points 3"], way: Vector, body: BodyGeometry, frame: int
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
    points: Float[np.ndarray, "points 3"], way: Vector, base: BodyGeometry, frame: int
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


class Ends(NamedTuple):
    """Frames in which a door is closed and open most, and how much of it is flush [1]."""

    closed: int
    opened: int
    share: float


def ends_before_opening(
    body: BodyGeometry,
    base: BodyGeometry,
    fixed: Collection[BodyGeometry],
    fit: GuideFit,
    still_m: float,
    thresholds: Thresholds,
) -> Ends | None:
    """Where a body that keeps to a rail closes an opening; None if it is no sliding door.

    ``still_m``: how much nearer to the edge is nearer [m].
    """
    side = np.cross(fit.axis, [0.0, 0.0, 1.0])
    length = float(np.linalg.norm(side))
    if length < thresholds.steep or base.planes is None:
        return None
    low, high = int(np.nanargmin(fit.course)), int(np.nanargmax(fit.course))
    for end in (low, high):
        if inside_share(body, base, end) >= thresholds.inside_share:
            return None
        if borne_from_below(body, fixed, end, thresholds):
            return None
    found = [
        _closed_end(body, base, fit, (low, high), way, still_m, thresholds)
        for way in (side / length, -side / length)
    ]
    return max((each for each in found if each), key=lambda each: each.share, default=None)


def _closed_end(
    body: BodyGeometry,
    base: BodyGeometry,
    fit: GuideFit,
    frames: tuple[int, int],
    way: Vector,
    still_m: float,
    thresholds: Thresholds,
) -> Ends | None:
    """The end at which it alone covers a hollow, or covers more, or meets an edge of the base."""
    shares = [flush_share(body, base, frame, way, thresholds) for frame in frames]
    covers = [
        share >= thresholds.closed_share and covers_a_hollow(body, base, frame, way, thresholds)
        for frame, share in zip(frames, shares, strict=True)
    ]
    if not any(covers):
        return None
    if all(covers) and abs(shares[0] - shares[1]) < thresholds.withdrawn_share:
        gaps = [
            edge_gap(body, base, frame, sign * fit.axis)
            for frame, sign in zip(frames, (-1.0, 1.0), strict=True)
        ]
        if min(gaps) > thresholds.flush_m or abs(gaps[0] - gaps[1]) < still_m:
            return None
        first = gaps[0] < gaps[1]
    else:
        first = covers[0] and (not covers[1] or shares[0] > shares[1])
    closed, opened = frames if first else frames[::-1]
    return Ends(closed, opened, max(shares))


@dataclass(frozen=True, eq=False)
class Guide:
    """The hinge or the rail of a body, and which end of its range is the closed place."""

    fit: GuideFit
    base: str
    """The fixed body that bears the guide."""

    closed: int
    """The frame in which the body is nearest to the closed end of its range."""

    opened: int
    """The frame in which it is farthest from there."""

    still: float
    """What is no farther than this from an end of its range is there [rad] or [m]."""

    @property
    def way_m(self) -> Series:
        """How far the body's middle is from its closed place along its path [m]."""
        fit = self.fit
        return self.opening * (fit.radius_m if fit.kind == HINGE else 1.0)

    @property
    def opening(self) -> Series:
        """How far the body is open at each frame [rad] or [m]; NaN where it was lost."""
        course = self.fit.course
        with np.errstate(invalid="ignore"):
            there = np.abs(course - course[self.closed]) <= self.still
        return np.asarray(np.abs(course - np.median(course[there])))


def guide_of(
    body: BodyGeometry, fixed: Iterable[BodyGeometry], floor: Floor, thresholds: Thresholds
) -> Guide | None:
    """The hinge or the rail on which a body moves throughout; None where there is none."""
    if body.shape is None or body.poses.rests:
        return None
    fit = _fit(body, floor, thresholds)
    if fit is None:
        return None
    still = floor.rotation_rad if fit.kind == HINGE else floor.position_m
    bases = tuple(fixed)
    best, most = None, 0.0
    for base in bases:
        found = _closed_frame(body, base, fit, still, thresholds)
        if found is not None and not _borne(body, base, found[0], thresholds):
            found = None
        if found is None and fit.kind == RAIL:
            found = _before_opening(body, base, bases, fit, still, thresholds)
        if found is not None and found[1] > most:
            best, most = found
    return best


def _before_opening(
    body: BodyGeometry,
    base: BodyGeometry,
    fixed: tuple[BodyGeometry, ...],
    fit: GuideFit,
    still_m: float,
    thresholds: Thresholds,
) -> tuple[Guide, float] | None:
    """The rail of a door that slides aside before an opening, and how much it covers [1]."""
    ends = ends_before_opening(body, base, fixed, fit, still_m, thresholds)
    if ends is None:
        return None
    return Guide(fit, base.name, ends.closed, ends.opened, still_m), ends.share


def _fit(body: BodyGeometry, floor: Floor, thresholds: Thresholds) -> GuideFit | None:
    """The line that the body never leaves, if it moves far enough to tell."""
    least = thresholds.guide_floors
    if not in_one_plane(body, floor.position_m):
        return None
    for fitted, own in ((fit_rail, floor.position_m), (fit_hinge, floor.rotation_rad)):
        fit = fitted(body)
        if fit is not None and fit.span >= least * own and _keeps_to(fit, floor):
            return fit
    return None


def _keeps_to(fit: GuideFit, floor: Floor) -> bool:
    stray_m, stray_rad = float(np.nanmax(fit.stray_m)), float(np.nanmax(fit.stray_rad))
    return stray_m <= floor.position_m and stray_rad <= floor.rotation_rad


def _closed_frame(
    body: BodyGeometry, base: BodyGeometry, fit: GuideFit, still: float, thresholds: Thresholds
) -> tuple[Guide, float] | None:
    """The end of its range at which the body is closed, the other not, and how closed it is [1]."""
    if base.planes is None:
        return None
    ends = [int(np.nanargmin(fit.course)), int(np.nanargmax(fit.course))]
    shares = [
        _closed_share(body, base, fit, end, outward, thresholds)
        for end, outward in zip(ends, (-1.0, 1.0), strict=True)
    ]
    (less, opened), (most, closed) = sorted(zip(shares, ends, strict=True))
    limit = thresholds.closed_share
    if most < limit or most - less < thresholds.withdrawn_share:
        return None
    if fit.kind == HINGE and less >= limit:
        return None
    return Guide(fit, base.name, closed, opened, still), most


def _closed_share(
    body: BodyGeometry,
    base: BodyGeometry,
    fit: GuideFit,
    end: int,
    outward: float,
    thresholds: Thresholds,
) -> float:
    """Share of the body that is inside the base at one end of its range, or flush against it [1].

    Outward is 1 at the end towards which the body turns about the hinge's axis, -1 at the other.
    """
    inside = inside_share(body, base, end)
    if fit.kind != HINGE or inside >= thresholds.closed_share:
        return inside
    way = outward * np.cross(fit.axis, body.middles[end] - fit.point)
    length = float(np.linalg.norm(way))
    if length <= 0.0:
        return inside
    way = way / length
    at_edge = hinge_at_edge_of(body, base, fit, end, way, thresholds)
    if at_edge or covers_a_hollow(body, base, end, way, thresholds):
        return flush_share(body, base, end, way, thresholds)
    return inside


def _borne(body: BodyGeometry, base: BodyGeometry, guide: Guide, thresholds: Thresholds) -> bool:
    """Whether the line is where a guide of that base would be."""
    if guide.fit.kind == HINGE:
        at_edge = hinge_at_own_edge(body, guide.fit, guide.closed, thresholds)
        return at_edge and hinge_near(body, base, guide.fit, guide.closed, thresholds)
    stays = inside_share(body, base, guide.opened) > 0.0
    return stays and confined(body, base, guide.fit.axis, guide.closed, thresholds)


def turns_on_guide(
    guide: Guide, motions: Iterable[Interval], thresholds: Thresholds
) -> tuple[int, ...]:
    """Frames at which a body turns back on its guide, after a real way and before another one.

    It lies in the middle of the frames in which the body is within the floor of motion of the
    place farthest along.
    """
    found: list[int] = []
    for first, last in motions:
        way = guide.way_m[first : last + 1]
        known = np.flatnonzero(~np.isnan(way))
        turns = _extrema(way[known], thresholds.reversal_m)
        found += [first + _middle(way, int(known[turn]), thresholds) for turn in turns]
    return tuple(found)


def _extrema(way: Float[np.ndarray, "known"], least: float) -> list[int]:
    """Where a course turns back, each so far from the last one and from what comes after it."""
    found: list[int] = []
    heading, low, high = 0, 0, 0
    for index, value in enumerate(way):
        low = index if value < way[low] else low
        high = index if value > way[high] else high
        if heading >= 0 and way[high] - value >= least and (heading or way[high] - way[0] >= least):
            found.append(high)
            heading, low = -1, index
        elif heading <= 0 and value - way[low] >= least and (heading or way[0] - way[low] >= least):
            found.append(low)
            heading, high = 1, index
    return found


def _middle(way: Series, at: int, thresholds: Thresholds) -> int:
    """The middle of the stretch about a frame in which the course is as far as there."""
    with np.errstate(invalid="ignore"):
        there = np.abs(way - way[at]) <= thresholds.motion_floor_m
    for first, last in geometry.runs(there):
        if first <= at <= last:
            return (first + last) // 2
    return at


X_AXIS = np.array([1.0, 0.0, 0.0])
"""The constraint's own axis that is the line of the guide."""


def guide_location(body: BodyGeometry, base: BodyGeometry, guide: Guide) -> GuideLocation:
    """The line of a body's hinge or rail as places on the body and on its base.

    The place on a hinge is the one beside the middle of the body; on a rail it is that middle,
    where the body is closed.
    """
    fit, frame = guide.fit, guide.closed
    opens = 1.0 if fit.course[guide.opened] > fit.course[frame] else -1.0
    point = fit.point if fit.kind == HINGE else body.middles[frame]
    turn = geometry.quaternions(_turn_to(opens * fit.axis))
    return GuideLocation(
        object=body.name,
        base=base.name,
        kind=fit.kind,
        object_nlt=_nlt(body, frame, point, turn),
        base_nlt=_nlt(base, frame, point, turn),
        opened=float(np.nanmax(guide.opening)),
        residual_m=fit.residual_m,
    )


def _turn_to(axis: Vector) -> Rotation:
    """The shortest turn that takes the constraint's axis to one of the world; half about z."""
    about = np.cross(X_AXIS, axis)
    sine, cosine = float(np.linalg.norm(about)), float(axis @ X_AXIS)
    unit = about / sine if sine > 0.0 else np.array([0.0, 0.0, 1.0])
    return Rotation.from_rotvec(np.arctan2(sine, cosine) * unit)


def _nlt(body: BodyGeometry, frame: int, point: Vector, turn: Quaternion) -> Nlt:
    stream = body.poses.settled if body.poses.rests else body.poses.smooth
    size = np.zeros(3) if body.shape is None else body.shape.size
    local = local_point(stream.positions[frame], stream.orientations[frame], point)
    return normalised(local, relative_orientation(stream.orientations[frame], turn), size)
