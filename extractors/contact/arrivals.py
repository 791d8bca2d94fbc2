"""When a hand arrives at what it touches and leaves it, where only a distance tells of contact."""

from collections.abc import Iterable, Iterator
from dataclasses import replace

import numpy as np
from jaxtyping import Float

from capar.model.calibration import Calibration, Found
from capar.model.capture import Capture
from capar.model.facts import Fact, Moving
from extractors.bodies.bodies import Bodies
from extractors.contact.contacts import Contact, points_apart
from extractors.motion.object_motion import slopes
from extractors.signals.clock import frame_rate
from extractors.signals.intervals import Interval
from extractors.thresholds import Thresholds

SETTLES = (Found.CO_MOTION, Found.SETTLING)
"""Distances with room for a hand that opens: with them it is seen when it arrives and leaves."""


def arrivals(
    capture: Capture,
    bodies: Bodies,
    calibration: Calibration,
    touches: Iterable[Contact],
    moves: Iterable[Fact],
    thresholds: Thresholds,
) -> Iterator[Contact]:
    """Contacts, those by an estimated distance from when an end-effector arrives until it leaves.

    What moves beyond its floor as the end-effector comes is touched already, and what moves so as
    it goes is touched still; what merely wobbles as it is grasped or let go is not.

    Args:
        capture: The trial.
        bodies: Its bodies.
        calibration: How the distance of each pair was found.
        touches: Contacts within those distances.
        moves: When things move, by their floors.
        thresholds: The window of a speed, and the speed of a body at rest.
    """
    motions = [each for each in moves if isinstance(each, Moving)]
    for touch in touches:
        pair = calibration.sought(touch.first, touch.second)
        settles = pair is not None and pair.pivots and pair.found in SETTLES
        if pair is None or not settles or touch.first not in bodies.sensors:
            yield touch
            continue
        one, two = bodies.sensors[touch.first], bodies.objects[touch.second]
        apart = points_apart(pair, one, two)
        first, last = settled_ends(apart, touch.interval, capture.times, thresholds)
        comes, goes = touch.interval
        first = min([first, *(max(m.first, comes) for m in motions if _in(m, touch, comes, first))])
        last = max([last, *(min(m.last, goes) for m in motions if _in(m, touch, last, goes))])
        yield replace(touch, interval=(first, last), gap_m=float(apart[first]))


def _in(move: Moving, touch: Contact, first: int, last: int) -> bool:
    """Whether it is a motion of what is touched at some of these frames."""
    return move.object == touch.second and move.first <= last and move.last >= first


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
    # A speed is that of a window about its frame, so it tells of both some frames within.
    here, gone = int(arrived[0]), int(there[-1])
    within = apart[first : last + 1]
    settled = within <= np.fmin.reduce(within[here : gone + 1]) + thresholds.edge_m
    coming, going = np.flatnonzero(~settled[:here]), np.flatnonzero(~settled[gone + 1 :])
    begins = int(coming[-1]) + 1 if coming.size else 0
    ends = gone + int(going[0]) if going.size else len(within) - 1
    return first + begins, first + ends
