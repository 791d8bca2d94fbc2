"""Reading a whole database once by way of every index, so that damage anywhere is found.

The questions stream, with neither DISTINCT nor COUNT over an index that is not known to be sound:
the database repeats a failed read for ever inside of those.
"""

from collections.abc import Iterable, Iterator, Sequence
from itertools import islice
from typing import Any

from pyoxigraph import Store as Oxigraph

_Row = tuple[Any, ...]

BATCH = 2000
"""How many terms a question names: fewer parse more questions, more take more memory."""

_READ = "SELECT ?none { GRAPH ?g { ?s ?p ?o } }"
_KEYS = (("?s",), ("?o",), ("?p",), ("?g", "?p"), ("?g", "?o"))
"""By which terms each index is looked up; that by graph and subject is read as a whole before."""


def read_all(store: Oxigraph) -> None:
    """Read every statement by way of every index, and every term.

    Raises:
        RuntimeError: The database is damaged.
        OSError: One of its files cannot be read.
    """
    _drain(store, _READ)
    for key in _KEYS:
        for batch in _batches(_terms(store, key)):
            _drain(store, _lookup(key, batch))


def _batches(rows: Iterable[_Row]) -> Iterator[list[_Row]]:
    left = iter(rows)
    while batch := list(islice(left, BATCH)):
        yield batch


def _terms(store: Oxigraph, key: Sequence[str]) -> list[_Row]:
    rows: Any = store.query(f"SELECT DISTINCT {' '.join(key)} {{ GRAPH ?g {{ ?s ?p ?o }} }}")
    return [tuple(row) for row in rows]


def _lookup(key: Sequence[str], terms: Iterable[_Row]) -> str:
    rows = " ".join(f"({' '.join(map(str, row))})" for row in terms)
    return f"SELECT ?none {{ VALUES ({' '.join(key)}) {{ {rows} }} GRAPH ?g {{ ?s ?p ?o }} }}"


def _drain(store: Oxigraph, query: str) -> None:
    rows: Any = store.query(query)
    for _ in rows:
        pass
