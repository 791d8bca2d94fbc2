"""Numbered borders of segments, and which facts begin, end and hold at them."""

from bisect import bisect_left, bisect_right
from collections import defaultdict
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import accumulate
from typing import Any

from capar.model.facts import (
    Displaced,
    Fact,
    FactIntervals,
    Frames,
    Interval,
    Link,
    LookingAt,
    Moving,
    Observed,
    OfAgent,
    Pause,
    RateMhz,
    Resting,
    Seated,
    Touching,
    ZeroCrossing,
)
from capar_rules.borders.ticks import FreeBetween as FreeBetween
from capar_rules.borders.ticks import LastTick as LastTick
from capar_rules.borders.ticks import Meanwhile, Shares, Undisturbed, in_frames, times
from capar_rules.borders.ticks import MovesBetween as MovesBetween
from capar_rules.borders.ticks import MovesDuring as MovesDuring
from capar_rules.borders.ticks import Tick as Tick
from capar_rules.borders.ticks import Within as Within


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
    own: Sequence[Touching], moving: Iterable[Moving], displaced: Iterable[Displaced]
) -> tuple[Edge, ...]:
    """The edges of every motion that lie within a contact of the end-effector with the object.

    ``own``: the end-effector's contacts, in order of time. ``moving``: motions of what it touches.
    ``displaced``: when those truly began and ended.
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
        within = [
            edge
            for edge in true.get(motion.object, ())
            if edge.first <= motion.last and motion.first <= edge.last
        ]
        if start:
            frame = min((edge.first for edge in within), default=motion.first)
            frame = max(min(frame, motion.first), start.first)
            found.append(Edge(SetsOff, motion.object, motion.first, frame))
        if stop:
            frame = max((edge.last for edge in within), default=motion.last)
            frame = min(max(frame, motion.last), stop.last)
            found.append(Edge(Settles, motion.object, motion.last, frame))
    return tuple(found)


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
    ee: str, ticks: Sequence[int], own: Iterable[Touching], others: Iterable[Touching], seats: Seats
) -> Iterator[Fact]:
    """When what the end-effector handles, or itself, truly begins and ceases to touch what.

    ``ticks``: frames of its link's ticks, ascending; the true ends are among them. ``own``: its own
    contacts. ``others``: contacts of what it handles. ``seats``: when bodies are down on others.
    """
    for contact in own:
        borne = as_borne(contact, seats)
        yield Lands(ee, ee, contact.other, contact.first, bisect_left(ticks, borne.first))
        yield Leaves(ee, ee, contact.other, contact.first, bisect_left(ticks, borne.last))
    for contact in others:
        first, last = true_ends(contact, seats)
        yield Lands(ee, contact.body, contact.other, contact.first, bisect_left(ticks, first))
        yield Leaves(ee, contact.body, contact.other, contact.first, bisect_left(ticks, last))


Contacts = Mapping[str, Sequence[Touching]]
"""Contacts of one end-effector by what it touches, each in order of time and disjoint."""


def by_object(touching: Iterable[Touching]) -> dict[str, list[Touching]]:
    """Contacts of one end-effector, in order of time, by what it touches."""
    out: dict[str, list[Touching]] = {}
    for touch in touching:
        out.setdefault(touch.other, []).append(touch)
    return out


def overlapping(
    own: Iterable[Touching], others: Sequence[Contacts]
) -> list[tuple[Touching, Touching]]:
    """Each contact of an end-effector with those of others that share a frame and the object."""
    found = []
    for touch in own:
        for contacts in (each.get(touch.other, ()) for each in others):
            first = bisect_left(contacts, touch.first, key=lambda each: each.last)
            last = bisect_right(contacts, touch.last, key=lambda each: each.first)
            found += [(touch, each) for each in contacts[first:last]]
    return found


def shared(
    ee: str, ticks: Sequence[int], pairs: Iterable[tuple[Touching, Touching]], *, rate_hz: float
) -> Iterator[Fact]:
    """Which contact of another end-effector came before or goes on after one's own, and when.

    ``ticks``: frames of its link's ticks, ascending. ``pairs``: its own contacts, each with one of
    another end-effector.
    """
    margin = in_frames(times().merge_ms, rate_hz)
    for touch, each in pairs:
        begins, ends = each.first - touch.first, each.last - touch.last
        if begins < -margin and ends < -margin:
            yield Shares(ee, touch.other, touch.first, each.body, "before")
        if begins > margin and ends > margin:
            yield Shares(ee, touch.other, touch.first, each.body, "after")
        latest = len(ticks) - 2
        if begins >= 0:
            tick = min(bisect_right(ticks, each.first) - 1, latest)
            yield Meanwhile(ee, tick, "begins", each.body, touch.other, each.first)
        if ends <= 0:
            tick = max(bisect_left(ticks, each.last) - 1, 0)
            yield Meanwhile(ee, tick, "ends", each.body, touch.other, each.first)


Stretch = tuple[str, str, str, int, int]
"""What it is, the body, the other body (or the same), first and last frame."""


@dataclass(frozen=True, slots=True, order=True)
class Spans(Fact):
    """The ticks of a link that lie inside a stretch."""

    predicate = "spans"
    ee: str
    how: str
    body: str
    other: str
    first: int
    last: int


@dataclass(frozen=True, slots=True, order=True)
class Encloses(Fact):
    """The last tick of a link before a stretch, and the first one after it, or at its ends."""

    predicate = "encloses"
    ee: str
    how: str
    body: str
    other: str
    first: int
    last: int


class Stretches:
    """Every stretch by the body that it is about, in order of time; looks also by what is seen."""

    def __init__(self, facts: Sequence[Fact]) -> None:
        self._by_body: dict[str, list[Stretch]] = defaultdict(list)
        self._seen: dict[str, list[Stretch]] = defaultdict(list)
        self._touches: dict[str, set[str]] = defaultdict(set)
        self._agents = {fact.body: fact.agent for fact in facts if isinstance(fact, OfAgent)}
        self.borders: dict[str, list[Interval]] = defaultdict(list)
        """First and last frames at which rules may draw a border, by body."""

        acting = {fact.ee for fact in facts if isinstance(fact, Link)}
        intervals = FactIntervals(facts)
        for fact in facts:
            if isinstance(fact, Touching):
                self._touches[fact.body].add(fact.other)
            for stretch in _stretches(fact, intervals):
                if isinstance(fact, LookingAt):
                    self._seen[fact.object].append(stretch)
                    if fact.sensor not in acting:
                        continue
                _, body, _, first, last = stretch
                self._by_body[body].append(stretch)
                if isinstance(fact, Observed) and fact.is_border():
                    self.borders[body].append((first, last))
        for stretches in self._by_body.values():
            stretches.sort(key=lambda each: (each[3], each))

    def numbered(
        self, ee: str, ticks: Sequence[int], reach: dict[str, list[tuple[int, int]]]
    ) -> Iterable[Fact]:
        """The stretches of an end-effector and of what it handles, and looks of its agent.

        What is handled may be looked at long before, and so may that which it then touches.
        """
        whole = [(ticks[0], ticks[-1])]
        for body, spans in {**reach, ee: whole}.items():
            for how, _, other, first, last in self._by_body.get(body, ()):
                if _overlap(spans, first, last):
                    yield from _ranked(ee, (how, body, other, first, last), ticks)
        concerned = {*reach, *(other for name in reach for other in self._touches.get(name, ()))}
        for name in sorted(concerned):
            for look in self._seen.get(name, ()):
                if look[1] != ee and self._agents.get(look[1]) == self._agents.get(ee):
                    yield from _ranked(ee, look, ticks)


def _stretches(fact: Fact, intervals: FactIntervals) -> Iterable[Stretch]:
    """The stretches that a fact states, as it declares."""
    if not isinstance(fact, Observed) or not fact.declaration.stretch:
        return
    interval = intervals.of(fact)
    if interval is not None:
        for other in fact.other_bodies():
            yield fact.stretch(), fact.subject(), other, *interval


def _ranked(ee: str, stretch: Stretch, ticks: Sequence[int]) -> Iterable[Fact]:
    how, body, other, first, last = stretch
    inside = bisect_left(ticks, first), bisect_right(ticks, last) - 1
    if inside[0] <= inside[1]:
        yield Spans(ee, how, body, other, *inside)
    around = bisect_right(ticks, first) - 1, min(bisect_left(ticks, last), len(ticks) - 1)
    yield Encloses(ee, how, body, other, max(around[0], 0), around[1])


def undisturbed(
    ee: str, ticks: Sequence[int], rests: Iterable[Resting], own: Sequence[Touching]
) -> Iterator[Undisturbed]:
    """The rests of an end-effector in which no contact of its own has a tick, or none any more.

    Of a rest in which it is relieved of all that it touches, what follows from there on counts: a
    palm from which the last thing is taken rests on. Each costs two searches, however many ticks or
    contacts it holds.

    ``ticks``: the frames of its link's ticks, in order. ``own``: its contacts, by their first
    frames.
    """
    begins = [each.first for each in own]
    latest = list(accumulate((each.last for each in own), max))
    for rest in rests:
        first, last = bisect_left(ticks, rest.first), bisect_right(ticks, rest.last) - 1
        if first > last:
            continue
        before = bisect_right(begins, ticks[last])
        if before == 0 or latest[before - 1] < ticks[first]:
            yield Undisturbed(ee, first, last)
        elif ticks[first] < latest[before - 1] < ticks[last]:
            yield Undisturbed(ee, bisect_left(ticks, latest[before - 1]), last)


def number_borders(facts: Sequence[Fact], *, crossings_only: bool) -> tuple[Fact, ...]:
    """The facts that number the borders of every link.

    ``crossings_only``: whether ticks are the zero crossings, as in the thesis, or else the first
    and last frames of every contact and motion that concerns the link.
    """
    scene = _Scene(facts)
    numbered = (
        fact for link in scene.links for fact in _number_link(scene, link.ee, crossings_only)
    )
    return tuple(sorted(numbered, key=lambda each: (type(each).predicate, each)))


class _Scene:
    """The measurements by what they are about, in order of time."""

    def __init__(self, facts: Sequence[Fact]) -> None:
        self.stretches = Stretches(facts)
        self.seats = by_pair(facts)
        self.touching: dict[str, list[Touching]] = defaultdict(list)
        self.moving: dict[str, list[Moving]] = defaultdict(list)
        self.crossings: dict[str, list[int]] = defaultdict(list)
        self.pauses: dict[str, list[int]] = defaultdict(list)
        self.rests: dict[str, list[Resting]] = defaultdict(list)
        kinds: dict[type, list[Any]] = defaultdict(list)
        for fact in facts:
            kinds[type(fact)].append(fact)
        self.links: list[Link] = kinds[Link]
        self.displaced: list[Displaced] = kinds[Displaced]
        self.frames: Frames = next(iter(kinds[Frames]), Frames(0, 0))
        self.rate = next((each.rate / 1000.0 for each in kinds[RateMhz]), 0.0)
        for touch in kinds[Touching]:
            self.touching[touch.body].append(touch)
        for move in kinds[Moving]:
            self.moving[move.object].append(move)
        for crossing in kinds[ZeroCrossing]:
            self.crossings[crossing.ee].append(crossing.frame)
        for pause in kinds[Pause]:
            self.pauses[pause.ee].append(pause.frame)
        for rest in kinds[Resting]:
            self.rests[rest.ee].append(rest)
        for touches in self.touching.values():
            touches.sort(key=lambda each: each.first)
        self.by_object = {link.ee: by_object(self.touching[link.ee]) for link in self.links}
        for moves in self.moving.values():
            moves.sort(key=lambda each: each.first)
        for frames in (*self.crossings.values(), *self.pauses.values()):
            frames.sort()


def _number_link(scene: _Scene, ee: str, crossings_only: bool) -> Iterable[Fact]:
    own = scene.touching[ee]
    reach = _reach(own, round(in_frames(times().margin_ms, scene.rate)))
    others = [
        each
        for name in reach
        for each in scene.touching[name]
        if each.other != ee and _overlap(reach[name], each.first, each.last)
    ]
    moves = {
        name: [each for each in scene.moving[name] if _overlap(reach[name], each.first, each.last)]
        for name in reach
    }
    moves |= {each.other: scene.moving[each.other] for each in others if each.other not in moves}
    crossings = scene.crossings[ee]
    refined: tuple[Edge, ...] = ()
    borne: list[Touching] = []
    if crossings_only:
        frames = set(crossings)
    else:
        held = (each for name in reach for each in moves[name])
        refined = edges(own, held, scene.displaced)
        frames = {frame for each in (*own, *others) for frame in (each.first, each.last)}
        frames |= {frame for name in reach for each in moves[name] for frame in _ends(each)}
        frames |= {each.refined for each in refined}
        frames |= {frame for each in others for frame in true_ends(each, scene.seats)}
        before, after = scene.frames.first - 1, scene.frames.last + 1
        borne = sorted((as_borne(each, scene.seats) for each in own), key=_ends)
        frames |= {frame for each in borne for frame in _ends(each)}
        frames |= {
            pause
            for gap in _free([(before, before), *map(_ends, own), (after, after)])
            for pause in scene.pauses[ee][
                bisect_right(scene.pauses[ee], gap[0]) : bisect_left(scene.pauses[ee], gap[1])
            ]
        }
        frames |= {frame for ends in scene.stretches.borders[ee] for frame in ends}
        frames |= {
            frame
            for name in reach
            for ends in scene.stretches.borders[name]
            if _overlap(reach[name], *ends)
            for frame in ends
        }
    first, last = scene.frames.first, scene.frames.last
    ticks = sorted({first, last} | {frame for frame in frames if first < frame < last})
    yield from (Tick(ee, index, frame) for index, frame in enumerate(ticks))
    yield LastTick(ee, len(ticks) - 1)
    yield from _within(ee, ticks, own, others)
    yield from _moves(ee, ticks, moves)
    yield from (
        each.kind(ee, each.object, each.frame, bisect_left(ticks, each.refined)) for each in refined
    )
    yield from (
        FreeBetween(ee, bisect_left(ticks, gap[0]), bisect_left(ticks, gap[1]))
        for gap in (() if crossings_only else _free(map(_ends, own)))
    )
    yield from (
        MovesDuring(ee, each.other, each.first)
        for each in own
        if _overlap(
            [(each.first, each.last) for each in scene.moving[each.other]], each.first, each.last
        )
    )
    if not crossings_only:
        yield from landings(ee, ticks, own, others, scene.seats)
        yield from scene.stretches.numbered(ee, ticks, reach)
        yield from undisturbed(ee, ticks, scene.rests[ee], borne)
        others_too = [scene.by_object[link.ee] for link in scene.links if link.ee != ee]
        pairs = overlapping(own, others_too)
        yield from shared(ee, ticks, pairs, rate_hz=scene.rate)
        yield from _within(ee, ticks, (), sorted({each for _, each in pairs}))


def _reach(own: Iterable[Touching], margin: int) -> dict[str, list[tuple[int, int]]]:
    """For each object that the end-effector touches, when: disjoint intervals, a little wider."""
    reach: dict[str, list[tuple[int, int]]] = {}
    for contact in own:
        spans = reach.setdefault(contact.other, [])
        first, last = contact.first - margin, contact.last + margin
        if spans and first <= spans[-1][1]:
            spans[-1] = (spans[-1][0], max(last, spans[-1][1]))
        else:
            spans.append((first, last))
    return dict(sorted(reach.items()))


def _free(contacts: Iterable[tuple[int, int]]) -> list[tuple[int, int]]:
    """Last and first frames of neighbouring contacts, whatever is touched, with none between."""
    gaps: list[tuple[int, int]] = []
    last = None
    for first, end in contacts:
        if last is not None and first > last + 1:
            gaps.append((last, first))
        last = end if last is None else max(last, end)
    return gaps


def _overlap(spans: Sequence[tuple[int, int]], first: int, last: int) -> bool:
    """Whether disjoint, sorted spans share a frame with an interval."""
    index = bisect_right(spans, (last, 1 << 62)) - 1
    return index >= 0 and spans[index][1] >= first


def _ends(fact: Moving | Touching) -> tuple[int, int]:
    return fact.first, fact.last


def _within(
    ee: str, ticks: list[int], own: Iterable[Touching], others: Iterable[Touching]
) -> Iterable[Fact]:
    for contact in (*own, *others):
        first, last = bisect_left(ticks, contact.first), bisect_right(ticks, contact.last) - 1
        if first <= last:
            yield Within(ee, contact.body, contact.other, contact.first, first, last)


def _moves(ee: str, ticks: list[int], moves: dict[str, list[Moving]]) -> Iterable[Fact]:
    found = {
        (name, gap)
        for name, group in moves.items()
        for each in group
        for gap in range(bisect_right(ticks, each.first) - 1, bisect_left(ticks, each.last))
        if 0 <= gap < len(ticks) - 1
    }
    return (MovesBetween(ee, name, gap) for name, gap in sorted(found))
