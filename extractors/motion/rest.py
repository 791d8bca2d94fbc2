"""When an end-effector is at rest."""

import numpy as np

from extractors.bodies.poses import Poses
from extractors.motion.object_motion import motion_floor, rest_poses, slow_frames
from extractors.signals.clock import frame_rate
from extractors.signals.intervals import Interval
from extractors.thresholds import Thresholds


def resting(poses: Poses, thresholds: Thresholds) -> tuple[Interval, ...]:
    """Closed intervals of frames from the first to the last slow one at a place of rest.

    A body that stirs a little within the floor of motion of its place rests on; its last
    millimetres of settling and its first of leaving are motion.
    """
    stream = poses.smooth
    rate_hz = frame_rate(stream.times)
    floor = motion_floor(poses.noise, rate_hz, own_m=None, thresholds=thresholds)
    calm = slow_frames(stream, poses.noise, rate_hz, thresholds)
    found: list[Interval] = []
    for rest in rest_poses(poses, floor, thresholds):
        first, last = rest.interval
        inside = first + np.flatnonzero(calm[first : last + 1])
        if inside.size:
            span = int(inside[0]), int(inside[-1])
            if found and span[0] <= found[-1][1] + 1:
                span = found.pop()[0], span[1]
            found.append(span)
    return tuple(found)
