"""Facts come back as they were measured, and contacts and forces say more of objects."""

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
    Moving,
    OfAgent,
    Place,
    RateMhz,
    Touching,
)
from capar.model.observation import ForceStyle, Observation
from capar.pipelines.observation import observe
from kb.actionary import Actionary
from kb.encode.observation import encode, held_contacts, in_order, stored_facts
from ontology import CAPAR

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


times = st.lists(st.integers(0, 200), min_size=2, max_size=12, unique=True).map(sorted)


def test_only_contacts_of_end_effectors_tell_how_long_the_thing_is_held() -> None:
    for seen in (drink_from_mug(), pick_up_with_both_hands()):
        effectors = {link.ee for link in seen.links}
        contacts = [each for each in seen.facts if isinstance(each, Touching)]
        told = held_contacts(seen, 100.0)
        assert set(told) == {each for each in contacts if each.body in effectors}
        for contact, of in told.items():
            lasts = (contact.last - contact.first) / 100.0
            assert 0.0 <= float(str(of[CAPAR.heldFor])) <= lasts + 1e-9
            moves = any(
                isinstance(each, Moving)
                and each.object == contact.other
                and each.first < contact.last
                and contact.first < each.last
                for each in seen.facts
            )
            assert (float(str(of[CAPAR.movedFor])) > 0.0) == moves


def test_what_is_held_is_told_by_contact_and_in_all() -> None:
    actionary = Actionary.in_memory()
    actionary.add(drink_from_mug())
    (row,) = actionary.ask("held")
    query = "SELECT (SUM(?held) AS ?all) { ?contact capar:heldFor ?held }"
    ((held,),) = (each.values() for each in actionary.query(query).plain())
    assert row["ee"] == "right_hand"
    assert 0.0 < float(str(row["held"])) == float(str(held)) <= float(str(row["touched"]))


FORCE = ForceStyle(
    object="mug",
    ee="right_hand",
    start_s=1.6,
    end_s=2.5,
    struck=True,
    position_m=(0.4, 0.0, 0.8),
    velocity_mps=(0.0, 1.2, 0.0),
    striker_mps=(0.0, 1.25, 0.0),
    follow_mps=(0.0, 0.575, 0.0),
    restitution=0.5,
    damping_per_s=(3.0, 2.5),
    thesis_damping=(0.1, 0.25),
    bounce=None,
    impulse_ns=None,
    residual_m=0.001,
)


def test_the_thesis_profile_keeps_the_thesis_damping(actionary: Actionary) -> None:
    actionary.add(replace(drink_from_mug(), profile="thesis", forces=(FORCE,)))
    assert actionary.object_profile("mug")["state: damping"] == ("0.1 0.25 0",)


def test_what_was_let_go_keeps_how_it_bounces(actionary: Actionary) -> None:
    tossed = replace(FORCE, struck=False, restitution=None, bounce=0.3, damping_per_s=None)
    actionary.add(replace(drink_from_mug(), profile="extended", forces=(tossed,)))
    shown = actionary.object_profile("mug")
    assert shown["state: restitution"] == ("0.3",)
    assert shown["state: damping"] == ()
