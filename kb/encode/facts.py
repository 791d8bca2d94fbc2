"""Facts as statements and back: each of the class and with the properties its kind declares.

Bodies and agents are things; a fact of an interval has its frames and its seconds. Samples of one
quantity at frames are one thing, with a row of numbers.
"""

from collections import defaultdict
from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import dataclass, field, fields
from decimal import Decimal
from functools import cache
from itertools import groupby
from typing import TYPE_CHECKING, Any, TypeAlias, cast

from pyoxigraph import Literal, NamedNode

from capar.model.facts import (
    ALL_FACT_KINDS,
    Fact,
    FactIntervals,
    MovedBy,
    Moving,
    Observed,
    RateMhz,
    Span,
    Touching,
)
from kb.store import names
from kb.store.sparql import stored
from kb.store.statements import TYPE, PropertyValues, Statements, Value
from kb.store.stores import Store
from ontology import CAPAR

if TYPE_CHECKING:
    from capar.model.observation import Observation

BODIES = frozenset({CAPAR.body, CAPAR.other, CAPAR.one, CAPAR.seen})
"""The properties whose values are bodies."""

Properties: TypeAlias = dict[NamedNode, Value | Iterable[NamedNode] | Iterable[Literal]]
Interval: TypeAlias = tuple[float, float]
"""Start and end [s]."""

UNMOVED = "unknown"
"""How an object is moved that nothing moves."""


@dataclass(frozen=True)
class Scene:
    """What facts refer to."""

    bodies: Callable[[str], list[NamedNode]]
    """The things of a body's name."""

    agents: Mapping[str, NamedNode]
    rate_hz: float
    more: Mapping[Any, PropertyValues] = field(default_factory=dict)
    """Further properties of some facts, by fact."""


def _form(kind: Any) -> tuple[NamedNode, dict[str, NamedNode]]:
    """The class of a kind of fact, and its properties by field; of samples those with names."""
    return _cached_form(kind)  # type checkers take a class with a declared hash for unhashable


@cache
def _cached_form(kind: Any) -> tuple[NamedNode, dict[str, NamedNode]]:
    declared = kind.declaration
    cls, *predicates = (getattr(CAPAR, each) for each in declared.rdf)
    named = [each.name for each in fields(kind) if not declared.sampled or each.type is str]
    return cls, dict(zip(named, predicates, strict=False))


def _columns(kind: Any) -> list[str]:
    """The fields of a sampled kind that are numbers, the frame first."""
    named = _form(kind)[1]
    return ["frame", *(e.name for e in fields(kind) if e.name not in {*named, "frame"})]


def rate_of(stated: tuple[Fact, ...], *, frames: int, duration_s: float) -> float:
    """The rate that the facts state [Hz], else frames by duration."""
    stated_hz = (each.rate / 1000.0 for each in stated if isinstance(each, RateMhz))
    return next(stated_hz, 0.0) or max(frames - 1, 1) / (duration_s or 1.0)


def facts(out: Statements, stated: tuple[Fact, ...], scene: Scene) -> list[NamedNode]:
    """Every fact; those of a sampled kind by what they are samples of."""
    observed = [each for each in stated if isinstance(each, Observed)]
    intervals = FactIntervals(observed)
    nodes = [
        _fact(out, each, scene, intervals.of(each))
        for each in observed
        if not each.declaration.sampled
    ]
    sampled = sorted((e for e in observed if e.declaration.sampled), key=_sampled_of)
    return nodes + [_samples(out, list(e), scene) for _, e in groupby(sampled, key=_sampled_of)]


def _fact(
    out: Statements, fact: Observed, scene: Scene, interval: tuple[int, int] | None
) -> NamedNode:
    cls, predicates = _form(type(fact))
    properties: Properties = {}
    values = {each: getattr(fact, each) for each in predicates}
    for name, value in values.items():
        power = fact.declaration.powers.get(name, 0)
        properties |= _property(predicates[name], value, power, scene)
    if isinstance(fact, MovedBy):
        if fact.how == UNMOVED:
            properties[CAPAR.unmovedBecause] = fact.mover
        else:
            agent = scene.agents.get(fact.mover)
            properties[CAPAR.mover] = agent or scene.bodies(fact.mover)
    if interval is not None:
        first, last = interval
        if fact.declaration.span is Span.INSTANT:
            properties[CAPAR.time] = first / scene.rate_hz
        else:
            properties[CAPAR.lastFrame] = last
            properties[CAPAR.start] = first / scene.rate_hz
            properties[CAPAR.end] = last / scene.rate_hz
    properties |= scene.more.get(fact, {})
    node = names.part(out.about, "fact", fact.predicate, *values.values())
    return out.add(node, (cls,), properties)


def _property(predicate: NamedNode, value: Any, power: int, scene: Scene) -> PropertyValues:
    if predicate in BODIES:
        return {predicate: scene.bodies(value)}
    if predicate == CAPAR.agent:
        return {predicate: scene.agents.get(value)}
    if predicate == CAPAR.mover:
        return {}
    return {predicate: float(Decimal(value).scaleb(power)) if power else value}


def _sampled_of(fact: Observed) -> tuple[str, ...]:
    """The predicate of a fact, and what it is a sample of."""
    return fact.predicate, *(getattr(fact, each) for each in _form(type(fact))[1])


def _samples(out: Statements, samples: list[Observed], scene: Scene) -> NamedNode:
    kind = type(samples[0])
    cls, predicates = _form(kind)
    properties: Properties = {}
    for name, predicate in predicates.items():
        properties |= _property(predicate, getattr(samples[0], name), 0, scene)
    rows = sorted(samples, key=lambda each: each.ends())
    numbers = (str(getattr(row, name)) for row in rows for name in _columns(kind))
    properties[CAPAR.samples] = Literal(" ".join(numbers), datatype=CAPAR.vector)
    node = names.part(out.about, "samples", *_sampled_of(samples[0]))
    return out.add(node, (cls,), properties)


def held_contacts(observation: "Observation", rate_hz: float) -> dict[Touching, PropertyValues]:
    """For each contact of an end-effector: how long of it the object is held, and moves [s]."""
    held: dict[tuple[str, str], list[Interval]] = defaultdict(list)
    for segment in observation.segments:
        if segment.possessed and segment.objects:
            held[segment.ee, segment.objects[0]].append((segment.start_s, segment.end_s))
    moved: dict[str, list[Interval]] = defaultdict(list)
    for fact in observation.facts:
        if isinstance(fact, Moving):
            moved[fact.object].append((fact.first / rate_hz, fact.last / rate_hz))
    effectors = {link.ee for link in observation.links}
    found: dict[Touching, PropertyValues] = {}
    for fact in observation.facts:
        if isinstance(fact, Touching) and fact.body in effectors:
            contact = (fact.first / rate_hz, fact.last / rate_hz)
            found[fact] = {
                CAPAR.heldFor: overlap_s(contact, held[fact.body, fact.other]),
                CAPAR.movedFor: overlap_s(contact, moved[fact.other]),
            }
    return found


def overlap_s(of: Interval, others: Iterable[Interval]) -> float:
    """How long of an interval lies in others, which do not overlap each other [s]."""
    return sum(max(min(of[1], end) - max(of[0], start), 0.0) for start, end in others)


# Back from a store


def stored_facts(store: Store, name: str) -> tuple[Fact, ...]:
    """What was measured in the capture of an observation, in the order of the extractors.

    What moves what is left out, as that is derived; so are kinds of facts that this program does
    not measure.
    """
    of_class = {_form(each)[0]: each for each in ALL_FACT_KINDS if each is not MovedBy}
    kinds: dict[object, Any] = {}
    said: dict[object, dict[NamedNode, str]] = defaultdict(dict)
    for fact, key, value, called in store.ask(
        stored("facts", graph=str(names.observation(name)))
    ).rows:
        if key == TYPE and value in of_class:
            kinds[fact] = of_class[cast(NamedNode, value)]
        elif isinstance(key, NamedNode):
            text = called if isinstance(called, Literal) else value
            said[fact][key] = text.value if isinstance(text, Literal) else ""
    found = (each for node, kind in kinds.items() for each in _decoded(kind, said[node]))
    return in_order(found)


def in_order(stated: Iterable[Fact]) -> tuple[Fact, ...]:
    """Facts in the order of the extractors."""
    rank: dict[object, int] = {each: index for index, each in enumerate(ALL_FACT_KINDS)}
    return tuple(sorted(stated, key=lambda each: (rank[type(each)], each)))


def _decoded(kind: Any, said: Mapping[NamedNode, str]) -> Iterator[Fact]:
    texts = {name: said[predicate] for name, predicate in _form(kind)[1].items()}
    if kind.declaration.sampled:
        numbers = [int(each) for each in said[CAPAR.samples].split()]
        columns = _columns(kind)
        for at in range(0, len(numbers), len(columns)):
            row = dict(zip(columns, numbers[at : at + len(columns)], strict=True))
            yield kind(**texts, **row)
        return
    values: dict[str, object] = {}
    for each in fields(kind):
        power = kind.declaration.powers.get(each.name, 0)
        text = texts[each.name]
        values[each.name] = text
        if each.type is int:
            values[each.name] = round(float(text) * 10**-power) if power else int(text)
    yield kind(**values)
