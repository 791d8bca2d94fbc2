"""Motion to and fro of a long, thin body along its own length."""

from collections.abc import Iterable

import numpy as np
from jaxtyping import Float

from extractors.bodies.body_geometry import BodyGeometry
from extractors.signals.intervals import Interval
from extractors.thresholds import Thresholds


def lengthwise(
    body: BodyGeometry, swinging: Iterable[Interval], thresholds: Thresholds
) -> tuple[Interval, ...]:
    """Those of the stretches in which a body goes along its own length rather than across.

    Args:
        body: The body; one that is not long and thin, or has no shape, goes along nothing.
        swinging: Closed intervals of frames in which it moves to and fro.
        thresholds: How long is long, and which share of its path is along.
    """
    axis = long_axis(body, thresholds)
    if axis is None:
        return ()
    least = thresholds.lengthwise_share
    return tuple(span for span in swinging if _share_along(body, axis, span) >= least)


def long_axis(body: BodyGeometry, thresholds: Thresholds) -> Float[np.ndarray, "3"] | None:
    """The unit axis of a long, thin body in its own frame; None for any other body.

    The axis is the principal one of its outermost points; its length along the axis is so many
    times the largest distance across that two of the points have.
    """
    points = body.corners - body.corners.mean(axis=0)
    if len(points) < 2:
        return None
    axes = np.linalg.svd(points, full_matrices=False)[2]
    along = points @ axes[0]
    across = points - np.outer(along, axes[0])
    wide = np.linalg.norm(across[:, None] - across[None], axis=2).max()
    return axes[0] if np.ptp(along) >= thresholds.slender_ratio * wide else None


def _share_along(body: BodyGeometry, axis: Float[np.ndarray, "3"], span: Interval) -> float:
    """Which share of its origin's path is along its own axis [1]; lost frames count nothing."""
    part = slice(span[0], span[1] + 1)
    steps = np.diff(body.poses.smooth.positions[part], axis=0)
    lengths = (body.turns_at(part) @ axis)[:-1]
    way = np.nansum(np.linalg.norm(steps, axis=1))
    along = np.nansum(np.abs(np.einsum("ij,ij->i", steps, lengths)))
    return float(along / way) if way > 0.0 else 0.0
