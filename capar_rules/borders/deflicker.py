"""Contact, motion and rest without flicker, and the stretches that were corrected."""

from collections import defaultdict
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass

from capar.model.facts import (
    ALL_FACT_KINDS,
    Fact,
    FlickerCorrection,
    Frames,
    Link,
    Observed,
    RateMhz,
    Tag,
)
from capar_rules.engine.solver import asking, best, rule_file

Key = tuple[str, str, str]
"""A relation: touching, moving or resting, the body, and the other body, or the same."""

NEGATED = {kind.predicate: kind.declaration.negated for kind in ALL_FACT_KINDS}
"""What an interval that is contradicted is taken for, by predicate; empty where none can be."""


@dataclass(frozen=True, slots=True, order=True)
class Relation(Fact):
    """A contact, a motion or a rest, by its number."""

    predicate = "relation"
    number: int
    how: str
    body: str
    other: str


@dataclass(frozen=True, slots=True, order=True)
class Stretch(Fact):
    """A time between two changes of a relation, throughout which it holds, 1, or does not, 0."""

    predicate = "stretch"
    number: int
    place: int
    holds: int
    first: int
    last: int


@asking
def steady(facts: Sequence[Fact]) -> tuple[Fact, ...]:
    """The facts, with contact, motion and rest that change as seldom as measurements allow.

    The corrections are stated beside them, so that the measurements can be restored.

    Raises:
        RuleError: The rules have a fault.
    """
    measured = _relations(facts)
    ends = next((each for each in facts if isinstance(each, Frames)), Frames(0, 0))
    stretches = {key: tuple(_stretches(spans, ends)) for key, spans in measured.items()}
    keys = sorted(key for key, between in stretches.items() if len(between) > 2)
    twins = {key for key in keys if stretches.get(_swapped(key)) == stretches[key]}
    once = [(key, stretches[key]) for key in keys if key not in twins or key[1] <= key[2]]
    doubted = _doubted(facts, once)
    if not doubted:
        return tuple(facts)
    doubted |= {_swapped(key): places for key, places in doubted.items() if key in twins}
    corrected = {key: _corrected(stretches[key], places) for key, places in doubted.items()}
    corrections = (
        FlickerCorrection(*key[1:], stretch[1], stretch[2], _taken(key[0], stretch[0]))
        for key, places in doubted.items()
        for stretch in (stretches[key][place] for place in places)
    )
    return (*_restated(facts, corrected), *sorted(corrections))


Span = tuple[int, int, int]
"""Whether the relation holds, first and last frame."""


def _relations(facts: Iterable[Fact]) -> dict[Key, list[tuple[int, int]]]:
    """The intervals of every relation, in order of time."""
    found: dict[Key, list[tuple[int, int]]] = defaultdict(list)
    for fact in facts:
        key = relation_of(fact)
        if key and isinstance(fact, Observed):
            first, last = fact.ends()
            found[key].append((first, last))
    return {key: sorted(spans) for key, spans in found.items()}


def relation_of(fact: Fact) -> Key | None:
    """The relation of which a fact states an interval, where flicker of it is resolved."""
    if not isinstance(fact, Observed) or not fact.declaration.negated:
        return None
    return fact.predicate, fact.subject(), fact.other_bodies()[0]


def _taken(how: str, holds: int) -> str:
    """What a corrected stretch is taken for, by whether the relation was measured to hold."""
    return NEGATED[how] if holds else how


def _swapped(key: Key) -> Key:
    """The same relation from the other body: contacts of two mobile objects are stated twice."""
    how, body, other = key
    return how, other, body


def _stretches(spans: Iterable[tuple[int, int]], ends: Frames) -> Iterator[Span]:
    """The stretches in which a relation holds and does not, in turn, from the first frame on."""
    free = ends.first
    for first, last in spans:
        if first > free:
            yield 0, free, first - 1
        yield 1, first, last
        free = last + 1
    if free <= ends.last:
        yield 0, free, ends.last


def _doubted(
    facts: Iterable[Fact], relations: Sequence[tuple[Key, tuple[Span, ...]]]
) -> dict[Key, tuple[int, ...]]:
    """The places of flickering stretches by relation; no relation without any."""
    asked: list[Fact] = [each for each in facts if isinstance(each, Link | RateMhz | Tag)]
    for number, (key, stretches) in enumerate(relations):
        asked.append(Relation(number, *key))
        asked += (Stretch(number, place, *each) for place, each in enumerate(stretches))
    found: dict[Key, list[int]] = defaultdict(list)
    for index, place in best([rule_file("segmentation/flicker.lp")], asked).of("doubted"):
        found[relations[int(str(index))][0]].append(int(str(place)))
    return {key: tuple(sorted(places)) for key, places in sorted(found.items())}


def _corrected(stretches: Sequence[Span], doubted: Iterable[int]) -> list[tuple[int, int]]:
    """The intervals in which a relation is taken to hold."""
    flipped = set(doubted)
    spans: list[tuple[int, int]] = []
    for place, (holds, first, last) in enumerate(stretches):
        if (holds == 1) == (place in flipped):
            continue
        if spans and spans[-1][1] == first - 1:
            spans[-1] = spans[-1][0], last
        else:
            spans.append((first, last))
    return spans


def _restated(facts: Iterable[Fact], corrected: dict[Key, list[tuple[int, int]]]) -> Iterator[Fact]:
    """The facts in their order, those of corrected relations in place of the measured ones."""
    written = set()
    for fact in facts:
        key = relation_of(fact)
        if key is None or key not in corrected or not isinstance(fact, Observed):
            yield fact
        elif key not in written:
            written.add(key)
            yield from (fact.between(*span) for span in corrected[key])
