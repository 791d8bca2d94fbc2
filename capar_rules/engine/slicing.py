"""The part of a rule base that some predicates depend on."""

import re
from collections import defaultdict
from collections.abc import Iterable, Sequence

from capar_rules.engine.syntax import Atom, Signature, Statement, split_arguments


def towards(
    statements: Sequence[Statement],
    targets: Iterable[Signature],
    *,
    given: Iterable[Signature] = (),
) -> list[Statement]:
    """The rules that targets depend on, and the constants, in order.

    Args:
        statements: A rule base.
        targets: Predicates to derive.
        given: Predicates that are defined elsewhere, whose rules are left out.
    """
    heads: dict[Signature, list[Statement]] = defaultdict(list)
    for each in statements:
        for head in each.heads:
            for node in nodes(head):
                heads[node].append(each)
    stated, named = set(given), set(heads)
    wanted, waiting = set(targets), sorted(targets)
    while waiting:
        for rule in heads[waiting.pop()]:
            below = {
                node
                for literal in rule.body
                for atom in literal.atoms
                if atom.signature not in stated
                for node in nodes_read(atom, named)
            }
            waiting += sorted(below - wanted)
            wanted |= below
    return [
        each
        for each in statements
        if each.kind == "definition"
        or any(node in wanted for head in each.heads for node in nodes(head))
    ]


def firing(statements: Sequence[Statement], measured: Iterable[Signature]) -> list[Statement]:
    """The rules that can fire if only these predicates have facts, and the constants.

    Args:
        statements: A rule base.
        measured: Predicates that have a fact.
    """
    known, fired = set(measured), set[int]()
    needs = [(number, each, _needed(each)) for number, each in enumerate(statements)]
    while found := [(number, each) for number, each, needed in needs if needed <= known]:
        fired |= {number for number, _ in found}
        known |= heads_of(each for _, each in found)
        needs = [each for each in needs if each[0] not in fired]
    return [each for number, each in enumerate(statements) if number in fired]


def asked_for(statements: Sequence[Statement]) -> list[Statement]:
    """The rules that what is shown depends on, and every other statement.

    All of them, where more than the definitions of what is shown decides on the answer: choices,
    constraints, weights, or terms that are shown.

    Args:
        statements: A rule base.
    """
    shown = {each.shows for each in statements if each.shows is not None}
    if not shown or not all(map(_merely_defines, statements)):
        return list(statements)
    read = {id(each) for each in towards(statements, shown)}
    return [each for each in statements if each.kind != "rule" or id(each) in read]


def _merely_defines(statement: Statement) -> bool:
    if statement.kind == "rule":
        return statement.head_kind == "atom"
    return statement.kind in _SAYING_NOTHING or statement.shows is not None


_SAYING_NOTHING = ("comment", "defined", "definition")


def _needed(statement: Statement) -> set[Signature]:
    """The predicates that must have an atom for a rule to fire."""
    return {
        literal.atoms[0].signature
        for literal in statement.body
        if literal.kind == "atom" and literal.sign == 0
    }


FITS = ("fits", 2)
_NAME = re.compile(r'"(\w+)"')


def named_node(name: str) -> Signature:
    """The node of the dependency graph for fitting one primitive."""
    return f"fits {name}", 2


def nodes(atom: Atom) -> list[Signature]:
    """The predicate; fits has one node for each primitive, as one may depend on another."""
    if atom.signature == FITS:
        names = _NAME.findall(split_arguments(atom.text)[1])
        return [named_node(each) for each in names] or [FITS]
    return [atom.signature]


def nodes_read(atom: Atom, named: set[Signature]) -> list[Signature]:
    """The nodes that an atom of a body reads; fits of a variable reads those of every primitive."""
    found = nodes(atom)
    if FITS in found:
        return sorted({each for each in named if each[0].startswith("fits ")} | {FITS})
    return [*found, FITS] if found[0][0].startswith("fits ") else found


def heads_of(statements: Iterable[Statement]) -> frozenset[Signature]:
    """The predicates that rules define."""
    return frozenset(head.signature for each in statements for head in each.heads)


def signatures_below(statements: Iterable[Statement]) -> frozenset[Signature]:
    """The predicates that rules read."""
    return frozenset(
        atom.signature for each in statements for literal in each.body for atom in literal.atoms
    )
