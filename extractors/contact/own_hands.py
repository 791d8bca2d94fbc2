"""Two hands of one person that meet: which meetings count, and whose they are."""

from collections.abc import Iterable, Iterator
from dataclasses import replace
from itertools import combinations

import numpy as np
from jaxtyping import Bool

from capar.model.capture import Capture, Sensor, TagObject, TagType
from capar.model.geometry import runs
from extractors.bodies.bodies import Bodies
from extractors.contact.proximity import body, near
from extractors.contact.surfaces import surface
from extractors.motion.rest import resting
from extractors.signals.intervals import Interval
from extractors.thresholds import Thresholds

HAND = "hand"


def with_meeting_hands(capture: Capture) -> Capture:
    """The capture in which hands of one person that meet are things to touch as well: SELF objects.

    That holds for hands with shapes that come together while neither has a mobile object at its
    surface; those that hold or pass something meet by the way. Who declares one of the two hands
    as an object has said which meetings are watched. Where the capture states a tolerance larger
    than noise accounts for, its surfaces are off by so much that two hands beside each other would
    meet: there they have to be declared.
    """
    limits = Thresholds()
    tolerance_m = capture.contact_tolerance_m or limits.tolerance_most_m
    if tolerance_m > limits.tolerance_most_m:
        return capture
    found: dict[str, Sensor] = {}
    for one, other in _pairs(capture):
        if _meet_free(capture, one, other, tolerance_m):
            found |= {one.name: one, other.name: other}
    if not found:
        return capture
    objects = tuple(
        TagObject(each.name, TagType.SELF, each.stream, each.shape, HAND, agent=each.agent)
        for each in found.values()
    )
    return replace(capture, objects=(*capture.objects, *objects))


def _pairs(capture: Capture) -> Iterator[tuple[Sensor, Sensor]]:
    """The two hands of each agent, where both have shapes and neither is an object already."""
    objects = {each.name for each in capture.objects}
    hands = [
        each
        for each in capture.acting
        if each.end_effector == HAND and each.shape is not None and each.name not in objects
    ]
    for one, other in combinations(hands, 2):
        if capture.agent_of(one) == capture.agent_of(other) and one.side != other.side:
            yield one, other


def _meet_free(capture: Capture, one: Sensor, other: Sensor, tolerance_m: float) -> bool:
    """Whether two hands ever meet with nothing mobile at either."""
    met = _near_any(capture.parts_of(one.name), [other], tolerance_m)
    met |= _near_any(capture.parts_of(other.name), [one], tolerance_m)
    if not met.any():
        return False
    hands = (*capture.parts_of(one.name), *capture.parts_of(other.name))
    mobile = [each for each in capture.objects if each.tag is TagType.MOBILE]
    busy = _near_any(hands, mobile, tolerance_m)
    return any(not busy[first : last + 1].any() for first, last in runs(met))


def _near_any(
    some: Iterable[Sensor], others: Iterable[Sensor | TagObject], tolerance_m: float
) -> Bool[np.ndarray, "frames"]:
    """At which frames any of some bodies is at any of others; those without shapes are at none."""
    some, others = list(some), list(others)
    out = np.zeros(len(some[0].stream.times), dtype=bool)
    for one in some:
        for other in others:
            if one.shape is not None and other.shape is not None:
                first = body(surface(one.shape), one.stream, rests=False)
                second = body(surface(other.shape), other.stream, rests=False)
                out |= near(first, second, distance_m=tolerance_m)
    return out


def counted_meetings(
    capture: Capture,
    bodies: Bodies,
    meetings: Iterable[tuple[str, str, Interval]],
    thresholds: Thresholds,
) -> Iterator[bool]:
    """Whether each contact counts: one of two hands of an agent does not always.

    It does not while either touches a mobile object, and it is not that of a hand that rests when
    the other one comes to it.

    Args:
        capture: The trial.
        bodies: Its bodies.
        meetings: Contacts: who touches what, and when.
        thresholds: What rest is measured by.
    """
    known = list(meetings)
    hands = {each.name: each for each in capture.acting if each.end_effector == HAND}
    mobile = {each.name for each in capture.objects if each.tag is TagType.MOBILE}
    held = [(one, span) for one, other, span in known if one in hands and other in mobile]
    for one, other, span in known:
        own = one in hands and other in hands
        if not own or capture.agent_of(hands[one]) != capture.agent_of(hands[other]):
            yield True
        elif any(name in (one, other) and _share(span, busy) for name, busy in held):
            yield False
        else:
            waits = _rests(bodies, one, span[0], thresholds)
            yield not (waits and not _rests(bodies, other, span[0], thresholds))


def _share(one: Interval, other: Interval) -> bool:
    return one[0] <= other[1] and other[0] <= one[1]


def _rests(bodies: Bodies, hand: str, frame: int, thresholds: Thresholds) -> bool:
    spans = resting(bodies.sensors[hand].poses, thresholds)
    return any(first <= frame <= last for first, last in spans)
