"""From schema 2 to 3: facts, borders and placements that named bodies by texts refer to them."""

from collections import defaultdict
from collections.abc import Iterator, Mapping
from dataclasses import fields
from typing import Any, cast

from pyoxigraph import Literal, NamedNode, Quad

from capar.model.facts import ALL_FACT_KINDS, Fact, Observed
from kb.encode.bodies import Bodies
from kb.encode.facts import Scene, facts, rate_of
from kb.encode.scene import UNNAMED
from kb.encode.segments import BROADER
from kb.lookup.facts import in_order
from kb.lookup.stored import observations
from kb.store import names
from kb.store.sparql import fill
from kb.store.statements import LABEL, TYPE, Statements, insertion
from kb.store.stores import Store
from ontology import BASE, CAPAR

OWN: Mapping[str, tuple[str, ...]] = {
    "FramesFact": ("frames", "firstFrame", "lastFrame"),
    "RateFact": ("rate_mhz", "rateMhz"),
    "LinkFact": ("link", "ee", "effectorType", "side"),
    "TagFact": ("tag", "objectName", "tagName"),
    "ZeroCrossing": ("zero_crossing", "ee", "frame"),
    "Touching": ("touching", "body", "other", "firstFrame", "lastFrame"),
    "Gap": ("gap", "body", "other", "firstFrame", "micrometres"),
    "Moving": ("moving", "objectName", "firstFrame", "lastFrame"),
    "LookingAt": ("looking_at", "sensor", "objectName", "firstFrame", "lastFrame"),
    "ForceTransfer": ("force_transfer",),
    "Intended": ("intended", "rank", "actionName", "objectName", "goalName", "purpose"),
}
"""The classes that facts had: the predicate, and the property of each argument. All others were of
the class Fact, with a name and their arguments as one text."""

AGENT = names.shared("agent", UNNAMED)
"""The one agent that every unnamed performer was."""

_KINDS: Mapping[str, type[Observed]] = {each.predicate: each for each in ALL_FACT_KINDS}

_FACTS = f"""SELECT ?fact ?property ?value
WHERE {{ GRAPH @graph@ {{ @graph@ {CAPAR.fact} ?fact . ?fact ?property ?value }} }}"""
_BODIES = f"""SELECT ?body ?kind ?name ?ee
WHERE {{
  GRAPH @graph@ {{
    VALUES ?kind {{ {CAPAR.TagObject} {CAPAR.Link} }}
    ?body a ?kind .
    OPTIONAL {{ ?body {CAPAR.name} ?name }}
    OPTIONAL {{ ?body {CAPAR.ee} ?ee }}
  }}
}}"""
_CLOCK = f"""SELECT ?duration ?frames
WHERE {{ @graph@ {CAPAR.capture} ?c . ?c {CAPAR.duration} ?duration ; {CAPAR.frames} ?frames }}"""
_AGENTS = f"SELECT ?agent ?name WHERE {{ ?agent a {CAPAR.Agent} ; {CAPAR.name} ?name }}"

_NO_FACTS = f"""DELETE {{ GRAPH ?g {{ ?fact ?property ?value . ?g {CAPAR.fact} ?fact }} }}
WHERE {{ GRAPH ?g {{ ?g {CAPAR.fact} ?fact . ?fact ?property ?value }} }}"""
_LINK_NAMES = f"""INSERT {{ GRAPH ?g {{ ?link {CAPAR.name} ?ee }} }}
WHERE {{ GRAPH ?g {{ ?link a {CAPAR.Link} ; {CAPAR.ee} ?ee }} }}"""
_SENSORS = f"""INSERT {{ GRAPH ?g {{
  ?sensor a {CAPAR.Sensor} ; {LABEL} ?name ; {CAPAR.name} ?name
}} }}
WHERE {{
  GRAPH ?g {{
    VALUES ?property {{ {CAPAR.body} {CAPAR.other} }}
    ?thing ?property ?name .
    FILTER(isLiteral(?name))
    FILTER NOT EXISTS {{
      VALUES ?kind {{ {CAPAR.TagObject} {CAPAR.Link} }}
      ?known {CAPAR.name} ?name ; a ?kind
    }}
  }}
  BIND(IRI(CONCAT(STR(?g), "#sensor.", ENCODE_FOR_URI(?name))) AS ?sensor)
}}"""
_REFERENCES = f"""DELETE {{ GRAPH ?g {{ ?thing ?property ?name }} }}
INSERT {{ GRAPH ?g {{ ?thing ?property ?body }} }}
WHERE {{
  GRAPH ?g {{
    VALUES ?property {{ {CAPAR.body} {CAPAR.other} }}
    ?thing ?property ?name .
    FILTER(isLiteral(?name))
    VALUES ?kind {{ {CAPAR.TagObject} {CAPAR.Link} {CAPAR.Sensor} }}
    ?body {CAPAR.name} ?name ; a ?kind .
  }}
}}"""

_UNNAMED = f"""DELETE {{
  GRAPH ?g {{ ?thing ?property {AGENT} }}
}}
INSERT {{
  GRAPH ?g {{ ?thing ?property ?own }}
  GRAPH {names.GRAPHS["agents"]} {{
    ?own a {CAPAR.Agent} ; {LABEL} ?label ; {CAPAR.name} "{UNNAMED}"
  }}
}}
WHERE {{
  GRAPH ?g {{
    ?g {CAPAR.capture}/{CAPAR.name} ?capture .
    ?thing ?property {AGENT} .
  }}
  BIND(CONCAT("{UNNAMED} of ", ?capture) AS ?label)
  BIND(IRI(CONCAT("{AGENT.value}.", ENCODE_FOR_URI(?capture))) AS ?own)
}} ;
DELETE {{ GRAPH {names.GRAPHS["agents"]} {{ {AGENT} ?property ?value }} }}
WHERE {{
  GRAPH {names.GRAPHS["agents"]} {{
    {AGENT} ?property ?value
    FILTER NOT EXISTS {{ {AGENT} {CAPAR.declared} true }}
  }}
}}"""
_KINDS_OF_ACTION = f"""INSERT {{
  GRAPH {names.GRAPHS["actions"]} {{ ?action {CAPAR.kindOf} ?action }}
}}
WHERE {{ GRAPH {names.GRAPHS["actions"]} {{ ?action a {CAPAR.Action} }} }} ;
INSERT {{
  GRAPH {names.GRAPHS["actions"]} {{ ?action {CAPAR.kindOf} ?general ; {BROADER} ?general }}
}}
WHERE {{
  GRAPH ?g {{ ?segment {CAPAR.action} ?action ; {CAPAR.specialises} ?general }}
}}"""


def from_2(store: Store) -> tuple[str, ...]:
    """The updates to version 3."""
    stated = [quad for each in observations(store) for quad in _facts_of(store, each.name)]
    inserted = (insertion(stated),) if stated else ()
    references = (_NO_FACTS, _LINK_NAMES, _SENSORS, _REFERENCES)
    return (*references, *inserted, _UNNAMED, _KINDS_OF_ACTION)


def _facts_of(store: Store, name: str) -> list[Quad]:
    """The facts of an observation as they stand in version 3."""
    graph = names.observation(name)
    out = Statements(graph)
    ((duration, frames),) = store.ask(_asked(_CLOCK, graph)).rows
    found = tuple(_old_facts(store, graph))
    rate_hz = rate_of(found, frames=int(_text(frames)), duration_s=float(_text(duration)))
    scene = Scene(_bodies(store, out), _agents(store), rate_hz)
    out.add(graph, (), {CAPAR.fact: facts(out, in_order(list(found)), scene)})
    return out.quads


def _bodies(store: Store, out: Statements) -> Bodies:
    objects: dict[str, NamedNode] = {}
    links: dict[str, NamedNode] = {}
    for body, kind, name, ee in store.ask(_asked(_BODIES, out.about)).rows:
        if isinstance(body, NamedNode):
            group, called = (links, ee) if kind == CAPAR.Link else (objects, name)
            group[_text(called)] = body
    return Bodies(out, objects, links)


def _agents(store: Store) -> dict[str, NamedNode]:
    rows = store.ask(_AGENTS).rows
    return {_text(name): agent for agent, name in rows if isinstance(agent, NamedNode)}


def _old_facts(store: Store, graph: NamedNode) -> Iterator[Fact]:
    """The facts of version 2; kinds that are no longer measured are left out."""
    kinds: dict[object, str] = {}
    said: dict[object, dict[str, str]] = defaultdict(dict)
    for fact, key, value in store.ask(_asked(_FACTS, graph)).rows:
        if key == TYPE:
            kinds[fact] = _text(value).removeprefix(BASE)
        else:
            said[fact][_text(key).removeprefix(BASE)] = _text(value)
    for node, told in said.items():
        own = OWN.get(kinds.get(node, ""))
        predicate = own[0] if own else told.get("name", "")
        texts = [told[each] for each in own[1:]] if own else told["parameters"].split(" ")
        if predicate in _KINDS:
            yield _fact(_KINDS[predicate], texts)


def _fact(kind: type[Observed], texts: list[str]) -> Fact:
    pairs = zip(fields(cast(Any, kind)), texts, strict=True)
    values = (int(text) if each.type is int else text for each, text in pairs)
    return cast(Fact, cast(Any, kind)(*values))


def _asked(query: str, graph: NamedNode) -> str:
    return fill(query, graph=str(graph))


def _text(term: object) -> str:
    return term.value if isinstance(term, Literal | NamedNode) else ""
