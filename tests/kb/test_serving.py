"""An Actionary is asked over HTTP, and written by those alone who bear the token."""

import json
import os
import signal
import socket
import subprocess
import sys
import threading
import time
import urllib.error
import urllib.request
from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor
from contextlib import contextmanager, suppress
from dataclasses import replace
from pathlib import Path
from urllib.parse import urlencode

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from observations import drink_from_mug, with_unknown
from pyoxigraph import QueryResultsFormat, RdfFormat, parse, parse_query_results
from starlette.requests import Request
from starlette.responses import Response

from kb.actionary import Actionary
from kb.errors import QueryError, StoreError
from kb.exchange import FORMATS, export, read
from kb.queries.questions import questions
from kb.serving import ActionaryServer, Service

TOKEN = "a secret"
NAMES = "SELECT ?name { ?o a capar:Observation ; rdfs:label ?name }"
ENDLESS = "SELECT (COUNT(*) AS ?n) { ?a ?b ?c . ?d ?e ?f . ?g ?h ?i . ?j ?k ?l }"


@pytest.fixture(scope="module")
def place(tmp_path_factory: pytest.TempPathFactory) -> str:
    folder = tmp_path_factory.mktemp("served") / "actionary"
    with Actionary.open(folder) as actionary:
        actionary.add(drink_from_mug())
    return str(folder)


@pytest.fixture(scope="module")
def served(place: str) -> Iterator[str]:
    with serving(Service(place)) as address:
        yield address


@contextmanager
def serving(service: Service) -> Iterator[str]:
    with ActionaryServer(service, port=0) as server:
        thread = threading.Thread(target=server.serve_forever)
        thread.start()
        yield server.url
        server.should_exit = True
        thread.join()


def asked(method: str, path: str, given: dict[str, str] | None = None, **headers: str) -> Request:
    named = {name.replace("_", "-"): value for name, value in headers.items()}
    scope = {"type": "http", "method": method, "path": path}
    scope["query_string"] = urlencode(given or {}).encode()
    scope["headers"] = [(name.encode(), value.encode()) for name, value in named.items()]
    return Request(scope)


def get(service: Service, path: str, *, accept: str = "", **given: str) -> Response:
    return service.answer(asked("GET", path, given, accept=accept))


def post(service: Service, path: str, body: bytes, kind: str, *, token: str = "") -> Response:
    request = asked("POST", path, content_type=kind, authorization=f"Bearer {token}")
    return service.answer(request, body)


def status(url: str, query: str = "", data: bytes | None = None, **headers: str) -> int:
    """The status of a response; one of 503 says when to ask again."""
    named = {name.replace("_", "-"): value for name, value in headers.items()}
    full = f"{url}query?{urlencode({'query': query})}" if query else url
    try:
        with urllib.request.urlopen(urllib.request.Request(full, data, named)) as reply:
            return reply.status
    except urllib.error.HTTPError as error:
        assert error.code != 503 or int(error.headers["Retry-After"]) > 0
        return error.code


@pytest.mark.parametrize(
    ("method", "kind", "body"),
    [
        ("GET", "", b""),
        ("POST", "application/sparql-query", NAMES.encode()),
        ("POST", "application/x-www-form-urlencoded", f"query={NAMES.replace(' ', '+')}".encode()),
    ],
)
def test_a_query_is_asked_in_the_three_ways_of_the_protocol(place, method, kind, body) -> None:
    given = {"query": NAMES} if method == "GET" else {}
    response = Service(place).answer(asked(method, "/query", given, content_type=kind), body)
    assert response.status_code == 200
    assert response.headers["content-type"] == "application/sparql-results+json"
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
        if (response := get(Service(place), "/query", accept=kind, query=query)).status_code == 200
    }
    assert len(found) == 1
    assert get(Service(place), "/query", accept="image/png", query=query).status_code == 406


@pytest.mark.parametrize(
    ("request_", "status", "told"),
    [
        (asked("GET", "/nowhere"), 404, "/questions"),
        (asked("GET", "/questions/segmets"), 404, "Did you mean 'segments'?"),
        (asked("GET", "/questions/world"), 400, "must be given"),
        (asked("GET", "/questions/segments", {"ee": "tail"}), 404, "right_hand"),
        (asked("GET", "/observations/Nothing"), 404, "DrinkFromMug"),
        (asked("GET", "/query"), 400, "one query"),
        (asked("GET", "/query", {"query": "SELECT nonsense"}), 400, "error"),
        (asked("GET", "/query", {"query": "DELETE WHERE { ?s ?p ?o }"}), 400, "error"),
        (asked("POST", "/query", content_type="text/plain"), 415, "sparql-query"),
        (asked("POST", "/questions"), 405, "GET"),
        (asked("GET", "/query", {"default-graph-uri": "x"}), 400, "FROM"),
    ],
)
def test_a_mistake_is_answered_with_a_status_and_a_remedy(place, request_, status, told) -> None:
    response = Service(place).answer(request_)
    assert response.status_code == status
    assert told in response.body.decode()


def test_a_query_ends_with_its_time_limit_and_the_server_goes_on(place) -> None:
    with serving(Service(place, seconds=0.6)) as url:
        assert status(url, ENDLESS) == 503
        assert status(url, NAMES) == 200


def test_a_time_limit_is_a_number_of_seconds(place) -> None:
    with pytest.raises(QueryError, match="no time limit"):
        Service(place, seconds=float("inf"))


def test_look_ups_are_answered_beside_endless_queries(place) -> None:
    with serving(Service(place, seconds=20.0)) as url, ThreadPoolExecutor(32) as clients:
        endless = [clients.submit(status, url, f"{ENDLESS} # {n}") for n in range(8)]
        found = [clients.submit(status, url, f"{NAMES} # {n}") for n in range(24)]
        assert {each.result() for each in found} == {200}
        ended = [each.result() for each in endless if each.done()]
        assert len(ended) < len(endless) and set(ended) <= {503}


def test_only_the_query_whose_process_is_killed_is_not_answered(place) -> None:
    others = set(descendants(os.getpid()))  # What tests before this one have left running.
    with serving(Service(place)) as url, ThreadPoolExecutor(2) as clients:
        before = {pid: spent_ticks(pid) for pid in {*descendants(os.getpid())} - others}
        endless = clients.submit(status, url, ENDLESS)
        for pid in busy(before, url):
            os.kill(pid, signal.SIGKILL)
        assert endless.result() == 503
        assert status(url, NAMES) == 200


@pytest.mark.parametrize("how", [signal.SIGINT, signal.SIGTERM, signal.SIGKILL])
def test_nothing_is_left_of_a_server_however_it_ends(place, how) -> None:
    command = "from capar.cli import main; main()"
    served = [sys.executable, "-c", command, "serve", "--port", "0", "--actionary", place]
    with subprocess.Popen(served, stderr=subprocess.PIPE, text=True) as running:
        assert running.stderr is not None
        url = running.stderr.readline().rpartition(" ")[2].strip()
        with ThreadPoolExecutor(1) as client:
            client.submit(status, url, ENDLESS)
            assert status(url, NAMES) == 200
            others = descendants(running.pid)
            running.send_signal(how)
            running.wait()
    assert others
    deadline = time.monotonic() + 30.0
    while left := [pid for pid in others if Path(f"/proc/{pid}").exists()]:
        assert time.monotonic() < deadline, left


def descendants(root: int) -> list[int]:
    """The processes that a process and those have started."""
    found = [root]
    for pid in found:
        for children in Path(f"/proc/{pid}/task").glob("*/children"):
            with suppress(OSError):  # A thread that has ended since it was listed.
                found += map(int, children.read_text().split())
    return found[1:]


def spent_ticks(pid: int) -> int:
    """The processor time of a process."""
    try:
        fields = Path(f"/proc/{pid}/stat").read_text().rpartition(")")[2].split()
    except OSError:
        return 0
    return int(fields[11]) + int(fields[12])


def busy(before: dict[int, int], url: str) -> set[int]:
    """The processes that work for two seconds on one query, while others answer look-ups."""
    while not (found := {pid for pid in before if spent_ticks(pid) - before[pid] > 200}):
        assert status(url, NAMES) == 200
        time.sleep(0.1)
    return found


def test_what_others_write_is_seen_at_once(tmp_path) -> None:
    with Actionary.open(tmp_path / "actionary") as writer:
        writer.add(drink_from_mug())
        with serving(Service(writer.store.place)) as url:
            for count in range(1, 5):
                with urllib.request.urlopen(f"{url}observations") as reply:
                    assert len(json.load(reply)) == count
                writer.add(replace(drink_from_mug(), capture=f"again_{count}"))


def test_who_writes_at_once_writes_one_after_the_other(tmp_path) -> None:
    place = str(tmp_path / "actionary")
    Actionary.open(place).close()
    source = Actionary.in_memory()
    source.add(drink_from_mug())
    text = export(source.store, "nquads", observation="DrinkFromMug")
    bodies = [text.replace(b"DrinkFromMug", f"Drink{n}".encode()) for n in range(4)]
    headers = {"Content_Type": "application/n-quads", "Authorization": f"Bearer {TOKEN}"}
    with serving(Service(place, TOKEN)) as url, ThreadPoolExecutor(4) as clients:
        written = [clients.submit(status, f"{url}statements", "", b, **headers) for b in bodies]
        assert {each.result() for each in written} == {200}
    with Actionary.open(place, read_only=True) as actionary:
        assert len(actionary.observations()) == 4


def test_processes_that_are_all_killed_are_replaced(place) -> None:
    others = set(descendants(os.getpid()))
    with serving(Service(place)) as url:
        assert status(url, NAMES) == 200
        for pid in {*descendants(os.getpid())} - others:
            os.kill(pid, signal.SIGKILL)
        assert {status(url, NAMES) for _ in range(3)} <= {200, 503}
        deadline = time.monotonic() + 30.0
        while status(url, NAMES) != 200:
            assert time.monotonic() < deadline


def test_a_query_whose_client_is_gone_is_ended(place) -> None:
    others = set(descendants(os.getpid()))
    with serving(Service(place)) as url:
        host, _, port = url.removeprefix("http://").rstrip("/").partition(":")
        before = {pid: spent_ticks(pid) for pid in {*descendants(os.getpid())} - others}
        with socket.create_connection((host, int(port))) as client:
            client.sendall(f"GET /query?{urlencode({'query': ENDLESS})} HTTP/1.1\r\n".encode())
            client.sendall(f"Host: {host}\r\n\r\n".encode())
            working = busy(before, url)
        deadline = time.monotonic() + 20.0
        while working & set(descendants(os.getpid())):
            assert time.monotonic() < deadline
        assert status(url, NAMES) == 200


ASKED_FOR = st.text(max_size=12) | st.sampled_from(["Reach", "mug", "2.5", "-1", "\0", '"', ">"])


@given(
    st.sampled_from(["GET", "POST", "PUT"]),
    st.sampled_from([f"questions/{name}" for name in questions()]) | st.text(max_size=12),
    st.dictionaries(st.sampled_from(["action", "capture", "time", "query", "ee"]), ASKED_FOR),
    st.binary(max_size=40),
    st.sampled_from(["application/sparql-query", "application/x-www-form-urlencoded", ""]),
    st.text(st.characters(codec="latin-1"), max_size=20) | st.just("text/csv;q=0.1, */*;q=x"),
)
@settings(suppress_health_check=[HealthCheck.function_scoped_fixture], deadline=None)
def test_whatever_is_asked_is_answered(place, method, path, given_, body, kind, accept) -> None:
    request = asked(method, f"/{path}", given_)
    request.scope["headers"] = [
        (b"content-type", kind.encode()),
        (b"accept", accept.encode("latin-1")),
    ]
    response = Service(place).answer(request, body)
    assert response.status_code in {200, 400, 403, 404, 405, 406, 415}


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
        assert post(service, "/statements", body, kind, token=token).status_code == status
        assert json.loads(get(service, "/observations").body) == []
    assert post(Service(service.place), "/statements", text, kind, token=TOKEN).status_code == 403
    assert post(service, "/statements", text, kind, token=TOKEN).status_code == 200
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
    for stranger in (
        {"Host": "evil.example"},
        {"Origin": "https://evil.example"},
        {"Origin": "null"},
    ):
        foreign = urllib.request.Request(f"{served}questions", headers=stranger)
        with pytest.raises(urllib.error.HTTPError, match="403"):
            urllib.request.urlopen(foreign)
    own = urllib.request.Request(f"{served}questions", headers={"Origin": served.rstrip("/")})
    with urllib.request.urlopen(own) as reply:
        assert reply.status == 200
    head = urllib.request.Request(f"{served}openapi.json", method="HEAD")
    with urllib.request.urlopen(head) as reply:
        assert (reply.read(), int(reply.headers["Content-Length"]) > 0) == (b"", True)


def test_a_port_that_is_taken_is_told(served: str) -> None:
    port = int(served.rstrip("/").rpartition(":")[2])
    with pytest.raises(Exception, match="try another --port"):
        ActionaryServer(Service(str(Path())), port=port)


def test_an_observation_cannot_be_added_by_updates_which_the_server_does_not_take(
    served: str,
) -> None:
    with Actionary.open(served) as actionary:
        assert [each.name for each in actionary.observations()] == ["DrinkFromMug"]
        with pytest.raises(StoreError, match=r"takes no SPARQL updates.*folder, or to a server"):
            actionary.add(with_unknown())
