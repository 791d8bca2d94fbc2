"""Short losses of tracking are interpolated; long ones stay lost and are reported."""

import numpy as np
from jaxtyping import Float

from capar.model import geometry
from capar.model.capture import Stream
from extractors.signals.clock import time_step

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
