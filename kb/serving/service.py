"""Answers to requests about one Actionary."""

import hmac
import json
from collections.abc import Callable, Mapping
from dataclasses import asdict, dataclass
from typing import Any
from urllib.parse import parse_qs, unquote

from capar.model.errors import CaparError, UnknownNameError
from kb.actionary import TIME_LIMIT_S, Actionary
from kb.errors import LockedError, TimeLimitError
from kb.exchange import bring_in, export, read
from kb.queries.formats import as_json
from kb.queries.questions import check_known, question, questions
from kb.serving.description import description, page
from kb.serving.media_types import chosen, encoded
from kb.serving.messages import RefusedError, Request, Response

EXPORTS = {
    "text/turtle": "turtle",
    "application/ld+json": "jsonld",
    "application/n-quads": "nquads",
    "application/trig": "trig",
    "application/rdf+xml": "rdfxml",
}
"""Media types of statements by the names of their formats."""

DATASET = ("default-graph-uri", "named-graph-uri")


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
            return _failure(error.status, str(error), allow=error.allow)
        except TimeLimitError as error:
            return _failure(503, str(error))
        except LockedError as error:
            return _failure(503, str(error))
        except UnknownNameError as error:
            return _failure(404, str(error))
        except CaparError as error:
            return _failure(400, str(error))

    def _answered(self, request: Request) -> Response:
        first, _, rest = request.path.strip("/").partition("/")
        routes: dict[str, dict[str, Callable[[Request, str], Response]]] = {
            "": {"GET": _page},
            "openapi.json": {"GET": _described},
            "query": {"GET": self._query, "POST": self._query},
            "questions": {"GET": self._question},
            "observations": {"GET": self._observation},
            "statements": {"POST": self._statements},
        }
        methods = routes.get(first, {})
        if not methods or (rest and first not in {"questions", "observations"}):
            raise RefusedError(404, f"there is no {request.path}; {page_hint(routes)}")
        if request.method not in methods:
            allowed = ", ".join(methods)
            raise RefusedError(405, f"{request.path} takes {allowed}", allow=allowed)
        return methods[request.method](request, unquote(rest))

    def _query(self, request: Request, _: str) -> Response:
        given, text = dict(request.query), None
        if request.method == "POST":
            if request.media_type == "application/sparql-query":
                text = _text(request.body)
            elif request.media_type == "application/x-www-form-urlencoded":
                given |= {k: tuple(v) for k, v in parse_qs(_text(request.body)).items()}
            else:
                raise RefusedError(
                    415, "send application/sparql-query or application/x-www-form-urlencoded"
                )
        if any(name in given for name in DATASET):
            raise RefusedError(400, "state graphs in the query, by FROM or GRAPH")
        asked = (text,) if text is not None else given.get("query", ())
        if len(asked) != 1:
            raise RefusedError(400, "send one query")
        with self._opened() as actionary:
            found = actionary.query(asked[0], seconds=self.seconds)
        return Response(200, *encoded(found, request.headers.get("accept", "")))

    def _question(self, request: Request, name: str) -> Response:
        if not name:
            return _json([_listed(name) for name in questions()])
        given = {key: values[-1] for key, values in request.query.items()}
        text = question(name).bind(given)
        with self._opened() as actionary:
            found = actionary.store.ask_within(text, seconds=self.seconds)
            if not found.rows:
                check_known(actionary.store, question(name), given)
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


def page_hint(routes: Mapping[str, object]) -> str:
    """Which paths there are."""
    return f"there are {', '.join(f'/{route}' for route in routes)}"


def _page(_: Request, __: str) -> Response:
    return Response(200, "text/html; charset=utf-8", page().encode())


def _described(_: Request, __: str) -> Response:
    return _json(description())


def _listed(name: str) -> Mapping[str, Any]:
    one = question(name)
    return {"name": name, "question": one.text, "parameters": [asdict(e) for e in one.parameters]}


def _text(data: bytes) -> str:
    try:
        return data.decode()
    except UnicodeDecodeError:
        raise RefusedError(400, "the query is not UTF-8") from None


def _json(value: object) -> Response:
    return Response(200, "application/json", json.dumps(value, ensure_ascii=False).encode())


def _failure(status: int, message: str, *, allow: str = "") -> Response:
    body = json.dumps({"error": message}, ensure_ascii=False).encode()
    return Response(status, "application/json", body, allow)
