"""The measured facts without which a word of rules cannot hold, by its definitions."""

from collections import defaultdict
from collections.abc import Mapping, Sequence
from itertools import chain

from capar_rules.engine.syntax import Literal, Signature, Statement, split_arguments

NUMBERED: Mapping[str, frozenset[str]] = {
    "tick": frozenset(),
    "last_tick": frozenset(),
    "within": frozenset({"touching"}),
    "moves_between": frozenset({"moving"}),
    "moves_during": frozenset({"touching", "moving"}),
    "free_between": frozenset({"touching"}),
    "undisturbed": frozenset({"resting"}),
    "shares": frozenset({"touching"}),
    "meanwhile": frozenset({"touching"}),
    "sets_off": frozenset({"moving"}),
    "settles": frozenset({"moving"}),
    "lands": frozenset({"touching"}),
    "leaves": frozenset({"touching"}),
}
"""Inputs numbered by ``capar_rules.borders``, each with the measured facts that they come from."""

STRETCHES = ("spans", "encloses")
"""Inputs that number a stretch, which their second argument names."""

GIVEN = frozenset({"frames", "rate_mhz", "link", "tag"})
"""What every example states anyway."""


Ways = tuple[tuple[str, ...], ...]
"""Predicates of measured facts, one set for each way to define a word."""


def required_facts(
    rules: Sequence[Statement], *, measured: frozenset[Signature]
) -> Mapping[Signature, Ways]:
    """The measured facts that each word of a rule base needs.

    Only conditions without ``not`` need facts. Of a way whose facts include those of another one
    nothing is said.

    Args:
        rules: A rule base.
        measured: The predicates of ``inputs.lp``.
    """
    heads: dict[Signature, list[Statement]] = defaultdict(list)
    for rule in rules:
        for head in rule.heads:
            heads[head.signature].append(rule)
    names = {name for name, _ in measured}
    everything = frozenset(names | {"lies"})
    needs: dict[Signature, frozenset[str]] = defaultdict(lambda: everything)

    def of_literal(literal: Literal) -> frozenset[str]:
        atom = literal.atoms[0]
        name = atom.signature[0]
        if atom.signature not in measured:
            return needs[atom.signature] if atom.signature in heads else frozenset()
        if name in STRETCHES:
            stretch = split_arguments(atom.text)[1]
            told = stretch if stretch in names else "lies"
            return frozenset({told} if stretch[:1].islower() else ())
        return NUMBERED.get(name, frozenset({name}))

    def of_rule(rule: Statement) -> frozenset[str]:
        plain = (each for each in rule.body if each.kind == "atom" and not each.sign)
        return frozenset(chain.from_iterable(map(of_literal, plain)))

    changed = True
    while changed:
        changed = False
        for signature, ways in heads.items():
            found = frozenset.intersection(needs[signature], *map(of_rule, ways))
            changed = changed or found != needs[signature]
            needs[signature] = found
    return {word: _least({of_rule(rule) - GIVEN for rule in heads[word]}) for word in heads}


def _least(ways: set[frozenset[str]]) -> Ways:
    least = [way for way in ways if not any(other < way for other in ways)]
    return tuple(sorted(tuple(sorted(way)) for way in least))
