"""Streams in numbers: rate, gaps, noise, ranges, and which come near each other."""

from collections.abc import Mapping
from dataclasses import asdict, dataclass
from itertools import combinations
from typing import Any

import numpy as np
from jaxtyping import Float

from capar.model import geometry
from capar.model.capture import Stream

REST_S = 0.5  # Noise is measured in windows of this length [s].
DEGREE = 3  # Degree of the polynomial that motion within a window is fitted by.
SHORTEST = 8  # Frames that a window has at least, so that noise is left after the fit.


@dataclass(frozen=True, slots=True)
class StreamSurvey:
    """One stream in numbers."""

    name: str
    kind: str
    frames: int
    seconds: float
    rate_hz: float
    jitter_ms: float
    """How far steps of time lie from the median step, as a deviation [ms]."""

    lost: int
    gaps: int
    longest_gap_s: float
    noise_mm: float | None
    """Deviation of position from a smooth motion in the stillest windows [mm], over all three
    axes; None where nothing is seen for half a second."""

    noise_deg: float | None
    """The same of orientation [deg]."""

    range_m: tuple[float, float, float] | None
    """Extent along x, y and z [m]."""


@dataclass(frozen=True, slots=True)
class NearPair:
    """Two streams and how near their origins come."""

    first: str
    second: str
    least_m: float
    at_s: float
    near_s: float
    """How long they stay within a fifth more than the least distance [s]."""


def survey(name: str, kind: str, stream: Stream) -> StreamSurvey:
    """Numbers of a stream; positions in metres."""
    steps = np.diff(stream.times)
    lost = geometry.runs(stream.lost)
    known = stream.positions[~stream.lost]
    extent = known.max(axis=0) - known.min(axis=0) if len(known) else None
    noise = _noise(stream)
    longest = max((stream.times[b] - stream.times[a] for a, b in lost), default=0.0)
    return StreamSurvey(
        name=name,
        kind=kind,
        frames=len(stream.times),
        seconds=float(stream.times[-1] - stream.times[0]),
        rate_hz=1.0 / float(np.median(steps)),
        jitter_ms=float(np.sqrt(np.mean((steps - np.median(steps)) ** 2)) * 1e3),
        lost=int(stream.lost.sum()),
        gaps=len(lost),
        longest_gap_s=float(longest),
        noise_mm=None if noise is None else noise[0],
        noise_deg=None if noise is None else noise[1],
        range_m=None if extent is None else (float(extent[0]), float(extent[1]), float(extent[2])),
    )


def _noise(stream: Stream) -> tuple[float, float] | None:
    """Noise of position [mm] and orientation [deg] in the windows of least motion.

    It is the deviation from a smooth local fit, so that slow motion is not taken for noise; the
    median of the stillest tenth of the windows, so that one lucky window does not decide.
    """
    length = max(SHORTEST, round(REST_S / float(np.median(np.diff(stream.times)))))
    starts = range(0, len(stream.times) - length + 1, max(1, length // 2))
    windows = [slice(at, at + length) for at in starts]
    found = [_deviation(stream, each) for each in windows if not stream.lost[each].any()]
    if not found:
        return None
    count = max(1, len(found) // 10)
    places, angles = (np.sort([each[index] for each in found])[:count] for index in (0, 1))
    return float(np.median(places)) * 1e3, float(np.degrees(np.median(angles)))


def _deviation(stream: Stream, window: slice) -> tuple[float, float]:
    """Root mean square distance [m] and angle [rad] of a window's poses from a smooth fit."""
    times = stream.times[window]
    turned = stream.orientations[window]
    relative = geometry.rotations(turned[:1]).inv() * geometry.rotations(turned)
    return _residual(times, stream.positions[window]), _residual(times, relative.as_rotvec())


def _residual(times: Float[np.ndarray, "frames"], values: Float[np.ndarray, "frames 3"]) -> float:
    """Deviation of values from a cubic in time, freed of the bias of fitting it."""
    base = np.vander((times - times.mean()) / np.ptp(times), DEGREE + 1)
    _, *rest = np.linalg.lstsq(base, values, rcond=None)
    free = len(times) - (DEGREE + 1)
    return float(np.sqrt(np.sum(rest[0]) / free))


def near_pairs(streams: Mapping[str, Stream], count: int = 12) -> list[NearPair]:
    """The pairs on one clock that come nearest each other, relative to how far they part."""
    found = []
    for first, second in combinations(sorted(streams), 2):
        one, two = streams[first], streams[second]
        if np.array_equal(one.times, two.times):
            pair = _near_pair(first, second, one.times, one.positions - two.positions)
            found += [pair] if pair else []
    ranked = sorted(found, key=lambda each: (each[0], each[1].first, each[1].second))
    return [pair for _, pair in ranked[:count]]


def _near_pair(
    first: str,
    second: str,
    times: Float[np.ndarray, "frames"],
    apart: Float[np.ndarray, "frames 3"],
) -> tuple[float, NearPair] | None:
    distance = np.linalg.norm(apart, axis=1)
    if np.isnan(distance).all():
        return None
    least, most = float(np.nanmin(distance)), float(np.nanmax(distance))
    if most - least < 0.05:
        return None  # parts of one body
    step = float(np.median(np.diff(times)))
    near = float((distance <= 1.2 * least).sum() * step)
    return least, NearPair(first, second, least, float(times[np.nanargmin(distance)]), near)


def as_json(surveys: list[StreamSurvey], pairs: list[NearPair]) -> dict[str, Any]:
    """Both lists as plain values."""
    return {"streams": [asdict(each) for each in surveys], "pairs": [asdict(p) for p in pairs]}
