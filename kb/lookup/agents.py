"""Agents and kinds of objects: what is declared and what was seen of them."""

import tomllib
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from importlib.resources import files
from typing import TypeAlias

from pyoxigraph import Literal, NamedNode, Quad

from capar.model.errors import UnknownNameError
from capar.model.par import Condition, Upar
from kb.encode import shared
from kb.errors import StoreError
from kb.lookup.pars import Pars
from kb.store import names
from kb.store.sparql import complete, stored
from kb.store.statements import LABEL, TYPE, Statements, insertion
from kb.store.stores import Store
from ontology import CAPAR
from ontology.files import closure
from ontology.namespace import OWL

AGENTS, OBJECTS, ACTIONS = (names.GRAPHS[each] for each in ("agents", "objects", "actions"))
SAME_AS = NamedNode(OWL + "sameAs")
GENERAL = ("object", "thing")
"""What every kind is by default."""

_PROFILES = (files("kb") / "store" / "queries" / "profiles.toml").read_text("utf-8")
PROFILES: Mapping[str, Mapping[str, str]] = tomllib.loads(_PROFILES)
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

    def define_kind(self, name: str, *, broader: str = "object") -> None:
        """State that a kind of object or agent is a case of a more general one.

        Raises:
            StoreError: The more general kind would be a case of this one.
        """
        if name == broader or name in self.kinds_above(broader):
            raise StoreError(
                f"{broader!r} is a kind of {name!r} already; "
                "a kind cannot be more general than itself"
            )
        direct = _pairs(self.store, CAPAR.broaderKind) | {(name, broader)}
        if not any(lower == broader for lower, _ in direct) and broader not in GENERAL:
            direct.add((broader, "object"))
        whole = closure(sorted(direct))
        closed = {(lower, upper) for lower, uppers in whole.items() for upper in (lower, *uppers)}
        quads = [
            Quad(names.shared("kind", lower), CAPAR.isA, names.shared("kind", upper), OBJECTS)
            for lower, upper in sorted(closed - _pairs(self.store, CAPAR.isA))
        ]
        quads += [*_declared_kind(name), *_declared_kind(broader)]
        node, general = names.shared("kind", name), names.shared("kind", broader)
        quads.append(Quad(node, CAPAR.broaderKind, general, OBJECTS))
        self.store.change(insertion(quads))

    def kinds_above(self, kind: str) -> tuple[str, ...]:
        """A kind and every more general one, nearest first; of equally near, by alphabet."""
        direct: dict[str, set[str]] = {}
        for lower, upper in _pairs(self.store, CAPAR.broaderKind):
            direct.setdefault(lower, set()).add(upper)
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
        if name in _known_agents(self.store) or node in aliases(self.store):
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
        return tuple(_known_agents(self.store))

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

    def _agent(self, name: str) -> NamedNode:
        """The agent of a label, or of a name that an earlier one was joined under."""
        agents = _known_agents(self.store)
        if name in agents:
            return agents[name]
        given = names.shared("agent", name)
        joined_to = aliases(self.store)
        if given not in joined_to:
            raise UnknownNameError("agent", name, agents, where=self.store.place)
        return joined_to[given]

    def agent_profile(self, name: str) -> Fields:
        """What is known of an agent, by the fields of thesis Fig 4.2; of some nothing is.

        Raises:
            UnknownNameError: There is no such agent.
        """
        return _profile(self.store, self._agent(name), PROFILES["agent"])

    def object_kinds(self) -> tuple[str, ...]:
        """Every kind of object that was observed or declared, by name."""
        found = [
            each
            for (each,) in self.store.ask(stored("object_kinds")).rows
            if isinstance(each, NamedNode)
        ]
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

    def add_ability(
        self, action: str, *, agent: str = "", kind: str = "", conditions: Iterable[Condition] = ()
    ) -> None:
        """State that an agent is able to do an action, or that a kind lends itself to it.

        Args:
            action: Name of the action.
            agent: Name of the agent; or
            kind: Name of the kind of agents or objects.
            conditions: What else must hold.

        Raises:
            StoreError: Neither of them is named, or both are.
        """
        if bool(agent) == bool(kind):
            raise StoreError("an ability is an agent's or a kind's: name one of them")
        graph = AGENTS if agent else OBJECTS
        node = names.shared("agent", agent) if agent else names.shared("kind", kind)
        out = Statements(ACTIONS)
        needs = shared.conditions(out, conditions)
        word = shared.action(out, action)
        own = [] if word is None else [word]
        quads = [each for each in out.quads if each.predicate != CAPAR.mentions]
        quads += [Quad(each, CAPAR.declared, Literal(True), ACTIONS) for each in (*own, *needs)]
        quads += _declared_agent(agent) if agent else _declared_kind(kind)
        ability = names.part(node, "ability", action)
        quads += [
            Quad(node, CAPAR.capability, ability, graph),
            Quad(ability, TYPE, CAPAR.Capability, graph),
            Quad(ability, LABEL, Literal(f"{agent or kind}: {action}"), graph),
            *(Quad(ability, CAPAR.action, each, graph) for each in own),
            *(Quad(ability, CAPAR.applicability, each, graph) for each in needs),
        ]
        self.store.insert(quads)

    def abilities(self, of: str) -> tuple[Ability, ...]:
        """What an agent, or a kind of agent or object, was declared or observed to do."""
        kinds = " ".join(str(names.shared("kind", each)) for each in self.kinds_above(of))
        rows = [
            *self.store.ask(stored("abilities_of_agent", name=str(Literal(of)))).texts(),
            *self.store.ask(stored("abilities_of_kinds", kinds=kinds)).texts(),
        ]
        evidence = {"true": "declared", "false": "observed"}
        return tuple(sorted({Ability(action, evidence[declared]) for action, declared in rows}))

    def unmet(
        self, action: str, *, agent: str, objects: Iterable[str] = ()
    ) -> tuple[Condition, ...]:
        """Conditions of an action's applicability that nothing known speaks for (thesis 4.6.1.4).

        Args:
            action: Name of the action.
            agent: Name of the agent.
            objects: Kinds of the objects, dominant first.

        Raises:
            UnknownNameError: The action is not known.
        """
        things = tuple(objects)
        known = self.upars(action)
        if not known:
            every = {each.name for each in self.upars()}
            raise UnknownNameError("action", action, every, where=self.store.place)
        fitting = [each for each in known if len(each.objects) == len(things)] or list(known)
        upar = fitting[0]
        return tuple(
            each for each in upar.applicability if not self._met(upar, each, agent, things)
        )

    def _met(self, upar: Upar, value: Condition, agent: str, objects: tuple[str, ...]) -> bool:
        """Whether an ability speaks for a condition; only capability is known before the act."""
        if value.kind != "capable" or len(value.arguments) != 2:
            return False
        bound = dict(zip(upar.objects, objects, strict=False)) | {upar.agent: agent}
        who, action = value.arguments
        able = any(each.action == action for each in self.abilities(bound.get(who, who)))
        return able is value.holds


def _pairs(store: Store, predicate: NamedNode) -> set[tuple[str, str]]:
    """The kinds that a property relates."""
    rows = store.ask(f"SELECT DISTINCT ?lower ?upper WHERE {{ ?lower {predicate} ?upper }}").rows
    return {
        (names.last_word(lower), names.last_word(upper))
        for lower, upper in rows
        if isinstance(lower, NamedNode) and isinstance(upper, NamedNode)
    }


def _declared_kind(name: str) -> list[Quad]:
    """That a kind was declared, and what it is if the ontology does not know it."""
    node = names.shared("kind", name)
    stated: list[tuple[NamedNode, NamedNode | Literal]] = [(CAPAR.declared, Literal(True))]
    if names.graph_of(node) != names.GRAPHS["ontology"]:
        stated += [
            (TYPE, CAPAR.ObjectKind),
            (LABEL, Literal(name.replace("_", " "))),
            (CAPAR.name, Literal(name)),
        ]
    return [Quad(node, predicate, value, OBJECTS) for predicate, value in stated]


def _declared_agent(name: str) -> list[Quad]:
    node = names.shared("agent", name)
    return [
        Quad(node, CAPAR.declared, Literal(True), AGENTS),
        Quad(node, TYPE, CAPAR.Agent, AGENTS),
        Quad(node, LABEL, Literal(name), AGENTS),
        Quad(node, CAPAR.name, Literal(name), AGENTS),
    ]


def _known_agents(store: Store) -> dict[str, NamedNode]:
    """Every agent by its label, which says of an unnamed one whose capture it is of."""
    found = {}
    for agent, name, label in store.ask(stored("agents")).rows:
        word = label if isinstance(label, Literal) else name
        if isinstance(agent, NamedNode) and isinstance(word, Literal):
            found[word.value] = agent
    return dict(sorted(found.items()))


def aliases(store: Store) -> Mapping[NamedNode, NamedNode]:
    """Agents that were joined to another one, each with that one."""
    direct = {
        other: agent
        for other, agent in store.ask(stored("aliases")).rows
        if isinstance(other, NamedNode) and isinstance(agent, NamedNode)
    }

    def last(agent: NamedNode) -> NamedNode:
        return last(direct[agent]) if agent in direct else agent

    return {other: last(agent) for other, agent in direct.items()}


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
    return {field: _values(store, node, pattern) for field, pattern in fields.items()}


def _values(store: Store, node: NamedNode, pattern: str) -> tuple[str, ...]:
    body = pattern.replace("?who", str(node))
    labels = f"OPTIONAL {{ ?value {LABEL} ?label }}"
    rows = store.ask(complete(f"SELECT DISTINCT ?value ?label {{ {body} {labels} }}")).rows
    return tuple(sorted({_word(label or value) for value, label in rows}))


def _word(term: object) -> str:
    return term.value if isinstance(term, Literal) else str(term).strip("<>").rsplit("/", 1)[-1]
