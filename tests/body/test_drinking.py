"""Whoever drinks, from whatever table, is observed to do the same (thesis 5.2)."""

from functools import cache

import pytest
from virtual_bodies.drinking import drinking, steps_of

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


KEEPS_NO_HOLD = pytest.mark.xfail(
    strict=True, reason="thesis misses the hold before a child raises the mug: no zero crossing"
)
TRIALS = [
    pytest.param("woman", 1, "extended"),
    pytest.param("woman", 1, "thesis"),
    pytest.param("child", 3, "extended"),
    pytest.param("child", 3, "thesis", marks=KEEPS_NO_HOLD),
]


@cache
def trial(who: str, number: int) -> Capture:
    return drinking(who, number, rate_hz=30.0)


@pytest.mark.parametrize(("who", "number", "profile"), TRIALS)
def test_a_drink_is_the_same_for_bodies_and_tables_of_any_size(
    who: str, number: int, profile: str
) -> None:
    assert steps_of(observe(trial(who, number), rules=profile)) == STEPS[profile]
