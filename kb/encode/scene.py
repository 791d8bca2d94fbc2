"""The capture, its performer, its objects and its links, as statements."""

import hashlib
from typing import TYPE_CHECKING

from pyoxigraph import Literal, NamedNode

from capar.model.capture import recorded_at
from kb.store import literals, names
from kb.store.statements import LABEL, PropertyValues, Statements
from ontology import CAPAR
from ontology.vocabularies import PREFIXES, PROV, XSD

if TYPE_CHECKING:
    from capar.model.capture import Agent
    from capar.model.observation import ForceStyle, Observation, ObservedObject

TAGS = {"self": CAPAR.Self, "fixed": CAPAR.Fixed, "mobile": CAPAR.Mobile}

USED = NamedNode(PROV + "used")
DERIVED = NamedNode(PROV + "wasDerivedFrom")
GENERATED = NamedNode(PROV + "wasGeneratedBy")
ASSOCIATED = NamedNode(PROV + "wasAssociatedWith")
THESIS = "thesis"
"""The profile by whose rules damping is the thesis's."""

UNNAMED = "agent"
"""The name of an agent that nobody named."""

OF_INTEREST = NamedNode(PREFIXES["sosa"] + "hasFeatureOfInterest")


def identity(observation: "Observation") -> str:
    """A digest by which the same capture is known again, whatever rules read it."""
    sources = sorted(each.sha256 for each in observation.sources)
    scene = (observation.agent.name, observation.frames, observation.rate_hz, sources)
    others = tuple(each.name for each in observation.others)
    return hashlib.sha256(repr((*scene, *others)).encode()).hexdigest()


def kind_of(seen: "ObservedObject") -> str:
    """The noun under which an object's knowledge is kept: its kind, else its own name."""
    return seen.kind or seen.name


def kind(out: Statements, name: str) -> NamedNode:
    """A kind of object; one outside the hierarchy is just an object."""
    node = names.shared("kind", name)
    if names.graph_of(node) == names.GRAPHS["ontology"]:
        return node
    above = names.shared("kind", "object")
    thing = names.shared("kind", "thing")
    properties: PropertyValues = {
        LABEL: name.replace("_", " "),
        CAPAR.name: name,
        CAPAR.isA: [node, above, thing],
    }
    return out.share(node, (CAPAR.ObjectKind,), properties)


def capture(out: Statements, observation: "Observation") -> NamedNode:
    """The capture with the files that it was read from."""
    files = [
        out.add(
            names.part(out.about, "source", index),
            (CAPAR.SourceFile,),
            {
                CAPAR.filePath: each.path,
                CAPAR.fileFormat: each.format,
                CAPAR.sha256: each.sha256,
            },
        )
        for index, each in enumerate(observation.sources)
    ]
    properties: PropertyValues = {
        LABEL: observation.capture,
        CAPAR.name: observation.capture,
        CAPAR.frames: observation.frames,
        CAPAR.rate: float(observation.rate_hz),
        CAPAR.duration: float(observation.duration_s),
        CAPAR.recordedAt: _time(recorded_at(observation.sources)),
        DERIVED: files,
    }
    return out.add(names.part(out.about, "capture"), (CAPAR.Capture,), properties)


def _time(stated: str) -> Literal | None:
    """A date, or a date and time, of ISO 8601; None for an empty text."""
    form = "dateTime" if "T" in stated else "date"
    return Literal(stated, datatype=NamedNode(XSD + form)) if stated else None


def agents(out: Statements, observation: "Observation") -> dict[str, NamedNode]:
    """Everyone who performed, by name, the first one first.

    Who has no name belongs to the capture: the same word in two captures is not one person.
    """
    return {
        each.name: _agent(out, each.name, observation.capture)
        for each in (observation.agent, *observation.others)
    }


def _agent(out: Statements, name: str, capture: str) -> NamedNode:
    unnamed = name == UNNAMED
    node = names.shared("agent", name, *([capture] if unnamed else []))
    label = unnamed_label(capture) if unnamed else name
    return out.share(node, (CAPAR.Agent,), {LABEL: label, CAPAR.name: name})


def unnamed_label(capture: str) -> str:
    """What the agent of a capture is called that nobody named."""
    return f"{UNNAMED} of {capture}"


def performer(out: Statements, agent: "Agent", who: NamedNode, *, number: int = 0) -> NamedNode:
    """An agent in this capture, with its kind and its measures there."""
    words = (number,) if number else ()
    node = names.part(out.about, "performer", *words)
    measures = [
        out.add(
            names.part(node, "measure", name),
            (CAPAR.Measure,),
            {CAPAR.name: name, CAPAR.value: float(agent.measures[name])},
        )
        for name in sorted(agent.measures)
    ]
    properties: PropertyValues = {
        CAPAR.agent: who,
        CAPAR.kind: kind(out, agent.kind),
        CAPAR.measure: measures,
    }
    return out.add(node, (CAPAR.Performer,), properties)


def objects(out: Statements, observation: "Observation") -> dict[str, NamedNode]:
    """Every tag object by name."""
    states = {
        thing.name: [
            _state(out, names.part(out.about, "object", thing.name), number, force, observation)
            for number, force in enumerate(observation.forces)
            if force.object == thing.name
        ]
        for thing in observation.objects
    }
    return {thing.name: _object(out, thing, states[thing.name]) for thing in observation.objects}


def _state(
    out: Statements, of: NamedNode, number: int, force: "ForceStyle", observation: "Observation"
) -> NamedNode:
    """The state in which a thing began to move on alone (thesis Fig 4.13)."""
    own = force.damping_per_s
    damping = force.thesis_damping if observation.profile == THESIS else own
    restitution = force.bounce if force.restitution is None else force.restitution
    return out.add(
        names.part(of, "state", number),
        (CAPAR.StateSpace,),
        {
            CAPAR.position: literals.vector(force.position_m),
            CAPAR.velocity: literals.vector(force.velocity_mps),
            # The damping along z is taken for zero (thesis 3.4.3.4).
            CAPAR.dampingForce: literals.vector((*damping, 0.0)) if damping else None,
            CAPAR.restitution: restitution,
        },
    )


def _object(out: Statements, seen: "ObservedObject", states: list[NamedNode]) -> NamedNode:
    node = names.part(out.about, "object", seen.name)
    site = out.add(
        names.part(node, "site"),
        (CAPAR.Site,),
        {
            CAPAR.position: literals.vector(seen.position_m),
            CAPAR.orientation: literals.vector(seen.orientation),
        },
    )
    properties: PropertyValues = {
        LABEL: seen.name,
        CAPAR.name: seen.name,
        CAPAR.kind: kind(out, kind_of(seen)),
        CAPAR.tag: TAGS[seen.tag],
        CAPAR.size: literals.vector(seen.size_m),
        CAPAR.shape: seen.shape,
        CAPAR.assumedFrom: seen.assumed,
        CAPAR.coordinateSystem: site,
        CAPAR.state: states,
    }
    return out.add(node, (CAPAR.TagObject,), properties)


def links(
    out: Statements, observation: "Observation", agents: dict[str, NamedNode]
) -> dict[str, NamedNode]:
    """Every acting link by its end-effector."""
    return {
        link.ee: out.add(
            names.part(out.about, "link", link.ee),
            (CAPAR.Link,),
            {
                CAPAR.name: link.ee,
                CAPAR.ee: link.ee,
                CAPAR.effectorType: link.kind,
                CAPAR.side: link.side,
                CAPAR.agent: agents[observation.performer(link.ee)],
            },
        )
        for link in observation.links
    }
