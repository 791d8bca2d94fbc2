"""Whoever drinks, from whatever table, is observed to do the same (thesis 5.2)."""

from functools import cache

import pytest
from virtual_bodies.drinking import drinking, steps_of

from capar.body.scripted_actions import action_capture
from capar.model.capture import Capture
from capar.pipelines.observation import observe

STEPS = {
    "extended": (
        "Reach(mug)", "Touch(mug)", "MoveObjTo(mug, head)", "TouchWith(mug, head)",
        "MoveObjTo(mug, table)", "TouchWith(mug, table)", "ResumePosture(mug)",
    ),
    "thesis": (
        "Reach(mug)", "TouchWith(mug, table)", "MoveObjTo(mug, head)", "TouchWith(mug, head)",
        "MoveObjTo(mug, table)", "TouchWith(mug, table)", "ResumePosture(mug)",
    ),
}  # fmt: skip
"""What the script asks for: it holds the mug for 0.3 s before it is raised, and at the mouth.

A support that bears the mug since before it was taken is no subordinate in ``extended`` alone.
"""


SIPS = {
    "extended": (
        "Reach(mug)", "MoveObjTo(mug, head)", "Drink(mug, head)", "MoveObjTo(mug, table)",
        "TouchWith(mug, table)", "ResumePosture(mug)",
    ),
    "thesis": (
        "Reach(mug)", "MoveObjTo(mug, head)", "MoveObj(mug, head)", "MoveObjTo(mug, table)",
        "TouchWith(mug, table)", "ResumePosture(mug)",
    ),
}  # fmt: skip
"""The published steps (thesis 5.2.1); Drink is a MoveObj."""

SLOW_CLOCK = pytest.mark.xfail(
    strict=True,
    reason="at 30 Hz a child's hold of the mug lies 0.13 s between crossings; steps take 0.15 s",
)
TRIALS = [
    pytest.param("woman", 1, 30.0, "extended"),
    pytest.param("woman", 1, 30.0, "thesis"),
    pytest.param("child", 3, 30.0, "extended"),
    pytest.param("child", 3, 30.0, "thesis", marks=SLOW_CLOCK),
    pytest.param("child", 3, 60.0, "thesis"),
]
"""All fifteen at 60 Hz, with and without noise: ``benchmarks/drinking.py``."""


@cache
def trial(who: str, number: int, rate_hz: float) -> Capture:
    return drinking(who, number, rate_hz=rate_hz)


@pytest.mark.parametrize(("who", "number", "rate_hz", "profile"), TRIALS)
def test_a_drink_is_the_same_for_bodies_and_tables_of_any_size(
    who: str, number: int, rate_hz: float, profile: str
) -> None:
    assert steps_of(observe(trial(who, number, rate_hz), rules=profile)) == STEPS[profile]


@pytest.mark.parametrize("who", ["man", "woman", "child"])
@pytest.mark.parametrize("noisy", [False, True])
@pytest.mark.parametrize("profile", ["extended", "thesis"])
def test_a_sip_is_the_published_six_steps(who: str, profile: str, *, noisy: bool) -> None:
    capture = action_capture("sip", who, rate_hz=103.3, noisy=noisy)
    assert steps_of(observe(capture, rules=profile)) == SIPS[profile]
