"""A whole observation as statements: what it found, and where that comes from."""

import json
from typing import TYPE_CHECKING

from pyoxigraph import Literal, NamedNode

from capar.model.json_form import document
from kb.encode import complex_pars, facts, joint, measures, pars, rules, scene, segments
from kb.encode.bodies import Bodies
from kb.encode.held_contacts import held_contacts
from kb.store import literals, names
from kb.store.statements import LABEL, PropertyValues, Statements
from ontology import CAPAR
from ontology.vocabularies import RDF

if TYPE_CHECKING:
    from capar.model.observation import Observation

JSON = NamedNode(RDF + "JSON")


def encode(observation: "Observation", *, name: str | None = None) -> Statements:
    """Everything that an observation says.

    Args:
        observation: What was understood of a capture.
        name: What its complex action is called; by default what the observation calls it.

    Raises:
        LiteralError: A number that is not finite.
        ParError: Steps that are related but not there.
    """
    out = Statements(names.observation(observation.capture))
    capture = scene.capture(out, observation)
    agents = scene.agents(out, observation)
    agent = agents[observation.agent.name]
    performer = scene.performer(out, observation.agent, agent)
    for number, each in enumerate(observation.others, start=1):
        scene.performer(out, each, agents[each.name], number=number)
    links = scene.links(out, observation, agents)
    objects = scene.objects(out, observation)
    bodies = Bodies(out, objects, links)
    rate_hz = facts.rate_of(
        observation.facts, frames=observation.frames, duration_s=observation.duration_s
    )
    contacts = held_contacts(observation, rate_hz)
    world = facts.Scene(bodies, agents, rate_hz, contacts)
    called = name or observation.complex_par.name or observation.capture
    complex_pars.complex_par(out, observation, called)
    base = rules.rule_base(out, observation)
    naming = rules.naming_rules(out, observation)
    for upar in observation.upars:
        pars.upar(out, upar)
    properties: PropertyValues = {
        LABEL: observation.capture,
        CAPAR.capture: capture,
        scene.USED: [capture, base],
        scene.ASSOCIATED: list(agents.values()),
        scene.OF_INTEREST: list(objects.values()),
        CAPAR.ruleBase: base,
        CAPAR.profile: observation.profile,
        CAPAR.version: observation.version,
        CAPAR.identity: scene.identity(observation),
        CAPAR.performer: performer,
        CAPAR.agent: agent,
        CAPAR.object: list(objects.values()),
        CAPAR.link: list(links.values()),
        CAPAR.segment: segments.segments(out, observation, links, objects, bodies, naming),
        CAPAR.jointAction: joint.joint_actions(out, observation, objects),
        CAPAR.fact: facts.facts(out, observation.facts, world),
        CAPAR.location: measures.locations(out, observation, agents, objects),
        CAPAR.guide: measures.guides(out, observation, objects),
        CAPAR.style: measures.styles(out, observation, agents),
        CAPAR.notice: _notices(out, observation),
        CAPAR.calibration: _calibration(observation),
    }
    pars.ipars(out, observation, agents, objects)
    for track in observation.tracks:
        for body in bodies[track.body]:
            out.add(body, (), {CAPAR.track: literals.track(track)})
    out.add(out.about, (CAPAR.Observation,), properties)
    return out


def _calibration(observation: "Observation") -> Literal | None:
    """What was decided for the whole recording, thresholds of extraction included, as JSON."""
    if observation.calibration is None:
        return None
    text = json.dumps(document(observation.calibration), separators=(",", ":"))
    return Literal(text, datatype=JSON)


def _notices(out: Statements, observation: "Observation") -> list[NamedNode]:
    return [
        out.add(
            names.part(out.about, "notice", index),
            (CAPAR.Notice,),
            {CAPAR.noticeCode: each.code, CAPAR.message: each.message},
        )
        for index, each in enumerate(observation.notices)
    ]
