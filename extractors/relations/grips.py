"""When an end-effector changes the place at which it touches an object."""

from collections.abc import Iterator

import numpy as np

from extractors.bodies.body_geometry import BodyGeometry
from extractors.signals.filters import speed
from extractors.signals.intervals import Interval
from extractors.signals.zero_crossings import horizon_frames, pauses, zero_crossings
from extractors.thresholds import Thresholds

FEWEST_FRAMES = 5
"""Fewest frames of a contact in which a change of place can be detected [1].

No threshold: two slowest samples, a faster one between them, and one on each side.
"""


def shifts(
    hand: BodyGeometry, thing: BodyGeometry, touching: Interval, thresholds: Thresholds
) -> Iterator[Interval]:
    """From the last pause at one place on an object to the first at another, as closed intervals.

    The place is where the end-effector's middle is in the object's own frame. It pauses there
    where it is slowest in that frame, while hand and object may move together. Another place is
    farther from the first pause at the old one than a hand is wide.

    Args:
        hand: The end-effector.
        thing: The object that it touches.
        touching: Frames through which it does.
        thresholds: Width of a hand, and what makes a pause.
    """
    first, last = touching
    if last - first + 1 < FEWEST_FRAMES:
        return
    part = slice(first, last + 1)
    offset = hand.middles[part] - thing.middles[part]
    place = np.einsum("fij,fi->fj", thing.turns_at(part), offset)
    times = hand.poses.smooth.times[part]
    pace = speed(place, times)
    noise = max(hand.poses.noise.position_m, thing.poses.noise.position_m)
    crossings = zero_crossings(
        pace, times, noise_m=noise, highest_mps=float(np.nanmax(pace)), thresholds=thresholds
    )
    stops = [int(each) for each in pauses(pace, crossings, horizon_frames(times, thresholds))]
    if not stops:
        return
    anchor = latest = stops[0]
    for seat in stops[1:]:
        if float(np.linalg.norm(place[seat] - place[anchor])) > thresholds.hand_width_m:
            yield first + latest, first + seat
            anchor = seat
        latest = seat
