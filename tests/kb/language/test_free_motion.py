"""A hand that touches nothing reaches up, forward or aside, as the person faces."""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from observations import MUG, Piece, observation

from capar.model.sampled_track import sampled_track
from kb.language.describe import describe

AT = {"right_hand": (0.3, -0.2, 0.9), "left_hand": (0.3, 0.2, 0.9)}
"""Hands of a person who looks along x, with y to the left."""


def told(way: Sequence[float], facing: float = 0.0, *, back: bool = True) -> str:
    """What is told of a right hand that goes that way from rest, in a person who faces so [rad]."""
    pieces = (Piece("Rest", 50, ()), Piece("PostureChange", 250, ()), Piece("Rest", 300, ()))
    still = (Piece("Rest", 300, ()),)
    made = observation(
        "Reaching",
        {"right_hand": pieces, "left_hand": still},
        (MUG,),
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
        share -= np.clip((np.arange(301) - 150) / 100.0, 0.0, 1.0)
    tracks = [sampled_track("head", 0.01, np.tile((0.0, 0.0, 1.6), (301, 1)))]
    for ee, place in AT.items():
        gone = share[:, None] * np.asarray(way) if ee == "right_hand" else np.zeros((301, 3))
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
