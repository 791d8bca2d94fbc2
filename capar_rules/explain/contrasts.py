"""Which neighbouring names a segment comes nearest to, and which condition decided."""

from collections.abc import Callable, Collection, Iterator, Sequence
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
    neighbours,
)
from capar_rules.explain.rule_base import RuleBase
from capar_rules.explain.rule_forms import VARIABLE

MOST_FAILING = 2
"""A name whose rules all lack more conditions than that is not near."""

MOST_NAMES = 3
"""So many names are told at most of which the same condition decided."""

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

    again: str
    """The same in other words, for where the clause was told already; empty if there are none."""

    rule: str
    """File and line of a rule of the first name that would have needed it otherwise."""

    def sentence(self, told: Collection[str] = ()) -> str:
        """Why the segment has none of the names, given the clauses that were told before."""
        *before, last = self.names
        clause = self.again or self.clause if self.clause in told else self.clause
        return f"{', '.join(before)}{' or ' * bool(before)}{last}, because {clause}"


@dataclass(frozen=True)
class _Found:
    by_features: bool
    """Whether it is the features that differ, and no condition of the name's own."""

    direct: bool
    """... in a row of its own."""

    order: tuple[int, int, int, int]
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
    own = list(_nearest([each for each in found if not each.by_features]))
    indirect = list(_nearest([each for each in found if each.by_features and not each.direct]))
    direct = list(_nearest([each for each in found if each.direct]))
    if own and not feature_strings(base, name):
        indirect = []
    elif own:
        indirect = [each for each in indirect if not {*each.names} & {*own[0].names}]
    return tuple((own + indirect or direct)[:MOST_TOLD])


def _nearest(found: Sequence[_Found]) -> Iterator[Contrast]:
    """The nearest of some neighbours, with those of which the same condition decided."""
    if not found:
        return
    first = min(found, key=lambda each: each.order)
    alike = sorted(
        (
            each
            for each in found
            if each.contrast.clause == first.contrast.clause and each.order[:2] == first.order[:2]
        ),
        key=lambda each: each.order,
    )
    names = dict.fromkeys(each.contrast.names[0] for each in alike)
    yield replace(first.contrast, names=tuple(names)[:MOST_NAMES])


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
        again = _lacking(base, match.failing[place], match, clock, "again")
        read = {each.atoms[0].signature for each in match.failing}
        featured, direct = bool(read & {FITS, FEATURE}), FEATURE in read
        where = f"{Path(form.rule.place.file).name}:{form.rule.place.line}"
        contrast = Contrast((other.name,), clauses[place], again, where)
        order = len(match.failing), other.steps, *other.distance(form)
        yield _Found(featured, direct, order, contrast)


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
        return _joined(tell(holding)) if holding else ""
    if literal.atoms[0].signature == FEATURE:
        return _feature(arguments, atoms, tell)
    if literal.atoms[0].signature == FITS:
        return _row(base, arguments, atoms, tell)
    return _lacking(base, literal, match, clock, "lacks")


def _lacking(base: RuleBase, literal: Literal, match: Match, clock: Clock, mood: str) -> str:
    """What a template says of a condition that fails; empty if none does, or not all is known."""
    atom = valued(literal.atoms[0].text, match.bound)
    known = [
        UNBOUND if VARIABLE.fullmatch(each) else each.strip('"') for each in split_arguments(atom)
    ]
    told = base.sentences.tell(literal.atoms[0].signature[0], known, clock, mood=mood)
    return "" if UNBOUND in told else told


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
