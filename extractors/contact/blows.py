"""Blows: contacts too short to outlast the filter, told by what they set going."""

from collections.abc import Iterable, Iterator, Mapping

import numpy as np

from capar.model import geometry
from capar.model.calibration import Calibration
from capar.model.capture import Capture, Stream
from extractors.bodies.bodies import Bodies
from extractors.bodies.body_geometry import BodyGeometry
from extractors.contact.contacts import Contact
from extractors.contact.proximity import body, near
from extractors.contact.surfaces import surface
from extractors.signals.filters import speed
from extractors.signals.intervals import Interval
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
    """Contacts of end-effectors with things that they set going, beside those already known.

    Args:
        capture: The trial.
        bodies: Its bodies.
        calibration: Distances of contact.
        known: Contacts; what an end-effector touches as it begins to move was not struck.
        motions: When each object moves.
        thresholds: How fast what is struck is, and how soon.
    """
    acting = [each.name for each in capture.acting]
    touched = [each for each in known if each.first in acting]
    for name, spans in motions.items():
        thing = bodies.objects[name]
        own = [each.interval for each in touched if each.second == name]
        for frame in set_going(thing, spans, thresholds):
            around = _around(thing, frame, thresholds)
            if any(first <= around[1] and last >= around[0] for first, last in own):
                continue
            for hand in acting:
                pair = None if hand == name else calibration.pair(hand, name)
                if pair is None or pair.pivots:
                    continue
                met = blow(bodies.sensors[hand], thing, frame, pair.touch_m, thresholds)
                if met is not None:
                    yield Contact(hand, name, met, 0.0)


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

    Args:
        thing: The thing.
        motions: When it moves, as closed intervals of frames.
        thresholds: How fast is fast, and how soon.
    """
    times = thing.poses.smooth.times
    pace = speed(thing.middles, times)
    for first, _ in motions:
        soon = int(np.searchsorted(times, times[first] + thresholds.blow_s))
        with np.errstate(invalid="ignore"):
            if first > 0 and (pace[first : soon + 1] >= thresholds.struck_mps).any():
                yield first


def blow(
    hand: BodyGeometry, thing: BodyGeometry, frame: int, distance_m: float, thresholds: Thresholds
) -> Interval | None:
    """When a hand met a thing that is set going at a frame, by their poses as recorded.

    A low-pass that is longer than the contact takes hand and thing apart; what was recorded has
    the noise of one frame instead, for which the tolerance of contact is meant.

    Args:
        hand: The end-effector.
        thing: The thing.
        frame: When it was seen to move first.
        distance_m: Distance up to which the two touch [m].
        thresholds: How long before and after they may have met.

    Returns:
        The stretch of contact nearest to the frame; None if there is none.
    """
    if hand.shape is None or thing.shape is None:
        return None
    first, last = _around(thing, frame, thresholds)
    part = slice(first, last + 1)
    one = body(surface(hand.shape), _cut(hand.poses.filled, part), rests=False)
    two = body(surface(thing.shape), _cut(thing.poses.filled, part), rests=False)
    found = geometry.runs(near(one, two, distance_m=distance_m))
    if not len(found):
        return None
    begin, end = min(found, key=lambda each: (abs(first + each[0] - frame), each[0]))
    return first + int(begin), first + int(end)
