"""Hinges and rails that guide an object: found, fitted and placed."""

from collections.abc import Collection, Iterable, Mapping
from dataclasses import dataclass
from functools import cache

import numpy as np
from jaxtyping import Float
from scipy.spatial.transform import Rotation

from capar.model import geometry
from capar.model.capture import Capture, TagObject, TagType
from capar.model.geometry import Holds, Series, Vector
from capar.model.locations import GuideLocation, Nlt, local_point, normalised, relative_orientation
from extractors.bodies.bodies import BodyGeometry
from extractors.bodies.poses import poses_in, standing
from extractors.contact.surfaces import surface
from extractors.motion.object_motion import Floor, motion_floor
from extractors.relations.arrangement import boxes_apart
from extractors.signals.intervals import Interval, frame_rate
from extractors.thresholds import Thresholds

HINGE, RAIL = "hinge", "rail"

ROUNDS = 3
"""How often the orientation that angles are counted from is averaged anew [1]: the first round
takes it from one frame, the second from all, the third changes it by less than a microradian."""

FEW = 1000
"""One frame in so many is looked at first where one that is far off tells [1]."""

ROUNDED = 1e-9
"""By this share a bound is wider than what it bounds [1], as numbers are rounded."""

CELLS = 8
"""Into how many cells a body's box is divided along each axis, to take shares of it [1]."""

ALONG = 5
"""At how many points of a hinge its distance is taken [1]."""

PARALLEL = 1e-9
"""A direction whose part along a plane's normal is smaller runs parallel to the plane [1]."""

UP = np.array([0.0, 0.0, 1.0])

Points = Float[np.ndarray, "points 3"]


@dataclass(frozen=True, eq=False)
class GuideFit:
    """The line about which, or along which, a body moves, and how far it strays from that."""

    kind: str
    """``hinge`` or ``rail``."""

    axis: Vector
    """Unit direction of the line in the world; its largest part is positive."""

    point: Vector
    """A point of the line in the world [m]; of a rail, the mean place of the body's middle."""

    course: Series
    """How far the body has turned [rad] or gone [m] at each frame; NaN where it was lost."""

    stray_m: Series
    """How far its middle is from where the guide would have it [m]; NaN where it was lost."""

    stray_rad: Series
    """By which angle its orientation is off [rad]; NaN where it was lost."""

    lever_m: float
    """Distance of the body's outermost point from its middle [m]."""

    @property
    def residual_m(self) -> float:
        """Root mean square of what is left [m]: stray of the middle, and of the rim by turning."""
        left = self.stray_m**2 + (self.lever_m * self.stray_rad) ** 2
        return float(np.sqrt(np.nanmean(left)))


def fit_hinge(body: BodyGeometry) -> GuideFit | None:
    """The fixed line about which a body turns; None where it was never seen to turn.

    The axis is the main direction of the vector parts of the rotations from one orientation, the
    angle of each frame the turn about it. The middle then goes on a circle, m = c + R(angle) q
    plus a height along the axis, which is linear in c and q.
    """
    known = _known(body)
    middles, turns = body.middles[known], body.orientations[known]
    base, axis = turns[:1], np.zeros(3)
    for _ in range(ROUNDS):
        moved = geometry.continuous(geometry.products(turns, base * [1.0, -1.0, -1.0, -1.0]))
        found = _main_direction(moved[:, 1:])
        if found is None:
            return None
        axis = found
        angles = np.unwrap(2.0 * np.arctan2(moved[:, 1:] @ axis, moved[:, 0]))
        half = -0.5 * angles[:, None]
        back = geometry.products(np.hstack([np.cos(half), np.sin(half) * axis]), turns)
        base = geometry.quaternions(geometry.rotations(back).mean())[None]
    one = np.cross(axis, np.eye(3)[int(np.argmin(np.abs(axis)))])
    one /= np.linalg.norm(one)
    other = np.cross(axis, one)
    places = middles @ one + 1j * (middles @ other)
    terms = np.stack([np.ones_like(places), np.exp(1j * angles)], axis=1)
    centre, arm = np.linalg.lstsq(terms, places, rcond=None)[0]
    heights = middles @ axis
    height = float(heights.mean())
    stray_m = np.hypot(np.abs(places - terms @ [centre, arm]), heights - height)
    point = centre.real * one + centre.imag * other + height * axis
    measured = angles, stray_m, geometry.angle_between(back, base)
    return _fitted(HINGE, body, known, axis, point, measured)


def fit_rail(body: BodyGeometry) -> GuideFit | None:
    """The line along which a body goes without turning; None where it never went anywhere."""
    known = _known(body)
    middles, turns = body.middles[known], body.orientations[known]
    mean = middles.mean(axis=0) if len(middles) else np.zeros(3)
    axis = _main_direction(middles - mean)
    if axis is None:
        return None
    course = (middles - mean) @ axis
    stray_m = geometry.lengths(middles - mean - course[:, None] * axis)
    usual = geometry.mean_orientation(turns)
    measured = course, stray_m, geometry.angle_between(turns, usual[None])
    return _fitted(RAIL, body, known, axis, mean, measured)


def _known(body: BodyGeometry) -> Holds:
    return np.asarray(geometry.is_known(body.middles) & geometry.is_known(body.orientations))


def _main_direction(vectors: Float[np.ndarray, "known 3"]) -> Vector | None:
    """The unit direction of the largest sum of squares; its largest part is positive."""
    values, directions = np.linalg.eigh(vectors.T @ vectors)
    if not len(vectors) or values[-1] <= 0.0:
        return None
    direction = directions[:, -1]
    return np.asarray(direction * np.sign(direction[np.argmax(np.abs(direction))]))


def _fitted(
    kind: str,
    body: BodyGeometry,
    known: Holds,
    axis: Vector,
    point: Vector,
    measured: tuple[Float[np.ndarray, "known"], ...],
) -> GuideFit:
    """A fit by what was measured in the frames in which the body is known."""
    columns = np.full((len(measured), len(known)), np.nan)
    columns[:, known] = measured
    course, stray_m, stray_rad = columns
    lever_m = float(geometry.lengths(body.corners).max())
    return GuideFit(kind, axis, point, course, stray_m, stray_rad, lever_m)


@dataclass(frozen=True, eq=False)
class Guide:
    """The hinge or the rail of a body, and which end of its range is the closed place."""

    fit: GuideFit
    base: str
    """The body that bears the guide."""

    closed: int
    """The frame in which the body is nearest to the closed end of its range."""

    opened: int
    """The frame in which it is farthest from there."""

    still: float
    """What is no farther than this from an end of its range is there [rad] or [m]."""

    known: bool = True
    """Whether that end is where it is closed, and not merely one end of its range."""

    stated: float | None = None
    """The course at which it is closed, as the capture states it [rad] or [m]."""

    @property
    def kind(self) -> str:
        """``hinge`` or ``rail``; ``pivot`` or ``track`` where no closed place is known."""
        return self.fit.kind if self.known else {HINGE: "pivot", RAIL: "track"}[self.fit.kind]

    @property
    def opening(self) -> Series:
        """How far the body is open at each frame [rad] or [m]; NaN where it was lost."""
        course = self.fit.course
        if self.stated is not None:
            return np.asarray(np.abs(course - self.stated))
        with np.errstate(invalid="ignore"):
            there = np.abs(course - course[self.closed]) <= self.still
        return np.asarray(np.abs(course - np.median(course[there])))


@dataclass(frozen=True, eq=False)
class Part:
    """A part of a thing: a door, a lid, a drawer, a blade of scissors."""

    base: BodyGeometry
    """The base; one that can be moved, in the axes in which it stands where it was first known."""

    body: BodyGeometry
    """The part, in the same axes."""

    floor: Floor
    """Of the part's motion in its base."""

    guide: Guide | None
    """None if it was not seen to move on a hinge or a rail."""


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
    ends = int(np.nanargmin(fit.course)), int(np.nanargmax(fit.course))
    bases = tuple(fixed)
    best, most = None, 0.0
    for base in bases:
        if base.planes is None:
            continue
        found = _closed(body, base, fit, ends, thresholds)
        if found is None and fit.kind == RAIL:
            found = _sliding_door(body, base, bases, fit, ends, still, thresholds)
        if found is not None and found[1] > most:
            first, most = found
            closed, opened = ends if first else ends[::-1]
            best = Guide(fit, base.name, closed, opened, still)
    return best


def parts(
    capture: Capture,
    objects: Mapping[str, BodyGeometry],
    floors: Mapping[str, Floor],
    free: Collection[str],
    thresholds: Thresholds,
) -> dict[str, Part]:
    """The parts of things, by name (spec 11).

    What a capture states is one; else what moves on a hinge or a rail of a fixed body, or of a
    larger one.

    ``floors``: of the motion of each mobile object in the world. ``free``: the mobile objects that
    may be parts of each other, without being stated.
    """
    fixed = [objects[each.name] for each in capture.objects if each.tag is TagType.FIXED]
    found: dict[str, Part] = {}
    for one in capture.objects:
        body = objects[one.name]
        stated = [each for each in capture.objects if each.name == one.part_of]
        if one.name not in floors:
            continue
        guide = None if stated else guide_of(body, fixed, floors[one.name], thresholds)
        if guide is not None:
            found[one.name] = Part(objects[guide.base], body, floors[one.name], guide)
            continue
        for other in stated or capture.objects:
            its = objects[other.name]
            may = {one.name, other.name} <= set(free)
            may = may and (body.volume_m3, its.name) < (its.volume_m3, body.name)
            may = may or (other.tag is TagType.FIXED and one.name in free)
            if stated or (may and _stays_near(body, its, thresholds)):
                part = _part(one, body, its, thresholds, stated=bool(stated))
                best = found.get(one.name)
                if stated or (part.guide and (best is None or _apart(part) < _apart(best))):
                    found[one.name] = part
    return found


def _apart(part: Part) -> float:
    """How far a part's hinge is from its base, along its length [m]; without one, the farthest."""
    if part.guide is None or part.base.planes is None:
        return np.inf
    line = _hinge_line(part.body, part.guide.fit, part.guide.closed)
    return float(np.maximum(_outside(line, part.base, part.guide.closed), 0.0).mean())


def _stays_near(one: BodyGeometry, other: BodyGeometry, thresholds: Thresholds) -> bool:
    """Whether the boxes of two bodies are never farther apart than a hinge's leaf."""
    if one.poses.rests:
        return False
    # Most are apart in one of a few frames.
    for frames in (slice(None, None, FEW), slice(None)):
        with np.errstate(invalid="ignore"):
            if (boxes_apart(one, other, frames) > thresholds.hinge_near_m).any():
                return False
    return True


def _part(
    one: TagObject, body: BodyGeometry, other: BodyGeometry, thresholds: Thresholds, *, stated: bool
) -> Part:
    moved = BodyGeometry(one.name, body.shape, poses_in(body.poses, other.poses, thresholds))
    base = BodyGeometry(other.name, other.shape, standing(other.poses))
    rate_hz = frame_rate(moved.poses.filled.times)
    noise = moved.poses.noise
    floor = motion_floor(noise, rate_hz, own_m=one.motion_floor_m, thresholds=thresholds)
    fit = None if body.shape is None else _fit(moved, floor, thresholds)
    if fit is None or not (stated or _steady(fit, thresholds)):
        return Part(base, moved, floor, None)
    still = floor.rotation_rad if fit.kind == HINGE else floor.position_m
    ends = int(np.nanargmin(fit.course)), int(np.nanargmax(fit.course))
    at = _stated_course(one, fit, moved, base)
    told = at is None and base.planes is not None
    closed = _closed(moved, base, fit, ends, thresholds) if told else None
    if told and closed is None and fit.kind == RAIL and (stated or not other.poses.rests):
        side = np.cross(fit.axis, UP)
        ways = (each / np.linalg.norm(each) for each in (side, -side, -UP) if each.any())
        covers = [
            _covering(moved, base, fit, ends, way, still, thresholds)
            for way in ways
            if stated or not _overhangs(moved, base, np.cross(fit.axis, way), thresholds)
        ]
        closed = max((each for each in covers if each), key=lambda each: each[1], default=None)
    found = stated or closed is not None
    if not found and not _joined(moved, other, base, fit, ends, thresholds):
        return Part(base, moved, floor, None)
    if closed is not None:
        near, far = ends if closed[0] else ends[::-1]
        return Part(base, moved, floor, Guide(fit, base.name, near, far, still))
    if at is None:
        at = _course_by_shapes(moved, base, fit, ends, thresholds)
    away = np.abs(fit.course - (fit.course[ends[0]] if at is None else at))
    near, far = int(np.nanargmin(away)), int(np.nanargmax(away))
    guide = Guide(fit, base.name, near, far, still, known=at is not None, stated=at)
    return Part(base, moved, floor, guide)


def _overhangs(
    body: BodyGeometry, base: BodyGeometry, across: Vector, thresholds: Thresholds
) -> bool:
    """Whether a body is wider than another: it may lie on that, and cannot run in it."""
    wide, wider = (float(np.ptp(each.corners @ each.turn(0).T @ across)) for each in (base, body))
    return wider > wide + thresholds.edge_m


def _steady(fit: GuideFit, thresholds: Thresholds) -> bool:
    """Whether what is left of a fit is as little as of a true hinge or rail (spec 11)."""
    stray_m = float(np.sqrt(np.nanmean(fit.stray_m**2)))
    stray_rad = float(np.sqrt(np.nanmean(fit.stray_rad**2)))
    return stray_m <= thresholds.part_stray_m and stray_rad <= thresholds.part_stray_rad


def _stated_course(
    one: TagObject, fit: GuideFit, body: BodyGeometry, base: BodyGeometry
) -> float | None:
    """The course at which the capture says that a part is closed [rad] or [m]."""
    known = int(np.flatnonzero(~np.isnan(fit.course))[0])
    axis = fit.axis @ base.turn(known)
    sign = 1.0 if axis[np.argmax(np.abs(axis))] > 0.0 else -1.0
    if fit.kind == HINGE and one.closed_deg is not None:
        turned = base.turn(known).T @ body.turn(known)
        w, *vector = geometry.quaternions(Rotation.from_matrix(turned))
        angle = 2.0 * np.arctan2(np.dot(vector, sign * axis), w)
        rest = np.radians(one.closed_deg) - angle
        return float(
            fit.course[known] + sign * (rest - 2.0 * np.pi * np.round(rest / (2.0 * np.pi)))
        )
    if fit.kind == RAIL and one.closed_m is not None:
        apart = body.poses.smooth.positions[known] - base.poses.smooth.positions[known]
        return float(fit.course[known] + sign * (one.closed_m - sign * float(apart @ fit.axis)))
    return None


def _joined(
    body: BodyGeometry,
    other: BodyGeometry,
    base: BodyGeometry,
    fit: GuideFit,
    ends: tuple[int, int],
    thresholds: Thresholds,
) -> bool:
    """Whether bodies hold together on a guide, and none merely is pushed or tips on the other.

    On a rail the base is on both sides of the part. What turns about its own edge, and comes to lie
    on the other, may be tipped, unless the other is leant in the recording, too. What turns about
    a line through its middle may stand on what is fixed, and what goes straight may be pushed.
    """
    if base.planes is None or body.planes is None:
        return False
    stands = other.poses.rests
    if fit.kind == RAIL:
        deeper = max(ends, key=lambda end: inside_share(body, base, end))
        inside = not stands and inside_share(body, base, deeper) >= thresholds.inside_share
        return inside and _confined(body, base, fit.axis, deeper, thresholds)
    line, own_edge = _hinge_line(body, fit, ends[0]), _at_own_edge(body, fit, ends[0], thresholds)
    gaps = (np.maximum(_outside(line, each, ends[0]), 0.0).mean() for each in (body, base))
    if max(gaps) > thresholds.hinge_near_m or (stands and not own_edge):
        return False
    shares = [
        _closed_share(body, base, fit, end, outward, thresholds)
        for end, outward in zip(ends, (-1.0, 1.0), strict=True)
    ]
    if max(shares) < thresholds.closed_share or not own_edge:
        return True
    up = other.turns_at(slice(None)) @ other.turn(int(np.argmin(other.poses.lost))).T @ UP
    return bool((up[:, 2] < np.cos(thresholds.lean_rad)).any())


def _course_by_shapes(
    body: BodyGeometry,
    base: BodyGeometry,
    fit: GuideFit,
    ends: tuple[int, int],
    thresholds: Thresholds,
) -> float | None:
    """The least angle, also beyond those seen, at which a part meets its base all along [rad].

    None where it does so at both ends of its range, or nowhere.
    """
    if base.planes is None or fit.kind == RAIL:
        return None

    def meets(end: int, beyond: float) -> bool:
        arms = Rotation.from_rotvec(beyond * fit.axis).apply(_points(body, end) - fit.point)
        levers = geometry.lengths(np.cross(arms, fit.axis))
        outer = fit.point + arms[levers >= thresholds.outer_share * levers.max()]
        gap_m = float(np.median(np.maximum(_outside(outer, base, end), 0.0)))
        return gap_m <= thresholds.closed_gap_share * levers.max()

    if all(meets(end, 0.0) for end in ends):
        return None
    for beyond in np.arange(0.0, np.pi, thresholds.part_stray_rad):
        for end, sign in zip(ends, (-1.0, 1.0), strict=True):
            if meets(end, sign * beyond):
                return float(fit.course[end] + sign * beyond)
    return None


def _fit(body: BodyGeometry, floor: Floor, thresholds: Thresholds) -> GuideFit | None:
    """The line that the body never leaves, if it moves far enough to tell."""
    known = _known(body)
    middles, turns = body.middles[known], body.orientations[known]
    kinds = [(fit_rail, floor.position_m)]
    if len(middles):
        offset = middles - middles.mean(axis=0)
        least = np.linalg.eigvalsh(offset.T @ offset / len(offset))[0]
        if least > floor.position_m**2 * (1.0 + ROUNDED):
            return None
        # Each round takes the angles from an orientation up to three times as far from all others.
        turned_rad = float(geometry.angle_between(turns, turns[:1]).max())
        if 2.0 * 3.0 ** (ROUNDS - 1) * turned_rad >= thresholds.guide_floors * floor.rotation_rad:
            kinds.append((fit_hinge, floor.rotation_rad))
    for fitted, own in kinds:
        fit = fitted(body)
        if (
            fit is not None
            and np.nanmax(fit.course) - np.nanmin(fit.course) >= thresholds.guide_floors * own
            and np.nanmax(fit.stray_m) <= floor.position_m
            and np.nanmax(fit.stray_rad) <= floor.rotation_rad
        ):
            return fit
    return None


def _closed(
    body: BodyGeometry,
    base: BodyGeometry,
    fit: GuideFit,
    ends: tuple[int, int],
    thresholds: Thresholds,
) -> tuple[bool, float] | None:
    """Whether the body is closed at the first end of its range, and how closed it is [1]."""
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
    if fit.kind == HINGE:
        arm = body.middles[closed] - fit.point
        there = np.linalg.norm(arm) > 0.0 and _at_own_edge(body, fit, closed, thresholds)
        line = _hinge_line(body, fit, closed)
        there = there and _outside(line, base, closed).min() <= thresholds.hinge_near_m
    else:
        there = inside_share(body, base, opened) > 0.0
        there = there and _confined(body, base, fit.axis, closed, thresholds)
    return (closed == ends[0], most) if there else None


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
    arm = body.middles[end] - fit.point
    way = outward * np.cross(fit.axis, arm)
    length = float(np.linalg.norm(way))
    if length <= 0.0:
        return inside
    way = way / length
    # The hinge is at the edge of the base's hull, seen that way, if just beyond it nothing is.
    beyond = _hinge_line(body, fit, end) - thresholds.hinge_near_m * arm / np.linalg.norm(arm)
    enters, leaves = _through(beyond, way, base, end)
    if (enters > leaves).all() or _covers_a_hollow(body, base, end, way, thresholds):
        return _flush_share(body, base, end, way, thresholds)
    return inside


def _at_own_edge(body: BodyGeometry, fit: GuideFit, frame: int, thresholds: Thresholds) -> bool:
    """Whether a body turns about its own edge, or a line next to it."""
    arm = body.middles[frame] - fit.point
    outward = arm / np.linalg.norm(arm)
    corners = body.corners @ body.turn(frame).T + arm
    beside = corners @ np.cross(fit.axis, outward)
    breadth = corners @ outward
    near = thresholds.hinge_near_m
    within = -thresholds.hinge_edge_share * float(np.ptp(breadth))
    return bool(within <= breadth.min() <= near and beside.min() <= near and beside.max() >= -near)


def _confined(
    body: BodyGeometry, base: BodyGeometry, axis: Vector, frame: int, thresholds: Thresholds
) -> bool:
    """Whether another's surface stands close by on both sides of a body, or fills its place."""
    sides = [np.cross(axis, UP)]
    if np.linalg.norm(sides[0]) < thresholds.steep:
        one = np.cross(axis, [1.0, 0.0, 0.0])
        sides = [one, np.cross(axis, one)]
    points = _points(body, frame)
    if base.shape is not None and surface(base.shape).contains(_local(points, base, frame)).any():
        return True
    return any(
        all(
            _ahead(body, base, frame, sign * side / np.linalg.norm(side)).min()
            <= thresholds.rail_play_m
            for sign in (1.0, -1.0)
        )
        for side in sides
    )


def _sliding_door(
    body: BodyGeometry,
    base: BodyGeometry,
    fixed: Iterable[BodyGeometry],
    fit: GuideFit,
    ends: tuple[int, int],
    still_m: float,
    thresholds: Thresholds,
) -> tuple[bool, float] | None:
    """Whether a door on a rail closes an opening at the first end, and how much is flush [1]."""
    side = np.cross(fit.axis, UP)
    length = float(np.linalg.norm(side))
    if length < thresholds.steep:
        return None
    for end in ends:
        if inside_share(body, base, end) >= thresholds.inside_share:
            return None
        if _borne_from_below(body, fixed, end, thresholds):
            return None
    found = [
        _covering(body, base, fit, ends, way, still_m, thresholds)
        for way in (side / length, -side / length)
    ]
    return max((each for each in found if each), key=lambda each: each[1], default=None)


def _covering(
    body: BodyGeometry,
    base: BodyGeometry,
    fit: GuideFit,
    frames: tuple[int, int],
    way: Vector,
    still_m: float,
    thresholds: Thresholds,
) -> tuple[bool, float] | None:
    """Whether it alone covers a hollow at the first end, or covers more, or meets a base's edge."""
    shares = [_flush_share(body, base, frame, way, thresholds) for frame in frames]
    covers = [
        share >= thresholds.closed_share and _covers_a_hollow(body, base, frame, way, thresholds)
        for frame, share in zip(frames, shares, strict=True)
    ]
    if not any(covers):
        return None
    first = covers[0] and (not covers[1] or shares[0] > shares[1])
    if all(covers) and abs(shares[0] - shares[1]) < thresholds.withdrawn_share:
        gaps = []
        for frame, sign in zip(frames, (-1.0, 1.0), strict=True):
            away = sign * fit.axis
            edges = [
                ((each.corners @ each.turn(frame).T + each.middles[frame]) @ away).max()
                for each in (body, base)
            ]
            gaps.append(abs(float(edges[0] - edges[1])))
        if min(gaps) > thresholds.flush_m or abs(gaps[0] - gaps[1]) < still_m:
            return None
        first = gaps[0] < gaps[1]
    return first, max(shares)


def inside_share(body: BodyGeometry, base: BodyGeometry, frame: int) -> float:
    """Share of a body's volume that lies in another's convex hull at a frame [1]."""
    if base.planes is None:
        return 0.0
    return float((_outside(_points(body, frame), base, frame) <= 0.0).mean())


def _flush_share(
    body: BodyGeometry, base: BodyGeometry, frame: int, way: Vector, thresholds: Thresholds
) -> float:
    """Share of a body that is flush against another's convex hull, seen along a direction [1]."""
    points = _points(body, frame)
    front = _through(points, way, body, frame)[1]
    enters, leaves = _through(points, way, base, frame)
    meets = (enters <= leaves) & (leaves >= 0.0)
    return float((meets & (enters - front <= thresholds.flush_m)).mean())


def _covers_a_hollow(
    body: BodyGeometry, base: BodyGeometry, frame: int, way: Vector, thresholds: Thresholds
) -> bool:
    """Whether behind most of a body, along a direction, the other's true surface is not flush."""
    return bool((_ahead(body, base, frame, way) > thresholds.flush_m).mean() > 0.5)


def _borne_from_below(
    body: BodyGeometry, others: Iterable[BodyGeometry], frame: int, thresholds: Thresholds
) -> bool:
    """Whether a true surface of another body is so near below a body that it may lie on it."""
    for other in others:
        near = _ahead(body, other, frame, -UP) <= thresholds.tolerance_most_m
        if other.planes is not None:
            near &= _outside(_points(body, frame), other, frame) > 0.0
        if near.any():
            return True
    return False


def _points(body: BodyGeometry, frame: int) -> Points:
    """Points spread evenly in a body's convex hull, in the world [m]."""
    size = body.shape.size if body.shape else np.zeros(3)
    points = _grid() * size
    if body.planes is not None:
        points = points[(points @ body.planes[:, :3].T + body.planes[:, 3] <= 0.0).all(axis=1)]
    return np.asarray(points @ body.turn(frame).T + body.middles[frame])


@cache
def _grid() -> Points:
    steps = (np.arange(CELLS) + 0.5) / CELLS - 0.5
    return np.stack(np.meshgrid(steps, steps, steps), axis=-1).reshape(-1, 3)


def _hinge_line(body: BodyGeometry, fit: GuideFit, frame: int) -> Points:
    """Points of a hinge's line, as far as its body extends along it, in the world [m]."""
    heights = (body.corners @ body.turn(frame).T + body.middles[frame] - fit.point) @ fit.axis
    along = np.linspace(heights.min(), heights.max(), ALONG)
    return np.asarray(fit.point + along[:, None] * fit.axis)


def _local(points: Points, base: BodyGeometry, frame: int) -> Points:
    """Points of the world in the frame of a body's shape [m]."""
    centre = base.shape.bounds.mean(axis=0) if base.shape else np.zeros(3)
    return np.asarray((points - base.middles[frame]) @ base.turn(frame) + centre)


def _outside(points: Points, base: BodyGeometry, frame: int) -> Float[np.ndarray, "points"]:
    """How far points of the world are outside a body's hull, at least; negative inside [m]."""
    assert base.planes is not None
    local = (points - base.middles[frame]) @ base.turn(frame)
    return np.asarray((local @ base.planes[:, :3].T + base.planes[:, 3]).max(axis=1))


def _through(
    points: Points, way: Vector, body: BodyGeometry, frame: int
) -> tuple[Float[np.ndarray, "points"], Float[np.ndarray, "points"]]:
    """Where lines from points along a direction enter and leave a body's hull [m]."""
    assert body.planes is not None
    local = (points - body.middles[frame]) @ body.turn(frame)
    height = local @ body.planes[:, :3].T + body.planes[:, 3]
    slope = body.planes[:, :3] @ (way @ body.turn(frame))
    with np.errstate(all="ignore"):  # lines along a plane
        at = -height / slope
    enters = np.where(slope < -PARALLEL, at, -np.inf).max(axis=1)
    leaves = np.where(slope > PARALLEL, at, np.inf).min(axis=1)
    misses = ((np.abs(slope) <= PARALLEL) & (height > 0.0)).any(axis=1)
    return np.where(misses, np.inf, enters), leaves


def _ahead(
    body: BodyGeometry, base: BodyGeometry, frame: int, way: Vector
) -> Float[np.ndarray, "points"]:
    """How far beyond a body's front another's true surface is, at each of its points [m]."""
    points = _points(body, frame)
    out = np.full(len(points), np.inf)
    if base.shape is not None:
        local, direction = _local(points, base, frame), way @ base.turn(frame)
        rays = np.broadcast_to(direction, local.shape)
        places, index = surface(base.shape).hits(local, rays, first=True)
        if len(index):
            out[index] = (places - local[index]) @ direction
    return out - _through(points, way, body, frame)[1]


def turns_on_guide(
    guide: Guide, motions: Iterable[Interval], thresholds: Thresholds
) -> tuple[int, ...]:
    """Frames at which a body turns back on its guide, after a real way and before another one.

    It lies in the middle of the frames in which the body is within the floor of motion of the
    place farthest along.
    """
    opening = guide.opening
    found: list[int] = []
    for first, last in motions:
        way = opening[first : last + 1]
        known = np.flatnonzero(~np.isnan(way))
        for turn in known[_extrema(way[known], thresholds.guide_floors * guide.still)]:
            with np.errstate(invalid="ignore"):
                there = np.abs(way - way[turn]) <= guide.still
            begin, end = next(run for run in geometry.runs(there) if run[0] <= turn <= run[1])
            found.append(first + (begin + end) // 2)
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


def guide_location(body: BodyGeometry, base: BodyGeometry, guide: Guide) -> GuideLocation:
    """The line of a body's hinge or rail as places on the body and on its base.

    The place on a hinge is the one next to the middle of the body; on a rail it is that middle,
    where the body is closed. The constraint's own x axis is the line, by the shortest turn.
    """
    fit, frame = guide.fit, guide.closed
    axis = fit.axis if fit.course[guide.opened] > fit.course[frame] else -fit.axis
    about = np.cross([1.0, 0.0, 0.0], axis)
    sine = float(np.linalg.norm(about))
    unit = about / sine if sine > 0.0 else UP
    turn = geometry.quaternions(Rotation.from_rotvec(np.arctan2(sine, axis[0]) * unit))
    point = fit.point if fit.kind == HINGE else body.middles[frame]

    def nlt(of: BodyGeometry) -> Nlt:
        stream = of.poses.settled if of.poses.rests else of.poses.smooth
        place, own = stream.positions[frame], stream.orientations[frame]
        size = np.zeros(3) if of.shape is None else of.shape.size
        return normalised(local_point(place, own, point), relative_orientation(own, turn), size)

    return GuideLocation(
        object=body.name,
        base=base.name,
        kind=fit.kind,
        object_nlt=nlt(body),
        base_nlt=nlt(base),
        opened=float(np.nanmax(guide.opening)),
        residual_m=fit.residual_m,
    )
