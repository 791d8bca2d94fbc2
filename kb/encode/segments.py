"""Segments and why they begin and end, as statements."""

from typing import TYPE_CHECKING

from pyoxigraph import NamedNode

from capar.model.errors import UnknownNameError
from capar.model.observation import SegmentAddress
from capar.model.par import UNKNOWN, FeatureSet
from kb.encode.bodies import Bodies
from kb.encode.scene import GENERATED
from kb.store import names
from kb.store.statements import LABEL, PropertyValues, Statements
from ontology import CAPAR
from ontology.vocabularies import PREFIXES, TIME

if TYPE_CHECKING:
    from capar.model.observation import Border, Observation, ObservedLink, Segment

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

BROADER = NamedNode(PREFIXES["skos"] + "broaderTransitive")
MEETS = NamedNode(TIME + "intervalMeets")


def action(out: Statements, name: str) -> NamedNode | None:
    """What an action is called; the unknown has no name."""
    if name in {"", UNKNOWN}:
        return None
    node = names.shared("action", name)
    properties: PropertyValues = {LABEL: name, CAPAR.name: name, CAPAR.kindOf: node}
    return out.share(node, (CAPAR.Action,), properties)


def specific_action(out: Statements, name: str, general: tuple[str, ...]) -> NamedNode | None:
    """The action of a segment, under every more general one."""
    node = action(out, name)
    above = actions(out, general)
    if node is not None and above:
        out.add(node, (), {CAPAR.kindOf: above, BROADER: above})
    return node


def actions(out: Statements, known: tuple[str, ...]) -> list[NamedNode]:
    """Several of them."""
    return [node for each in known if (node := action(out, each)) is not None]


def features(out: Statements, value: FeatureSet) -> NamedNode:
    """A set of features, called after its bits."""
    bits = (value.rel_start, value.rel_end, value.change_loc, value.end_effector, value.force)
    properties: PropertyValues = {
        CAPAR.relStart: value.rel_start,
        CAPAR.relEnd: value.rel_end,
        CAPAR.changeLoc: value.change_loc,
        CAPAR.effectorType: value.end_effector,
        CAPAR.forceApplied: value.force,
        CAPAR.objectCount: value.count,
    }
    return out.share(names.shared("features", *(bits)), (CAPAR.FeatureSet,), properties)


def segment_node(about: NamedNode, ee: str, index: int) -> NamedNode:
    """What a segment is called."""
    return names.part(about, "segment", ee, index)


def segments(
    out: Statements,
    observation: "Observation",
    links: dict[str, NamedNode],
    objects: dict[str, NamedNode],
    bodies: Bodies,
    rules: dict[str, NamedNode],
) -> list[NamedNode]:
    """Every segment, links in order, with how it stands to others."""
    for each in observation.relations:
        node, other = (segment_node(out.about, *key) for key in (each.segment, each.other))
        out.add(node, (), {_RELATIONS[each.kind]: other})
    return [
        _segment(out, link, each, links[link.ee], objects, bodies, rules)
        for link in observation.links
        for each in link.segments
    ]


_RELATIONS = {
    "same_action": CAPAR.sameAction,
    "resumes": CAPAR.resumes,
    "fragment_of": CAPAR.fragmentOf,
    "rights": CAPAR.rights,
    "steadies": CAPAR.steadies,
}


def _segment(
    out: Statements,
    link: "ObservedLink",
    seen: "Segment",
    link_node: NamedNode,
    objects: dict[str, NamedNode],
    bodies: Bodies,
    rules: dict[str, NamedNode],
) -> NamedNode:
    node = segment_node(out.about, seen.ee, seen.index)
    after = seen.index + 1
    follows = segment_node(out.about, seen.ee, after) if after < len(link.segments) else None
    properties: PropertyValues = {
        LABEL: f"{seen.ee} {seen.index}: {seen.name}",
        CAPAR.ofLink: link_node,
        CAPAR.ee: seen.ee,
        CAPAR.index: seen.index,
        CAPAR.address: str(SegmentAddress(seen.ee, seen.index, names.observation_name(out.about))),
        CAPAR.firstFrame: seen.first,
        CAPAR.lastFrame: seen.last,
        CAPAR.start: float(seen.start_s),
        CAPAR.end: float(seen.end_s),
        CAPAR.duration: float(seen.end_s - seen.start_s),
        CAPAR.action: specific_action(out, seen.name, seen.general),
        CAPAR.namedBy: rules.get(seen.name),
        CAPAR.general: " ".join(seen.general),
        CAPAR.specialises: actions(out, seen.general),
        CAPAR.candidate: actions(out, seen.candidates),
        CAPAR.failedAt: seen.level,
        CAPAR.possesses: seen.possessed,
        CAPAR.objects: " ".join(seen.objects),
        CAPAR.object: [objects[each] for each in seen.objects if each in objects],
        CAPAR.dominant: objects.get(seen.objects[0]) if seen.objects else None,
        CAPAR.subordinate: [objects[each] for each in seen.objects[1:] if each in objects],
        CAPAR.features: features(out, seen.features),
        CAPAR.beginsWith: _borders(out, node, "begin", seen.begins, bodies),
        CAPAR.endsWith: _borders(out, node, "end", seen.ends, bodies),
        CAPAR.placement: _placements(out, node, seen.prepositions, bodies),
        CAPAR.look: _looks(out, node, seen.looks, objects),
        CAPAR.purpose: seen.purpose,
        CAPAR.next: follows,
        MEETS: follows,
        GENERATED: out.about,
    }
    kinds = (CAPAR.Segment,) if seen.known else (CAPAR.Segment, CAPAR.UnknownSegment)
    return out.add(node, kinds, properties)


def border_kind(word: str) -> NamedNode:
    """What happens at a border, by its word.

    Raises:
        UnknownNameError: Nothing of that name may happen there.
    """
    if word not in BORDER_KINDS:
        raise UnknownNameError("kind of border", word, BORDER_KINDS)
    return BORDER_KINDS[word]


def _placements(
    out: Statements,
    of: NamedNode,
    prepositions: tuple[tuple[str, str, str], ...],
    bodies: Bodies,
) -> list[NamedNode]:
    return [
        out.add(
            names.part(of, "placement", index),
            (CAPAR.Placement,),
            {
                CAPAR.preposition: preposition,
                CAPAR.body: bodies[body],
                CAPAR.other: bodies[other],
            },
        )
        for index, (preposition, body, other) in enumerate(prepositions)
    ]


def _looks(
    out: Statements,
    of: NamedNode,
    looks: tuple[tuple[str, str], ...],
    objects: dict[str, NamedNode],
) -> list[NamedNode]:
    return [
        out.add(
            names.part(of, "look", index),
            (CAPAR.Look,),
            {CAPAR.seen: objects[seen], CAPAR.when: when},
        )
        for index, (seen, when) in enumerate(looks)
        if seen in objects
    ]


def _borders(
    out: Statements, of: NamedNode, where: str, borders: "tuple[Border, ...]", bodies: Bodies
) -> list[NamedNode]:
    return [
        out.add(
            names.part(of, where, index),
            (CAPAR.Border,),
            {
                CAPAR.index: index,
                CAPAR.borderKind: border_kind(each.kind),
                CAPAR.body: bodies[each.body] if each.body else None,
                CAPAR.other: bodies[each.other] if each.other else None,
            },
        )
        for index, each in enumerate(borders)
    ]
