"""A query that a user types cannot write, run for ever or reach the network."""

import time

import pytest
from hypothesis import given
from hypothesis import strategies as st
from observations import drink_from_mug

from kb import sparql
from kb.actionary import Actionary
from kb.errors import QueryError, TimeLimitError

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


def test_a_query_is_stopped_in_time(actionary: Actionary) -> None:
    begun = time.monotonic()
    with pytest.raises(TimeLimitError, match=r"stopped after 0\.5 s"):
        actionary.query(ENDLESS, seconds=0.5)
    assert time.monotonic() - begun < 5.0


@pytest.mark.parametrize(
    "text",
    [
        "DELETE WHERE { ?s ?p ?o }",
        "INSERT DATA { <a:a> <a:b> <a:c> }",
        "PREFIX a: <b:c> CLEAR ALL",
        "LOAD <http://127.0.0.1/x>",
        "# SELECT\nDROP ALL",
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


def test_a_query_that_is_none_says_where(actionary: Actionary) -> None:
    with pytest.raises(QueryError, match="1:"):
        actionary.query("SELECT ?x WHERE {")


@given(st.text(max_size=60))
def test_pieces_of_any_text_join_to_the_text(text: str) -> None:
    assert "".join(each.text for each in sparql.tokens(text)) == text
