"""A store kept by a SPARQL 1.1 server, reached by its address."""

import urllib.error
import urllib.parse
import urllib.request
from collections.abc import Iterable
from typing import Any

from pyoxigraph import NamedNode, Quad
from pyoxigraph import Store as Oxigraph

from kb.errors import QueryError, StoreError
from kb.store import answers, sparql
from kb.store import timed_query as bounded
from kb.store.answers import Answer
from kb.store.embedded import evaluated
from kb.store.statements import insertion
from ontology import DATA

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
        return bounded.ask(query, seconds=seconds, address=self.place)

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
