"""Stretches and instants by a link's ticks, for what lies to what and moves in which way."""

from bisect import bisect_left, bisect_right
from collections import defaultdict
from collections.abc import Iterable, Sequence
from dataclasses import dataclass

from capar.model.facts import (
    Bears,
    Between,
    Fact,
    Flies,
    Leans,
    Lies,
    Link,
    LookingAt,
    OfAgent,
    Passage,
    Resting,
    Reverses,
    Rolls,
    Swings,
    Touching,
)

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
        acting = {fact.ee for fact in facts if isinstance(fact, Link)}
        passed = {}
        spans = {}
        for fact in facts:
            for each in _stretches(fact):
                self._by_body[each[1]].append(each)
            if isinstance(fact, Touching):
                self._touches[fact.body].add(fact.other)
            elif isinstance(fact, LookingAt):
                look = (LOOKS, fact.sensor, fact.object, fact.first, fact.last)
                self._seen[fact.object].append(look)
                if fact.sensor in acting:
                    self._by_body[fact.sensor].append(look)
            elif isinstance(fact, Lies):
                spans[fact.body, fact.how, fact.other, fact.first] = fact.last
            elif isinstance(fact, Passage):
                passed[fact.body, fact.how, fact.other, fact.first] = fact.sides
        for key, way in passed.items():
            body, how, other, first = key
            if key in spans:
                stretch = (f"{how}_{way}", body, other, first, spans[key])
                self._by_body[body].append(stretch)
        for stretches in self._by_body.values():
            stretches.sort(key=lambda each: (each[3], each))

    def frames(self, body: str) -> Iterable[tuple[int, int]]:
        """First and last frames at which rules may draw a border for this body."""
        return [
            (first, last)
            for how, _, _, first, last in self._by_body.get(body, ())
            if how in BORDERS
        ]

    def ranked(
        self, ee: str, ticks: Sequence[int], reach: dict[str, list[tuple[int, int]]]
    ) -> Iterable[Fact]:
        """The stretches of an end-effector and of what it handles, and looks of its agent.

        What is handled may be looked at long before, and so may that which it then touches.
        """
        whole = [(ticks[0], ticks[-1])]
        for body, times in {**reach, ee: whole}.items():
            for how, _, other, first, last in self._by_body.get(body, ()):
                if _meets(times, first, last):
                    yield from _ranked(ee, (how, body, other, first, last), ticks)
        concerned = {*reach, *(other for name in reach for other in self._touches.get(name, ()))}
        for name in sorted(concerned):
            for look in self._seen.get(name, ()):
                if look[1] != ee and self._agents.get(look[1]) == self._agents.get(ee):
                    yield from _ranked(ee, look, ticks)


LOOKS = "looks"
"""That a sensor looks at an object."""

BORDERS = frozenset(
    {"resting", "reverses", "swings", "leans", "flies", "bears_whole", "bears_none", LOOKS}
)
"""Stretches at whose ends there may be a border."""


def _stretches(fact: Fact) -> Iterable[Stretch]:
    if isinstance(fact, Resting):
        yield "resting", fact.ee, fact.ee, fact.first, fact.last
    elif isinstance(fact, Swings):
        yield "swings", fact.body, fact.body, fact.first, fact.last
    elif isinstance(fact, Leans):
        yield "leans", fact.object, fact.object, fact.first, fact.last
    elif isinstance(fact, Flies):
        yield "flies", fact.object, fact.object, fact.first, fact.last
    elif isinstance(fact, Rolls):
        yield "rolls", fact.object, fact.object, fact.first, fact.last
    elif isinstance(fact, Bears):
        yield f"bears_{fact.share}", fact.foot, fact.foot, fact.first, fact.last
    elif isinstance(fact, Reverses):
        yield "reverses", fact.object, fact.object, fact.frame, fact.frame
    elif isinstance(fact, Lies):
        yield fact.how, fact.body, fact.other, fact.first, fact.last
    elif isinstance(fact, Between):
        yield "between", fact.body, fact.one, fact.first, fact.last
        yield "between", fact.body, fact.other, fact.first, fact.last


def _meets(times: Sequence[tuple[int, int]], first: int, last: int) -> bool:
    """Whether one of disjoint stretches in order shares a frame with an interval."""
    index = bisect_right(times, (last, 1 << 62)) - 1
    return index >= 0 and times[index][1] >= first


def _ranked(ee: str, stretch: Stretch, ticks: Sequence[int]) -> Iterable[Fact]:
    how, body, other, first, last = stretch
    inside = bisect_left(ticks, first), bisect_right(ticks, last) - 1
    if inside[0] <= inside[1]:
        yield Spans(ee, how, body, other, *inside)
    around = bisect_right(ticks, first) - 1, min(bisect_left(ticks, last), len(ticks) - 1)
    yield Encloses(ee, how, body, other, max(around[0], 0), around[1])
