"""When a motion began follows from all that was seen of it, at any rate, speed and noise."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.extra import numpy as arrays

from extractors.motion.motion_edges import GROWN, onset

HAIR_M = 0.001
MOST_S = 1.0
REST_S = 0.5
ROUGH_S = 0.003
"""A beginning is the mean over all that may be, so it is no nearer than this at any rate [s]."""

RATES_HZ = st.sampled_from([30.0, 60.0, 100.0, 240.0])


def smooth(share: np.ndarray) -> np.ndarray:
    """From 0 to 1 with least jerk."""
    part = np.clip(share, 0.0, 1.0)
    return np.asarray(part**3 * (10.0 - 15.0 * part + 6.0 * part**2))


def clock(rate_hz: float, lasts_s: float) -> np.ndarray:
    """Times from a rest before a motion to its end; it begins at 0 [s]."""
    rest = round(REST_S * rate_hz)
    return (np.arange(rest + round(lasts_s * rate_hz) + 1) - rest) / rate_hz


def told_s(times: np.ndarray, way: np.ndarray, noise: np.ndarray | float = 0.0) -> float:
    """When a way is told to have begun [s], of which a hair can be seen and no noise low-passed."""
    rate_hz = 1.0 / float(np.median(np.diff(times)))
    seen = int(np.flatnonzero(way >= HAIR_M)[0])
    beyond = np.flatnonzero(way >= GROWN * HAIR_M)
    part = slice(int(beyond[0]) + 1 if beyond.size else len(way))
    found = onset(
        (way + noise)[part] / HAIR_M,
        way[part] / HAIR_M,
        seen,
        noise=np.full(len(way[part]), float(np.std(noise)) / HAIR_M),
        place=0.0,
        most=round(MOST_S * rate_hz),
        rest=round(0.15 * rate_hz),
        rate_hz=rate_hz,
    )
    return float(times[found])


@given(RATES_HZ, st.floats(0.4, 4.0), st.floats(0.05, 1.0), st.floats(0.0, 1.0))
@settings(max_examples=60, deadline=None)
def test_a_smooth_motion_began_when_it_did_whatever_its_speed_and_the_clock(
    rate_hz: float, lasts_s: float, way_m: float, phase: float
) -> None:
    times = clock(rate_hz, lasts_s)
    begin_s = phase / rate_hz
    found_s = told_s(times, way_m * smooth((times - begin_s) / lasts_s))
    assert abs(found_s - begin_s) <= 1.01 / rate_hz + ROUGH_S


@given(RATES_HZ, st.floats(0.3, 3.0), st.floats(0.0, 1.0))
@settings(max_examples=60, deadline=None)
def test_what_sets_off_at_once_began_within_a_frame_of_when_it_did(
    rate_hz: float, speed_mps: float, phase: float
) -> None:
    times = clock(rate_hz, 0.5)
    begin_s = 0.1 + phase / rate_hz
    found_s = told_s(times, np.maximum(times - begin_s, 0.0) * speed_mps)
    assert abs(found_s - begin_s) <= 1.01 / rate_hz


@given(RATES_HZ, st.floats(2.0, 4.0), st.floats(0.2, 0.4), st.integers(0, 1000))
@settings(max_examples=60, deadline=None)
def test_noise_moves_the_beginning_of_a_slow_motion_by_no_more_than_50_ms(
    rate_hz: float, lasts_s: float, way_m: float, seed: int
) -> None:
    """A fifth of a hair is what noise leaves of a filtered place, since a hair is five of it."""
    times = clock(rate_hz, lasts_s)
    noise = np.random.default_rng(seed).normal(0.0, HAIR_M / 5.0, len(times))
    found_s = told_s(times, way_m * smooth(times / lasts_s), noise)
    assert found_s == pytest.approx(0.0, abs=0.05 + 1.0 / rate_hz)


@given(
    arrays.arrays(
        np.float64,
        st.integers(1, 30),
        elements=st.floats(-10.0, 1e4) | st.just(float("nan")),
    ),
    st.integers(0, 100),
    st.data(),
)
@settings(max_examples=300, deadline=None)
def test_any_displacement_has_an_answer_no_earlier_than_the_most_and_within_it(
    way: np.ndarray, most: int, data: st.DataObject
) -> None:
    seen = data.draw(st.integers(0, len(way) - 1))
    noise = np.full(len(way), 0.2)
    found = onset(way, way, seen, noise=noise, place=0.1, most=most, rest=5, rate_hz=30.0)
    assert max(seen - most, 0) <= found < len(way)
