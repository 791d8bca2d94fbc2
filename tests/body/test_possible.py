"""What is told to be humanly possible is reached without falling over."""

from dataclasses import replace

import motions
import numpy as np
from virtual_bodies.possible import NEAR_M, Missed, missed

from capar.model.capture import Capture

BEYOND_M = 0.6
"""How much further ahead a thing on the table is than a child touches it without falling [m]."""

TOO_FAR_M = 1.4
"""The same, and no child could touch it [m]."""


def further(capture: Capture, ahead_m: float) -> Capture:
    """The same with the hand further ahead of where the person stands."""
    by = np.array([ahead_m, 0.0, 0.0])
    sensors = tuple(
        replace(sensor, stream=replace(sensor.stream, positions=sensor.stream.positions + by))
        for sensor in capture.sensors
    )
    return replace(capture, sensors=sensors)


def touched(ahead_m: float) -> Missed:
    """How well a child touches a thing on the table that far ahead of the usual."""
    return missed(further(motions.touch(motions.CHILD, rate_hz=3.0).capture, ahead_m))


def test_a_hand_on_the_table_is_possible_with_the_weight_above_the_feet() -> None:
    made = touched(0.0)
    assert made.possible
    assert made.beside_m < 0.0
    assert not any(made.stands)


def test_what_could_be_touched_only_by_falling_forward_is_not_possible() -> None:
    made = touched(BEYOND_M)
    assert not made.possible
    assert made.metres > NEAR_M
    assert made.reasons[-1] == "only who fell over could do it"


def test_what_nobody_could_reach_is_not_possible_and_says_by_how_much() -> None:
    made = touched(TOO_FAR_M)
    assert not made.possible
    assert not made.falls
    assert f"by {1e3 * made.metres:.0f} mm" in made.reasons[0]


def test_somebody_who_lifts_a_foot_has_the_weight_above_the_other_one() -> None:
    made = missed(motions.stand_on_one_leg(motions.CHILD, rate_hz=10.0).capture)
    assert made.possible
    assert -0.05 < made.beside_m < 0.0, "a foot is narrow"
