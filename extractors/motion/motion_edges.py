"""When a motion truly begins and ends, within the floor that separates motion from rest."""

from collections.abc import Collection
from functools import partial

import numpy as np
from jaxtyping import Float, Int

from capar.model import geometry
from extractors.bodies.poses import Poses, median_pose
from extractors.motion.object_motion import Floor, RestPose, rests_at
from extractors.motion.onsets import onset
from extractors.motion.ways import way_out
from extractors.signals.clock import frame_rate
from extractors.signals.filters import gains
from extractors.signals.intervals import Interval, first_where, last_where
from extractors.thresholds import Thresholds

GROWN = 8.0
"""How many times as far as it can first be seen a motion is looked at again [1].

No threshold: as displacement grows with the cube of time, that is twice as long after it began.
"""

RETURNED = 0.5
"""A stroke is over where no more than this share of its way is left, and a hair less [1]."""


def motion_edges(
    poses: Poses,
    moved: Interval,
    rests: tuple[RestPose, ...],
    floor: Floor,
    thresholds: Thresholds,
    partners: Collection[Poses] = (),
) -> Interval:
    """The interval of a motion, from when the object left one place to when it was at another.

    A motion is recognised by a displacement that no handling without it makes; once recognised, it
    began when the object was last where it had rested, and ended when it first was where it
    rests afterwards: within what noise alone makes, and at least a hair's width. What passed
    before it was that far follows from how it grew (``onset``). What takes longer to the floor than
    motion at the slowest does, drifts until then. What was nudged or wobbled, and for the least
    duration of a rest went no farther away, sets off from there.

    Args:
        poses: The object's poses.
        moved: Frames in which it is beyond the floor of motion.
        rests: Places where it rests, in time.
        floor: The floor of its motion.
        thresholds: Least displacement, and deviations of noise that it must exceed.
        partners: Poses of what touches the object meanwhile: where it moves as one with the object,
            it tells of the same motion with noise of its own.
    """
    before = [each for each in rests if each.interval[0] < moved[0]]
    after = [each for each in rests if each.interval[1] > moved[1]]
    first, last = moved
    if before:
        first = _left(poses, before[-1], moved, floor, thresholds, partners)
    if after:
        last = _arrived(poses, after[0].at_first, moved, floor, thresholds, partners)
    creeps = round(thresholds.creep_s * frame_rate(poses.filled.times))
    first, last = max(first, moved[0] - creeps), min(last, moved[1] + creeps)
    return min(first, moved[0]), max(last, moved[1])


def _left(
    poses: Poses,
    stay: RestPose,
    moved: Interval,
    floor: Floor,
    thresholds: Thresholds,
    partners: Collection[Poses],
) -> int:
    """When an object left a place."""
    near = hair(poses, thresholds)
    edge = _gone(poses, stay, moved, near)
    nudged = _nudged(poses, np.arange(moved[0], edge - 1, -1), stay, near, thresholds)
    if nudged is not None:
        stay, edge = nudged, _gone(poses, nudged, moved, near)
    return _onset(poses, stay, (edge, max(moved[1], edge)), 1, floor, thresholds, partners)


def _arrived(
    poses: Poses,
    stay: RestPose,
    moved: Interval,
    floor: Floor,
    thresholds: Thresholds,
    partners: Collection[Poses],
) -> int:
    """When an object was at a place to stay."""
    near = hair(poses, thresholds)
    edge = _come(poses, stay, moved, near)
    nudged = _nudged(poses, np.arange(moved[1], edge + 1), stay, near, thresholds)
    if nudged is not None:
        stay, edge = nudged, _come(poses, nudged, moved, near)
    return _onset(poses, stay, (edge, min(moved[0], edge)), -1, floor, thresholds, partners)


def _gone(poses: Poses, stay: RestPose, moved: Interval, near: Floor) -> int:
    """The first frame at which an object that moves next is no longer at a place."""
    at_place = partial(rests_at, poses.smooth, stay=stay, floor=near)
    there = last_where(at_place, moved[0] - 1)
    return stay.interval[0] if there is None else there + 1


def _come(poses: Poses, stay: RestPose, moved: Interval, near: Floor) -> int:
    """The last frame at which an object that has moved is not yet at a place."""
    at_place = partial(rests_at, poses.smooth, stay=stay, floor=near)
    there = first_where(at_place, moved[1] + 1, len(poses.smooth.times))
    return stay.interval[1] if there is None else there - 1


def _nudged(
    poses: Poses,
    frames: Int[np.ndarray, "some"],
    stay: RestPose,
    near: Floor,
    thresholds: Thresholds,
) -> RestPose | None:
    """Where an object stood beside its place of rest, next to its motion; None if it did not.

    Args:
        poses: The object's poses.
        frames: From the motion to where it is at its place of rest.
        stay: That place.
        near: The unit of its displacement.
        thresholds: The least duration of a rest.
    """
    window = max(1, round(thresholds.rest_minimum_s * frame_rate(poses.filled.times)))
    grows = growth(poses, frames, stay, near)
    with np.errstate(invalid="ignore"):
        stands = np.flatnonzero(grows[:-window] <= grows[window:])
    if not stands.size:
        return None
    ends = frames[stands[0]], frames[stands[0] + window]
    first, last = int(min(ends)), int(max(ends))
    place = median_pose(poses.smooth, slice(first, last + 1))
    return RestPose((first, last), *place, last + 1 - first)


def growth(
    poses: Poses, frames: Int[np.ndarray, "some"] | slice, stay: RestPose, unit: Floor
) -> Float[np.ndarray, "some"]:
    """How far an object is from a place, or turned, in units of a displacement [1]; NaN if lost."""
    stream = poses.smooth
    distance = np.linalg.norm(stream.positions[frames] - stay.position, axis=1)
    angle = geometry.angle_between(stream.orientations[frames], stay.orientation[None])
    return np.asarray(np.maximum(distance / unit.position_m, angle / unit.rotation_rad))


def _onset(
    poses: Poses,
    stay: RestPose,
    motion: tuple[int, int],
    step: int,
    floor: Floor,
    thresholds: Thresholds,
    partners: Collection[Poses],
) -> int:
    """The frame at which a motion out of a place truly began, or one into it truly ended.

    Args:
        poses: The object's poses.
        stay: The place.
        motion: The frame next to the place at which the object is a hair beyond it, and the one at
            the other end of the motion.
        step: 1 out of the place, -1 where the motion leads to it.
        floor: The floor of its motion, as far as which it is followed at least.
        thresholds: What a hair is, and how long it takes at most to go so far.
        partners: Poses of what may move as one with it.
    """
    near, rate_hz = hair(poses, thresholds), frame_rate(poses.filled.times)
    most, rest = longest(poses, near, thresholds), round(thresholds.rest_minimum_s * rate_hz)
    edge, start = motion[0], stay.interval[0 if step > 0 else 1]
    seen = max(min(step * (edge - start), most + rest), 0)
    far = _well_beyond(poses, stay, motion, near, floor)
    frames = np.arange(edge - step * seen, far + step, step)
    if len(frames) <= seen + 1:
        return edge
    left = gains(rate_hz, thresholds)[0]
    way, smooth, noise = way_out(poses, partners, frames, seen, stay, near, left)
    # A place is the mean of the middle half of the poses there.
    place = float(np.median(noise)) / np.sqrt(0.5 * stay.frames)
    begin = onset(
        way, smooth, seen, noise=noise, place=place, most=most, rest=rest, rate_hz=rate_hz
    )
    return int(frames[begin])


def _well_beyond(
    poses: Poses, stay: RestPose, motion: tuple[int, int], near: Floor, floor: Floor
) -> int:
    """The frame, from the first of a motion to the last, at which it is clear how it grew.

    It is the last one before the object is lost, and the farthest if it never goes well beyond, or
    comes most of the way back before that: a stroke to and fro grows from the place as well.
    """
    step = 1 if motion[0] <= motion[1] else -1
    frames = np.arange(motion[0], motion[1] + step, step)
    reach = min(floor.position_m / near.position_m, floor.rotation_rad / near.rotation_rad)
    grows = growth(poses, frames, stay, near)
    lost = np.flatnonzero(np.isnan(grows))
    grows = grows[: int(lost[0])] if lost.size else grows
    if not grows.size:
        return int(frames[0])
    farthest = np.maximum.accumulate(grows)
    back = np.flatnonzero(grows < np.minimum(RETURNED * farthest, farthest - 1.0))
    grows = grows[: int(back[0])] if back.size else grows
    beyond = np.flatnonzero(grows >= max(reach, GROWN))
    return int(frames[beyond[0] if beyond.size else np.argmax(grows)])


def longest(poses: Poses, near: Floor, thresholds: Thresholds) -> int:
    """How many frames a motion lasts at most until it is seen: longer where noise hides more."""
    share = float(np.cbrt(near.position_m / thresholds.edge_m))
    return round(thresholds.onset_s * share * frame_rate(poses.filled.times))


def hair(poses: Poses, thresholds: Thresholds) -> Floor:
    """Displacement that noise does not explain, and at least a hair's width."""
    times = poses.filled.times
    rate_hz = frame_rate(times)
    left = thresholds.motion_sigmas * gains(rate_hz, thresholds)[0]
    return Floor(
        max(thresholds.edge_m, left * poses.noise.position_m),
        max(thresholds.edge_rad, left * poses.noise.orientation_rad),
    )
