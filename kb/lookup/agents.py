"""Agents and kinds of objects: what is declared and what was seen of them."""

import tomllib
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from importlib.resources import files
from typing import TypeAlias

from pyoxigraph import Literal, NamedNode, Quad

from capar.model.errors import UnknownNameError
from capar.model.figures import figures
from kb.encode import shared
from kb.errors import StoreError
from kb.lookup.pars import Pars
from kb.store import names
from kb.store.sparql import complete, stored
from kb.store.statements import LABEL, TYPE, Statements
from kb.store.stores import Store
from ontology import CAPAR

AGENTS, OBJECTS, ACTIONS = (names.GRAPHS[each] for each in ("agents", "objects", "actions"))
GENERAL = ("object", "thing")
"""What every kind is by default."""

PROFILES: Mapping[str, Mapping[str, str]] = tomllib.loads(
    (files("kb") / "store" / "queries" / "profiles.toml").read_text("utf-8")
)
"""The fields of agents and of kinds of objects, each with the pattern of its values."""

Fields: TypeAlias = dict[str, tuple[str, ...]]
"""Values by field, in the order of the listing; no values where nothing is recorded."""


@dataclass(frozen=True, slots=True, order=True)
class Ability:
    """An action that an agent is able to do, or that an object lends itself to."""

    action: str
    evidence: str
    """``declared`` or ``observed``."""


class Agents(Pars):
    """Agents and kinds in a store."""

    def kinds_above(self, kind: str) -> tuple[str, ...]:
        """A kind and every more general one, nearest first; of equally near, by alphabet."""
        direct: dict[str, set[str]] = {}
        query = f"SELECT DISTINCT ?lower ?upper {{ ?lower {CAPAR.broaderKind} ?upper }}"
        for lower, upper in self.store.ask(query).rows:
            if isinstance(lower, NamedNode) and isinstance(upper, NamedNode):
                direct.setdefault(names.last_word(lower), set()).add(names.last_word(upper))
        order = [kind]
        level = {kind}
        while level:
            level = {upper for each in level for upper in direct.get(each, ())} - set(order)
            order += sorted(level)
        return (*order, *(each for each in GENERAL if each not in order))

    def declare_agent(self, name: str, *, kind: str = "", can: Iterable[str] = ()) -> None:
        """State that there is an agent, of what kind it is, and which actions it is able to do.

        Raises:
            StoreError: There is one of that name.
        """
        node = names.shared("agent", name)
        if name in self._known_agents() or node in aliases(self.store):
            raise StoreError(f"{self.store.place}: there is an agent {name!r} already")
        quads = _declared_agent(name)
        if kind:
            of = names.shared("kind", kind)
            quads += [*_declared_kind(kind), Quad(node, CAPAR.kind, of, AGENTS)]
            if names.graph_of(of) != names.GRAPHS["ontology"]:
                above = (of, names.shared("kind", GENERAL[-1]))
                quads += [Quad(of, CAPAR.isA, each, OBJECTS) for each in above]
        self.store.insert(quads)
        for action in can:
            self.add_ability(action, agent=name)

    def agents(self) -> tuple[str, ...]:
        """Every agent, declared or seen, by name; an unnamed one by the capture that it is of."""
        return tuple(self._known_agents())

    def same_agent(self, first: str, second: str) -> None:
        """State that two agents are one: what the second did is the first one's from now on.

        Observing the second one's captures again keeps it so.

        Raises:
            UnknownNameError: There is no such agent.
            StoreError: They are one already.
        """
        agent, other = self._agent(first), self._agent(second)
        if agent == other:
            raise StoreError(f"{self.store.place}: {first!r} and {second!r} are one agent already")
        self.store.change(stored("join_agents", agent=str(agent), other=str(other)))

    def _known_agents(self) -> dict[str, NamedNode]:
        """Every agent by its label, which says of an unnamed one whose capture it is of."""
        found = {}
        for agent, name, label in self.store.ask(stored("agents")).rows:
            word = label if isinstance(label, Literal) else name
            if isinstance(agent, NamedNode) and isinstance(word, Literal):
                found[word.value] = agent
        return dict(sorted(found.items()))

    def _agent(self, name: str) -> NamedNode:
        """The agent of a label, or of a name that an earlier one was joined under."""
        agents = self._known_agents()
        node = agents.get(name) or aliases(self.store).get(names.shared("agent", name))
        if node is None:
            raise UnknownNameError("agent", name, agents, where=self.store.place)
        return node

    def agent_profile(self, name: str) -> Fields:
        """What is known of an agent, by the fields of thesis Fig 4.2; of some nothing is.

        Raises:
            UnknownNameError: There is no such agent.
        """
        return _profile(self.store, self._agent(name), PROFILES["agent"])

    def object_kinds(self) -> tuple[str, ...]:
        """Every kind of object that was observed or declared, by name."""
        rows = self.store.ask(stored("object_kinds")).rows
        found = [each for (each,) in rows if isinstance(each, NamedNode)]
        return tuple(names.last_word(each) for each in sorted(found, key=str))

    def object_profile(self, name: str) -> Fields:
        """What is known of a kind of object, by the fields of thesis Fig 4.3.

        Raises:
            UnknownNameError: There is no object and no kind of that name.
        """
        node = names.shared("kind", name)
        if name not in (known := self.object_kinds()):
            rows = self.store.ask(stored("kind_of_named", name=str(Literal(name)))).rows
            found = [each for (each,) in rows if isinstance(each, NamedNode)]
            if not found:
                raise UnknownNameError("object", name, known, where=self.store.place)
            node = found[0]
        return _profile(self.store, node, PROFILES["object"])

    def add_ability(self, action: str, *, agent: str = "", kind: str = "") -> None:
        """State that an agent is able to do an action, or that a kind lends itself to it.

        Raises:
            StoreError: Neither an agent nor a kind is named, or both are.
        """
        if bool(agent) == bool(kind):
            raise StoreError("an ability is an agent's or a kind's: name one of them")
        graph = AGENTS if agent else OBJECTS
        node = names.shared("agent", agent) if agent else names.shared("kind", kind)
        out = Statements(ACTIONS)
        word = shared.action(out, action)
        own = [] if word is None else [word]
        ability = names.part(node, "ability", action)
        self.store.insert(
            [
                *(each for each in out.quads if each.predicate != CAPAR.mentions),
                *(Quad(each, CAPAR.declared, Literal(True), ACTIONS) for each in own),
                *(_declared_agent(agent) if agent else _declared_kind(kind)),
                Quad(node, CAPAR.capability, ability, graph),
                Quad(ability, TYPE, CAPAR.Capability, graph),
                Quad(ability, LABEL, Literal(f"{agent or kind}: {action}"), graph),
                *(Quad(ability, CAPAR.action, each, graph) for each in own),
            ]
        )

    def abilities(self, of: str) -> tuple[Ability, ...]:
        """What an agent, or a kind of agent or object, was declared or observed to do."""
        kinds = " ".join(str(names.shared("kind", each)) for each in self.kinds_above(of))
        rows = [
            *self.store.ask(stored("abilities_of_agent", name=str(Literal(of)))).texts(),
            *self.store.ask(stored("abilities_of_kinds", kinds=kinds)).texts(),
        ]
        evidence = {"true": "declared", "false": "observed"}
        return tuple(sorted({Ability(action, evidence[declared]) for action, declared in rows}))


def _declared_kind(name: str) -> list[Quad]:
    """That a kind was declared, and what it is if the ontology does not know it."""
    node = names.shared("kind", name)
    stated: dict[NamedNode, NamedNode | Literal] = {CAPAR.declared: Literal(True)}
    if names.graph_of(node) != names.GRAPHS["ontology"]:
        label = Literal(name.replace("_", " "))
        stated |= {TYPE: CAPAR.ObjectKind, LABEL: label, CAPAR.name: Literal(name)}
    return [Quad(node, predicate, value, OBJECTS) for predicate, value in stated.items()]


def _declared_agent(name: str) -> list[Quad]:
    stated: dict[NamedNode, NamedNode | Literal] = {
        CAPAR.declared: Literal(True),
        TYPE: CAPAR.Agent,
        LABEL: Literal(name),
        CAPAR.name: Literal(name),
    }
    node = names.shared("agent", name)
    return [Quad(node, predicate, value, AGENTS) for predicate, value in stated.items()]


def aliases(store: Store) -> Mapping[NamedNode, NamedNode]:
    """Agents that were joined to another one, each with that one."""
    found = {
        other: agent
        for other, agent in store.ask(stored("aliases")).rows
        if isinstance(other, NamedNode) and isinstance(agent, NamedNode)
    }
    while any(agent in found for agent in found.values()):
        found = {other: found.get(agent, agent) for other, agent in found.items()}
    return found


def joined(quads: Sequence[Quad], by: Mapping[NamedNode, NamedNode]) -> list[Quad]:
    """Statements in which every agent that was joined to another one is that one."""
    return [
        Quad(each.subject, each.predicate, by.get(each.object, each.object), each.graph_name)
        if isinstance(each.object, NamedNode)
        else each
        for each in quads
        if each.subject not in by
    ]


def _profile(store: Store, node: NamedNode, fields: Mapping[str, str]) -> Fields:
    found = {}
    for field, pattern in fields.items():
        body = f"{pattern.replace('?who', str(node))} OPTIONAL {{ ?value {LABEL} ?label }}"
        rows = store.ask(complete(f"SELECT DISTINCT ?value ?label {{ {body} }}")).rows
        terms = {label or value for value, label in rows}
        found[field] = tuple(
            sorted(
                figures(each.value)
                if isinstance(each, Literal)
                else str(each).strip("<>").rsplit("/", 1)[-1]
                for each in terms
            )
        )
    return found
