"""Frames at which acceleration crosses zero: starts, stops and extrema of speed (thesis 3.2.1).

The acceleration of a path in space is taken along the path: it crosses zero where speed has a
local extremum. That does not depend on how the world's axes lie, as crossings of each axis by
itself would. A change of direction shows as a minimum of speed, since the low-passed path rounds
each corner, and a start from rest and a stop as the ends of a stretch of rest.
"""

import numpy as np
from jaxtyping import Int
from scipy.ndimage import minimum_filter1d

from capar.model import geometry
from capar.model.geometry import Holds, Series
from extractors.signals.filters import gains
from extractors.signals.intervals import duration, frame_rate, intervals, time_step
from extractors.thresholds import Thresholds


def zero_crossings(
    speed_mps: Series, times: Series, *, noise_m: float, highest_mps: float, thresholds: Thresholds
) -> Int[np.ndarray, "crossings"]:
    """Frames, ascending, at which the speed of a low-passed stream starts, stops or turns.

    The first and the last frame count. Frames at which the stream was lost do not.

    ``speed_mps``: speed of the low-passed stream [m/s]; NaN where it was lost. ``noise_m``:
    deviation of one unfiltered coordinate at rest [m]. ``highest_mps``: highest speed of the stream
    in the whole recording [m/s].
    """
    rate_hz = frame_rate(times)
    reach = horizon_frames(times, thresholds)
    noise_mps = gains(rate_hz, thresholds)[1] * noise_m * np.sqrt(3.0)
    found: set[int] = {0, len(times) - 1}
    known = ~np.isnan(speed_mps)
    if known.any():
        prominence = max(
            thresholds.crossing_speed_mps,
            thresholds.crossing_sigmas * noise_mps,
            thresholds.crossing_speed_share * highest_mps,
        )
        resting = rests(speed_mps, times, noise_mps=noise_mps, thresholds=thresholds)
        for first, last in geometry.runs(known):
            part = slice(first, last + 1)
            # Prominent maxima and minima outside rest, and the ends of rest.
            for signal in (speed_mps[part], -speed_mps[part]):
                peaks = first + prominent_peaks(signal, prominence, reach)
                found.update(int(each) for each in peaks if not resting[each])
            for begin, end in geometry.runs(resting[part]):
                found.update(first + each for each in {begin, end} - {0, last - first})
    return np.array(sorted(found), dtype=np.int64)


def horizon_frames(times: Series, thresholds: Thresholds) -> int:
    """How many frames about an extremum of speed its prominence and neighbours are sought."""
    return max(1, round(thresholds.extremum_horizon_s / time_step(times)))


def pauses(
    speed_mps: Series, crossings: Int[np.ndarray, "crossings"], reach: int
) -> Int[np.ndarray, "pauses"]:
    """Those crossings, the capture's first and last frame aside, that are no maximum of speed.

    A maximum is faster than the crossing before and the one after. Where one of these is far away,
    it is faster than the frames beside it.

    ``speed_mps``: speed of the low-passed stream [m/s]. ``crossings``: zero crossings, ascending.
    ``reach``: how many frames away a neighbour counts.
    """
    if len(crossings) < 3:
        return crossings[:0]
    before, here, after = (speed_mps[at] for at in (crossings[:-2], crossings[1:-1], crossings[2:]))
    near = np.diff(crossings) <= reach
    # Whether each is faster than the frame before and no slower than the one after.
    rises = np.diff(speed_mps) > 0.0
    top = rises[crossings[1:-1] - 1] & ~rises[crossings[1:-1]]
    highest = np.where(near[:-1], here > before, top) & np.where(near[1:], here > after, top)
    return crossings[1:-1][~highest]


def rests(speed_mps: Series, times: Series, *, noise_mps: float, thresholds: Thresholds) -> Holds:
    """Whether each frame lies in a stretch of rest, from where speed ceased to fall.

    ``speed_mps``: speed [m/s]; NaN where it is not known, and there is no rest. ``noise_mps``: size
    of the speed that noise alone makes [m/s].
    """
    limit = max(thresholds.rest_speed_mps, thresholds.rest_sigmas * noise_mps)
    slow = _to_the_ends(np.nan_to_num(speed_mps, nan=np.inf) < limit, speed_mps, times, thresholds)
    out = np.zeros(len(speed_mps), dtype=bool)
    step = time_step(times)
    for first, last in intervals(slow, times, dropout_s=0.0, minimum_s=thresholds.rest_minimum_s):
        # From the first to the last local minimum of speed near its ends.
        begin, end, reach = first, last, horizon_frames(times, thresholds)
        if first > 0:
            while begin < min(last, first + reach) and speed_mps[begin + 1] < speed_mps[begin]:
                begin += 1
        if last < len(speed_mps) - 1:
            while end > max(first, last - reach) and speed_mps[end - 1] < speed_mps[end]:
                end -= 1
        if begin > end or duration((begin, end), times, step) < thresholds.rest_minimum_s:
            begin, end = first, last
        out[begin : end + 1] = True
    return out


def _to_the_ends(slow: Holds, speed_mps: Series, times: Series, thresholds: Thresholds) -> Holds:
    """Slowness that begins or ends near the end of a known stretch reaches it."""
    out = slow.copy()
    reach = int(0.5 * thresholds.rest_minimum_s / time_step(times)) + 1
    for first, last in geometry.runs(~np.isnan(speed_mps)):
        inside = np.flatnonzero(slow[first : last + 1]) + first
        if inside.size and inside[0] - first <= reach:
            out[first : inside[0]] = True
        if inside.size and last - inside[-1] <= reach:
            out[inside[-1] : last + 1] = True
    return out


def prominent_peaks(signal: Series, prominence: float, reach: int) -> Int[np.ndarray, "peaks"]:
    """Local maxima that rise by a prominence above what lies between them and higher values.

    The middle of a flat top counts. It is ``scipy.signal.find_peaks`` without the half second that
    its import takes.

    ``signal``: any quantity over time. ``prominence``: least height above the higher of the lowest
    points on both sides. ``reach``: how many frames to each side are looked at.
    """
    steps = np.flatnonzero(np.diff(signal))
    slopes = np.sign(np.diff(signal)[steps])
    tops = np.flatnonzero((slopes[:-1] > 0.0) & (slopes[1:] < 0.0))
    peaks = (steps[tops] + 1 + steps[tops + 1]) // 2
    size = reach + 1
    low_before = minimum_filter1d(signal, size, mode="nearest", origin=size // 2 - (size % 2 == 0))
    low_after = minimum_filter1d(signal, size, mode="nearest", origin=-(size // 2))
    lowest = np.maximum(low_before[peaks], low_after[peaks])
    possible = peaks[signal[peaks] - lowest >= prominence]
    kept = [each for each in possible if _prominence(signal, int(each), reach) >= prominence]
    return np.array(kept, dtype=np.int64)


def _prominence(signal: Series, peak: int, reach: int) -> float:
    height = signal[peak]
    before = signal[max(peak - reach, 0) : peak + 1][::-1]
    after = signal[peak : peak + reach + 1]
    bases = []
    for side in (before, after):
        higher = side > height
        bases.append(float(side[: int(higher.argmax()) if higher.any() else len(side)].min()))
    return float(height - max(bases))
