"""When atoms hold: the frames of a measurement, of a tick, or of a segment."""

from collections.abc import Sequence
from dataclasses import fields

from capar.model.facts import STATED, Fact
from capar_rules.ranking import Tick
from capar_rules.sentences import Clock

_KINDS: tuple[type[Fact], ...] = (*STATED, Tick)
_FIELDS = {
    (each.predicate, len(fields(each))): tuple(field.name for field in fields(each))
    for each in _KINDS
}


def frames_of(predicate: str, arguments: Sequence[str], clock: Clock) -> tuple[int, int] | None:
    """When a measurement holds; or the instant of a tick, or the span of a segment."""
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
