"""What the server offers: as an OpenAPI document, and as a page for people."""

from collections.abc import Mapping
from html import escape
from typing import Any

from kb.queries.questions import Parameter, Question, questions
from kb.store.updates import SCHEMA

_KINDS = {"text": "string", "number": "number"}


def description() -> Mapping[str, Any]:
    """The OpenAPI 3.1 document: the protocol's paths, and one for each named question."""
    asked = {
        f"/questions/{question.name}": {"get": _operation(question)}
        for question in questions().values()
    }
    return {
        "openapi": "3.1.0",
        "info": {"title": "Actionary", "version": str(SCHEMA)},
        "paths": {
            "/query": {
                "get": _plain("A SPARQL 1.1 query.", [_given("query", "string", required="yes")]),
                "post": _plain("A SPARQL 1.1 query as the body, or as a form's field query.", []),
            },
            "/questions": {"get": _plain("The named questions with their parameters.", [])},
            **asked,
            "/observations": {"get": _plain("What is observed.", [])},
            "/observations/{name}": {
                "get": _plain(
                    "One observation with all that it mentions, as RDF.", [_in_path("name")]
                )
            },
            "/statements": {
                "post": _plain("Add RDF; it is checked first, and needs a bearer token.", [])
                | {"security": [{"token": []}]}
            },
        },
        "components": {"securitySchemes": {"token": {"type": "http", "scheme": "bearer"}}},
    }


def _operation(asked: Question) -> Mapping[str, Any]:
    return _plain(asked.text, [_parameter(wanted) for wanted in asked.parameters])


def _plain(summary: str, parameters: list[Mapping[str, Any]]) -> dict[str, Any]:
    answered = {"200": {"description": "The answer."}, "400": {"description": "A mistake in it."}}
    return {"summary": summary, "parameters": parameters, "responses": answered}


def _parameter(one: Parameter) -> Mapping[str, Any]:
    given = _given(one.name, _KINDS[one.kind], required="yes" if one.required else "")
    schema = given["schema"] | ({"default": one.default} if one.default else {})
    return {**given, "description": one.meaning, "schema": schema}


def _given(name: str, kind: str, *, required: str) -> dict[str, Any]:
    return {"name": name, "in": "query", "required": bool(required), "schema": {"type": kind}}


def _in_path(name: str) -> Mapping[str, Any]:
    return {"name": name, "in": "path", "required": True, "schema": {"type": "string"}}


def page() -> str:
    """The same for people, without scripts."""
    rows = "".join(
        f"<tr><td><a href='/questions/{escape(question.name)}'>{escape(question.name)}</a></td>"
        f"<td>{escape(question.text)}</td><td>{escape(_names(question))}</td></tr>"
        for question in questions().values()
    )
    return (
        "<!doctype html><html lang='en'><meta charset='utf-8'><title>Actionary</title>"
        "<h1>Actionary</h1><p>SPARQL 1.1 at <code>/query</code>; "
        "<a href='/observations'>observations</a>; <a href='/openapi.json'>OpenAPI</a>.</p>"
        "<form action='/query'><textarea name='query' rows='8' cols='80'>"
        "SELECT ?address { ?segment capar:address ?address }</textarea>"
        "<p><button>Ask</button></p></form>"
        f"<table><tr><th>Question</th><th></th><th>Parameters</th></tr>{rows}</table></html>"
    )


def _names(asked: Question) -> str:
    return ", ".join(
        wanted.name if wanted.required else f"[{wanted.name}]" for wanted in asked.parameters
    )
