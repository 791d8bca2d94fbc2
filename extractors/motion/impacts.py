"""Sudden motion: how fast bodies meet, and when one falls freely."""

import numpy as np

from extractors.bodies.body_geometry import BodyGeometry
from extractors.signals.filters import velocity
from extractors.signals.intervals import Interval, intervals
from extractors.thresholds import Thresholds

GRAVITY_MPS2 = 9.81
"""Standard acceleration of free fall, rounded [m/s^2]."""

APPROACH_S = 0.05
"""How long before a contact the speed of approach is taken [s].

No threshold: it is the time over which the low-pass filter blurs a blow.
"""


def closing_speed(body: BodyGeometry, other: BodyGeometry, frame: int) -> float:
    """How fast two bodies' middles move relative to each other just before a frame [m/s].

    The fastest relative speed in the last twentieth of a second, so that a filter which rounds
    a blow does not hide it; zero where either is lost or the contact begins the capture.
    """
    times = body.poses.filled.times
    first = int(np.searchsorted(times, times[frame] - APPROACH_S))
    span = slice(first, frame + 1)
    offset = body.middles[span] - other.middles[span]
    if frame == 0 or len(offset) < 2 or np.isnan(offset).any():
        return 0.0
    speeds = np.linalg.norm(np.diff(offset, axis=0), axis=1) / np.diff(times[span])
    return float(speeds.max())


def falls(body: BodyGeometry, thresholds: Thresholds) -> tuple[Interval, ...]:
    """Closed intervals of frames in which a body's acceleration is that of free fall."""
    times = body.poses.smooth.times
    rate = velocity(velocity(body.middles, times), times)
    apart = np.linalg.norm(rate + np.array([0.0, 0.0, GRAVITY_MPS2]), axis=1)
    with np.errstate(invalid="ignore"):
        free = apart < thresholds.fall_share * GRAVITY_MPS2
    return tuple(intervals(free, times, dropout_s=0.0, minimum_s=thresholds.fall_minimum_s))
