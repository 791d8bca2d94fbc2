"""The schema version of a store, checked whenever it is opened; others are refused."""

from collections.abc import Iterable

from pyoxigraph import Literal, NamedNode, Quad

from kb.errors import SchemaError
from kb.store.names import GRAPHS
from kb.store.statements import TYPE
from kb.store.stores import Store
from ontology import CAPAR

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
