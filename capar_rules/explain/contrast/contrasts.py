"""Which neighbouring names a segment comes nearest to, and which condition decided."""

import re
from collections.abc import Collection, Iterator, Sequence
from dataclasses import dataclass, replace
from pathlib import Path

from capar_rules.engine.syntax import FITS, split_arguments
from capar_rules.explain.clock import Clock
from capar_rules.explain.contrast.condition_matching import Atoms, Match
from capar_rules.explain.contrast.deciding_clauses import (
    Wording,
    instead_clauses,
    nearness_of,
    seen_beside,
)
from capar_rules.explain.contrast.near_misses import more_specific
from capar_rules.explain.contrast.neighbours import (
    FEATURE,
    Neighbour,
    all_generals_of,
    conditions_of_neighbours,
    names_of_strings,
    neighbours,
)
from capar_rules.explain.contrast.told_contrast import HALF, Contrast
from capar_rules.explain.derivations import Derivations
from capar_rules.explain.rule_base import RuleBase

MOST_FAILING = 2
"""A name whose rules all lack more conditions than that is not near."""

MOST_NAMES = 4
"""So many names are told at most of which the same condition decided."""

LEAST_NEARNESS = 0.25
"""A name is idle of which what decided fell short by more: it shares less than that [1]."""

LEAST_TOLD = 0.01
"""Where no name is near, the nearest is told if it has a number, however small its share [1]."""

LEAST_SEEN = 0.1
"""Beside near names, others are told whose number has that share of what is asked for [1]."""

MOST_TOLD = 2
"""So many conditions are told at most."""

MOST_FOUND = 6
"""So many are found at most: some of them may be told as the name's own."""


@dataclass(frozen=True)
class _Found:
    direct: bool
    """Whether it is the features that differ, in a row of the name's own."""

    nearness: float
    """By how much what decided missed being otherwise: a share of what was asked for."""

    order: tuple[float, ...]
    """The less, the nearer: of what was seen of a name, or of a more specific one, first; then by
    how many conditions fail, by how much, and how the names are related."""

    contrast: Contrast


def contrasts(
    base: RuleBase, name: str, derived: Derivations, clock: Clock, tell: Wording
) -> tuple[Contrast, ...]:
    """The neighbours that the fewest conditions keep from fitting, and what decided.

    Those that a condition of their own excludes come first, then those that the features do.

    Args:
        base: The rules.
        name: The segment's name.
        derived: What follows from the facts around it.
        clock: Times and distances of the segment.
        tell: How what decided is told.
    """
    read = {node[0].split()[0] for node in conditions_of_neighbours(base, name)}
    facts = (str(each) for each in derived.facts if type(each).predicate in read)
    atoms = Atoms((*facts, *derived.atoms({*read, FITS[0], FEATURE[0]})))
    found = [
        one
        for neighbour in neighbours(base, name)
        for one in _of_neighbour(base, neighbour, atoms, clock, tell)
    ]
    own_found = [refused for refused in found if not refused.contrast.by_features]
    own = list(_nearest(own_found))
    numbered = [refused for refused in own_found if refused.contrast.numbered]
    least = LEAST_SEEN if own else LEAST_TOLD
    own += [one for one in _nearest(numbered, least=least) if one not in own]
    features = [each for each in found if each.contrast.by_features]
    indirect = list(_nearest([each for each in features if not each.direct], most=MOST_TOLD))
    direct = list(_nearest([each for each in features if each.direct], most=1))
    supported = list(_supported(base, derived, atoms, clock, tell))
    found_once = _told_once(supported + own + direct + indirect)
    own_names = {name, *all_generals_of(base, name)}
    return tuple(_of_its_kind(base, contrast, own_names) for contrast in found_once)


def _of_its_kind(base: RuleBase, contrast: Contrast, own: Collection[str]) -> Contrast:
    """A contrast by the row of a name, of it and of the names that are kinds of it.

    A name that is among the segment's own is left out.
    """
    general = contrast.names[0] if contrast.direct else contrast.general
    if not contrast.by_features or not general:
        return contrast
    kinds = more_specific(base.statements, general)
    names = tuple(name for name in contrast.names if name in kinds)
    if not contrast.direct and (general in own or contrast.though):
        return replace(contrast, names=names or contrast.names, general="")
    return replace(contrast, names=(general, *names)[:MOST_NAMES], general=general)


def _told_once(found: Sequence[Contrast]) -> Iterator[Contrast]:
    """The contrasts, those together of which the same is told."""
    for number, contrast in enumerate(found):
        if any(contrast.told_as(before) for before in found[:number]):
            continue
        alike = [other for other in found[number:] if contrast.told_as(other)]
        names = tuple(dict.fromkeys(name for other in alike for name in other.names))
        yield replace(contrast, names=names[:MOST_NAMES])


def _nearest(
    found: Sequence[_Found], *, most: int = MOST_FOUND, least: float = LEAST_NEARNESS
) -> Iterator[Contrast]:
    """The nearest of some neighbours, each with those of which the same condition decided."""
    near = (refused for refused in found if refused.nearness >= least)
    waiting = sorted(near, key=lambda each: each.order)
    told: set[str] = set()
    for _ in range(most):
        waiting = [each for each in waiting if each.contrast.names[0] not in told]
        if not waiting:
            return
        first = waiting[0]
        alike = [refused for refused in waiting if refused.contrast.told_as(first.contrast)]
        names = tuple(dict.fromkeys(refused.contrast.names[0] for refused in alike))[:MOST_NAMES]
        told |= {*names}
        yield replace(first.contrast, names=names)
        waiting = [each for each in waiting if not each.contrast.told_as(first.contrast)]


def _supported(
    base: RuleBase, derived: Derivations, atoms: Atoms, clock: Clock, tell: Wording
) -> Iterator[Contrast]:
    """The names that it would have were what bore the object all along one of its objects."""
    own = {side: string for term, side, string in atoms.rows[FEATURE] if term == clock.own}
    if any(len(string.strip('"')) != 1 for string in own.values()):
        return
    beside = {
        side: string.strip('"') + ("01" if side in ("start", "end") else "0")
        for side, string in own.items()
    }
    names = names_of_strings(base, beside)
    clauses = tuple(
        tell.clause("support", [term, other], "brief")
        for term, other in derived.holding("support")
        if term == clock.own
    )
    if names and clauses:
        yield Contrast(names, clauses, "", by_features=False)


def _of_neighbour(
    base: RuleBase, other: Neighbour, atoms: Atoms, clock: Clock, tell: Wording
) -> Iterator[_Found]:
    matches = [
        (form, atoms.nearest(form, clock.own, most=MOST_FAILING, may_fail=base.sentences.tellable))
        for form in other.forms
    ]
    if any(match is not None and not match.failing for _, match in matches):
        return  # it fits, and another name comes before it
    as_featured = any(match is not None and not _featured(match) for _, match in matches)
    for form, match in matches:
        if match is None or (as_featured and _featured(match)):
            continue  # where the features fit one rule for a name, those of another deny nothing
        clauses = [instead_clauses(base, literal, match, atoms, tell) for literal in match.failing]
        if not all(clauses):
            continue
        place = _deciding(match, clauses)
        near = min(nearness_of(base, literal, match, clock) for literal in match.failing)
        though = seen_beside(other, form, match, tell)
        near = max(near, HALF) if though else near
        told = match.failing[place].atoms[0]
        featured, direct = told.signature in (FITS, FEATURE), told.signature == FEATURE
        general = split_arguments(told.text)[1].strip('"') if told.signature == FITS else ""
        where = f"{Path(form.rule.place.file).name}:{form.rule.place.line}"
        contrast = Contrast(
            (other.name,),
            clauses[place],
            where,
            by_features=featured,
            failing=len(clauses),
            though=though,
            below=other.below,
            numbered=bool(re.search(r"\d", "".join(clauses[place]))),
            direct=direct,
            nearness=near,
            general=general,
        )
        related = other.steps, *other.distance(form)
        seen_first = not though, not other.below
        brief = len(clauses[place])
        order = *seen_first, len(match.failing), -round(near, 1), brief, *related
        yield _Found(direct, near, order, contrast)


def _featured(match: Match) -> bool:
    """Whether the features are among what keeps a rule from fitting."""
    return any(literal.atoms[0].signature in (FITS, FEATURE) for literal in match.failing)


def _deciding(match: Match, clauses: Sequence[Sequence[str]]) -> int:
    """Which of the conditions that fail is told: one of the name's own, and one with a number."""

    def order(at: int) -> tuple[bool, bool]:
        features = match.failing[at].atoms[0].signature in (FITS, FEATURE)
        return features, not re.search(r"\d", "".join(clauses[at]))

    return min(range(len(clauses)), key=order)
