"""Streams resampled to one clock, by interpolation that never crosses a gap."""

from collections.abc import Sequence

import numpy as np
from jaxtyping import Bool, Float

from capar.model import geometry
from capar.model.capture import Notice, Stream, notice
from capar.model.errors import CaptureError
from extractors.thresholds import Thresholds

GAP_S = Thresholds().gap_s
"""Nothing is interpolated between samples further apart than this [s]."""

GAP_STEPS = 1.5
"""Or than so many steps of a source that is slower."""

SAME_S = 1e-6
"""Time stamps that differ by less are one [s]."""

FAR_RATE = 4.0
"""A rate that differs from the recorded ones by more than this factor is doubtful."""

LARGEST_FRAMES = 1e7
"""Frames that a capture may have: more than a day at 100 Hz."""


def resampled(
    stream: Stream, times: Float[np.ndarray, "frames"], *, extend: str = "none"
) -> Stream:
    """A stream at other times: positions by cubic, orientations by slerp.

    Args:
        stream: The source, on a clock of its own with the same zero.
        times: The wanted clock [s].
        extend: ``rest`` holds the first pose before it and the last after it; ``none`` does not.
    """
    known = np.flatnonzero(~stream.lost)
    if not known.size:
        return _lost(times)
    if extend == "none" and _is_on(stream, times):
        return Stream(times, stream.positions, stream.orientations)  # what is lost stays so
    source = stream.times[known]
    wanted = np.clip(times, source[0], source[-1]) if extend == "rest" else times
    near = _near(source, wanted, stream.times)
    positions = np.full((len(times), 3), np.nan)
    orientations = np.full((len(times), 4), np.nan)
    inside = np.clip(wanted[near], source[0], source[-1])
    positions[near] = _positions(source, stream.positions[known], inside)
    orientations[near] = geometry.slerp(source, stream.orientations[known], inside)
    return Stream(times=times, positions=positions, orientations=orientations)


def _is_on(stream: Stream, times: Float[np.ndarray, "frames"]) -> bool:
    return len(times) == len(stream.times) and bool(np.abs(times - stream.times).max() < SAME_S)


def _lost(times: Float[np.ndarray, "frames"]) -> Stream:
    frames = len(times)
    return Stream(
        times=times,
        positions=np.full((frames, 3), np.nan),
        orientations=np.full((frames, 4), np.nan),
    )


def _near(
    source: Float[np.ndarray, "known"],
    wanted: Float[np.ndarray, "frames"],
    clock: Float[np.ndarray, "samples"],
) -> Bool[np.ndarray, "frames"]:
    """Where a wanted time has a known sample at itself, or lies between two near ones."""
    reach = max(GAP_S, GAP_STEPS * float(np.median(np.diff(clock))))
    after = np.clip(np.searchsorted(source, wanted), 0, len(source) - 1)
    before = np.clip(after - 1, 0, len(source) - 1)
    exact = np.minimum(np.abs(wanted - source[before]), np.abs(source[after] - wanted)) < SAME_S
    inside = (wanted >= source[0]) & (wanted <= source[-1])
    return exact | (inside & (source[after] - source[before] <= reach + SAME_S))


def _positions(
    source: Float[np.ndarray, "known"],
    positions: Float[np.ndarray, "known 3"],
    wanted: Float[np.ndarray, "frames"],
) -> Float[np.ndarray, "frames 3"]:
    """Cubic inside runs of steady sampling, linear in short ones."""
    from scipy.interpolate import CubicSpline

    if len(source) == 1:
        return np.repeat(positions, len(wanted), axis=0)
    out = np.stack([np.interp(wanted, source, each) for each in positions.T], axis=1)
    step = max(GAP_S, GAP_STEPS * float(np.median(np.diff(source))))
    breaks = np.flatnonzero(np.diff(source) > step) + 1
    for run in np.split(np.arange(len(source)), breaks):
        if len(run) < 4:
            continue
        within = (wanted >= source[run[0]]) & (wanted <= source[run[-1]])
        out[within] = CubicSpline(source[run], positions[run])(wanted[within])
    return out


def shared_clock(
    streams: Sequence[Stream],
    *,
    rate_hz: float | None,
    span_s: tuple[float | None, float | None],
    where: str,
) -> tuple[Float[np.ndarray, "frames"], float]:
    """The clock that every stream is put on, from zero, and the files' time of its zero.

    Args:
        streams: The streams on their files' clocks.
        rate_hz: Frames a second; None keeps the clock that all streams share.
        span_s: What is kept, in seconds after the earliest frame.
        where: The capture.toml, for messages.

    Raises:
        CaptureError: The streams have different clocks and no rate is stated.
    """
    if not streams:
        raise CaptureError(f"{where}: no sensor or object has a body or markers")
    first = min(float(each.times[0]) for each in streams)
    last = max(float(each.times[-1]) for each in streams)
    begin = first + (span_s[0] or 0.0)
    end = last if span_s[1] is None else min(last, first + span_s[1])
    if rate_hz is not None:
        count = _count(begin, end, rate_hz, where)
        return np.arange(count) / rate_hz, begin
    clock = streams[0].times
    for stream in streams:
        if len(stream.times) != len(clock) or np.abs(stream.times - clock).max() > SAME_S:
            raise CaptureError(
                f"{where}: the streams are on different clocks ({len(clock)} and "
                f"{len(stream.times)} frames); state the rate to bring them to, like rate_hz = 100"
            )
    kept = clock[(clock >= begin - SAME_S) & (clock <= end + SAME_S)]
    if len(kept) < 2:
        raise CaptureError(f"{where}: no frames between from_s and to_s")
    return kept - kept[0], float(kept[0])


def rate_notices(streams: Sequence[Stream], rate_hz: float | None) -> list[Notice]:
    """A notice if the stated rate is far from every rate at which bodies were recorded."""
    rates = [1.0 / float(np.median(np.diff(each.times))) for each in streams]
    if rate_hz is None or min(rates) / FAR_RATE <= rate_hz <= max(rates) * FAR_RATE:
        return []
    recorded = f"{min(rates):.4g}" + (f" to {max(rates):.4g}" if max(rates) > min(rates) else "")
    return [notice("rate-mistyped", stated_hz=rate_hz, recorded_hz=recorded)]


def _count(begin: float, end: float, rate_hz: float, where: str) -> int:
    frames = (end - begin) * rate_hz
    if not 1.0 <= frames <= LARGEST_FRAMES:
        raise CaptureError(
            f"{where}: {end - begin:g} s at rate_hz = {rate_hz:g} make {frames:.0f} frames; "
            f"between 2 and {LARGEST_FRAMES:.0e} are possible"
        )
    return int(np.floor(frames + 1e-6)) + 1
