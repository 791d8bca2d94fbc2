"""Complex actions as such, and as they were done, as statements (thesis 4.6.2)."""

from typing import TYPE_CHECKING

from pyoxigraph import NamedNode

from capar.model.errors import ParError, UnknownNameError
from capar.model.par import UNKNOWN, ComplexPar, LinkSteps, Step
from kb.encode.scene import GENERATED
from kb.encode.segments import action, segment_node
from kb.store import names
from kb.store.statements import LABEL, PropertyValues, Statements
from ontology import CAPAR
from ontology.vocabularies import ALLEN

if TYPE_CHECKING:
    from capar.model.observation import Observation

COMMON = "all"
"""The end-effector of the step that ends every link."""


def is_known(value: ComplexPar) -> bool:
    """Whether every step has a name, so that the action can be known again."""
    steps = [step for link in value.links for step in link.steps]
    return bool(steps) and all(each.action != UNKNOWN for each in steps)


def complex_node(value: ComplexPar) -> NamedNode:
    """What a complex action is called: after what makes two observations one action."""
    return names.shared("complex", names.hashed(value.signature))


def complex_par(out: Statements, observation: "Observation", name: str) -> NamedNode:
    """The complex action and its steps; one with unknown steps is the observation's own."""
    value = observation.complex_par
    known = is_known(value)
    node = complex_node(value) if known else names.part(out.about, "complex")
    add = out.share if known else out.add
    numbers = {each: index for index, each in enumerate(value.objects)}
    steps = []
    for link in _with_common(value):
        for index, step in enumerate(link.steps):
            properties: PropertyValues = {
                CAPAR.ee: link.ee,
                CAPAR.index: index,
                CAPAR.ofAction: action(out, step.action),
                CAPAR.name: step.action,
                CAPAR.objectNumbers: " ".join(str(numbers[each]) for each in step.objects),
            }
            steps.append(
                add(names.part(node, "step", link.ee, index), (CAPAR.ComplexStep,), properties)
            )
    add(node, (CAPAR.ComplexPar,), {CAPAR.arity: len(value.objects), CAPAR.complexStep: steps})
    _enact(out, observation, node, name)
    return node


def _with_common(value: ComplexPar) -> tuple[LinkSteps, ...]:
    """The links, and the step that ends them all as a link of its own."""
    common = (LinkSteps(COMMON, (value.common,)),) if value.common else ()
    return (*value.links, *common)


def _enact(out: Statements, observation: "Observation", node: NamedNode, name: str) -> None:
    value = observation.complex_par
    links = _with_common(value)
    ees = [each.ee for each in observation.links]
    known = {(link.ee, index) for link in links for index, _ in enumerate(link.steps)}
    for relation in value.relations:
        for each in (relation.first, relation.second):
            if each not in known:
                raise ParError(f"relation of a step {each} that the complex action has not")
    for link in links:
        for index, step in enumerate(link.steps):
            after = (link.ee, index + 1)
            properties: dict[NamedNode, list[NamedNode]] = {
                CAPAR.nextStep: [_step(out, *after)] if after in known else []
            }
            for relation in value.relations:
                if relation.first == (link.ee, index):
                    allen = _property(relation.relation)
                    properties.setdefault(allen, []).append(_step(out, *relation.second))
            _add_step(out, node, link, index, step, relations=properties, ees=ees)
    out.add(
        out.about,
        (),
        {
            CAPAR.enacts: node,
            CAPAR.name: name,
            CAPAR.effectors: " ".join(each.ee for each in value.links),
            CAPAR.objects: " ".join(value.objects),
            CAPAR.duration: float(value.duration_s),
        },
    )


def _property(relation: str) -> NamedNode:
    if relation not in ALLEN:
        raise UnknownNameError("relation of Allen's", relation, ALLEN)
    return NamedNode(ALLEN[relation])


def _step(out: Statements, ee: str, index: int) -> NamedNode:
    return names.part(out.about, "step", ee, index)


def _add_step(
    out: Statements,
    node: NamedNode,
    link: LinkSteps,
    index: int,
    step: Step,
    *,
    relations: PropertyValues,
    ees: list[str],
) -> None:
    properties: PropertyValues = {
        LABEL: f"{link.ee} {index}: {step.action}",
        CAPAR.realises: names.part(node, "step", link.ee, index),
        CAPAR.ee: link.ee,
        CAPAR.index: index,
        CAPAR.ofAction: action(out, step.action),
        CAPAR.name: step.action,
        CAPAR.objects: " ".join(step.objects),
        CAPAR.share: float(step.share),
        CAPAR.begin: float(step.begin),
        CAPAR.purpose: step.purpose,
        CAPAR.posture: step.posture,
        CAPAR.segmentNumbers: " ".join(map(str, step.segments)),
        CAPAR.standsFor: _segments(out, link, step, ees),
        GENERATED: out.about,
        **relations,
    }
    node_of_step = out.add(_step(out, link.ee, index), (CAPAR.Step,), properties)
    out.add(out.about, (), {CAPAR.step: node_of_step})


def _segments(out: Statements, link: LinkSteps, step: Step, ees: list[str]) -> list[NamedNode]:
    """The segments that a step stands for; a common step has one of each link."""
    if link.ee != COMMON:
        return [segment_node(out.about, link.ee, each) for each in step.segments]
    if len(ees) != len(step.segments):
        return []
    return [segment_node(out.about, ee, each) for ee, each in zip(ees, step.segments, strict=True)]
