"""When a motion began follows from all that was seen of it, at any rate, speed and noise."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.extra import numpy as arrays

from extractors.motion.motion_edges import GROWN, before_seen

HAIR_M = 0.001
MOST_S = 1.0
RATES_HZ = st.sampled_from([30.0, 60.0, 100.0, 240.0])


def smooth(share: np.ndarray) -> np.ndarray:
    """From 0 to 1 with least jerk."""
    part = np.clip(share, 0.0, 1.0)
    return np.asarray(part**3 * (10.0 - 15.0 * part + 6.0 * part**2))


def seen(way: np.ndarray) -> tuple[np.ndarray, int]:
    """A displacement in hairs from where it is one on, and the frame where that is."""
    first = int(np.flatnonzero(way >= HAIR_M)[0])
    return way[first:] / HAIR_M, first


@given(RATES_HZ, st.floats(0.4, 4.0), st.floats(0.05, 1.0), st.floats(0.0, 1.0))
@settings(max_examples=60, deadline=None)
def test_a_smooth_motion_began_when_it_did_whatever_its_speed_and_the_clock(
    rate_hz: float, lasts_s: float, way_m: float, phase: float
) -> None:
    times = np.arange(round(lasts_s * rate_hz) + 1) / rate_hz
    begin_s = phase / rate_hz
    grows, first = seen(way_m * smooth((times - begin_s) / lasts_s))
    found = first - before_seen(grows, GROWN, round(MOST_S * rate_hz))
    assert abs(found / rate_hz - begin_s) <= 1.01 / rate_hz


@given(RATES_HZ, st.floats(0.3, 3.0), st.floats(0.0, 1.0))
@settings(max_examples=60, deadline=None)
def test_what_sets_off_at_once_began_within_a_frame_before_it_was_seen(
    rate_hz: float, speed_mps: float, phase: float
) -> None:
    times = np.arange(round(0.5 * rate_hz)) / rate_hz
    begin_s = 0.1 + phase / rate_hz
    grows, first = seen(np.maximum(times - begin_s, 0.0) * speed_mps)
    found = first - before_seen(grows, GROWN, round(MOST_S * rate_hz))
    assert abs(found / rate_hz - begin_s) <= 1.01 / rate_hz


@pytest.mark.parametrize("rate_hz", [30.0, 60.0, 100.0, 240.0])
def test_noise_moves_the_beginning_of_98_in_100_slow_motions_by_no_more_than_50_ms(
    rate_hz: float,
) -> None:
    """A fifth of a hair is what noise leaves of a filtered place, since a hair is five of it."""
    chance = np.random.default_rng(7)
    errors_s = [_noisy_error_s(chance, rate_hz) for _ in range(300)]
    assert np.mean(np.abs(errors_s) <= 0.05 + 1.0 / rate_hz) >= 0.98


def _noisy_error_s(chance: np.random.Generator, rate_hz: float) -> float:
    """How late the beginning is of a slow motion drawn by chance, with noise [s]."""
    lasts_s, way_m = chance.uniform(2.0, 4.0), chance.uniform(0.2, 0.4)
    rest = round(0.5 * rate_hz)
    times = (np.arange(rest + round(lasts_s * rate_hz) + 1) - rest) / rate_hz
    truth = way_m * smooth(times / lasts_s)
    noise = chance.normal(0.0, HAIR_M / 5.0, len(times))
    noise = np.convolve(noise, np.ones(3) / np.sqrt(3.0), mode="same")
    last_there = int(np.flatnonzero(truth + noise < HAIR_M)[-1])
    grows = (truth + noise)[last_there + 1 :] / HAIR_M
    found = last_there + 1 - before_seen(grows, GROWN, round(MOST_S * rate_hz))
    return float(times[found])


@given(
    arrays.arrays(
        np.float64,
        st.integers(0, 30),
        elements=st.floats(-10.0, 1e4) | st.just(float("nan")),
    ),
    st.integers(0, 100),
)
@settings(max_examples=300, deadline=None)
def test_any_displacement_has_an_answer_between_none_and_the_most(
    grows: np.ndarray, most: int
) -> None:
    assert 0 <= before_seen(grows, GROWN, most) <= most
