"""The hierarchy of kinds: a mug is a container is an object."""

from pyoxigraph import Literal, NamedNode, Quad

from kb.errors import StoreError
from kb.store import names
from kb.store.statements import LABEL, TYPE, insertion
from kb.store.stores import Store
from ontology import CAPAR
from ontology.files import closure

_PAIRS = f"SELECT DISTINCT ?lower ?upper WHERE {{ ?lower {CAPAR.broaderKind} ?upper }}"
_CLOSURE = f"SELECT DISTINCT ?lower ?upper WHERE {{ ?lower {CAPAR.isA} ?upper }}"
GENERAL = ("object", "thing")
"""What every kind is by default."""


def _pairs(store: Store, query: str) -> set[tuple[str, str]]:
    rows = store.ask(query).rows
    return {
        (names.last_word(lower), names.last_word(upper))
        for lower, upper in rows
        if isinstance(lower, NamedNode) and isinstance(upper, NamedNode)
    }


def define(store: Store, name: str, broader: str) -> None:
    """State that a kind is a case of a more general one, and what follows from that."""
    if name == broader or name in above(store, broader):
        raise StoreError(
            f"{broader!r} is a kind of {name!r} already; a kind cannot be more general than itself"
        )
    graph = names.GRAPHS["objects"]
    direct = _pairs(store, _PAIRS) | {(name, broader)}
    if not any(lower == broader for lower, _ in direct) and broader not in GENERAL:
        direct.add((broader, "object"))
    whole = closure(sorted(direct))
    closed = {(lower, upper) for lower, uppers in whole.items() for upper in (lower, *uppers)}
    known = _pairs(store, _CLOSURE)
    quads = [
        Quad(names.shared("kind", lower), CAPAR.isA, names.shared("kind", upper), graph)
        for lower, upper in sorted(closed - known)
    ]
    for kind in (name, broader):
        quads += described(kind)
    node, general = names.shared("kind", name), names.shared("kind", broader)
    quads.append(Quad(node, CAPAR.broaderKind, general, graph))
    store.change(insertion(quads))


def described(name: str) -> list[Quad]:
    """That a kind was declared, and what it is if the ontology does not know it."""
    graph = names.GRAPHS["objects"]
    node = names.shared("kind", name)
    marks = [Quad(node, CAPAR.declared, Literal(True), graph)]
    if names.graph_of(node) == names.GRAPHS["ontology"]:
        return marks
    label = Literal(name.replace("_", " "))
    return [
        *marks,
        Quad(node, TYPE, CAPAR.ObjectKind, graph),
        Quad(node, LABEL, label, graph),
        Quad(node, CAPAR.name, Literal(name), graph),
    ]


def by_itself(name: str) -> list[Quad]:
    """That a kind was declared, of which no more is stated than that it is a thing."""
    graph, node = names.GRAPHS["objects"], names.shared("kind", name)
    quads = described(name)
    if names.graph_of(node) == names.GRAPHS["ontology"]:
        return quads
    thing = names.shared("kind", GENERAL[-1])
    return [*quads, *(Quad(node, CAPAR.isA, each, graph) for each in (node, thing))]


def above(store: Store, name: str) -> tuple[str, ...]:
    """A kind and every more general one, nearest first; of equally near, by alphabet."""
    direct: dict[str, set[str]] = {}
    for lower, upper in _pairs(store, _PAIRS):
        direct.setdefault(lower, set()).add(upper)
    order = [name]
    level = {name}
    while level:
        level = {upper for each in level for upper in direct.get(each, ())} - set(order)
        order += sorted(level)
    return (*order, *(each for each in GENERAL if each not in order))
