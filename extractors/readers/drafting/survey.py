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
    found = []
    for window in (slice(at, at + length) for at in starts):
        if not stream.lost[window].any():
            times, turned = stream.times[window], geometry.rotations(stream.orientations[window])
            relative = (turned[0].inv() * turned).as_rotvec()
            found.append((_residual(times, stream.positions[window]), _residual(times, relative)))
    if not found:
        return None
    place, angle = np.median(np.sort(found, axis=0)[: max(1, len(found) // 10)], axis=0)
    return float(place) * 1e3, float(np.degrees(angle))


def _residual(times: Float[np.ndarray, "frames"], values: Float[np.ndarray, "frames 3"]) -> float:
    """Deviation of values from a cubic in time, freed of the bias of fitting it."""
    base = np.vander((times - times.mean()) / np.ptp(times), DEGREE + 1)
    _, *rest = np.linalg.lstsq(base, values, rcond=None)
    return float(np.sqrt(np.sum(rest[0]) / (len(times) - (DEGREE + 1))))


def near_pairs(streams: Mapping[str, Stream], count: int = 12) -> list[NearPair]:
    """The pairs on one clock that come nearest each other, nearest first."""
    found = []
    for first, second in combinations(sorted(streams), 2):
        one, two = streams[first], streams[second]
        if not np.array_equal(one.times, two.times):
            continue
        distance = np.linalg.norm(one.positions - two.positions, axis=1)
        if np.isnan(distance).all() or np.nanmax(distance) - np.nanmin(distance) < 0.05:
            continue  # never seen together, or parts of one body
        least, at = float(np.nanmin(distance)), int(np.nanargmin(distance))
        near_s = float((distance <= 1.2 * least).sum() * np.median(np.diff(one.times)))
        found.append(NearPair(first, second, least, float(one.times[at]), near_s))
    return sorted(found, key=lambda each: (each.least_m, each.first, each.second))[:count]


def as_json(surveys: list[StreamSurvey], pairs: list[NearPair]) -> dict[str, Any]:
    """Both lists as plain values."""
    return {"streams": [asdict(each) for each in surveys], "pairs": [asdict(p) for p in pairs]}
