"""Where statements are kept: in memory, in a folder, or at a SPARQL server."""

import fcntl
import json
import math
import os
import socket
import subprocess
import sys
import time
import urllib.error
import urllib.parse
import urllib.request
from collections.abc import Callable, Iterable, Iterator, Sequence
from contextlib import contextmanager
from datetime import UTC, datetime
from itertools import islice
from pathlib import Path
from typing import Any, Protocol, TypeVar

from pyoxigraph import NamedNode, Quad, RdfFormat
from pyoxigraph import Store as Oxigraph

from kb.errors import DamagedError, LockedError, QueryError, StoreError, TimeLimitError
from kb.store import answers, sparql
from kb.store.answers import Answer, decode
from kb.store.statements import insertion
from ontology import DATA

LONGEST_S = 1e6
"""What a system's clocks can wait for at most; a longer time limit is cut to it [s]."""


def ask(
    query: str,
    *,
    seconds: float,
    folder: Path | None = None,
    dump: bytes = b"",
    address: str = "",
) -> Answer:
    """What a query answers over a folder, a dump of N-Quads or a server.

    Raises:
        QueryError: It is no query, or its time limit is no positive number of seconds.
        StoreError: The store does not answer.
        TimeLimitError: It took longer than it may; the process was ended.
    """
    if not 0.0 < seconds < math.inf:
        raise QueryError(
            f"{seconds:g} s is no time limit; give a positive number of seconds "
            "(--time-limit SECONDS)"
        )
    request = {"query": query, "folder": str(folder) if folder else "", "address": address}
    data = json.dumps(request).encode() + b"\n" + dump
    command = [sys.executable, "-P", "-m", "kb.store.query_worker"]
    try:
        done = subprocess.run(
            command, input=data, capture_output=True, timeout=min(seconds, LONGEST_S), check=False
        )
    except subprocess.TimeoutExpired:
        raise TimeLimitError(seconds) from None
    head, _, body = done.stdout.partition(b"\n")
    if done.returncode != 0 or not head:
        text = done.stderr.decode(errors="replace").strip() or f"exit code {done.returncode}"
        raise StoreError(f"the query's process failed: {text}")
    kind, _, rest = head.decode().partition(" ")
    if kind == "query-error":
        raise QueryError(json.loads(rest))
    if kind == "store-error":
        raise StoreError(json.loads(rest))
    return decode(rest, body)


POLL_S = 0.05
"""How often a waiting writer looks again [s]."""


class WriterLock:
    """The right to write a store's folder, held from construction to release.

    The system releases the lock of a process that ends in any way; the text that a killed
    process left in the file does not count.
    """

    def __init__(self, folder: Path, *, wait_s: float = 0.0) -> None:
        """Take the lock.

        Args:
            folder: The folder of the store, which exists.
            wait_s: How long to wait for another writer [s].

        Raises:
            LockedError: Another process holds it for longer than that.
        """
        self._path = folder / "writer.lock"
        self._file = os.open(self._path, os.O_RDWR | os.O_CREAT | os.O_CLOEXEC, 0o644)
        try:
            self._take(time.monotonic() + wait_s)
        except LockedError:
            os.close(self._file)
            raise
        text = json.dumps(
            {
                "pid": os.getpid(),
                "host": socket.gethostname(),
                "since": datetime.now(UTC).isoformat(timespec="seconds"),
            }
        )
        os.ftruncate(self._file, 0)
        os.pwrite(self._file, text.encode(), 0)

    def _take(self, deadline: float) -> None:
        while True:
            try:
                fcntl.flock(self._file, fcntl.LOCK_EX | fcntl.LOCK_NB)
                return
            except BlockingIOError:
                if time.monotonic() >= deadline:
                    raise LockedError(str(self._path.parent), self._holder()) from None
            time.sleep(POLL_S)

    def _holder(self) -> str:
        try:
            seen = json.loads(os.pread(self._file, 4096, 0))
            return f"process {seen['pid']} on {seen['host']}, since {seen['since']},"
        except (ValueError, KeyError, TypeError):
            return "another process"

    def release(self) -> None:
        """Release the lock; safe to call twice."""
        if self._file >= 0:
            os.ftruncate(self._file, 0)
            os.close(self._file)
            self._file = -1


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


TRIES = 60
"""How often a reader tries again when files are replaced while it reads."""

PAUSE_S = 0.02
"""How long it waits between [s]."""

LASTING = "block checksum mismatch"
"""What the database reports of damage that no other try mends; finished files never change."""

_T = TypeVar("_T")


def open_reader(data: Path) -> Oxigraph:
    """The database as it is now.

    The writer merges its files now and then and removes the old ones; a reader that opens at
    that instant finds a file missing, and tries again.

    Raises:
        StoreError: It cannot be opened even so.
    """
    return _again(lambda: Oxigraph.read_only(str(data)), data)


def read(data: Path, reading: Callable[[Oxigraph], _T]) -> tuple[_T, Oxigraph]:
    """What a reading of the database gives, and the database; read again if files go meanwhile.

    Raises:
        StoreError: It cannot be read even so.
    """

    def both() -> tuple[_T, Oxigraph]:
        store = Oxigraph.read_only(str(data))
        return reading(store), store

    return _again(both, data)


def check_whole(data: Path) -> None:
    """Check that a database's files have their table of contents, before it is written.

    Without it the database would start empty, and overwrite what is there.

    Raises:
        DamagedError: They have none.
    """
    if any(data.glob("*.sst")) and not (data / "CURRENT").is_file():
        raise DamagedError(str(data.parent), f"{data / 'CURRENT'} is missing")


def _again(action: Callable[[], _T], data: Path) -> _T:
    problem: Exception | None = None
    for _ in range(TRIES):
        try:
            return action()
        except SyntaxError:
            raise
        except (OSError, RuntimeError) as error:
            if LASTING in str(error):
                raise unusable(data.parent, error) from None
            problem = error
            time.sleep(PAUSE_S)
    raise unusable(data.parent, problem)


def unusable(folder: Path, problem: Exception | None) -> StoreError:
    """The error for a database that fails: damage, where that is what the database reports."""
    reason = " ".join(str(problem).split())
    if "Corruption" in reason or "No such file" in reason:
        return DamagedError(str(folder), reason)
    return StoreError(f"{folder}: its database cannot be read or written ({reason})")


_T_EMBEDDED = TypeVar("_T_EMBEDDED")

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

    def _read(self, reading: Callable[[Oxigraph], _T_EMBEDDED]) -> _T_EMBEDDED:
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
            return ask(query, seconds=seconds, dump=data)
        return ask(query, seconds=seconds, folder=self._folder / DATA_FOLDER)

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


ACCEPT = "application/sparql-results+json, application/n-triples"
PATIENCE_S = 60.0
"""How long a server may be silent in answering a query or a change of ours [s]."""

NOWHERE = DATA + "graph/none"
"""A graph that there never is."""


class RemoteStore:
    """A store at ``ADDRESS/query`` and ``ADDRESS/update``; the server holds the locks.

    A change is one request, which such servers do whole or not at all.
    """

    def __init__(self, address: str) -> None:
        """Check that a server answers there.

        Raises:
            StoreError: No server answers there.
        """
        self.place = address.rstrip("/")
        self.ask("ASK {}")

    def insert(self, quads: Iterable[Quad]) -> None:
        """Add statements in one request."""
        self.change(insertion(quads))

    def change(self, update: str) -> None:
        """Do an update in one request."""
        _post(f"{self.place}/update", update, "application/sparql-update")

    def ask(self, query: str) -> Answer:
        """What a query of ours answers, over the union of all graphs."""
        if sparql.opens_tracks(query):
            return answers.collect(query_copy(self.place, query))
        return answers.decode(*post_query(self.place, query))

    def ask_within(self, query: str, *, seconds: float) -> Answer:
        """The answer to a user's query; we stop listening in time, the server by its own limit."""
        return ask(query, seconds=seconds, address=self.place)

    def graph(self, name: NamedNode) -> list[Quad]:
        """Every statement of a graph."""
        found = self.ask(f"CONSTRUCT {{ ?s ?p ?o }} WHERE {{ GRAPH {name} {{ ?s ?p ?o }} }}")
        return [
            Quad(each.subject, each.predicate, each.object, name) for each in found.triples or ()
        ]

    def quads(self) -> Iterable[Quad]:
        """Every statement of every named graph."""
        found = self.ask("SELECT DISTINCT ?g WHERE { GRAPH ?g { ?s ?p ?o } }")
        for (name,) in found.rows:
            if isinstance(name, NamedNode):
                yield from self.graph(name)

    def check_readable(self) -> None:
        """A server looks after its own files."""

    def dataset(self) -> Any:
        """The same as rdflib's dataset, over the server's own endpoints."""
        from rdflib import Dataset
        from rdflib.plugins.stores.sparqlstore import SPARQLStore

        union = {"union-default-graph": "true"}
        store = SPARQLStore(f"{self.place}/query", params=union)
        return Dataset(store=store, default_union=True)

    def refresh(self) -> None:
        """A server always shows what was written."""

    def close(self) -> None:
        """There is nothing to release."""


def query_copy(address: str, query: str) -> Any:
    """What a query that opens tracks answers: no server can open them, so a copy is asked.

    Everything that the server holds is copied into this process, once a query.

    Raises:
        StoreError: The server does not answer.
    """
    copied = Oxigraph()
    copied.bulk_extend(RemoteStore(address).quads())
    return evaluated(copied, query)


def post_query(address: str, query: str) -> tuple[str, bytes]:
    """A server's answer to a query: its media type and its bytes.

    Raises:
        QueryError: The server says that it is no query.
        StoreError: The server does not answer, or ignores the graphs that a query names.
    """
    kind = "application/sparql-query"
    if not sparql.names_graphs(query):
        return _post(f"{address}/query?union-default-graph=true", query, kind)
    asked = f"{address}/query"
    if answers.decode(*_post(asked, f"ASK FROM <{NOWHERE}> {{ ?s ?p ?o }}", kind)).boolean:
        raise StoreError(
            f"{address}: this server ignores FROM; write GRAPH <...> {{ ... }} in its "
            "place, or start the server without --union-default-graph"
        )
    return _post(asked, query, kind)


def _post(url: str, text: str, kind: str) -> tuple[str, bytes]:
    headers = {"Content-Type": f"{kind}; charset=utf-8", "Accept": ACCEPT}
    request = urllib.request.Request(url, text.encode(), headers, method="POST")
    try:
        with urllib.request.urlopen(request, timeout=PATIENCE_S) as reply:
            return reply.headers.get("Content-Type", ""), reply.read()
    except urllib.error.HTTPError as error:
        said = error.read().decode(errors="replace").strip()
        if error.code == 400 or "custom function" in said:
            raise QueryError(said) from None
        raise StoreError(f"{url} refuses: {error.code} {error.reason} {said}".strip()) from None
    except (urllib.error.URLError, OSError) as error:
        reason = getattr(error, "reason", error)
        raise StoreError(
            f"{url}: no server answers ({reason}); start a server there, for example "
            "`oxigraph serve --location FOLDER --bind 127.0.0.1:7878`"
        ) from None


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
        return RemoteStore(str(where))

    folder = None if where is None else Path(where)
    return EmbeddedStore(folder, read_only=read_only, wait_s=wait_s)
