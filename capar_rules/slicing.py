"""The part of a rule base that some predicates rest on."""

from collections import defaultdict
from collections.abc import Iterable, Sequence

from capar_rules.syntax import Signature, Statement


def towards(
    statements: Sequence[Statement],
    targets: Iterable[Signature],
    *,
    given: Iterable[Signature] = (),
) -> list[Statement]:
    """The rules that targets rest on, and the constants, in their order.

    Args:
        statements: A rule base.
        targets: Predicates asked for.
        given: Predicates that are stated elsewhere, so that their own rules are left out.
    """
    heads: dict[Signature, list[Statement]] = defaultdict(list)
    for each in statements:
        for head in each.heads:
            heads[head.signature].append(each)
    stated = set(given)
    wanted, waiting = set(targets), sorted(targets)
    while waiting:
        for rule in heads[waiting.pop()]:
            below = {atom.signature for literal in rule.body for atom in literal.atoms} - stated
            waiting += sorted(below - wanted)
            wanted |= below
    return [
        each
        for each in statements
        if each.kind == "definition" or any(head.signature in wanted for head in each.heads)
    ]


def heads_of(statements: Iterable[Statement]) -> frozenset[Signature]:
    """The predicates that rules define."""
    return frozenset(head.signature for each in statements for head in each.heads)


def signatures_below(statements: Iterable[Statement]) -> frozenset[Signature]:
    """The predicates that rules read."""
    return frozenset(
        atom.signature for each in statements for literal in each.body for atom in literal.atoms
    )
