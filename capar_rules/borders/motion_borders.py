"""Refined start and end of a held object's motion: at the pause of the hand that is near.

An object counts as moving once it is away from its place by a floor that noise cannot reach; by
then it has been on its way for a moment. The zero crossing at which the hand starts, or stops,
tells when.
"""

from bisect import bisect_left, bisect_right
from collections.abc import Iterable, Sequence
from dataclasses import dataclass

from capar.model.facts import Fact, Moving, Touching
from capar_rules.borders.times import in_frames, times


@dataclass(frozen=True, slots=True, order=True)
class SetsOff(Fact):
    """The tick at which a held object sets off on the motion that has this first frame."""

    predicate = "sets_off"
    ee: str
    object: str
    first: int
    tick: int


@dataclass(frozen=True, slots=True, order=True)
class Settles(Fact):
    """The tick at which it settles after the motion that has this last frame."""

    predicate = "settles"
    ee: str
    object: str
    last: int
    tick: int


@dataclass(frozen=True, slots=True)
class Edge:
    """A frame at which a motion begins or ends, and the frame by the hand instead."""

    kind: type[SetsOff] | type[Settles]
    object: str
    frame: int
    refined: int


def edges(
    own: Sequence[Touching], moving: Iterable[Moving], pauses: Sequence[int], *, rate_hz: float
) -> tuple[Edge, ...]:
    """The edges of every motion that lie within a contact of the end-effector with the object.

    Args:
        own: The end-effector's contacts, in order of time.
        moving: Motions of what it touches.
        pauses: Frames at which it is slow, ascending.
        rate_hz: Frames a second [Hz].
    """
    reach = round(in_frames(times().refining_ms, rate_hz))
    contacts: dict[str, list[Touching]] = {}
    for each in own:
        contacts.setdefault(each.other, []).append(each)
    found = []
    for motion in moving:
        held = contacts.get(motion.object, [])
        start, stop = _around(held, motion.first), _around(held, motion.last)
        if start:
            last = bisect_right(pauses, motion.first) - 1
            near = last >= 0 and pauses[last] >= max(motion.first - reach, start.first)
            frame = pauses[last] if near else motion.first
            found.append(Edge(SetsOff, motion.object, motion.first, frame))
        if stop:
            first = bisect_left(pauses, motion.last)
            near = first < len(pauses) and pauses[first] <= min(motion.last + reach, stop.last)
            frame = pauses[first] if near else motion.last
            found.append(Edge(Settles, motion.object, motion.last, frame))
    return tuple(found)


def _around(contacts: Sequence[Touching], frame: int) -> Touching | None:
    """The contact that a frame lies in."""
    index = bisect_right(contacts, frame, key=lambda each: each.first) - 1
    return contacts[index] if index >= 0 and contacts[index].last >= frame else None
