"""How firmly hands and head are led at each frame, and what is looked at."""

from collections.abc import Collection, Mapping, Sequence

import numpy as np
from jaxtyping import Float
from scipy.spatial.transform import RigidTransform

from capar.model.capture import TagType
from capar.model.facts import LookingAt
from capar.regeneration.sources import Hold, Meeting, Source

FAR_M = 3.0
"""Distance of the point looked at where nothing is [m]."""

SHIFT_S = 0.3
"""How long a shift of gaze takes [s]."""

EVENT_S = 0.3
"""How long before and after an event a hand may be led more firmly [s]."""

REST_S = 0.5
"""Over so long it is seen whether a hand rests [s]."""

REST_M, REST_SHARE = 0.02, 0.5
"""A hand that stays so near for a while rests [m], and how firmly it is kept there [1]."""


def grasps(
    source: Source, firm_s: float, events: Collection[int] = (), weight: float = 1.0
) -> dict[str, Float[np.ndarray, "frames"]]:
    """How firmly each hand is led [1]: in holds, and less so at rest beside a body that leans.

    Args:
        source: The recorded performance.
        firm_s: How long before a hold the hand is led more and more firmly [s].
        events: Frames at which things are taken, let go, and have to be somewhere.
        weight: How firmly it is led in holds at these frames; 1 at others [1].
    """
    out = {}
    for side, hand in source.hands.items():
        holds = [hold for hold in source.holds if hold.side == side]
        firm = around(source, holds, firm_s)
        edges = {frame for hold in holds for frame in (hold.first, hold.last)}
        instants = [Hold(side, "", frame, frame) for frame in sorted(edges.union(events))]
        firm *= 1.0 + (weight - 1.0) * around(source, instants, EVENT_S)
        out[side] = np.maximum(firm, REST_SHARE * _rests(source, hand.path.translation))
    return out


def _rests(source: Source, spots: Float[np.ndarray, "frames 3"]) -> Float[np.ndarray, "frames"]:
    """One where something hardly moves for a while, smoothly falling to zero beside that."""
    half = max(round(0.5 * REST_S * source.rate_hz), 1)
    padded = np.pad(spots, ((half, half), (0, 0)), mode="edge")
    windows = np.lib.stride_tricks.sliding_window_view(padded, 2 * half + 1, axis=0)
    still = (np.ptp(windows, axis=2).max(axis=1) < REST_M).astype(float)
    mean = np.ones(2 * half + 1) / (2 * half + 1)
    smooth = np.convolve(np.pad(still, half, mode="edge"), mean, mode="valid")
    return np.asarray(smooth)


def around(
    source: Source, spans: Sequence[Hold | Meeting], settle_s: float
) -> Float[np.ndarray, "frames"]:
    """One during some spans, smoothly falling to zero on both sides of each."""
    out = np.zeros(len(source.times))
    for span in spans:
        start, end = source.times[span.first], source.times[span.last]
        away = np.maximum(np.maximum(start - source.times, source.times - end), 0.0)
        share = np.clip(1.0 - away / settle_s, 0.0, 1.0)
        out = np.maximum(out, share**3 * (10.0 - 15.0 * share + 6.0 * share**2))
    return out


def looks(
    source: Source, things: Mapping[str, RigidTransform], head: RigidTransform
) -> Float[np.ndarray, "frames 3"]:
    """The point looked at: a thing that was looked at, else ahead along the line of sight."""
    points = head.translation + FAR_M * head.rotation.apply([1.0, 0.0, 0.0])
    for fact in source.observation.facts:
        if isinstance(fact, LookingAt) and fact.object in things:
            thing = source.scene.thing(fact.object)
            if thing.tag is TagType.MOBILE:
                middle = 0.5 * thing.shape.bounds.sum(axis=0)
                part = slice(fact.first, fact.last + 1)
                points[part] = things[fact.object][part].apply(middle)
    width = max(round(SHIFT_S * source.rate_hz) | 1, 3)
    window = np.hanning(width + 2)[1:-1]
    padded = np.pad(points, ((width // 2, width // 2), (0, 0)), mode="edge")
    columns = [np.convolve(c, window / window.sum(), mode="valid") for c in padded.T]
    return np.stack(columns, axis=1)
