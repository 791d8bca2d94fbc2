"""When a body truly comes down on what bears it, and leaves it, within a contact by tolerance."""

from collections.abc import Collection

import numpy as np
from jaxtyping import Float

from extractors.bodies.body_geometry import BodyGeometry
from extractors.motion.motion_edges import GROWN, hair, longest
from extractors.signals.clock import frame_rate
from extractors.signals.intervals import Interval
from extractors.thresholds import Thresholds

REACHES = 3
"""How far beyond a contact a height is followed, in the longest times until it is seen [1]."""

POWERS = (1.0, 3.0)
"""With which power of time a displacement grows [1]: at once, by a steady push, smoothly."""

AGREEMENT = 0.1
"""A beginning is sure if both estimates of how long ago it was differ by no larger share [1]."""

UNSURE = 1.0 / 3.0
"""Share of the longest time by which a motion may have begun earlier if that is not sure [1]: what
drifts, or is recorded at few frames, grows with no power of time."""

LEAST = 0.01
"""A displacement is taken for at least this [1], since less is noise."""


def seat(
    body: BodyGeometry,
    other: BodyGeometry,
    contact: Interval,
    motions: Collection[Interval],
    thresholds: Thresholds,
) -> Interval:
    """The closed interval within a contact in which the body is down on the other.

    Bodies touch within a tolerance, so that a contact begins before the body has come down and
    lasts after it has risen. It is down until it begins to rise to where the contact ends: until
    its lowest point was last no more than a hair above its level before that, as far back as it was
    no higher than a hair above the lowest; and likewise at the beginning. What rises as soon as it
    has come down is down where it was lowest.

    Args:
        body: What lies on the other.
        other: What bears it.
        contact: First and last frame of their contact.
        motions: When either of them moves; at rest nothing comes down or leaves.
        thresholds: What a hair is.
    """
    first, last = contact
    height = body.boxes[0][:, 2] - other.middles[:, 2]
    near = hair(body.poses, thresholds)
    most = longest(body.poses, near, thresholds)
    least = near.position_m
    lies = max(1, round(thresholds.rest_begins_s * frame_rate(body.poses.filled.times)))
    begin = first + _settled(height[first : last + 1], height[:first][::-1], least, most, lies)
    end = last - _settled(height[first : last + 1][::-1], height[last + 1 :], least, most, lies)
    coming = max((m[1] for m in motions if m[0] <= first <= m[1]), default=first)
    going = min((m[0] for m in motions if m[0] <= last <= m[1]), default=last)
    begin, end = min(begin, coming), max(end, going)
    if begin <= end:
        return begin, end
    # It rose as soon as it had come down.
    lowest = end + int(np.nanargmin(height[end : begin + 1]))
    return lowest, lowest


def _settled(
    height: Float[np.ndarray, "frames"],
    outside: Float[np.ndarray, "others"],
    least: float,
    most: int,
    lies: int,
) -> int:
    """How many frames pass before it is down, from the first on, as far as it was not lost.

    It is down where it first is for so many frames (``lies``) no more than a hair above its lowest,
    or for as long as the contact lasts: the level is that of these frames, however long it lies.

    People stop smoothly: the height over what bears it shrinks with the cube of time (minimum jerk;
    Flash and Hogan 1985), so it comes down later than it passes a hair's width, by at most so many
    frames. Where noise makes a hair as wide as the tolerance of contact, the height is followed
    beyond the contact.
    """
    lost = np.flatnonzero(np.isnan(height))
    height = height[: lost[0]] if lost.size else height
    if not height.size:
        return 0
    lowest = np.minimum.accumulate(height)
    higher = np.flatnonzero(height > lowest + least)
    end = int(higher[0]) if higher.size else len(height)
    since = np.searchsorted(-lowest, -(lowest + least))
    long = np.flatnonzero(np.arange(len(height)) - since >= lies - 1)
    end = min(end, int(long[0]) + 1) if long.size else end
    down = np.flatnonzero(height[:end] <= lowest[end - 1] + least)[0]
    level = float(np.median(height[down:end]))
    passed = int(np.flatnonzero(height[:end] <= level + least)[0])
    way = np.concatenate([height[: passed + 1][::-1], outside[: REACHES * most]])
    later = before_seen((way - level) / least, GROWN, most)
    return min(passed + later, end - 1)


def before_seen(grows: Float[np.ndarray, "some"], reach: float, most: int) -> int:
    """How many frames before it is 1 a displacement that grows with a power of time was none.

    The power is the one of ``POWERS`` that agrees best with when it was half as large, in powers
    of ten, as in the end.

    Args:
        grows: The displacement, from where it is about 1 on.
        reach: How large it should have grown for this to be told [1]; less if it never is.
        most: The answer at most.
    """
    if not grows.size or np.isnan(grows[0]):
        return 0
    large = np.flatnonzero(grows >= reach)
    far = int(large[0]) if large.size else int(np.nanargmax(grows))
    begin, end = max(float(grows[0]), LEAST), float(grows[far])
    if end <= begin:
        return 0
    middle = float(np.sqrt(begin * end))
    half = int(np.flatnonzero(grows[: far + 1] >= middle)[0])
    tries = [
        (_lasted(begin, end, far, power), _lasted(begin, middle, half, power)) for power in POWERS
    ]
    whole, part = min(tries, key=lambda both: abs(1.0 - both[1] / both[0]))
    if abs(1.0 - part / whole) > AGREEMENT:
        most = round(most * UNSURE)
    return min(round(whole), most)


def _lasted(begin: float, end: float, frames: int, power: float) -> float:
    """How many frames it took to ``begin`` if it then takes so many to ``end``."""
    first, last = begin ** (1.0 / power), end ** (1.0 / power)
    return frames * first / (last - first)
