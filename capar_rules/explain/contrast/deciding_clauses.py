"""What decided against a name: the clauses of conditions that failed, and how near they came."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass

from capar_rules.engine.syntax import FITS, Literal, split_arguments
from capar_rules.explain.clock import Clock
from capar_rules.explain.contrast.condition_matching import Atoms, Match, valued
from capar_rules.explain.contrast.neighbours import FEATURE, Neighbour, feature_strings
from capar_rules.explain.contrast.told_contrast import HALF
from capar_rules.explain.rule_base import RuleBase
from capar_rules.explain.rule_forms import VARIABLE, Form
from capar_rules.explain.told_argument import UNBOUND

BUT_FOR = 0.95
"""How near that comes which only what was done besides keeps from a name [1]."""

SEEN = ("leans_over", "spins")
"""Predicates of how a thing was turned: one sees it of a segment also where it does not decide."""


@dataclass(frozen=True)
class Wording:
    """How contrasts are told."""

    holding: Callable[[str], Sequence[str]]
    """The clauses of why an atom holds; of a bit of the features, what it says:
    ``feature(Segment,Side,Position)``."""

    clause: Callable[[str, Sequence[str], str], str]
    """The clause for a predicate with its arguments in a mood of the templates."""


def seen_beside(other: Neighbour, form: Form, match: Match, tell: Wording) -> tuple[str, ...]:
    """What a rule asks for of how a thing was turned, and the own name does not, and was so."""
    holding = [
        literal
        for literal in form.body
        if literal.kind == "atom"
        and not literal.sign
        and literal not in match.failing
        and literal.atoms[0].signature[0] in SEEN
        and (literal.atoms[0].signature, literal.sign) not in other.shared
    ]
    told = (
        tell.clause(literal.atoms[0].signature[0], _known(literal, match), "brief")
        for literal in holding
    )
    return tuple(clause for clause in told if clause and UNBOUND not in clause)


def instead_clauses(
    base: RuleBase, literal: Literal, match: Match, atoms: Atoms, tell: Wording
) -> tuple[str, ...]:
    """What holds instead of a condition; none if no sentence says all of it."""
    if literal.kind != "atom":
        return ()
    arguments = split_arguments(valued(literal.atoms[0].text, match.bound))
    if literal.sign:
        holding = atoms.matching(literal, match.bound)
        return _known_clauses(tell.holding(holding)) if holding else ()
    if literal.atoms[0].signature == FEATURE:
        return _feature(arguments, atoms, tell)
    if literal.atoms[0].signature == FITS:
        return _row(base, arguments, atoms, tell)
    predicate = literal.atoms[0].signature[0]
    return _known_clauses([tell.clause(predicate, _known(literal, match), "lacks")])


def _known_clauses(told: Sequence[str]) -> tuple[str, ...]:
    """Clauses; none if part of one is not known."""
    return () if any(not clause or UNBOUND in clause for clause in told) else tuple(told)


def nearness_of(base: RuleBase, literal: Literal, match: Match, clock: Clock) -> float:
    """How near a condition that decided came to being otherwise; of those without numbers, half.

    What would have the name but for one thing that it did besides comes nearest.
    """
    if literal.kind != "atom":
        return HALF
    if literal.sign:
        return BUT_FOR
    name = literal.atoms[0].signature[0]
    return base.sentences.nearness(name, _known(literal, match), clock) or HALF


def _known(literal: Literal, match: Match) -> list[str]:
    """The arguments of a condition that fails, as far as they are known."""
    atom = valued(literal.atoms[0].text, match.bound)
    return [
        UNBOUND if VARIABLE.fullmatch(term) else term.strip('"') for term in split_arguments(atom)
    ]


def _row(base: RuleBase, arguments: Sequence[str], atoms: Atoms, tell: Wording) -> tuple[str, ...]:
    """What holds instead of the one string in which a row of another name differs."""
    segment, name = arguments
    own = {side: string for term, side, string in atoms.rows[FEATURE] if term == segment}
    told = []
    for row in feature_strings(base, name.strip('"')):
        differing = [side for side, string in row.items() if own.get(side) != string]
        if len(differing) == 1:
            told.append(_feature((segment, differing[0], row[differing[0]]), atoms, tell))
    return min(filter(None, told), key=len, default=())


def _feature(arguments: Sequence[str], atoms: Atoms, tell: Wording) -> tuple[str, ...]:
    """What the segment's own string for a side says where another one says something else."""
    segment, side, other = arguments
    for term, own_side, own in atoms.rows[FEATURE]:
        if (term, own_side) == (segment, side) and len(own) == len(other):
            bits = zip(own.strip('"'), other.strip('"'), strict=True)
            places = [place for place, (ours, theirs) in enumerate(bits) if ours != theirs]
            told = [tell.holding(f"feature({segment},{side},{place})") for place in places]
            return tuple(clause for clauses in told for clause in clauses)
    return ()
