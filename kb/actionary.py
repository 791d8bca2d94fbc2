"""The Actionary: what was observed, as knowledge that lasts and answers (thesis 4.1.2)."""

from collections.abc import Iterable
from pathlib import Path
from types import TracebackType
from typing import TYPE_CHECKING, Any, Self

from pyoxigraph import Literal, NamedNode, Quad, Triple

from capar.model.par import (
    ComplexPar,
    Condition,
    ConstraintLocation,
    FeatureSet,
    Ipar,
    Style,
    Upar,
)
from kb import names, sparql, writing
from kb.answers import Answer, Plain
from kb.errors import StoreError
from kb.findings import Ability, Added, FeatureRow, FoundLocation, FoundStyle, Stored
from kb.lookup import abilities, feature_table, kinds, locations, pars, recognition, stored, styles
from kb.questions import question
from kb.store import Store, open_store
from kb.store import place as default_place
from ontology import CAPAR
from ontology import files as ontology_files

if TYPE_CHECKING:
    from capar.model.observation import Observation

TIME_LIMIT_S = 30.0
"""How long a user's query may take, unless the user says otherwise [s]."""


class Actionary:
    """Observations, the actions, agents and objects that they are of, and the ontology."""

    def __init__(self, store: Store, *, read_only: bool = False) -> None:
        """Take a store; one that is written gets the present ontology if it has another.

        Raises:
            StoreError: The store answers like no Actionary.
        """
        self.store = store
        if not read_only:
            self._prepare()

    @classmethod
    def open(
        cls, where: str | Path | None = None, *, read_only: bool = False, wait_s: float = 0.0
    ) -> Self:
        """The Actionary in a folder or at a server's address.

        Args:
            where: Folder or address; by default CAPAR_ACTIONARY, else ``./actionary``.
            read_only: Whether it is only read, which any number may do beside a writer.
            wait_s: How long to wait for another writer [s].

        Raises:
            LockedError: Another process writes the folder.
            StoreError: There is nothing to read, or it cannot be used.
        """
        target = default_place(str(where) if where is not None else None)
        return cls(open_store(target, read_only=read_only, wait_s=wait_s), read_only=read_only)

    @classmethod
    def in_memory(cls) -> Self:
        """An Actionary that ends with the process."""
        return cls(open_store(None))

    def __enter__(self) -> Self:
        """Use it in a ``with`` statement, which closes it."""
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        """Close it."""
        self.close()

    def close(self) -> None:
        """Let go of the store."""
        self.store.close()

    def refresh(self) -> None:
        """See what others have written since it was opened."""
        self.store.refresh()

    def _prepare(self) -> None:
        graph = names.GRAPHS["ontology"]
        digest = ontology_files.digest()
        known = self.store.ask(f'ASK {{ {graph} {CAPAR.sha256} "{digest}" }}')
        if not known.boolean:
            stated = [_in(each, graph) for each in ontology_files.ontology()]
            mark = Quad(graph, CAPAR.sha256, Literal(digest), graph)
            self.store.change(writing.graph_replacement(graph, [*stated, mark]))
            if not self.store.ask(f'ASK {{ {graph} {CAPAR.sha256} "{digest}" }}').boolean:
                raise StoreError(
                    f"{self.store.place}: its default graph is not the union of the named ones; "
                    "configure the server so (oxigraph serve --union-default-graph)"
                )

    # Observations

    def add(
        self, observation: "Observation", *, name: str | None = None, replace: bool = False
    ) -> Added:
        """Keep an observation; it is whole, checked and lasting when this returns.

        An observation of the same capture (its files, frames and performer) is replaced.

        Args:
            observation: What was understood of a capture.
            name: What its complex action is called; by default the observation's own name for
                it, else the name under which it is known, else the capture's.
            replace: Whether to replace an observation of another capture of the same name.

        Raises:
            ExistsError: Another capture of the same name is there.
            ShapeError: It breaks the model.
        """
        return stored.add(self.store, observation, name=name, replace=replace)

    def forget(self, name: str) -> None:
        """Take an observation back, and everything that nothing else says.

        Raises:
            UnknownNameError: There is no observation of that name.
        """
        stored.forget(self.store, name)

    def observations(self) -> tuple[Stored, ...]:
        """Every observation, by name."""
        return stored.observations(self.store)

    # Actions

    def recognise(self, value: ComplexPar) -> str | None:
        """The name under which a complex action is known, whoever performed it."""
        return recognition.recognise(self.store, value)

    def find_pars(
        self,
        *,
        action: str | None = None,
        objects: Iterable[str] = (),
        performer: str | None = None,
    ) -> tuple[Stored, ...]:
        """Observations of complex actions that fit.

        Args:
            action: Name of the complex action, or of a step of it.
            objects: Kinds or names of objects, all of which take part.
            performer: Name of the agent.
        """
        return pars.find(self.store, action=action, objects=tuple(objects), performer=performer)

    def complex_par(self, name: str) -> ComplexPar:
        """A complex action as it was observed: by the observation's name, or by its own.

        Raises:
            UnknownNameError: There is none.
        """
        return pars.complex_par(self.store, name)

    def upars(self, name: str | None = None) -> tuple[Upar, ...]:
        """Uninstantiated actions of a name, or all of them, by name and number of objects."""
        return pars.upars(self.store, name)

    def ipars(self, observation: str) -> tuple[Ipar, ...]:
        """The instantiated actions of an observation, links in order.

        Raises:
            UnknownNameError: There is no such observation.
        """
        return pars.ipars(self.store, observation)

    def effective(self, ipar: Ipar) -> Upar:
        """An action as it is to be done: what the IPAR says overrides its UPAR (thesis 4.1.2).

        Raises:
            UnknownNameError: Its UPAR is not known.
        """
        return pars.effective(self.upars(ipar.upar), ipar)

    # Features

    def feature_table(self) -> tuple[FeatureRow, ...]:
        """Known sets of features with their names (thesis 4.5), sorted."""
        return feature_table.rows(self.store)

    def add_feature_row(
        self, name: str, features: FeatureSet, *, general: Iterable[str] = ()
    ) -> FeatureRow:
        """Name a set of features; it stays when observations are forgotten.

        Raises:
            ParError: Another name was given to the same set of features.
        """
        return feature_table.add(self.store, name, features, tuple(general))

    # Objects, agents and what is stored with them

    def define_kind(self, name: str, *, broader: str = "object") -> None:
        """State that a kind of object or agent is a case of a more general one.

        Raises:
            StoreError: The more general kind would be a case of this one.
        """
        kinds.define(self.store, name, broader)

    def kinds_above(self, kind: str) -> tuple[str, ...]:
        """A kind and every more general one, nearest first."""
        return kinds.above(self.store, kind)

    def locations(
        self,
        kind: str,
        *,
        action: str | None = None,
        purpose: str | None = None,
        side: str | None = None,
    ) -> tuple[FoundLocation, ...]:
        """Constraint locations for a kind of object, best first.

        Those of the kind itself stand before those of more general kinds, those of the side
        before those mirrored from the other one; then by observation.
        """
        return locations.find(self.store, kind, action=action, purpose=purpose, side=side)

    def location(
        self, kind: str, *, action: str, purpose: str | None = None, side: str | None = None
    ) -> ConstraintLocation | None:
        """The best constraint location for a kind of object, mirrored if need be."""
        found = self.locations(kind, action=action, purpose=purpose, side=side)
        return found[0].location if found else None

    def styles(
        self,
        *,
        agent: str | None = None,
        action: str | None = None,
        purpose: str | None = None,
        ee: str | None = None,
    ) -> tuple[FoundStyle, ...]:
        """Styles that fit, by observation."""
        return styles.find(self.store, agent=agent, action=action, purpose=purpose, ee=ee)

    def style(
        self, agent: str, *, action: str, purpose: str | None = None, ee: str | None = None
    ) -> Style | None:
        """An agent's style of doing an action, from the first observation by name."""
        found = self.styles(agent=agent, action=action, purpose=purpose, ee=ee)
        return found[0].style if found else None

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
        abilities.declare(self.store, action, tuple(conditions), agent=agent, kind=kind)

    def abilities(self, of: str) -> tuple[Ability, ...]:
        """What an agent, or a kind of agent or object, was declared or observed to do."""
        return abilities.of(self.store, of)

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
        return abilities.unmet(self.store, action, agent, tuple(objects))

    # Questions

    def ask(self, name: str, **parameters: object) -> list[dict[str, Plain]]:
        """The rows that answer a named question, as plain values.

        Raises:
            UnknownNameError: There is no such question, or it has no such parameter.
            QuestionError: A parameter that it needs is missing.
        """
        return list(self.store.ask(question(name).bind(parameters)).plain())

    def query(self, text: str, *, seconds: float = TIME_LIMIT_S) -> Answer:
        """What anybody's SPARQL query answers: it cannot write, reach out or run for ever.

        Raises:
            QueryError: It is no query, or does what it may not.
            TimeLimitError: It takes longer than it may [s].
        """
        return self.store.ask_within(sparql.prepare(text), seconds=seconds)

    def replace_graph(self, graph: NamedNode, triples: Iterable[Triple]) -> None:
        """Give a graph that is no observation's these statements and no others."""
        self.store.change(writing.graph_replacement(graph, [_in(each, graph) for each in triples]))

    def dataset(self) -> Any:
        """The whole as rdflib's dataset, whose default graph is the union of all."""
        return self.store.dataset()


def _in(triple: Triple, graph: NamedNode) -> Quad:
    return Quad(triple.subject, triple.predicate, triple.object, graph)
