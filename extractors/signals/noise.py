"""The noise of a stream, as it shows at rest: what is faster than any limb can move."""

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from capar.model.capture import Stream
from extractors.signals.clock import frame_rate
from extractors.signals.filters import gains, lowpass
from extractors.thresholds import Thresholds

CHI_SQUARE = 2.366
"""Median of the squared length of a normal vector in space, in variances of one axis [1]."""


@dataclass(frozen=True, slots=True)
class Noise:
    """Deviations of a stream's pose from where the body truly was."""

    position_m: float
    """Standard deviation of one coordinate [m]."""

    orientation_rad: float
    """Standard deviation of the rotation about one axis [rad]."""


def noise_at_rest(stream: Stream, thresholds: Thresholds) -> Noise:
    """The stream's noise, robustly, from what the low-pass takes away.

    What is faster than the cutoff is noise whether the body rests or moves; its median size,
    over the share of white noise that lies above the cutoff, gives the whole. Stretches of
    quick motion or loose tracking count no more than any other outlier.
    """
    _, _, taken = gains(frame_rate(stream.times), thresholds)
    place = _deviation(stream.positions, stream, thresholds)
    # A small rotation changes the quaternion by half of its angle, along three directions.
    turn = 2.0 * _deviation(stream.orientations, stream, thresholds)
    return Noise(place / taken, turn / taken)


def _deviation(
    values: Float[np.ndarray, "frames axes"], stream: Stream, thresholds: Thresholds
) -> float:
    rest = (values - lowpass(values, stream.times, thresholds))[~stream.lost]
    return float(np.sqrt(np.median((rest**2).sum(axis=1)) / CHI_SQUARE)) if len(rest) else 0.0
