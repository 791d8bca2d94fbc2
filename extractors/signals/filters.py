"""Filters of motion with finite support, noise at rest, and gaps that are bridged."""

from dataclasses import dataclass
from functools import lru_cache
from math import ceil

import numpy as np
from jaxtyping import Float
from scipy.ndimage import correlate1d

from capar.model import geometry
from capar.model.capture import Stream
from capar.model.geometry import Holds, Places, Series, Turns
from extractors.signals.intervals import frame_rate, time_step
from extractors.thresholds import Thresholds

ORDER = 2
"""Order of one pass of the Butterworth filter [1]; two passes make it twice that, without phase."""

EXTENSION_S = 0.5
"""How far a stretch is continued at its ends, point-symmetrically, before it is filtered [s]."""

JITTER = 0.2
"""Steps of time that differ by more than this share of the median are resampled [1]."""


def cutoff(rate_hz: float, thresholds: Thresholds) -> float:
    """The cutoff that the rate allows [Hz]."""
    return min(thresholds.cutoff_hz, thresholds.cutoff_rate_share * rate_hz)


SETTLED_SHARE = 1e-6
"""Frames whose weights add up to less than this no longer change a filtered pose [1]: of a metre it
is a micrometre."""


def filter_settles_s(step_s: float, thresholds: Thresholds) -> float:
    """After how long later frames no longer change a filtered one [s]: less than half the filter.

    What lies beyond weighs less than ``SETTLED_SHARE`` on either side.
    """
    weights = kernel(step_s, thresholds)
    beyond = np.cumsum(np.abs(weights))
    return step_s * (len(weights) // 2 - int(np.searchsorted(beyond, SETTLED_SHARE)))


def filter_support_s(step_s: float, thresholds: Thresholds) -> float:
    """Half the length of the low-pass filter [s]."""
    return step_s * (len(kernel(step_s, thresholds)) // 2)


@lru_cache
def kernel(step_s: float, thresholds: Thresholds) -> Float[np.ndarray, "taps"]:
    """The weights of the frames about each one: symmetric, of sum one."""
    half = ceil(thresholds.filter_periods / (cutoff(1.0 / step_s, thresholds) * step_s))
    # The response to an impulse, on a circle so long that its ends do not meet.
    angles = np.pi * np.arange(8 * half + 1) / (8 * half)
    response = np.fft.irfft(_passed(angles, 1.0 / step_s, thresholds))
    weights = np.concatenate([response[half:0:-1], response[: half + 1]])
    weights /= weights.sum()
    weights.flags.writeable = False
    return np.asarray(weights)


def lowpass(
    values: Float[np.ndarray, "frames axes"], times: Series, thresholds: Thresholds
) -> Float[np.ndarray, "frames axes"]:
    """The values without what is faster than the cutoff; each known stretch by itself, NaN stays.

    ``values``: any quantity over time; NaN in all axes where it is unknown.
    """
    step = time_step(times)
    weights = kernel(step, thresholds)
    out = np.array(values, dtype=float)
    for first, last in geometry.runs(~np.isnan(values[:, 0])):
        part = slice(first, last + 1)
        out[part] = _filtered(weights, values[part], times[part], step)
    return out


def lowpass_orientations(orientations: Turns, times: Series, thresholds: Thresholds) -> Turns:
    """Unit quaternions of continuous sign without what is faster than the cutoff."""
    smooth = lowpass(orientations, times, thresholds)
    return np.asarray(smooth / geometry.lengths(smooth)[:, None])


@lru_cache(maxsize=64)
def gains(rate_hz: float, thresholds: Thresholds) -> tuple[float, float, float]:
    """What the filter makes of white noise of deviation one.

    Returns:
        The deviations of the filtered noise [1], of its rate of change [1/s] by central
        differences, and of what the filter took away [1].
    """
    angles = np.pi * np.arange(2048) / 2048
    passed = _passed(angles, rate_hz, thresholds)
    rates = np.sin(angles) * rate_hz
    return (
        float(np.sqrt(np.mean(passed**2))),
        float(np.sqrt(np.mean((passed * rates) ** 2))),
        float(np.sqrt(np.mean((1.0 - passed) ** 2))),
    )


def speed(positions: Places, times: Series) -> Series:
    """Length of the velocity by central differences [m/s]; NaN where a position is unknown."""
    return geometry.lengths(velocity(positions, times))


def velocity(positions: Places, times: Series) -> Places:
    """Rate of change by central differences [m/s]; each known stretch by itself, NaN stays."""
    out = np.full(positions.shape, np.nan)
    known: Holds = ~np.isnan(positions[:, 0])
    for first, last in geometry.runs(known):
        part = slice(first, last + 1)
        out[part] = derivative(positions[part], times[part]) if last > first else 0.0
    return out


def derivative(
    values: Float[np.ndarray, "frames *axes"], times: Series
) -> Float[np.ndarray, "frames *axes"]:
    """Rate of change by differences with both neighbours, one-sided at the ends.

    ``numpy.gradient`` chooses its formula by whether all steps are equal, so that it computes a
    part otherwise than the whole.
    """
    steps = np.diff(times).reshape(-1, *[1] * (values.ndim - 1))
    slopes = np.diff(values, axis=0) / steps
    share = steps[:-1] / (steps[:-1] + steps[1:])
    inner = share * slopes[1:] + (1.0 - share) * slopes[:-1]
    return np.concatenate([slopes[:1], inner, slopes[-1:]])


def _passed(
    angles: Float[np.ndarray, "angles"], rate_hz: float, thresholds: Thresholds
) -> Float[np.ndarray, "angles"]:
    """The share of each frequency [rad/frame] that a digital Butterworth filter passes twice.

    It is the squared magnitude of one pass by the bilinear transform. ``scipy.signal`` gives the
    same; to import it takes as long as to observe a short capture.
    """
    warped = np.tan(0.5 * np.minimum(angles, np.pi - 1e-9))
    corner = np.tan(np.pi * cutoff(rate_hz, thresholds) / rate_hz)
    return np.asarray(1.0 / (1.0 + (warped / corner) ** (2 * ORDER)))


def _filtered(
    weights: Float[np.ndarray, "taps"],
    values: Float[np.ndarray, "frames axes"],
    times: Series,
    step: float,
) -> Float[np.ndarray, "frames axes"]:
    if len(values) < 4:
        return values
    if np.abs(np.diff(times) / step - 1.0).max() <= JITTER:
        return _weighted(weights, values, step)
    even = np.linspace(times[0], times[-1], max(round((times[-1] - times[0]) / step) + 1, 4))
    columns = [np.interp(even, times, column) for column in values.T]
    smooth = _weighted(weights, np.stack(columns, axis=1), step)
    return np.stack([np.interp(times, even, column) for column in smooth.T], axis=1)


def _weighted(
    weights: Float[np.ndarray, "taps"], values: Float[np.ndarray, "frames axes"], step: float
) -> Float[np.ndarray, "frames axes"]:
    """The weighted mean about each frame; the ends are continued point-symmetrically, then held."""
    half = len(weights) // 2
    reach = min(len(values) - 1, half, max(int(EXTENSION_S / step), 1))
    before = 2.0 * values[0] - values[reach:0:-1]
    after = 2.0 * values[-1] - values[-2 : -reach - 2 : -1]
    held = ((half - reach, half - reach), (0, 0))
    extended = np.pad(np.concatenate([before, values, after]), held, mode="edge")
    return np.asarray(correlate1d(extended, weights, axis=0)[half : len(extended) - half])


CHI_SQUARE = 2.366
"""Median of the squared length of a normal vector in space, in variances of one axis [1]."""


@dataclass(frozen=True, slots=True)
class Noise:
    """Deviations of a stream's pose from where the body truly was."""

    position_m: float
    """Standard deviation of one coordinate [m]."""

    orientation_rad: float
    """Standard deviation of the rotation about one axis [rad]."""


def noise_at_rest(stream: Stream, thresholds: Thresholds, smooth: Places | None = None) -> Noise:
    """The stream's noise, robustly, from what the low-pass takes away.

    ``smooth``: its low-passed places [m], if they are at hand.

    What is faster than the cutoff is noise whether the body rests or moves; its median size,
    over the share of white noise that lies above the cutoff, gives the whole. Stretches of
    quick motion or loose tracking count no more than any other outlier.
    """
    _, _, taken = gains(frame_rate(stream.times), thresholds)
    if smooth is None:
        smooth = lowpass(stream.positions, stream.times, thresholds)
    place = _deviation(stream.positions - smooth, stream)
    # A small rotation changes the quaternion by half of its angle, along three directions.
    left = stream.orientations - lowpass(stream.orientations, stream.times, thresholds)
    turn = 2.0 * _deviation(left, stream)
    return Noise(place / taken, turn / taken)


def _deviation(left: Float[np.ndarray, "frames axes"], stream: Stream) -> float:
    rest = left[~stream.lost]
    return float(np.sqrt(np.median(geometry.totals(rest**2)) / CHI_SQUARE)) if len(rest) else 0.0


DEGREE = 3
"""Positions in a gap lie on a polynomial of this degree [1] (spec 3: cubic)."""


def fill_gaps(stream: Stream, *, gap_s: float) -> Stream:
    """The stream with each loss shorter than ``gap_s`` [s] filled.

    Positions lie on the cubic that fits, by least squares, as many known frames on each side as
    the gap has (two at least), so that noise beside a gap is not thrown across it; it is exact
    for cubic motion. Orientations turn along great arcs. Losses at the ends stay lost.
    """
    short = [each for each in geometry.runs(stream.lost) if _inside(stream, each, gap_s)]
    if not short:
        return stream
    positions, orientations = stream.positions.copy(), stream.orientations.copy()
    for first, last in short:
        gap = slice(first, last + 1)
        positions[gap] = _cubic(stream, first, last)
        ends = [first - 1, last + 1]
        orientations[gap] = geometry.slerp(
            stream.times[ends], stream.orientations[ends], stream.times[gap]
        )
    return Stream(stream.times, positions, orientations)


def long_gaps(stream: Stream, *, gap_s: float) -> list[tuple[int, int]]:
    """Losses that are not filled, as closed intervals of frames."""
    return [each for each in geometry.runs(stream.lost) if not _inside(stream, each, gap_s)]


def _inside(stream: Stream, gap: tuple[int, int], gap_s: float) -> bool:
    first, last = gap
    if first == 0 or last == len(stream.times) - 1:
        return False
    lasts_s = stream.times[last + 1] - stream.times[first - 1] - time_step(stream.times)
    return bool(lasts_s < gap_s - 1e-9)


def _cubic(stream: Stream, first: int, last: int) -> Float[np.ndarray, "gap 3"]:
    reach = max(2, last - first + 1)
    near = np.r_[max(0, first - reach) : first, last + 1 : last + 1 + reach]
    near = near[near < len(stream.times)]
    near = near[~stream.lost[near]]
    middle = 0.5 * (stream.times[first] + stream.times[last])
    scale = stream.times[last + 1] - stream.times[first - 1]
    degree = min(DEGREE, len(near) - 1)
    known = np.vander((stream.times[near] - middle) / scale, degree + 1)
    wanted = np.vander((stream.times[first : last + 1] - middle) / scale, degree + 1)
    factors, *_ = np.linalg.lstsq(known, stream.positions[near], rcond=None)
    return np.asarray(wanted @ factors)
