"""An Actionary over HTTP: the SPARQL 1.1 protocol, and the named questions as JSON.

One process listens and hands each request to another one, which has the Actionary open.
"""

import asyncio
import hmac
import json
import marshal
import re
import socket
from collections.abc import Callable, Iterable, Mapping
from contextlib import suppress
from dataclasses import asdict
from functools import lru_cache
from html import escape
from ipaddress import ip_address
from typing import Any, Self, TypeAlias
from urllib.parse import parse_qs, urlsplit

import uvicorn
from pyoxigraph import (
    QueryBoolean,
    QueryResultsFormat,
    QuerySolutions,
    RdfFormat,
    serialize,
)
from starlette.requests import ClientDisconnect, Request
from starlette.responses import Response
from starlette.types import Receive, Scope, Send
from uvicorn.protocols.http.auto import AutoHTTPProtocol

from capar.model.errors import CaparError, UnknownNameError
from kb.actionary import TIME_LIMIT_S, Actionary
from kb.errors import BusyError, LockedError, LostError, StoreError, TimeLimitError
from kb.exchange import bring_in, export, read
from kb.queries.questions import as_json, check_known, questions
from kb.queries.questions import question as question_of
from kb.store import sparql
from kb.store.answer_values import Result
from kb.store.stores import LONGEST_S, check_time_limit
from kb.store.updates import SCHEMA
from kb.workers import Answering, Workers

LARGEST_BODY = 256 << 20
"""How many bytes a request may hold."""

PATIENCE_S = 60.0
"""How long a connection may be silent [s]."""

BACKLOG, LONGEST_HEAD = 2048, 1 << 17
"""How many connections may wait to be taken, and how many bytes the head of a request may hold."""

RETRY_S = 2
"""When a client may ask again for what was not answered now [s]."""

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


class RefusedError(CaparError):
    """A request that is not answered, with the status that says why."""

    def __init__(self, status: int, message: str, *, allow: str = "") -> None:
        self.status = status
        self.allow = allow
        super().__init__(message)


class UnreadError(RefusedError):
    """A request whose body is not read; whoever sent it may not take JSON."""


STATUSES = (
    ((TimeLimitError, LockedError, BusyError, LostError), 503),
    (UnknownNameError, 404),
    (CaparError, 400),
)
"""The status of each error; the first that fits."""


class Service:
    """An Actionary's answers; it is kept open, and opened anew when others have written."""

    def __init__(self, place: str, token: str = "", *, seconds: float = TIME_LIMIT_S) -> None:
        """Say what is served.

        Args:
            place: Folder or address.
            token: What a client that writes must bear; empty where nobody may write.
            seconds: How long a server takes for an answer at most [s].

        Raises:
            QueryError: So many seconds are no time limit.
        """
        check_time_limit(seconds)
        self.place, self.token, self.seconds = place, token, min(seconds, LONGEST_S)
        self._kept: Actionary | None = None

    def begin(self) -> Answering:
        """Open the Actionary, if it can be, in a process that answers for a server."""
        with suppress(CaparError):
            self._opened()
        return self._answer_message

    def _answer_message(self, message: bytes) -> bytes:
        method, path, query, headers, body = marshal.loads(message)
        scope = {"type": "http", "method": method, "path": path, "query_string": query}
        response = self.answer(Request(scope | {"headers": headers}), body)
        return marshal.dumps((response.status_code, response.raw_headers, response.body))

    def answer(self, request: Request, body: bytes = b"") -> Response:
        """The response to a request, errors included."""
        try:
            self.check(request)
            route, name = _parts(request)
            return ROUTES[route][request.method](self, request, body, name)
        except CaparError as error:
            return refusal(error)

    def check(self, request: Request) -> None:
        """Check a request before its body is read.

        Raises:
            RefusedError: There is no such path, it has no such method, or writing is refused.
        """
        route, name = _parts(request)
        methods = ROUTES.get(route, {})
        path = request.scope["path"]
        if not methods or (name and route not in {"questions", "observations"}):
            listed = ", ".join(f"/{route}" for route in ROUTES)
            raise RefusedError(404, f"there is no {path}; there are {listed}")
        if request.method not in methods:
            allowed = ", ".join(methods)
            raise RefusedError(405, f"{path} takes {allowed}", allow=allowed)
        if not writes(request):
            return
        if not self.token:
            raise RefusedError(
                403, "this server only reads; `capar serve --token` lets clients write"
            )
        given = request.headers.get("authorization", "")
        if not hmac.compare_digest(given.encode(), f"Bearer {self.token}".encode()):
            raise RefusedError(401, "writing needs the header Authorization: Bearer TOKEN")

    def _page(self, request: Request, body: bytes, name: str) -> Response:
        return _response(page().encode(), "text/html; charset=utf-8")

    def _description(self, request: Request, body: bytes, name: str) -> Response:
        return _json(description())

    def _query(self, request: Request, body: bytes, name: str) -> Response:
        kind = (_media_type(request) or "none") if request.method == "POST" else ""
        query = _asked(request.scope["query_string"], kind, body)
        accept = request.headers.get("accept", "")
        store = self._opened().store
        return _response(*store.answered(query, lambda found: encoded(found, accept)))

    def _question(self, request: Request, body: bytes, name: str) -> Response:
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
        given = dict(request.query_params)
        text = question_of(name).bind(given)
        store = self._opened().store
        found = store.ask(text)
        if not found.rows:
            check_known(store, question_of(name), given)
        return _response(as_json(found).encode(), "application/json")

    def _observation(self, request: Request, body: bytes, name: str) -> Response:
        actionary = self._opened()
        if not name:
            return _json([asdict(observation) for observation in actionary.observations()])
        kind = chosen(request.headers.get("accept", ""), EXPORTS)
        return _response(export(actionary.store, EXPORTS[kind], observation=name), kind)

    def _statements(self, request: Request, body: bytes, name: str) -> Response:
        form = EXPORTS.get(_media_type(request))
        if form is None:
            raise RefusedError(415, f"send one of {', '.join(EXPORTS)}")
        quads = read(body, form, path="the request")
        with Actionary.open(self.place) as actionary:
            statements, observations = bring_in(actionary.store, quads, source="the request")
        return _json({"statements": statements, "observations": observations})

    def _opened(self) -> Actionary:
        """The Actionary as it is now."""
        kept, self._kept = self._kept, None  # what fails is opened anew next time
        if kept is None:
            kept = Actionary.open(self.place, read_only=True)
        else:
            kept.refresh()
        self._kept = kept
        return kept


_Answered: TypeAlias = Callable[[Service, Request, bytes, str], Response]

ROUTES: Mapping[str, Mapping[str, _Answered]] = {
    "": {"GET": Service._page},
    "openapi.json": {"GET": Service._description},
    "query": {"GET": Service._query, "POST": Service._query},
    "questions": {"GET": Service._question},
    "observations": {"GET": Service._observation},
    "statements": {"POST": Service._statements},
}
"""What answers, by the first part of a path and the method."""


def _parts(request: Request) -> tuple[str, str]:
    route, _, name = request.scope["path"].strip("/").partition("/")
    return route, name


def writes(request: Request) -> bool:
    """Whether a request is one to write."""
    return request.method == "POST" and _parts(request)[0] == "statements"


def _media_type(request: Request) -> str:
    return request.headers.get("content-type", "").partition(";")[0].strip().lower()


@lru_cache
def _asked(query_string: bytes, kind: str, body: bytes) -> str:
    """The query of a request, prepared; a body has a kind."""
    given = parse_qs(query_string.decode("latin-1"), keep_blank_values=True)
    if kind:
        try:
            text = body.decode()
        except UnicodeDecodeError:
            raise RefusedError(400, "the query is not UTF-8") from None
        if kind == "application/sparql-query":
            given["query"] = [text]
        elif kind == "application/x-www-form-urlencoded":
            given |= parse_qs(text)
        else:
            raise RefusedError(
                415, "send application/sparql-query or application/x-www-form-urlencoded"
            )
    if {"default-graph-uri", "named-graph-uri"} & given.keys():
        raise RefusedError(400, "state graphs in the query, by FROM or GRAPH")
    asked = given.get("query", ())
    if len(asked) != 1:
        raise RefusedError(400, "send one query")
    return sparql.prepare(asked[0])


def _response(body: bytes, kind: str, status: int = 200, **headers: str) -> Response:
    stated = {"content-type": kind, "x-content-type-options": "nosniff"}
    return Response(body, status, headers=stated | headers)


def _json(value: object, status: int = 200, **headers: str) -> Response:
    body = json.dumps(value, ensure_ascii=False).encode()
    return _response(body, "application/json", status, **headers)


def refusal(error: CaparError) -> Response:
    """The response that states an error."""
    headers = {}
    if isinstance(error, RefusedError):
        status = error.status
        if isinstance(error, UnreadError):
            headers = {"connection": "close"} if status != 403 else {}
            return _response(f"{error}\n".encode(), "text/plain; charset=utf-8", status, **headers)
        headers = {"allow": error.allow} if error.allow else {}
    else:
        status = next(code for kinds, code in STATUSES if isinstance(error, kinds))
    if status == 401:
        headers["www-authenticate"] = "Bearer"
    if status == 503:
        headers["retry-after"] = str(RETRY_S)
    return _json({"error": str(error)}, status, **headers)


# Media types


def chosen(accept: str, offered: Iterable[str]) -> str:
    """The first media type on offer among those of the highest quality that a client accepts.

    Raises:
        RefusedError: It accepts none of them.
    """
    known = list(offered)
    if accept in known:
        return accept
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


def encoded(found: Result, accept: str) -> tuple[bytes, str]:
    """An answer's bytes and media type.

    Raises:
        RefusedError: The client accepts none that there are for such an answer.
    """
    if isinstance(found, QueryBoolean | QuerySolutions):
        kind = chosen(accept, RESULTS)
        return found.serialize(format=RESULTS[kind]) or b"", kind
    kind = chosen(accept, GRAPHS)
    return serialize(dict.fromkeys(found), format=GRAPHS[kind]) or b"", kind


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


class ActionaryServer(uvicorn.Server):
    """Listens until it is shut down; what it starts ends with it."""

    def __init__(self, service: Service, *, host: str = "127.0.0.1", port: int = 7879) -> None:
        """Take the port, 0 for any that is free, and start the processes that answer.

        Raises:
            StoreError: It cannot listen there.
        """
        self.service = service
        self.loopback = is_loopback(host)
        try:
            family = socket.AF_INET6 if ":" in host else socket.AF_INET
            dual = family == socket.AF_INET6 and socket.has_dualstack_ipv6()
            self._socket = socket.create_server(
                (host, port), family=family, backlog=BACKLOG, dualstack_ipv6=dual
            )
        except (OSError, OverflowError) as error:
            raise StoreError(
                f"{host}:{port}: cannot listen there ({error}); try another --port"
            ) from None
        super().__init__(
            uvicorn.Config(
                self._answer,
                interface="asgi3",
                http=_Connection,
                ws="none",
                lifespan="off",
                log_config=None,
                log_level="error",
                access_log=False,
                server_header=False,
                proxy_headers=False,
                backlog=BACKLOG,
                timeout_keep_alive=int(PATIENCE_S),
                timeout_graceful_shutdown=1,
                h11_max_incomplete_event_size=LONGEST_HEAD,
            )
        )
        self._workers = Workers(service.begin, seconds=service.seconds)

    def __enter__(self) -> Self:
        """Listen already; who connects waits."""
        return self

    def __exit__(self, *_: object) -> None:
        """Leave nothing running."""
        self._workers.close()
        self._socket.close()

    @property
    def url(self) -> str:
        """Where it is."""
        host, port = self._socket.getsockname()[:2]
        return f"http://{f'[{host}]' if ':' in host else host}:{port}/"

    def serve_forever(self) -> None:
        """Answer until ``should_exit`` is set, or a signal says so."""
        self.run(sockets=[self._socket])

    async def startup(self, sockets: list[socket.socket] | None = None) -> None:
        """Look after the processes, and answer."""
        self._watching = asyncio.create_task(self._workers.watch())
        self._watching.add_done_callback(lambda _: setattr(self, "should_exit", True))
        await super().startup(sockets)

    async def shutdown(self, sockets: list[socket.socket] | None = None) -> None:
        """End the processes and what they are at, then the connections."""
        self._watching.cancel()
        self._workers.close()
        await super().shutdown(sockets)

    async def _answer(self, scope: Scope, receive: Receive, send: Send) -> None:
        asked = Request({**scope, "method": "GET"} if scope["method"] == "HEAD" else scope, receive)
        try:
            self._check_head(asked)
            self.service.check(asked)
            status, headers, body = marshal.loads(await self._answered(asked))
        except ClientDisconnect:
            return
        except CaparError as error:
            await refusal(error)(scope, receive, send)
            return
        await send({"type": "http.response.start", "status": status, "headers": headers})
        await send({"type": "http.response.body", "body": body})

    def _check_head(self, request: Request) -> None:
        """Refuse a foreign host's name, a page of another site, or a body without end."""
        length = request.headers.get("content-length")
        if self.loopback and not _names_loopback(request.headers.get("host", "")):
            raise UnreadError(403, "ask for it by the name localhost or a loopback address")
        origin = request.headers.get("origin")
        if self.loopback and origin is not None and not _names_loopback(origin.partition("://")[2]):
            raise UnreadError(403, f"pages of {origin} may not ask this server")
        if request.method == "POST" and (length is None or not length.isdecimal()):
            raise UnreadError(411, "say how long the body is: Content-Length")
        if length is not None and int(length) > LARGEST_BODY:
            raise UnreadError(413, f"a body may hold {LARGEST_BODY} bytes at most")

    async def _answered(self, request: Request) -> bytes:
        body, more = bytearray(), request.method == "POST"
        while more:
            try:
                async with asyncio.timeout(PATIENCE_S):
                    part = await request.receive()
            except TimeoutError:
                raise UnreadError(408, "the body did not come") from None
            if part["type"] == "http.disconnect":
                raise ClientDisconnect
            body += part.get("body", b"")
            more = part.get("more_body", False)
        scope = request.scope
        given = (scope["method"], scope["path"], scope["query_string"], scope["headers"])
        message = marshal.dumps((*given, bytes(body)))
        if writes(request):
            return await self._workers.answer_alone(message)
        return await self._workers.answer(message, request.is_disconnected)


class _Connection(AutoHTTPProtocol):  # type: ignore[misc, valid-type]
    """A connection that is closed where no request comes."""

    def connection_made(self, transport: asyncio.Transport) -> None:
        super().connection_made(transport)
        self._silent = self.loop.call_later(PATIENCE_S, self._close_if_silent)

    def connection_lost(self, exc: Exception | None) -> None:
        self._silent.cancel()
        super().connection_lost(exc)

    def _close_if_silent(self) -> None:
        if self.cycle is None:
            self.transport.close()


@lru_cache
def _names_loopback(host: str) -> bool:
    """Whether the header Host names this computer alone."""
    try:
        return is_loopback(urlsplit(f"//{host}").hostname or "")
    except ValueError:
        return False


def is_loopback(host: str) -> bool:
    """Whether a host's name or address is of this computer alone."""
    name = host.strip("[]")
    if name.lower() == "localhost":
        return True
    try:
        return ip_address(name).is_loopback
    except ValueError:
        return False
