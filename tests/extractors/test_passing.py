"""What brushes past another body does not touch it; what strikes, stops or pushes it does."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from measured_bodies import box, still, stream

from capar.model.capture import Capture, Sensor, TagObject, TagType
from capar.model.facts import Touching
from extractors.measure import measure

RATES_HZ = st.sampled_from([30.0, 60.0, 100.0, 240.0])
WALL = box(0.02, 0.4, 0.4)


def touches(way_m: np.ndarray, rate_hz: float, thing: np.ndarray | None = None) -> list[Touching]:
    """The contacts of a small hand that goes such a way with a plate that stands upright."""
    hand = Sensor(
        "hand", "hand", "right", "right_arm", stream(way_m, rate_hz=rate_hz), box(0.02, 0.02, 0.02)
    )
    if thing is None:
        pose = still((0.0, 0.0, 0.0), len(way_m), rate_hz=rate_hz)
        plate = TagObject("plate", TagType.FIXED, pose, WALL)
    else:
        plate = TagObject("plate", TagType.MOBILE, stream(thing, rate_hz=rate_hz), WALL)
    facts = measure(Capture("trial", (hand,), (plate,))).facts
    return [each for each in facts if isinstance(each, Touching) and each.body == "hand"]


def clock(rate_hz: float) -> np.ndarray:
    """Two seconds about zero."""
    return np.arange(round(2.0 * rate_hz)) / rate_hz - 1.0


@given(st.floats(1.0, 2.0), st.floats(-0.003, 0.004), RATES_HZ)
@settings(max_examples=20, deadline=None)
def test_a_hand_that_goes_on_past_an_edge_as_before_touches_nothing(
    speed_mps: float, gap_m: float, rate_hz: float
) -> None:
    along = speed_mps * clock(rate_hz)
    way = np.stack([along, np.zeros_like(along), np.full_like(along, 0.21 + gap_m)], axis=1)
    assert not touches(way, rate_hz)


@given(st.floats(1.0, 2.0), st.floats(0.0, 0.004), RATES_HZ)
@settings(max_examples=20, deadline=None)
def test_a_hand_that_bounces_off_has_touched(
    speed_mps: float, deep_m: float, rate_hz: float
) -> None:
    away = speed_mps * np.maximum(np.abs(clock(rate_hz)) - 0.04, 0.0) + 0.02 - deep_m
    way = np.stack([away, np.zeros_like(away), np.zeros_like(away)], axis=1)
    assert len(touches(way, rate_hz)) == 1


@pytest.mark.parametrize("rate_hz", [30.0, 100.0, 240.0])
def test_a_hand_that_strokes_along_slowly_touches(rate_hz: float) -> None:
    along = 0.2 * clock(rate_hz)
    way = np.stack([along, np.zeros_like(along), np.full_like(along, 0.212)], axis=1)
    assert len(touches(way, rate_hz)) == 1


@given(st.floats(1.0, 2.0), st.sampled_from([100.0, 240.0]))
@settings(max_examples=10, deadline=None)
def test_a_hand_that_sends_a_thing_off_has_touched_it(speed_mps: float, rate_hz: float) -> None:
    times = clock(rate_hz)
    way, sent = np.zeros((len(times), 3)), np.zeros((len(times), 3))
    way[:, 0] = np.where(times < 0.0, speed_mps * times, 0.2 * speed_mps * times) - 0.02
    sent[:, 0] = np.maximum(speed_mps * times, 0.0)
    assert touches(way, rate_hz, sent)
