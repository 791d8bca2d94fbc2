"""Changes of a store: its schema version, its ontology, and observations replaced whole."""

from collections.abc import Iterable
from functools import cache

from pyoxigraph import Literal, NamedNode, Quad

from kb.errors import SchemaError
from kb.store.names import GRAPHS
from kb.store.sparql import stored
from kb.store.statements import TYPE, insertion
from kb.store.stores import Store
from ontology import CAPAR
from ontology import files as ontology_files

SCHEMA = 4
"""The version that this program reads and writes."""

ONTOLOGY = GRAPHS["ontology"]
VERSION = Quad(ONTOLOGY, CAPAR.schemaVersion, Literal(SCHEMA), ONTOLOGY)
"""What a store of this version says of itself."""


def check_current(store: Store) -> None:
    """Check that a store is empty or of this version.

    Raises:
        SchemaError: It is of another one; the message says what to do.
    """
    query = f"SELECT ?version {{ {ONTOLOGY} {CAPAR.schemaVersion} ?version }}"
    written = (
        f"ASK {{ {{ {ONTOLOGY} {CAPAR.sha256} ?digest }} UNION {{ ?seen a {CAPAR.Observation} }} }}"
    )
    rows = store.ask(query).rows
    if rows or store.ask(written).boolean:
        _check(store.place, rows[0][0] if rows else Literal(1))


def check_version(place: str, quads: Iterable[Quad]) -> None:
    """Check that statements with an observation are of this version.

    Raises:
        SchemaError: They are of another one.
    """
    written = False
    for quad in quads:
        if quad.predicate == CAPAR.schemaVersion and quad.subject == ONTOLOGY:
            return _check(place, quad.object)
        written = written or (quad.predicate == TYPE and quad.object == CAPAR.Observation)
    return _check(place, Literal(1)) if written else None


def _check(place: str, term: object) -> None:
    text = term.value if isinstance(term, Literal | NamedNode) else ""
    found = int(text) if text.isascii() and text.isdecimal() else 0
    if found != SCHEMA:
        remedy = f"this program reads schema {SCHEMA}; observe the captures again"
        newer = ", or install the capar that wrote it" if found > SCHEMA else ""
        raise SchemaError(place, found, f"{remedy}{newer}")


def removal(graph: NamedNode) -> str:
    """The update that takes an observation back, and what nothing else mentions."""
    shared = " ".join(str(GRAPHS[each]) for each in ("agents", "objects", "actions"))
    orphans = stored("remove_orphans", graph=str(graph), shared=shared)
    return f"{orphans} ;\nDROP SILENT GRAPH {graph}"


def replacement(graph: NamedNode, quads: list[Quad]) -> str:
    """The update that puts an observation in the place of one of the same name."""
    return f"{removal(graph)} ;\n{insertion(quads)}"


def ontology_digest() -> Quad:
    """What distinguishes the ontology of a store from another one."""
    return Quad(ONTOLOGY, CAPAR.sha256, Literal(ontology_files.digest()), ONTOLOGY)


@cache
def ontology_replacement() -> str:
    """The update that gives a store the present ontology and schema version."""
    stated = [Quad(s, p, o, ONTOLOGY) for s, p, o in ontology_files.ontology()]
    return f"DROP SILENT GRAPH {ONTOLOGY} ;\n{insertion([*stated, ontology_digest(), VERSION])}"
