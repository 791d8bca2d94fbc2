"""What counts as touching at a distance is told as near, and of what the distance is."""

import math
import re
from dataclasses import replace

import motions
import numpy as np
import pytest

from capar.model.capture import Capture, PivotContact, Sensor, ShapeSource, Stream
from capar.pipelines.explanation import explain
from capar_rules.explain.explanation import Explanation


def capture() -> Capture:
    return motions.touch_cycle(motions.WOMAN).capture


def stream(trial: Capture, name: str) -> Stream:
    return next(body.stream for body in (*trial.sensors, *trial.objects) if body.name == name)


def roughly_shaped(trial: Capture) -> Capture:
    """The trial, in which the hand's shape stands in for the true one."""
    hand = next(sensor for sensor in trial.sensors if sensor.name == "right_hand")
    assert hand.shape is not None
    shape = replace(hand.shape, source=ShapeSource.STAND_IN, description="a ball of 40 mm")
    return with_hand(trial, replace(hand, shape=shape))


def with_hand(trial: Capture, hand: Sensor) -> Capture:
    others = (sensor for sensor in trial.sensors if sensor.name != hand.name)
    return replace(trial, sensors=(hand, *others))


def by_origins(trial: Capture, distance_m: float) -> Capture:
    """The trial, in which the hand has no shape and touches by the distance of origins."""
    hand = next(sensor for sensor in trial.sensors if sensor.name == "right_hand")
    pivots = (PivotContact("right_hand", "box", distance_m),)
    return replace(with_hand(trial, replace(hand, shape=None)), pivot_contacts=pivots)


def touch(trial: Capture) -> Explanation:
    """The explanation of the segment in which the hand stays at the box."""
    return next(told for told in explain(trial, "right_hand") if told.name == "Touch")


def test_true_surfaces_are_told_to_touch() -> None:
    summary = touch(capture()).summary
    assert "the right hand touched the box throughout" in summary
    assert summary.endswith("Contact is counted within 5 mm, between their surfaces.")


def test_a_stand_in_is_told_to_be_near_and_which_shape_stands_in() -> None:
    summary = touch(roughly_shaped(capture())).summary
    assert "the right hand counted as in contact with the box throughout" in summary
    assert "touched" not in summary
    assert "A shape is assumed for the right hand (a ball of 40 mm)" in summary


@pytest.mark.parametrize("margin_m", [0.01, 0.05])
def test_origins_are_told_to_be_as_near_as_they_were(margin_m: float) -> None:
    """The distance that is told is that up to which contact counts, and no frame is further."""
    trial = capture()
    ways = stream(trial, "right_hand").positions - stream(trial, "box").positions
    nearest = float(np.linalg.norm(ways, axis=1).min())
    told = touch(by_origins(trial, nearest + margin_m))
    found = re.search(
        r"Contact is counted within (\d+(?:\.\d)?) mm, between their origins", told.summary
    )
    assert found is not None
    first, last = (round(at * trial.rate_hz) for at in (told.start_s, told.end_s))
    far = float(np.linalg.norm(ways[first : last + 1], axis=1).max())
    assert far <= float(found[1]) / 1000.0 + 0.001
    assert float(found[1]) == math.ceil(1e4 * (nearest + margin_m)) / 10.0
