"""Facts as statements: each has its predicate as its class, and its arguments by name."""

from dataclasses import fields
from functools import cache
from typing import TYPE_CHECKING, Any, cast

from pyoxigraph import NamedNode

from kb.encode.scene import DERIVED
from kb.store import names
from kb.store.statements import Statements, Value
from ontology import CAPAR

if TYPE_CHECKING:
    from capar.model.facts import Fact

CLASSES = {
    "frames": CAPAR.FramesFact,
    "rate_mhz": CAPAR.RateFact,
    "link": CAPAR.LinkFact,
    "tag": CAPAR.TagFact,
    "zero_crossing": CAPAR.ZeroCrossing,
    "touching": CAPAR.Touching,
    "gap": CAPAR.Gap,
    "moving": CAPAR.Moving,
    "looking_at": CAPAR.LookingAt,
    "force_transfer": CAPAR.ForceTransfer,
    "intended": CAPAR.Intended,
}
"""The class of each predicate that extractors state; others are plainly facts."""

PROPERTIES = {
    "first": CAPAR.firstFrame,
    "last": CAPAR.lastFrame,
    "frame": CAPAR.frame,
    "ee": CAPAR.ee,
    "kind": CAPAR.effectorType,
    "side": CAPAR.side,
    "body": CAPAR.body,
    "other": CAPAR.other,
    "object": CAPAR.objectName,
    "sensor": CAPAR.sensor,
    "type": CAPAR.tagName,
    "rate": CAPAR.rateMhz,
    "micrometres": CAPAR.micrometres,
    "rank": CAPAR.rank,
    "action": CAPAR.actionName,
    "goal": CAPAR.goalName,
    "purpose": CAPAR.purpose,
}
"""The property of each argument."""


def facts(out: Statements, stated: "tuple[Fact, ...]", capture: NamedNode) -> list[NamedNode]:
    """Every fact, derived from its capture."""
    return [_fact(out, each, capture) for each in stated]


@cache
def _arguments(kind: Any) -> tuple[str, ...]:
    return tuple(each.name for each in fields(kind))


def _fact(out: Statements, fact: "Fact", capture: NamedNode) -> NamedNode:
    arguments = {each: getattr(fact, each) for each in _arguments(cast(Any, type(fact)))}
    kind = CLASSES.get(fact.predicate)
    said: dict[NamedNode, Value] = {}
    if kind:
        said = {PROPERTIES[name]: value for name, value in arguments.items()}
    else:
        said[CAPAR.name] = fact.predicate
        said[CAPAR.parameters] = " ".join(map(str, arguments.values()))
    said[DERIVED] = capture
    node = names.part(out.about, "fact", fact.predicate, *arguments.values())
    return out.say(node, (kind or CAPAR.Fact,), said)
