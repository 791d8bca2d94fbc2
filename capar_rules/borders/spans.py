"""Stretches and instants by a link's ticks, for what lies to what and moves in which way."""

from bisect import bisect_left, bisect_right
from collections import defaultdict
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from typing import cast

from capar.model.facts import (
    Fact,
    FactIntervals,
    Interval,
    Link,
    LookingAt,
    Observed,
    OfAgent,
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
        self._borders: dict[str, list[Interval]] = defaultdict(list)
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
                self._add(stretch, border=cast(Observed, fact).is_border())
        for stretches in self._by_body.values():
            stretches.sort(key=lambda each: (each[3], each))

    def _add(self, stretch: Stretch, *, border: bool) -> None:
        _, body, _, first, last = stretch
        self._by_body[body].append(stretch)
        if border:
            self._borders[body].append((first, last))

    def frames(self, body: str) -> Iterable[tuple[int, int]]:
        """First and last frames at which rules may draw a border for this body."""
        return self._borders.get(body, ())

    def numbered(
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


def _stretches(fact: Fact, intervals: FactIntervals) -> Iterable[Stretch]:
    """The stretches that a fact states, as it declares."""
    if not isinstance(fact, Observed) or not fact.declaration.stretch:
        return
    interval = intervals.of(fact)
    if interval is not None:
        for other in fact.other_bodies():
            yield fact.stretch(), fact.subject(), other, *interval


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
