"""Blows and arrivals: how fast bodies meet and part."""

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import replace

import numpy as np

from capar.model import geometry
from capar.model.calibration import Calibration, Found
from capar.model.capture import Capture, Stream
from capar.model.facts import Fact, Moving
from capar.model.geometry import Series
from extractors.bodies.bodies import Bodies, BodyGeometry
from extractors.contact.contacts import Contact, points_apart
from extractors.contact.proximity import body, near
from extractors.contact.surfaces import surface
from extractors.motion.object_motion import slopes
from extractors.signals.filters import speed
from extractors.signals.intervals import Interval, frame_rate
from extractors.thresholds import Thresholds

Motions = Mapping[str, Iterable[Interval]]
"""When each object moves, by its name."""


def blows(
    capture: Capture,
    bodies: Bodies,
    calibration: Calibration,
    known: Iterable[Contact],
    motions: Motions,
    thresholds: Thresholds,
) -> Iterator[Contact]:
    """Contacts of end-effectors, and of what they hold, with things that they set going."""
    acting = [each.name for each in capture.acting]
    touches = tuple(known)
    for name, spans in motions.items():
        thing = bodies.objects[name]
        for frame in set_going(thing, spans, thresholds):
            around = _around(thing, frame, thresholds)
            # What may strike besides end-effectors moves and is touched all that time.
            held = {
                each.second
                for each in touches
                if each.first in acting
                and each.second not in acting
                and each.second in set(motions) - {name}
                and each.interval[0] <= around[0]
                and around[1] <= each.interval[1]
            }
            strikers = {*acting, *held}
            if any(
                name in (each.first, each.second)
                and (each.first in strikers or each.second in strikers)
                and each.interval[0] <= around[1]
                and around[0] <= each.interval[1]
                for each in touches
            ):
                continue
            pairs = [
                (part, thing, part.name, name, other, name)
                for other in acting
                if other != name
                for part in bodies.on_end_effector(other)
                if part.shape is not None
            ]
            for each in sorted(held):
                first, second = min(each, name), max(each, name)
                pairs.append(
                    (bodies.objects[first], bodies.objects[second], first, second, first, second)
                )
            found: set[tuple[str, str]] = set()
            for one, two, first, second, whole, other in pairs:
                pair = calibration.pair(first, second)
                if (whole, other) in found or pair.pivots:
                    continue
                met = blow(one, two, frame, pair.touch_m, thresholds)
                if met is not None:
                    found.add((whole, other))
                    yield Contact(whole, other, met, 0.0)


def _around(thing: BodyGeometry, frame: int, thresholds: Thresholds) -> Interval:
    """The frames that are so near that a filter may have moved what happened there."""
    times = thing.poses.filled.times
    first = int(np.searchsorted(times, times[frame] - thresholds.blow_s))
    last = int(np.searchsorted(times, times[frame] + thresholds.blow_s, side="right")) - 1
    return first, last


def _cut(stream: Stream, part: slice) -> Stream:
    return Stream(stream.times[part], stream.positions[part], stream.orientations[part])


def set_going(
    thing: BodyGeometry, motions: Iterable[Interval], thresholds: Thresholds
) -> Iterator[int]:
    """Frames at which a thing that rested is set going at once, as nothing but a blow does.

    It is as fast as a struck thing within the time by which the filter blurs a motion.
    """
    times = thing.poses.smooth.times
    pace = speed(thing.middles, times)
    for first, _ in motions:
        soon = int(np.searchsorted(times, times[first] + thresholds.blow_s))
        with np.errstate(invalid="ignore"):
            if first > 0 and (pace[first : soon + 1] >= thresholds.struck_mps).any():
                yield first


def blow(
    one: BodyGeometry, other: BodyGeometry, frame: int, distance_m: float, thresholds: Thresholds
) -> Interval | None:
    """When two bodies met of which one is set going at a frame, by their poses as recorded.

    A low-pass that is longer than the contact takes the two apart; what was recorded has
    the noise of one frame instead, for which the tolerance of contact is meant.

    ``distance_m``: distance up to which the two touch [m].

    Returns:
        The stretch of contact nearest to the frame; None if there is none.
    """
    if one.shape is None or other.shape is None:
        return None
    first, last = _around(one, frame, thresholds)
    part = slice(first, last + 1)
    first_body = body(surface(one.shape), _cut(one.poses.filled, part), rests=False)
    second_body = body(surface(other.shape), _cut(other.poses.filled, part), rests=False)
    found = geometry.runs(near(first_body, second_body, distance_m=distance_m))
    if not len(found):
        return None
    begin, end = min(found, key=lambda each: (abs(first + each[0] - frame), each[0]))
    return first + int(begin), first + int(end)


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

    ``moves``: when things move, by their floors.
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
    apart: Series, contact: Interval, times: Series, thresholds: Thresholds
) -> Interval:
    """The closed interval within a contact from the end of the approach to the begin of departure.

    An estimated distance has room for fingers that open. The hand has arrived when the distance no
    longer shrinks, and leaves when it begins to grow, faster than a body at rest moves.

    ``apart``: distance of the points by which the two touch [m]; NaN where either is lost.

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
