"""The summary of an explanation: the name's conditions, and what decided against neighbours."""

import re
from collections.abc import Collection, Iterable, Iterator, Sequence
from dataclasses import dataclass, replace

from capar_rules.explain.briefs import COURSES, Briefs
from capar_rules.explain.claimed_measures import Measure
from capar_rules.explain.claims import Claim
from capar_rules.explain.contrast.contrasts import (
    LEAST_NEARNESS,
    LEAST_SEEN,
    MOST_NAMES,
    MOST_TOLD,
)
from capar_rules.explain.contrast.deciding_clauses import BUT_FOR
from capar_rules.explain.contrast.told_contrast import Contrast, alternatives
from capar_rules.explain.joining import BOTH, listed
from capar_rules.explain.leading import DOUBTED, OWN, leading, parsed, rank
from capar_rules.explain.reason import Reason
from capar_rules.explain.touch_notes import touching


@dataclass(frozen=True)
class Summary:
    """Why a segment has a name, in a few sentences."""

    text: str
    claims: tuple[Claim, ...]
    """Its clauses, with what was measured for each."""

    names: tuple[str, ...]
    """The names of which it speaks, the segment's own first."""


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
    doubts = [node for node in nodes if node.atom.startswith(DOUBTED)]
    nodes = [node for node in nodes if node not in doubts]
    clauses = briefs.clauses(nodes)
    own = briefs.clauses([node for node in nodes if rank(node) == OWN])
    subjects = _subjects(nodes, briefs)
    beside, fresh = _told_contrasts(_against(against, clauses, briefs), clauses)
    more = [clause for clause in clauses if clause not in own]
    kind = bool(generals and own and more) and all(one.by_features for one in fresh)
    kind = kind and all(one.clause in own for one in beside)  # what denies them leads
    told = name + (f", a kind of {listed(generals)}," * bool(generals and not kind))
    if beside:
        told += f"{',' * (not told.endswith(','))} and not {_denied(beside)}"
    told += f"{',' * (not told.endswith(','))} because "
    told += _by_subject(own if kind else clauses, subjects)
    if kind:
        told += f". It is a kind of {listed(generals)}, because {_by_subject(more, subjects)}"
    fresh = [_shortened(contrast, clauses, briefs) for contrast in fresh]
    told += "".join(f". Not {contrast.sentence}" for contrast in fresh)
    said = [*clauses, *(clause for contrast in fresh for clause in contrast.clauses)]
    said += [clause for contrast in fresh for clause in contrast.though]
    every = (briefs.claims.get(clause.removesuffix(BOTH)) for clause in dict.fromkeys(said))
    claims = [known for known in every if known is not None]
    mended = briefs.clauses(doubts)
    claims += [briefs.claims[clause] for clause in mended if clause in briefs.claims]
    told += f". {_sentence(listed(mended))}" * bool(mended)
    extra = [*briefs.clear_of(claims), *briefs.fixed(claims), *briefs.also_reached(claims)]
    extra += briefs.leaning(reason)
    extra += briefs.lost([*claims, *extra])
    told += "".join(f". {_sentence(claim.text)}" for claim in extra)
    names = [name, *generals, *(other for one in (*beside, *fresh) for other in one.names)]
    text = f"{told}." + touching([*claims, *extra], briefs.clock)
    return Summary(text, (*claims, *extra), tuple(dict.fromkeys(names)))


def _denied(beside: Sequence[Contrast]) -> str:
    """The names of contrasts as one list, those that are kinds of another one behind it."""
    plain = [name for one in beside if not one.general for name in one.names]
    kinds = [alternatives(one.names, one.general) for one in beside if one.general]
    return alternatives([*plain, *kinds])


def _sentence(clause: str) -> str:
    return clause[:1].upper() + clause[1:]


def _against(against: Sequence[Contrast], clauses: Sequence[str], briefs: Briefs) -> list[Contrast]:
    """The contrasts, without what the summary says anyway."""
    known = [briefs.claims[clause] for clause in clauses if clause in briefs.claims]
    found = [
        replace(one, though=tuple(clause for clause in one.though if clause not in clauses))
        for one in against
    ]
    if any(_goes(claim) for claim in known):  # the same angle keeps it from going the other way
        found = [one for one in found if not _goes(briefs.claims.get(one.clause))]
    return [one for one in found if one.though or not _is_course(briefs.claims.get(one.clause))]


def _is_course(claim: Claim | None) -> bool:
    """Whether a clause tells but how a thing went, which by itself denies no other name."""
    return claim is not None and claim.of in COURSES


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
    against: Sequence[Contrast], clauses: Sequence[str]
) -> tuple[list[Contrast], list[Contrast]]:
    """The contrasts whose reason is among the name's own, and those that are told after it.

    Names of other features are told only where too few others are; each name is told once.
    """
    fresh = [one for one in against if one.though or one.clause not in clauses]
    alike = [one for one in against if one not in fresh and one.failing == 1]
    order = [one for one in fresh if not one.by_features and not one.weak]
    order += [one for one in alike if not one.by_features]
    features = [*(one for one in against if one.by_features and not one.direct)]
    features += [one for one in (*fresh, *alike) if one.by_features and one.direct]
    order = [*order, *features]
    order.sort(key=lambda one: (one.nearness < LEAST_SEEN) + (one.nearness < BUT_FOR))
    names = {name for one in order if one.though for name in one.names}
    beside, told = list(_beside(order, clauses, names)), list[Contrast]()
    names = {name for one in beside for name in one.names}
    order = [one for one in order if one.though or one.clause not in clauses]
    most = MOST_TOLD + any(contrast.though for contrast in order)
    for contrast in sorted(order, key=lambda one: not one.though):
        left = tuple(name for name in contrast.names if name not in names)
        left = left[:MOST_NAMES]
        alike_at = [at for at, one in enumerate(told) if one.clause == contrast.clause]
        if left and alike_at and not contrast.though and not told[alike_at[-1]].though:
            both = (*told[alike_at[-1]].names, *left)[:MOST_NAMES]
            names |= {*both}
            told[alike_at[-1]] = replace(told[alike_at[-1]], names=both)
        elif left and len(told) < most and not _idle(contrast, told=told, beside=beside):
            names |= {*left}
            told.append(replace(contrast, names=left))
    return beside, told


def _beside(
    order: Iterable[Contrast], clauses: Sequence[str], names: Collection[str]
) -> Iterator[Contrast]:
    """The contrasts whose reason is among the name's own, without names that are told apart."""
    told = {*names}
    for contrast in order:
        left = tuple(name for name in contrast.names if name not in told)
        left = left[: max(MOST_NAMES + len(names) - len(told), 0)]
        if left and contrast.clause in clauses and not contrast.though:
            told |= {*left}
            yield replace(contrast, names=left)


def _idle(contrast: Contrast, *, told: Sequence[Contrast], beside: Sequence[Contrast]) -> bool:
    """Whether nobody would ask for the names, where others are told, or denied by what is told."""
    least = LEAST_SEEN if told else LEAST_NEARNESS if beside and not contrast.below else 0.0
    return contrast.nearness < least and not contrast.though


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
