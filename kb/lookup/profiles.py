"""What is known of an agent or a kind of object, field by field of the thesis's listings."""

from pyoxigraph import Literal, NamedNode

from capar.model.errors import UnknownNameError
from kb.lookup import agents
from kb.store import names
from kb.store.sparql import fill
from kb.store.statements import LABEL
from kb.store.stores import Store
from ontology import CAPAR

Fields = dict[str, tuple[str, ...]]
"""Values by field, in the order of the listing; no values where nothing is recorded."""

_ABLE = f"{CAPAR.capability}/{CAPAR.action}/{CAPAR.name}"
_NOMINAL = f"""?who {CAPAR.nominal} ?range .
  ?range {CAPAR.parameter} ?parameter ; {CAPAR.mean} ?mean .
  OPTIONAL {{ ?range {CAPAR.standardDeviation} ?deviation }}
  BIND(COALESCE(CONCAT(" +- ", STR(?deviation)), "") AS ?spread)
  BIND(CONCAT(?parameter, " ", STR(?mean), ?spread) AS ?value)"""
_MEASURE = f"""?part {CAPAR.agent} ?who ; {CAPAR.measure} ?measure .
  ?measure {CAPAR.name} ?parameter ; {CAPAR.value} ?number .
  BIND(CONCAT(?parameter, " ", STR(?number)) AS ?value)"""
_STYLE = f"""?style a {CAPAR.AgentStyle} ; {CAPAR.agent} ?who ; {CAPAR.actionName} ?action ;
    {CAPAR.ee} ?ee . BIND(CONCAT(?action, " with ", ?ee) AS ?value)"""
_PLACE = f"""?place a {CAPAR.ConstraintLocation} ; {CAPAR.goalKind}|{CAPAR.dominantKind} ?who ;
    {CAPAR.actionName} ?action . OPTIONAL {{ ?place {CAPAR.purpose} ?purpose }}
  BIND(IF(COALESCE(?purpose, "") != "", CONCAT(" for ", ?purpose), "") AS ?aim)
  BIND(CONCAT(?action, ?aim) AS ?value)"""
_PART = f"?thing {CAPAR.kind} ?who . "

AGENT = {
    "kind": f"{{ ?who {CAPAR.kind} ?value }} UNION {{ ?part a {CAPAR.Performer} ; "
    f"{CAPAR.agent} ?who ; {CAPAR.kind} ?value }}",
    "captures": f"?seen {CAPAR.performer}/{CAPAR.agent} ?who ; {CAPAR.capture}/{CAPAR.name} ?value",
    "coordinate system": f"?who {CAPAR.coordinateSystem}/{CAPAR.position} ?value",
    "state": f"?who {CAPAR.state} ?value",
    "directions": f"?who {CAPAR.relativeDirection}|{CAPAR.specialDirection} ?value",
    "grasp sites": f"?who {CAPAR.graspSite}/{CAPAR.position} ?value",
    "capabilities (declared)": f"?who {_ABLE} ?value",
    "capabilities (observed)": f"?segment {CAPAR.ofLink}/{CAPAR.agent} ?who ; "
    f"{CAPAR.action}/{CAPAR.name} ?value",
    "nominal value ranges": _NOMINAL,
    "measures": _MEASURE,
    "styles": _STYLE,
}
"""Fields of an agent (thesis Fig 4.2), each with the pattern that gives its values."""

OBJECT = {
    "more general": f"?who {CAPAR.isA} ?value . FILTER(?value != ?who)",
    "captures": f"{_PART}?seen {CAPAR.object} ?thing ; {CAPAR.capture}/{CAPAR.name} ?value",
    "objects": f"{_PART}?thing a {CAPAR.TagObject} ; {CAPAR.name} ?value",
    "tag": f"{_PART}?thing {CAPAR.tag} ?value",
    "size [m]": f"{_PART}?thing {CAPAR.size} ?value",
    "shape": f"{_PART}?thing {CAPAR.shape} ?value",
    "coordinate system": f"{_PART}?thing {CAPAR.coordinateSystem}/{CAPAR.position} ?value",
    "state: damping": f"{_PART}?thing {CAPAR.state}/{CAPAR.dampingForce} ?value",
    "state: restitution": f"{_PART}?thing {CAPAR.state}/{CAPAR.restitution} ?value",
    "directions": f"{_PART}?thing {CAPAR.relativeDirection}|{CAPAR.specialDirection} ?value",
    "grasp sites": f"{_PART}?thing {CAPAR.graspSite}/{CAPAR.position} ?value",
    "actions (declared)": f"?who {CAPAR.affords}/{CAPAR.name}|{_ABLE} ?value",
    "actions (observed)": f"{_PART}?segment a {CAPAR.Segment} ; {CAPAR.dominant} ?thing ; "
    f"{CAPAR.action}/{CAPAR.name} ?value",
    "constraint locations": _PLACE,
}
"""Fields of a kind of object (thesis Fig 4.3), each with the pattern that gives its values."""

_KINDS = f"""SELECT DISTINCT ?kind
WHERE {{ {{ ?thing a {CAPAR.TagObject} ; {CAPAR.kind} ?kind }}
  UNION {{ ?kind a {CAPAR.ObjectKind} ; {CAPAR.declared} true .
    FILTER NOT EXISTS {{ ?who a {CAPAR.Agent} ; {CAPAR.kind} ?kind }} }} }}"""

_NAMED = f"SELECT DISTINCT ?kind WHERE {{ ?thing {CAPAR.name} @name@ ; {CAPAR.kind} ?kind }}"


def agent(store: Store, name: str) -> Fields:
    """The fields of an agent.

    Raises:
        UnknownNameError: There is none of that name.
    """
    return _filled(store, agents.node_of(store, name), AGENT)


def kind(store: Store, name: str) -> Fields:
    """The fields of a kind of object, or of the kind of the object of that name.

    Raises:
        UnknownNameError: There is none of that name.
    """
    node = names.shared("kind", name)
    if node not in (known := kinds(store)).values():
        rows = store.ask(fill(_NAMED, name=str(Literal(name)))).rows
        found = [each for (each,) in rows if isinstance(each, NamedNode)]
        if not found:
            raise UnknownNameError("object", name, known, where=store.place)
        node = found[0]
    return _filled(store, node, OBJECT)


def kinds(store: Store) -> dict[str, NamedNode]:
    """The kinds of objects that were observed or declared, by name."""
    found = [each for (each,) in store.ask(_KINDS).rows if isinstance(each, NamedNode)]
    return {names.last_word(each): each for each in sorted(found, key=str)}


def _filled(store: Store, node: NamedNode, fields: dict[str, str]) -> Fields:
    return {field: _values(store, node, pattern) for field, pattern in fields.items()}


def _values(store: Store, node: NamedNode, pattern: str) -> tuple[str, ...]:
    body = pattern.replace("?who", str(node))
    rows = store.ask(
        f"SELECT DISTINCT ?value ?label WHERE {{ {body} OPTIONAL {{ ?value {LABEL} ?label }} }}"
    ).rows
    return tuple(sorted({_told(label or value) for value, label in rows}))


def _told(term: object) -> str:
    return term.value if isinstance(term, Literal) else str(term).strip("<>").rsplit("/", 1)[-1]
