"""An Actionary over HTTP: the SPARQL 1.1 protocol, and the named questions as JSON."""

import hmac
import json
import re
from collections.abc import Callable, Iterable, Mapping
from dataclasses import asdict, dataclass, field
from html import escape
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer
from ipaddress import ip_address
from socket import AF_INET6
from typing import Any
from urllib.parse import parse_qs, unquote, urlsplit

from pyoxigraph import (
    BlankNode,
    Literal,
    NamedNode,
    QueryResultsFormat,
    RdfFormat,
    parse_query_results,
    serialize,
)

from capar.model.errors import CaparError, UnknownNameError
from kb.actionary import TIME_LIMIT_S, Actionary
from kb.errors import LockedError, StoreError, TimeLimitError
from kb.exchange import bring_in, export, read
from kb.queries.questions import as_json, check_known, questions
from kb.queries.questions import question as question_of
from kb.store.answer_values import Answer, Found
from kb.store.updates import SCHEMA
from ontology.namespace import XSD

LARGEST_BODY = 256 << 20
"""How many bytes a request may hold."""

PATIENCE_S = 60.0
"""How long a connection may be silent [s]."""

RESULTS = {
    "application/sparql-results+json": QueryResultsFormat.JSON,
    "application/sparql-results+xml": QueryResultsFormat.XML,
    "text/csv": QueryResultsFormat.CSV,
    "text/tab-separated-values": QueryResultsFormat.TSV,
    "application/json": QueryResultsFormat.JSON,
    "application/xml": QueryResultsFormat.XML,
}
"""Media types for rows and truths, the preferred one first."""

GRAPHS = {
    "text/turtle": RdfFormat.TURTLE,
    "application/n-triples": RdfFormat.N_TRIPLES,
    "application/rdf+xml": RdfFormat.RDF_XML,
    "application/ld+json": RdfFormat.JSON_LD,
}
"""Media types for statements, the preferred one first."""

EXPORTS = {
    "text/turtle": "turtle",
    "application/ld+json": "jsonld",
    "application/n-quads": "nquads",
    "application/trig": "trig",
    "application/rdf+xml": "rdfxml",
}
"""Media types of exports and imports, with the names of their formats."""


@dataclass(frozen=True, slots=True)
class Request:
    """One HTTP request."""

    method: str
    path: str
    """Without what follows a question mark, percent signs resolved."""

    query: Mapping[str, tuple[str, ...]] = field(default_factory=dict)
    """Values by name of what follows it."""

    headers: Mapping[str, str] = field(default_factory=dict)
    """By their names in small letters."""

    body: bytes = b""

    @property
    def media_type(self) -> str:
        """Of the body, without parameters."""
        return self.headers.get("content-type", "").partition(";")[0].strip().lower()


@dataclass(frozen=True, slots=True)
class Response:
    """One HTTP response."""

    status: int
    media_type: str
    body: bytes
    allow: str = ""
    """The methods that the path has, where it has not the one that was asked."""


class RefusedError(CaparError):
    """A request that is not answered, with the status that says why."""

    def __init__(self, status: int, message: str, *, allow: str = "") -> None:
        self.status = status
        self.allow = allow
        super().__init__(message)


STATUSES = ((TimeLimitError, 503), (LockedError, 503), (UnknownNameError, 404), (CaparError, 400))
"""The status of each error; the first that fits."""


@dataclass(frozen=True, slots=True)
class Service:
    """An Actionary's answers; each request opens it anew, so it sees what others wrote."""

    place: str
    """Folder or address."""

    token: str = ""
    """What a client that writes must bear; empty where nobody may write."""

    seconds: float = TIME_LIMIT_S
    """How long a query may take [s]."""

    def answer(self, request: Request) -> Response:
        """The response to a request, errors included."""
        try:
            return self._answered(request)
        except RefusedError as error:
            return _json({"error": str(error)}, status=error.status, allow=error.allow)
        except CaparError as error:
            status = next(code for kind, code in STATUSES if isinstance(error, kind))
            return _json({"error": str(error)}, status=status)

    def _answered(self, request: Request) -> Response:
        first, _, rest = request.path.strip("/").partition("/")
        routes: dict[str, dict[str, Callable[[Request, str], Response]]] = {
            "": {"GET": lambda *_: Response(200, "text/html; charset=utf-8", page().encode())},
            "openapi.json": {"GET": lambda *_: _json(description())},
            "query": {"GET": self._query, "POST": self._query},
            "questions": {"GET": self._question},
            "observations": {"GET": self._observation},
            "statements": {"POST": self._statements},
        }
        methods = routes.get(first, {})
        if not methods or (rest and first not in {"questions", "observations"}):
            listed = ", ".join(f"/{route}" for route in routes)
            raise RefusedError(404, f"there is no {request.path}; there are {listed}")
        if request.method not in methods:
            allowed = ", ".join(methods)
            raise RefusedError(405, f"{request.path} takes {allowed}", allow=allowed)
        return methods[request.method](request, unquote(rest))

    def _query(self, request: Request, _: str) -> Response:
        given = dict(request.query)
        if request.method == "POST":
            try:
                text = request.body.decode()
            except UnicodeDecodeError:
                raise RefusedError(400, "the query is not UTF-8") from None
            if request.media_type == "application/sparql-query":
                given["query"] = (text,)
            elif request.media_type == "application/x-www-form-urlencoded":
                given |= {name: tuple(values) for name, values in parse_qs(text).items()}
            else:
                raise RefusedError(
                    415, "send application/sparql-query or application/x-www-form-urlencoded"
                )
        if {"default-graph-uri", "named-graph-uri"} & given.keys():
            raise RefusedError(400, "state graphs in the query, by FROM or GRAPH")
        asked = given.get("query", ())
        if len(asked) != 1:
            raise RefusedError(400, "send one query")
        with self._opened() as actionary:
            found = actionary.query(asked[0], seconds=self.seconds)
        return Response(200, *encoded(found, request.headers.get("accept", "")))

    def _question(self, request: Request, name: str) -> Response:
        if not name:
            return _json(
                [
                    {
                        "name": each.name,
                        "question": each.text,
                        "parameters": [asdict(parameter) for parameter in each.parameters],
                    }
                    for each in questions().values()
                ]
            )
        given = {key: values[-1] for key, values in request.query.items()}
        text = question_of(name).bind(given)
        with self._opened() as actionary:
            found = actionary.store.ask_within(text, seconds=self.seconds)
            if not found.rows:
                check_known(actionary.store, question_of(name), given)
        return Response(200, "application/json", as_json(found).encode())

    def _observation(self, request: Request, name: str) -> Response:
        with self._opened() as actionary:
            if not name:
                return _json([asdict(observation) for observation in actionary.observations()])
            kind = chosen(request.headers.get("accept", ""), EXPORTS)
            return Response(200, kind, export(actionary.store, EXPORTS[kind], observation=name))

    def _statements(self, request: Request, _: str) -> Response:
        if not self.token:
            raise RefusedError(
                403, "this server only reads; `capar serve --token` lets clients write"
            )
        given = request.headers.get("authorization", "")
        if not hmac.compare_digest(given.encode(), f"Bearer {self.token}".encode()):
            raise RefusedError(401, "writing needs the header Authorization: Bearer TOKEN")
        form = EXPORTS.get(request.media_type)
        if form is None:
            raise RefusedError(415, f"send one of {', '.join(EXPORTS)}")
        quads = read(request.body, form, path="the request")
        with Actionary.open(self.place) as actionary:
            statements, observations = bring_in(actionary.store, quads, source="the request")
        return _json({"statements": statements, "observations": observations})

    def _opened(self) -> Actionary:
        return Actionary.open(self.place, read_only=True)


def _json(value: object, *, status: int = 200, allow: str = "") -> Response:
    body = json.dumps(value, ensure_ascii=False).encode()
    return Response(status, "application/json", body, allow)


# Media types


def chosen(accept: str, offered: Iterable[str]) -> str:
    """The first media type on offer among those of the highest quality that a client accepts.

    Raises:
        RefusedError: It accepts none of them.
    """
    known = list(offered)
    wanted = {}
    for part in (accept or "*/*").split(","):
        pattern, *parameters = (each.strip() for each in part.split(";"))
        stated = re.search(r"(?:^|;)\s*q\s*=\s*([\d.]+|[^;]*)", ";".join(parameters))
        try:
            wanted[pattern.lower()] = float(stated[1]) if stated else 1.0
        except ValueError:
            wanted[pattern.lower()] = 0.0

    def quality(media: str) -> float:
        patterns = ("*/*", media, f"{media.partition('/')[0]}/*")
        return max((wanted.get(each, 0.0) for each in patterns), default=0.0)

    best = max(known, key=quality)
    if quality(best) <= 0.0:
        raise RefusedError(406, f"nothing here is {accept}; accept one of {', '.join(known)}")
    return best


def encoded(answer: Answer, accept: str) -> tuple[str, bytes]:
    """An answer's media type and bytes.

    Raises:
        RefusedError: The client accepts none that there are for such an answer.
    """
    if answer.triples is not None:
        kind = chosen(accept, GRAPHS)
        return kind, serialize(answer.triples, format=GRAPHS[kind]) or b""
    kind = chosen(accept, RESULTS)
    document: dict[str, Any] = {"head": {}, "boolean": answer.boolean}
    if answer.boolean is None:
        rows = [
            {name: _term(term) for name, term in zip(answer.variables, row, strict=True) if term}
            for row in answer.rows
        ]
        document = {"head": {"vars": list(answer.variables)}, "results": {"bindings": rows}}
    stated = json.dumps(document).encode()
    if RESULTS[kind] == QueryResultsFormat.JSON:
        return kind, stated
    results = parse_query_results(stated, format=QueryResultsFormat.JSON)
    return kind, results.serialize(format=RESULTS[kind]) or b""


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


# What is offered


def description() -> Mapping[str, Any]:
    """The OpenAPI 3.1 document: the protocol's paths, and one for each named question."""
    text = _parameter("query", "query", "string", required=True)
    name = _parameter("name", "path", "string", required=True)
    asked = {}
    for question in questions().values():
        taken = []
        for each in question.parameters:
            kind = "number" if each.kind == "number" else "string"
            one = _parameter(each.name, "query", kind, required=each.required)
            one["description"] = each.meaning
            if each.default:
                one["schema"]["default"] = each.default
            taken.append(one)
        asked[f"/questions/{question.name}"] = {"get": _operation(question.text, *taken)}
    writes = _operation("Add RDF; it is checked first, and needs a bearer token.")
    return {
        "openapi": "3.1.0",
        "info": {"title": "Actionary", "version": str(SCHEMA)},
        "paths": {
            "/query": {
                "get": _operation("A SPARQL 1.1 query.", text),
                "post": _operation("A SPARQL 1.1 query as the body, or as a form's field query."),
            },
            "/questions": {"get": _operation("The named questions with their parameters.")},
            **asked,
            "/observations": {"get": _operation("What is observed.")},
            "/observations/{name}": {
                "get": _operation("One observation with all that it mentions, as RDF.", name)
            },
            "/statements": {"post": writes | {"security": [{"token": []}]}},
        },
        "components": {"securitySchemes": {"token": {"type": "http", "scheme": "bearer"}}},
    }


def _operation(summary: str, *parameters: Mapping[str, Any]) -> dict[str, Any]:
    answered = {"200": {"description": "The answer."}, "400": {"description": "A mistake in it."}}
    return {"summary": summary, "parameters": list(parameters), "responses": answered}


def _parameter(name: str, where: str, kind: str, *, required: bool) -> dict[str, Any]:
    return {"name": name, "in": where, "required": required, "schema": {"type": kind}}


def page() -> str:
    """The same for people, without scripts."""
    rows = []
    for each in questions().values():
        taken = ", ".join(p.name if p.required else f"[{p.name}]" for p in each.parameters)
        link = f"<a href='/questions/{escape(each.name)}'>{escape(each.name)}</a>"
        rows.append(f"<tr><td>{link}</td><td>{escape(each.text)}</td><td>{escape(taken)}</td></tr>")
    return (
        "<!doctype html><html lang='en'><meta charset='utf-8'><title>Actionary</title>"
        "<h1>Actionary</h1><p>SPARQL 1.1 at <code>/query</code>; "
        "<a href='/observations'>observations</a>; <a href='/openapi.json'>OpenAPI</a>.</p>"
        "<form action='/query'><textarea name='query' rows='8' cols='80'>"
        "SELECT ?address { ?segment capar:address ?address }</textarea>"
        "<p><button>Ask</button></p></form>"
        f"<table><tr><th>Question</th><th></th><th>Parameters</th></tr>{''.join(rows)}</table>"
        "</html>"
    )


# Sockets


class ActionaryServer(ThreadingHTTPServer):
    """Listens until it is shut down; a thread for each connection."""

    daemon_threads = True

    def __init__(self, service: Service, *, host: str = "127.0.0.1", port: int = 7879) -> None:
        """Take the port; 0 for any that is free.

        Raises:
            StoreError: It cannot listen there.
        """
        self.service = service
        self.loopback = is_loopback(host)
        if ":" in host:
            self.address_family = AF_INET6
        try:
            super().__init__((host, port), _Handler)
        except (OSError, OverflowError) as error:
            raise StoreError(
                f"{host}:{port}: cannot listen there ({error}); try another --port"
            ) from None

    @property
    def url(self) -> str:
        """Where it is."""
        host, port = self.server_address[:2]
        name = str(host)
        return f"http://{f'[{name}]' if ':' in name else name}:{port}/"


def is_loopback(host: str) -> bool:
    """Whether a host's name or address is of this computer alone."""
    name = host.strip("[]")
    if name.lower() == "localhost":
        return True
    try:
        return ip_address(name).is_loopback
    except ValueError:
        return False


class _Handler(BaseHTTPRequestHandler):
    protocol_version = "HTTP/1.1"
    timeout = PATIENCE_S
    server: ActionaryServer

    def do_GET(self) -> None:
        """Answer; HEAD without the body."""
        response = self._refused() or self.server.service.answer(self._request())
        self.send_response(response.status)
        self.send_header("Content-Type", response.media_type)
        self.send_header("Content-Length", str(len(response.body)))
        self.send_header("X-Content-Type-Options", "nosniff")
        if response.allow:
            self.send_header("Allow", response.allow)
        if response.status == 401:
            self.send_header("WWW-Authenticate", "Bearer")
        if response.status in {411, 413}:
            self.close_connection = True
            self.send_header("Connection", "close")
        self.end_headers()
        if self.command != "HEAD":
            self.wfile.write(response.body)

    do_HEAD = do_GET  # noqa: N815
    do_POST = do_GET  # noqa: N815

    def _refused(self) -> Response | None:
        """Why a request is not even read: a foreign host's name, or a body without end."""
        host = urlsplit(f"//{self.headers.get('Host', '')}").hostname or ""
        length = self.headers.get("Content-Length")
        if self.server.loopback and not is_loopback(host):
            status, why = 403, "ask for it by the name localhost or a loopback address"
        elif self.command == "POST" and (length is None or not length.isdecimal()):
            status, why = 411, "say how long the body is: Content-Length"
        elif length is not None and int(length) > LARGEST_BODY:
            status, why = 413, f"a body may hold {LARGEST_BODY} bytes at most"
        else:
            return None
        return Response(status, "text/plain; charset=utf-8", f"{why}\n".encode())

    def _request(self) -> Request:
        parts = urlsplit(self.path)
        asked = parse_qs(parts.query, keep_blank_values=True)
        length = int(self.headers.get("Content-Length") or 0)
        return Request(
            "GET" if self.command == "HEAD" else self.command,
            unquote(parts.path),
            {name: tuple(values) for name, values in asked.items()},
            {name.lower(): value for name, value in self.headers.items()},
            self.rfile.read(length) if length else b"",
        )

    def log_message(self, format: str, *args: object) -> None:
        """Write nothing; errors are answered."""
