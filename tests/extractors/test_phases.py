"""Phases, seats and onsets of motion are what closed forms say, whatever the noise and the rate."""

from itertools import pairwise

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st
from motions import shapes

from capar.model.capture import Stream, TagObject, TagType
from extractors.bodies.bodies import BodyGeometry, geometry_of
from extractors.motion.motion_edges import GROWN, POWERS, before_seen, motion_edges, seat
from extractors.motion.object_motion import Floor, moving, rest_poses
from extractors.motion.phases import LEVEL, RISING, SINKING, Phase, phases, turns_of_height
from extractors.thresholds import Thresholds

LIMITS = Thresholds()
BOX = shapes.box(0.1, 0.1, 0.1)
TABLE = shapes.table(1.0, 1.0)
RATES = st.sampled_from([30.0, 60.0, 100.0, 240.0])
NOISES_M = st.sampled_from([0.0, 0.0005, 0.0015])
SEEDS = st.integers(0, 10)


def smooth(share: np.ndarray) -> np.ndarray:
    """From 0 to 1 with least jerk, at rest before and after."""
    part = np.clip(share, 0.0, 1.0)
    return np.asarray(part**3 * (10.0 - 15.0 * part + 6.0 * part**2))


def body(
    places: np.ndarray, rate_hz: float, *, noise_m: float = 0.0, seed: int = 0
) -> BodyGeometry:
    """A box whose middle is at these places [m], measured with noise."""
    times = np.arange(len(places)) / rate_hz
    noise = np.random.default_rng(seed).normal(0.0, noise_m, places.shape) if noise_m else 0.0
    turns = np.tile([1.0, 0.0, 0.0, 0.0], (len(times), 1))
    thing = TagObject("thing", TagType.MOBILE, Stream(times, places + noise, turns), BOX)
    return geometry_of(thing, LIMITS)


def arc(rate_hz: float, *, up_m: float, aside_m: float, lasts_s: float = 1.6) -> np.ndarray:
    """An ellipse over the table, from 0.5 s on, with a rest before and after."""
    times = np.arange(round((lasts_s + 1.0) * rate_hz)) / rate_hz
    angle = np.pi * smooth((times - 0.5) / lasts_s)
    x, z = 0.5 * aside_m * (1.0 - np.cos(angle)), up_m * np.sin(angle)
    return np.stack([x, np.zeros_like(x), z], axis=1)


def found_in(thing: BodyGeometry, rate_hz: float, lasts_s: float = 1.6) -> tuple[Phase, ...]:
    whole = (round(0.5 * rate_hz), round((0.5 + lasts_s) * rate_hz))
    return phases(thing, (whole,), LIMITS)


@settings(max_examples=40)
@given(rate_hz=RATES, noise_m=NOISES_M, seed=SEEDS)
def test_a_high_arc_rises_goes_level_and_sinks_where_it_is_at_45_degrees(
    rate_hz: float, noise_m: float, seed: int
) -> None:
    up_m, aside_m = 0.25, 0.5
    thing = body(arc(rate_hz, up_m=up_m, aside_m=aside_m), rate_hz, noise_m=noise_m, seed=seed)
    found = found_in(thing, rate_hz)
    assert [each.kind for each in found] == [RISING, LEVEL, SINKING]
    share = np.linspace(0.0, 1.0, 10001)
    angle = np.pi * smooth(share)
    slope = up_m * np.cos(angle) / (0.5 * aside_m * np.maximum(np.sin(angle), 1e-9))
    steep = 0.5 + 1.6 * share[int(np.argmax(slope < 1.0))]
    flat = 0.5 + 1.6 * share[int(np.argmax(slope < -1.0))]
    placed = [each.last / rate_hz for each in found[:2]]
    assert placed == pytest.approx([steep, flat], abs=0.05)


@settings(max_examples=40)
@given(rate_hz=RATES, noise_m=NOISES_M, seed=SEEDS, aside_m=st.floats(0.0, 0.08))
def test_what_goes_up_and_down_turns_back_in_the_middle_of_its_flat_top(
    rate_hz: float, noise_m: float, seed: int, aside_m: float
) -> None:
    thing = body(arc(rate_hz, up_m=0.25, aside_m=aside_m), rate_hz, noise_m=noise_m, seed=seed)
    (turn,) = turns_of_height(found_in(thing, rate_hz), thing.middles, (), LIMITS)
    assert turn / rate_hz == pytest.approx(1.3, abs=0.05)


@settings(max_examples=40)
@given(rate_hz=RATES, noise_m=NOISES_M, seed=SEEDS, up_m=st.floats(0.0, 0.08))
def test_a_flat_arc_is_level_and_turns_back_nowhere(
    rate_hz: float, noise_m: float, seed: int, up_m: float
) -> None:
    thing = body(arc(rate_hz, up_m=up_m, aside_m=0.6), rate_hz, noise_m=noise_m, seed=seed)
    assert turns_of_height(found_in(thing, rate_hz), thing.middles, (), LIMITS) == ()


@settings(max_examples=40)
@given(rate_hz=RATES, noise_m=NOISES_M, seed=SEEDS)
def test_phases_of_a_motion_follow_each_other_and_fill_it(
    rate_hz: float, noise_m: float, seed: int
) -> None:
    thing = body(arc(rate_hz, up_m=0.2, aside_m=0.4), rate_hz, noise_m=noise_m, seed=seed)
    found = found_in(thing, rate_hz)
    assert found[0].first == round(0.5 * rate_hz)
    assert found[-1].last == round(2.1 * rate_hz)
    assert all(one.last == two.first for one, two in pairwise(found))


def test_what_sinks_and_rises_again_turns_back_only_after_it_had_risen() -> None:
    rate_hz = 100.0
    high = arc(rate_hz, up_m=0.25, aside_m=0.0)
    low = high * np.array([1.0, 1.0, -1.0])
    thing = body(low, rate_hz)
    assert turns_of_height(found_in(thing, rate_hz), thing.middles, (), LIMITS) == ()


@settings(max_examples=40)
@given(rate_hz=RATES, seed=SEEDS, lasts_s=st.floats(0.4, 2.0), way_m=st.floats(0.1, 0.6))
def test_a_smooth_motion_is_known_to_begin_and_end_within_50_ms_and_a_frame(
    rate_hz: float, seed: int, lasts_s: float, way_m: float
) -> None:
    creeps_s = lasts_s * (LIMITS.edge_m / (10.0 * way_m)) ** (1.0 / 3.0)
    assume(creeps_s < LIMITS.onset_s + 0.05)  # What takes longer to go a hair drifts.
    edges_are_right(rate_hz, 0.0003, seed, lasts_s, way_m)


@settings(max_examples=40)
@given(rate_hz=RATES, seed=SEEDS, lasts_s=st.floats(0.4, 1.2), way_m=st.floats(0.2, 0.6))
def test_noise_of_a_millimetre_and_a_half_hides_no_more_than_that_of_a_quick_motion(
    rate_hz: float, seed: int, lasts_s: float, way_m: float
) -> None:
    edges_are_right(rate_hz, 0.0015, seed, lasts_s, way_m)


def edges_are_right(
    rate_hz: float, noise_m: float, seed: int, lasts_s: float, way_m: float
) -> None:
    times = np.arange(round((lasts_s + 1.0) * rate_hz)) / rate_hz
    way = way_m * smooth((times - 0.5) / lasts_s)
    places = np.stack([way, np.zeros_like(way), np.zeros_like(way)], axis=1)
    poses = body(places, rate_hz, noise_m=noise_m, seed=seed).poses
    floor = Floor(LIMITS.motion_floor_m, LIMITS.motion_floor_rad)
    rests = rest_poses(poses, floor, LIMITS)
    (moved,) = moving(poses, rests, floor, LIMITS)
    edges = motion_edges(poses, moved, rests, floor, LIMITS)
    begin, end = (each / rate_hz for each in edges)
    assert begin == pytest.approx(0.5, abs=0.05 + 1.0 / rate_hz)
    assert end == pytest.approx(0.5 + lasts_s, abs=0.05 + 1.0 / rate_hz)


@pytest.mark.parametrize("power", POWERS)
@pytest.mark.parametrize("frames", [3, 8, 20])
def test_a_displacement_that_grows_by_a_power_is_known_to_begin_before_it_shows(
    power: float, frames: int
) -> None:
    grows = ((frames + np.arange(10.0 * frames)) / frames) ** power
    assert before_seen(grows, GROWN, 100) == pytest.approx(frames, abs=1)


def test_a_box_is_down_until_it_rises_and_no_longer_where_it_merely_touches_by_tolerance() -> None:
    rate_hz = 100.0
    places = arc(rate_hz, up_m=0.05, aside_m=0.3) + np.array([0.0, 0.0, 0.05])
    box = body(places, rate_hz)
    times = np.arange(len(places)) / rate_hz
    flat = np.zeros((len(times), 3))
    turns = np.tile([1.0, 0.0, 0.0, 0.0], (len(times), 1))
    table = geometry_of(TagObject("t", TagType.FIXED, Stream(times, flat, turns), TABLE), LIMITS)
    height = places[:, 2] - 0.05
    left = int(np.argmax(height > 0.005)) - 1
    rises = 50
    motion = (rises, 210)
    first, last = seat(box, table, (0, left), [motion], LIMITS)
    assert first == 0
    assert last == pytest.approx(rises, abs=5)
    assert last < left - 15
    assert seat(box, table, (0, left), [], LIMITS) == (0, left), "at rest nothing leaves"
