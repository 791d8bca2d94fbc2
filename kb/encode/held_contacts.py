"""How long of a contact its end-effector possesses the thing, and how long the thing moves."""

from collections import defaultdict
from collections.abc import Iterable
from typing import TYPE_CHECKING, TypeAlias

from capar.model.facts import Moving, Touching
from kb.store.statements import PropertyValues
from ontology import CAPAR

if TYPE_CHECKING:
    from capar.model.observation import Observation

Span: TypeAlias = tuple[float, float]
"""From when to when [s]."""


def held_contacts(observation: "Observation", rate_hz: float) -> dict[Touching, PropertyValues]:
    """For each contact of an end-effector: the seconds of it that the thing is held, and moves."""
    held: dict[tuple[str, str], list[Span]] = defaultdict(list)
    for link in observation.links:
        for segment in link.segments:
            if segment.possessed and segment.objects:
                span = (segment.start_s, segment.end_s)
                held[segment.ee, segment.objects[0]].append(span)
    moved: dict[str, list[Span]] = defaultdict(list)
    for fact in observation.facts:
        if isinstance(fact, Moving):
            moved[fact.object].append((fact.first / rate_hz, fact.last / rate_hz))
    effectors = {link.ee for link in observation.links}
    found: dict[Touching, PropertyValues] = {}
    for fact in observation.facts:
        if isinstance(fact, Touching) and fact.body in effectors:
            contact = (fact.first / rate_hz, fact.last / rate_hz)
            found[fact] = {
                CAPAR.heldFor: shared(contact, held[fact.body, fact.other]),
                CAPAR.movedFor: shared(contact, moved[fact.other]),
            }
    return found


def shared(of: Span, spans: Iterable[Span]) -> float:
    """How long of a time lies in others that do not overlap each other [s]."""
    return sum(max(min(of[1], end) - max(of[0], start), 0.0) for start, end in spans)
