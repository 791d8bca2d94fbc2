"""When atoms hold: the frames of a measurement, of a tick, or of a segment."""

from bisect import bisect_left, bisect_right
from collections import defaultdict
from collections.abc import Iterable, Sequence
from dataclasses import fields

from capar.model.facts import STATED, Doubted, Fact, Moving, Resting, Touching
from capar_rules.borders.ranking import Tick
from capar_rules.explain.sentences import Clock

_KINDS: tuple[type[Fact], ...] = (*STATED, Tick)
_FIELDS = {
    (each.predicate, len(fields(each))): tuple(field.name for field in fields(each))
    for each in _KINDS
}


def frames_of(predicate: str, arguments: Sequence[str], clock: Clock) -> tuple[int, int] | None:
    """First and last frame of a measurement, a tick or a segment; None for other atoms."""
    names = _FIELDS.get((predicate, len(arguments)), ())
    named = dict(zip(names, arguments, strict=False))
    if "first" in named:
        return int(named["first"]), int(named.get("last", named["first"]))
    if "frame" in named:
        return int(named["frame"]), int(named["frame"])
    for each in arguments:
        span = clock.span(each)
        if span is not None:
            return span
    return None


def mended(facts: Iterable[Fact]) -> frozenset[str]:
    """The contacts, motions and rests, as atoms, that contain doubted frames."""
    doubts: dict[tuple[str, str, str], list[int]] = defaultdict(list)
    spans: list[tuple[tuple[str, str, str], Touching | Moving | Resting]] = []
    for each in facts:
        if isinstance(each, Doubted):
            doubts[each.taken, each.body, each.other].append(each.first)
        elif isinstance(each, Touching):
            spans.append((("touching", each.body, each.other), each))
        elif isinstance(each, Moving):
            spans.append((("moving", each.object, each.object), each))
        elif isinstance(each, Resting):
            spans.append((("resting", each.ee, each.ee), each))
    for frames in doubts.values():
        frames.sort()
    return frozenset(
        str(each)
        for key, each in spans
        if bisect_left(doubts.get(key, ()), each.first)
        < bisect_right(doubts.get(key, ()), each.last)
    )
