"""The distance within which bodies without meshes touch, estimated from co-motion and rest."""

from collections.abc import Iterable, Iterator
from dataclasses import dataclass, replace
from functools import cache, cached_property
from weakref import WeakKeyDictionary

import numpy as np
from jaxtyping import Float, Int
from scipy.ndimage import maximum_filter1d, minimum_filter1d, uniform_filter1d

from capar.model import geometry
from capar.model.calibration import Found, PairCalibration
from capar.model.capture import Capture, Role, Shape, ShapeSource, Stream, TagType
from capar.model.geometry import Holds, Places, Series
from extractors.bodies.bodies import Bodies, BodyGeometry
from extractors.bodies.poses import rotation_matrices
from extractors.contact.proximity import Body, at_frame, body, distance
from extractors.contact.surfaces import Surface, surface
from extractors.motion.object_motion import motion_floor, rest_poses, resting
from extractors.signals.intervals import frame_rate, mask
from extractors.thresholds import Thresholds

Points = Places
Some = Int[np.ndarray, "some"] | Holds


class Journey:
    """Where a thing covers some way in the world, and who it goes with; many are asked of one."""

    def __init__(self, thing: Stream, thresholds: Thresholds) -> None:
        """Seek where it travels, within the window of co-motion about each frame."""
        self.thing, self.thresholds = thing, thresholds
        self.way = spread(thing.positions, thing, thresholds)
        with np.errstate(invalid="ignore"):
            self.travels = np.asarray(self.way >= thresholds.co_motion_way_m)

    @cached_property
    def _asked(self) -> tuple[Int[np.ndarray, "some"], Holds]:
        """The frames in which it travels, and half a window about, run by run; and which are these.

        Before and after each run its first and last frame stand as often as a window reaches, so
        that what is filtered of one run is not of the next.
        """
        reach = _half_window(self.thing, self.thresholds)
        wide = maximum_filter1d(self.travels.view(np.uint8), 2 * reach + 1, mode="nearest")
        runs = np.array(geometry.runs(wide.astype(bool)), dtype=int).reshape(-1, 2)
        counts = np.diff(runs, axis=1)[:, 0] + 1 + 2 * reach
        first, last = np.repeat(runs, counts, axis=0).T
        begins = np.repeat(np.cumsum(counts) - counts, counts)
        at = np.arange(len(first)) - begins + first - reach
        return np.clip(at, first, last), (first <= at) & (at <= last)

    @cached_property
    def _turns(self) -> Float[np.ndarray, "some 3 3"]:
        return rotation_matrices(self.thing.orientations[self._asked[0]])

    def steady_in(self, carrier: Stream) -> Holds:
        """Where the thing covers some way and stays where it is in a carrier's frame.

        Or the carrier stays where it is in the thing's frame, as a hand does that takes a large
        thing by its rim and tips it: its origin, far from the hand, then strays in the hand's
        frame. Steady means that it strays there by no more than a centimetre, or by no more than a
        share of its way through the world, within the window of co-motion.
        """
        out, (some, own) = np.zeros(len(self.way), dtype=bool), self._asked
        offset = self.thing.positions[some] - carrier.positions[some]
        turns = rotation_matrices(carrier.orientations[some])
        places = (np.einsum("fji,fj->fi", each, offset) for each in (turns, self._turns))
        stray = np.minimum(*(spread(each, self.thing, self.thresholds)[own] for each in places))
        most, share = self.thresholds.co_motion_stray_m, self.thresholds.co_motion_share
        frames = some[own]
        with np.errstate(invalid="ignore"):
            steady = stray <= np.maximum(most, share * self.way[frames])
        out[frames] = self.travels[frames] & steady
        return out


def in_either_frame(one: Stream, other: Stream, some: slice) -> tuple[Points, Points]:
    """The origin of each of two bodies in the other's frame [m], at some frames."""
    return relative(one, other, some), relative(other, one, some)


def relative(frame_of: Stream, thing: Stream, some: slice) -> Points:
    """A body's origin in another's frame [m] at some frames; NaN where either is lost."""
    turns = rotation_matrices(frame_of.orientations[some])
    offset = thing.positions[some] - frame_of.positions[some]
    return np.asarray(np.einsum("fji,fj->fi", turns, offset))


def spread(points: Points, stream: Stream, thresholds: Thresholds) -> Series:
    """Diagonal of the box that points cover within the window around each frame [m].

    It is NaN where one of them is not known.
    """
    size = 2 * _half_window(stream, thresholds) + 1
    lost = ~geometry.is_known(points)
    known = np.where(lost[:, None], 0.0, points) if lost.any() else points
    high = maximum_filter1d(known, size, axis=0, mode="nearest")
    low = minimum_filter1d(known, size, axis=0, mode="nearest")
    out = geometry.lengths(high - low)
    if lost.any():
        out[maximum_filter1d(lost.view(np.uint8), size, mode="nearest").astype(bool)] = np.nan
    return out


def _half_window(stream: Stream, thresholds: Thresholds) -> int:
    """Frames of the window of co-motion to either side [1]."""
    return max(1, round(0.5 * thresholds.co_motion_window_s * frame_rate(stream.times)))


Vector = tuple[float, float, float]


@dataclass(frozen=True, slots=True)
class TouchPoints:
    """A point of each body, in its own frame [m]; they coincide where the bodies touch."""

    first: Vector = (0.0, 0.0, 0.0)
    second: Vector = (0.0, 0.0, 0.0)

    def apart(self, first: Stream, second: Stream, some: Some | slice = slice(None)) -> Series:
        """Distance of the two points at some frames [m]; NaN where either body is lost."""
        return geometry.lengths(_at(first, self.first, some) - _at(second, self.second, some))


def touch_points(
    first: Stream, second: Stream, frames: Holds, thresholds: Thresholds
) -> TouchPoints:
    """The points that stay nearest to each other through some frames, by least squares.

    Another origin of a body's stream moves its point by the same offset the other way, so the
    distance of the points hardly depends on where on its body a marker cluster sits.
    """
    turns = (
        rotation_matrices(first.orientations[frames]),
        rotation_matrices(second.orientations[frames]),
    )
    rows = np.concatenate([turns[0], -turns[1]], axis=2)
    offset = second.positions[frames] - first.positions[frames]
    normal = np.einsum("fij,fik->jk", rows, rows) / len(rows) + thresholds.touch_ridge * np.eye(6)
    right = np.einsum("fij,fi->j", rows, offset) / len(rows)
    found = [float(value) for value in np.linalg.solve(normal, right)]
    return TouchPoints((found[0], found[1], found[2]), (found[3], found[4], found[5]))


def _at(stream: Stream, point: Vector, some: Some | slice) -> Places:
    turns = rotation_matrices(stream.orientations[some])
    return np.asarray(stream.positions[some] + turns @ np.array(point))


HAND = "hand"
"""The end-effector that takes hold of things it does not move."""

Frames = Holds


@dataclass(frozen=True, eq=False)
class Evidence:
    """What the bodies of a capture do to each other, as far as it tells who touches whom."""

    capture: Capture
    bodies: Bodies
    thresholds: Thresholds

    @cached_property
    def carried(self) -> dict[tuple[str, str], Frames]:
        """By end-effector and mobile object, where it surely carries the object."""
        out = {}
        for thing in self._mobile:
            journey = Journey(thing.poses.settled, self.thresholds)
            least = self.thresholds.co_motion_least * max(int(journey.travels.sum()), 1)
            for sensor in self.capture.acting:
                carrier = self.bodies.sensors[sensor.name]
                if carrier.poses is thing.poses:
                    continue
                frames = journey.steady_in(carrier.poses.settled)
                if frames.sum() > least and self._lasts(frames):
                    out[sensor.name, thing.name] = frames
        return out

    @cached_property
    def gripped(self) -> dict[tuple[str, str], Frames]:
        """The same, with the frames before and after in which their distance is no other."""
        return {
            (hand, thing): self._nearby(hand, thing, frames)
            for (hand, thing), frames in self.carried.items()
        }

    def held(self, name: str) -> Frames:
        """Where some end-effector surely holds a thing, or an end-effector something."""
        out = np.zeros(len(self.capture.times), dtype=bool)
        for pair, frames in self.gripped.items():
            out |= frames & (name in pair)
        return out

    def unheld_rest(self, thing: str) -> Frames:
        """Where a thing rests and nobody surely holds it."""
        return mask(self._rests(thing), len(self.capture.times)) & ~self.held(thing)

    def settled(self, hand: str) -> dict[str, Frames]:
        """By object, where a hand without load rests by it and by no nearer one.

        The rests with which a recording begins and ends are the person's posture, not contact.
        """
        own = self.bodies.sensors[hand]
        last = len(self.capture.times) - 1
        spans = resting(own.poses, self.thresholds)
        home = mask([each for each in spans if each[0] == 0 or each[1] == last], last + 1)
        free = mask([each for each in spans if each[0] > 0 and each[1] < last], last + 1)
        known = {thing for name, thing in self.gripped if name == hand}
        others = [each for each in self._mobile if each.name not in known and each.name != hand]
        return self._nearest(own, free & ~self.held(hand), home, others)

    def dwelling(self, thing: str) -> dict[str, Frames]:
        """By object, where a held thing dwells by it and by no nearer one."""
        own = self.bodies.objects[thing]
        apart = self.unheld_rest(thing)
        # Where it is at a place at which it also rests while nobody holds it, it is laid down.
        spans = [(a, z) for a, z in self._rests(thing) if apart[a : z + 1].any()]
        laid_down = mask(spans, len(self.capture.times))
        dwells = self._dwells(own) & self.held(thing) & ~laid_down
        others = [each for each in self._mobile if each.name != thing]
        return self._nearest(own, dwells, apart, others)

    def _nearest(
        self, own: BodyGeometry, frames: Frames, apart: Frames, others: list[BodyGeometry]
    ) -> dict[str, Frames]:
        """By object that rests by itself, where it is the nearest, if nearer than when apart."""
        gaps: dict[str, Series] = {}
        for other in others:
            offset = own.poses.settled.positions - other.poses.settled.positions
            gap = geometry.lengths(offset)
            limit = self.thresholds.settle_reach_m
            if apart.any():
                usual = float(np.nanmedian(gap[apart]))
                limit = min(limit, usual - self.thresholds.settle_nearer_m)
            there = (
                frames & self.unheld_rest(other.name) & (np.nan_to_num(gap, nan=np.inf) <= limit)
            )
            gaps[other.name] = np.where(there, gap, np.inf)
        if not gaps:
            return {}
        least = np.min(list(gaps.values()), axis=0)
        found = {name: np.isfinite(gap) & (gap == least) for name, gap in gaps.items()}
        return {name: each for name, each in found.items() if self._lasts(each)}

    def _nearby(self, hand: str, thing: str, frames: Frames) -> Frames:
        one, two = self.bodies.sensors[hand].poses.settled, self.bodies.objects[thing].poses.settled
        apart = touch_points(one, two, frames, self.thresholds).apart(one, two)
        limit = float(np.quantile(apart[frames], self.thresholds.touch_quantile))
        with np.errstate(invalid="ignore"):
            return np.asarray(apart <= limit + self.thresholds.touch_margin_m)

    def _dwells(self, own: BodyGeometry) -> Frames:
        """Where the mean place over the time of dwelling hardly moves within that time."""
        stream = own.poses.settled
        size = max(1, round(self.thresholds.dwell_s * frame_rate(stream.times)))
        known = ~stream.lost[:, None]
        sums = uniform_filter1d(np.where(known, stream.positions, 0.0), size, axis=0)
        count = uniform_filter1d(known.astype(float), size, axis=0)
        means = np.where(known, sums / np.maximum(count, 1.0 / size), np.nan)
        way = spread(means, stream, self.thresholds)
        with np.errstate(invalid="ignore"):
            return np.asarray(way <= self.thresholds.dwell_m)

    def _rests(self, thing: str) -> list[tuple[int, int]]:
        body, last = self.bodies.objects[thing], len(self.capture.times) - 1
        own = self.capture.tag_object(thing)
        if own.tag is TagType.FIXED or body.poses.still:
            return [(0, last)]
        floor = motion_floor(
            body.poses.noise,
            frame_rate(self.capture.times),
            own_m=own.motion_floor_m,
            thresholds=self.thresholds,
        )
        return [each.interval for each in rest_poses(body.poses, floor, self.thresholds)]

    @cached_property
    def _mobile(self) -> list[BodyGeometry]:
        objects = self.capture.objects
        return [self.bodies.objects[each.name] for each in objects if each.tag is TagType.MOBILE]

    def _lasts(self, frames: Frames) -> bool:
        step_s = 1.0 / frame_rate(self.capture.times)
        return bool(frames.sum() * step_s >= self.thresholds.rest_minimum_s)


SAMPLES = 100
"""In how many frames at most distances to a surface are measured for an estimate."""

GAP_SAMPLES = 15
"""In how many frames at most a gap between surfaces is measured, of which the median counts."""

POINT_M = 0.0005
"""Radius of the ball that stands for a body's origin [m]: far less than any distance of touch."""


def estimated_pair(
    capture: Capture,
    first: BodyGeometry,
    second: BodyGeometry,
    evidence: Evidence,
    tolerance_m: float,
) -> PairCalibration:
    """At which distance two bodies touch, one of which has no surface.

    ``evidence``: what the bodies do to each other. ``tolerance_m``: what is added to where a thing
    rests on a support [m].
    """
    limits = evidence.thresholds
    for found, frames in _witnesses(capture, first.name, second.name, evidence):
        if frames.any():
            margin = tolerance_m if found is Found.REST else limits.touch_margin_m
            points = first.shape is None and second.shape is None
            return _pair(first, second, found, frames, margin, limits, points=points)
    return PairCalibration(first.name, second.name, 0.0, 0.0, pivots=True, found=Found.NEVER)


def stated_pair(
    capture: Capture,
    first: BodyGeometry,
    second: BodyGeometry,
    evidence: Evidence,
    distance_m: float,
) -> PairCalibration:
    """A distance of origins that the capture states, and what the recording shows against it.

    It is contradicted where it is less than the distance in most frames of sure contact, or more
    than that by twice the margin of an estimate.
    """
    taken = PairCalibration(
        first.name, second.name, distance_m, distance_m, pivots=True, found=Found.STATED
    )
    limits = evidence.thresholds
    for _, frames in _witnesses(capture, first.name, second.name, evidence):
        if frames.any():
            apart = TouchPoints().apart(first.poses.settled, second.poses.settled, frames)
            far_m = float(np.quantile(apart, limits.touch_quantile))
            fits = far_m <= distance_m <= far_m + 2.0 * limits.touch_margin_m
            shown_m = None if fits else far_m + limits.touch_margin_m
            return replace(taken, frames=int(frames.sum()), shown_m=shown_m)
    return taken


def with_gaps(
    pairs: Iterable[PairCalibration], bodies: Bodies, evidence: Evidence
) -> Iterator[PairCalibration]:
    """Pairs of surfaces with the gap at which one steadily carries the other, if it has one.

    Of all the end-effectors that move as one with an object it is the nearest that carries it;
    if it touches the object within the distance of release there is no gap. Where one of the
    surfaces is a stand-in, the bodies touch at the gap, as bodies without surfaces do.
    """
    known = list(pairs)
    gaps: dict[tuple[str, str], float] = {}
    for pair in known:
        frames = evidence.carried.get((pair.first, pair.second))
        if pair.found is Found.TOLERANCE and frames is not None:
            thing = bodies.objects[pair.second]
            apart = [
                _surface_distances(part, thing, frames, GAP_SAMPLES)
                for part in bodies.on_end_effector(pair.first)
                if part.shape is not None
            ]
            gaps[pair.first, pair.second] = float(np.median(np.min(apart, axis=0)))
    for pair in known:
        rivals = [gap for (_, thing), gap in gaps.items() if thing == pair.second]
        gap_m = gaps.get((pair.first, pair.second), 0.0)
        if pair.release_m < gap_m <= evidence.thresholds.settle_reach_m and gap_m == min(rivals):
            frames, limits = evidence.carried[pair.first, pair.second], evidence.thresholds
            carrier, thing = bodies.sensors[pair.first], bodies.objects[pair.second]
            sources = {each.shape.source for each in (carrier, thing) if each.shape is not None}
            if ShapeSource.STAND_IN in sources:
                margin_m = limits.touch_margin_m
                yield _pair(carrier, thing, Found.CO_MOTION, frames, margin_m, limits, points=True)
            else:
                yield replace(pair, frames=int(frames.sum()), shown_m=gap_m)
        else:
            yield pair


def _witnesses(
    capture: Capture, first: str, second: str, evidence: Evidence
) -> Iterator[tuple[Found, Holds]]:
    """Kinds of evidence for a pair, the surest first."""
    nowhere = np.zeros(len(capture.times), dtype=bool)
    acting = {each.name: each.end_effector for each in capture.sensors if each.role is Role.ACTS}
    tags = {each.name: each.tag for each in capture.objects}
    if first in acting:
        yield Found.CO_MOTION, evidence.carried.get((first, second), nowhere)
        if acting[first] == HAND:
            yield Found.SETTLING, evidence.settled(first).get(second, nowhere)
        return
    for one, other in ((first, second), (second, first)):
        if tags[one] is TagType.MOBILE and tags[other] is TagType.FIXED:
            yield Found.REST, evidence.unheld_rest(one)
        elif tags[one] is TagType.MOBILE:
            yield Found.SETTLING, evidence.dwelling(one).get(other, nowhere)


def _pair(
    first: BodyGeometry,
    second: BodyGeometry,
    found: Found,
    frames: Holds,
    margin_m: float,
    thresholds: Thresholds,
    *,
    points: bool,
) -> PairCalibration:
    """The distance of the points that stay nearest to each other, or of surfaces, and a margin."""
    touch = TouchPoints()
    if points:
        touch = touch_points(first.poses.settled, second.poses.settled, frames, thresholds)
        apart = touch.apart(first.poses.settled, second.poses.settled, frames)
    else:
        apart = _surface_distances(first, second, frames, SAMPLES)
    touch_m = float(np.quantile(apart, thresholds.touch_quantile)) + margin_m
    return PairCalibration(
        first.name,
        second.name,
        touch_m,
        touch_m,
        pivots=points,
        found=found,
        frames=int(frames.sum()),
        first_point=touch.first,
        second_point=touch.second,
    )


def _surface_distances(
    first: BodyGeometry, second: BodyGeometry, frames: Holds, most: int
) -> Float[np.ndarray, "some"]:
    """How far two bodies are apart in some of the frames [m]; a body without shape is a point."""
    every = np.flatnonzero(frames)
    some = every[np.linspace(0, len(every) - 1, min(most, len(every))).round().astype(int)]
    one, two = touchable(first), touchable(second)
    return np.array([distance(one, two, int(frame)) for frame in some])


def touchable(each: BodyGeometry) -> Body:
    """The surface of a body at its poses; of one without a shape, a speck at its origin."""
    if each not in _TOUCHABLE:
        _TOUCHABLE[each] = body(_surface(each), each.poses.settled, rests=each.poses.rests)
    return _TOUCHABLE[each]


def forget_touchable(bodies: Iterable[BodyGeometry]) -> None:
    """Keep the surfaces of some bodies at their poses no longer: they are made again when asked."""
    for body_geometry in bodies:
        _TOUCHABLE.pop(body_geometry, None)


def touchable_at(each: BodyGeometry, frame: int) -> Body:
    """The same at one frame, which is its frame 0."""
    return at_frame(_surface(each), each.poses.settled, frame)


def _surface(each: BodyGeometry) -> Surface:
    return surface(_speck() if each.shape is None else each.shape)


@cache
def _speck() -> Shape:
    """What stands for a body that has no shape."""
    import trimesh

    ball = trimesh.creation.icosphere(subdivisions=0, radius=POINT_M)
    return Shape(np.asarray(ball.vertices), np.asarray(ball.faces), ShapeSource.STAND_IN, "a point")


_TOUCHABLE: WeakKeyDictionary[BodyGeometry, Body] = WeakKeyDictionary()
"""Of bodies that were asked for before: each is in many pairs."""


def touching_part(bodies: Bodies, ee: str, other: BodyGeometry, frame: int) -> BodyGeometry:
    """The part of an end-effector that is nearest to a body at a frame; of equals the first.

    Its own body, where no part is known and has a shape at that frame.
    """
    parts = bodies.on_end_effector(ee)
    known = [each for each in parts if each.shape is not None and not each.poses.lost[frame]]
    if len(parts) == 1 or not known or other.poses.lost[frame]:
        return parts[0]
    there = touchable_at(other, frame)
    return min(known, key=lambda each: distance(touchable_at(each, frame), there, 0))
