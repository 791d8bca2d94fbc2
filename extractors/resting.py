"""When an end-effector is at a place where it rests."""

import numpy as np

from extractors.intervals import Interval
from extractors.object_motion import motion_floor, stays
from extractors.poses import Poses
from extractors.thresholds import Thresholds


def resting(where: Poses, thresholds: Thresholds) -> tuple[Interval, ...]:
    """Closed intervals of frames in which a body lies within the floor of motion of one place.

    Intervals of neighbouring places that share frames are one: a hand that settles is at rest.
    """
    stream = where.smooth
    rate_hz = 1.0 / float(np.median(np.diff(stream.times)))
    floor = motion_floor(where.noise, rate_hz, own_m=None, thresholds=thresholds)
    found: list[Interval] = []
    for each in stays(where, floor, thresholds):
        first, last = each.interval
        if found and first <= found[-1][1] + 1:
            found[-1] = (found[-1][0], max(last, found[-1][1]))
        else:
            found.append((first, last))
    return tuple(found)
