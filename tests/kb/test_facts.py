"""Facts come back as they were measured, and refer to the bodies that they are about."""

from dataclasses import replace

import pytest
from actionaries import ACTIONS
from hypothesis import given
from hypothesis import strategies as st
from motions import PERFORMERS
from observations import drink_from_mug, pick_up_with_both_hands, with_unknown

from capar.model.facts import (
    LARGEST,
    Between,
    ClosingSpeed,
    Distance,
    Fact,
    FlickerCorrection,
    Gap,
    LookingAt,
    MovedBy,
    OfAgent,
    Place,
    RateMhz,
    Touching,
)
from capar.model.observation import Observation
from capar.pipelines.observation import observe
from kb.actionary import Actionary
from kb.encode import encode
from kb.encode.facts import in_order, stored_facts
from kb.store.validation import by_thing, violations

MADE = (drink_from_mug(), pick_up_with_both_hands(), with_unknown())


@pytest.fixture(scope="module")
def drunk() -> Observation:
    return observe(ACTIONS["DrinkFromMug"](PERFORMERS[0]).capture)


def read_back(observation: Observation) -> tuple[Fact, ...]:
    actionary = Actionary.in_memory()
    actionary.add(observation)
    return stored_facts(actionary.store, observation.capture)


def measured(observation: Observation) -> tuple[Fact, ...]:
    return in_order([each for each in observation.facts if not isinstance(each, MovedBy)])


@pytest.mark.parametrize("made", MADE, ids=lambda each: each.capture)
def test_facts_made_by_hand_come_back(made: Observation) -> None:
    assert read_back(made) == measured(made)


def test_every_fact_of_a_trial_comes_back(drunk: Observation) -> None:
    assert len({type(each) for each in drunk.facts}) > 20
    assert read_back(drunk) == measured(drunk)


FRAMES = st.integers(0, 10**6)
WHOLE = st.integers(-LARGEST, LARGEST)
BODIES = st.sampled_from(["mug", "table", "right_hand", "forehead_sensor"])
FACTS = st.one_of(
    st.builds(Touching, BODIES, BODIES, FRAMES, FRAMES),
    st.builds(Gap, BODIES, BODIES, FRAMES, WHOLE),
    st.builds(ClosingSpeed, BODIES, BODIES, FRAMES, WHOLE),
    st.builds(Between, BODIES, st.just("mug"), st.just("table"), FRAMES, FRAMES),
    st.builds(LookingAt, BODIES, BODIES, FRAMES, FRAMES),
    st.builds(FlickerCorrection, BODIES, BODIES, FRAMES, FRAMES, st.just("apart")),
    st.builds(OfAgent, BODIES, st.just(drink_from_mug().agent.name)),
)
SAMPLES = st.lists(
    st.one_of(
        st.builds(Distance, BODIES, BODIES, FRAMES, WHOLE),
        st.builds(Place, BODIES, FRAMES, WHOLE, WHOLE, WHOLE),
    ),
    unique_by=lambda each: tuple(str(each).split(",")[:3]),
)


@given(st.lists(FACTS, unique=True), SAMPLES)
def test_any_facts_come_back_exactly(stated: list[Fact], samples: list[Fact]) -> None:
    made = replace(drink_from_mug(), facts=(*in_order([*stated, *samples]),))
    quads = encode(made).quads
    actionary = Actionary.in_memory()
    actionary.store.insert(quads)
    assert stored_facts(actionary.store, made.capture) == in_order([*stated, *samples])


def test_facts_have_frames_and_seconds_and_refer_to_bodies(drunk: Observation) -> None:
    actionary = Actionary.in_memory()
    actionary.add(drunk)
    rows = actionary.query(
        """SELECT ?body ?other ?first ?start ?end WHERE {
          ?t a capar:Touching ; capar:body/capar:name ?body ; capar:other ?thing ;
            capar:firstFrame ?first ; capar:start ?start ; capar:end ?end .
          ?thing a capar:TagObject ; capar:name ?other }"""
    ).plain()
    (rate_hz,) = (fact.rate / 1000.0 for fact in drunk.facts if isinstance(fact, RateMhz))
    expected = {
        (each.body, each.other, each.first, each.first / rate_hz, each.last / rate_hz)
        for each in drunk.facts
        if isinstance(each, Touching)
    }
    assert {tuple(row.values()) for row in rows} == expected


def test_a_frame_has_the_same_seconds_in_facts_and_in_segments(drunk: Observation) -> None:
    actionary = Actionary.in_memory()
    actionary.add(drunk)
    rows = actionary.query(
        """SELECT ?frame ?time ?seconds WHERE {
          ?s a capar:Segment ; capar:firstFrame ?frame ; capar:start ?time .
          ?t a capar:Touching ; capar:firstFrame ?frame ; capar:start ?seconds }"""
    ).plain()
    times = [(row["time"], row["seconds"]) for row in rows]
    assert times
    assert all(time == seconds for time, seconds in times)


def test_no_text_packs_several_names_or_numbers_into_one(drunk: Observation) -> None:
    statements = encode(drunk)
    packed = [
        value
        for thing, said in statements.things.items()
        if "#fact." in thing.value
        for values in said.values()
        for value in values
        if " " in getattr(value, "value", "")
    ]
    assert packed == []


def test_what_is_stored_of_a_trial_is_at_most_half_of_what_schema_2_stored(
    drunk: Observation,
) -> None:
    fact_statements = sum(5 for each in drunk.facts)  # a link, a class, a name, a text, a source
    now = [
        each
        for each in encode(drunk).quads
        if any(part in str(each.subject) for part in ("#fact.", "#samples."))
    ]
    assert len(now) < 0.5 * fact_statements
    assert violations(by_thing(encode(drunk).quads)) == ()
