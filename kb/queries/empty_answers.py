"""Why a query of one's own finds nothing: values that are nowhere, properties that a class lacks.

Only patterns that must hold are looked at: what is OPTIONAL, negated or taken away empties nothing.
"""

from collections.abc import Iterator
from difflib import get_close_matches
from typing import TYPE_CHECKING, Any

from pyoxigraph import Literal, NamedNode
from rdflib import RDF, URIRef, Variable
from rdflib import Literal as Text
from rdflib.paths import AlternativePath, SequencePath
from rdflib.plugins.sparql.algebra import translateQuery
from rdflib.plugins.sparql.parser import parseQuery
from rdflib.plugins.sparql.parserutils import CompValue

from kb.queries.emptying_patterns import emptying_patterns, needed_triples
from ontology import BASE

if TYPE_CHECKING:
    from kb.store.stores import Store

_NEGATIONS = frozenset({"Builtin_NOTEXISTS", "Minus"})

MOST_NEAR = 3
"""How many values are told that are written alike."""

MOST_LISTED = 40
"""Of so many values that there are, those are listed that there are, where none is alike."""


def hints(store: "Store", query: str) -> list[str]:
    """A sentence for each word of a complete query that alone leaves its answer empty.

    If no word does, for the patterns or filters that do.

    Args:
        store: What was asked.
        query: The query, with its prefixes declared (``sparql.prepare``).
    """
    try:
        algebra = translateQuery(parseQuery(query)).algebra
    except Exception:  # rdflib reads less than the engine does, and says so in many ways
        return []
    parts = list(_parts(algebra))
    triples = [triple for part in parts if part.name == "BGP" for triple in part["triples"]]
    found = [
        *_unknown_values(store, triples),
        *_compared(store, parts),
        *_lacking(store, triples),
        *_shapeless(store, triples),
    ]
    if not found:
        found = list(emptying_patterns(store, query, needed_triples(algebra)))
    return list(dict.fromkeys(found))


def _parts(value: Any) -> Iterator[CompValue]:
    """The parts of a query's algebra that must hold."""
    if isinstance(value, CompValue):
        if value.name in _NEGATIONS:
            return
        yield value
        if value.name == "LeftJoin":
            yield from _parts(value.p1)
            return
        for inner in value.values():
            yield from _parts(inner)
    elif isinstance(value, list | tuple):
        for inner in value:
            yield from _parts(inner)


def _unknown_values(store: "Store", triples: list[tuple[Any, Any, Any]]) -> Iterator[str]:
    """Texts that no property has which the query asks for them."""
    for _, path, value in triples:
        properties = _last_of(path)
        if isinstance(value, Text) and value.datatype is None and properties:
            yield from _unknown(store, value, properties)


def _compared(store: "Store", parts: list[CompValue]) -> Iterator[str]:
    """Texts that a filter compares with, and that nothing has."""
    for part in parts:
        if part.name == "RelationalExpression" and part.op in {"=", "IN"}:
            others = part.other if isinstance(part.other, list) else [part.other]
            for value in others:
                if isinstance(value, Text) and value.datatype is None:
                    yield from _unknown(store, value, [])


def _unknown(store: "Store", value: Text, properties: list[URIRef]) -> Iterator[str]:
    """That nothing has a text, with those of the same properties that are written alike."""
    path = "|".join(property_.n3() for property_ in properties) or "?any"
    if _holds(store, f"?x {path} {value.n3()}"):
        return
    asked = " or ".join(_short(property_) for property_ in properties) or "name or value"
    known = _texts(store, f"?x {path} ?found FILTER(isLiteral(?found))") if properties else []
    near = get_close_matches(str(value), known, n=MOST_NEAR)
    if not near and len(known) <= MOST_LISTED:
        near = known
    hint = f"; there is {' or '.join(map(repr, near))}" if near else ""
    if str(value) in known:
        hint = (
            "; it is there as a number, which is written without quotes, or with another language "
            "tag, or with none"
        )
    if properties and _holds(store, f"?x ({path})/<{BASE}name> {value.n3()}"):
        hint = f"; it is the name of what {asked} leads to: {asked}/capar:name"
    yield f"nothing has {str(value)!r} as its {asked}{hint}"


def _lacking(store: "Store", triples: list[tuple[Any, Any, Any]]) -> Iterator[str]:
    """Properties that are asked of a class of which nothing has them."""
    classes = {
        (subject, value)
        for subject, property_, value in triples
        if property_ == RDF.type and isinstance(subject, Variable) and isinstance(value, URIRef)
    }
    for of, class_ in sorted(classes):
        if not _holds(store, f"?x a {class_.n3()}"):
            yield f"nothing here is a {_short(class_)}"
            continue
        for subject, path, _ in triples:
            first = _first_of(path)
            if subject != of or not first or path == RDF.type:
                continue
            written = "|".join(property_.n3() for property_ in first)
            if not _holds(store, f"?x a {class_.n3()} ; {written} ?y"):
                asked = " or ".join(map(_short, first))
                own = _properties(store, class_)
                yield f"no {_short(class_)} has {asked}; they have {', '.join(own)}"


def _shapeless(store: "Store", triples: list[tuple[Any, Any, Any]]) -> Iterator[str]:
    """Things that are asked for by name, in which nothing can lie as their shape is not known."""
    if not any(URIRef(BASE + "arrangement") in _last_of(path) for _, path, _ in triples):
        return
    for _, path, value in triples:
        if isinstance(value, Text) and URIRef(BASE + "name") in _last_of(path):
            fact = f"?x a <{BASE}ShapelessObject> ; <{BASE}body>/<{BASE}name> {value.n3()}"
            if _holds(store, fact):
                yield f"{str(value)!r} is a capar:ShapelessObject, so nothing is inside it"


def _last_of(path: Any) -> list[URIRef]:
    """The properties by which a path reaches its end; none where one of them goes backwards."""
    return _reached(path.args[-1] if isinstance(path, SequencePath) else path)


def _first_of(path: Any) -> list[URIRef]:
    """The properties by which a path begins, likewise."""
    return _reached(path.args[0] if isinstance(path, SequencePath) else path)


def _reached(step: Any) -> list[URIRef]:
    ways = step.args if isinstance(step, AlternativePath) else [step]
    named = [way for way in ways if isinstance(way, URIRef)]
    return named if len(named) == len(ways) else []


def _holds(store: "Store", pattern: str) -> bool:
    return bool(store.ask(f"SELECT ?x {{ {pattern} }} LIMIT 1").rows)


def _texts(store: "Store", pattern: str) -> list[str]:
    rows = store.ask(f"SELECT DISTINCT ?found {{ {pattern} }} ORDER BY ?found").rows
    return [term.value for (term,) in rows if isinstance(term, Literal | NamedNode)]


def _properties(store: "Store", class_: URIRef) -> list[str]:
    """What things of a class have, by one of them and by all where they are few."""
    pattern = f"{{ SELECT ?x {{ ?x a {class_.n3()} }} LIMIT 100 }} ?x ?found ?y"
    return [_short(URIRef(name)) for name in _texts(store, pattern) if name.startswith(BASE)]


def _short(name: URIRef) -> str:
    return f"capar:{name[len(BASE) :]}" if name.startswith(BASE) else name.n3()
