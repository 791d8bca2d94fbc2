"""The summary of an explanation: the name's conditions, and what decided against neighbours."""

import re
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace

from capar_rules.explain.briefs import BOTH, Briefs, listed
from capar_rules.explain.claimed_measures import Measure
from capar_rules.explain.claims import Claim
from capar_rules.explain.contrasts import MOST_NAMES, MOST_TOLD, Contrast
from capar_rules.explain.leading import DOUBTED, OWN, leading, parsed, rank
from capar_rules.explain.reason import Reason
from capar_rules.explain.touch_notes import touching


@dataclass(frozen=True)
class Summary:
    """Why a segment has a name, in a few sentences."""

    text: str
    claims: tuple[Claim, ...]
    """Its clauses, with what was measured for each."""


def summary(
    name: str,
    reason: Reason,
    briefs: Briefs,
    against: Sequence[Contrast],
    generals: Sequence[str] = (),
) -> Summary:
    """Why a segment has a name, and not that of its nearest neighbours.

    Where none is near, what is said apart is why it has no more general name.
    """
    nodes = leading(reason)
    doubts = [each for each in nodes if each.atom.startswith(DOUBTED)]
    nodes = [each for each in nodes if each not in doubts]
    clauses = briefs.clauses(nodes)
    own = briefs.clauses([each for each in nodes if rank(each) == OWN])
    subjects = _subjects(nodes, briefs)
    against = [
        replace(each, though=tuple(clause for clause in each.though if clause not in clauses))
        for each in against
    ]
    known = [briefs.claims[each] for each in clauses if each in briefs.claims]
    if any(_goes(claim) for claim in known):  # the same angle keeps it from going the other way
        against = [each for each in against if not _goes(briefs.claims.get(each.clause))]
    fresh, alike = _told_contrasts(against, clauses, MOST_TOLD + (not own))
    apart = bool(generals and own) and not alike and all(each.weak for each in fresh)
    fresh = [] if apart else fresh
    beside = [f"just {listed(generals, 'or')}"] if apart else _names(alike)
    other = f", and not {listed(beside, 'or')}" * bool(beside)
    told = f"{name}{other}, because "
    if apart:
        more = [each for each in clauses if each not in own]
        told += _by_subject(own, subjects) + f". Also, {_by_subject(more, subjects)}" * bool(more)
    else:
        told += _by_subject(clauses, subjects)
    fresh = [_shortened(each, clauses, briefs) for each in fresh]
    for number, contrast in enumerate(fresh):
        told += f"{';' if number else '.'} {'n' if number else 'N'}ot {contrast.sentence}"
    said = [*clauses, *(clause for each in fresh for clause in each.clauses)]
    said += [clause for each in fresh for clause in each.though]
    every = (briefs.claims.get(each.removesuffix(BOTH)) for each in dict.fromkeys(said))
    claims = [each for each in every if each is not None]
    mended = briefs.clauses(doubts)
    claims += [briefs.claims[each] for each in mended if each in briefs.claims]
    told += f". For this, {listed(mended)}" * bool(mended)
    lost = briefs.lost(claims)
    told += "".join(f". {each.text[0].upper()}{each.text[1:]}" for each in lost)
    return Summary(f"{told}." + touching(nodes, briefs.clock), (*claims, *lost))


def _goes(claim: Claim | None) -> bool:
    """Whether a clause tells at which angle a thing went to what moved it."""
    return claim is not None and any(
        quantity.measure is Measure.BEARING for quantity in claim.quantities
    )


def _shortened(contrast: Contrast, clauses: Sequence[str], briefs: Briefs) -> Contrast:
    """A contrast without the numbers in brackets of clauses that the summary tells before."""
    short = {each: re.sub(r" \([^()]*\)", "", each) for each in contrast.clauses if each in clauses}
    for each, text in short.items():
        if each in briefs.claims:
            briefs.claims.setdefault(text, replace(briefs.claims[each], text=text))
    return replace(contrast, clauses=tuple(short.get(each, each) for each in contrast.clauses))


def _told_contrasts(
    against: Sequence[Contrast], clauses: Sequence[str], most: int
) -> tuple[list[Contrast], list[Contrast]]:
    """The contrasts that are told with reasons of their own, and those that need none.

    Names of the latter are denied by what the summary says of its own. Names of other features are
    told only where too few others are; so many are told at most.
    """
    fresh = [each for each in against if each.though or each.clause not in clauses]
    same = [each for each in against if each not in fresh and each.failing == 1]
    alike = [each for each in same if not each.by_features]
    near = [each for each in fresh if not each.by_features and not each.weak]
    fresh = near or [each for each in fresh if each.by_features]
    count = min(MOST_NAMES, sum(len(each.names) for each in alike))
    least = max(not alike, sum(bool(each.though) for each in fresh), bool(near))
    fresh = fresh[: max(most - count, least)]
    if count + len(fresh) < MOST_TOLD:
        others = [each for each in same if each not in alike]
        alike += others[: MOST_TOLD - count - len(fresh)]
    return fresh, alike


def _names(alike: Sequence[Contrast]) -> list[str]:
    """The names of contrasts that need no reason, and what was so though they are denied."""
    return [name for each in alike for name in each.names][:MOST_NAMES]


def _subjects(nodes: Iterable[Reason], briefs: Briefs) -> list[str]:
    """How clauses about the bodies that nodes name begin, the longest first."""
    bodies = {each for node in nodes for each in parsed(node.atom)[1]}
    hand = briefs.clock.own[4:].split(",")[0]
    called = {f"the {briefs.clock.called(each)} " for each in {*bodies, hand}}
    return sorted(called, key=lambda each: (-len(each), each))


def _by_subject(clauses: Sequence[str], subjects: Sequence[str]) -> str:
    """The clauses in one sentence, those about one body together."""
    groups: dict[str, list[str]] = {}
    for clause in clauses:
        subject = next((each for each in subjects if clause.startswith(each)), "")
        groups.setdefault(subject or clause, []).append(clause.removeprefix(subject))
    told = [
        subject + listed(said) if subject in subjects else subject
        for subject, said in groups.items()
    ]
    if any(" and " in each or "," in each for each in told) and len(told) > 1:
        return f"{'; '.join(told[:-1])}; and {told[-1]}"
    return listed(told)
