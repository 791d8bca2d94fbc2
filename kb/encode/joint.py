"""What several end-effectors did with one object as one action, as statements."""

from typing import TYPE_CHECKING

from pyoxigraph import NamedNode

from kb.encode.scene import GENERATED
from kb.encode.segments import action, segment_node
from kb.store import names
from kb.store.statements import LABEL, PropertyValues, Statements
from ontology import CAPAR

if TYPE_CHECKING:
    from capar.model.observation import JointAction, Observation


def joint_actions(
    out: Statements, observation: "Observation", objects: dict[str, NamedNode]
) -> list[NamedNode]:
    """Every joint action, in order of time."""
    return [_joint(out, index, each, objects) for index, each in enumerate(observation.joint)]


def _joint(
    out: Statements, index: int, seen: "JointAction", objects: dict[str, NamedNode]
) -> NamedNode:
    parts = zip(seen.ees, seen.segments, strict=True)
    properties: PropertyValues = {
        LABEL: f"{', '.join(seen.who)}: {seen.name}",
        CAPAR.index: index,
        CAPAR.action: action(out, seen.name),
        CAPAR.name: seen.name,
        CAPAR.effectors: " ".join(seen.who),
        CAPAR.objects: " ".join(seen.objects),
        CAPAR.dominant: objects.get(seen.objects[0]),
        CAPAR.object: [objects[each] for each in seen.objects if each in objects],
        CAPAR.standsFor: [segment_node(out.about, ee, number) for ee, number in parts],
        CAPAR.firstFrame: seen.first,
        CAPAR.lastFrame: seen.last,
        CAPAR.start: float(seen.start_s),
        CAPAR.end: float(seen.end_s),
        CAPAR.duration: float(seen.end_s - seen.start_s),
        GENERATED: out.about,
    }
    return out.add(names.part(out.about, "joint", index), (CAPAR.JointAction,), properties)
