"""What a summary says of when bodies count as in contact, and of shapes that stand in."""

from collections.abc import Iterable, Mapping, Sequence

from capar_rules.explain.briefs import listed
from capar_rules.explain.claimed_measures import ANY, Measure
from capar_rules.explain.claims import Claim
from capar_rules.explain.clock import Clock
from capar_rules.explain.reaches import Reach

OF_CONTACT = (Measure.DISTANCE, Measure.BORNE)
"""What is measured of two bodies where their contact is told."""


def touching(claims: Iterable[Claim], clock: Clock) -> str:
    """Up to which distance bodies are counted as touching whose contact is told."""
    found: dict[str, dict[str, list[str]]] = {}
    bodies: list[str] = []
    for one, other in _pairs(claims):
        reach = clock.measured.reaches.get((one, other))
        if reach:
            pair = f"{clock.called(one)} to {clock.called(other)}"
            between = _between(reach, clock)
            found.setdefault(between, {}).setdefault(reach.told, []).append(pair)
        bodies += [one, other]
    several = sum(map(len, found.values())) > 1
    told = [
        _counted(reaches, between, several=several) for between, reaches in found.items() if reaches
    ]
    counted = f" Contact is counted {'; '.join(told)}." if told else ""
    return counted + _stand_ins(bodies, clock)


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
    return reach.between.value + f", as {listed(called)} {has}" * bool(called)


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
