"""The segments that a rule is about: its own, which its head names, and others that it joins."""

from collections.abc import Iterable

from capar_rules.engine.slicing import FITS
from capar_rules.engine.syntax import Atom, Literal, Statement
from capar_rules.lint.word_places import Slot, arguments_of, closed

COMPOUND = frozenset({"seg("})
"""What stands where a predicate takes a segment: ``seg(Hand, From)``."""

FITTED: Slot = (FITS, 0)


def segment_slots(rules: Iterable[Statement]) -> frozenset[Slot]:
    """The arguments of predicates that are segments."""
    return frozenset(slot for slot, words in closed([*rules]).items() if words == COMPOUND)


def about_others(rule: Statement, slots: Iterable[Slot]) -> frozenset[str]:
    """The conditions, as written, about a segment that is not the one of the rule's head.

    A head without a segment has the first one of the body.
    """
    wanted, alike = frozenset(slots), _alike(rule)
    home = {alike(term) for head in rule.heads for term in _terms(head, wanted)}
    found = set()
    for literal in rule.body:
        terms = {alike(term) for atom in literal.atoms for term in _terms(atom, wanted)}
        home = home or terms
        if terms - home:
            found.add(literal.text)
    return frozenset(found)


def _terms(atom: Atom, slots: frozenset[Slot]) -> list[str]:
    places = enumerate(arguments_of(atom))
    return [_spaceless(text) for at, text in places if (atom.signature, at) in slots]


class _Alike:
    """Terms that a rule equates, by one of them."""

    def __init__(self) -> None:
        self.leaders: dict[str, str] = {}

    def join(self, left: str, right: str) -> None:
        self.leaders[self(left)] = self(right)

    def __call__(self, term: str) -> str:
        while (leader := self.leaders.get(term, term)) != term:
            term = leader
        return term


def _alike(rule: Statement) -> _Alike:
    found = _Alike()
    for left, right in equations(rule):
        found.join(_spaceless(left), _spaceless(right))
    return found


def equations(rule: Statement) -> Iterable[tuple[str, str]]:
    """The two sides of each equation of a rule."""
    for literal in rule.body:
        if sides := _sides(literal):
            yield sides


def _sides(literal: Literal) -> tuple[str, str] | None:
    sides = literal.text.split(" = ")
    if literal.kind == "comparison" and len(sides) == 2 and not literal.sign:
        return sides[0], sides[1]
    return None


def _spaceless(text: str) -> str:
    return "".join(text.split())
