"""Where statements are kept: in memory, in a folder, or at a SPARQL server.

A folder has one writer and any number of readers; a change is whole or not at all, and on disk
when it returns. A user's query runs in a process of its own: ``python -m kb.store.stores``.
"""

import fcntl
import json
import math
import os
import re
import socket
import subprocess
import sys
import time
from collections import deque
from collections.abc import Callable, Iterable, Iterator
from contextlib import contextmanager, suppress
from datetime import UTC, datetime
from pathlib import Path
from typing import Any, BinaryIO, TypeAlias, TypeVar

from pyoxigraph import NamedNode, Quad, RdfFormat
from pyoxigraph import Store as Oxigraph

from capar.model.errors import UnknownNameError
from kb.errors import DamagedError, LockedError, QueryError, StoreError, TimeLimitError
from kb.store import answer_values, sparql
from kb.store.answer_values import Answer, Result
from kb.store.statements import insertion
from ontology import DATA

_T = TypeVar("_T")

VARIABLE = "CAPAR_ACTIONARY"

DATA_FOLDER = "store"
"""Where in the Actionary's folder the database stands."""

LONGEST_S = 1e6
"""What a system's clocks can wait for at most; a longer time limit is cut to it [s]."""

POLL_S = 0.05
"""How often a waiting writer looks again [s]."""

TRIES, PAUSE_S = 60, 0.02
"""How often a reader tries again when files are replaced meanwhile, and how long between [s]."""

LASTING = "block checksum mismatch"
"""What the database reports of damage that no other try mends; finished files never change."""

PATIENCE_S = 60.0
"""How long a server may be silent in answering a query or a change of ours [s]."""


def place(given: str | None = None) -> str:
    """The Actionary that is meant: what is given, else the environment's, else ./actionary."""
    return given or os.environ.get(VARIABLE) or "actionary"


def is_address(where: str) -> bool:
    """Whether a place is a server's."""
    return where.startswith(("http://", "https://"))


def open_store(
    where: str | Path | None, *, read_only: bool = False, wait_s: float = 0.0
) -> "Store":
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


# In memory, or in a folder


class EmbeddedStore:
    """A store of this process, kept by pyoxigraph.

    A reader sees the folder as it was when it was opened or last refreshed.
    """

    def __init__(
        self, folder: Path | None, *, read_only: bool = False, wait_s: float = 0.0
    ) -> None:
        self.place = "memory" if folder is None else str(folder)
        self._folder = folder
        self._read_only = read_only
        self._flushes = folder is not None
        self._lock: int | None = None
        self._seen: dict[Path, tuple[int, int]] = {}
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
            if not data.is_dir():
                raise StoreError(
                    f"{self._folder}: no Actionary there; `capar observe` makes one, and "
                    f"--actionary or {VARIABLE} says where it is"
                )
            changing = [data, *data.glob("MANIFEST-*"), *data.glob("*.log")]
            self._seen = _times_and_sizes(changing)
            return _reading(data, lambda store: store)
        # Without its table of contents the database would start empty, and overwrite what is there.
        if any(data.glob("*.sst")) and not (data / "CURRENT").is_file():
            raise DamagedError(self.place, f"{data / 'CURRENT'} is missing")
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
            raise _unusable(self._folder, error) from None

    def insert(self, quads: Iterable[Quad]) -> None:
        """Add statements, all or none of them; they are on disk when this returns."""
        self._write(lambda store: store.extend(quads))

    def change(self, update: str) -> None:
        """Do an update, all or nothing of it; it is on disk when this returns."""
        self._write(lambda store: store.update(update))

    def bulk(self, quads: Iterable[Quad]) -> None:
        """Add a great many statements fast; a reader may see a part of them before this returns."""
        self._write(lambda store: store.bulk_extend(quads))

    def _write(self, writing: Callable[[Oxigraph], None]) -> None:
        if self._read_only:
            raise StoreError(f"{self.place} was opened to be read; open it to be written")
        with self._guarded():
            writing(self._store)
            if self._flushes:
                self._store.flush()

    @contextmanager
    def together(self) -> Iterator[Callable[[], None]]:
        """Have changes on disk only when what this gives is called, and at the end.

        Each is still whole or not at all; many cost less so, for the database merges fewer files.
        """
        flushes, self._flushes = self._flushes, False

        def flush() -> None:
            if flushes:
                with self._guarded():
                    self._store.flush()

        try:
            yield flush
        finally:
            self._flushes = flushes
            flush()

    def ask(self, query: str) -> Answer:
        """What a query of ours answers, over the union of all graphs if it names none."""
        return self._read(lambda store: answer_values.collect(evaluated(store, query)))

    def _read(self, reading: Callable[[Oxigraph], _T]) -> _T:
        """What a reading gives; a reader reopens the folder if files go meanwhile."""
        if self._folder is None or not self._read_only:
            with self._guarded():
                return reading(self._store)
        try:
            return reading(self._store)
        except (OSError, RuntimeError):
            found, self._store = _reading(
                self._folder / DATA_FOLDER, lambda store: (reading(store), store)
            )
            return found

    def answered(self, query: str, reading: Callable[[Result], _T]) -> _T:
        """What is read of the answer to a user's query, asked in this process.

        Raises:
            QueryError: It is no query.
        """
        with _explained():
            return self._read(lambda store: _result(store, query, reading))

    def ask_within(self, query: str, *, seconds: float) -> Answer:
        """The answer to a user's query, asked in a process of its own."""
        if self._folder is None:
            data = self._store.dump(format=RdfFormat.N_QUADS) or b""
            return _asked_within(query, seconds, dump=data)
        return _asked_within(query, seconds, folder=str(self._folder / DATA_FOLDER))

    def graph(self, name: NamedNode) -> list[Quad]:
        """Every statement of a graph."""
        return self._read(lambda store: list(store.quads_for_pattern(None, None, None, name)))

    def quads(self) -> Iterable[Quad]:
        """Every statement of every named graph."""
        return self._read(list)

    def check_readable(self) -> None:
        """Read every statement by way of every index, so that damage anywhere is found."""
        self._read(_read_all)

    def dataset(self) -> Any:
        """The same as rdflib's dataset, whose default graph is the union of all."""
        from oxrdflib import OxigraphStore
        from rdflib import Dataset

        return Dataset(store=OxigraphStore(store=self._store), default_union=True)

    def refresh(self) -> bool:
        """See what the writer has written since; whether there is anything new."""
        if not self._read_only or self._seen == _times_and_sizes(self._seen):
            return False
        self._store = self._open()
        return True

    def close(self) -> None:
        """Close the database and release the lock."""
        del self._store
        self._release()

    def _release(self) -> None:
        if self._lock is not None:
            os.ftruncate(self._lock, 0)
            os.close(self._lock)
            self._lock = None


def evaluated(store: Oxigraph, query: str) -> Any:
    """What a query answers over a database, our functions at hand, as the database gives it."""
    functions: Any = None
    if sparql.opens_tracks(query):
        from kb.store.track_functions import track_functions  # most of a second, for few queries

        functions = track_functions(store)
    union = not sparql.names_graphs(query)
    return store.query(query, use_default_graph_as_union=union, custom_functions=functions)


def _locked(folder: Path, wait_s: float) -> int:
    """The right to write a folder: a lock that the system releases however its process ends.

    The text in the file says who holds it; that of a killed process does not count.
    """
    try:
        folder.mkdir(parents=True, exist_ok=True)
        file = os.open(folder / "writer.lock", os.O_RDWR | os.O_CREAT | os.O_CLOEXEC, 0o644)
    except OSError as error:
        raise StoreError(f"{folder}: cannot be written ({error.strerror})") from None
    deadline = time.monotonic() + wait_s
    while True:
        try:
            fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
            break
        except BlockingIOError:
            if time.monotonic() >= deadline:
                try:
                    seen = json.loads(os.pread(file, 4096, 0))
                    holder = f"process {seen['pid']} on {seen['host']}, since {seen['since']},"
                except (ValueError, KeyError, TypeError):
                    holder = "another process"
                os.close(file)
                raise LockedError(str(folder), holder) from None
        time.sleep(POLL_S)
    since = datetime.now(UTC).isoformat(timespec="seconds")
    os.ftruncate(file, 0)
    text = json.dumps({"pid": os.getpid(), "host": socket.gethostname(), "since": since})
    os.pwrite(file, text.encode(), 0)
    return file


def _times_and_sizes(paths: Iterable[Path]) -> dict[Path, tuple[int, int]]:
    """When each was changed and how large it is; nothing of what is gone.

    A change of the database makes a new file of it, or one of these longer.
    """
    found = {}
    for path in paths:
        with suppress(OSError):
            seen = path.stat()
            found[path] = seen.st_mtime_ns, seen.st_size
    return found


def _reading(data: Path, reading: Callable[[Oxigraph], _T]) -> _T:
    """What a reading of a folder's database gives, read again if files go meanwhile.

    The writer merges its files now and then and removes the old ones; a reader that opens at
    that instant finds a file missing, and tries again.
    """
    problem: Exception | None = None
    for _ in range(TRIES):
        try:
            return reading(Oxigraph.read_only(str(data)))
        except (OSError, RuntimeError) as error:
            if isinstance(error, SyntaxError):
                raise
            problem = error
            if LASTING in str(error):
                break
            time.sleep(PAUSE_S)
    raise _unusable(data.parent, problem) from None


def _unusable(folder: Path, problem: Exception | None) -> StoreError:
    """The error for a database that fails: damage, where that is what the database reports."""
    reason = " ".join(str(problem).split())
    if "Corruption" in reason or "No such file" in reason:
        return DamagedError(str(folder), reason)
    return StoreError(f"{folder}: its database cannot be read or written ({reason})")


_SOUGHT = {
    "?s": "OPTIONAL { GRAPH ?in { ?s ?x ?y } FILTER(sameTerm(?x, ?y)) }",
    "?p": "OPTIONAL { GRAPH ?in { ?x ?p ?y } FILTER(sameTerm(?x, ?y)) }",
    "?o": "OPTIONAL { GRAPH ?in { ?x ?y ?o } FILTER(sameTerm(?x, ?y)) }",
    "?g ?p": "GRAPH ?g { ?x ?p ?y } FILTER(sameTerm(?x, ?y))",
    "?g ?o": "GRAPH ?g { ?x ?y ?o } FILTER(sameTerm(?x, ?y))",
}
"""How the statements with some terms are read by the index that begins with these: one question
after another, and hardly any passes the filter. With OPTIONAL the terms themselves are read too."""


def _read_all(store: Oxigraph) -> None:
    """Read a database by way of each index: every statement, then by the terms of each order.

    All stream, without DISTINCT over an index that is not known to be sound: the database repeats
    a failed read for ever inside of those. The terms come from the index that is read first.
    """
    rows: Any = store.query("SELECT ?none { GRAPH ?g { ?s ?p ?o } }")
    deque(rows, maxlen=0)
    for terms, sought in _SOUGHT.items():
        known = f"SELECT DISTINCT {terms} {{ GRAPH ?g {{ ?s ?p ?o }} }}"
        rows = store.query(f"SELECT {terms} {{ {{ {known} }} {sought} }}")
        deque(rows, maxlen=0)


# At a server


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

    @contextmanager
    def together(self) -> Iterator[Callable[[], None]]:
        """Nothing: a server decides itself when its changes are on disk."""
        yield lambda: None

    def ask(self, query: str) -> Answer:
        """What a query of ours answers, over the union of all graphs."""
        return answer_values.collect(answer_values.decode(*self.encoded(query)))

    def answered(self, query: str, reading: Callable[[Result], _T]) -> _T:
        """What is read of the answer to a query."""
        with _explained():
            return reading(answer_values.decode(*self.encoded(query)))

    def encoded(self, query: str) -> tuple[str, bytes]:
        """The media type and the bytes of an answer.

        No server can open tracks: for a query that does, everything is copied into this process.

        Raises:
            QueryError: The server says that it is no query.
            StoreError: The server does not answer, or ignores the graphs that a query names.
        """
        if sparql.opens_tracks(query):
            copied = Oxigraph()
            copied.bulk_extend(self.quads())
            return answer_values.encode(evaluated(copied, query))
        kind, asked = "application/sparql-query", f"{self.place}/query"
        if not sparql.names_graphs(query):
            return _post(f"{asked}?union-default-graph=true", query, kind)
        nowhere = f"ASK FROM <{DATA}graph/none> {{ ?s ?p ?o }}"
        if answer_values.decode(*_post(asked, nowhere, kind)):
            raise StoreError(
                f"{self.place}: this server ignores FROM; write GRAPH <...> {{ ... }} in its "
                "place, or start the server without --union-default-graph"
            )
        return _post(asked, query, kind)

    def ask_within(self, query: str, *, seconds: float) -> Answer:
        """The answer to a user's query; we stop listening in time, the server by its own limit."""
        return _asked_within(query, seconds, address=self.place)

    def graph(self, name: NamedNode) -> list[Quad]:
        """Every statement of a graph."""
        found = self.ask(f"CONSTRUCT {{ ?s ?p ?o }} WHERE {{ GRAPH {name} {{ ?s ?p ?o }} }}")
        return [Quad(e.subject, e.predicate, e.object, name) for e in found.triples or ()]

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

    def refresh(self) -> bool:
        """A server always shows what was written."""
        return False

    def close(self) -> None:
        """There is nothing to release."""


Store: TypeAlias = EmbeddedStore | RemoteStore
"""A dataset of named graphs; each change is whole or not at all, and lasts once it returns,
or, of many together, once they are flushed."""


def _post(url: str, text: str, kind: str) -> tuple[str, bytes]:
    from urllib.error import HTTPError, URLError
    from urllib.request import Request, urlopen

    headers = {
        "Content-Type": f"{kind}; charset=utf-8",
        "Accept": "application/sparql-results+json, application/n-triples",
    }
    request = Request(url, text.encode(), headers, method="POST")
    try:
        with urlopen(request, timeout=PATIENCE_S) as reply:
            return reply.headers.get("Content-Type", ""), reply.read()
    except HTTPError as error:
        said = error.read().decode(errors="replace").strip()
        if error.code == 400 or "custom function" in said:
            raise QueryError(said) from None
        if error.code in {404, 405} and url.endswith("/update"):
            raise StoreError(
                f"{url.rpartition('/')[0]}: takes no SPARQL updates, as `capar serve`; write "
                "to the Actionary's folder, or to a server such as `oxigraph serve`"
            ) from None
        raise StoreError(f"{url} refuses: {error.code} {error.reason} {said}".strip()) from None
    except (URLError, OSError) as error:
        reason = getattr(error, "reason", error)
        raise StoreError(
            f"{url.rpartition('/')[0]}: no server answers ({reason}); start one there, for example "
            "`oxigraph serve --location FOLDER --bind 127.0.0.1:7878`"
        ) from None


# A user's query, in a process of its own

NOT_ACCEPTED = {"LATERAL", "SERVICE", "[_]"}
"""What a parser expects but a query may not use, and its sign for the end of a query."""

_NO_FUNCTION = re.compile(r"custom function <([^>]*)> is not supported")


def _asked_within(
    query: str, seconds: float, *, folder: str = "", dump: bytes = b"", address: str = ""
) -> Answer:
    """What a query answers over a folder, a dump of N-Quads or a server, within a time [s]."""
    check_time_limit(seconds)
    request = json.dumps({"query": query, "folder": folder, "address": address}).encode()
    try:
        done = subprocess.run(
            [sys.executable, "-P", "-m", "kb.store.stores"],
            input=request + b"\n" + dump,
            capture_output=True,
            timeout=min(seconds, LONGEST_S),
            check=False,
        )
    except subprocess.TimeoutExpired:
        raise TimeLimitError(seconds) from None
    head, _, body = done.stdout.partition(b"\n")
    if done.returncode != 0 or not head:
        text = done.stderr.decode(errors="replace").strip() or f"exit code {done.returncode}"
        raise StoreError(f"the query's process failed: {text}")
    kind, _, rest = head.decode().partition(" ")
    if kind in {"query-error", "store-error"}:
        raise (QueryError if kind == "query-error" else StoreError)(json.loads(rest))
    return answer_values.collect(answer_values.decode(rest, body))


def check_time_limit(seconds: float) -> None:
    """Check that a time limit [s] is one.

    Raises:
        QueryError: It is not.
    """
    if not 0.0 < seconds < math.inf:
        raise QueryError(
            f"{seconds:g} s is no time limit; give a positive number of seconds "
            "(--time-limit SECONDS)"
        )


def answer_request(source: BinaryIO) -> bytes:
    """The answer to a request of another process: a line that says its kind, then its bytes."""
    request = json.loads(source.readline())
    query = request["query"]
    try:
        if request["address"]:
            kind, data = RemoteStore(request["address"]).encoded(query)
        elif request["folder"]:
            folder = Path(request["folder"])
            kind, data = _reading(folder, lambda store: _result(store, query, answer_values.encode))
        else:
            store = Oxigraph()
            store.bulk_load(input=source.read(), format=RdfFormat.N_QUADS)
            kind, data = _result(store, query, answer_values.encode)
    except (QueryError, SyntaxError) as error:
        return b"query-error " + json.dumps(user_message(str(error))).encode()
    except (StoreError, OSError) as error:
        return b"store-error " + json.dumps(str(error)).encode()
    return f"answer {kind}\n".encode() + data


@contextmanager
def _explained() -> Iterator[None]:
    """Report a mistake in a user's query as an error of ours."""
    try:
        yield
    except (QueryError, SyntaxError) as error:
        raise QueryError(user_message(str(error))) from None


def _result(store: Oxigraph, query: str, reading: Callable[[Any], _T]) -> _T:
    try:
        return reading(evaluated(store, query))
    except RuntimeError as error:
        if _NO_FUNCTION.search(str(error)):
            raise QueryError(str(error)) from None
        raise


def user_message(problem: str) -> str:
    """A parser's message in short; an unknown function with the names of those that exist."""
    if slip := _NO_FUNCTION.search(problem):
        known = [*(f"capar:{each}" for each in sparql.FUNCTIONS), "those of SPARQL"]
        return str(UnknownNameError("function", answer_values.short(slip[1]), known))
    first = problem.splitlines()[0] if problem else ""
    before, expected, listed = first.partition("expected ")
    if expected:
        taken = [e for e in listed.removeprefix("one of ").split(", ") if e not in NOT_ACCEPTED]
        several = "one of " if len(taken) > 1 else ""
        missing = "something is missing here or before"
        first = before + (expected + several + ", ".join(taken) if taken else missing)
    return "no SPARQL: " + (first if len(first) <= 160 else first[:160] + " ...")


if __name__ == "__main__":
    sys.stdout.buffer.write(answer_request(sys.stdin.buffer))
