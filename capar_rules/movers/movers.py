"""Parts of motions between which nothing changes, and what holds throughout each."""

from bisect import bisect_left
from collections import defaultdict
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from itertools import pairwise

from capar.model.facts import (
    Displaced,
    Fact,
    Flies,
    Link,
    MovedBy,
    MovesWith,
    Observed,
    RateMhz,
    Resting,
    Rolls,
    Swings,
    Tag,
    Touching,
    Travels,
)
from capar_rules.engine.solver import asking, rule_file, solve

RULES = "movers/movers.lp"

STRETCHES = (Displaced, Travels, Resting, Flies, Rolls, Swings, Touching)
"""Kinds of measured intervals by which movers are told, beside ``MovesWith``."""


@dataclass(frozen=True, slots=True, order=True)
class Part(Fact):
    """Frames of some object's motion between which nothing changes, by number."""

    predicate = "part"
    number: int
    first: int
    last: int


@dataclass(frozen=True, slots=True, order=True)
class During(Fact):
    """A measured stretch holds throughout a part."""

    predicate = "during"
    part: int
    how: str
    body: str
    other: str


@dataclass(frozen=True, slots=True, order=True)
class With(Fact):
    """An object is steady in a body's frame throughout a part, so far from touching it [mm]."""

    predicate = "with"
    part: int
    object: str
    body: str
    gap: int


@asking
def movers(facts: Sequence[Fact]) -> tuple[MovedBy, ...]:
    """What moves each object, through all parts of its motion, in order of object and time.

    Raises:
        RuleError: The rules have a fault.
    """
    parts = numbered_parts(facts)
    if not parts:
        return ()
    asked: list[Fact] = [each for each in facts if isinstance(each, Link | RateMhz | Tag)]
    answer = solve((rule_file(RULES),), (*asked, *parts, *_during(facts, parts)))
    found: dict[tuple[str, str, str], list[int]] = defaultdict(list)
    for part, thing, body, how in answer.of("mover"):
        found[str(thing), str(body), str(how)].append(_int(part))
    for part, thing, body, _ in answer.of("pushed_early"):
        found[str(thing), str(body), "pushed"].append(_int(part))
    for part, thing, why in answer.of("unmoved"):
        found[str(thing), str(why), "unknown"].append(_int(part))
    return tuple(sorted(_joined(found, parts)))


def numbered_parts(facts: Iterable[Fact]) -> tuple[Part, ...]:
    """The frames in which some object moves, cut wherever any stretch begins or ends."""
    used = [each for each in facts if isinstance(each, (*STRETCHES, MovesWith))]
    moved = [each.ends() for each in used if isinstance(each, Displaced)]
    cuts = {each.ends()[0] for each in used} | {each.ends()[1] + 1 for each in used}
    out: list[Part] = []
    ordered = sorted(cuts)
    for first, after in pairwise(ordered):
        if any(begin <= first and after - 1 <= end for begin, end in moved):
            out.append(Part(len(out), first, after - 1))
    return tuple(out)


def _during(facts: Iterable[Fact], parts: Sequence[Part]) -> Iterator[Fact]:
    starts = [each.first for each in parts]
    for fact in facts:
        if not isinstance(fact, (*STRETCHES, MovesWith)):
            continue
        first, last = fact.ends()
        for part in parts[bisect_left(starts, first) :]:
            if part.first > last:
                break
            yield from _stated(fact, part.number)


def _stated(fact: Observed, part: int) -> Iterator[Fact]:
    if isinstance(fact, MovesWith):
        yield With(part, fact.object, fact.body, fact.gap)
    elif isinstance(fact, Touching):
        yield During(part, fact.predicate, fact.body, fact.other)
    else:
        yield During(part, fact.predicate, fact.subject(), fact.subject())


def _joined(
    found: dict[tuple[str, str, str], list[int]], parts: Sequence[Part]
) -> Iterator[MovedBy]:
    for (thing, body, how), numbers in found.items():
        spans: list[tuple[int, int]] = []
        for number in sorted(numbers):
            part = parts[number]
            if spans and part.first == spans[-1][1] + 1:
                spans[-1] = (spans[-1][0], part.last)
            else:
                spans.append((part.first, part.last))
        for first, last in spans:
            yield MovedBy(thing, body, how, first, last)


def _int(value: object) -> int:
    assert isinstance(value, int)
    return value
