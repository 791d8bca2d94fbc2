"""Facts of one window after the other, put together as those of one recording."""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace
from functools import cache
from inspect import get_annotations
from typing import Any, cast

from capar.model.facts import (
    DrawsBack,
    Fact,
    Moving,
    Observed,
    Phase,
    ReleaseSpeed,
    Reverses,
    Rides,
    Span,
)

Key = tuple[object, ...]
"""What an interval is of: its kind and its bodies, whenever it is."""

AT_THE_END = (ReleaseSpeed, Rides)
"""Kinds that name a contact by its first frame and are measured up to its end."""

OF_A_MOTION = (Reverses, DrawsBack, Phase)
"""Kinds that are sought within a motion as a whole: that a thing has come down tells where it was
highest. They are settled with the motion."""

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
        self._told: set[tuple[Key, int]] = set()
        """The instants that were settled since the earliest motion began that goes on."""

    def begin_of(self, kinds: tuple[type[Observed], ...]) -> int | None:
        """The first frame of the intervals of some kinds that go on; None without any."""
        return min((own.first for key, own in self._open.items() if key[0] in kinds), default=None)

    def stitched(self, facts: Iterable[Fact], begin: int) -> list[Observed]:
        """Facts of a window in frames of the recording, with intervals from their beginning.

        Facts that are settled are left out, and so are those that hold always.

        Args:
            facts: Facts of the window, in its own frames.
            begin: The frame of the recording with which the window begins.
        """
        observed = [fact for fact in facts if isinstance(fact, Observed)]
        of_motions = (_moved(fact, begin) for fact in observed if isinstance(fact, OF_A_MOTION))
        late = {fact.ends()[0] for fact in of_motions if self._is_late(fact)}
        # Most facts are of single frames, and most of them are settled.
        seen = [
            _moved(fact, begin)
            for fact in observed
            if fact.declaration.span is not Span.INSTANT
            or (at := fact.ends()[0] + begin) > self.frontier
            or (at in late and (_key(fact), at) not in self._told)
        ]
        firsts = self._firsts(seen)
        own = {(_key(fact), fact.ends()[0]) for fact in seen if _is_interval(fact)}
        continued = {place for place in own if firsts.get(place, place[1]) != place[1]}
        ended = {(_key(fact), fact.ends()[0]) for fact in seen if self._has_ended(fact)}
        out: list[Observed] = []
        for fact in seen:
            span = fact.declaration.span
            if span is Span.INSTANT:
                out.append(fact)
            elif span is Span.INTERVAL and (not self._has_ended(fact) or self._is_late(fact)):
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
        moves = {
            fact.object: fact.first
            for fact in stitched
            if isinstance(fact, Moving) and fact.first <= frontier < fact.last
        }
        for fact in stitched:
            span, ends = fact.declaration.span, fact.ends()
            if isinstance(fact, OF_A_MOTION) and ends[0] >= moves.get(fact.object, frontier + 1):
                continue
            if span is Span.INSTANT and ends[0] <= frontier:
                done.append(fact)
                self._told.add((_key(fact), ends[0]))
            elif span is Span.INTERVAL:
                place = (_key(fact), ends[0])
                if ends[-1] <= frontier:
                    done.append(fact)
                    done += named.get(place, ())
                    ended.add(place)
                elif ends[0] <= frontier:
                    going[place[0]] = _Open(ends[0], tuple(named.get(place, ())))
        self._open, self.frontier = going, frontier
        oldest = min(moves.values(), default=frontier + 1)
        self._told = {told for told in self._told if told[1] >= oldest}
        return done

    def _firsts(self, seen: Iterable[Observed]) -> dict[tuple[Key, int], int]:
        """The true first frames of intervals that were going on at the frontier."""
        out: dict[tuple[Key, int], int] = {}
        for fact in seen:
            known = self._continued(fact)
            if known is not None:
                out[_key(fact), fact.ends()[0]] = known.first
        return out

    def _continued(self, fact: Observed) -> _Open | None:
        """The interval that went on at the frontier and that a fact tells of; None without one.

        Its end may be told a frame sooner than before, and so be at the frontier or before it.
        """
        if not _is_interval(fact) or fact.ends()[0] > self.frontier:
            return None
        known = self._open.get(_key(fact))
        return known if known is not None and fact.ends()[-1] >= known.first else None

    def _is_late(self, fact: Observed) -> bool:
        """Whether it is of a motion that goes on, and is not settled though its frames are."""
        if not isinstance(fact, OF_A_MOTION) or fact.ends()[-1] > self.frontier:
            return False
        motion = self._open.get((Moving, fact.object))
        return motion is not None and fact.ends()[0] >= motion.first

    def _has_ended(self, fact: Observed) -> bool:
        """Whether it is an interval that was settled before."""
        ended = _is_interval(fact) and fact.ends()[-1] <= self.frontier
        return ended and self._continued(fact) is None


def _is_interval(fact: Observed) -> bool:
    return fact.declaration.span is Span.INTERVAL


def _key(fact: Observed) -> Key:
    """The kind of an interval and its bodies: what it measures besides is no part of it."""
    bodies, _ = _layout(cast(Any, type(fact)))
    return type(fact), *(getattr(fact, name) for name in bodies)


@cache
def _layout(kind: type[Observed]) -> tuple[tuple[str, ...], tuple[str, ...]]:
    """The fields of a kind of fact that hold text, and those that hold frames."""
    known = get_annotations(kind)
    frames = () if kind.declaration.span is Span.ALWAYS else FRAMES
    texts = tuple(name for name, of in known.items() if of is str)
    return texts, tuple(name for name in known if name in frames)


def _key_of_named(fact: Observed) -> Key:
    """The key of the interval that a fact names."""
    kind, *values = fact.name(cast(Any, fact.declaration.span))
    return kind, *(each for each in values if isinstance(each, str))


def _moved(fact: Observed, by: int) -> Observed:
    _, frames = _layout(cast(Any, type(fact)))
    if not by or not frames:
        return fact
    changed = {name: getattr(fact, name) + by for name in frames}
    return cast(Observed, replace(cast(Any, fact), **changed))


def _begun(fact: Observed, first: int | None) -> Observed:
    return fact if first is None else cast(Observed, replace(cast(Any, fact), first=first))
