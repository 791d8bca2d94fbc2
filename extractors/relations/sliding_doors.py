"""Doors that slide aside before an opening: where they are closed.

Such a door stays outside of what it closes, flush before its hollow, and nothing is below it on
which it could lie: what hangs so, and keeps to a level line, hangs on a rail. It is closed at the
end of its range at which it covers the hollow, or more of it. Where it covers as much at both ends,
as one of two leaves does, it is closed where its edge meets the edge of what it closes; an open
one stops short of the other edge, as its handle has no room there.
"""

from collections.abc import Collection
from typing import NamedTuple

import numpy as np
from jaxtyping import Float

from extractors.bodies.body_geometry import BodyGeometry
from extractors.motion.guide_fitting import GuideFit
from extractors.relations.guide_places import (
    borne_from_below,
    covers_a_hollow,
    edge_gap,
    flush_share,
    inside_share,
)
from extractors.thresholds import Thresholds


class Ends(NamedTuple):
    """Frames in which a door is closed and open most, and how much of it is flush [1]."""

    closed: int
    opened: int
    share: float


def ends_before_opening(
    body: BodyGeometry,
    base: BodyGeometry,
    fixed: Collection[BodyGeometry],
    fit: GuideFit,
    still_m: float,
    thresholds: Thresholds,
) -> Ends | None:
    """Where a body that keeps to a rail closes an opening; None if it is no sliding door.

    Args:
        body: The body.
        base: What may have the opening.
        fixed: All that stands fixed: what the body could lie on.
        fit: The rail.
        still_m: How much nearer to the edge is nearer [m].
        thresholds: What is level, flush, and closed.
    """
    side = np.cross(fit.axis, [0.0, 0.0, 1.0])
    length = float(np.linalg.norm(side))
    if length < thresholds.steep or base.planes is None:
        return None
    low, high = int(np.nanargmin(fit.course)), int(np.nanargmax(fit.course))
    for end in (low, high):
        if inside_share(body, base, end) >= thresholds.inside_share:
            return None
        if borne_from_below(body, fixed, end, thresholds):
            return None
    found = [
        _closed_end(body, base, fit, (low, high), way, still_m, thresholds)
        for way in (side / length, -side / length)
    ]
    return max((each for each in found if each), key=lambda each: each.share, default=None)


def _closed_end(
    body: BodyGeometry,
    base: BodyGeometry,
    fit: GuideFit,
    frames: tuple[int, int],
    way: Float[np.ndarray, "3"],
    still_m: float,
    thresholds: Thresholds,
) -> Ends | None:
    """The end at which it alone covers a hollow, or covers more, or meets an edge of the base."""
    shares = [flush_share(body, base, frame, way, thresholds) for frame in frames]
    covers = [
        share >= thresholds.closed_share and covers_a_hollow(body, base, frame, way, thresholds)
        for frame, share in zip(frames, shares, strict=True)
    ]
    if not any(covers):
        return None
    if all(covers) and abs(shares[0] - shares[1]) < thresholds.withdrawn_share:
        gaps = [
            edge_gap(body, base, frame, sign * fit.axis)
            for frame, sign in zip(frames, (-1.0, 1.0), strict=True)
        ]
        if min(gaps) > thresholds.flush_m or abs(gaps[0] - gaps[1]) < still_m:
            return None
        first = gaps[0] < gaps[1]
    else:
        first = covers[0] and (not covers[1] or shares[0] > shares[1])
    closed, opened = frames if first else frames[::-1]
    return Ends(closed, opened, max(shares))
