"""Told steps agree with the capture by numbers alone, and would not with other times or words."""

import re
from functools import cache

import motions
import pytest
from tellings import WORDS
from told_checks import Checked, checked
from told_claims import claims

from capar.model.capture import Capture
from capar.pipelines.observation import observe_measured
from extractors.measure import measure
from kb.language.describe import describe

MADE = {
    "slid": lambda: motions.slide_object(motions.WOMAN).capture,
    "lifted": lambda: motions.pick_up_with_both_hands(motions.WOMAN).capture,
}
THINGS = {"box": "box", "table": "table"}


@cache
def observed(name: str) -> tuple[str, Capture]:
    """What is told of a motion with its times, and its capture."""
    capture = MADE[name]()
    observation = observe_measured(capture, measure(capture))
    return describe(observation, timed=True, words=WORDS.words), capture


def of(text: str, capture: Capture) -> list[Checked]:
    """The told steps as they were checked."""
    return checked(text, capture, THINGS)


@pytest.mark.parametrize("name", MADE)
def test_nothing_contradicts_what_is_told_of_a_known_motion(name: str) -> None:
    found = of(*observed(name))
    assert found
    assert all(step.compared for step in found)
    assert [step for step in found if step.wrong] == []


@pytest.mark.parametrize("late_s", [-0.9, 0.9])
@pytest.mark.parametrize("name", MADE)
def test_other_times_are_contradicted(name: str, late_s: float) -> None:
    text, capture = observed(name)
    moved = re.sub(r"\d+\.\d\d", lambda told: f"{float(told[0]) + late_s:.2f}", text)
    assert all(step.wrong for step in of(moved, capture))


def test_a_motion_of_which_no_step_is_told_is_found() -> None:
    text, capture = observed("lifted")
    told = re.sub(r",? and put it .*", ".", text)
    assert told != text
    (*_, last) = of(told, capture)
    assert any(what.endswith("untold") for what in last.wrong)


@pytest.mark.parametrize(
    ("name", "told", "other"),
    [
        ("lifted", "put it back on the table", "carried it"),
        ("lifted", "lifted the box", "turned the box around"),
        ("slid", "pushed the box along the table", "turned the box upside down"),
    ],
)
def test_other_deeds_are_contradicted(name: str, told: str, other: str) -> None:
    text, capture = observed(name)
    assert told in text
    assert any(step.wrong for step in of(text.replace(told, other), capture))


def test_steps_are_read_with_their_thing_hand_and_times() -> None:
    text = (
        "The agent put the box (1.00–2.00 s) and the mug (3.00–4.00 s) in the carton with the "
        "right hand, while the left hand turned the table (1.50–3.50 s) and slid it (4.00–5.00 s), "
        "turning it by about a quarter."
    )
    found = list(claims(text, {"box": "box", "mug": "mug", "carton": "carton", "table": "table"}))
    assert [(step.said, step.thing, step.goal, step.hands, step.timed) for step in found] == [
        ("put the box in the carton", "box", "carton", ("right",), True),
        ("put the mug in the carton", "mug", "carton", ("right",), True),
        ("turned the table", "table", "", ("left",), True),
        ("slid it", "table", "", ("left",), True),
        ("turning it by about a quarter", "table", "", ("left",), False),
    ]
    assert [step.spans for step in found][-2:] == [((4.0, 5.0),), ((4.0, 5.0),)]
