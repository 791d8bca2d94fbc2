"""Uninstantiated and instantiated actions as statements (thesis 4.1)."""

from collections.abc import Callable
from dataclasses import replace
from typing import TYPE_CHECKING

from pyoxigraph import NamedNode

from capar.model.par import (
    Call,
    Condition,
    CoreSemantics,
    Ipar,
    Motion,
    Preparation,
    Upar,
)
from kb.encode.scene import DERIVED, GENERATED
from kb.encode.segments import action, actions, features, segment_node
from kb.store import literals, names
from kb.store.statements import LABEL, PropertyValues, Statements
from ontology import CAPAR

if TYPE_CHECKING:
    from capar.model.observation import Observation, Segment

MOTIONS = {
    Motion.NONE: CAPAR.NoMotion,
    Motion.TRANSLATION: CAPAR.Translation,
    Motion.ROTATION: CAPAR.Rotation,
    Motion.BOTH: CAPAR.TranslationAndRotation,
}

Add = Callable[[NamedNode, tuple[NamedNode, ...], PropertyValues], NamedNode]
"""How a part is stated: as the observation's own, or as shared."""


def condition(out: Statements, value: Condition) -> NamedNode:
    """A condition, called after what it says."""
    sign = "" if value.holds else "not"
    node = names.shared("condition", value.kind, *value.arguments, *([sign] if sign else []))
    text = f"{'' if value.holds else 'not '}{value.kind}({', '.join(value.arguments)})"
    properties: PropertyValues = {
        LABEL: text,
        CAPAR.conditionKind: value.kind,
        CAPAR.parameters: " ".join(value.arguments),
        CAPAR.holds: value.holds,
    }
    return out.share(node, (CAPAR.Condition,), properties)


def conditions(out: Statements, values: tuple[Condition, ...]) -> list[NamedNode]:
    """Several of them."""
    return [condition(out, each) for each in values]


def upar_node(value: Upar) -> NamedNode:
    """What an uninstantiated action is called: its name, and a digest of what it says."""
    return names.shared("upar", value.name, names.hashed(replace(value, parent="")))


def upar(out: Statements, value: Upar) -> NamedNode:
    """An uninstantiated action; equal ones of several observations are one."""
    node = upar_node(value)
    properties: PropertyValues = {
        LABEL: value.name,
        CAPAR.name: value.name,
        CAPAR.ofAction: action(out, value.name),
        CAPAR.parameters: " ".join(value.objects),
        CAPAR.arity: len(value.objects),
        CAPAR.agentParameter: value.agent,
        CAPAR.general: " ".join(value.general),
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
) -> list[NamedNode]:
    """One instantiated action for each segment, links in order."""
    known = {
        (each.name, each.core.constraint.features): upar_node(each) for each in observation.upars
    }
    out_nodes = []
    for value, segment in zip(observation.ipars, observation.segments, strict=True):
        of = known.get((value.upar, value.core.constraint.features))
        agent = agents.get(value.agent, agents[observation.agent.name])
        out_nodes.append(_ipar(out, value, segment, of, agent=agent, objects=objects))
    return out_nodes


def _ipar(
    out: Statements,
    value: Ipar,
    segment: "Segment",
    of: NamedNode | None,
    *,
    agent: NamedNode,
    objects: dict[str, NamedNode],
) -> NamedNode:
    node = names.part(out.about, "ipar", segment.ee, segment.index)
    properties: PropertyValues = {
        CAPAR.name: value.upar,
        CAPAR.ofAction: action(out, value.upar),
        CAPAR.instanceOf: of,
        CAPAR.agent: agent,
        CAPAR.ee: value.ee,
        CAPAR.objects: " ".join(value.objects),
        CAPAR.object: [objects[each] for each in value.objects if each in objects],
        CAPAR.start: float(value.start_s),
        CAPAR.core: _core(out, out.add, node, value.core),
        CAPAR.preparation: _preparation(out, out.add, node, value.preparation),
        CAPAR.postAssertion: conditions(out, value.post_assertions),
        CAPAR.posture: value.posture,
        CAPAR.parentName: value.parent,
        DERIVED: segment_node(out.about, segment.ee, segment.index),
        GENERATED: out.about,
    }
    return out.add(node, (CAPAR.Ipar,), properties)


def _preparation(
    out: Statements, add: Add, of: NamedNode, values: tuple[Preparation, ...]
) -> list[NamedNode]:
    nodes = []
    for index, each in enumerate(values):
        node = names.part(of, "preparation", index)
        remedy = _call(out, add, names.part(node, "remedy"), each.action, 0)
        properties: PropertyValues = {
            CAPAR.index: index,
            CAPAR.condition: condition(out, each.condition),
            CAPAR.remedy: remedy,
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
    constraint = add(
        names.part(node, "constraint"),
        (CAPAR.Constraint,),
        {
            CAPAR.features: features(out, value.constraint.features),
            CAPAR.collidingFirst: first,
            CAPAR.collidingSecond: second,
        },
    )
    ends = [each for point in value.path for each in point]
    properties: PropertyValues = {
        CAPAR.motion: MOTIONS[value.motion],
        CAPAR.moved: value.moved,
        CAPAR.causal: value.causal,
        CAPAR.forceOn: " ".join(value.force),
        CAPAR.pathEnds: literals.vector(ends) if ends else None,
        CAPAR.purpose: value.purpose,
        CAPAR.enables: actions(out, value.enables),
        CAPAR.termination: conditions(out, value.termination),
        CAPAR.duration: None if value.duration_s is None else float(value.duration_s),
        CAPAR.manner: value.manner,
        CAPAR.constraint: constraint,
    }
    return add(node, (CAPAR.CoreSemantics,), properties)
