"""The whole Actionary goes out and comes back in every format; literals keep every number."""

from dataclasses import replace
from functools import cache
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st
from observations import drink_from_mug, pick_up_with_both_hands, with_unknown
from pyoxigraph import Quad

from capar.model.errors import FileError, UnknownNameError
from capar.model.observation import Border, Observation
from capar.model.par import FeatureSet, Nlt
from kb.actionary import Actionary
from kb.encode.observation import BORDER_KINDS
from kb.errors import ShapeError
from kb.exchange import FORMATS, bring_in, export, format_of, misplaced, read
from kb.store import names, statements
from kb.store.statements import LiteralError

pytestmark = pytest.mark.long

PREPOSITIONS = (("away from", "mug", "table"), ("on", "mug", "table"), ("up", "mug", "mug"))


def with_every_border() -> Observation:
    """One whose segments begin with everything that may happen, and say where the mug goes."""
    made = with_unknown()
    borders = tuple(Border(kind, "mug", "table") for kind in BORDER_KINDS)
    (link,) = made.links
    segments = tuple(
        replace(each, begins=borders, prepositions=PREPOSITIONS) for each in link.segments
    )
    return replace(made, capture="Borders", links=(replace(link, segments=segments),))


def full() -> Actionary:
    actionary = Actionary.in_memory()
    made = (drink_from_mug(), pick_up_with_both_hands(), with_unknown(), with_every_border())
    for each in made:
        actionary.add(each)
    actionary.add_ability("Swap", agent="ann")
    actionary.add_ability("Pour", kind="container")
    return actionary


@cache
def known() -> Actionary:
    """The same, made once, for what only reads it."""
    return full()


def said(actionary: Actionary) -> set[Quad]:
    """Everything but when and where observations were made, which does not travel."""
    return {each for each in actionary.store.quads() if each.graph_name != names.GRAPHS["runs"]}


@pytest.mark.parametrize("name", FORMATS)
def test_everything_round_trips(name: str, actionary: Actionary) -> None:
    source = known()
    assert misplaced(source.store) == 0
    bring_in(actionary.store, read(export(source.store, name), name))
    assert said(actionary) == said(source)


@pytest.mark.parametrize("name", FORMATS)
def test_an_export_is_the_same_bytes_each_time(name: str) -> None:
    assert export(full().store, name) == export(known().store, name)


@pytest.mark.parametrize("name", FORMATS)
def test_borders_and_prepositions_are_read_back_as_they_were(name: str) -> None:
    target = Actionary.in_memory()
    bring_in(target.store, read(export(known().store, name, observation="Borders"), name))
    rows = [tuple(row.values()) for row in target.ask("where")]
    assert rows == [
        ("Borders", "right_hand", index, action, *said)
        for index, action in enumerate(("Reach", "Unknown"))
        for said in PREPOSITIONS
    ]
    asked = (
        "SELECT ?kind WHERE { ?s capar:index 0 ; capar:beginsWith ?b . "
        "?b capar:index ?at ; capar:borderKind/capar:name ?kind } ORDER BY ?at"
    )
    found = [row["kind"] for row in target.query(asked).plain()]
    assert found == list(BORDER_KINDS)


def test_a_border_of_no_known_kind_is_refused_by_name() -> None:
    made = with_every_border()
    (link,) = made.links
    odd = replace(link.segments[0], ends=(Border("explodes", "mug"),))
    with pytest.raises(UnknownNameError, match=r"explodes.*begins_swinging"):
        Actionary.in_memory().add(replace(made, links=(replace(link, segments=(odd,)),)))


def test_rdflib_reads_the_turtle_as_an_isomorphic_graph() -> None:
    from rdflib import Graph
    from rdflib.compare import isomorphic

    store = known().store
    ours = Graph().parse(data=export(store, "turtle"), format="turtle")
    lines = "".join(f"{each} .\n" for each in {quad.triple for quad in said(known())})
    assert isomorphic(ours, Graph().parse(data=lines, format="nt"))


def without_objects(name: str) -> Observation:
    """One of a sensor on the chest, which touches nothing."""
    made = with_unknown()
    (link,) = made.links
    bits = FeatureSet("", "", "", "chest", "")
    segments = tuple(replace(each, objects=(), features=bits) for each in link.segments)
    return replace(made, capture=name, links=(replace(link, segments=segments),))


@pytest.mark.parametrize("name", FORMATS)
@pytest.mark.parametrize("capture", ["Chest", "Take 1.", ".", "-", "50% é/ü", "a#b?c&d"])
def test_rdflib_reads_as_many_statements_as_there_are(name: str, capture: str) -> None:
    from rdflib import Dataset

    actionary = Actionary.in_memory()
    actionary.add(without_objects(capture))
    quads = said(actionary)
    form = {"jsonld": "json-ld", "rdfxml": "xml"}.get(name, name)
    found = Dataset().parse(data=export(actionary.store, name), format=form)
    expected = {each.triple for each in quads} if name in {"turtle", "rdfxml"} else quads
    assert len(list(found.quads())) == len(expected)
    assert {str(each) for each, *_ in found.quads()} == {each.subject.value for each in quads}
    assert [each.name for each in actionary.observations()] == [capture]


@given(st.lists(st.text(st.characters(exclude_categories=["Cs"])), min_size=1, max_size=3))
def test_no_name_ends_in_a_dot_whatever_is_named(words: list[str]) -> None:
    whole = names.observation(words[0])
    made = (whole, names.part(whole, *words), names.shared("features", *words))
    assert not any(each.value.endswith((".", "/", "#")) for each in made)
    assert names.observation_name(whole) == words[0] or not words[0]


def test_an_empty_word_and_the_mark_for_it_are_two_names() -> None:
    assert names.shared("features", "", "1") != names.shared("features", "-", "1")


def test_one_observation_travels_with_all_that_it_mentions() -> None:
    target = Actionary.in_memory()
    bring_in(target.store, read(export(known().store, "trig", observation="Strange"), "trig"))
    alone = Actionary.in_memory()
    alone.add(with_unknown())
    assert said(alone) <= said(target)
    assert [each.name for each in target.observations()] == ["Strange"]


def test_unnamed_things_get_names_that_follow_from_what_is_said() -> None:
    text = b"@prefix ex: <http://ex/> . ex:a ex:b [ ex:c 1 ; ex:d [ ex:e 2 ] ] ."
    again = b"@prefix ex: <http://ex/> . _:y ex:e 2 . _:x ex:d _:y ; ex:c 1 . ex:a ex:b _:x ."
    assert set(read(text, "turtle")) == set(read(again, "turtle"))


def test_what_breaks_the_model_is_not_taken_in() -> None:
    store = full().store
    before = set(store.quads())
    text = export(store, "trig").decode().replace('capar:side "right"', 'capar:side "up"')
    with pytest.raises(ShapeError, match="right, "):
        bring_in(store, read(text.encode(), "trig"))
    assert set(store.quads()) == before


def test_a_file_that_is_not_what_it_says_is_refused(tmp_path: Path) -> None:
    with pytest.raises(FileError, match="no turtle"):
        read(b"<a> <b>", "turtle", path=tmp_path / "x.ttl")
    with pytest.raises(UnknownNameError, match="jsonld, nquads, rdfxml, trig, turtle"):
        format_of("facts.docx")
    for nameless in ("-", ".", "facts"):
        with pytest.raises(
            FileError, match=r"add --format: jsonld, nquads, rdfxml, trig or turtle"
        ):
            format_of(nameless)
    assert format_of("facts.nq") == "nquads"


finite = st.floats(allow_nan=False, allow_infinity=False)


@given(st.lists(finite))
def test_a_vector_keeps_every_bit(values: list[float]) -> None:
    assert statements.numbers(statements.vector(values).value) == tuple(values)


@given(st.tuples(finite, finite, finite), st.tuples(finite, finite, finite, finite))
def test_an_nlt_keeps_every_bit(
    place: tuple[float, float, float], turn: tuple[float, float, float, float]
) -> None:
    value = Nlt(place, turn)
    assert statements.nlt_of(statements.nlt(value).value) == value


@pytest.mark.parametrize("text", ["1 2 3", "1 2 3 1 0 0 nan", "1 2 3 1 0 0 x", "1 2 3 1 0 0 inf"])
def test_a_literal_that_is_no_nlt_is_refused(text: str) -> None:
    with pytest.raises(LiteralError):
        statements.nlt_of(text)
