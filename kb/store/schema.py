"""The version of the form in which statements are stored, checked whenever a store is opened.

Version 1 stated no version. Version 2 states it, and gives each segment its address. Version 3 has
facts of a class each that refer to bodies, where version 2 had texts. Version 4 says of what was
done alone that it has an action; representations, steps, calls, locations and styles are of one.
Contacts of end-effectors tell for how long the thing is held and moves.
"""

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
    found = version(store)
    if found is not None and found != SCHEMA:
        raise SchemaError(store.place, found, remedy(store.place, found))


def remedy(place: str, found: int) -> str:
    """What to do about a store of another version."""
    if FIRST <= found < SCHEMA:
        return f"this program reads schema {SCHEMA}; run: capar migrate --actionary {place}"
    if found > SCHEMA:
        return (
            f"a newer program wrote it, this one reads schema {SCHEMA}; install a capar that "
            "reads it, or observe the captures again into another Actionary"
        )
    return "no program wrote such a version; restore the Actionary from an export (capar import)"
