"""A hand that touches nothing reaches up, forward or aside, as the person faces."""

import re
from collections.abc import Sequence
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from observations import MUG, TABLE, Piece, observation

from capar.model.locations import sampled_track
from capar.model.observation import ObservedObject
from kb.language.describe import describe

AT = {"right_hand": (0.3, -0.2, 0.9), "left_hand": (0.3, 0.2, 0.9)}
"""Hands of a person who looks along x, with y to the left."""


def told(
    way: Sequence[float],
    facing: float = 0.0,
    *,
    back: bool = True,
    head: Sequence[float] = (0.0, 0.0, 0.0),
    things: tuple[ObservedObject, ...] = (MUG,),
    swing_m: float = 0.0,
) -> str:
    """What is told of a right hand that goes that way from rest, in a person who faces so [rad].

    The head goes its own way meanwhile. With a swing the hand is back at 2 s, and swings up so far
    until 2.5 s.
    """
    pieces = (Piece("Rest", 50, ()), Piece("PostureChange", 250, ()), Piece("Rest", 300, ()))
    still = (Piece("Rest", 300, ()),)
    made = observation(
        "Reaching",
        {"right_hand": pieces, "left_hand": still},
        things,
        frames=301,
        rate_hz=100.0,
    )
    turn = np.array(
        [
            [np.cos(facing), -np.sin(facing), 0.0],
            [np.sin(facing), np.cos(facing), 0.0],
            [0.0, 0.0, 1.0],
        ]
    )
    share = np.clip((np.arange(301) - 50) / 100.0, 0.0, 1.0)
    if back:
        share -= np.clip((np.arange(301) - 150) / (50.0 if swing_m else 100.0), 0.0, 1.0)
    swing = swing_m * np.clip((np.arange(301) - 200) / 50.0, 0.0, 1.0)
    over = (np.array((0.0, 0.0, 1.6)) + share[:, None] * np.asarray(head)) @ turn.T
    tracks = [sampled_track("head", 0.01, over)]
    for ee, place in AT.items():
        gone = share[:, None] * np.asarray(way) + swing[:, None] * (0.0, 0.0, 1.0)
        gone = gone if ee == "right_hand" else np.zeros((301, 3))
        tracks.append(sampled_track(ee, 0.01, (np.asarray(place) + gone) @ turn.T))
    return describe(replace(made, tracks=tuple(tracks)), timed=True)


@pytest.mark.parametrize(
    ("way", "words"),
    [
        ((0.5, 0.0, 0.0), "forward"),
        ((-0.5, 0.0, 0.0), "backward"),
        ((0.0, 0.5, 0.0), "to the left"),
        ((0.0, -0.5, 0.0), "to the right"),
        ((0.0, 0.0, 0.6), "up"),
        ((0.0, 0.0, -0.6), "down"),
        ((0.4, 0.0, 0.5), "forward and up"),
        ((0.0, -0.4, -0.4), "to the right and down"),
        ((0.5, 0.6, 0.0), "forward to the left"),
        ((-0.4, -0.4, 0.0), "backward to the right"),
    ],
)
def test_a_reach_has_its_direction(way: tuple[float, ...], words: str) -> None:
    text = told(way)
    assert text.startswith(f"The agent reached {words} with the right hand (0.50–")
    back = "brought the hand forward again" if words == "backward" else "brought the hand back"
    back = "lowered the hand again" if way[2] > 0.0 else back
    assert f" and {back} (" in text
    assert text.endswith(" s) without touching anything.")


def test_a_hand_is_lowered_when_it_is_lowest_though_it_swings_up_a_little_after() -> None:
    found = re.search(
        r"lowered the hand again \((\d\.\d\d)–(\d\.\d\d) s\)", told((0.0, 0.0, 0.6), swing_m=0.06)
    )
    assert found is not None
    assert float(found[1]) == pytest.approx(1.5, abs=0.05)
    assert float(found[2]) == pytest.approx(2.0, abs=0.05)


def test_a_hand_that_gets_above_the_head_is_told_to() -> None:
    assert "reached up above the head with the right hand" in told((0.0, 0.0, 0.9))


def test_a_hand_that_stays_there_does_not_come_back() -> None:
    assert "back" not in told((0.5, 0.0, 0.0), back=False)


def test_a_hand_that_hardly_goes_reaches_nowhere() -> None:
    assert told((0.1, 0.0, 0.0)) == (
        "The agent moved the right hand (0.50–2.50 s) without touching anything."
    )


@given(st.floats(-3.1, 3.1))
def test_directions_are_the_persons_own(facing: float) -> None:
    assert told((0.5, 0.1, 0.1), facing) == told((0.5, 0.1, 0.1))


@pytest.mark.parametrize("facing", [0.0, 2.0])
def test_who_goes_down_and_along_with_the_hand_leans(facing: float) -> None:
    text = told((0.5, 0.0, 0.0), facing, head=(0.25, 0.0, -0.15))
    assert text.startswith("The agent leaned and reached forward with the right hand (0.50–")
    assert " and straightened up again (" in text
    for head in ((0.25, 0.0, 0.0), (0.1, 0.0, -0.15), (0.0, 0.25, -0.15)):
        assert "leaned" not in told((0.5, 0.0, 0.0), facing, head=head)


def test_where_there_is_nothing_to_touch_it_is_not_told_that_nothing_was_touched() -> None:
    for things in ((), (TABLE,)):
        text = told((0.5, 0.0, 0.0), things=things)
        assert text.startswith("The agent reached forward")
        assert "touching" not in text
