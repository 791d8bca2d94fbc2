"""The constants and texts that can occur in each argument of a predicate, by the rules' heads."""

import re
from collections.abc import Iterable, Mapping, Sequence

from capar_rules.engine.syntax import Atom, Signature, Statement, split_arguments

Slot = tuple[Signature, int]
"""A predicate and the index of an argument, from zero."""

KINDS = frozenset({"hand", "foot", "head"})
"""The usual kinds of end-effectors (thesis 4.4.1); a capture may have others."""

MEASURED: Mapping[Slot, frozenset[str]] = {
    (("tag", 2), 1): frozenset({"self", "fixed", "mobile"}),
    (("link", 3), 1): KINDS,
    (("link", 3), 2): frozenset({"right", "left", "none"}),
}
"""Words in arguments of measurements (inputs.lp), which no rule defines."""

VARIABLE = re.compile(r"_*[A-Z]\w*'*")
CONSTANT = re.compile(r"_*[a-z]\w*'*")
STRING = re.compile(r'"[^"]*"')
_TERM = re.compile(r"(_*[a-z]\w*)\(")


def closed(rules: Sequence[Statement]) -> dict[Slot, frozenset[str]]:
    """The arguments for which rules have only a finite set of words, each with those words.

    A compound such as ``seg(Hand, From)`` is listed as ``seg(``. Arguments that can be a number,
    any term or a measured value have no entry.
    """
    constants = {each.defines for each in rules if isinstance(each.defines, str)}
    told = [_row(head, each) for each in rules for head in each.heads]
    found: dict[Slot, frozenset[str] | None] = {
        (signature, place): frozenset()
        for signature, arguments, _ in told
        for place in range(len(arguments))
    }
    found |= MEASURED
    changed = True
    while changed:
        changed = False
        for signature, arguments, bound in told:
            for place, text in enumerate(arguments):
                slot = signature, place
                old = found[slot]
                if old is None or slot in MEASURED:
                    continue
                new = _words(text, bound, found, constants)
                wider = None if new is None else old | new
                if wider != old:
                    found[slot], changed = wider, True
    return {slot: words for slot, words in found.items() if words}


def _row(head: Atom, rule: Statement) -> tuple[Signature, list[str], dict[str, list[Slot]]]:
    """A head's arguments, and where each of the rule's variables is bound."""
    bound: dict[str, list[Slot]] = {}
    for literal in rule.body:
        if literal.kind == "atom" and not literal.sign:
            for atom in literal.atoms:
                for place, text in enumerate(arguments_of(atom)):
                    if VARIABLE.fullmatch(text):
                        bound.setdefault(text, []).append((atom.signature, place))
    return head.signature, arguments_of(head), bound


def arguments_of(atom: Atom) -> list[str]:
    """An atom's arguments as they are written; empty texts for a pool of atoms."""
    found = split_arguments(atom.text) if atom.signature[1] else []
    return found if len(found) == atom.signature[1] else [""] * atom.signature[1]


def _words(
    text: str,
    bound: Mapping[str, Iterable[Slot]],
    found: Mapping[Slot, frozenset[str] | None],
    constants: set[str],
) -> frozenset[str] | None:
    """The words that an argument of a head can be; None for anything."""
    if STRING.fullmatch(text) or (CONSTANT.fullmatch(text) and text not in constants):
        return frozenset({text})
    if (term := _TERM.match(text)) and text.endswith(")"):
        return frozenset({f"{term[1]}("})
    choices = [words for slot in bound.get(text, ()) if (words := found.get(slot)) is not None]
    return frozenset.intersection(*choices) if choices else None
