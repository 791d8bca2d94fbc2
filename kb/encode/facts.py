"""Facts as statements: each of the class and with the properties that its kind declares.

Bodies and agents are things; a fact of an interval has its frames and its seconds. Samples of one
quantity at frames are one thing, with a row of numbers.
"""

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field, fields
from decimal import Decimal
from functools import cache
from itertools import groupby
from typing import TYPE_CHECKING, Any, TypeAlias, cast

from pyoxigraph import Literal, NamedNode

from capar.model.facts import FactIntervals, MovedBy, Observed, RateMhz, Span
from kb.encode.bodies import Bodies
from kb.store import names
from kb.store.statements import PropertyValues, Statements, Value
from ontology import CAPAR

if TYPE_CHECKING:
    from capar.model.facts import Fact

BODIES = frozenset({CAPAR.body, CAPAR.other, CAPAR.one, CAPAR.seen})
"""The properties whose values are bodies."""

Properties: TypeAlias = dict[NamedNode, Value | Iterable[NamedNode] | Iterable[Literal]]

UNMOVED = "unknown"
"""How an object is moved that nothing moves."""


@dataclass(frozen=True)
class Scene:
    """What facts refer to: bodies, agents, and the rate, by which segments have their times too."""

    bodies: Bodies
    agents: Mapping[str, NamedNode]
    rate_hz: float
    more: Mapping[Any, PropertyValues] = field(default_factory=dict)
    """What else is known of some facts, by fact."""


@dataclass(frozen=True)
class FactForm:
    """How the facts of a kind stand in RDF."""

    kind: NamedNode
    properties: Mapping[str, NamedNode]
    """By field; of a sampled kind only those that name something."""

    powers: Mapping[str, int] = field(default_factory=dict)


def form(kind: "type[Fact]") -> FactForm:
    """The class, the properties and the powers of ten of a kind of fact."""
    return _form(cast(Any, kind))


@cache
def _form(kind: Any) -> FactForm:
    declared = kind.declaration
    cls, *predicates = (getattr(CAPAR, each) for each in declared.rdf)
    named = [each.name for each in fields(kind) if not declared.sampled or each.type is str]
    return FactForm(cls, dict(zip(named, predicates, strict=False)), declared.powers)


def rate_of(stated: "tuple[Fact, ...]", *, frames: int, duration_s: float) -> float:
    """The rate that the facts state [Hz], else that of so many frames in so long a time."""
    stated_hz = (each.rate / 1000.0 for each in stated if isinstance(each, RateMhz))
    return next(stated_hz, 0.0) or max(frames - 1, 1) / (duration_s or 1.0)


def facts(out: Statements, stated: "tuple[Fact, ...]", scene: Scene) -> list[NamedNode]:
    """Every fact; those of a sampled kind by what they are samples of."""
    observed = [each for each in stated if isinstance(each, Observed)]
    intervals = FactIntervals(observed)
    single = [each for each in observed if not each.declaration.sampled]
    sampled = [each for each in observed if each.declaration.sampled]
    nodes = [_fact(out, each, scene, intervals) for each in single]
    groups = groupby(sorted(sampled, key=_sampled_of), key=_sampled_of)
    return nodes + [_samples(out, list(each), scene) for _, each in groups]


def _fact(out: Statements, fact: Observed, scene: Scene, intervals: FactIntervals) -> NamedNode:
    known = form(type(fact))
    properties: Properties = {}
    values = {each: getattr(fact, each) for each in known.properties}
    for name, value in values.items():
        power = known.powers.get(name, 0)
        properties |= _property(known.properties[name], value, power, scene)
    if isinstance(fact, MovedBy):
        properties |= _mover(fact, scene)
    properties |= _times(fact, scene, intervals)
    properties |= scene.more.get(fact, {})
    return out.add(
        names.part(out.about, "fact", fact.predicate, *values.values()), (known.kind,), properties
    )


def _property(predicate: NamedNode, value: Any, power: int, scene: Scene) -> PropertyValues:
    if predicate in BODIES:
        return {predicate: scene.bodies[value]}
    if predicate == CAPAR.agent:
        return {predicate: scene.agents.get(value)}
    if predicate == CAPAR.mover:
        return {}
    return {predicate: float(Decimal(value).scaleb(power)) if power else value}


def _mover(fact: MovedBy, scene: Scene) -> PropertyValues:
    """The body or the agent that moves an object; else what is known of a motion without one."""
    if fact.how == UNMOVED:
        return {CAPAR.unmovedBecause: fact.mover}
    agent = scene.agents.get(fact.mover)
    return {CAPAR.mover: agent or scene.bodies[fact.mover]}


def _times(fact: Observed, scene: Scene, intervals: FactIntervals) -> PropertyValues:
    interval = intervals.of(fact)
    if interval is None:
        return {}
    first, last = interval
    if fact.declaration.span is Span.INSTANT:
        return {CAPAR.time: first / scene.rate_hz}
    return {
        CAPAR.lastFrame: last,
        CAPAR.start: first / scene.rate_hz,
        CAPAR.end: last / scene.rate_hz,
    }


def _sampled_of(fact: Observed) -> tuple[str, ...]:
    """The predicate of a fact, and what it is a sample of."""
    return fact.predicate, *(getattr(fact, each) for each in form(type(fact)).properties)


def _samples(out: Statements, samples: list[Observed], scene: Scene) -> NamedNode:
    known = form(type(samples[0]))
    properties: Properties = {}
    for name, predicate in known.properties.items():
        properties |= _property(predicate, getattr(samples[0], name), 0, scene)
    rows = sorted(samples, key=lambda each: each.ends())
    numbers = (str(number) for each in rows for number in sample(each))
    properties[CAPAR.samples] = Literal(" ".join(numbers), datatype=CAPAR.vector)
    node = names.part(out.about, "samples", *_sampled_of(samples[0]))
    return out.add(node, (known.kind,), properties)


def sample(fact: Observed) -> tuple[int, ...]:
    """The numbers of a sample, its frame first, the others in the order of its fields."""
    named = form(type(fact)).properties
    numbers = {
        each.name: getattr(fact, each.name)
        for each in fields(cast(Any, fact))
        if each.name not in named
    }
    return numbers.pop("frame"), *numbers.values()
