"""Contacts of two bodies at both borders of a segment, told as one."""

from collections import defaultdict
from collections.abc import Sequence

from capar_rules.engine.syntax import split_arguments
from capar_rules.explain.clock import Clock
from capar_rules.explain.reason import Reason

Told = tuple[str, Sequence[str]]
"""A predicate of summaries, and its arguments."""

NAMES = {
    ("touch", "touch"): "touches_again",
    ("none", "touch"): "comes_to_touch",
    ("touch", "none"): "ceases_to_touch",
    ("none", "none"): "never_touches",
    ("touch", ""): "touches_at_start",
    ("", "touch"): "touches_at_end",
    ("none", ""): "touches_not_at_start",
    ("", "none"): "touches_not_at_end",
}
"""What is told of a pair, by what was so at the start and at the end."""

NEAR = {
    "touches_throughout": "near_throughout",
    "touches_again": "near_again",
    "comes_to_touch": "comes_near",
    "ceases_to_touch": "ceases_to_be_near",
    "never_touches": "never_near",
    "touches_at_start": "near_at_start",
    "touches_at_end": "near_at_end",
    "touches_not_at_start": "not_near_at_start",
    "touches_not_at_end": "not_near_at_end",
}
"""The same of a pair that may be some way apart while it counts as touching."""


def merged_contacts(nodes: Sequence[Reason], clock: Clock) -> dict[str, Told]:
    """What is told in place of each contact, or lack of one, at a border of the segment.

    A contact of which a part is doubted is told by its own sentence.
    """
    sides: dict[tuple[str, str], dict[str, tuple[str, str]]] = defaultdict(dict)
    atoms: dict[tuple[str, str], list[str]] = defaultdict(list)
    told: dict[str, Told] = {}

    def near(pair: Sequence[str]) -> bool:
        return clock.measured.near(pair[0], pair[1])

    for each in nodes:
        arguments = split_arguments(each.atom) if "(" in each.atom else []
        if each.atom.startswith("no_contact("):
            _, side, *pair = arguments
            state = "none", ""
        elif each.atom.startswith("contact_at(") and "was taken to" not in each.sentence:
            hand, *pair, since, tick = arguments
            side, state = clock.side(hand, int(tick)), ("touch", since)
        else:
            continue
        if side == "before":
            told[each.atom] = "near_before" * near(pair) or "touched_before", arguments
        elif side:
            key = pair[0], pair[1]
            sides[key][side] = state
            atoms[key].append(each.atom)
    return told | {
        atom: (NEAR[_name(found)] if near(pair) else _name(found), (clock.own, *pair))
        for pair, found in sides.items()
        for atom in atoms[pair]
    }


def _name(found: dict[str, tuple[str, str]]) -> str:
    start, end = found.get("start", ("", "")), found.get("end", ("", ""))
    if start == end and start[1]:
        return "touches_throughout"
    return NAMES[start[0], end[0]]
