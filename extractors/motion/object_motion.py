"""When objects move and when they rest."""

from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from functools import partial
from itertools import pairwise
from typing import Any, TypeVar, cast
from weakref import WeakKeyDictionary

import numpy as np
from jaxtyping import Bool, Float
from scipy.ndimage import correlate1d

from capar.model import geometry
from capar.model.capture import Stream
from capar.model.geometry import Holds, Quaternion, Series, Vector
from extractors.bodies.poses import Poses, median_pose
from extractors.signals.filters import Noise, gains
from extractors.signals.intervals import (
    Interval,
    first_where,
    frame_rate,
    intervals,
    last_where,
    mask,
)
from extractors.thresholds import Thresholds


@dataclass(frozen=True, eq=False)
class RestPose:
    """A place where an object rests, and the frames through which it is there."""

    interval: Interval
    position: Vector
    """World position [m]."""

    orientation: Quaternion
    """Unit quaternion w x y z."""

    frames: int
    """By how many frames the place is told [1]."""

    came: "RestPose | None" = None
    """The same rest at the place where it began; None where the object creeps."""

    missing: int = 0
    """By how many frames more the place where it began is to be told, as it has just begun [1]."""

    @property
    def at_first(self) -> "RestPose":
        """The rest at the place to which the object came, which is known soon after it did."""
        return self.came or self


@dataclass(frozen=True, slots=True)
class Floor:
    """Displacement from a place below which an object is still there."""

    position_m: float
    rotation_rad: float


def motion_floor(
    noise: Noise, rate_hz: float, *, own_m: float | None, thresholds: Thresholds
) -> Floor:
    """The floor of an object's motion: its own if it has one, else above the noise.

    ``noise``: noise of the object's unfiltered stream. ``own_m``: the floor that the capture states
    for this object [m], which holds as it is.
    """
    left = thresholds.motion_sigmas * gains(rate_hz, thresholds)[0]
    place = max(thresholds.motion_floor_m, left * noise.position_m)
    turn = max(thresholds.motion_floor_rad, left * noise.orientation_rad)
    if own_m is None:
        return Floor(place, turn)
    # What gives way under a hand also turns: the angle grows as the length does.
    return Floor(own_m, max(turn, thresholds.motion_floor_rad * own_m / thresholds.motion_floor_m))


def rest_poses(poses: Poses, floor: Floor, thresholds: Thresholds) -> tuple[RestPose, ...]:
    """Places where the object rests, in time, with all frames at which it is not beyond the floor.

    A rest pose is extended from a stretch in which the object is slow for the least duration of
    rest; its place is the middle of the poses there; it holds all contiguous frames within the
    floor of that place, so the last millimetres of a landing belong to it. When it began is told by
    the place to which the object came, the middle of its first poses: however long an object lies
    there, that is settled soon.
    """
    return _kept(poses, (floor, thresholds), lambda: tuple(_rests(poses, floor, thresholds)))


_Found = TypeVar("_Found")
_KEPT: WeakKeyDictionary[Poses, dict[object, Any]] = WeakKeyDictionary()


def _kept(poses: Poses, asked: object, find: Callable[[], _Found]) -> _Found:
    """What is found of the poses: sought once, as each contact and several measurements ask."""
    known = _KEPT.setdefault(poses, {})
    if asked not in known:
        known[asked] = find()
    return cast(_Found, known[asked])


def first_rest(poses: Poses, floor: Floor, thresholds: Thresholds) -> RestPose | None:
    """The first place of rest; the others are not sought for it."""
    return next(_rests(poses, floor, thresholds), None)


def _rests(poses: Poses, floor: Floor, thresholds: Thresholds) -> Iterator[RestPose]:
    """The places of rest in a window, told by the poses from longer ago where they are known."""
    if poses.longer is None:
        calm = _calm(poses, thresholds)
        yield from _rest_poses(poses.smooth, poses.filled, calm, floor, thresholds)
        return
    before = len(poses.longer.times) - len(poses.smooth.times)
    recorded = replace(
        poses.longer,
        positions=np.concatenate((poses.longer.positions[:before], poses.filled.positions)),
        orientations=np.concatenate(
            (poses.longer.orientations[:before], poses.filled.orientations)
        ),
    )
    calm = slow_frames(poses.longer, poses.noise, frame_rate(poses.longer.times), thresholds)
    for each in _rest_poses(poses.longer, recorded, calm, floor, thresholds):
        if each.interval[1] >= before:
            yield _earlier(each, before)


def _earlier(rest: RestPose, frames: int) -> RestPose:
    """A rest in the frames of a part of the recording that begins so many later."""
    span = max(rest.interval[0] - frames, 0), rest.interval[1] - frames
    return replace(rest, interval=span, came=rest.came and replace(rest.came, interval=span))


def _calm(poses: Poses, thresholds: Thresholds) -> Holds:
    stream, rate_hz = poses.smooth, frame_rate(poses.smooth.times)
    return _kept(poses, thresholds, lambda: slow_frames(stream, poses.noise, rate_hz, thresholds))


def _rest_poses(
    stream: Stream, recorded: Stream, calm: Holds, floor: Floor, thresholds: Thresholds
) -> Iterator[RestPose]:
    times = stream.times
    rate_hz = frame_rate(times)
    begins = max(1, round(thresholds.rest_begins_s * rate_hz))
    least = max(1, round(thresholds.rest_minimum_s * rate_hz))
    until = -1
    for first, last in intervals(calm, times, dropout_s=0.0, minimum_s=thresholds.rest_minimum_s):
        if last <= until:
            continue
        for stay in _stays((stream, recorded), (first, last), floor, least, begins):
            until = stay.interval[1]
            yield stay


def _stays(
    streams: tuple[Stream, Stream], seed: Interval, floor: Floor, least: int, begins: int
) -> Iterator[RestPose]:
    """The place of a slow stretch; of one that creeps beyond the floor of it, one place each."""
    stay = _stay(streams, seed, floor, begins)
    begin, end = stay.interval
    if begin - seed[0] >= least:
        yield from _stays(streams, (seed[0], begin - 1), floor, least, begins)
    yield stay
    if seed[1] - end >= least:
        yield from _stays(streams, (end + 1, seed[1]), floor, least, begins)


def moving(
    poses: Poses, rests: tuple[RestPose, ...], floor: Floor, thresholds: Thresholds
) -> tuple[Interval, ...]:
    """Closed intervals of frames in which the object is at none of the places where it rests.

    An absence from a place counts if it lasts, or if the next place is beyond the floor from it:
    what rests here and then there has moved in between, however quickly. Frames in which it was
    lost count as motion only if it lies elsewhere afterwards.
    """
    stream = poses.smooth
    away = ~mask([each.interval for each in rests], len(stream.times)) & ~stream.lost
    for first, last in geometry.runs(stream.lost):
        if first > 0 and last < len(stream.times) - 1 and _moved(stream, first, last, floor):
            away[first : last + 1] = True
    changes = _changes(rests, floor)
    least_s = thresholds.moving_minimum_s
    lasting = set(intervals(away, stream.times, dropout_s=0.0, minimum_s=least_s))
    return tuple(
        (first, last)
        for first, last in geometry.runs(away)
        if (first, last) in lasting or any(a <= last and first <= z for a, z in changes)
    )


def _changes(rests: tuple[RestPose, ...], floor: Floor) -> list[Interval]:
    """The frames between two places of rest that are farther apart than the floor."""
    out: list[Interval] = []
    for one, two in pairwise(rests):
        there = two.at_first
        apart = float(np.linalg.norm(there.position - one.position))
        angle = float(geometry.angle_between(there.orientation[None], one.orientation[None])[0])
        if apart > floor.position_m or angle > floor.rotation_rad:
            left, come = one.interval[1], two.interval[0]
            if come > left + 1:
                out.append((left + 1, come - 1))
    return out


def slow_frames(stream: Stream, noise: Noise, rate_hz: float, thresholds: Thresholds) -> Holds:
    """Whether the way's slope over the window of rest is no more than noise makes it."""
    half = _half_window(rate_hz, thresholds)
    # Least squares over n samples: by sigma sqrt(12 / n^3) a step the slope deviates on each axis.
    left = thresholds.rest_sigmas * rate_hz * float(np.sqrt(12.0 / (2 * half + 1) ** 3))
    speed, turning = paces(stream, rate_hz, thresholds)
    with np.errstate(invalid="ignore"):
        slow = speed < max(thresholds.rest_speed_mps, left * noise.position_m)
        return slow & (turning < max(thresholds.rest_speed_radps, left * noise.orientation_rad))


def paces(stream: Stream, rate_hz: float, thresholds: Thresholds) -> tuple[Series, Series]:
    """Slopes of way [m/s] and of turning [rad/s] over the window of rest; NaN where lost."""
    half = _half_window(rate_hz, thresholds)
    speed, turning = np.full(len(stream.times), np.nan), np.full(len(stream.times), np.nan)
    for first, last in geometry.runs(~stream.lost):
        part = slice(first, last + 1)
        speed[part] = geometry.lengths(slopes(stream.positions[part], half)) * rate_hz
        # A quaternion changes by half of the angle.
        turn = geometry.lengths(slopes(stream.orientations[part], half))
        turning[part] = 2.0 * turn * rate_hz
    return speed, turning


def _half_window(rate_hz: float, thresholds: Thresholds) -> int:
    """Half the window of rest [frames]."""
    return max(1, round(0.5 * thresholds.rest_window_s * rate_hz))


def slopes(
    positions: Float[np.ndarray, "frames axes"], half: int
) -> Float[np.ndarray, "frames axes"]:
    """Slope of a straight line fitted to the frames around each, so many on either side, a frame.

    At the ends it is that of the first and the last frame with so many around.
    """
    count = len(positions)
    half = min(half, (count - 1) // 2)
    if half < 1:
        return np.zeros(positions.shape)
    weights = np.arange(-half, half + 1) * 3.0 / (half * (half + 1) * (2 * half + 1))
    slope = np.asarray(correlate1d(positions, weights, axis=0, mode="nearest"))
    slope[:half] = slope[half]
    slope[count - half :] = slope[count - half - 1]
    return slope


def _stay(streams: tuple[Stream, Stream], seed: Interval, floor: Floor, begins: int) -> RestPose:
    stream, recorded = streams
    first, last = seed
    missing = max(0, first + begins - last - 1) if last + 1 == len(stream.times) else 0
    stay = RestPose(
        seed, *median_pose(stream, slice(first, last + 1)), last + 1 - first, missing=missing
    )

    def gone(frames: slice, place: RestPose = stay) -> Bool[np.ndarray, "some"]:
        return ~rests_at(stream, frames, place, floor)

    inside, centre = np.flatnonzero(~gone(slice(first, last + 1))), (last - first) // 2
    middle = first + int(inside[np.argmin(np.abs(inside - centre))] if inside.size else centre)
    before, after = last_where(gone, middle - 1), first_where(gone, middle + 1, len(stream.times))
    end = len(stream.times) - 1 if after is None else after - 1
    if end < last:
        # It creeps away from there: the poses beyond are of no place of rest.
        begin = first if before is None else max(first, before + 1)
        stay = RestPose(seed, *median_pose(stream, slice(begin, end + 1)), end + 1 - begin)
    if before is not None and before >= first:
        return replace(stay, interval=(before + 1, end))
    soon = min(first + begins, last + 1)
    came = RestPose(seed, *median_pose(recorded, slice(first, soon)), soon - first)
    before = last_where(partial(gone, place=came), (first + soon) // 2 - 1)
    span = 0 if before is None else before + 1, end
    return replace(stay, interval=span, came=replace(came, interval=span))


def rests_at(
    stream: Stream, frames: slice, stay: RestPose, floor: Floor
) -> Bool[np.ndarray, "some"]:
    """Whether an object is at a place within a floor, at each of some frames; not where lost."""
    distance = geometry.lengths(stream.positions[frames] - stay.position)
    angle = geometry.angle_between(stream.orientations[frames], stay.orientation[None])
    with np.errstate(invalid="ignore"):
        return np.asarray((distance <= floor.position_m) & (angle <= floor.rotation_rad))


def _moved(stream: Stream, first: int, last: int, floor: Floor) -> bool:
    """Whether an object lies elsewhere after a loss than before."""
    ends = [first - 1, last + 1]
    way = float(np.linalg.norm(np.diff(stream.positions[ends], axis=0)))
    turns = stream.orientations[ends]
    return way > floor.position_m or bool(
        geometry.angle_between(turns[:1], turns[1:])[0] > floor.rotation_rad
    )


def resting(poses: Poses, thresholds: Thresholds) -> tuple[Interval, ...]:
    """Closed intervals of frames from the first to the last slow one at a place of rest.

    A body that stirs a little within the floor of motion of its place rests on; its last
    millimetres of settling and its first of leaving are motion.
    """
    return _kept(poses, (resting, thresholds), lambda: tuple(_resting(poses, thresholds)))


def _resting(poses: Poses, thresholds: Thresholds) -> list[Interval]:
    rate_hz = frame_rate(poses.smooth.times)
    floor = motion_floor(poses.noise, rate_hz, own_m=None, thresholds=thresholds)
    calm = _calm(poses, thresholds)
    found: list[Interval] = []
    for rest in rest_poses(poses, floor, thresholds):
        first, last = rest.interval
        inside = first + np.flatnonzero(calm[first : last + 1])
        if inside.size:
            span = int(inside[0]), int(inside[-1])
            if found and span[0] <= found[-1][1] + 1:
                span = found.pop()[0], span[1]
            found.append(span)
    return found
