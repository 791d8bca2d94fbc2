"""How bodies are arranged to each other, keep together, and are gripped."""

from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from jaxtyping import Bool, Float, Int

from capar.model import geometry
from capar.model.calibration import Calibration, Found
from capar.model.capture import Capture, Stream, TagType
from capar.model.facts import MovesWith, Travels
from capar.model.geometry import Places, Series
from extractors.bodies.bodies import Bodies, BodyGeometry
from extractors.contact.proximity import distance
from extractors.contact.touch_distances import (
    Journey,
    TouchPoints,
    in_either_frame,
    touchable_at,
)
from extractors.signals.filters import derivative, speed
from extractors.signals.intervals import (
    FramePredicate,
    Interval,
    first_where,
    intervals,
    last_where,
)
from extractors.signals.zero_crossings import horizon_frames, pauses, zero_crossings
from extractors.thresholds import Thresholds

Holds = Bool[np.ndarray, "frames"]

BLOCK_VALUES = 1 << 15
"""How many points are placed at once [1]: few enough for a processor's cache."""

BLOCK_POINTS = 1 << 10
"""How many points are compared with all planes at once [1]: few enough for a processor's cache."""


ROUNDED_M = 1e-4
"""By so much a hull may stick out of its box, as its planes are rounded [m]."""


@dataclass(frozen=True, eq=False)
class Pair:
    """A body and another one, with what several arrangements ask of both, computed once."""

    body: BodyGeometry
    other: BodyGeometry
    thresholds: Thresholds

    @cached_property
    def gap(self) -> Series:
        """Distance of their boxes along the world's axes [m]; zero where they overlap."""
        return boxes_apart(self.body, self.other, slice(None))

    @cached_property
    def aside(self) -> Series:
        """How far the body's middle is outside the shadow of the other's box [m]."""
        return beyond_shadow(self.body.middles, *self.other.boxes)

    @cached_property
    def near(self) -> Holds:
        """Whether their boxes came within a hand's length, and are hardly further apart."""
        with np.errstate(invalid="ignore"):
            comes = np.asarray(self.gap <= self.thresholds.near_m)
            stays = np.asarray(self.gap <= self.thresholds.near_stays_m)
        return lasting(comes, stays)

    @cached_property
    def hull_shares(self) -> tuple[Series, Series]:
        """The shares at every frame; where the body is surely not ``inside``, one is too low."""
        frames = np.arange(len(self.body.middles))
        return self.shares(frames, least=self.thresholds.inside_stays_share)

    def shares(
        self, frames: Int[np.ndarray, "some"], *, least: float = 0.0
    ) -> tuple[Float[np.ndarray, "some"], Float[np.ndarray, "some"]]:
        """Shares of the body's points in the other's convex hull, and of those well inside.

        The points are its outermost ones, those halfway to its middle, and its middle. Well inside
        is deeper than bodies that touch cut each other; for this those a quarter of the way count
        beside the outermost, as these touch the bottom of what the body stands in.

        ``least``: a share of the first kind that is below this may be too low.
        """
        within, deep = np.zeros(len(frames)), np.zeros(len(frames))
        with np.errstate(invalid="ignore"):
            meeting = np.flatnonzero(self.gap[frames] <= 0.0)
        length = max(1, BLOCK_VALUES // (3 * len(self.body.corners) + 1))
        for start in range(0, len(meeting) if self.other.planes is not None else 0, length):
            some = meeting[start : start + length]
            within[some], deep[some] = self._shares(frames[some], least)
        return within, deep

    def _shares(
        self, frames: Int[np.ndarray, "some"], least: float
    ) -> tuple[Float[np.ndarray, "some"], Float[np.ndarray, "some"]]:
        corners, other, planes = self.body.corners, self.other, self.other.planes
        assert planes is not None and other.shape is not None
        points = np.concatenate([corners, 0.5 * corners, np.zeros((1, 3)), 0.75 * corners])
        middle = slice(len(corners), 2 * len(corners) + 1)
        back = other.turns_at(frames)
        turns = np.swapaxes(self.body.turns_at(frames), 1, 2) @ back
        offset = (self.body.middles[frames] - other.middles[frames])[:, None] @ back
        local = points @ turns
        local += offset
        half, deep_m = 0.5 * other.shape.size, self.thresholds.tolerance_most_m
        asked = geometry.every(np.abs(local) <= half + 1e-9)
        # The hull is in the box: where few points are, only those matter that are deep in this.
        few = asked[:, : middle.stop].mean(axis=1) < least
        asked[few, middle] = False
        candidates = local[asked]
        near = geometry.every(np.abs(candidates) <= half - deep_m + ROUNDED_M)
        near |= ~np.repeat(few, asked.sum(axis=1))
        candidates, found = candidates[near], np.full(len(near), np.inf)
        height = np.empty(len(candidates))
        for start in range(0, len(candidates), BLOCK_POINTS):
            part = slice(start, start + BLOCK_POINTS)
            height[part] = (candidates[part] @ planes[:, :3].T + planes[:, 3]).max(axis=1)
        heights = np.full(asked.shape, np.inf)
        found[near] = height
        heights[asked] = found
        ends = np.delete(heights, middle, axis=1)
        return (
            (heights[:, : middle.stop] <= 0.0).mean(axis=1),
            (ends <= -deep_m).mean(axis=1),
        )


def inside(pair: Pair) -> Holds:
    """At least half of the body came to lie in the other's hull, and hardly less does now.

    What lies across an opening is above it: its middle is not below the other's top. A body without
    a shape is a point, and that of what lies on a table may be in it as far as bodies that touch
    cut each other: it is inside where it is well inside.
    """
    within, deep = pair.hull_shares
    share, limits = (deep if pair.body.shape is None else within), pair.thresholds
    held = lasting(share >= limits.inside_share, share >= limits.inside_stays_share)
    with np.errstate(invalid="ignore"):
        return np.asarray(held & (pair.body.middles[:, 2] <= pair.other.boxes[1][:, 2]))


def dips(pair: Pair) -> Holds:
    """One end of it is in the other's hull, deeper than bodies that touch cut each other."""
    return np.asarray(pair.hull_shares[1] > 0.0)


def above(pair: Pair) -> Holds:
    """It is higher than the other's top, within 45 degrees of the vertical from its shadow."""
    low, high = pair.body.boxes[0][:, 2], pair.other.boxes[1][:, 2]
    rise = pair.body.middles[:, 2] - high
    with np.errstate(invalid="ignore"):
        return np.asarray(
            (low >= high - pair.thresholds.tolerance_most_m) & (rise > 0.0) & (pair.aside <= rise)
        )


def below(pair: Pair) -> Holds:
    """It is lower than the other's bottom, under its shadow."""
    high, low = pair.body.boxes[1][:, 2], pair.other.boxes[0][:, 2]
    with np.errstate(invalid="ignore"):
        return np.asarray((high <= low + pair.thresholds.tolerance_most_m) & (pair.aside <= 0.0))


def beside(pair: Pair) -> Holds:
    """It is near, at the same height, and not in its shadow."""
    low, high = pair.body.boxes
    bottom, top = pair.other.boxes
    with np.errstate(invalid="ignore"):
        heights = (low[:, 2] <= top[:, 2]) & (high[:, 2] >= bottom[:, 2])
        return np.asarray(heights & pair.near & (pair.aside > 0.0))


def along(pair: Pair) -> Holds:
    """It moves near the other, in the direction of its longest axis if it has one."""
    body, other, thresholds = pair.body, pair.other, pair.thresholds
    out = np.zeros(len(body.middles), dtype=bool)
    if other.shape is None or not pair.near.any():
        return out
    sizes = np.sort(other.shape.size)
    if sizes[2] < 2.0 * sizes[1]:
        return out
    near = np.flatnonzero(pair.near)
    axis = other.turns_at(near)[:, :, int(np.argmax(other.shape.size))]
    step = derivative(body.middles, body.poses.smooth.times)[near]
    pace = geometry.lengths(step)
    with np.errstate(invalid="ignore"):
        straight = np.abs(np.einsum("ij,ij->i", step, axis)) >= np.cos(thresholds.along_rad) * pace
        out[near] = straight & (pace > thresholds.rest_speed_mps)
    return out


def between(body: BodyGeometry, one: BodyGeometry, other: BodyGeometry) -> Holds:
    """Its middle is in a straight tube that joins two bodies, in neither of their boxes."""
    line = other.middles - one.middles
    with np.errstate(invalid="ignore", divide="ignore"):
        share = np.einsum("ij,ij->i", body.middles - one.middles, line) / np.einsum(
            "ij,ij->i", line, line
        )
        off = geometry.lengths(body.middles - one.middles - share[:, None] * line)
        wide = min(float(geometry.lengths(each.corners).max()) for each in (one, other))
        tube = np.flatnonzero((share > 0.0) & (share < 1.0) & (off <= wide))
    out = np.zeros(len(share), dtype=bool)
    out[tube] = ~_holds(one, body.middles, tube) & ~_holds(other, body.middles, tube)
    return out


def boxes_apart(
    body: BodyGeometry, other: BodyGeometry, frames: Int[np.ndarray, "some"] | slice
) -> Float[np.ndarray, "some"]:
    """Distance of two bodies' boxes along the world's axes [m]; zero where they overlap."""
    low, high = (ends[frames] for ends in body.boxes)
    bottom, top = (ends[frames] for ends in other.boxes)
    outside = np.maximum(np.maximum(low - top, bottom - high), 0.0)
    return np.asarray(geometry.lengths(outside))


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


def lasting(comes: Holds, stays: Holds) -> Holds:
    """What holds from where it clearly does for as long, to both sides, as it still does."""
    out = comes.copy()
    for first, last in geometry.runs(comes | stays):
        out[first : last + 1] = bool(comes[first : last + 1].any())
    return out


ARRANGEMENTS: dict[str, Callable[[Pair], Holds]] = {
    "inside": inside,
    "dips": dips,
    "above": above,
    "below": below,
    "beside": beside,
    "along": along,
}
"""Every arrangement of two bodies by its name in facts."""


def beyond_shadow(point: Places, low: Places, high: Places) -> Series:
    """How far a point is outside a box's shadow on the ground [m]."""
    outside = np.maximum(np.maximum(low - point, point - high), 0.0)
    return np.asarray(geometry.lengths(outside[:, :2]))


def _holds(
    box: BodyGeometry, points: Places, frames: Int[np.ndarray, "some"]
) -> Bool[np.ndarray, "some"]:
    low, high = (ends[frames] for ends in box.boxes)
    some = points[frames]
    return geometry.every((some >= low) & (some <= high))


SAMPLES = 5
"""In how many frames of a stretch the distance of surfaces is measured; the median counts."""


def company(
    names: Iterable[str],
    capture: Capture,
    bodies: Bodies,
    calibration: Calibration,
    thresholds: Thresholds,
) -> Iterator[Travels | MovesWith]:
    """When each of some mobile objects travels, and in whose frame it is steady meanwhile.

    Asked are all sensors but those on parts of an end-effector, and all other mobile objects. A
    stretch is extended to the frames before and after it in which either is no farther from where
    it then was in the other's frame than fingers open about what they let go.
    """
    mobile = [body.name for body in capture.objects if body.tag is TagType.MOBILE]
    carriers = {*mobile, *(sensor.name for sensor in capture.acting)}
    for name in names:
        thing = bodies.objects[name]
        journey = Journey(thing.poses.settled, thresholds)
        if not journey.travels.any():
            continue
        for span in _spans(journey.travels, capture, thresholds):
            yield Travels(name, *span)
        wholes = [bodies.sensors[each.name] for each in capture.sensors if not each.part_of]
        others = [*wholes, *(bodies.objects[each] for each in mobile)]
        for other in others:
            if other.name == name or other.poses is thing.poses:
                continue
            parts = bodies.on_end_effector(other.name) if other.name in bodies.parts else (other,)
            reach_m = thresholds.company_reach_m if other.name in carriers else np.inf
            # One finger of a hand may carry it.
            together = (
                (one, span)
                for one in parts
                for span in _together(one.poses.settled, journey, capture, thresholds)
            )
            for one, span in together:
                near = parts if one is other else (one,)
                gaps = [_gap(part, thing, span, calibration, reach_m) for part in near]
                gap = min(filter(np.isfinite, gaps), default=np.inf)
                if np.isfinite(gap):
                    yield MovesWith(name, other.name, *span, round(1000.0 * gap))


def _together(
    carrier: Stream, journey: Journey, capture: Capture, thresholds: Thresholds
) -> list[Interval]:
    thing, frames = journey.thing, journey.steady_in(carrier)
    out = frames.copy()
    for first, last in geometry.runs(frames):
        before = last_where(_strays(carrier, thing, first, thresholds.touch_margin_m), first)
        strays = _strays(carrier, thing, last, thresholds.touch_margin_m)
        after = first_where(strays, last, len(out))
        out[0 if before is None else before + 1 : first] = True
        out[last:after] = True
    return _spans(out, capture, thresholds)


def _strays(carrier: Stream, thing: Stream, edge: int, margin_m: float) -> FramePredicate:
    """Whether both of two bodies have left their places at a frame, each in the other's frame."""
    then = in_either_frame(carrier, thing, slice(edge, edge + 1))

    def strays(some: slice) -> Bool[np.ndarray, "some"]:
        places = in_either_frame(carrier, thing, some)
        pairs = zip(places, then, strict=True)
        ways = [geometry.lengths(place - at_edge) for place, at_edge in pairs]
        return ~np.asarray(np.minimum(*ways) <= margin_m)

    return strays


def _spans(
    holds: Bool[np.ndarray, "frames"], capture: Capture, thresholds: Thresholds
) -> list[Interval]:
    dropout_s, minimum_s = thresholds.dropout_s, thresholds.contact_minimum_s
    return intervals(holds, capture.times, dropout_s=dropout_s, minimum_s=minimum_s)


def _gap(
    other: BodyGeometry,
    thing: BodyGeometry,
    span: Interval,
    calibration: Calibration,
    reach_m: float,
) -> float:
    """How much farther apart than where they touch two bodies are in a stretch [m]."""
    some = np.unique(np.linspace(*span, SAMPLES).round().astype(int))
    points, touch_m, pivots = TouchPoints(), 0.0, other.shape is None or thing.shape is None
    for first, second in ((other.name, thing.name), (thing.name, other.name)):
        pair = calibration.sought(first, second)
        if pair is None:
            continue
        touch_m, pivots = pair.touch_m, pair.pivots
        if pair.found is Found.NEVER:
            pivots = True
        one, two = pair.first_point, pair.second_point
        points = TouchPoints(one, two) if first == other.name else TouchPoints(two, one)
        break
    apart: Series
    if pivots:
        apart = points.apart(other.poses.settled, thing.poses.settled, some)
    else:
        lost = other.poses.lost[some] | thing.poses.lost[some]
        known = some[~lost]
        apart = boxes_apart(other, thing, known)
        if not known.size or np.median(apart) <= reach_m:
            both = [[touchable_at(each, int(f)) for each in (other, thing)] for f in known]
            apart = np.array([distance(one, two, 0) for one, two in both])
    known_m = apart[~np.isnan(apart)]
    return max(0.0, float(np.median(known_m)) - touch_m) if known_m.size else float("nan")


FEWEST_FRAMES = 5
"""Fewest frames of a contact in which a change of place can be detected [1].

No threshold: two slowest samples, a faster one between them, and one on each side.
"""


def shifts(
    hand: BodyGeometry, thing: BodyGeometry, touching: Interval, thresholds: Thresholds
) -> Iterator[Interval]:
    """From the last pause at one place on an object to the first at another, as closed intervals.

    The place is where the end-effector's middle is in the object's own frame. It pauses there
    where it is slowest in that frame, while hand and object may move together. Another place is
    farther from the first pause at the old one than a hand is wide.

    ``touching``: frames through which it does.
    """
    first, last = touching
    if last - first + 1 < FEWEST_FRAMES:
        return
    part = slice(first, last + 1)
    offset = hand.middles[part] - thing.middles[part]
    place = np.einsum("fij,fi->fj", thing.turns_at(part), offset)
    times = hand.poses.smooth.times[part]
    pace = speed(place, times)
    noise = max(hand.poses.noise.position_m, thing.poses.noise.position_m)
    crossings = zero_crossings(
        pace, times, noise_m=noise, highest_mps=float(np.nanmax(pace)), thresholds=thresholds
    )
    stops = [int(each) for each in pauses(pace, crossings, horizon_frames(times, thresholds))]
    if not stops:
        return
    anchor = latest = stops[0]
    for seat in stops[1:]:
        if float(np.linalg.norm(place[seat] - place[anchor])) > thresholds.hand_width_m:
            yield first + latest, first + seat
            anchor = seat
        latest = seat
