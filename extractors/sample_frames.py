"""Frames at which rules may draw a border, for each body whose place matters there."""

from bisect import bisect_left, bisect_right
from collections import defaultdict
from collections.abc import Iterable, Mapping, Sequence

from capar.model.facts import Fact, Observed, Touching

FramesByBody = Mapping[str, Sequence[int]]
"""Frames by body, ascending."""


def boundary_frames(facts: Iterable[Fact], acting: Iterable[str], last_frame: int) -> FramesByBody:
    """For each end-effector every frame where something that concerns it begins or ends.

    For each object that it touches, those of these frames at which it touches it, with the one
    before and the one after.

    Args:
        facts: Intervals and instants that were measured.
        acting: The end-effectors.
        last_frame: The capture's last frame.
    """
    frames: dict[str, set[int]] = defaultdict(set)
    touches: dict[str, list[Touching]] = defaultdict(list)
    for fact in facts:
        if isinstance(fact, Observed) and fact.declaration.border:
            frames[fact.subject()].update(fact.ends())
        if isinstance(fact, Touching):
            touches[fact.body].append(fact)
    out: dict[str, set[int]] = defaultdict(set)
    for ee in acting:
        own = {0, last_frame} | frames[ee]
        for name in {each.other for each in touches[ee]}:
            own |= frames[name]
        out[ee] |= own
        ordered = sorted(own)
        for touch in touches[ee]:
            out[touch.other].update(_around(ordered, touch.first, touch.last))
    return {name: tuple(sorted(out[name])) for name in sorted(out)}


def _around(ordered: Sequence[int], first: int, last: int) -> Sequence[int]:
    low = max(bisect_left(ordered, first) - 1, 0)
    return ordered[low : bisect_right(ordered, last) + 1]
