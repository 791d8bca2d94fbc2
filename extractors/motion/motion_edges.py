"""When a motion truly begins and ends, within the floor that separates motion from rest."""

from functools import partial

import numpy as np
from jaxtyping import Float, Int

from capar.model import geometry
from extractors.bodies.poses import Poses, median_pose
from extractors.motion.onsets import beginning_s, weights
from extractors.motion.object_motion import Floor, RestPose, rests_at
from extractors.signals.clock import frame_rate
from extractors.signals.filters import gains
from extractors.signals.intervals import Interval, first_where, last_where
from extractors.thresholds import Thresholds

GROWN = 8.0
"""How many times as far as it can first be seen a motion is looked at again [1].

No threshold: as displacement grows with the cube of time, that is twice as long after it began.
"""


POWERS = (1.0, 3.0)
"""With which power of time a displacement grows [1]: at once, by a steady push, smoothly."""

AGREEMENT = 0.1
"""A beginning is sure if both estimates of how long ago it was differ by no larger share [1]."""

UNSURE = 1.0 / 3.0
"""Share of the longest time by which a motion may have begun earlier if that is not sure [1]: what
drifts, or is recorded at few frames, grows with no power of time."""

LEAST = 0.01
"""A displacement is taken for at least this [1], since less is noise."""


def motion_edges(
    poses: Poses, moved: Interval, rests: tuple[RestPose, ...], floor: Floor, thresholds: Thresholds
) -> Interval:
    """The interval of a motion, from when the object left one place to when it was at another.

    A motion is recognised by a displacement that no handling without it makes; once recognised, it
    began when the object was last where it had rested, and ended when it first was where it
    rests afterwards: within what noise alone makes, and at least a hair's width. What passed
    before it was that far is added (``onset``). What takes longer to the floor than motion at the
    slowest does, drifts until then. What was nudged or wobbled, and for the least duration of a
    rest went no farther away, sets off from there.

    Args:
        poses: The object's poses.
        moved: Frames in which it is beyond the floor of motion.
        rests: Places where it rests, in time.
        floor: The floor of its motion.
        thresholds: Least displacement, and deviations of noise that it must exceed.
    """
    before = [each for each in rests if each.interval[0] < moved[0]]
    after = [each for each in rests if each.interval[1] > moved[1]]
    first, last = moved
    if before:
        first = _left(poses, before[-1], moved, floor, thresholds)
    if after:
        last = _arrived(poses, after[0], moved, floor, thresholds)
    creeps = round(thresholds.creep_s * frame_rate(poses.filled.times))
    return max(first, moved[0] - creeps), min(last, moved[1] + creeps)


def _left(
    poses: Poses, stay: RestPose, moved: Interval, floor: Floor, thresholds: Thresholds
) -> int:
    """When an object left a place."""
    near = hair(poses, thresholds)
    edge = _gone(poses, stay, moved, near)
    nudged = _nudged(poses, np.arange(moved[0], edge - 1, -1), stay, near, thresholds)
    if nudged is not None:
        stay, edge = nudged, _gone(poses, nudged, moved, near)
    frames = np.arange(stay.interval[0], max(moved[1], edge) + 1)
    return onset(poses, frames, edge - stay.interval[0], stay, floor, thresholds)


def _arrived(
    poses: Poses, stay: RestPose, moved: Interval, floor: Floor, thresholds: Thresholds
) -> int:
    """When an object was at a place to stay."""
    near = hair(poses, thresholds)
    edge = _come(poses, stay, moved, near)
    nudged = _nudged(poses, np.arange(moved[1], edge + 1), stay, near, thresholds)
    if nudged is not None:
        stay, edge = nudged, _come(poses, nudged, moved, near)
    frames = np.arange(stay.interval[1], min(moved[0], edge) - 1, -1)
    return onset(poses, frames, stay.interval[1] - edge, stay, floor, thresholds)


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
    return RestPose((first, last), *median_pose(poses.smooth, slice(first, last + 1)))


def growth(
    poses: Poses, frames: Int[np.ndarray, "some"], stay: RestPose, unit: Floor
) -> Float[np.ndarray, "some"]:
    """How far an object is from a place, or turned, in units of a displacement [1]; NaN if lost."""
    stream = poses.smooth
    distance = np.linalg.norm(stream.positions[frames] - stay.position, axis=1)
    angle = geometry.angle_between(stream.orientations[frames], stay.orientation[None])
    return np.asarray(np.maximum(distance / unit.position_m, angle / unit.rotation_rad))


def onset(
    poses: Poses,
    frames: Int[np.ndarray, "some"],
    seen: int,
    stay: RestPose,
    floor: Floor,
    thresholds: Thresholds,
) -> int:
    """The frame at which a motion that was seen at a frame truly began.

    Args:
        poses: The object's poses.
        frames: Frames in a row, from its place of rest to its motion; backward for an end.
        seen: Which of them is the first at which it is a hair beyond that place.
        stay: That place.
        floor: The floor of its motion, as far as which it is followed at least.
        thresholds: What a hair is, and how long it takes at most to go so far.
    """
    near = hair(poses, thresholds)
    reach = max(
        min(floor.position_m / near.position_m, floor.rotation_rad / near.rotation_rad), GROWN
    )
    most = longest(poses, near, thresholds)
    pad = round(thresholds.rest_minimum_s * frame_rate(poses.filled.times))
    start = max(seen - most - pad, 0)
    grows = growth(poses, frames[seen:], stay, near)
    large = np.flatnonzero(~(grows < reach))
    far = seen + (int(large[0]) if large.size else int(np.nanargmax(grows)) if len(grows) and not np.isnan(grows).all() else 0)
    some = frames[start : far + 1]
    lost = np.flatnonzero(poses.filled.lost[some])
    if lost.size or len(some) < 4:
        return int(frames[min(seen, len(frames)-1)])
    raw, smooth, noise = _along(poses, some, stay, near)
    times = np.abs(poses.filled.times[some] - poses.filled.times[some[0]])
    at = beginning_s(raw, times, weights(smooth, noise), float(times[max(seen - most, 0) - start]), float(times[-1]))
    return int(some[np.argmin(np.abs(times - at))])


def _along(poses, some, stay, near):
    """Displacement along the way to the last frame, raw and smooth, in hairs, and its noise."""
    place = poses.smooth.positions[some] - stay.position
    turn = _turned(poses.smooth.orientations[some], stay)
    far, angle = np.linalg.norm(place[-1]), np.linalg.norm(turn[-1])
    if far / near.position_m >= angle / near.rotation_rad:
        raw, unit, noise = poses.filled.positions[some] - stay.position, near.position_m, poses.noise.position_m
        smooth, to = place, place[-1] / far
    else:
        raw, unit, noise = _turned(poses.filled.orientations[some], stay), near.rotation_rad, poses.noise.orientation_rad
        smooth, to = turn, turn[-1] / angle
    return raw @ to / unit, smooth @ to / unit, noise / unit


def _turned(orientations, stay):
    from scipy.spatial.transform import Rotation
    back = Rotation.from_quat(stay.orientation, scalar_first=True).inv()
    return (Rotation.from_quat(orientations, scalar_first=True) * back).as_rotvec()


def before_seen(grows: Float[np.ndarray, "some"], reach: float, most: int) -> int:
    """How many frames before it is 1 a displacement that grows with a power of time was none.

    The power is the one of ``POWERS`` that agrees best with when it was half as large, in powers
    of ten, as in the end.

    Args:
        grows: The displacement, from where it is about 1 on.
        reach: How large it should have grown for this to be told [1]; less if it never is.
        most: The answer at most.
    """
    if not grows.size or np.isnan(grows[0]):
        return 0
    large = np.flatnonzero(grows >= reach)
    far = int(large[0]) if large.size else int(np.nanargmax(grows))
    begin, end = max(float(grows[0]), LEAST), float(grows[far])
    if end <= begin:
        return 0
    middle = float(np.sqrt(begin * end))
    half = int(np.flatnonzero(grows[: far + 1] >= middle)[0])
    tries = [
        (_lasted(begin, end, far, power), _lasted(begin, middle, half, power)) for power in POWERS
    ]
    whole, part = min(tries, key=lambda both: abs(1.0 - both[1] / both[0]))
    if abs(1.0 - part / whole) > AGREEMENT:
        most = round(most * UNSURE)
    return min(round(whole), most)


def _lasted(begin: float, end: float, frames: int, power: float) -> float:
    """How many frames it took to ``begin`` if it then takes so many to ``end``."""
    first, last = begin ** (1.0 / power), end ** (1.0 / power)
    return frames * first / (last - first)


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
