"""Which neighbouring names a segment comes nearest to, and which condition decided."""

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace
from pathlib import Path

from capar_rules.engine.slicing import FITS
from capar_rules.engine.syntax import Literal, split_arguments
from capar_rules.explain.clock import Clock
from capar_rules.explain.condition_matching import Atoms, Match, valued
from capar_rules.explain.derivations import Derivations
from capar_rules.explain.formatting import UNBOUND
from capar_rules.explain.neighbours import (
    FEATURE,
    Neighbour,
    conditions_of_neighbours,
    feature_strings,
    names_of_strings,
    neighbours,
)
from capar_rules.explain.rule_base import RuleBase
from capar_rules.explain.rule_forms import VARIABLE

MOST_FAILING = 2
"""A name whose rules all lack more conditions than that is not near."""

MOST_NAMES = 3
"""So many names are told at most of which the same condition decided."""

LEAST_NEARNESS = 0.25
"""A name is idle of which what decided fell short by more: it shares less than that [1]."""

HALF = 0.5
"""How near a condition that has no number is taken to come to being otherwise [1]."""

MOST_TOLD = 2
"""So many conditions are told at most."""

Tell = Callable[[str], Sequence[str]]
"""What is told of why an atom holds, the clauses of a summary; of a bit of the features, what
it says: ``feature(Segment,Side,Position)``."""


@dataclass(frozen=True)
class Contrast:
    """Neighbouring names of which the same condition decided."""

    names: tuple[str, ...]
    clause: str
    """What kept the segment from them."""

    rule: str
    """File and line of a rule of the first name that would have needed it otherwise."""

    by_features: bool
    """Whether it is the features that differ, and no condition of the name's own."""

    failing: int = 1
    """How many conditions keep the segment from the first name."""

    @property
    def sentence(self) -> str:
        """Why the segment has none of the names."""
        *before, last = self.names
        return f"{', '.join(before)}{' or ' * bool(before)}{last}, because {self.clause}"


@dataclass(frozen=True)
class _Found:
    direct: bool
    """Whether it is the features that differ, in a row of the name's own."""

    nearness: float
    """By how much what decided missed being otherwise: a share of what was asked for."""

    order: tuple[float, ...]
    """The less, the nearer: conditions that fail, by how much, and how the names are related."""

    contrast: Contrast


def contrasts(
    base: RuleBase, name: str, derived: Derivations, clock: Clock, tell: Tell
) -> tuple[Contrast, ...]:
    """The neighbours that the fewest conditions keep from fitting, and what decided.

    Those that a condition of their own excludes come first, then those that the features do.

    Args:
        base: The rules.
        name: The segment's name.
        derived: What follows from the facts around it.
        clock: Times and distances of the segment.
        tell: What is told of why an atom holds.
    """
    read = {node[0].split()[0] for node in conditions_of_neighbours(base, name)}
    facts = (str(each) for each in derived.facts if type(each).predicate in read)
    atoms = Atoms((*facts, *derived.atoms({*read, FITS[0], FEATURE[0]})))
    found = [
        one
        for neighbour in neighbours(base, name)
        for one in _of_neighbour(base, neighbour, atoms, clock, tell)
    ]
    own = list(_nearest([each for each in found if not each.contrast.by_features]))
    features = [each for each in found if each.contrast.by_features]
    indirect = list(_nearest([each for each in features if not each.direct], most=1))
    direct = list(_nearest([each for each in features if each.direct], most=1))
    supported = list(_supported(base, derived, atoms, clock))
    return tuple((supported + own or indirect or direct)[:MOST_TOLD])


def _nearest(found: Sequence[_Found], *, most: int = MOST_TOLD) -> Iterator[Contrast]:
    """The nearest of some neighbours, each with those of which the same condition decided."""
    waiting = sorted(
        (each for each in found if each.nearness >= LEAST_NEARNESS), key=lambda each: each.order
    )
    told: set[str] = set()
    for _ in range(most):
        waiting = [each for each in waiting if each.contrast.names[0] not in told]
        if not waiting:
            return
        first = waiting[0]
        waiting = [each for each in waiting if each.order[0] == first.order[0]]
        alike = [each for each in waiting if each.contrast.clause == first.contrast.clause]
        names = tuple(dict.fromkeys(each.contrast.names[0] for each in alike))[:MOST_NAMES]
        told |= {*names}
        yield replace(first.contrast, names=names)
        waiting = [each for each in waiting if each.contrast.clause != first.contrast.clause]


def _supported(
    base: RuleBase, derived: Derivations, atoms: Atoms, clock: Clock
) -> Iterator[Contrast]:
    """The names that it would have were what bore the object all along one of its objects."""
    own = {side: string for term, side, string in atoms.rows[FEATURE] if term == clock.own}
    if any(len(string.strip('"')) != 1 for string in own.values()):
        return
    beside = {
        side: string.strip('"') + ("01" if side in ("start", "end") else "0")
        for side, string in own.items()
    }
    for term, other in derived.holding("support"):
        names = names_of_strings(base, beside) if term == clock.own else ()
        if names:
            clause = base.sentences.tell("support", [term, other], clock, mood="brief")
            yield Contrast(names, clause, "", by_features=False)


def _of_neighbour(
    base: RuleBase, other: Neighbour, atoms: Atoms, clock: Clock, tell: Tell
) -> Iterator[_Found]:
    matches = [
        (form, atoms.nearest(form, clock.own, most=MOST_FAILING, may_fail=base.sentences.tellable))
        for form in other.forms
    ]
    if any(match is not None and not match.failing for _, match in matches):
        return  # it fits, and another name comes before it
    for form, match in matches:
        if match is None:
            continue
        clauses = [_clause(base, each, match, atoms, clock, tell) for each in match.failing]
        if not all(clauses):
            continue
        place = next((at for at, each in enumerate(clauses) if any(map(str.isdigit, each))), 0)
        near = min(_nearness(base, each, match, clock) for each in match.failing)
        read = {each.atoms[0].signature for each in match.failing}
        featured, direct = bool(read & {FITS, FEATURE}), FEATURE in read
        where = f"{Path(form.rule.place.file).name}:{form.rule.place.line}"
        contrast = Contrast(
            (other.name,), clauses[place], where, by_features=featured, failing=len(clauses)
        )
        order = len(match.failing), -round(near, 1), other.steps, *other.distance(form)
        yield _Found(direct, near, order, contrast)


def _clause(
    base: RuleBase, literal: Literal, match: Match, atoms: Atoms, clock: Clock, tell: Tell
) -> str:
    """What holds instead of a condition; empty if no sentence says it."""
    if literal.kind != "atom":
        return ""
    atom = valued(literal.atoms[0].text, match.bound)
    arguments = split_arguments(atom)
    if literal.sign:
        holding = atoms.matching(literal, match.bound)
        return _known_text(_joined(tell(holding))) if holding else ""
    if literal.atoms[0].signature == FEATURE:
        return _feature(arguments, atoms, tell)
    if literal.atoms[0].signature == FITS:
        return _row(base, arguments, atoms, tell)
    told = base.sentences.tell(
        literal.atoms[0].signature[0], _known(literal, match), clock, mood="lacks"
    )
    return _known_text(told)


def _known_text(told: str) -> str:
    """A clause; empty if part of it is not known."""
    return "" if UNBOUND in told else told


def _nearness(base: RuleBase, literal: Literal, match: Match, clock: Clock) -> float:
    """How near a condition that decided came to being otherwise; of those without numbers, half."""
    if literal.kind != "atom" or literal.sign:
        return HALF
    name = literal.atoms[0].signature[0]
    return base.sentences.nearness(name, _known(literal, match), clock) or HALF


def _known(literal: Literal, match: Match) -> list[str]:
    """The arguments of a condition that fails, as far as they are known."""
    atom = valued(literal.atoms[0].text, match.bound)
    return [
        UNBOUND if VARIABLE.fullmatch(each) else each.strip('"') for each in split_arguments(atom)
    ]


def _row(base: RuleBase, arguments: Sequence[str], atoms: Atoms, tell: Tell) -> str:
    """What holds instead of the one string in which a row of another name differs."""
    segment, name = arguments
    own = {side: string for term, side, string in atoms.rows[FEATURE] if term == segment}
    for row in feature_strings(base, name.strip('"')):
        differing = [side for side, string in row.items() if own.get(side) != string]
        if len(differing) == 1:
            return _feature((segment, differing[0], row[differing[0]]), atoms, tell)
    return ""


def _feature(arguments: Sequence[str], atoms: Atoms, tell: Tell) -> str:
    """What the segment's own string for a side says where another one says something else."""
    segment, side, other = arguments
    for term, own_side, own in atoms.rows[FEATURE]:
        if (term, own_side) == (segment, side) and len(own) == len(other):
            bits = zip(own.strip('"'), other.strip('"'), strict=True)
            places = [place for place, (ours, theirs) in enumerate(bits) if ours != theirs]
            told = [tell(f"feature({segment},{side},{place})") for place in places]
            return _joined([clause for clauses in told for clause in clauses])
    return ""


def _joined(clauses: Sequence[str]) -> str:
    if len(clauses) < 2:
        return "".join(clauses)
    return f"{', '.join(clauses[:-1])} and {clauses[-1]}"
