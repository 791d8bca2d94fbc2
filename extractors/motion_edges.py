"""When a motion truly begins and ends, beyond the floor that tells it from none."""

import numpy as np

from capar.model import geometry
from extractors.intervals import Interval
from extractors.object_motion import Floor, Stay
from extractors.poses import Poses
from extractors.signals import gains
from extractors.thresholds import Thresholds


def motion_edges(
    where: Poses, moved: Interval, rests: tuple[Stay, ...], thresholds: Thresholds
) -> Interval:
    """The interval of a motion, from when the object left one place to when it was at another.

    A motion is told from none by a displacement that no handling without it makes; once told, it
    began when the object was last where it had rested, and ended when it first was where it
    rests afterwards: within what noise alone makes, and at least a hair's width.

    Args:
        where: The object's poses.
        moved: Frames in which it is beyond the floor of motion.
        rests: Places where it rests, in time.
        thresholds: Least displacement, and deviations of noise that it must exceed.
    """
    floor = _hair(where, thresholds)
    before = [each for each in rests if each.interval[0] < moved[0]]
    after = [each for each in rests if each.interval[1] > moved[1]]
    first, last = moved
    if before:
        there = _there(where, before[-1], floor)
        found = np.flatnonzero(there[:first])
        first = int(found[-1]) + 1 if found.size else before[-1].interval[0]
    if after:
        there = _there(where, after[0], floor)
        found = np.flatnonzero(there[last + 1 :])
        last = last + int(found[0]) if found.size else after[0].interval[1]
    return first, last


def _hair(where: Poses, thresholds: Thresholds) -> Floor:
    times = where.filled.times
    rate_hz = 1.0 / float(np.median(np.diff(times)))
    left = thresholds.motion_sigmas * gains(rate_hz, thresholds)[0]
    return Floor(
        max(thresholds.edge_m, left * where.noise.position_m),
        max(thresholds.edge_rad, left * where.noise.orientation_rad),
    )


def _there(where: Poses, stay: Stay, floor: Floor) -> np.ndarray:
    stream = where.smooth
    distance = np.linalg.norm(stream.positions - stay.position, axis=1)
    angle = geometry.angle_between(stream.orientations, stay.orientation[None])
    with np.errstate(invalid="ignore"):
        return np.asarray((distance <= floor.position_m) & (angle <= floor.rotation_rad))
