"""When a hand has come to what it touches, and leaves it, where only a distance tells of contact."""

import numpy as np
from jaxtyping import Float

from extractors.motion.object_motion import slopes
from extractors.signals.clock import frame_rate
from extractors.signals.intervals import Interval
from extractors.thresholds import Thresholds


def settled_ends(
    apart: Float[np.ndarray, "frames"],
    contact: Interval,
    times: Float[np.ndarray, "frames"],
    thresholds: Thresholds,
) -> Interval:
    """The closed interval within a contact from the end of the approach to the begin of departure.

    A distance of touch that was estimated has room for fingers that open, so the hand is within it
    before it has arrived and after it has set off. It has arrived when the distance no longer
    shrinks, and leaves when it begins to grow, faster than a body at rest moves.

    Args:
        apart: Distance of the points by which the two touch [m]; NaN where either is lost.
        contact: First and last frame at which they are within the distance of touch.
        times: Clock [s].
        thresholds: The window of a speed, and the speed of a body at rest.

    Returns:
        The contact itself where the two never settle.
    """
    rate_hz = frame_rate(times)
    half = max(1, round(0.5 * thresholds.rest_window_s * rate_hz))
    first, last = contact
    begin, end = max(first - half, 0), min(last + half + 1, len(apart))
    opening = slopes(apart[begin:end, None], half)[:, 0] * rate_hz
    opening = opening[first - begin : last + 1 - begin]
    # A comparison with an unknown speed is false: where either was lost nothing is settled later.
    arrived = np.flatnonzero(~(opening < -thresholds.rest_speed_mps))
    there = np.flatnonzero(~(opening > thresholds.rest_speed_mps))
    if not arrived.size or not there.size or arrived[0] >= there[-1]:
        return contact
    return first + int(arrived[0]), first + int(there[-1])
