"""True start and end of a held object's motion, and of its contact with what bears it, as ticks.

An object counts as moving once it is away from its place by a floor that noise cannot reach, and
as touching another one within a tolerance: those tell that something happened. When it happened
is measured more finely, and that is where the ticks stand.
"""

from bisect import bisect_left, bisect_right
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, replace

from capar.model.facts import Displaced, Fact, Moving, Seated, Touching


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


@dataclass(frozen=True, slots=True, order=True)
class Lands(Fact):
    """The tick at which a body truly comes to touch another one, in the contact since a frame."""

    predicate = "lands"
    ee: str
    body: str
    other: str
    since: int
    tick: int


@dataclass(frozen=True, slots=True, order=True)
class Leaves(Fact):
    """The tick at which it truly leaves it."""

    predicate = "leaves"
    ee: str
    body: str
    other: str
    since: int
    tick: int


@dataclass(frozen=True, slots=True)
class Edge:
    """A frame at which a motion begins or ends by its floor, and when it truly does."""

    kind: type[SetsOff] | type[Settles]
    object: str
    frame: int
    refined: int


def edges(
    own: Sequence[Touching],
    moving: Iterable[Moving],
    displaced: Iterable[Displaced],
) -> tuple[Edge, ...]:
    """The edges of every motion that lie within a contact of the end-effector with the object.

    Args:
        own: The end-effector's contacts, in order of time.
        moving: Motions of what it touches.
        displaced: When those truly began and ended.
    """
    contacts: dict[str, list[Touching]] = {}
    for contact in own:
        contacts.setdefault(contact.other, []).append(contact)
    true: dict[str, list[Displaced]] = {}
    for edge in displaced:
        true.setdefault(edge.object, []).append(edge)
    found = []
    for motion in moving:
        held = contacts.get(motion.object, [])
        start, stop = _around(held, motion.first), _around(held, motion.last)
        within = [edge for edge in true.get(motion.object, ()) if _meet(edge, motion)]
        if start:
            frame = min((edge.first for edge in within), default=motion.first)
            frame = max(min(frame, motion.first), start.first)
            found.append(Edge(SetsOff, motion.object, motion.first, frame))
        if stop:
            frame = max((edge.last for edge in within), default=motion.last)
            frame = min(max(frame, motion.last), stop.last)
            found.append(Edge(Settles, motion.object, motion.last, frame))
    return tuple(found)


def _meet(one: Displaced, other: Moving) -> bool:
    return one.first <= other.last and other.first <= one.last


def _around(contacts: Sequence[Touching], frame: int) -> Touching | None:
    """The contact that a frame lies in."""
    index = bisect_right(contacts, frame, key=lambda each: each.first) - 1
    return contacts[index] if index >= 0 and contacts[index].last >= frame else None


Seats = dict[tuple[str, str], list[Seated]]
"""When bodies are down on others, in time, by the two."""


def by_pair(facts: Iterable[Fact]) -> Seats:
    """When bodies are down on others, by the two."""
    out: Seats = {}
    for fact in facts:
        if isinstance(fact, Seated):
            out.setdefault((fact.body, fact.other), []).append(fact)
    return {pair: sorted(seats, key=lambda each: each.first) for pair, seats in out.items()}


def true_ends(contact: Touching, seats: Seats) -> tuple[int, int]:
    """The frames at which a body truly comes down on another one and leaves it.

    Where nothing says so, the first and the last frame of their contact.
    """
    own = [
        each
        for each in seats.get((contact.body, contact.other), ())
        if contact.first <= each.first and each.last <= contact.last
    ]
    return (own[0].first, own[-1].last) if own else (contact.first, contact.last)


def as_borne(contact: Touching, seats: Seats) -> Touching:
    """An end-effector's contact, from when a thing truly comes down on it until it leaves it.

    The contact itself where the end-effector does not bear the thing.
    """
    first, last = true_ends(replace(contact, body=contact.other, other=contact.body), seats)
    return replace(contact, first=first, last=last)


def landings(
    ee: str,
    ticks: Sequence[int],
    own: Iterable[Touching],
    others: Iterable[Touching],
    seats: Seats,
) -> Iterator[Fact]:
    """When what the end-effector handles, or itself, truly begins and ceases to touch what.

    Args:
        ee: The end-effector.
        ticks: Frames of its link's ticks, ascending; the true ends are among them.
        own: Its own contacts.
        others: Contacts of what it handles.
        seats: When bodies are down on others.
    """
    for contact in own:
        borne = as_borne(contact, seats)
        yield Lands(ee, ee, contact.other, contact.first, bisect_left(ticks, borne.first))
        yield Leaves(ee, ee, contact.other, contact.first, bisect_left(ticks, borne.last))
    for contact in others:
        first, last = true_ends(contact, seats)
        yield Lands(ee, contact.body, contact.other, contact.first, bisect_left(ticks, first))
        yield Leaves(ee, contact.body, contact.other, contact.first, bisect_left(ticks, last))
