"""When atoms hold: the frames of a measurement, of a tick, or of a segment."""

from bisect import bisect_left, bisect_right
from collections import defaultdict
from collections.abc import Mapping, Sequence
from dataclasses import fields

from capar.model.facts import ALL_FACT_KINDS, Fact, FlickerCorrection, Observed
from capar_rules.borders.border_numbers import Tick
from capar_rules.borders.deflicker import Key, relation_of
from capar_rules.explain.clock import Clock

_KINDS: tuple[type[Fact], ...] = (*ALL_FACT_KINDS, Tick)
_FIELDS = {
    (each.predicate, len(fields(each))): tuple(field.name for field in fields(each))
    for each in _KINDS
}

STRETCHES = {
    each.predicate: sum(
        field.name not in ("first", "last", "gap", "taken") for field in fields(each)
    )
    for each in ALL_FACT_KINDS
    if {"first", "last"} <= {field.name for field in fields(each)}
}
"""Facts of what holds from frame to frame: how many of their first arguments say of what."""


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


def corrected(facts: Sequence[Fact]) -> frozenset[str]:
    """The contacts, motions and rests, as atoms, that contain frames corrected as flicker."""
    doubts: dict[Key, list[int]] = defaultdict(list)
    for each in facts:
        if isinstance(each, FlickerCorrection):
            doubts[each.taken, each.body, each.other].append(each.first)
    for frames in doubts.values():
        frames.sort()
    return frozenset(
        str(each) for each in facts if isinstance(each, Observed) and _has_doubt(each, doubts)
    )


def _has_doubt(fact: Observed, doubts: Mapping[Key, Sequence[int]]) -> bool:
    key = relation_of(fact)
    begins = doubts.get(key, ()) if key else ()
    return bool(begins) and bisect_left(begins, fact.ends()[0]) < bisect_right(
        begins, fact.ends()[1]
    )
