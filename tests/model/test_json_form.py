"""JSON holds all of an observation, and bad JSON is refused with its place."""

import json
from dataclasses import replace

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from jsonschema import Draft202012Validator
from observations import drink_from_mug, pick_up_with_both_hands, with_unknown

from capar.model.capture import Agent
from capar.model.errors import ParError
from capar.model.json_form import (
    KINDS,
    document,
    from_json,
    published_schema,
    schema,
    schema_text,
    to_json,
    value_from_json,
)
from capar.model.observation import Observation
from capar.model.par import ComplexPar, Condition, FeatureSet, Ipar, LinkSteps, Relation, Step, Upar

OBSERVATIONS = [drink_from_mug(), pick_up_with_both_hands(), with_unknown()]
numbers = st.floats(allow_nan=False, allow_infinity=False)
words = st.text(max_size=12)


@pytest.mark.parametrize("seen", OBSERVATIONS, ids=lambda each: each.capture)
def test_an_observation_comes_back_whole(seen: Observation) -> None:
    assert from_json(to_json(seen)) == seen


@pytest.mark.parametrize("seen", OBSERVATIONS, ids=lambda each: each.capture)
def test_what_is_written_obeys_the_published_schema(seen: Observation) -> None:
    published = json.loads(published_schema("observation"))
    Draft202012Validator(published).validate(json.loads(to_json(seen)))


@pytest.mark.parametrize("name", KINDS)
def test_the_published_schema_is_the_one_of_the_types(name: str) -> None:
    Draft202012Validator.check_schema(schema(name))
    assert published_schema(name) == schema_text(name)


def test_each_par_comes_back_alone_and_obeys_its_schema() -> None:
    seen = drink_from_mug()
    for name, kind, par in (
        ("upar", Upar, seen.upars[0]),
        ("ipar", Ipar, seen.ipars[1]),
        ("complex_par", ComplexPar, seen.complex_par),
    ):
        Draft202012Validator(schema(name)).validate(document(par))
        assert value_from_json(to_json(par), kind) == par  # type: ignore[type-var]


def _steps(ee: str) -> st.SearchStrategy[Step]:
    return st.builds(
        Step,
        action=words,
        ee=st.just(ee),
        objects=st.lists(words).map(tuple),
        share=numbers,
        purpose=words,
        begin=numbers,
        segments=st.lists(st.integers(0, 99)).map(tuple),
        posture=words,
    )


places = st.tuples(words, st.integers(0, 99))
complex_pars = st.builds(
    ComplexPar,
    name=words,
    objects=st.lists(words).map(tuple),
    duration_s=numbers,
    links=st.lists(
        st.builds(LinkSteps, ee=words, steps=st.lists(_steps("hand"), max_size=3).map(tuple)),
        max_size=3,
    ).map(tuple),
    common=st.none() | _steps("all"),
    relations=st.lists(st.builds(Relation, places, words, places), max_size=3).map(tuple),
)


@settings(max_examples=60, deadline=None, suppress_health_check=[HealthCheck.too_slow])
@given(complex_pars)
def test_every_complex_par_comes_back_to_the_last_bit(par: ComplexPar) -> None:
    text = to_json(par)
    assert value_from_json(text, ComplexPar) == par
    assert to_json(value_from_json(text, ComplexPar)) == text


@settings(max_examples=30, deadline=None)
@given(st.dictionaries(words, numbers, max_size=5), words)
def test_measures_come_back_whatever_they_are_called(measures: dict[str, float], name: str) -> None:
    seen = replace(drink_from_mug(), agent=Agent(name, "person", measures))
    assert from_json(to_json(seen)) == seen


def test_the_order_of_measures_does_not_change_a_byte() -> None:
    one = replace(drink_from_mug(), agent=Agent("a", "person", {"x": 1.0, "y": 2.0}))
    other = replace(drink_from_mug(), agent=Agent("a", "person", {"y": 2.0, "x": 1.0}))
    assert to_json(one) == to_json(other)


def test_facts_are_written_as_atoms() -> None:
    assert "touching(right_hand,mug,178,330)" in document(drink_from_mug())["facts"]


def _broken(place: str, value: object) -> str:
    """A good document with another value at one place; an ellipsis takes the key away."""
    content = json.loads(to_json(drink_from_mug()))
    *way, last = [int(each) if each.isdigit() else each for each in place.split(".")]
    inner = content
    for each in way:
        inner = inner[each]
    if value is ...:
        del inner[last]
    else:
        inner[last] = value
    return json.dumps(content)


@pytest.mark.parametrize(
    ("place", "value", "says"),
    [
        ("capture", ..., "a.json: capture: expected a value, found none"),
        ("colour", "red", "a.json: colour: no such field"),
        ("links.0.segments.2.first", "1", "links.0.segments.2.first: expected a valid integer"),
        ("links.0.segments.2.possessed", 1, "links.0.segments.2.possessed: expected"),
        ("upars.0.core.motion", "dance", "upars.0.core.motion: expected 'none'"),
        ("ipars.0.core.constraint.features.force", "11", "ipars.0.core.constraint.features: "),
        ("facts.3", "touching(a", "facts.3: expected an atom"),
        ("facts.3", "dances(agent)", "facts.3: 'dances(agent)' is no measured fact"),
        ("facts.3", "tag(mug)", "facts.3: tag(mug) is no tag/2"),
        ("facts", 3, "facts: expected a list of atoms, found 3"),
    ],
)
def test_bad_json_is_refused_with_its_place(place: str, value: object, says: str) -> None:
    with pytest.raises(ParError) as raised:
        from_json(_broken(place, value), where="a.json")
    assert says in str(raised.value)
    assert str(raised.value).startswith("a.json: ")


@pytest.mark.parametrize("text", ["", "{", "[]", "3", "null", "[" * 100_000])
def test_what_is_no_document_is_refused(text: str) -> None:
    with pytest.raises(ParError):
        from_json(text)


def test_a_number_that_json_lacks_is_refused_with_its_place() -> None:
    seen = replace(drink_from_mug(), rate_hz=float("nan"))
    with pytest.raises(ParError, match=r"Observation\.rate_hz: nan"):
        to_json(seen)


@given(st.text("01", max_size=7), st.text("01", max_size=7))
def test_feature_strings_of_wrong_lengths_never_make_a_feature_set(start: str, end: str) -> None:
    if len(start) == len(end) == 3:
        assert FeatureSet(start, end, "00", "hand", "00").count == 2
    else:
        with pytest.raises(ParError):
            FeatureSet(start, end, "00", "hand", "00")


def test_a_condition_that_does_not_hold_is_another_one() -> None:
    assert Condition("contact", ("EE", "obj1")) != Condition("contact", ("EE", "obj1"), False)
