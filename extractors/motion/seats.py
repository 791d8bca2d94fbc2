"""When a body truly comes down on what bears it, and leaves it, within a contact by tolerance."""

from collections.abc import Collection

import numpy as np
from jaxtyping import Float

from extractors.bodies.body_geometry import BodyGeometry
from extractors.motion.motion_edges import GROWN, hair, longest
from extractors.motion.onsets import onset
from extractors.signals.clock import frame_rate
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
    coming = _settled(body, height[first : last + 1], height[:first][::-1], thresholds)
    going = _settled(body, height[first : last + 1][::-1], height[last + 1 :], thresholds)
    begin, end = first + coming, last - going
    arrived = max((m[1] for m in motions if m[0] <= first <= m[1]), default=first)
    leaves = min((m[0] for m in motions if m[0] <= last <= m[1]), default=last)
    return min(begin, arrived), max(end, leaves)


def _settled(
    body: BodyGeometry,
    height: Float[np.ndarray, "frames"],
    outside: Float[np.ndarray, "others"],
    thresholds: Thresholds,
) -> int:
    """How many frames pass before it is down, from the first on, as far as it was not lost.

    It comes down later than it passes a hair's width, which follows from how its height over what
    bears it shrank (``onset``, against time). Where noise makes a hair as wide as the tolerance of
    contact, the height is followed beyond the contact.

    Args:
        body: The body that comes down.
        height: Its height within the contact [m], from where it comes.
        outside: Its height before that [m], from the contact on.
        thresholds: What a hair is.
    """
    lost = np.flatnonzero(np.isnan(height))
    height = height[: lost[0]] if lost.size else height
    if not height.size:
        return 0
    poses, rate_hz = body.poses, frame_rate(body.poses.filled.times)
    near = hair(poses, thresholds)
    most, least = longest(poses, near, thresholds), near.position_m
    lowest = np.minimum.accumulate(height)
    higher = np.flatnonzero(height > lowest + least)
    end = int(higher[0]) if higher.size else len(height)
    down = np.flatnonzero(height[:end] <= lowest[end - 1] + least)[0]
    level = float(np.median(height[down:end]))
    passed = int(np.flatnonzero(height[:end] <= level + least)[0])
    way = (np.concatenate([height[:end][::-1], outside[: REACHES * most]]) - level) / least
    seen = end - 1 - passed
    far = seen + _well_up(way[seen:])
    noise, rest = poses.noise.position_m / least, round(thresholds.rest_minimum_s * rate_hz)
    way = way[: far + 1]
    begin = onset(way, way, seen, noise=noise, most=most, rest=rest, rate_hz=rate_hz)
    return max(min(end - 1 - begin, end - 1), 0)


def _well_up(way: Float[np.ndarray, "frames"]) -> int:
    """The frame at which it is clear how a height grew; the highest if it never is [hairs]."""
    beyond = np.flatnonzero(~(way < GROWN))
    return int(beyond[0]) if beyond.size else int(np.argmax(way))
