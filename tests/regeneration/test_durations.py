"""Steps of several hands keep their relations of Allen's in whatever time an action is done."""

from functools import cache

import pytest
from hypothesis import Phase as Search
from hypothesis import given, settings
from hypothesis import strategies as st

from capar.body.anthropometry import ready_made
from capar.body.human import Human
from capar.body.performing import perform
from capar.body.recording import record
from capar.body.scripted_actions import action_capture, action_scene
from capar.body.scripts import STAND, Hand, Move, Phase, Script
from capar.body.sensors import PERFECT
from capar.model.facts import Touching
from capar.model.observation import Observation
from capar.pipelines.observation import observe
from capar.pipelines.round_trips import observed_source
from capar.regeneration import Source, regenerate
from capar.regeneration.captures import capture_of
from capar.regeneration.styles import paced
from capar_rules.pars.pars import allen

RATE_HZ = 30.0
HOLDS, REACHES = Hand("holds", "crate"), Hand("reaches", "crate")
BOTH = {"left": HOLDS, "right": HOLDS}
ONE_AFTER_THE_OTHER: Script = (
    STAND,
    Phase("the left one reaches", 1.1, {"left": REACHES}, look="crate"),
    Phase("the right one reaches", 1.1, {"left": HOLDS, "right": REACHES}, look="crate"),
    Phase("grasp", 0.4, BOTH, look="crate"),
    Phase("lift", 1.0, BOTH, {"crate": Move((0.0, 0.0, 0.2))}, look="crate"),
    Phase("hold", 0.5, BOTH, look="crate"),
    Phase("lower", 1.0, BOTH, {"crate": Move(home=True)}, look="crate"),
    Phase("release", 0.4, BOTH, look="crate"),
    Phase("the right one leaves", 1.0, {"left": HOLDS}, look="crate"),
    Phase("the left one leaves", 1.0, look="ahead"),
    Phase("stand", 0.6, look="ahead"),
)


@cache
def _at_once() -> Source:
    return observed_source(action_capture("pick_up", rate_hz=RATE_HZ))


@cache
def _in_turn() -> Source:
    human = Human.of(ready_made("man"))
    scene = action_scene(human, "pick_up")
    made = perform(human, scene, ONE_AFTER_THE_OTHER, rate_hz=RATE_HZ)
    return observed_source(record(made, name="in_turn", seed=0, tracker=PERFECT))


def _again(source: Source, factor: float) -> Observation:
    motion, found = regenerate(paced(source, factor * float(source.times[-1])), source.human)
    assert found.passed, found.failed
    return observe(capture_of(motion, name=source.capture.name, agent="man"))


def _contacts(seen: Observation) -> list[tuple[str, str, str]]:
    """Relations between the contacts of two hands with the crate."""
    own = [f for f in seen.facts if isinstance(f, Touching) and f.other == "crate"]
    hands = sorted((f for f in own if f.body.endswith("_hand")), key=lambda f: (f.body, f.first))
    return [
        (one.body, allen(one.first, one.last, two.first, two.last), two.body)
        for one in hands
        for two in hands
        if one.body < two.body
    ]


@pytest.mark.long
@settings(max_examples=3, derandomize=True, deadline=None, database=None, phases=[Search.generate])
@given(factor=st.floats(0.5, 3.0))
def test_hands_that_act_at_once_do_so_in_any_time(factor: float) -> None:
    source = _at_once()
    again = _again(source, factor)
    assert again.complex_par.signature == source.observation.complex_par.signature
    assert again.complex_par.relations == source.observation.complex_par.relations
    assert _contacts(again) == _contacts(source.observation)


@pytest.mark.long
@settings(max_examples=3, derandomize=True, deadline=None, database=None, phases=[Search.generate])
@given(factor=st.floats(0.75, 3.0))
def test_hands_that_join_and_leave_in_turn_overlap_alike_in_any_time(factor: float) -> None:
    source = _in_turn()
    relations = {one.relation for one in source.observation.complex_par.relations}
    assert {"overlaps", "starts", "equals", "meets"} <= relations
    again = _again(source, factor)
    assert again.complex_par.signature == source.observation.complex_par.signature
    assert again.complex_par.relations == source.observation.complex_par.relations
    assert _contacts(again) == _contacts(source.observation)


@pytest.mark.long
def test_in_half_the_time_contacts_overlap_alike_though_the_ends_may_be_one_step() -> None:
    source = _in_turn()
    assert _contacts(_again(source, 0.5)) == _contacts(source.observation)
