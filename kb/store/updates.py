"""Changes of a store: its schema version, its ontology, and observations replaced whole."""

from collections.abc import Iterable

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

FIRST = 1
"""The version of a store that states none."""

_STATED = f"SELECT ?version WHERE {{ {GRAPHS['ontology']} {CAPAR.schemaVersion} ?version }}"
_WRITTEN = (
    f"ASK {{ {{ {GRAPHS['ontology']} {CAPAR.sha256} ?digest }} "
    f"UNION {{ ?seen a {CAPAR.Observation} }} }}"
)


def statement() -> Quad:
    """What a store of this version says of itself."""
    graph = GRAPHS["ontology"]
    return Quad(graph, CAPAR.schemaVersion, Literal(SCHEMA), graph)


def version(store: Store) -> int | None:
    """The version of a store; None if it is empty."""
    rows = store.ask(_STATED).rows
    if rows:
        return _number(rows[0][0])
    return FIRST if store.ask(_WRITTEN).boolean else None


def version_of(quads: Iterable[Quad]) -> int | None:
    """The version of exported statements; None if there is no observation among them."""
    written = False
    for quad in quads:
        if quad.predicate == CAPAR.schemaVersion and quad.subject == GRAPHS["ontology"]:
            return _number(quad.object)
        written = written or (quad.predicate == TYPE and quad.object == CAPAR.Observation)
    return FIRST if written else None


def _number(term: object) -> int:
    text = term.value if isinstance(term, Literal | NamedNode) else ""
    return int(text) if text.isascii() and text.isdecimal() else 0


def check_current(store: Store) -> None:
    """Check that a store is empty or of this version.

    Raises:
        SchemaError: It is of another one; the message says what to do.
    """
    check_version(store.place, version(store))


def check_version(place: str, found: int | None) -> None:
    """Check that what a store or a file holds is of this version, or that it holds nothing.

    Raises:
        SchemaError: It is of another one.
    """
    if found is not None and found != SCHEMA:
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


def graph_replacement(graph: NamedNode, quads: list[Quad]) -> str:
    """The update that gives a graph these statements and no others."""
    return f"DROP SILENT GRAPH {graph} ;\n{insertion(quads)}"


def ontology_digest() -> Quad:
    """What distinguishes the ontology of a store from another one."""
    graph = GRAPHS["ontology"]
    return Quad(graph, CAPAR.sha256, Literal(ontology_files.digest()), graph)


def ontology_replacement() -> str:
    """The update that gives a store the present ontology and schema version."""
    graph = GRAPHS["ontology"]
    stated = [Quad(s, p, o, graph) for s, p, o in ontology_files.ontology()]
    return graph_replacement(graph, [*stated, ontology_digest(), statement()])
