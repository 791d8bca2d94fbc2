"""What is told to be humanly possible is reached without falling over."""

from dataclasses import replace

import motions
import numpy as np
from virtual_bodies.possible import BESIDE_M, missed

from capar.model.capture import Capture

TOO_FAR_M = 0.8
"""How much further ahead a thing on the table is than a child can touch it standing [m]."""


def further(capture: Capture, ahead_m: float) -> Capture:
    """The same with the hand further ahead of where the person stands."""
    by = np.array([ahead_m, 0.0, 0.0])
    sensors = tuple(
        replace(each, stream=replace(each.stream, positions=each.stream.positions + by))
        for each in capture.sensors
    )
    return replace(capture, sensors=sensors)


def test_a_hand_on_the_table_is_possible_with_the_weight_above_the_feet() -> None:
    made = missed(motions.touch(motions.CHILD, rate_hz=10.0).capture)
    assert made.possible
    assert made.beside_m <= BESIDE_M
    assert not any(made.stands)


def test_what_could_be_touched_only_by_falling_forward_is_not_possible() -> None:
    capture = motions.touch(motions.CHILD, rate_hz=3.0).capture
    made = missed(further(capture, TOO_FAR_M))
    assert not made.possible
    assert made.beside_m > BESIDE_M
