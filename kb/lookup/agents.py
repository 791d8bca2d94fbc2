"""Agents: declared ones, those that performed, and which of them are one person."""

from collections.abc import Mapping, Sequence

from pyoxigraph import Literal, NamedNode, Quad

from capar.model.errors import UnknownNameError
from kb.errors import StoreError
from kb.lookup import kinds
from kb.store import names
from kb.store.sparql import fill
from kb.store.statements import LABEL, TYPE
from kb.store.stores import Store
from ontology import CAPAR
from ontology.vocabularies import OWL

GRAPH = names.GRAPHS["agents"]
SAME_AS = NamedNode(OWL + "sameAs")

_ALL = f"""SELECT ?agent ?name ?label
WHERE {{ ?agent a {CAPAR.Agent} ; {CAPAR.name} ?name . OPTIONAL {{ ?agent {LABEL} ?label }} }}"""

_ALIASES = f"SELECT ?other ?agent WHERE {{ GRAPH {GRAPH} {{ ?other {SAME_AS} ?agent }} }}"

_JOIN = f"""DELETE {{ GRAPH ?graph {{ ?thing ?property @other@ }} }}
INSERT {{ GRAPH ?graph {{ ?thing ?property @agent@ }} }}
WHERE {{ GRAPH ?graph {{ ?thing ?property @other@ }} }} ;
INSERT {{ GRAPH {GRAPH} {{ @agent@ ?property ?value }} }}
WHERE {{ GRAPH {GRAPH} {{ @other@ ?property ?value }}
  VALUES ?property {{ {CAPAR.capability} {CAPAR.nominal} {CAPAR.kind} }} }} ;
DELETE WHERE {{ GRAPH {GRAPH} {{ @other@ ?property ?value }} }} ;
INSERT DATA {{ GRAPH {GRAPH} {{
  @other@ {SAME_AS} @agent@ ; {CAPAR.declared} true . @agent@ {CAPAR.declared} true . }} }}"""


def known(store: Store) -> dict[str, NamedNode]:
    """Every agent by its label, which says of an unnamed one whose capture it is of."""
    found = {}
    for agent, name, label in store.ask(_ALL).rows:
        word = label if isinstance(label, Literal) else name
        if isinstance(agent, NamedNode) and isinstance(word, Literal):
            found[word.value] = agent
    return dict(sorted(found.items()))


def node_of(store: Store, name: str) -> NamedNode:
    """The agent of a label, or of a name that an earlier one was joined under.

    Raises:
        UnknownNameError: There is none.
    """
    agents = known(store)
    if name in agents:
        return agents[name]
    given = names.shared("agent", name)
    joined = aliases(store)
    if given not in joined:
        raise UnknownNameError("agent", name, agents, where=store.place)
    return joined[given]


def declare(store: Store, name: str, *, kind: str = "") -> None:
    """State that there is an agent, and of what kind it is.

    Raises:
        StoreError: There is one of that name.
    """
    if name in known(store) or names.shared("agent", name) in aliases(store):
        raise StoreError(f"{store.place}: there is an agent {name!r} already")
    node = names.shared("agent", name)
    quads = [
        Quad(node, TYPE, CAPAR.Agent, GRAPH),
        Quad(node, LABEL, Literal(name), GRAPH),
        Quad(node, CAPAR.name, Literal(name), GRAPH),
        Quad(node, CAPAR.declared, Literal(True), GRAPH),
    ]
    if kind:
        quads += [*kinds.by_itself(kind), Quad(node, CAPAR.kind, names.shared("kind", kind), GRAPH)]
    store.insert(quads)


def same(store: Store, first: str, second: str) -> None:
    """State that two agents are one: what the second did is the first one's from now on.

    Observing the second one's captures again keeps it so.

    Raises:
        UnknownNameError: There is no such agent.
        StoreError: They are one already.
    """
    agent, other = node_of(store, first), node_of(store, second)
    if agent == other:
        raise StoreError(f"{store.place}: {first!r} and {second!r} are one agent already")
    store.change(fill(_JOIN, agent=str(agent), other=str(other)))


def aliases(store: Store) -> Mapping[NamedNode, NamedNode]:
    """Agents that were joined to another one, each with that one."""
    direct = {
        other: agent
        for other, agent in store.ask(_ALIASES).rows
        if isinstance(other, NamedNode) and isinstance(agent, NamedNode)
    }
    return {other: _last(agent, direct) for other, agent in direct.items()}


def _last(agent: NamedNode, joined_to: Mapping[NamedNode, NamedNode]) -> NamedNode:
    while agent in joined_to:
        agent = joined_to[agent]
    return agent


def joined(quads: Sequence[Quad], by: Mapping[NamedNode, NamedNode]) -> list[Quad]:
    """Statements in which every agent that was joined to another one is that one."""
    return [
        Quad(each.subject, each.predicate, by.get(each.object, each.object), each.graph_name)
        if isinstance(each.object, NamedNode)
        else each
        for each in quads
        if each.subject not in by
    ]
