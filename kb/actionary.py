"""The Actionary: observations kept as RDF, and the questions it answers (thesis 4.1.2)."""

from contextlib import AbstractContextManager
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any, Self

from kb.errors import ExistsError, StoreError
from kb.lookup.agents import Agents, aliases, joined
from kb.lookup.pars import unknown_observation
from kb.queries.questions import question
from kb.store import names, sparql, updates
from kb.store.answer_values import Answer, Plain
from kb.store.stores import Store, is_address, open_store
from kb.store.stores import place as default_place
from kb.store.validation import check_statements
from ontology import CAPAR

if TYPE_CHECKING:
    from capar.model.observation import Observation

TIME_LIMIT_S = 30.0
"""How long a user's query may take, unless the user says otherwise [s]."""


@dataclass(frozen=True, slots=True)
class Added:
    """The result of adding an observation."""

    name: str
    action: str
    """What its complex action is called."""

    recognised: str
    """Under which name that action was known before; empty if it was not."""

    replaced: bool
    """Whether it took the place of an observation of the same capture."""

    statements: int


class Actionary(Agents, AbstractContextManager["Actionary"]):
    """Observations, the actions, agents and objects that they are of, and the ontology."""

    def __init__(self, store: Store, *, read_only: bool = False) -> None:
        """Take a store; one that is written gets the present ontology if it has another.

        Raises:
            SchemaError: The store is kept in the form of another version.
            StoreError: The store answers like no Actionary.
        """
        self.store = store
        updates.check_current(store)
        current = f"ASK {{ {updates.ontology_digest().triple} }}"
        if not read_only and not store.ask(current).boolean:
            store.change(updates.ontology_replacement())
            if not store.ask(current).boolean:
                raise StoreError(
                    f"{store.place}: its default graph is not the union of the named ones; "
                    "configure the server so (oxigraph serve --union-default-graph)"
                )

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
            SchemaError: It is kept in the form of another version of the program.
            StoreError: There is nothing to read, or it cannot be used.
        """
        target = default_place(str(where) if where is not None else None)
        store = open_store(target, read_only=read_only, wait_s=wait_s)
        try:
            return cls(store, read_only=read_only)
        except BaseException:
            store.close()
            raise

    @classmethod
    def in_memory(cls) -> Self:
        """An Actionary that ends with the process."""
        return cls(open_store(None))

    def __exit__(self, *_: object) -> None:
        """Close it."""
        self.close()

    def close(self) -> None:
        """Close the store."""
        self.store.close()

    def refresh(self) -> None:
        """See what others have written since it was opened."""
        if self.store.refresh():
            updates.check_current(self.store)

    # Observations

    def add(
        self, observation: "Observation", *, name: str | None = None, replace: bool = False
    ) -> Added:
        """Keep an observation; it is checked, complete and on disk when this returns.

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
        from kb.encode.observation import encode, identity, run, run_removal

        graph = names.observation(observation.capture)
        there = self.store.ask(
            f"SELECT ?identity WHERE {{ {graph} {CAPAR.identity} ?identity }}"
        ).rows
        same = there and getattr(there[0][0], "value", "") == identity(observation)
        if there and not same and not replace:
            raise ExistsError(
                f"an observation {observation.capture!r} of another capture is in "
                f"{self.store.place}; "
                "give this capture another name, forget that one, or ask to replace it"
            )
        recognised = self.recognise(observation.complex_par, besides=graph) or ""
        called = name or observation.complex_par.name or recognised or observation.capture
        statements = encode(observation, name=called)
        check_statements(observation.capture, statements.things)
        quads = joined(statements.quads, aliases(self.store))
        if there or is_address(self.store.place):
            change = updates.replacement(graph, [*quads, *run(observation)])
            self.store.change(f"{run_removal(graph)} ;\n{change}")
        else:
            self.store.insert([*quads, *run(observation)])
        return Added(observation.capture, called, recognised, bool(there), len(quads))

    def forget(self, name: str) -> None:
        """Remove an observation, and everything that no other one mentions.

        Raises:
            UnknownNameError: There is no observation of that name.
        """
        from kb.encode.observation import run_removal

        if name not in [each.name for each in self.observations()]:
            raise unknown_observation(self.store, name)
        graph = names.observation(name)
        self.store.change(f"{run_removal(graph)} ;\n{updates.removal(graph)}")

    # Questions

    def ask(self, name: str, **parameters: object) -> list[dict[str, Plain]]:
        """The rows that answer a named question, as plain values.

        Raises:
            UnknownNameError: There is no such question, or it has no such parameter.
            QuestionError: A parameter that it needs is missing.
        """
        return list(self.store.ask(question(name).bind(parameters)).plain())

    def query(self, text: str, *, seconds: float = TIME_LIMIT_S) -> Answer:
        """The answer to a user's SPARQL query, which can neither write nor call services.

        Raises:
            QueryError: It is no query, or does what it may not.
            TimeLimitError: It takes longer than its time limit [s].
        """
        return self.store.ask_within(sparql.prepare(text), seconds=seconds)

    def dataset(self) -> Any:
        """The store as an rdflib dataset whose default graph is the union of all graphs."""
        return self.store.dataset()
