"""What a query answers, whatever store it was asked of."""

from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass
from typing import TypeAlias

from pyoxigraph import (
    BlankNode,
    Literal,
    NamedNode,
    Quad,
    QueryBoolean,
    QueryResultsFormat,
    QuerySolutions,
    QueryTriples,
    RdfFormat,
    Triple,
    parse,
    parse_query_results,
    serialize,
)

from ontology import PREFIXES
from ontology.namespace import XSD

Found: TypeAlias = NamedNode | BlankNode | Literal | Triple | None
Plain: TypeAlias = str | int | float | bool | None

_PLAIN: dict[str, Callable[[str], Plain]] = {
    XSD + "integer": int,
    XSD + "double": float,
    XSD + "decimal": float,
    XSD + "float": float,
    XSD + "boolean": lambda text: text == "true",
}


@dataclass(frozen=True)
class Answer:
    """Rows over variables; or, for a query that constructs, statements; or yes or no."""

    variables: tuple[str, ...] = ()
    rows: tuple[tuple[Found, ...], ...] = ()
    triples: tuple[Triple, ...] | None = None
    boolean: bool | None = None

    def plain(self) -> Iterator[dict[str, Plain]]:
        """Each row by variable, its terms as Python's own values."""
        for row in self.rows:
            yield {name: plain(each) for name, each in zip(self.variables, row, strict=True)}

    def texts(self) -> list[list[str]]:
        """Each row as the texts of its literals, empty for what is none."""
        return [[t.value if isinstance(t, Literal) else "" for t in row] for row in self.rows]


def plain(term: Found) -> Plain:
    """A term as a value: a number, a truth, a text, or an IRI in its short form."""
    if term is None:
        return None
    if isinstance(term, Literal):
        return _PLAIN.get(term.datatype.value, str)(term.value)
    return short(term.value) if isinstance(term, NamedNode) else str(term)


def exact(term: Found) -> Plain:
    """The same with an IRI in full, as other programs take it."""
    return term.value if isinstance(term, NamedNode) else plain(term)


def short(iri: str) -> str:
    """An IRI with its prefix, where it has a known one."""
    for prefix, base in PREFIXES.items():
        if iri.startswith(base):
            return f"{prefix}:{iri.removeprefix(base)}"
    return iri


Result: TypeAlias = QuerySolutions | QueryBoolean | Iterable[Triple]
"""What an engine answers, read as it comes."""


def collect(result: Result) -> Answer:
    """Everything that a query answers."""
    if isinstance(result, QueryBoolean):
        return Answer(boolean=bool(result))
    if not isinstance(result, QuerySolutions):
        return Answer(triples=tuple(dict.fromkeys(result)))
    variables = tuple(each.value for each in result.variables)
    return Answer(variables, tuple(tuple(row) for row in result))


def encode(result: QuerySolutions | QueryBoolean | QueryTriples) -> tuple[str, bytes]:
    """An answer as bytes with their media type."""
    if isinstance(result, QueryTriples):
        data = serialize(result, format=RdfFormat.N_TRIPLES)
        return RdfFormat.N_TRIPLES.media_type, data or b""
    data = result.serialize(format=QueryResultsFormat.JSON)
    return QueryResultsFormat.JSON.media_type, data or b""


def decode(media_type: str, data: bytes) -> Result:
    """What such bytes state."""
    if "json" in media_type:
        return parse_query_results(data, format=QueryResultsFormat.JSON)
    return (each.triple for each in parse(data, format=RdfFormat.N_TRIPLES))


def turtle(statements: Iterable[Triple] | Iterable[Quad], *, form: RdfFormat) -> str:
    """Statements as Turtle or TriG with our prefixes, the same bytes each time."""
    data = serialize(statements, format=form, prefixes=dict(PREFIXES)) or b""
    lines = data.decode().splitlines(keepends=True)
    return "".join(
        sorted(lines, key=lambda each: (0, each) if each.startswith("@prefix") else (1, ""))
    )
