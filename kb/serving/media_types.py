"""Answers in the media type that a client accepts."""

import json
from collections.abc import Iterable, Mapping
from typing import Any

from pyoxigraph import (
    BlankNode,
    Literal,
    NamedNode,
    QueryResultsFormat,
    RdfFormat,
    parse_query_results,
    serialize,
)

from kb.serving.messages import RefusedError
from kb.store.answers import Answer, Found
from ontology.namespace import XSD

RESULTS = {
    "application/sparql-results+json": QueryResultsFormat.JSON,
    "application/sparql-results+xml": QueryResultsFormat.XML,
    "text/csv": QueryResultsFormat.CSV,
    "text/tab-separated-values": QueryResultsFormat.TSV,
    "application/json": QueryResultsFormat.JSON,
    "application/xml": QueryResultsFormat.XML,
}
"""For rows and truths, the preferred one first."""

GRAPHS = {
    "text/turtle": RdfFormat.TURTLE,
    "application/n-triples": RdfFormat.N_TRIPLES,
    "application/rdf+xml": RdfFormat.RDF_XML,
    "application/ld+json": RdfFormat.JSON_LD,
}
"""For statements, the preferred one first."""


def chosen(accept: str, offered: Iterable[str]) -> str:
    """The first media type on offer among those of the highest quality that a client accepts.

    Raises:
        RefusedError: It accepts none of them.
    """
    known = list(offered)
    wanted = [_range(part) for part in (accept or "*/*").split(",")]
    rated = [
        (max((q for pattern, q in wanted if _matches(pattern, media)), default=0.0), -at, media)
        for at, media in enumerate(known)
    ]
    quality, _, best = max(rated)
    if quality <= 0.0:
        raise RefusedError(406, f"nothing here is {accept}; accept one of {', '.join(known)}")
    return best


def _range(text: str) -> tuple[str, float]:
    pattern, *parameters = (part.strip() for part in text.split(";"))
    for parameter in parameters:
        name, _, value = parameter.partition("=")
        if name.strip() == "q":
            try:
                return pattern.lower(), float(value)
            except ValueError:
                return pattern.lower(), 0.0
    return pattern.lower(), 1.0


def _matches(pattern: str, media_type: str) -> bool:
    return pattern in {"*/*", media_type, f"{media_type.partition('/')[0]}/*"}


def encoded(answer: Answer, accept: str) -> tuple[str, bytes]:
    """An answer's media type and bytes.

    Raises:
        RefusedError: The client accepts none that there are for such an answer.
    """
    if answer.triples is not None:
        kind = chosen(accept, GRAPHS)
        return kind, serialize(answer.triples, format=GRAPHS[kind]) or b""
    kind = chosen(accept, RESULTS)
    stated = json.dumps(_document(answer)).encode()
    if RESULTS[kind] == QueryResultsFormat.JSON:
        return kind, stated
    results = parse_query_results(stated, format=QueryResultsFormat.JSON)
    return kind, results.serialize(format=RESULTS[kind]) or b""


def _document(answer: Answer) -> Mapping[str, Any]:
    if answer.boolean is not None:
        return {"head": {}, "boolean": answer.boolean}
    rows = [
        {name: _term(term) for name, term in zip(answer.variables, row, strict=True) if term}
        for row in answer.rows
    ]
    return {"head": {"vars": list(answer.variables)}, "results": {"bindings": rows}}


def _term(term: Found) -> Mapping[str, str]:
    if isinstance(term, NamedNode):
        return {"type": "uri", "value": term.value}
    if isinstance(term, BlankNode):
        return {"type": "bnode", "value": term.value}
    if not isinstance(term, Literal):
        raise RefusedError(501, "quoted triples are not written in results")
    stated = {"type": "literal", "value": term.value}
    if term.language:
        return stated | {"xml:lang": term.language}
    plain = term.datatype.value == XSD + "string"
    return stated if plain else stated | {"datatype": term.datatype.value}
