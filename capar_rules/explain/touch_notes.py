"""What a summary says of how near bodies are that it tells to touch, and of their shapes."""

from collections.abc import Iterable, Mapping, Sequence

from capar_rules.explain.briefs import listed
from capar_rules.explain.clock import Clock
from capar_rules.explain.leading import parsed
from capar_rules.explain.reaches import Between
from capar_rules.explain.reason import Reason


def touching(nodes: Iterable[Reason], clock: Clock) -> str:
    """Up to which distance bodies are counted as touching that are told to touch."""
    measured = clock.measured
    found: dict[tuple[bool, Between], dict[int, list[str]]] = {}
    bodies: list[str] = []
    for each in nodes:
        predicate, arguments = parsed(each.atom)
        if predicate in ("contact_at", "no_contact", "takes", "lets_go"):
            one, other = arguments[2:4] if predicate == "no_contact" else arguments[1:3]
            reach = measured.reaches.get((one, other))
            bodies += [one, other]
            if reach:
                pair = f"{clock.called(one)} to {clock.called(other)}"
                alike = found.setdefault((measured.near(one, other), reach.between), {})
                alike.setdefault(reach.told_mm, []).append(pair)
    several = sum(map(len, found.values())) > 1
    return "".join(
        _counted(told, several=several, near=near, between=between)
        for (near, between), told in found.items()
    ) + _stand_ins(bodies, clock)


def _stand_ins(bodies: Iterable[str], clock: Clock) -> str:
    """That contacts are uncertain of bodies whose true shape is not known."""
    shapes = clock.measured.stand_ins
    return "".join(
        f" The shape of the {clock.called(each)} is a stand-in ({shapes[each]}): when it "
        "touches is known only roughly."
        for each in dict.fromkeys(bodies)
        if each in shapes
    )


def _counted(
    found: Mapping[int, Sequence[str]], *, several: bool, near: bool, between: Between
) -> str:
    """What distances are between, by how many millimetres they are, of which pairs of bodies."""
    told = listed(
        [
            f"{reach} mm" + f" ({', '.join(dict.fromkeys(pairs))})" * several
            for reach, pairs in found.items()
        ]
    )
    if not near:
        return f" Contact is counted within {told}, {between.value}."
    return f" The {told} are {between.value}."
