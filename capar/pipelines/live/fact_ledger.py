"""Facts of one window after the other, put together as those of one recording."""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, fields, replace
from typing import Any, cast

from capar.model.declarations import Span
from capar.model.facts import Fact, Observed, ReleaseSpeed, Rides

Key = tuple[object, ...]
"""What an interval is of: its kind and its bodies, whenever it is."""

AT_THE_END = (ReleaseSpeed, Rides)
"""Kinds that name a contact by its first frame and are measured up to its end."""

FRAMES = ("frame", "first", "last")


@dataclass(frozen=True, slots=True)
class _Open:
    """An interval that goes on beyond the frontier."""

    first: int
    named: tuple[Observed, ...]
    """Facts that name it, as they were measured when its beginning was in the window."""


class FactLedger:
    """What is settled up to a frame, the frontier, and the intervals that go on there.

    A later window may begin within an interval: it is then continued by its true beginning.
    """

    def __init__(self) -> None:
        self.frontier = -1
        self._open: dict[Key, _Open] = {}

    def stitched(self, facts: Iterable[Fact], begin: int) -> list[Observed]:
        """Facts of a window in frames of the recording, with intervals from their beginning.

        Facts that are settled are left out, and so are those that hold always.

        Args:
            facts: Facts of the window, in its own frames.
            begin: The frame of the recording with which the window begins.
        """
        seen = [
            _moved(fact, begin)
            for fact in facts
            if isinstance(fact, Observed)
            and not (
                fact.declaration.span is Span.INSTANT and begin + fact.ends()[0] <= self.frontier
            )
        ]
        firsts = self._firsts(seen)
        own = {(_key(fact), fact.ends()[0]) for fact in seen if _is_interval(fact)}
        continued = {place for place in own if firsts.get(place, place[1]) != place[1]}
        ended = {(_key(fact), fact.ends()[0]) for fact in seen if self._has_ended(fact)}
        out: list[Observed] = []
        for fact in seen:
            span = fact.declaration.span
            if span is Span.INSTANT and fact.ends()[0] > self.frontier:
                out.append(fact)
            elif span is Span.INTERVAL and not self._has_ended(fact):
                out.append(_begun(fact, firsts.get((_key(fact), fact.ends()[0]))))
            elif not isinstance(span, Span):
                place = (_key_of_named(fact), fact.ends()[0])
                if place in ended or (place in continued and not isinstance(fact, AT_THE_END)):
                    continue
                out.append(_begun(fact, firsts.get(place)))
        for key, _ in continued:
            out += [each for each in self._open[key].named if not isinstance(each, AT_THE_END)]
        return list(dict.fromkeys(out))

    def settle(self, stitched: Sequence[Observed], frontier: int) -> list[Observed]:
        """Move the frontier; what ends no later is settled, and returned.

        Args:
            stitched: What ``stitched`` gave.
            frontier: The last frame that no later frame can change.
        """
        done: list[Observed] = []
        going: dict[Key, _Open] = {}
        ended: set[tuple[Key, int]] = set()
        named: dict[tuple[Key, int], list[Observed]] = {}
        for fact in stitched:
            if not isinstance(fact.declaration.span, Span):
                named.setdefault((_key_of_named(fact), fact.ends()[0]), []).append(fact)
        for fact in stitched:
            span, ends = fact.declaration.span, fact.ends()
            if span is Span.INSTANT and ends[0] <= frontier:
                done.append(fact)
            elif span is Span.INTERVAL:
                place = (_key(fact), ends[0])
                if ends[-1] <= frontier:
                    done.append(fact)
                    done += named.get(place, ())
                    ended.add(place)
                elif ends[0] <= frontier:
                    going[place[0]] = _Open(ends[0], tuple(named.get(place, ())))
        self._open, self.frontier = going, frontier
        return done

    def _firsts(self, seen: Iterable[Observed]) -> dict[tuple[Key, int], int]:
        """The true first frames of intervals that were going on at the frontier."""
        out: dict[tuple[Key, int], int] = {}
        for fact in seen:
            if _is_interval(fact) and fact.ends()[0] <= self.frontier <= fact.ends()[-1]:
                known = self._open.get(_key(fact))
                if known is not None:
                    out[_key(fact), fact.ends()[0]] = known.first
        return out

    def _has_ended(self, fact: Observed) -> bool:
        return _is_interval(fact) and fact.ends()[-1] <= self.frontier


def _is_interval(fact: Observed) -> bool:
    return fact.declaration.span is Span.INTERVAL


def _key(fact: Observed) -> Key:
    """The kind of an interval and its bodies: what it measures besides is no part of it."""
    values = (getattr(fact, each.name) for each in fields(cast(Any, fact)))
    return type(fact), *(each for each in values if isinstance(each, str))


def _key_of_named(fact: Observed) -> Key:
    """The key of the interval that a fact names."""
    kind, *values = fact.name(cast(Any, fact.declaration.span))
    return kind, *(each for each in values if isinstance(each, str))


def _moved(fact: Observed, by: int) -> Observed:
    names = [each.name for each in fields(cast(Any, fact)) if each.name in FRAMES]
    if not by or not names or fact.declaration.span is Span.ALWAYS:
        return fact
    return cast(Observed, replace(cast(Any, fact), **{n: getattr(fact, n) + by for n in names}))


def _begun(fact: Observed, first: int | None) -> Observed:
    return fact if first is None else cast(Observed, replace(cast(Any, fact), first=first))
