"""Rules over several windows at once: each atom has the number of its window as first argument.

What the rules cost to read and ground is paid once for all windows, and no atom meets one of
another window.
"""

import re
from collections.abc import Iterable, Iterator
from dataclasses import fields

from capar.model.facts import ALL_FACT_KINDS
from capar_rules.engine.syntax import Atom, Literal, Signature, Statement

WINDOW = "W_"
"""A variable that no rule uses."""

NUMBERS = "window_number"
"""The predicate of the numbers themselves."""

FACTS = {(each.predicate, len(fields(each))) for each in ALL_FACT_KINDS}
"""Predicates of facts, which a rule file may state too: measured, corrected, what moves what."""

_ATOM = re.compile(r"((?:not )*)(\w+)(?:\((.*)\))?", re.DOTALL)


class Numbering:
    """How statements are written so that the numbers of windows keep their atoms apart."""

    def __init__(self, statements: Iterable[Statement]) -> None:
        rules = [each for each in statements if each.kind == "rule"]
        derived = {head.signature for each in rules if each.body for head in each.heads}
        self.same = {head.signature for each in rules for head in each.heads} - derived - FACTS
        """Predicates that are stated in the rules alone, and are the same in every window."""

    def rule(self, statement: Statement) -> str:
        """A rule with the atoms of one window; other statements as they are."""
        if statement.kind != "rule" or self._is_same(statement):
            return statement.text
        if statement.head_kind == "constraint":
            return f":- {self.body(statement.body)}."
        head = statement.text.partition(" :- ")[0].removesuffix(".")
        return f"{self._inside(head, statement.heads)} :- {self.body(statement.body)}."

    def body(self, literals: Iterable[Literal], *more: str) -> str:
        """Conditions within one window, and others as they are."""
        return "; ".join((*map(self.literal, literals), *more, f"{NUMBERS}({WINDOW})"))

    def literal(self, literal: Literal) -> str:
        """A condition with the atoms of one window."""
        if literal.kind == "atom":
            return self.atom(literal.text, literal.atoms[0].signature)
        return self._inside(literal.text, literal.atoms)

    def atom(self, text: str, signature: Signature) -> str:
        """An atom, or its negation, of one window; of a pool, each."""
        found = _ATOM.fullmatch(text)
        if signature in self.same or found is None:
            return text
        negation, name, inside = found.groups()
        numbered = (f"{WINDOW},{each}" if each else WINDOW for each in _alternatives(inside or ""))
        return f"{negation}{name}({';'.join(numbered)})"

    def _inside(self, text: str, atoms: Iterable[Atom]) -> str:
        """A text with these of its atoms of one window."""
        known = {each.text: each.signature for each in atoms}
        if not known:
            return text
        every = "|".join(re.escape(each) for each in sorted(known, key=len, reverse=True))
        pattern = rf"(?<!\w)(?:{every})(?!\w)"
        return re.sub(pattern, lambda found: self.atom(found[0], known[found[0]]), text)

    def _is_same(self, statement: Statement) -> bool:
        return bool(statement.heads) and all(
            each.signature in self.same for each in statement.heads
        )


def _alternatives(inside: str) -> Iterator[str]:
    """The arguments of an atom, or those of each alternative of a pool."""
    depth, quoted, start = 0, False, 0
    for at, sign in enumerate(inside):
        quoted ^= sign == '"' and inside[at - 1 : at] != "\\"
        depth += (not quoted) * ((sign in "([") - (sign in ")]"))
        if sign == ";" and not depth and not quoted:
            yield inside[start:at]
            start = at + 1
    yield inside[start:]
