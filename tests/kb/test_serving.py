"""An Actionary is asked over HTTP, and written by those alone who bear the token."""

import json
import threading
import urllib.error
import urllib.request
from collections.abc import Iterator
from pathlib import Path

import pytest
from observations import drink_from_mug, with_unknown
from pyoxigraph import QueryResultsFormat, RdfFormat, parse, parse_query_results

from kb.actionary import Actionary
from kb.exchange import FORMATS, export, read
from kb.queries.questions import questions
from kb.serving import ActionaryServer, Request, Response, Service

TOKEN = "a secret"
NAMES = "SELECT ?name { ?o a capar:Observation ; rdfs:label ?name }"


@pytest.fixture(scope="module")
def place(tmp_path_factory: pytest.TempPathFactory) -> str:
    folder = tmp_path_factory.mktemp("served") / "actionary"
    with Actionary.open(folder) as actionary:
        actionary.add(drink_from_mug())
    return str(folder)


@pytest.fixture(scope="module")
def served(place: str) -> Iterator[str]:
    with ActionaryServer(Service(place), port=0) as server:
        thread = threading.Thread(target=server.serve_forever)
        thread.start()
        yield server.url
        server.shutdown()
        thread.join()


def get(service: Service, path: str, *, accept: str = "", **given: str) -> Response:
    asked = {name: (value,) for name, value in given.items()}
    return service.answer(Request("GET", path, asked, {"accept": accept}))


def post(service: Service, path: str, body: bytes, kind: str, *, token: str = "") -> Response:
    headers = {"content-type": kind, "authorization": f"Bearer {token}"}
    return service.answer(Request("POST", path, {}, headers, body))


@pytest.mark.parametrize(
    ("method", "kind", "body"),
    [
        ("GET", "", b""),
        ("POST", "application/sparql-query", NAMES.encode()),
        ("POST", "application/x-www-form-urlencoded", f"query={NAMES.replace(' ', '+')}".encode()),
    ],
)
def test_a_query_is_asked_in_the_three_ways_of_the_protocol(place, method, kind, body) -> None:
    given = {"query": (NAMES,)} if method == "GET" else {}
    request = Request(method, "/query", given, {"content-type": kind}, body)
    response = Service(place).answer(request)
    assert (response.status, response.media_type) == (200, "application/sparql-results+json")
    (row,) = json.loads(response.body)["results"]["bindings"]
    assert row["name"]["value"] == "DrinkFromMug"


@pytest.mark.parametrize(
    ("accept", "form"),
    [
        ("application/sparql-results+json", QueryResultsFormat.JSON),
        ("text/html;q=0.9, application/sparql-results+xml", QueryResultsFormat.XML),
        ("text/tab-separated-values", QueryResultsFormat.TSV),
    ],
)
def test_rows_come_in_the_form_that_is_accepted(place, accept, form) -> None:
    query = "SELECT * { ?s capar:duration ?seconds ; rdfs:label ?name } LIMIT 3"
    response = get(Service(place), "/query", accept=accept, query=query)
    assert len(list(parse_query_results(response.body, format=form))) == 3


def test_statements_come_in_the_form_that_is_accepted(place) -> None:
    query = "CONSTRUCT { ?s ?p ?o } { ?s a capar:Segment ; ?p ?o }"
    found = {
        frozenset(each.triple for each in parse(response.body, format=form))
        for kind, form in (
            ("text/turtle", RdfFormat.TURTLE),
            ("application/rdf+xml", RdfFormat.RDF_XML),
        )
        if (response := get(Service(place), "/query", accept=kind, query=query)).status == 200
    }
    assert len(found) == 1
    assert get(Service(place), "/query", accept="image/png", query=query).status == 406


@pytest.mark.parametrize(
    ("request_", "status", "told"),
    [
        (Request("GET", "/nowhere"), 404, "/questions"),
        (Request("GET", "/questions/segmets"), 404, "Did you mean 'segments'?"),
        (Request("GET", "/questions/world"), 400, "must be given"),
        (Request("GET", "/questions/segments", {"ee": ("tail",)}), 404, "right_hand"),
        (Request("GET", "/observations/Nothing"), 404, "DrinkFromMug"),
        (Request("GET", "/query"), 400, "one query"),
        (Request("GET", "/query", {"query": ("SELECT nonsense",)}), 400, "error"),
        (Request("GET", "/query", {"query": ("DELETE WHERE { ?s ?p ?o }",)}), 400, "error"),
        (Request("POST", "/query", {}, {"content-type": "text/plain"}, b"x"), 415, "sparql-query"),
        (Request("POST", "/questions"), 405, "GET"),
        (Request("GET", "/query", {"default-graph-uri": ("x",)}), 400, "FROM"),
    ],
)
def test_a_mistake_is_answered_with_a_status_and_a_remedy(place, request_, status, told) -> None:
    response = Service(place).answer(request_)
    assert response.status == status
    assert told in response.body.decode()


def test_a_query_ends_with_its_time_limit(place) -> None:
    query = "SELECT (COUNT(*) AS ?n) { ?a ?b ?c . ?d ?e ?f . ?g ?h ?i }"
    assert get(Service(place, seconds=0.6), "/query", query=query).status == 503


def test_named_questions_answer_as_the_actionary_does(place) -> None:
    listed = json.loads(get(Service(place), "/questions").body)
    assert [each["name"] for each in listed] == list(questions())
    found = json.loads(get(Service(place), "/questions/follows", action="Reach").body)
    with Actionary.open(place, read_only=True) as actionary:
        assert found == actionary.ask("follows", action="Reach")


def test_openapi_has_every_question_with_its_parameters(place) -> None:
    document = json.loads(get(Service(place), "/openapi.json").body)
    for name, asked in questions().items():
        stated = document["paths"][f"/questions/{name}"]["get"]["parameters"]
        assert {(e["name"], e["required"]) for e in stated} == {
            (each.name, each.required) for each in asked.parameters
        }


def test_writing_needs_the_token_and_right_statements(tmp_path) -> None:
    service = Service(str(tmp_path / "actionary"), TOKEN)
    Actionary.open(service.place).close()
    source = Actionary.in_memory()
    source.add(with_unknown())
    (name,) = (each.name for each in source.observations())
    text = export(source.store, "nquads", observation=name)
    wrong = text.replace(b"#firstFrame", b"#firstFrme")
    kind = "application/n-quads"
    for body, token, status in (
        (text, "", 401),
        (text, "another", 401),
        (wrong, TOKEN, 400),
        (b"nonsense", TOKEN, 400),
    ):
        assert post(service, "/statements", body, kind, token=token).status == status
        assert json.loads(get(service, "/observations").body) == []
    assert post(Service(service.place), "/statements", text, kind, token=TOKEN).status == 403
    assert post(service, "/statements", text, kind, token=TOKEN).status == 200
    assert [each["name"] for each in json.loads(get(service, "/observations").body)] == [name]
    kept = get(service, f"/observations/{name}", accept=kind)
    assert set(read(kept.body, "nquads")) == set(read(text, "nquads"))


@pytest.mark.parametrize("form", FORMATS)
def test_one_observation_exports_whole_in_every_format(place, form) -> None:
    with Actionary.open(place, read_only=True) as actionary:
        whole = set(read(export(actionary.store, "nquads", observation="DrinkFromMug"), "nquads"))
        data = export(actionary.store, form, observation="DrinkFromMug")
    assert set(read(data, form)) == whole


def test_json_ld_has_a_context_with_our_prefixes(place) -> None:
    response = get(Service(place), "/observations/DrinkFromMug", accept="application/ld+json")
    document = json.loads(response.body)
    assert document["@context"]["capar"] == "https://w3id.org/capar/ontology#"


def test_the_server_answers_on_loopback_and_to_its_own_name_alone(served: str) -> None:
    with urllib.request.urlopen(f"{served}questions/observations") as reply:
        assert json.load(reply)[0]["observation"] == "DrinkFromMug"
    with urllib.request.urlopen(served) as reply:
        assert b"/questions/segments" in reply.read()
    foreign = urllib.request.Request(f"{served}questions", headers={"Host": "evil.example"})
    with pytest.raises(urllib.error.HTTPError, match="403"):
        urllib.request.urlopen(foreign)
    head = urllib.request.Request(f"{served}openapi.json", method="HEAD")
    with urllib.request.urlopen(head) as reply:
        assert (reply.read(), int(reply.headers["Content-Length"]) > 0) == (b"", True)


def test_a_port_that_is_taken_is_told(served: str) -> None:
    port = int(served.rstrip("/").rpartition(":")[2])
    with pytest.raises(Exception, match="try another --port"):
        ActionaryServer(Service(str(Path())), port=port)
