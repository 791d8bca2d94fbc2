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


def merged_contacts(nodes: Sequence[Reason], clock: Clock) -> dict[str, Told]:
    """What is told in place of each contact, or lack of one, at a border of the segment.

    A contact of which a part is doubted is told by its own sentence.
    """
    sides: dict[tuple[str, str], dict[str, tuple[str, str]]] = defaultdict(dict)
    atoms: dict[tuple[str, str], list[str]] = defaultdict(list)
    told: dict[str, Told] = {}
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
            told[each.atom] = "touched_before", arguments
        elif side:
            key = pair[0], pair[1]
            sides[key][side] = state
            atoms[key].append(each.atom)
    return told | {
        atom: (_name(found), (clock.own, *pair))
        for pair, found in sides.items()
        for atom in atoms[pair]
    }


def _name(found: dict[str, tuple[str, str]]) -> str:
    start, end = found.get("start", ("", "")), found.get("end", ("", ""))
    if start == end and start[1]:
        return "touches_throughout"
    return NAMES[start[0], end[0]]
