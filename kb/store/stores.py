"""The interface of a store, and opening one: in memory, in a folder, or at a server."""

import os
from collections.abc import Iterable
from pathlib import Path
from typing import Any, Protocol

from pyoxigraph import NamedNode, Quad

from kb.store.answers import Answer

VARIABLE = "CAPAR_ACTIONARY"
DEFAULT = "actionary"


class Store(Protocol):
    """A dataset of named graphs; each change is whole or not at all, and lasts once it returns."""

    place: str
    """The folder or address, or ``memory``, for messages."""

    def insert(self, quads: Iterable[Quad]) -> None:
        """Add statements."""

    def change(self, update: str) -> None:
        """Run a SPARQL update of ours as one transaction."""

    def ask(self, query: str) -> Answer:
        """What a query of ours answers, over the union of all graphs."""

    def ask_within(self, query: str, *, seconds: float) -> Answer:
        """The answer to a user's query, stopped after so many seconds.

        Raises:
            QueryError: It is no SPARQL query.
            TimeLimitError: It takes longer.
        """

    def graph(self, name: NamedNode) -> list[Quad]:
        """Every statement of a graph."""

    def quads(self) -> Iterable[Quad]:
        """Every statement of every named graph."""

    def check_readable(self) -> None:
        """Check that every statement can be read.

        Raises:
            DamagedError: One cannot.
        """

    def dataset(self) -> Any:
        """The same as rdflib's dataset, whose default graph is the union of all."""

    def refresh(self) -> None:
        """See what others have written since."""

    def close(self) -> None:
        """Close the store."""


def place(given: str | None = None) -> str:
    """The Actionary that is meant: what is given, else the environment's, else ./actionary."""
    return given or os.environ.get(VARIABLE) or DEFAULT


def is_address(where: str) -> bool:
    """Whether a place is a server's."""
    return where.startswith(("http://", "https://"))


def open_store(where: str | Path | None, *, read_only: bool = False, wait_s: float = 0.0) -> Store:
    """The store at a place; a folder that is not there yet is made, unless it is only read.

    Args:
        where: A folder, a server's address, or ``None`` for one in memory.
        read_only: Whether it is only read; a folder may have many readers beside a writer.
        wait_s: How long to wait for another writer [s].

    Raises:
        LockedError: Another process writes the folder.
        StoreError: There is no store to read, or it cannot be used.
    """
    if where is not None and is_address(str(where)):
        from kb.store.remote import RemoteStore

        return RemoteStore(str(where))
    from kb.store.embedded import EmbeddedStore

    folder = None if where is None else Path(where)
    return EmbeddedStore(folder, read_only=read_only, wait_s=wait_s)
