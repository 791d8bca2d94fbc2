"""How few conditions of a rule fail of a segment, over atoms that hold: a search by unification."""

import re
from collections import defaultdict
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import lru_cache

from capar_rules.engine.syntax import Literal, Signature, split_arguments
from capar_rules.explain.rule_forms import VARIABLE, Form

Bound = Mapping[str, str]
"""What the variables of a rule stand for."""

_VALUED = re.compile(r'"(?:[^"\\]|\\.)*"|\b_*[A-Z]\w*')
_COMPOUND = re.compile(r"(\w*)(\(.*\))", re.DOTALL)


@dataclass(frozen=True)
class Match:
    """A rule's conditions over a segment: which fail, and what its variables stand for."""

    failing: tuple[Literal, ...]
    bound: Bound


class Atoms:
    """Atoms that hold, by predicate."""

    def __init__(self, atoms: Iterable[str]) -> None:
        self.rows: dict[Signature, list[Sequence[str]]] = defaultdict(list)
        for atom in atoms:
            parts = _parts(atom)
            self.rows[atom.partition("(")[0], len(parts)].append(parts)

    def nearest(
        self, form: Form, segment: str, *, most: int, may_fail: Callable[[Literal], bool]
    ) -> Match | None:
        """The match of a rule with fewest failing conditions; None if more than so many fail.

        Args:
            form: The rule.
            segment: The term of the segment that its head is about.
            most: How many conditions may fail.
            may_fail: Which ones may.
        """
        if any(not _plain(each) for each in form.body):
            return None
        failable = {id(each) for each in form.body if may_fail(each)}
        hopeless = [each for each in form.body if self._hopeless(each)]
        if len(hopeless) > most or any(id(each) not in failable for each in hopeless):
            return None
        joins = [each.partition("=")[::2] for each in form.joins]
        start = dict(_unified(split_arguments(form.rule.heads[0].text)[0], segment, {}) or {})
        found = None
        for allowed in range(len(hopeless), most + 1):
            found = next(self._matches(form.body, start, joins, failable, allowed), None)
            if found is not None:
                break
        if found is None:
            return None
        failing, bound = found
        return Match(failing, bound)

    def _hopeless(self, literal: Literal) -> bool:
        """Whether no atom of a condition's predicate holds, so that it fails in every match."""
        return _binds(literal) and not self.rows.get(literal.atoms[0].signature)

    def matching(self, literal: Literal, bound: Bound) -> str:
        """An atom that a condition, taken without its negation, is met by; empty if none is."""
        atom = literal.atoms[0]
        wanted = _parts(atom.text)
        for row in self.rows.get(atom.signature, ()):
            if _all_unified(wanted, row, bound) is not None:
                return f"{atom.signature[0]}({','.join(row)})" if row else atom.signature[0]
        return ""

    def _matches(
        self,
        body: Sequence[Literal],
        bound: dict[str, str],
        joins: Sequence[tuple[str, str]],
        failable: set[int],
        allowed: int,
    ) -> Iterator[tuple[tuple[Literal, ...], dict[str, str]]]:
        """Ways to match conditions in turn, of which at most so many fail.

        Positive conditions come first, as they bind the variables of the others.
        """
        joined = _joined(bound, joins)
        if joined is None:
            return
        if not body:
            yield (), joined
            return
        literal = next((each for each in body if _binds(each)), body[0])
        rest = [each for each in body if each is not literal]
        ways = list(self._ways(literal, joined))
        for way in ways:
            yield from self._matches(rest, way, joins, failable, allowed)
        if allowed and id(literal) in failable:
            for failing, way in self._matches(rest, joined, joins, failable, allowed - 1):
                yield (literal, *failing), way

    def _ways(self, literal: Literal, bound: dict[str, str]) -> Iterator[dict[str, str]]:
        """What the variables stand for where a condition holds."""
        if literal.kind == "comparison":
            if _compared(literal.text, bound):
                yield bound
            return
        atom = literal.atoms[0]
        wanted = _parts(atom.text)
        ways = (
            way
            for row in self.rows.get(atom.signature, ())
            if (way := _all_unified(wanted, row, bound)) is not None
        )
        if not literal.sign:
            yield from ways
        elif next(ways, None) is None:
            yield bound


def valued(text: str, bound: Bound) -> str:
    """A text with what its variables stand for."""
    if text in bound:
        return bound[text]
    return _VALUED.sub(lambda found: bound.get(found[0], found[0]), text)


def _plain(literal: Literal) -> bool:
    """Whether the search can judge a condition."""
    if literal.kind == "comparison":
        return bool(re.fullmatch(r"\w+\s*(=|!=|<=|>=|<|>)\s*\w+", literal.text))
    return literal.kind == "atom" and literal.sign < 2


def _binds(literal: Literal) -> bool:
    return literal.kind == "atom" and not literal.sign


def _joined(bound: dict[str, str], joins: Sequence[tuple[str, str]]) -> dict[str, str] | None:
    """The bindings with what equalities of two terms add; None if those do not hold."""
    for _ in range(len(joins) + 1):
        before = len(bound)
        for one, other in joins:
            first, second = valued(one, bound), valued(other, bound)
            way = _unified(first, second, bound) if _ground(second) else None
            if way is None and _ground(first):
                way = _unified(second, first, bound)
            if way is None and _ground(first) and _ground(second):
                return None
            bound = way if way is not None else bound
        if len(bound) == before:
            break
    return bound


@lru_cache(maxsize=1 << 14)
def _ground(text: str) -> bool:
    return not any(
        VARIABLE.fullmatch(each) for each in re.findall(r'"[^"]*"|\w+', text) if each != "_"
    )


def _unified(pattern: str, text: str, bound: Bound) -> dict[str, str] | None:
    """The bindings under which a pattern is a text; None if there are none."""
    if _is_variable(pattern):
        known = bound.get(pattern, text)
        return {**bound, pattern: text} if known == text else None
    if pattern in ("_", text):
        return dict(bound)
    compound, other = _COMPOUND.fullmatch(pattern), _COMPOUND.fullmatch(text)
    if compound and not compound[1] and ";" in pattern:
        ways = (_unified(each.strip(), text, bound) for each in pattern[1:-1].split(";"))
        return next((way for way in ways if way is not None), None)
    if compound and other and other[1] == compound[1]:
        return _all_unified(_parts(pattern), _parts(text), bound)
    return None


def _all_unified(
    patterns: Sequence[str], texts: Sequence[str], bound: Bound
) -> dict[str, str] | None:
    """The bindings under which each pattern is the text at its place."""
    if len(patterns) != len(texts):
        return None
    way = dict(bound)
    for one, other in zip(patterns, texts, strict=True):
        if one in ("_", other):
            continue
        if not _is_variable(one):
            further = _unified(one, other, way)
            if further is None:
                return None
            way = further
        elif way.setdefault(one, other) != other:
            return None
    return way


@lru_cache(maxsize=1 << 14)
def _is_variable(text: str) -> bool:
    return VARIABLE.fullmatch(text) is not None


@lru_cache(maxsize=1 << 14)
def _parts(text: str) -> tuple[str, ...]:
    return tuple(split_arguments(text)) if "(" in text else ()


def _compared(text: str, bound: Bound) -> bool:
    """Whether a comparison of two variables or constants holds; false of unknown ones."""
    one, sign, other = re.split(r"\s*(!=|<=|>=|<|>|=)\s*", valued(text, bound))
    if not (_ground(one) and _ground(other)):
        return False
    if sign in ("=", "!="):
        return (one == other) == (sign == "=")
    if not (one.lstrip("-").isdigit() and other.lstrip("-").isdigit()):
        return False
    first, second = int(one), int(other)
    return {"<": first < second, "<=": first <= second, ">": first > second}.get(
        sign, first >= second
    )
