"""Uninstantiated, instantiated and complex actions as statements (thesis 4.1, 4.6.2)."""

from collections.abc import Callable
from dataclasses import replace
from typing import TYPE_CHECKING

from pyoxigraph import NamedNode

from capar.model.errors import ParError, UnknownNameError
from capar.model.par import (
    UNKNOWN,
    Call,
    ComplexPar,
    CoreSemantics,
    LinkSteps,
    Motion,
    Preparation,
    Step,
    Upar,
)
from kb.encode.shared import DERIVED, GENERATED, action, actions, conditions, features
from kb.store import names, statements
from kb.store.statements import LABEL, PropertyValues, Statements, same
from ontology import CAPAR
from ontology.namespace import ALLEN

if TYPE_CHECKING:
    from capar.model.observation import Observation

MOTIONS = {
    Motion.NONE: CAPAR.NoMotion,
    Motion.TRANSLATION: CAPAR.Translation,
    Motion.ROTATION: CAPAR.Rotation,
    Motion.BOTH: CAPAR.TranslationAndRotation,
}

COMMON = "all"
"""The end-effector of the step that ends every link."""

Add = Callable[[NamedNode, tuple[NamedNode, ...], PropertyValues], NamedNode]
"""How a part is stated: as the observation's own, or as shared."""


def segment_node(about: NamedNode, ee: str, index: int) -> NamedNode:
    """The node of a segment."""
    return names.part(about, "segment", ee, index)


def upar_node(value: Upar) -> NamedNode:
    """The node of an uninstantiated action: its name, and a digest of what it says."""
    return names.shared("upar", value.name, names.hashed(replace(value, parent="")))


def upar(out: Statements, value: Upar) -> NamedNode:
    """An uninstantiated action; equal ones of several observations are one."""
    node = upar_node(value)
    properties: PropertyValues = {
        LABEL: value.name,
        **same(value, "name general"),
        CAPAR.ofAction: action(out, value.name),
        CAPAR.parameters: " ".join(value.objects),
        CAPAR.arity: len(value.objects),
        CAPAR.agentParameter: value.agent,
        CAPAR.specialises: actions(out, value.general),
        CAPAR.applicability: conditions(out, value.applicability),
        CAPAR.preparation: _preparation(out, out.share, node, value.preparation),
        CAPAR.executionStep: [
            _call(out, out.share, names.part(node, "step", index), each, index)
            for index, each in enumerate(value.steps)
        ],
        CAPAR.core: _core(out, out.share, node, value.core),
        CAPAR.postAssertion: conditions(out, value.post_assertions),
    }
    return out.share(node, (CAPAR.Upar,), properties)


def ipars(
    out: Statements,
    observation: "Observation",
    agents: dict[str, NamedNode],
    objects: dict[str, NamedNode],
) -> None:
    """One instantiated action for each segment, links in order."""
    known = {
        (each.name, each.core.constraint.features): upar_node(each) for each in observation.upars
    }
    for value, segment in zip(observation.ipars, observation.segments, strict=True):
        of = known.get((value.upar, value.core.constraint.features))
        agent = agents.get(value.agent, agents[observation.agent.name])
        seen = [objects[each] for each in value.objects if each in objects]
        node = names.part(out.about, "ipar", segment.ee, segment.index)
        properties: PropertyValues = {
            CAPAR.instanceOf: of,
            CAPAR.agent: agent,
            CAPAR.object: seen,
            CAPAR.name: value.upar,
            CAPAR.ofAction: action(out, value.upar),
            **same(value, "ee objects posture"),
            CAPAR.start: float(value.start_s),
            CAPAR.core: _core(out, out.add, node, value.core),
            CAPAR.preparation: _preparation(out, out.add, node, value.preparation),
            CAPAR.postAssertion: conditions(out, value.post_assertions),
            CAPAR.parentName: value.parent,
            DERIVED: segment_node(out.about, segment.ee, segment.index),
            GENERATED: out.about,
        }
        out.add(node, (CAPAR.Ipar,), properties)


def _preparation(
    out: Statements, add: Add, of: NamedNode, values: tuple[Preparation, ...]
) -> list[NamedNode]:
    nodes = []
    for index, each in enumerate(values):
        node = names.part(of, "preparation", index)
        properties: PropertyValues = {
            CAPAR.index: index,
            CAPAR.condition: conditions(out, (each.condition,)),
            CAPAR.remedy: _call(out, add, names.part(node, "remedy"), each.action, 0),
        }
        nodes.append(add(node, (CAPAR.Preparation,), properties))
    return nodes


def _call(out: Statements, add: Add, node: NamedNode, value: Call, index: int) -> NamedNode:
    properties: PropertyValues = {
        CAPAR.index: index,
        CAPAR.ofAction: action(out, value.action),
        CAPAR.name: value.action,
        CAPAR.parameters: " ".join(value.objects),
        CAPAR.purpose: value.purpose,
    }
    return add(node, (CAPAR.Call,), properties)


def _core(out: Statements, add: Add, of: NamedNode, value: CoreSemantics) -> NamedNode:
    node = names.part(of, "core")
    first, second = value.constraint.colliding_objects
    constraint: PropertyValues = {
        CAPAR.features: features(out, value.constraint.features),
        CAPAR.collidingFirst: first,
        CAPAR.collidingSecond: second,
    }
    ends = [each for point in value.path for each in point]
    properties: PropertyValues = {
        CAPAR.motion: MOTIONS[value.motion],
        **same(value, "moved causal purpose manner"),
        CAPAR.forceOn: " ".join(value.force),
        CAPAR.pathEnds: statements.vector(ends) if ends else None,
        CAPAR.enables: actions(out, value.enables),
        CAPAR.termination: conditions(out, value.termination),
        CAPAR.duration: None if value.duration_s is None else float(value.duration_s),
        CAPAR.constraint: add(names.part(node, "constraint"), (CAPAR.Constraint,), constraint),
    }
    return add(node, (CAPAR.CoreSemantics,), properties)


def is_known(value: ComplexPar) -> bool:
    """Whether every step has a name, so that the action can be known again."""
    steps = [step for link in value.links for step in link.steps]
    return bool(steps) and all(each.action != UNKNOWN for each in steps)


def complex_node(value: ComplexPar) -> NamedNode:
    """The node of a complex action: named after what makes two observations one action."""
    return names.shared("complex", names.hashed(value.signature))


def complex_par(out: Statements, observation: "Observation", name: str) -> NamedNode:
    """The complex action and its steps; one with unknown steps is the observation's own."""
    value = observation.complex_par
    known = is_known(value)
    node = complex_node(value) if known else names.part(out.about, "complex")
    add = out.share if known else out.add
    numbers = {each: index for index, each in enumerate(value.objects)}
    steps = []
    for ee, index, step in _all_steps(value):
        properties: PropertyValues = {
            CAPAR.ee: ee,
            CAPAR.index: index,
            CAPAR.ofAction: action(out, step.action),
            CAPAR.name: step.action,
            CAPAR.objectNumbers: " ".join(str(numbers[each]) for each in step.objects),
        }
        steps.append(add(names.part(node, "step", ee, index), (CAPAR.ComplexStep,), properties))
    add(node, (CAPAR.ComplexPar,), {CAPAR.arity: len(value.objects), CAPAR.complexStep: steps})
    _enact(out, observation, node, name)
    return node


def _all_steps(value: ComplexPar) -> list[tuple[str, int, Step]]:
    """End-effector, index and step: of each link, and the step that ends them all."""
    common = (LinkSteps(COMMON, (value.common,)),) if value.common else ()
    links = (*value.links, *common)
    return [(link.ee, at, step) for link in links for at, step in enumerate(link.steps)]


def _enact(out: Statements, observation: "Observation", node: NamedNode, name: str) -> None:
    """The complex action as the observation saw it."""
    value = observation.complex_par
    every = _all_steps(value)
    nodes = {(ee, at): names.part(out.about, "step", ee, at) for ee, at, _ in every}
    related: dict[tuple[str, int], dict[NamedNode, list[NamedNode]]] = {}
    for relation in value.relations:
        for each in (relation.first, relation.second):
            if each not in nodes:
                raise ParError(f"relation of a step {each} that the complex action has not")
        if relation.relation not in ALLEN:
            raise UnknownNameError("relation of Allen's", relation.relation, ALLEN)
        own = related.setdefault(relation.first, {})
        own.setdefault(NamedNode(ALLEN[relation.relation]), []).append(nodes[relation.second])
    ees = [each.ee for each in observation.links]
    for ee, index, step in every:
        # A common step stands for a segment of each link.
        whose = ees if ee == COMMON else [ee] * len(step.segments)
        fits = len(whose) == len(step.segments)
        stands_for = list(zip(whose, step.segments, strict=True)) if fits else []
        properties: PropertyValues = {
            LABEL: f"{ee} {index}: {step.action}",
            CAPAR.realises: names.part(node, "step", ee, index),
            CAPAR.ee: ee,
            CAPAR.index: index,
            CAPAR.ofAction: action(out, step.action),
            CAPAR.name: step.action,
            **same(step, "objects purpose posture"),
            CAPAR.share: float(step.share),
            CAPAR.begin: float(step.begin),
            CAPAR.segmentNumbers: " ".join(map(str, step.segments)),
            CAPAR.standsFor: [segment_node(out.about, one, at) for one, at in stands_for],
            CAPAR.nextStep: nodes.get((ee, index + 1)),
            GENERATED: out.about,
            **related.get((ee, index), {}),
        }
        out.add(nodes[ee, index], (CAPAR.Step,), properties)
    whole: PropertyValues = {
        CAPAR.step: list(nodes.values()),
        CAPAR.enacts: node,
        CAPAR.name: name,
        CAPAR.effectors: " ".join(each.ee for each in value.links),
        CAPAR.objects: " ".join(value.objects),
        CAPAR.duration: float(value.duration_s),
    }
    out.add(out.about, (), whole)
