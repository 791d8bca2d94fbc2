"""Doors, lids and drawers: bodies that move on one hinge or one rail of a body that stands fixed.

Whatever is pushed straight over a table or turned on the spot fits a line or an axis, too. A door,
a lid or a drawer differs from it by what it is:

* It never leaves its guide: in every frame of the recording its middle and its orientation are
  within the floor of motion of where the fitted line would have them.
* It has a closed place at one end of its range, and only at one: there it lies inside the fixed
  body, or flush against it all over, and at the other end it does not. A block on a table is as
  flush at both ends of its way.
* A hinge is at its own edge and near the fixed body. Where the closed place is outside that body,
  the hinge is at the edge of that body, or what it closes is hollow: a box that is tipped over its
  edge on a table covers nothing.
* What is on a rail is never wholly out of the fixed body, which stands close by on both sides:
  sideways it cannot go.
* A door that slides aside stays before the fixed body's opening, where nothing bears it from below.

What has no closed place in the recording is taken for a thing that was pushed or turned.
"""

from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from capar.model import geometry
from extractors.bodies.body_geometry import BodyGeometry
from extractors.motion.guide_fitting import HINGE, RAIL, GuideFit, fit_hinge, fit_rail, in_one_plane
from extractors.motion.object_motion import Floor
from extractors.relations.guide_places import (
    confined,
    covers_a_hollow,
    flush_share,
    hinge_at_edge_of,
    hinge_at_own_edge,
    hinge_near,
    inside_share,
)
from extractors.relations.sliding_doors import ends_before_opening
from extractors.signals.intervals import Interval
from extractors.thresholds import Thresholds


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
    def way_m(self) -> Float[np.ndarray, "frames"]:
        """How far the body's middle is from its closed place along its path [m]."""
        fit = self.fit
        return self.opening * (fit.radius_m if fit.kind == HINGE else 1.0)

    @property
    def opening(self) -> Float[np.ndarray, "frames"]:
        """How far the body is open at each frame [rad] or [m]; NaN where it was lost."""
        course = self.fit.course
        with np.errstate(invalid="ignore"):
            there = np.abs(course - course[self.closed]) <= self.still
        return np.asarray(np.abs(course - np.median(course[there])))


def guide_of(
    body: BodyGeometry, fixed: Iterable[BodyGeometry], floor: Floor, thresholds: Thresholds
) -> Guide | None:
    """The hinge or the rail on which a body moves throughout; None where there is none.

    Args:
        body: The body, with a shape.
        fixed: Bodies that stand fixed; of several that fit, the one in which it lies most.
        floor: Displacement below which the body is still at a place.
        thresholds: What the criteria decide by.
    """
    if body.shape is None or body.poses.rests:
        return None
    fit = _fit(body, floor, thresholds)
    if fit is None:
        return None
    still = floor.rotation_rad if fit.kind == HINGE else floor.position_m
    bases = tuple(fixed)
    best, most = None, 0.0
    for base in bases:
        found = _closed_end(body, base, fit, still, thresholds)
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


def _closed_end(
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

    Args:
        guide: The guide.
        motions: When the body moves, in time.
        thresholds: The least way, and the floor of motion.
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


def _middle(way: Float[np.ndarray, "frames"], at: int, thresholds: Thresholds) -> int:
    """The middle of the stretch about a frame in which the course is as far as there."""
    with np.errstate(invalid="ignore"):
        there = np.abs(way - way[at]) <= thresholds.motion_floor_m
    for first, last in geometry.runs(there):
        if first <= at <= last:
            return (first + last) // 2
    return at
