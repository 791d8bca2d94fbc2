"""A store in memory or in a folder, kept by pyoxigraph."""

from collections.abc import Callable, Iterable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any, TypeVar

from pyoxigraph import NamedNode, Quad, RdfFormat
from pyoxigraph import Store as Oxigraph

from kb.errors import StoreError
from kb.store import answers, sparql
from kb.store import timed_query as bounded
from kb.store.answers import Answer
from kb.store.lock import WriterLock
from kb.store.readability import read_all
from kb.store.readonly_folder import check_whole, open_reader, read, unusable

_T = TypeVar("_T")

DATA_FOLDER = "store"
"""Where in the Actionary's folder the database stands."""


class EmbeddedStore:
    """A store of this process; a folder has one writer and any number of readers.

    A reader sees the folder as it was when it was opened or last refreshed.
    """

    def __init__(
        self, folder: Path | None, *, read_only: bool = False, wait_s: float = 0.0
    ) -> None:
        self.place = "memory" if folder is None else str(folder)
        self._folder = folder
        self._read_only = read_only
        self._lock: WriterLock | None = None
        if folder is not None and not read_only:
            self._lock = _locked(folder, wait_s)
        try:
            self._store = self._open()
        except BaseException:
            self._release()
            raise

    def _open(self) -> Oxigraph:
        if self._folder is None:
            return Oxigraph()
        data = self._folder / DATA_FOLDER
        if self._read_only:
            return _reader(self._folder, data)
        check_whole(data)
        with self._guarded():
            return Oxigraph(data)

    @contextmanager
    def _guarded(self) -> Iterator[None]:
        """Report a failure of the database as an error of ours."""
        try:
            yield
        except (OSError, RuntimeError) as error:
            if self._folder is None:
                raise
            raise unusable(self._folder, error) from None

    def insert(self, quads: Iterable[Quad]) -> None:
        """Add statements, all or none of them; they are on disk when this returns."""
        with self._guarded():
            self._writable().extend(quads)
            self._flush()

    def change(self, update: str) -> None:
        """Do an update, all or nothing of it; it is on disk when this returns."""
        with self._guarded():
            self._writable().update(update)
            self._flush()

    def ask(self, query: str) -> Answer:
        """What a query of ours answers, over the union of all graphs if it names none."""
        return self._read(lambda store: _answer(store, query))

    def _read(self, reading: Callable[[Oxigraph], _T]) -> _T:
        """What a reading gives; a reader reopens the folder if files go meanwhile."""
        if self._folder is None or not self._read_only:
            with self._guarded():
                return reading(self._store)
        try:
            return reading(self._store)
        except (OSError, RuntimeError):
            found, self._store = read(self._folder / DATA_FOLDER, reading)
            return found

    def ask_within(self, query: str, *, seconds: float) -> Answer:
        """The answer to a user's query, asked in a process of its own."""
        if self._folder is None:
            data = self._store.dump(format=RdfFormat.N_QUADS) or b""
            return bounded.ask(query, seconds=seconds, dump=data)
        return bounded.ask(query, seconds=seconds, folder=self._folder / DATA_FOLDER)

    def graph(self, name: NamedNode) -> list[Quad]:
        """Every statement of a graph."""
        return self._read(lambda store: list(store.quads_for_pattern(None, None, None, name)))

    def quads(self) -> Iterable[Quad]:
        """Every statement of every named graph."""
        return self._read(list)

    def check_readable(self) -> None:
        """Read every statement by way of every index, so that damage anywhere is found."""
        self._read(read_all)

    def dataset(self) -> Any:
        """The same as rdflib's dataset, whose default graph is the union of all."""
        from oxrdflib import OxigraphStore
        from rdflib import Dataset

        return Dataset(store=OxigraphStore(store=self._store), default_union=True)

    def bulk(self, quads: Iterable[Quad]) -> None:
        """Add a great many statements fast; a reader may see a part of them before this returns."""
        with self._guarded():
            self._writable().bulk_extend(quads)
            self._flush()

    def refresh(self) -> None:
        """See what the writer has written since."""
        if self._read_only:
            self._store = self._open()

    def close(self) -> None:
        """Close the database and release the lock."""
        del self._store
        self._release()

    def _release(self) -> None:
        if self._lock is not None:
            self._lock.release()

    def _writable(self) -> Oxigraph:
        if self._read_only:
            raise StoreError(f"{self.place} was opened to be read; open it to be written")
        return self._store

    def _flush(self) -> None:
        if self._folder is not None:
            self._store.flush()


def _answer(store: Oxigraph, query: str) -> Answer:
    return answers.collect(evaluated(store, query))


def evaluated(store: Oxigraph, query: str) -> Any:
    """What a query answers over a database, our functions at hand, as the database gives it."""
    return store.query(
        query,
        use_default_graph_as_union=not sparql.names_graphs(query),
        custom_functions=_functions(store) if sparql.opens_tracks(query) else None,
    )


def _functions(store: Oxigraph) -> dict[NamedNode, Any]:
    from kb.store.track_functions import track_functions  # most of a second, for few queries

    return dict(track_functions(store))


def _locked(folder: Path, wait_s: float) -> WriterLock:
    try:
        folder.mkdir(parents=True, exist_ok=True)
        return WriterLock(folder, wait_s=wait_s)
    except OSError as error:
        raise StoreError(f"{folder}: cannot be written ({error.strerror})") from None


def _reader(folder: Path, data: Path) -> Oxigraph:
    if not data.is_dir():
        raise StoreError(
            f"{folder}: no Actionary there; `capar observe` makes one, and --actionary or "
            "CAPAR_ACTIONARY says where it is"
        )
    return open_reader(data)
