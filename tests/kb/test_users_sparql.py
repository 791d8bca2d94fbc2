"""A query that a user types cannot write, run for ever or reach the network."""

import math
import time
from collections.abc import Callable

import pytest
from hypothesis import given
from hypothesis import strategies as st
from observations import drink_from_mug
from pyoxigraph import NamedNode

from kb.actionary import Actionary
from kb.errors import QueryError, StoreError, TimeLimitError
from kb.store import sparql
from kb.store.answer_values import Answer

ENDLESS = "SELECT (COUNT(*) AS ?n) WHERE { ?a ?b ?c . ?d ?e ?f . ?g ?h ?i . ?j ?k ?l }"


def test_known_prefixes_need_no_declaration(actionary: Actionary) -> None:
    actionary.add(drink_from_mug())
    answer = actionary.query("SELECT ?s WHERE { ?s a capar:Segment }")
    assert len(answer.rows) == 6
    assert actionary.query("ASK { ?s a capar:Segment }").boolean is True
    built = actionary.query("CONSTRUCT { ?s a capar:Segment } WHERE { ?s a capar:Segment }")
    assert len(built.triples or ()) == 6


def test_functions_open_compact_literals_in_every_store(actionary: Actionary) -> None:
    actionary.add(drink_from_mug())
    answer = actionary.query(
        "SELECT DISTINCT (capar:element(?n, 1) AS ?y) (capar:elements(?n) AS ?count) "
        "(capar:element(?n, 7) AS ?none) WHERE { ?l capar:goalNlt ?n }"
    )
    assert list(answer.plain()) == [{"y": -0.5, "count": 7, "none": None}]


@given(
    st.lists(st.floats(-1e6, 1e6), min_size=1, max_size=9),
    st.integers(0, 9),
)
def test_an_element_is_the_number_at_its_index(values: list[float], index: int) -> None:
    text = " ".join(map(repr, values))
    query = sparql.complete(f'SELECT (capar:element("{text}", {index}) AS ?x) WHERE {{}}')
    (row,) = STORE.store.ask(query).plain()
    expected = values[index] if index < len(values) else None
    assert row["x"] == expected


STORE = Actionary.in_memory()


def test_a_query_is_stopped_in_time(burdened: Actionary) -> None:
    begun = time.monotonic()
    with pytest.raises(TimeLimitError, match=r"stopped after 0\.5 s"):
        burdened.query(ENDLESS, seconds=0.5)
    assert time.monotonic() - begun < 5.0


@pytest.mark.parametrize(
    "text",
    [
        "DELETE WHERE { ?s ?p ?o }",
        "INSERT DATA { <a:a> <a:b> <a:c> }",
        "PREFIX a: <b:c> CLEAR ALL",
        "LOAD <http://127.0.0.1/x>",
        "# SELECT\nDROP ALL",
        "DROP ALL",
    ],
)
def test_a_query_cannot_write(text: str, actionary: Actionary) -> None:
    before = set(actionary.store.quads())
    with pytest.raises(QueryError, match="may not write"):
        actionary.query(text)
    assert set(actionary.store.quads()) == before


@pytest.mark.parametrize(
    "text",
    [
        "SELECT * WHERE { SERVICE <http://127.0.0.1:9/> { ?s ?p ?o } }",
        "SELECT * WHERE { service silent <http://127.0.0.1:9/> { ?s ?p ?o } }",
        'SELECT * WHERE { BIND("}" AS ?x)SERVICE<http://127.0.0.1:9/>{ ?s ?p ?o } }',
        "SELECT * WHERE { \\u0053ERVICE <http://127.0.0.1:9/> { ?s ?p ?o } }",
        "SELECT * WHERE { ?s ?p ?o FILTER(?s<?o)SERVICE ?x { ?a ?b ?c } FILTER(?o>?s) }",
    ],
)
def test_a_query_cannot_call_out(text: str) -> None:
    with pytest.raises(QueryError, match="SERVICE"):
        sparql.prepare(text)


@pytest.mark.parametrize(
    "text",
    [
        'SELECT ("SERVICE DELETE" AS ?service) WHERE {} # SERVICE',
        "SELECT * WHERE { ?service <http://ex/SERVICE> 'SERVICE' }",
        "PREFIX service: <a:> SELECT * WHERE { ?s service:SERVICE '''a ' SERVICE''' }",
    ],
)
def test_the_word_may_stand_where_it_calls_nothing(text: str) -> None:
    assert sparql.prepare(text).endswith(text)


OBSERVED = "https://w3id.org/capar/data/observation/DrinkFromMug"
COUNTED = "SELECT (COUNT(*) AS ?n) {} WHERE {{ {} }}"
EVERY, GRAPHS = "?s ?p ?o", "GRAPH ?g { ?s ?p ?o }"


@pytest.mark.parametrize("ask", [Actionary.query, lambda made, text: made.store.ask(text)])
def test_a_query_is_asked_of_the_graphs_that_it_names(
    ask: Callable[[Actionary, str], Answer], actionary: Actionary
) -> None:
    actionary.add(drink_from_mug())
    own = len(actionary.store.graph(NamedNode(OBSERVED)))
    everything = len({each.triple for each in actionary.store.quads()})
    assert 0 < own < everything
    cases = {
        ("", EVERY): everything,
        ("FROM <urn:none>", EVERY): 0,
        (f"from <{OBSERVED}>", EVERY): own,
        (f"FROM <{OBSERVED}> FROM <urn:none>", EVERY): own,
        (f"FROM NAMED <{OBSERVED}>", EVERY): 0,
        (f"FROM NAMED <{OBSERVED}>", GRAPHS): own,
        (f"FROM <{OBSERVED}>", GRAPHS): 0,
    }
    found = {key: ask(actionary, COUNTED.format(*key)) for key in cases}
    assert {key: next(each.plain())["n"] for key, each in found.items()} == cases


@pytest.mark.parametrize(
    "text",
    [
        "SELECT (COUNT(?from) AS ?n) WHERE { ?from a capar:Segment } # FROM <urn:none>",
        "SELECT (COUNT(*) AS ?n) WHERE { ?s a capar:Segment FILTER('FROM' != \"\"@from) }",
        "PREFIX from: <a:> SELECT (COUNT(*) AS ?n) { ?s a capar:Segment MINUS { ?s a from:from } }",
    ],
)
def test_the_word_from_may_stand_where_it_names_no_graph(text: str) -> None:
    made = Actionary.in_memory()
    made.add(drink_from_mug())
    assert list(made.query(text).plain()) == [{"n": 6}]


def test_a_server_that_does_not_heed_from_is_not_believed(union_server: str) -> None:
    with Actionary.open(union_server) as made:
        made.add(drink_from_mug())
        assert made.query("ASK { ?s a capar:Segment }").boolean is True
        with pytest.raises(StoreError, match=r"FROM.*GRAPH <\.\.\.>"):
            made.query("ASK FROM <urn:none> { ?s ?p ?o }")


@pytest.mark.parametrize("seconds", [math.nan, math.inf, -math.inf, -1.0, 0.0])
def test_a_time_limit_is_a_positive_number(seconds: float) -> None:
    with pytest.raises(QueryError, match="a positive number of seconds"):
        STORE.query("ASK {}", seconds=seconds)


def test_a_slip_in_a_functions_name_is_told_which_there_are(actionary: Actionary) -> None:
    actionary.add(drink_from_mug())
    with pytest.raises(QueryError) as slip:
        actionary.query("SELECT (capar:elemnt(?n, 1) AS ?y) WHERE { ?l capar:goalNlt ?n }")
    assert "no function 'capar:elemnt'" in str(slip.value)
    assert "there are: capar:distance, capar:element, capar:elements, " in str(slip.value)
    assert "Did you mean 'capar:element'?" in str(slip.value)
    with pytest.raises(QueryError, match="no function 'urn:none'; there are: capar:distance, "):
        actionary.query("CONSTRUCT { ?s ?p ?x } WHERE { ?s ?p ?o BIND(<urn:none>(?o) AS ?x) }")


@given(st.text(max_size=60))
def test_pieces_of_any_text_join_to_the_text(text: str) -> None:
    assert "".join(each.text for each in sparql.tokens(text)) == text
