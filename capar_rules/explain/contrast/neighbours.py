"""Names next to a segment's own, by the rules alone, and the conditions that they ask for.

Names are neighbours if one specialises the other, if both specialise the same one, if rows of the
feature table differ in one of their four strings, or if one asks for what the other excludes.
"""

from collections import defaultdict
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from functools import lru_cache

from capar_rules.engine.syntax import FITS, Signature, Statement, nodes_read, split_arguments
from capar_rules.explain.contrast.near_misses import SPECIALISES, names_in_pairs
from capar_rules.explain.rule_base import RuleBase
from capar_rules.explain.rule_forms import SIDES, Form, forms_of_segment, rules_of

FEATURE = ("feature", 3)
ALIKE = 3
"""So many of the four strings of a row are the same in a neighbouring row."""


@dataclass(frozen=True)
class Neighbour:
    """A name next to another one."""

    name: str
    steps: int
    """Zero if a name of which both are kinds, or one of the two, is directly above; else one."""

    below: bool
    """Whether it specialises the other one."""

    forms: tuple[Form, ...]
    shared: frozenset[tuple[Signature, int]]
    """The conditions of the rules for the name that it is next to."""

    def distance(self, form: Form) -> tuple[int, int]:
        """How few of a rule's conditions the other name asks for too, and how many it does not."""
        asked = _asked(form)
        return -len(asked & self.shared), len(asked - self.shared)


@dataclass(frozen=True)
class _Names:
    """What a rule base says of its primitives."""

    above: Mapping[str, frozenset[str]]
    """What a primitive specialises directly."""

    generals: Mapping[str, frozenset[str]]
    """All that a primitive specialises, directly or by others."""

    rows: Mapping[str, Sequence[tuple[str, ...]]]
    asked: Mapping[str, frozenset[tuple[Signature, int]]]
    """The conditions in the rules of each, with their signs."""

    def below(self, name: str) -> set[str]:
        """The primitives that specialise one."""
        return {each for each in self.asked if name in self.generals.get(each, ())}

    def beside(self, name: str) -> set[str]:
        """The primitives with a row that differs from one of this name in one string."""
        ours = self.rows.get(name, ())
        return {other for other, rows in self.rows.items() if _differ_by_one(ours, rows)}

    def steps(self, name: str, other: str) -> int:
        """Zero if one is directly above the other, or the same name is directly above both."""
        ours, theirs = ({each, *self.above.get(each, ())} for each in (name, other))
        return int(not ours & theirs)

    def related(self, name: str) -> set[str]:
        """What specialises it or the same as it, what excludes it, and what is below its rows."""
        below = self.below(name)
        own = self.generals.get(name, frozenset())
        excluded = {(signature, 1 - sign) for signature, sign in self.asked.get(name, ())}
        found = below | {each for each in self.asked if own & self.generals.get(each, frozenset())}
        found |= {each for each, asked in self.asked.items() if asked & excluded}
        for other in self.beside(name):
            found |= self.below(other) if self.below(other) & below else set()
        return found


@lru_cache(maxsize=8)
def _names(base: RuleBase) -> _Names:
    above: dict[str, set[str]] = defaultdict(set)
    for one, general in names_in_pairs(base.statements, SPECIALISES):
        above[one].add(general)
    generals = {one: frozenset(_closed(above, one)) for one in above}
    rows: dict[str, list[tuple[str, ...]]] = defaultdict(list)
    asked: dict[str, frozenset[tuple[Signature, int]]] = {}
    for rule in base.statements:
        for head in rule.heads if not rule.body else ():
            parts = split_arguments(head.text)
            if head.signature == ("feature_row", 6):
                rows[parts[0].strip('"')].append(tuple(parts[2:]))
            if head.signature == ("primitive", 1):
                asked[parts[0].strip('"')] = frozenset()
    for name in asked:
        asked[name] = frozenset(
            (each.atoms[0].signature, each.sign)
            for rule in rules_of(base.statements, name)
            for each in rule.body
            if each.kind == "atom" and each.atoms[0].signature not in (FITS, FEATURE)
        )
    direct = {one: frozenset(generals) for one, generals in above.items()}
    return _Names(direct, generals, rows, asked)


def _closed(above: Mapping[str, Iterable[str]], name: str) -> set[str]:
    found, waiting = set[str](), [name]
    while waiting:
        more = {*above.get(waiting.pop(), ())} - found
        found |= more
        waiting += sorted(more)
    return found


def _differ_by_one(ours: Sequence[tuple[str, ...]], theirs: Sequence[tuple[str, ...]]) -> bool:
    return any(
        list(map(len, one)) == list(map(len, other))
        and sum(a == b for a, b in zip(one, other, strict=True)) == ALIKE
        for one in ours
        for other in theirs
    )


def generals_of(base: RuleBase, name: str) -> list[str]:
    """What a primitive specialises directly."""
    return sorted(_names(base).above.get(name, ()))


def all_generals_of(base: RuleBase, name: str) -> frozenset[str]:
    """What a primitive specialises, directly or by others."""
    return _names(base).generals.get(name, frozenset())


def feature_strings(base: RuleBase, name: str) -> list[dict[str, str]]:
    """The four strings of each row of a name, by their side."""
    return [dict(zip(SIDES, row, strict=True)) for row in _names(base).rows.get(name, ())]


def names_of_strings(base: RuleBase, strings: Mapping[str, str]) -> tuple[str, ...]:
    """The primitives with a row of these four strings, by their side."""
    wanted = tuple(f'"{strings[side]}"' for side in SIDES)
    return tuple(name for name, rows in _names(base).rows.items() if wanted in rows)


@lru_cache(maxsize=256)
def neighbours(base: RuleBase, name: str) -> tuple[Neighbour, ...]:
    """The names next to one, each with the rules by which segments have it."""
    names = _names(base)
    beside = names.beside(name)
    others = (names.related(name) | beside) - {name, *names.generals.get(name, ())}
    shared = frozenset(each for form in _forms(base, name) for each in _asked(form))
    return tuple(
        Neighbour(
            other,
            names.steps(name, other),
            name in names.generals.get(other, ()),
            tuple(_forms(base, other)),
            shared,
        )
        for other in sorted(others)
    )


def _asked(form: Form) -> set[tuple[Signature, int]]:
    return {(each.atoms[0].signature, each.sign) for each in form.body if each.kind == "atom"}


@lru_cache(maxsize=256)
def _forms(base: RuleBase, name: str) -> list[Form]:
    rules: Iterable[Statement] = rules_of(base.statements, name)
    told = base.sentences
    return [form for rule in rules for form in forms_of_segment(rule, base.statements, told)]


@lru_cache(maxsize=256)
def conditions_of_neighbours(base: RuleBase, name: str) -> frozenset[Signature]:
    """The predicates, and nodes of names, that rules of neighbouring names ask for."""
    named = {head.signature for each in base.statements for head in each.heads}
    return frozenset(
        node
        for other in neighbours(base, name)
        for form in other.forms
        for literal in form.body
        for atom in literal.atoms
        for node in nodes_read(atom, named)
        if node != FITS
    )
