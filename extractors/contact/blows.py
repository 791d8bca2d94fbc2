"""Blows: contacts too short to outlast the filter, told by what they set going."""

from collections.abc import Collection, Iterable, Iterator, Mapping

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
    """Contacts of end-effectors, and of what they hold, with things that they set going.

    Args:
        capture: The trial.
        bodies: Its bodies.
        calibration: Distances of contact.
        known: Contacts; what is touched by a possible striker as it begins to move was not struck.
        motions: When each object moves.
        thresholds: How fast what is struck is, and how soon.
    """
    acting = [each.name for each in capture.acting]
    touches = tuple(known)
    for name, spans in motions.items():
        thing = bodies.objects[name]
        for frame in set_going(thing, spans, thresholds):
            around = _around(thing, frame, thresholds)
            held = _held(touches, acting, around, set(motions) - {name})
            if _touched(touches, name, {*acting, *held}, around):
                continue
            for other in acting:
                if other != name:
                    yield from _blow_of_any(other, name, frame, bodies, calibration, thresholds)
            for first, second in ((min(each, name), max(each, name)) for each in held):
                pair, one = calibration.pair(first, second), bodies.objects[first]
                if not pair.pivots:
                    met = blow(one, bodies.objects[second], frame, pair.touch_m, thresholds)
                    if met is not None:
                        yield Contact(first, second, met, 0.0)


def _blow_of_any(
    ee: str,
    name: str,
    frame: int,
    bodies: Bodies,
    calibration: Calibration,
    thresholds: Thresholds,
) -> Iterator[Contact]:
    """The contact of an end-effector, or of any part of it, with a thing that is set going."""
    for part in bodies.on_end_effector(ee):
        if part.shape is None or (pair := calibration.pair(part.name, name)).pivots:
            continue
        met = blow(part, bodies.objects[name], frame, pair.touch_m, thresholds)
        if met is not None:
            yield Contact(ee, name, met, 0.0)
            return


def _held(
    known: Iterable[Contact], acting: Collection[str], around: Interval, moving: Collection[str]
) -> tuple[str, ...]:
    """What may strike beside end-effectors: things that move and are touched all that time."""
    found = {
        each.second
        for each in known
        if each.first in acting
        and each.second not in acting
        and each.second in moving
        and each.interval[0] <= around[0]
        and around[1] <= each.interval[1]
    }
    return tuple(sorted(found))


def _touched(
    known: Iterable[Contact], name: str, strikers: Collection[str], around: Interval
) -> bool:
    """Whether one of the strikers is known to touch the thing about then."""
    return any(
        name in (each.first, each.second)
        and (each.first in strikers or each.second in strikers)
        and each.interval[0] <= around[1]
        and around[0] <= each.interval[1]
        for each in known
    )


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
    one: BodyGeometry, other: BodyGeometry, frame: int, distance_m: float, thresholds: Thresholds
) -> Interval | None:
    """When two bodies met of which one is set going at a frame, by their poses as recorded.

    A low-pass that is longer than the contact takes the two apart; what was recorded has
    the noise of one frame instead, for which the tolerance of contact is meant.

    Args:
        one: What strikes, or is struck.
        other: The other of the two.
        frame: When the one that is struck was seen to move first.
        distance_m: Distance up to which the two touch [m].
        thresholds: How long before and after they may have met.

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
