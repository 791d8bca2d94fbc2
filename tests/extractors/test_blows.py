"""A blow is told by what it sets going, and its speed is that of the motion before the filter."""

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st
from measured_bodies import box, stream

from capar.model.capture import Capture, Sensor, TagObject, TagType
from capar.model.facts import Touching
from extractors.bodies.bodies import BodyGeometry, geometry_of
from extractors.contact.blows import blow, set_going
from extractors.measure import measure
from extractors.motion.impacts import closing_speed, release_speed
from extractors.relations.arrangement import lasting
from extractors.thresholds import Thresholds

LIMITS = Thresholds()


def struck(
    speed_mps: float, leaves_mps: float, rate_hz: float, seed: int
) -> tuple[BodyGeometry, BodyGeometry, int]:
    """A palm comes at a block, which leaves it at once and slides to a halt."""
    times = np.arange(round(3.0 * rate_hz)) / rate_hz
    noise = np.random.default_rng(seed)
    palm = np.zeros((len(times), 3))
    palm[:, 0] = -speed_mps * np.abs(times - 1.0) - 0.06
    since = np.maximum(times - 1.0, 0.0)
    stops = leaves_mps / 3.0
    block = np.zeros((len(times), 3))
    block[:, 0] = leaves_mps * np.minimum(since, stops) - 1.5 * np.minimum(since, stops) ** 2
    palm += noise.normal(0.0, 0.0005, palm.shape)
    block += noise.normal(0.0, 0.0005, block.shape)
    hand = Sensor(
        "palm", "hand", "right", "right_arm", stream(palm, rate_hz=rate_hz), box(0.02, 0.1, 0.1)
    )
    thing = TagObject("block", TagType.MOBILE, stream(block, rate_hz=rate_hz), box(0.1, 0.1, 0.1))
    return geometry_of(hand, LIMITS), geometry_of(thing, LIMITS), round(rate_hz)


@given(
    st.floats(1.0, 2.5),
    st.floats(0.6, 1.5),
    st.sampled_from([100.0, 240.0]),
    st.integers(0, 1000),
)
@settings(max_examples=20, deadline=None)
def test_a_block_that_is_struck_away_was_met_when_it_set_off(
    speed_mps: float, leaves_mps: float, rate_hz: float, seed: int
) -> None:
    palm, block, met = struck(speed_mps, leaves_mps, rate_hz, seed)
    moves = (met + round(0.01 * rate_hz), met + round(0.3 * rate_hz))
    (frame,) = set_going(block, [moves], LIMITS)
    found = blow(palm, block, frame, 0.005, LIMITS)
    assert found is not None
    assert found[0] <= met + 1
    assert found[1] >= met - 1


def swung_stick(aside_m: float, rate_hz: float, seed: int) -> Capture:
    """A stick in a hand comes at a puck at a metre a second, past it by so far, and halts."""
    palm, puck, _ = struck(1.0, 0.8, rate_hz, seed)
    times = palm.poses.filled.times
    way = np.zeros((len(times), 3))
    way[:, 0] = np.minimum(times - 1.0, 0.0) - 0.06
    way[:, 1] = aside_m
    held = way + np.array([-0.2, 0.0, 0.0])
    sensor = Sensor(
        "palm", "hand", "right", "right_arm", stream(held, rate_hz=rate_hz), box(0.02, 0.1, 0.1)
    )
    length = box(0.38, 0.02, 0.02)
    moved = way + np.array([-0.18, 0.0, 0.0])
    stick = TagObject("stick", TagType.MOBILE, stream(moved, rate_hz=rate_hz), length)
    thing = TagObject("puck", TagType.MOBILE, puck.poses.filled, box(0.1, 0.1, 0.1))
    return Capture("swung stick", (sensor,), (stick, thing))


@given(st.sampled_from([100.0, 240.0]), st.integers(0, 1000))
@settings(max_examples=6, deadline=None)
def test_a_held_stick_met_the_puck_that_it_sends_off(rate_hz: float, seed: int) -> None:
    capture = swung_stick(0.0, rate_hz, seed)
    met = [
        each
        for each in measure(capture).facts
        if isinstance(each, Touching) and (each.body, each.other) == ("stick", "puck")
    ]
    assert any(each.first - 2 <= round(rate_hz) <= each.last + 2 for each in met)


@given(st.floats(0.08, 0.3), st.integers(0, 1000))
@settings(max_examples=4, deadline=None)
def test_a_held_stick_that_passes_beside_the_puck_did_not_meet_it(
    aside_m: float, seed: int
) -> None:
    facts = measure(swung_stick(aside_m, 100.0, seed)).facts
    pairs = [{each.body, each.other} for each in facts if isinstance(each, Touching)]
    assert {"palm", "stick"} in pairs
    assert {"stick", "puck"} not in pairs


@given(st.floats(0.05, 0.4), st.floats(0.8, 2.0))
@settings(max_examples=20, deadline=None)
def test_what_is_pushed_off_softly_was_not_struck(way_m: float, seconds: float) -> None:
    times = np.arange(400) / 100.0
    share = np.clip((times - 1.0) / (seconds + way_m), 0.0, 1.0)
    way = np.zeros((400, 3))
    way[:, 0] = way_m * share**3 * (10.0 - 15.0 * share + 6.0 * share**2)
    thing = TagObject("block", TagType.MOBILE, stream(way), box(0.1, 0.1, 0.1))
    body = geometry_of(thing, LIMITS)
    assert not list(set_going(body, [(100, 300)], LIMITS))
    assert release_speed(body, 50) < 0.01


@given(st.floats(0.5, 2.5), st.sampled_from([30.0, 100.0, 240.0]), st.integers(0, 1000))
@settings(max_examples=20, deadline=None)
def test_a_hand_that_halts_at_a_wall_met_it_as_fast_as_it_came(
    speed_mps: float, rate_hz: float, seed: int
) -> None:
    times = np.arange(round(2.0 * rate_hz)) / rate_hz
    way = np.zeros((len(times), 3))
    way[:, 0] = speed_mps * np.minimum(times - 1.0, 0.0) - 0.06
    way += np.random.default_rng(seed).normal(0.0, 0.0005, way.shape)
    palm = stream(way, rate_hz=rate_hz)
    hand = Sensor("palm", "hand", "right", "right_arm", palm, box(0.02, 0.1, 0.1))
    stands = stream(np.zeros(way.shape), rate_hz=rate_hz)
    wall = TagObject("wall", TagType.FIXED, stands, box(0.1, 1.0, 1.0))
    late = round(rate_hz) + 1
    found = closing_speed(geometry_of(hand, LIMITS), geometry_of(wall, LIMITS), late)
    assert abs(found - speed_mps) < 0.05 * speed_mps + 0.1


@given(st.lists(st.floats(0.0, 1.0), min_size=1, max_size=60))
def test_what_lasts_begins_where_it_clearly_holds_and_never_flickers_in_between(
    values: list[float],
) -> None:
    share = np.array(values)
    found = lasting(share >= 0.5, share >= 0.4)
    assert found[share >= 0.5].all()
    assert not found[share < 0.4].any()
    kept = (share >= 0.4) & (share < 0.5)
    for frame in np.flatnonzero(kept):
        beside = {
            found[each] for each in (frame - 1, frame + 1) if 0 <= each < len(share) and kept[each]
        }
        assert beside <= {found[frame]}
