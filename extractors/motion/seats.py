"""When a body truly comes down on what bears it, and leaves it, within a contact by tolerance."""

from collections.abc import Collection

import numpy as np
from jaxtyping import Float

from extractors.bodies.body_geometry import BodyGeometry
from extractors.motion.motion_edges import GROWN, before_seen, hair, longest
from extractors.signals.intervals import Interval
from extractors.thresholds import Thresholds

REACHES = 3
"""How far beyond a contact a height is followed, in the longest times until it is seen [1]."""


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
    no higher than a hair above the lowest; and likewise at the beginning.

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
    begin = first + _settled(height[first : last + 1], height[:first][::-1], least, most)
    end = last - _settled(height[first : last + 1][::-1], height[last + 1 :], least, most)
    coming = max((m[1] for m in motions if m[0] <= first <= m[1]), default=first)
    going = min((m[0] for m in motions if m[0] <= last <= m[1]), default=last)
    return min(begin, coming), max(end, going)


def _settled(
    height: Float[np.ndarray, "frames"],
    outside: Float[np.ndarray, "others"],
    least: float,
    most: int,
) -> int:
    """How many frames pass before it is down, from the first on, as far as it was not lost.

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
    down = np.flatnonzero(height[:end] <= lowest[end - 1] + least)[0]
    level = float(np.median(height[down:end]))
    passed = int(np.flatnonzero(height[:end] <= level + least)[0])
    way = np.concatenate([height[: passed + 1][::-1], outside[: REACHES * most]])
    later = before_seen((way - level) / least, GROWN, most)
    return min(passed + later, end - 1)
