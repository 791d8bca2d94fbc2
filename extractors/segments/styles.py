"""How a performer moves: timing along the way and significant places of the path (thesis 3.4)."""

import numpy as np
from jaxtyping import Float, Int

from capar.model.observation import Segment
from capar.model.par import PathPoint, Style
from extractors.measure import Track
from extractors.thresholds import Thresholds

STEPS = 33
"""Samples of a VelStyle, at equal steps of time from the first to the last [1]."""


def style(
    segment: Segment, track: Track, times: Float[np.ndarray, "frames"], thresholds: Thresholds
) -> Style:
    """How a segment was performed: its VelStyle and its PathStyle."""
    span = segment.first, segment.last
    return Style(
        action=segment.name,
        purpose=segment.purpose,
        ee=segment.ee,
        velocity=velocity_style(track.positions, times, *span, thresholds=thresholds),
        path=path_style(track.positions, times, track.crossings, *span),
    )


def velocity_style(
    positions: Float[np.ndarray, "frames 3"],
    times: Float[np.ndarray, "frames"],
    first: int,
    last: int,
    *,
    thresholds: Thresholds,
) -> tuple[float, ...]:
    """VelStyle: the share of the way covered, at ``STEPS`` equal steps of a segment's time.

    Per axis it is the integral of the speed's size up to a time over that to the end; the axes
    that move are averaged (thesis 4.4.2.3, eq. 4.1). It never falls and goes from 0 to 1; for an
    end-effector that does not move it is the time itself.

    Args:
        positions: Low-passed places of the end-effector [m]; NaN where lost.
        times: Clock [s].
        first: Frame where the segment begins.
        last: Frame where it ends.
        thresholds: What share of the largest axis's way makes an axis move.
    """
    steps = np.linspace(0.0, 1.0, STEPS)
    part, clock = positions[first : last + 1], times[first : last + 1]
    known = ~np.isnan(part[:, 0])
    if known.sum() < 2:
        return tuple(map(float, steps))
    ways = np.abs(np.diff(part[known], axis=0))
    lengths = ways.sum(axis=0)
    moves = (lengths >= thresholds.axis_share * lengths.max()) & (lengths > 0.0)
    if not moves.any():
        return tuple(map(float, steps))
    shares = np.cumsum(ways[:, moves], axis=0) / lengths[moves]
    covered = np.concatenate([[0.0], shares.mean(axis=1)])
    share_of_time = (clock[known] - clock[0]) / (clock[-1] - clock[0])
    style = np.clip(np.interp(steps, share_of_time, covered), 0.0, 1.0)
    style[0], style[-1] = 0.0, 1.0
    return tuple(map(float, np.maximum.accumulate(style)))


def path_style(
    positions: Float[np.ndarray, "frames 3"],
    times: Float[np.ndarray, "frames"],
    crossings: Int[np.ndarray, "crossings"],
    first: int,
    last: int,
) -> tuple[PathPoint, ...]:
    """PathStyle: the end-effector's places at the zero crossings strictly inside a segment.

    Args:
        positions: Low-passed places of the end-effector [m]; NaN where lost.
        times: Clock [s].
        crossings: Frames at which its acceleration crosses zero, ascending.
        first: Frame where the segment begins.
        last: Frame where it ends.
    """
    inside = [int(each) for each in crossings if first < each < last]
    whole = times[last] - times[first]
    return tuple(
        PathPoint(float((times[each] - times[first]) / whole), _point(positions[each]))
        for each in inside
        if not np.isnan(positions[each]).any()
    )


def _point(position: Float[np.ndarray, "3"]) -> tuple[float, float, float]:
    x, y, z = map(float, position)
    return x, y, z
