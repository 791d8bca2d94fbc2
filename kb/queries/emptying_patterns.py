"""Which patterns or filters of a query of one's own leave it without an answer.

Patterns that must hold are tried alone, then in pairs that share a variable, then together in the
order of the query; filters are left out one at a time. All tries are one query with a time limit.
"""

from collections.abc import Iterator, Sequence
from decimal import Decimal
from itertools import combinations
from typing import TYPE_CHECKING, Any, TypeAlias

from pyoxigraph import Literal, NamedNode
from rdflib import Literal as Text
from rdflib import URIRef, Variable
from rdflib.paths import SequencePath
from rdflib.plugins.sparql.parserutils import CompValue

from capar.model.errors import CaparError
from kb.store import sparql
from kb.store.answers import plain, short

if TYPE_CHECKING:
    from kb.store.stores import Store

LIMIT_S = 10.0
"""How long the tries may take together [s]."""

MOST_TOLD = 20
"""How many properties or values are told that there are."""

Triple: TypeAlias = tuple[Any, Any, Any]

_INNER = frozenset(
    {"SelectQuery", "Project", "Distinct", "Reduced", "OrderBy", "Slice", "Group"}
    | {"AggregateJoin", "Extend", "Filter", "ToMultiSet", "AskQuery", "ConstructQuery"}
)
"""Parts of a query's algebra whose inner pattern must hold."""


def needed_triples(part: Any) -> list[Triple]:
    """The patterns of a query's algebra without which it finds nothing, in the order of the query.

    Args:
        part: The algebra, or a part of it.
    """
    if not isinstance(part, CompValue):
        return []
    if part.name == "BGP":
        return list(part["triples"])
    if part.name == "Join":
        return needed_triples(part.p1) + needed_triples(part.p2)
    if part.name in {"LeftJoin", "Minus"}:
        return needed_triples(part.p1)
    return needed_triples(part.p) if part.name in _INNER else []


def emptying_patterns(store: "Store", query: str, triples: Sequence[Triple]) -> Iterator[str]:
    """Sentences about what empties a query: a pattern, two of them, all before one, or a filter.

    Args:
        store: What was asked.
        query: The query, with its prefixes declared.
        triples: The patterns that must hold (``needed_triples``).
    """
    try:
        yield from _emptying(store, query, list(dict.fromkeys(triples)))
    except CaparError:
        return  # there is no time to try


def _emptying(store: "Store", query: str, triples: list[Triple]) -> Iterator[str]:
    alone = [some for some, holds in _tried(store, [[t] for t in triples]) if not holds]
    if alone:
        for (triple,) in alone:
            yield _broken(store, triple)
        return
    pairs = [list(pair) for pair in combinations(triples, 2) if _variables(*pair)]
    for one, other in (pair for pair, holds in _tried(store, pairs) if not holds):
        yield f"nothing fits both  {_written(one)}  and  {_written(other)}"
        return
    grown = [triples[: count + 1] for count in range(2, len(triples))]
    for some in (some for some, holds in _tried(store, grown) if not holds):
        yield f"nothing fits  {_written(some[-1])}  together with what stands before it"
        return
    yield from _emptying_filters(store, query)


def _emptying_filters(store: "Store", query: str) -> Iterator[str]:
    spans = list(_filters(query))
    if not spans or not _rows(store, _without(query, spans)):
        return
    alone = 0
    for span in spans:
        if _rows(store, _without(query, [span])):
            alone += 1
            text = " ".join(query[slice(*span)].split())
            yield f"without {text} there would be an answer"
    if not alone:
        yield "without its FILTERs there would be an answer"


def _tried(store: "Store", patterns: list[list[Triple]]) -> list[tuple[list[Triple], bool]]:
    """Whether something fits each group of patterns."""
    if not patterns:
        return []
    tests = (
        f"(EXISTS {{ {' . '.join(map(_text, some))} }} AS ?e{number})"
        for number, some in enumerate(patterns)
    )
    answer = store.ask_within(f"SELECT {' '.join(tests)} {{}}", seconds=LIMIT_S)
    (row,) = answer.rows
    return [
        (some, isinstance(term, Literal) and term.value == "true")
        for some, term in zip(patterns, row, strict=True)
    ]


def _rows(store: "Store", query: str) -> bool:
    return bool(store.ask_within(query, seconds=LIMIT_S).rows)


def _broken(store: "Store", triple: Triple) -> str:
    """Why nothing fits a pattern: the first step of its path that leads nowhere, or its value."""
    _, path, _ = triple
    steps = path.args if isinstance(path, SequencePath) else [path]
    ways = [SequencePath(*steps[:count]) for count in range(2, len(steps) + 1)]
    begun = [[(Variable("x"), way, Variable("y"))] for way in (steps[0], *ways)]
    holding = [holds for _, holds in _tried(store, begun)]
    if not holding[0]:
        return f"nothing has {_written(steps[0])}"
    if all(holding):
        values = _found(store, f"?x {path.n3()} ?found")
        near = f"; {_written(path)} is {', '.join(values)}" if values else ""
        return f"nothing fits  {_written(triple)}{near}{_otherwise_typed(store, triple)}"
    at = holding.index(False)
    (((_, way, _),), lacking) = begun[at - 1], steps[at]
    own = _found(store, f"?x {way.n3()} ?thing . ?thing ?found ?y")
    has = [name for name in own if name.startswith("capar:")]
    return (
        f"what {_written(way)} leads to has no {_written(lacking)}; "
        f"it has {', '.join(has) or 'no property of ours'}"
    )


def _otherwise_typed(store: "Store", triple: Triple) -> str:
    """That a number is there, but written as one of another type: 0 is not 0e0."""
    _, path, value = triple
    if not isinstance(value, Text) or not isinstance(value.value, int | float | Decimal):
        return ""
    query = f"SELECT ?y {{ ?x {path.n3()} ?y FILTER(isNumeric(?y) && ?y = {value.n3()}) }} LIMIT 1"
    for (term,) in store.ask_within(query, seconds=LIMIT_S).rows:
        if isinstance(term, Literal):
            kind = term.datatype.value.rpartition("#")[2]
            return f"; it is an xsd:{kind}: write FILTER(?value = {value}) instead"
    return ""


def _found(store: "Store", pattern: str) -> list[str]:
    """Some of what a pattern has at ?found, as texts."""
    query = f"SELECT DISTINCT ?found {{ {pattern} }} ORDER BY ?found LIMIT {MOST_TOLD}"
    rows = store.ask_within(query, seconds=LIMIT_S).rows
    return [
        short(term.value) if isinstance(term, NamedNode) else _literal(term)
        for (term,) in rows
        if isinstance(term, Literal | NamedNode)
    ]


def _literal(term: Literal) -> str:
    """A number as it is, a text in quotes."""
    return str(term) if isinstance(plain(term), str) else term.value


def _variables(one: Triple, other: Triple) -> bool:
    return bool({term for term in one if isinstance(term, Variable)} & set(other))


def _text(triple: Triple) -> str:
    return " ".join(term.n3() for term in triple)


def _written(term: Any) -> str:
    """A pattern, a path or a term as the user may have written it."""
    if isinstance(term, tuple):
        return " ".join(map(_written, term))
    if isinstance(term, SequencePath):
        return "/".join(map(_written, term.args))
    if isinstance(term, Text) and term.datatype is not None:
        return str(term)
    return short(str(term)) if isinstance(term, URIRef) else str(term.n3())


def _filters(query: str) -> Iterator[tuple[int, int]]:
    """Where each FILTER of a query stands that is in no other one: its first and last letter."""
    at, begin, depth, opened = 0, -1, 0, False
    for piece in sparql.tokens(query):
        if begin < 0 and piece.kind == "word" and piece.text.lower() == "filter":
            begin, depth, opened = at, 0, False
        elif begin >= 0 and piece.kind == "other" and piece.text in "({":
            depth, opened = depth + 1, True
        elif begin >= 0 and piece.kind == "other" and piece.text in ")}":
            depth -= 1
        at += len(piece.text)
        if begin >= 0 and opened and depth == 0:
            yield begin, at
            begin = -1


def _without(query: str, spans: Sequence[tuple[int, int]]) -> str:
    for begin, end in reversed(spans):
        query = f"{query[:begin]} {query[end:]}"
    return query
