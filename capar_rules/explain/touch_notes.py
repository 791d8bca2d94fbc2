"""What a summary says of when bodies count as in contact, and of shapes that stand in."""

from collections.abc import Iterable, Mapping, Sequence

from capar_rules.explain.arrangements import hand_of
from capar_rules.explain.briefs import TOUCHING_NOTHING
from capar_rules.explain.claimed_measures import ANY, Measure
from capar_rules.explain.claims import Claim
from capar_rules.explain.clock import Clock
from capar_rules.explain.joining import listed
from capar_rules.explain.quantities import gap, length, spread
from capar_rules.explain.reaches import Reach

BEYOND = "at moments up to"
"""How a contact throughout the segment is told in which bodies were further apart for moments."""

SETTLED = (
    ", from when the hand has all but stopped coming nearer, or the thing counts as moving, until "
    "the hand goes away for good"
)
"""How contact is told to last for which only an estimated distance is known."""

BORDER = 2
"""So many frames beside a contact are left out where bodies are sought that do not touch [1]."""

OF_CONTACT = (Measure.DISTANCE, Measure.BORNE)
"""What is measured of two bodies where their contact is told."""


def touching(claims: Iterable[Claim], clock: Clock) -> str:
    """Up to which distance bodies are counted as touching whose contact is told."""
    claims = list(claims)
    found: dict[str, dict[str, list[str]]] = {}
    bodies: list[str] = []
    for one, other in _pairs(claims):
        reach = clock.measured.reaches.get((one, other))
        if reach:
            pair = f"{clock.called(one)} to {clock.called(other)}"
            between = _between(reach, clock)
            found.setdefault(between, {}).setdefault(reach.told, []).append(pair)
        bodies += [one, other]
    if not found and any(claim.of in TOUCHING_NOTHING for claim in claims):
        hand = hand_of(clock.own)
        own = [reach for (one, _), reach in sorted(clock.measured.reaches.items()) if one == hand]
        if len({(reach.told, _between(reach, clock)) for reach in own}) == 1:
            found[_between(own[0], clock).replace("their surfaces", "surfaces")] = {own[0].told: []}
            bodies.append(hand)
    several = sum(map(len, found.values())) > 1
    told = [
        _counted(reaches, between, several=several) for between, reaches in found.items() if reaches
    ]
    counted = f" Contact is counted {'; '.join(told)}." if told else ""
    beside = _bridged(claims, clock) + _passed_by(claims, clock)
    return counted + beside + _stand_ins(bodies, clock)


def _bridged(claims: Iterable[Claim], clock: Clock) -> str:
    """Which bodies were further apart at moments within a contact that is not told throughout."""
    told = "".join(claim.text for claim in claims)
    found: list[str] = []
    for one, other in _pairs(claims):
        far, reach = _farthest(one, other, clock), clock.measured.reaches.get((one, other))
        if reach is None or far is None or 1000.0 * far <= reach.told_mm or BEYOND in told:
            continue
        called = f"the {clock.called(one)} and the {clock.called(other)}"
        found.append(f"{called} were up to {spread(far)} apart")
    gaps = clock.closed_gaps
    return f" At moments within the contact {listed(found)}{gaps}." if found else ""


def _passed_by(claims: Iterable[Claim], clock: Clock) -> str:
    """Which bodies came within the distance of contact, and did not count as in contact."""
    found: list[str] = []
    for one, other in _pairs(claims):
        near, reach = _nearest(one, other, clock), clock.measured.reaches.get((one, other))
        if reach is None or near is None or reach.settles:
            continue
        if near <= min(reach.begin_m, reach.distance_m):
            called = f"the {clock.called(one)} and the {clock.called(other)}"
            found.append(f"{called} were only {gap(near)} apart")
    rule = f"what passes by, or lasts {clock.measured.brief_frames}, is no contact"
    return f" At moments without contact {listed(found)}: {rule}." if found else ""


def _nearest(one: str, other: str, clock: Clock) -> float | None:
    """How far two bodies are apart at least in the segment, where they do not touch [m]."""
    known, span = clock.measured, clock.span(clock.own)
    if span is None or known.apart is None:
        return None
    every = sorted([*known.contacts.get((one, other), ()), *known.contacts.get((other, one), ())])
    parts, begin = [], span[0]
    for first, last in every:
        if last >= span[0] and first <= span[1]:
            parts.append((begin, first - BORDER))
            begin = max(begin, last + BORDER)
    parts.append((begin, span[1]))
    found = [known.apart(one, other, *part) for part in parts if part[0] < part[1]]
    return min((near[0] for near in found if near is not None), default=None)


def _farthest(one: str, other: str, clock: Clock) -> float | None:
    """How far two bodies are apart at most while they count as touching in the segment [m]."""
    known, span = clock.measured, clock.span(clock.own)
    if span is None or known.apart is None:
        return None
    every = [*known.contacts.get((one, other), ()), *known.contacts.get((other, one), ())]
    parts = [(max(first, span[0]), min(last, span[1])) for first, last in every]
    found = [known.apart(one, other, *part) for part in parts if part[0] < part[1]]
    return max((far[1] for far in found if far is not None), default=None)


def _pairs(claims: Iterable[Claim]) -> list[tuple[str, str]]:
    """The pairs of bodies whose contact claims tell, each once."""
    pairs: dict[frozenset[str], tuple[str, str]] = {}
    for claim in claims:
        for quantity in claim.quantities:
            if quantity.measure in OF_CONTACT and ANY not in quantity.bodies:
                one, other = quantity.bodies
                pairs.setdefault(frozenset((one, other)), (one, other))
    return list(pairs.values())


def _between(reach: Reach, clock: Clock) -> str:
    """What of two bodies their distance is between, and which of them has no known shape."""
    called = [f"the {clock.called(name)}" for name in reach.unshaped]
    has = "has no known shape" if len(called) == 1 else "have no known shapes"
    unshaped = f", as {listed(called)} {has}" * bool(called)
    outlying = [
        f"that of the {clock.called(name)} lies {length(far)} {where}"
        for name, where, far in reach.outlying
    ]
    outlying += [
        f"{length(far)} from the origin of the {clock.called(name)}" for name, far in reach.offsets
    ]
    aside = f" ({listed(outlying)})" * bool(outlying)
    return reach.between.value + aside + unshaped + SETTLED * reach.settles


def _counted(reaches: Mapping[str, Sequence[str]], between: str, *, several: bool) -> str:
    """Within what contact is counted, of which pairs of bodies, and between what of them."""
    told = [within + f" ({', '.join(pairs)})" * several for within, pairs in reaches.items()]
    return f"{listed(told)}, {between}"


def _stand_ins(bodies: Iterable[str], clock: Clock) -> str:
    """That contacts are uncertain of bodies whose true shape is not known."""
    shapes: dict[str, list[str]] = {}
    for body in dict.fromkeys(bodies):
        if body in clock.measured.stand_ins:
            shapes.setdefault(clock.measured.stand_ins[body], []).append(body)
    if not shapes:
        return ""
    told = []
    for shape, alike in shapes.items():
        called = [f"the {clock.called(body)}" for body in alike]
        told.append(f"{listed(called)} ({shape}{' each' * (len(alike) > 1)})")
    several = sum(map(len, shapes.values())) > 1
    are = "Shapes are assumed for" if several else "A shape is assumed for"
    return f" {are} {listed(told)}, so contact is known only roughly."
