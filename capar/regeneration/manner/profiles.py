"""The part of a way that is covered at each frame, and its shape, as an effort changes them."""

import numpy as np
from jaxtyping import Float

SLOW = 0.05
"""Speeds below this share of the highest one are scaled alike, so that noise is not raised [1]."""

SKEW = 1.5
"""Weight tilts the speeds by this power of e from the first frame to the last one [1]."""

PAUSE = 0.12
"""Bound flow pauses for so long at an end of a stretch [1, of its time]."""

OVERSHOOT, SETTLES = 0.08, 0.3
"""Free flow goes so far beyond a free end [1, of the way] and needs so long for it [1, of time]."""

BULGE, LIFT = 0.15, 0.08
"""Indirect space leads so far aside, light weight so high half-way [1, of the straight way]."""

WIDER = 0.5
"""Indirect space enlarges by so much what deviates from the straight way already [1]."""


def timed(
    shares: Float[np.ndarray, "frames"], time: float, weight: float
) -> Float[np.ndarray, "frames"]:
    """Shares of the way, from 0 to 1, with the speeds of another effort.

    Speeds are raised to the power 2^time, so that the highest over the mean grows with time
    (sudden), and tilted by exp(SKEW * weight) towards the end, so that weight (strong) goes on
    accelerating for longer and light weight eases in.

    Args:
        shares: Of the way, as recorded, not decreasing.
        time: From sustained to sudden.
        weight: From light to strong.
    """
    speeds = np.diff(shares)
    peak = float(speeds.max())
    middle = (np.arange(len(speeds)) + 0.5) / len(speeds)
    rate = np.maximum(speeds / peak, SLOW) ** (2.0**time - 1.0)
    rate = rate * np.exp(SKEW * weight * (middle - 0.5))
    covered = np.concatenate([[0.0], np.cumsum(speeds * rate)])
    return np.asarray(covered / covered[-1])


def paused(
    shares: Float[np.ndarray, "frames"], flow: float, ends: tuple[bool, bool]
) -> Float[np.ndarray, "frames"]:
    """Shares of the way with the pauses of bound flow.

    Args:
        shares: Of the way.
        flow: Bound where above 0; nothing is changed below.
        ends: Whether it may pause at the start and at the end.
    """
    before, after = (PAUSE * max(flow, 0.0) * may for may in ends)
    time = np.linspace(0.0, 1.0, len(shares))
    inner = np.clip((time - before) / (1.0 - before - after), 0.0, 1.0)
    return np.interp(inner, time, shares)


def overshot(frames: int, flow: float) -> tuple[Float[np.ndarray, "frames"], ...]:
    """When the way is gone, and what is gone beyond its end, with free flow.

    Args:
        frames: How many.
        flow: Free where below 0; nothing is changed above.

    Returns:
        The share of the recorded time at each frame, and the added share of the way.
    """
    free = max(-flow, 0.0)
    time = np.linspace(0.0, 1.0, frames)
    arrival = 1.0 - SETTLES * free
    gone = np.minimum(time / arrival, 1.0)
    late = np.clip((time - arrival + SETTLES * free) / (2.0 * SETTLES * max(free, 1e-9)), 0.0, 1.0)
    return gone, OVERSHOOT * free * np.sin(np.pi * late) ** 2


def shaped(
    spots: Float[np.ndarray, "frames 3"],
    space: float,
    weight: float,
    free: Float[np.ndarray, "frames"],
) -> Float[np.ndarray, "frames 3"]:
    """A way between the same ends, more or less direct, higher or lower.

    Direct space takes what deviates from the straight way out of it. Indirect space enlarges that
    and bulges aside: to the side on which the way becomes longer, so that, a length being convex
    in what is added, more indirect is never shorter.

    Args:
        spots: The way [m].
        space: From indirect to direct.
        weight: From light to strong.
        free: How far each frame may be moved [1].
    """
    chord = spots[-1] - spots[0]
    length = float(np.linalg.norm(chord))
    along = (spots - spots[0]) @ chord / length**2
    straight = spots[0] + np.outer(along, chord)
    aside = spots - straight
    steps = np.linalg.norm(np.diff(spots, axis=0), axis=1)
    share = np.concatenate([[0.0], np.cumsum(steps)]) / steps.sum()
    bump = 16.0 * share**2 * (1.0 - share) ** 2
    out = -max(space, 0.0) * aside
    if space < 0.0:
        wider = WIDER * aside + length * BULGE * np.outer(bump, _sideways(chord))
        other = WIDER * aside - length * BULGE * np.outer(bump, _sideways(chord))
        added = wider if _lengthens(spots, wider) >= _lengthens(spots, other) else other
        out = -space * added
    out = out - weight * LIFT * length * np.outer(bump, [0.0, 0.0, 1.0])
    return np.asarray(spots + free[:, None] * out)


def _sideways(chord: Float[np.ndarray, "3"]) -> Float[np.ndarray, "3"]:
    """Level and across a way; to the left of x where that goes straight up."""
    across = np.array([-chord[1], chord[0], 0.0])
    size = float(np.linalg.norm(across))
    return np.asarray(across / size) if size > 1e-9 else np.array([0.0, 1.0, 0.0])


def _lengthens(spots: Float[np.ndarray, "frames 3"], added: Float[np.ndarray, "frames 3"]) -> float:
    """How fast a way becomes longer as something is added to it [m]."""
    steps, more = np.diff(spots, axis=0), np.diff(added, axis=0)
    sizes = np.maximum(np.linalg.norm(steps, axis=1), 1e-12)
    return float(np.sum(np.einsum("ij,ij->i", steps, more) / sizes))
