"""Observations and their facts as statements of RDF."""

import hashlib
import json
import os
import platform
from collections import defaultdict
from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import dataclass, field, fields
from datetime import UTC, datetime
from decimal import Decimal
from functools import cache
from itertools import groupby
from typing import TYPE_CHECKING, Any, TypeAlias, cast

from pyoxigraph import Literal, NamedNode, Quad

from capar.model.capture import recorded_at
from capar.model.errors import UnknownNameError
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
from capar.model.json_form import document
from capar.model.observation import SegmentAddress
from kb.encode import pars, shared
from kb.encode.shared import ASSOCIATED, BROADER, DERIVED, ENDED, GENERATED, USED, kind_of
from kb.store import names, statements
from kb.store.sparql import stored
from kb.store.statements import LABEL, TYPE, PropertyValues, Statements, Value, same
from kb.store.stores import Store
from ontology import CAPAR
from ontology.namespace import PREFIXES, RDF, TIME, XSD

if TYPE_CHECKING:
    from capar.model.capture import Agent
    from capar.model.observation import Border, JointAction, Observation, ObservedObject, Segment


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


THESIS = "thesis"
"""The profile in which damping is the thesis's."""

UNNAMED = "agent"
"""The name of an agent that nobody named."""

OF_INTEREST = NamedNode(PREFIXES["sosa"] + "hasFeatureOfInterest")
MEETS = NamedNode(TIME + "intervalMeets")
JSON = NamedNode(RDF + "JSON")
TAGS = {"self": CAPAR.Self, "fixed": CAPAR.Fixed, "mobile": CAPAR.Mobile}

BORDER_KINDS = {
    "first": CAPAR.CaptureBegins,
    "last": CAPAR.CaptureEnds,
    "begins": CAPAR.ContactBegins,
    "ends": CAPAR.ContactEnds,
    "starts_moving": CAPAR.StartsMoving,
    "stops_moving": CAPAR.StopsMoving,
    "turns": CAPAR.Turns,
    "comes_to_rest": CAPAR.ComesToRest,
    "leaves_rest": CAPAR.LeavesRest,
    "reverses": CAPAR.Reverses,
    "levels": CAPAR.Levels,
    "begins_swinging": CAPAR.BeginsSwinging,
    "ends_swinging": CAPAR.EndsSwinging,
    "tips": CAPAR.Tips,
    "rights": CAPAR.Rights,
    "begins_looking": CAPAR.BeginsLooking,
    "ends_looking": CAPAR.EndsLooking,
    "shifts_weight": CAPAR.ShiftsWeight,
}
"""What may happen at a border, by the word that observations use for it."""


RELATIONS = {
    "same_action": CAPAR.sameAction,
    "resumes": CAPAR.resumes,
    "fragment_of": CAPAR.fragmentOf,
    "rights": CAPAR.rights,
    "steadies": CAPAR.steadies,
}
"""How a segment stands to another one, by the word that observations use for it."""


def encode(observation: "Observation", *, name: str | None = None) -> Statements:
    """Everything that an observation says.

    Args:
        observation: What was understood of a capture.
        name: What its complex action is called; by default what the observation calls it.

    Raises:
        LiteralError: A number that is not finite.
        ParError: Steps that are related but not there.
    """
    return _Encoder(observation).whole(name or observation.complex_par.name or observation.capture)


def identity(observation: "Observation") -> str:
    """A digest by which the same capture is known again, whatever rules read it."""
    sources = sorted(each.sha256 for each in observation.sources)
    scene = (observation.agent.name, observation.frames, observation.rate_hz, sources)
    others = tuple(each.name for each in observation.others)
    return hashlib.sha256(repr((*scene, *others)).encode()).hexdigest()


class _Encoder:
    """Each method states one kind of thing and returns its nodes."""

    def __init__(self, observation: "Observation") -> None:
        self.seen = observation
        self.out = Statements(names.observation(observation.capture))
        self.about = self.out.about
        self.agents = {
            each.name: self.agent(each.name) for each in (observation.agent, *observation.others)
        }
        self.objects = {each.name: self.object(each) for each in observation.objects}
        self.kinds = {each.name: kind_of(each) for each in observation.objects}
        self.links = {
            link.ee: self.add(
                CAPAR.Link,
                "link",
                link.ee,
                {
                    **same(link, "ee side"),
                    CAPAR.name: link.ee,
                    CAPAR.effectorType: link.kind,
                    CAPAR.agent: self.performer(link.ee),
                },
            )
            for link in observation.links
        }

    def add(
        self, kind: NamedNode, word: str, key: str | int, properties: PropertyValues
    ) -> NamedNode:
        """Add a thing of the observation, named by a word and a key."""
        return self.out.add(names.part(self.about, word, key), (kind,), properties)

    def whole(self, called: str) -> Statements:
        """Everything."""
        out, seen = self.out, self.seen
        capture = self.capture()
        performer, *_ = [
            self.performance(each, number) for number, each in enumerate((seen.agent, *seen.others))
        ]
        rate_hz = rate_of(seen.facts, frames=seen.frames, duration_s=seen.duration_s)
        contacts = held_contacts(seen, rate_hz)
        world = Scene(self.bodies, self.agents, rate_hz, contacts)
        pars.complex_par(out, seen, called)
        base = shared.rule_base(out, seen.rules)
        rules = {each.name: shared.rule(out, each) for each in seen.naming}
        for upar in seen.upars:
            pars.upar(out, upar)
        properties: PropertyValues = {
            LABEL: seen.capture,
            CAPAR.capture: capture,
            USED: [capture, base],
            ASSOCIATED: list(self.agents.values()),
            OF_INTEREST: list(self.objects.values()),
            CAPAR.ruleBase: base,
            **same(seen, "profile version"),
            CAPAR.identity: identity(seen),
            CAPAR.performer: performer,
            CAPAR.agent: self.agents[seen.agent.name],
            CAPAR.object: list(self.objects.values()),
            CAPAR.link: list(self.links.values()),
            CAPAR.segment: [
                self.segment(each, len(link.segments), rules)
                for link in seen.links
                for each in link.segments
            ],
            CAPAR.jointAction: self.joint_actions(),
            CAPAR.fact: facts(out, seen.facts, world),
            CAPAR.location: self.locations(),
            CAPAR.guide: self.guides(),
            CAPAR.style: self.styles(),
            CAPAR.notice: [
                self.add(
                    CAPAR.Notice,
                    "notice",
                    index,
                    {CAPAR.noticeCode: each.code, CAPAR.message: each.message},
                )
                for index, each in enumerate(seen.notices)
            ],
            # What was decided for the whole recording, thresholds included.
            CAPAR.calibration: Literal(
                json.dumps(document(seen.calibration), separators=(",", ":")), datatype=JSON
            )
            if seen.calibration
            else None,
        }
        for each in seen.relations:
            node, other = (
                pars.segment_node(self.about, *key) for key in (each.segment, each.other)
            )
            out.add(node, (), {RELATIONS[each.kind]: other})
        pars.ipars(out, seen, self.agents, self.objects)
        for track in seen.tracks:
            for body in self.bodies(track.body):
                out.add(body, (), {CAPAR.track: statements.track(track)})
        out.add(self.about, (CAPAR.Observation,), properties)
        return out

    def bodies(self, name: str) -> list[NamedNode]:
        """The tag object and the link of a name, which are one body; else a sensor."""
        found = [each[name] for each in (self.objects, self.links) if name in each]
        return found or [self.add(CAPAR.Sensor, "sensor", name, {LABEL: name, CAPAR.name: name})]

    def known(self, things: Iterable[str]) -> list[NamedNode]:
        """The objects among things."""
        return [self.objects[each] for each in things if each in self.objects]

    def performer(self, ee: str) -> NamedNode:
        """Whose end-effector it is."""
        return self.agents[self.seen.performer(ee)]

    def capture(self) -> NamedNode:
        """The capture with the files that it was read from."""
        seen = self.seen
        files = [
            self.add(
                CAPAR.SourceFile,
                "source",
                index,
                {
                    CAPAR.filePath: each.path,
                    CAPAR.fileFormat: each.format,
                    CAPAR.sha256: each.sha256,
                },
            )
            for index, each in enumerate(seen.sources)
        ]
        recorded = recorded_at(seen.sources)
        of_day = NamedNode(XSD + ("dateTime" if "T" in recorded else "date"))
        properties: PropertyValues = {
            LABEL: seen.capture,
            CAPAR.name: seen.capture,
            CAPAR.frames: seen.frames,
            CAPAR.rate: float(seen.rate_hz),
            CAPAR.duration: float(seen.duration_s),
            CAPAR.recordedAt: Literal(recorded, datatype=of_day) if recorded else None,
            DERIVED: files,
        }
        return self.out.add(names.part(self.about, "capture"), (CAPAR.Capture,), properties)

    def agent(self, name: str) -> NamedNode:
        """An agent; one without a name belongs to the capture alone."""
        capture = self.seen.capture
        unnamed = name == UNNAMED
        return self.out.share(
            names.shared("agent", name, *([capture] if unnamed else [])),
            (CAPAR.Agent,),
            {LABEL: f"{UNNAMED} of {capture}" if unnamed else name, CAPAR.name: name},
        )

    def performance(self, agent: "Agent", number: int) -> NamedNode:
        """An agent in this capture, with its kind and its measures there."""
        node = names.part(self.about, "performer", *([number] if number else []))
        measures = [
            self.out.add(
                names.part(node, "measure", name),
                (CAPAR.Measure,),
                {CAPAR.name: name, CAPAR.value: float(agent.measures[name])},
            )
            for name in sorted(agent.measures)
        ]
        properties: PropertyValues = {
            CAPAR.agent: self.agents[agent.name],
            CAPAR.kind: shared.kind(self.out, agent.kind),
            CAPAR.measure: measures,
        }
        return self.out.add(node, (CAPAR.Performer,), properties)

    def object(self, seen: "ObservedObject") -> NamedNode:
        """A tag object with its site, and the states in which it began to move alone."""
        node = names.part(self.about, "object", seen.name)
        states = []
        for number, force in enumerate(self.seen.forces):
            if force.object == seen.name:  # began to move on alone (thesis Fig 4.13)
                thesis = self.seen.profile == THESIS
                damping = force.thesis_damping if thesis else force.damping_per_s
                bounce = force.bounce if force.restitution is None else force.restitution
                state: PropertyValues = {
                    CAPAR.position: statements.vector(force.position_m),
                    CAPAR.velocity: statements.vector(force.velocity_mps),
                    # The damping along z is taken for zero (thesis 3.4.3.4).
                    CAPAR.dampingForce: statements.vector((*damping, 0.0)) if damping else None,
                    CAPAR.restitution: bounce,
                }
                own = names.part(node, "state", number)
                states.append(self.out.add(own, (CAPAR.StateSpace,), state))
        site: PropertyValues = {
            CAPAR.position: statements.vector(seen.position_m),
            CAPAR.orientation: statements.vector(seen.orientation),
        }
        properties: PropertyValues = {
            **same(seen, "name shape"),
            LABEL: seen.name,
            CAPAR.kind: shared.kind(self.out, kind_of(seen)),
            CAPAR.tag: TAGS[seen.tag],
            CAPAR.size: statements.vector(seen.size_m),
            CAPAR.assumedFrom: seen.assumed,
            CAPAR.coordinateSystem: self.out.add(names.part(node, "site"), (CAPAR.Site,), site),
            CAPAR.state: states,
        }
        return self.out.add(node, (CAPAR.TagObject,), properties)

    def segment(self, seen: "Segment", count: int, rules: Mapping[str, NamedNode]) -> NamedNode:
        """A segment of a link of so many."""
        out, after = self.out, seen.index + 1
        node = pars.segment_node(self.about, seen.ee, seen.index)
        follows = pars.segment_node(self.about, seen.ee, after) if after < count else None
        action, general = shared.action(out, seen.name), shared.actions(out, seen.general)
        if action is not None and general:
            out.add(action, (), {CAPAR.kindOf: general, BROADER: general})
        properties: PropertyValues = {
            LABEL: f"{seen.ee} {seen.index}: {seen.name}",
            CAPAR.ofLink: self.links[seen.ee],
            **same(seen, "ee index general objects purpose"),
            **_interval(seen),
            CAPAR.address: str(SegmentAddress(seen.ee, seen.index, self.seen.capture)),
            CAPAR.action: action,
            CAPAR.namedBy: rules.get(seen.name),
            CAPAR.specialises: general,
            CAPAR.candidate: shared.actions(out, seen.candidates),
            CAPAR.failedAt: seen.level,
            CAPAR.possesses: seen.possessed,
            CAPAR.object: self.known(seen.objects),
            CAPAR.dominant: self.known(seen.objects[:1]),
            CAPAR.subordinate: self.known(seen.objects[1:]),
            CAPAR.features: shared.features(out, seen.features),
            CAPAR.beginsWith: self.borders(node, "begin", seen.begins),
            CAPAR.endsWith: self.borders(node, "end", seen.ends),
            CAPAR.placement: [
                out.add(
                    names.part(node, "placement", index),
                    (CAPAR.Placement,),
                    {
                        CAPAR.preposition: preposition,
                        CAPAR.body: self.bodies(body),
                        CAPAR.other: self.bodies(other),
                    },
                )
                for index, (preposition, body, other) in enumerate(seen.prepositions)
            ],
            CAPAR.look: [
                out.add(
                    names.part(node, "look", index),
                    (CAPAR.Look,),
                    {CAPAR.seen: self.objects[looked_at], CAPAR.when: when},
                )
                for index, (looked_at, when) in enumerate(seen.looks)
                if looked_at in self.objects
            ],
            CAPAR.next: follows,
            MEETS: follows,
            GENERATED: self.about,
        }
        kinds = (CAPAR.Segment,) if seen.known else (CAPAR.Segment, CAPAR.UnknownSegment)
        return out.add(node, kinds, properties)

    def borders(self, of: NamedNode, where: str, borders: "tuple[Border, ...]") -> list[NamedNode]:
        """What happens at the begin or at the end of a segment."""
        nodes = []
        for index, each in enumerate(borders):
            if each.kind not in BORDER_KINDS:
                raise UnknownNameError("kind of border", each.kind, BORDER_KINDS)
            properties: PropertyValues = {
                CAPAR.index: index,
                CAPAR.borderKind: BORDER_KINDS[each.kind],
                CAPAR.body: self.bodies(each.body) if each.body else None,
                CAPAR.other: self.bodies(each.other) if each.other else None,
            }
            nodes.append(self.out.add(names.part(of, where, index), (CAPAR.Border,), properties))
        return nodes

    def joint_actions(self) -> list[NamedNode]:
        """What several end-effectors did with one object as one action, in order of time."""
        return [
            self.add(
                CAPAR.JointAction,
                "joint",
                index,
                {
                    **same(seen, "name objects"),
                    **_interval(seen),
                    LABEL: f"{', '.join(seen.who)}: {seen.name}",
                    CAPAR.index: index,
                    CAPAR.action: shared.action(self.out, seen.name),
                    CAPAR.effectors: " ".join(seen.who),
                    CAPAR.dominant: self.known(seen.objects[:1]),
                    CAPAR.object: self.known(seen.objects),
                    CAPAR.standsFor: [
                        pars.segment_node(self.about, ee, number)
                        for ee, number in zip(seen.ees, seen.segments, strict=True)
                    ],
                    GENERATED: self.about,
                },
            )
            for index, seen in enumerate(self.seen.joint)
        ]

    def kind_named(self, name: str) -> NamedNode | None:
        """The kind of the object of a name."""
        return shared.kind(self.out, self.kinds.get(name, name)) if name else None

    def locations(self) -> list[NamedNode]:
        """Constraint locations, with the kinds of objects that each is kept with."""
        ended = {
            (each.ee, each.last, each.name): pars.segment_node(self.about, each.ee, each.index)
            for each in self.seen.segments
        }
        return [
            self.add(
                CAPAR.ConstraintLocation,
                "location",
                index,
                {
                    CAPAR.index: index,
                    CAPAR.agent: self.performer(value.ee),
                    CAPAR.ofSegment: ended.get((value.ee, value.frame, value.action)),
                    **same(value, "ee purpose side frame"),
                    CAPAR.ofAction: shared.action(self.out, value.action),
                    CAPAR.actionName: value.action,
                    CAPAR.dominant: self.objects.get(value.dominant),
                    CAPAR.dominantKind: self.kind_named(value.dominant) if value.ee_nlt else None,
                    CAPAR.goal: self.objects.get(value.goal),
                    CAPAR.goalKind: self.kind_named(value.goal),
                    CAPAR.seen: self.objects.get(value.seen),
                    CAPAR.seenKind: self.kind_named(value.seen),
                    CAPAR.eeNlt: statements.nlt(value.ee_nlt),
                    CAPAR.goalNlt: statements.nlt(value.goal_nlt),
                    CAPAR.vNlt: statements.nlt(value.v_nlt),
                    GENERATED: self.about,
                },
            )
            for index, value in enumerate(self.seen.locations)
        ]

    def guides(self) -> list[NamedNode]:
        """Hinges and rails, with the kinds of objects that each is kept with."""
        return [
            self.add(
                CAPAR.Guide,
                "guide",
                each.object,
                {
                    CAPAR.guideKind: each.kind,
                    CAPAR.dominant: self.objects[each.object],
                    CAPAR.dominantKind: self.kind_named(each.object),
                    CAPAR.goal: self.objects[each.base],
                    CAPAR.goalKind: self.kind_named(each.base),
                    CAPAR.eeNlt: statements.nlt(each.object_nlt),
                    CAPAR.goalNlt: statements.nlt(each.base_nlt),
                    CAPAR.opened: each.opened,
                    CAPAR.residual: each.residual_m,
                    GENERATED: self.about,
                },
            )
            for each in self.seen.guides
        ]

    def styles(self) -> list[NamedNode]:
        """Styles of whoever performed."""
        return [
            self.add(
                CAPAR.AgentStyle,
                "style",
                index,
                {
                    CAPAR.index: index,
                    CAPAR.agent: self.performer(value.ee),
                    CAPAR.ofAction: shared.action(self.out, value.action),
                    CAPAR.actionName: value.action,
                    **same(value, "purpose ee"),
                    CAPAR.velStyle: statements.vector(value.velocity),
                    CAPAR.pathStyle: statements.path(value.path),
                    GENERATED: self.about,
                },
            )
            for index, value in enumerate(self.seen.styles)
        ]


def _interval(seen: "Segment | JointAction") -> PropertyValues:
    """Frames and times [s]."""
    return {
        CAPAR.firstFrame: seen.first,
        CAPAR.lastFrame: seen.last,
        CAPAR.start: float(seen.start_s),
        CAPAR.end: float(seen.end_s),
        CAPAR.duration: float(seen.end_s - seen.start_s),
    }


def run(observation: "Observation") -> list[Quad]:
    """The run that ends now on this computer: its time, the version and the files as they are."""
    out = Statements(names.GRAPHS["runs"])
    now = datetime.now(UTC).isoformat(timespec="seconds")
    properties: dict[NamedNode, Any] = {
        LABEL: f"run of {observation.capture}",
        CAPAR.ofObservation: names.observation(observation.capture),
        ENDED: Literal(now, datatype=NamedNode(XSD + "dateTime")),
        CAPAR.version: observation.version,
        CAPAR.host: platform.node(),
        CAPAR.readFrom: [Literal(os.path.expandvars(each.path)) for each in observation.sources],
    }
    out.add(names.shared("run", observation.capture), (CAPAR.Run,), properties)
    return out.quads


def run_removal(graph: NamedNode) -> str:
    """The update that forgets the run of an observation."""
    node = names.shared("run", names.observation_name(graph))
    return f"DELETE WHERE {{ GRAPH {names.GRAPHS['runs']} {{ {node} ?property ?value }} }}"
