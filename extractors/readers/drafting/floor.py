"""Where the floor is, by the feet that stand on it, and how level it is."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from extractors.readers.drafting.stance import Points

STANDING_MPS = 0.25
"""A foot's lowest point that is slower than this stands [m/s]."""

LOW_M = 0.05
"""... if it is no higher above the lowest than this [m]: a foot may be held still in the air."""

SHARES = (0.05, 0.95)
"""The range in which feet stand is between these shares of their frames [1]."""

TOLERANCE_M = (0.010, 0.040)
"""The least and largest tolerance of contact that a floor is drafted with [m]."""

MARGIN_M = 1.0
"""How far the floor goes beyond where feet are [m]."""

THICK_M = 0.02
RADIUS_M = 0.03
"""Radius of a foot's stand-in: half the thickness of a foot [m]."""


@dataclass(frozen=True)
class Floor:
    """A level floor under the feet."""

    top_m: float
    """Height of its surface [m]."""

    spread_m: float
    """Range of heights at which feet stand [m]."""

    middle: tuple[float, float]
    size: tuple[float, float]
    """Where it is and how large, along x and y [m]."""

    rests: bool
    """Whether any foot stands; else the floor is under the lowest point of a foot."""

    @property
    def tolerance_m(self) -> float:
        """Distance at which feet touch it: what their heights differ by [m]."""
        low, high = TOLERANCE_M
        return float(np.clip(np.ceil(200 * self.spread_m) / 200, low, high))


def floor(
    points: Points, feet: Mapping[str, Sequence[str]], rate_hz: float, radius_m: float = RADIUS_M
) -> Floor:
    """The floor under some feet.

    Args:
        points: In the world: metres, z up.
        feet: The points of each foot.
        rate_hz: Frames a second.
        radius_m: How far the surface of a foot's stand-in is from its points.
    """
    standing = [_standing_heights(points, names, rate_hz) for names in feet.values()]
    heights = np.concatenate(standing)
    rests = bool(heights.size)
    if not rests:
        heights = np.array([np.nanmin(points[n][:, 2]) for group in feet.values() for n in group])
    heights = heights[heights <= heights.min() + (LOW_M if rests else 0.0)]
    low, high = np.quantile(heights, SHARES)
    ground = np.concatenate([points[name] for names in feet.values() for name in names])
    ground = ground[~np.isnan(ground).any(axis=1), :2]
    first, last = ground.min(axis=0) - MARGIN_M, ground.max(axis=0) + MARGIN_M
    (x, y), (long, wide) = (first + last) / 2, last - first
    return Floor(
        float(low) - radius_m,
        float(high - low),
        (float(x), float(y)),
        (float(long), float(wide)),
        rests,
    )


def _standing_heights(
    points: Points, names: Sequence[str], rate_hz: float
) -> Float[np.ndarray, "frames"]:
    """Heights of a foot's lowest point in the frames in which it stands [m]."""
    stack = np.stack([points[name] for name in names])
    heights = np.where(np.isnan(stack[..., 2]), np.inf, stack[..., 2])
    lowest = np.argmin(heights, axis=0)
    frames = np.arange(stack.shape[1])
    speeds = np.full(stack.shape[:2], np.inf)
    speeds[:, 1:] = np.linalg.norm(np.diff(stack, axis=1), axis=2) * rate_hz
    own = speeds[lowest, frames]
    height = heights[lowest, frames]
    return height[np.isfinite(height) & (np.nan_to_num(own, nan=np.inf) <= STANDING_MPS)]
