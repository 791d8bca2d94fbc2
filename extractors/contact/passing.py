"""Contacts in passing: two bodies brush against each other, and both keep their course."""

import numpy as np
from jaxtyping import Float

from extractors.bodies.body_geometry import BodyGeometry
from extractors.signals.intervals import Interval, duration
from extractors.thresholds import Thresholds

ASIDE_S = 0.05
"""How long before and after a contact the course of two bodies is taken [s].

No threshold: it is the time over which the low-pass filter blurs what happens at once.
"""


def in_passing(
    one: BodyGeometry, other: BodyGeometry, contact: Interval, thresholds: Thresholds
) -> bool:
    """Whether two bodies keep their course relative to each other through a brief contact.

    A blow turns that course back or ends it, a grasp ends it, and what is pushed or struck away
    takes it over. A hand that brushes past a thing goes on as before.

    Args:
        one: A body.
        other: The other one.
        contact: First and last frame of their contact.
        thresholds: What is brief, what is fast, and how much of the course is kept.
    """
    first, last = contact
    times = one.poses.smooth.times
    if duration(contact, times, float(times[1] - times[0])) >= thresholds.passing_s:
        return False
    begin = int(np.searchsorted(times, times[first] - ASIDE_S - 1e-9))
    end = int(np.searchsorted(times, times[last] + ASIDE_S - 1e-9))
    if not 0 <= begin < first or not last < end < len(times):
        return False
    before = _course(one, other, (begin, first))
    after = _course(one, other, (last, end))
    pace = float(np.linalg.norm(before))
    if not pace >= thresholds.passing_mps:
        return False
    return bool(before @ after >= thresholds.passing_share * pace**2)


def _course(one: BodyGeometry, other: BodyGeometry, span: Interval) -> Float[np.ndarray, "3"]:
    """Mean velocity of a body's middle relative to another's between two frames [m/s]."""
    offsets = [one.middles[frame] - other.middles[frame] for frame in span]
    times = one.poses.smooth.times
    return np.asarray((offsets[1] - offsets[0]) / (times[span[1]] - times[span[0]]))
