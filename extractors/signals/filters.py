"""Zero-phase low-pass filtering of sampled motion, and what it leaves of white noise."""

import numpy as np
from jaxtyping import Bool, Float
from scipy.signal import butter, sosfiltfilt, sosfreqz

from capar.model import geometry
from extractors.thresholds import Thresholds

ORDER = 2
"""Order of one pass of the Butterworth filter [1]; two passes make it twice that, without phase."""

JITTER = 0.2
"""Steps of time that differ by more than this share of the median are resampled [1]."""


def cutoff(rate_hz: float, thresholds: Thresholds) -> float:
    """The cutoff that the rate allows [Hz]."""
    return min(thresholds.cutoff_hz, thresholds.cutoff_rate_share * rate_hz)


def lowpass(
    values: Float[np.ndarray, "frames axes"],
    times: Float[np.ndarray, "frames"],
    thresholds: Thresholds,
) -> Float[np.ndarray, "frames axes"]:
    """The values without what is faster than the cutoff; each known stretch by itself, NaN stays.

    Args:
        values: Any quantity over time; NaN in all axes where it is unknown.
        times: Clock [s]; if its steps are uneven, values are filtered on an even clock.
        thresholds: The cutoff [Hz].
    """
    step = float(np.median(np.diff(times)))
    sos = _filter(1.0 / step, thresholds)
    out = np.array(values, dtype=float)
    for first, last in geometry.runs(~np.isnan(values[:, 0])):
        part = slice(first, last + 1)
        out[part] = _filtered(sos, values[part], times[part], step)
    return out


def lowpass_orientations(
    orientations: Float[np.ndarray, "frames 4"],
    times: Float[np.ndarray, "frames"],
    thresholds: Thresholds,
) -> Float[np.ndarray, "frames 4"]:
    """Unit quaternions of continuous sign without what is faster than the cutoff."""
    smooth = lowpass(orientations, times, thresholds)
    return np.asarray(smooth / np.linalg.norm(smooth, axis=1, keepdims=True))


def gains(rate_hz: float, thresholds: Thresholds) -> tuple[float, float, float]:
    """What the filter makes of white noise of deviation one.

    Returns:
        The deviations of the filtered noise [1], of its rate of change [1/s] by central
        differences, and of what the filter took away [1].
    """
    angles, response = sosfreqz(_filter(rate_hz, thresholds), worN=2048)
    passed = np.abs(response) ** 2
    rates = np.sin(angles) * rate_hz
    return (
        float(np.sqrt(np.mean(passed**2))),
        float(np.sqrt(np.mean((passed * rates) ** 2))),
        float(np.sqrt(np.mean((1.0 - passed) ** 2))),
    )


def speed(
    positions: Float[np.ndarray, "frames 3"], times: Float[np.ndarray, "frames"]
) -> Float[np.ndarray, "frames"]:
    """Length of the velocity by central differences [m/s]; NaN where a position is unknown."""
    return np.linalg.norm(velocity(positions, times), axis=1)


def velocity(
    positions: Float[np.ndarray, "frames 3"], times: Float[np.ndarray, "frames"]
) -> Float[np.ndarray, "frames 3"]:
    """Rate of change by central differences [m/s]; each known stretch by itself, NaN stays."""
    out = np.full(positions.shape, np.nan)
    known: Bool[np.ndarray, "frames"] = ~np.isnan(positions[:, 0])
    for first, last in geometry.runs(known):
        part = slice(first, last + 1)
        out[part] = np.gradient(positions[part], times[part], axis=0) if last > first else 0.0
    return out


def _filter(rate_hz: float, thresholds: Thresholds) -> np.ndarray:
    return np.asarray(butter(ORDER, cutoff(rate_hz, thresholds), fs=rate_hz, output="sos"))


def _filtered(sos: np.ndarray, values: np.ndarray, times: np.ndarray, step: float) -> np.ndarray:
    if len(values) < 4:
        return values
    pad = min(len(values) - 1, max(int(0.5 / step), 3 * (2 * len(sos) + 1)))
    if np.abs(np.diff(times) / step - 1.0).max() <= JITTER:
        return np.asarray(sosfiltfilt(sos, values, axis=0, padlen=pad))
    even = np.linspace(times[0], times[-1], max(round((times[-1] - times[0]) / step) + 1, 4))
    columns = [np.interp(even, times, column) for column in values.T]
    pad = min(pad, len(even) - 1)
    smooth = sosfiltfilt(sos, np.stack(columns, axis=1), axis=0, padlen=pad)
    return np.stack([np.interp(times, even, column) for column in smooth.T], axis=1)
