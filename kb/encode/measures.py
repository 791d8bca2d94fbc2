"""Constraint locations and styles as statements (thesis 4.4.2)."""

from typing import TYPE_CHECKING

from pyoxigraph import NamedNode

from capar.model.locations import ConstraintLocation
from capar.model.par import Style
from kb.encode.scene import GENERATED, kind, kind_of
from kb.encode.segments import action, segment_node
from kb.store import literals, names
from kb.store.statements import PropertyValues, Statements
from ontology import CAPAR

if TYPE_CHECKING:
    from capar.model.observation import Observation


def locations(
    out: Statements,
    observation: "Observation",
    agents: dict[str, NamedNode],
    objects: dict[str, NamedNode],
) -> list[NamedNode]:
    """Every constraint location, with the kinds of objects that it is kept with."""
    kinds = {each.name: kind_of(each) for each in observation.objects}
    ended = {
        (each.ee, each.last, each.name): segment_node(out.about, each.ee, each.index)
        for link in observation.links
        for each in link.segments
    }
    return [
        _location(
            out,
            index,
            each,
            {
                CAPAR.agent: agents[observation.performer(each.ee)],
                CAPAR.ofSegment: ended.get((each.ee, each.frame, each.action)),
            },
            objects=objects,
            kinds=kinds,
        )
        for index, each in enumerate(observation.locations)
    ]


def _location(
    out: Statements,
    index: int,
    value: ConstraintLocation,
    made: PropertyValues,
    *,
    objects: dict[str, NamedNode],
    kinds: dict[str, str],
) -> NamedNode:
    def kind_named(name: str) -> NamedNode | None:
        return kind(out, kinds.get(name, name)) if name else None

    properties: PropertyValues = {
        CAPAR.index: index,
        **made,
        CAPAR.ee: value.ee,
        CAPAR.ofAction: action(out, value.action),
        CAPAR.actionName: value.action,
        CAPAR.purpose: value.purpose,
        CAPAR.side: value.side,
        CAPAR.frame: value.frame,
        CAPAR.dominant: objects.get(value.dominant),
        CAPAR.dominantKind: kind_named(value.dominant) if value.ee_nlt else None,
        CAPAR.goal: objects.get(value.goal),
        CAPAR.goalKind: kind_named(value.goal),
        CAPAR.seen: objects.get(value.seen),
        CAPAR.seenKind: kind_named(value.seen),
        CAPAR.eeNlt: literals.nlt(value.ee_nlt) if value.ee_nlt else None,
        CAPAR.goalNlt: literals.nlt(value.goal_nlt) if value.goal_nlt else None,
        CAPAR.vNlt: literals.nlt(value.v_nlt) if value.v_nlt else None,
        GENERATED: out.about,
    }
    return out.add(
        names.part(out.about, "location", index), (CAPAR.ConstraintLocation,), properties
    )


def guides(
    out: Statements, observation: "Observation", objects: dict[str, NamedNode]
) -> list[NamedNode]:
    """Every hinge and rail, with the kinds of objects that it is kept with (spec 10)."""
    kinds = {each.name: kind_of(each) for each in observation.objects}
    return [
        out.add(
            names.part(out.about, "guide", each.object),
            (CAPAR.Guide,),
            {
                CAPAR.guideKind: each.kind,
                CAPAR.dominant: objects[each.object],
                CAPAR.dominantKind: kind(out, kinds[each.object]),
                CAPAR.goal: objects[each.base],
                CAPAR.goalKind: kind(out, kinds[each.base]),
                CAPAR.eeNlt: literals.nlt(each.object_nlt),
                CAPAR.goalNlt: literals.nlt(each.base_nlt),
                CAPAR.opened: each.opened,
                CAPAR.residual: each.residual_m,
                GENERATED: out.about,
            },
        )
        for each in observation.guides
    ]


def styles(
    out: Statements, observation: "Observation", agents: dict[str, NamedNode]
) -> list[NamedNode]:
    """Every style that was seen, of whoever performed."""
    return [
        _style(out, index, each, agents[observation.performer(each.ee)])
        for index, each in enumerate(observation.styles)
    ]


def _style(out: Statements, index: int, value: Style, agent: NamedNode) -> NamedNode:
    properties: PropertyValues = {
        CAPAR.index: index,
        CAPAR.agent: agent,
        CAPAR.ofAction: action(out, value.action),
        CAPAR.actionName: value.action,
        CAPAR.purpose: value.purpose,
        CAPAR.ee: value.ee,
        CAPAR.velStyle: literals.vector(value.velocity),
        CAPAR.pathStyle: literals.path(value.path) if value.path else None,
        GENERATED: out.about,
    }
    return out.add(names.part(out.about, "style", index), (CAPAR.AgentStyle,), properties)
