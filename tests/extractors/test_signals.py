"""Signals: filters, peaks, clocks and intervals."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.signal import butter, find_peaks, sosfiltfilt, sosfreqz

from extractors.signals.filters import ORDER, cutoff, gains, kernel
from extractors.signals.intervals import NEAREST, first_where, last_where
from extractors.signals.zero_crossings import prominent_peaks
from extractors.thresholds import Thresholds

LIMITS = Thresholds()


@given(rate_hz=st.floats(12.0, 1000.0))
def test_the_kernel_is_the_response_of_a_butterworth_filter_run_both_ways(rate_hz: float) -> None:
    weights = kernel(1.0 / rate_hz, LIMITS)
    half = len(weights) // 2
    impulse = np.zeros(8 * half + 1)
    impulse[4 * half] = 1.0
    sos = butter(ORDER, cutoff(rate_hz, LIMITS), fs=rate_hz, output="sos")
    response = sosfiltfilt(sos, impulse, padlen=0)[3 * half : 5 * half + 1]
    assert weights == pytest.approx(response / response.sum(), abs=1e-7)
    assert weights.sum() == pytest.approx(1.0)
    assert weights == pytest.approx(weights[::-1])


@given(rate_hz=st.floats(12.0, 1000.0))
def test_gains_are_those_of_that_filter(rate_hz: float) -> None:
    sos = butter(ORDER, cutoff(rate_hz, LIMITS), fs=rate_hz, output="sos")
    angles, response = sosfreqz(sos, worN=2048)
    passed = np.abs(response) ** 2
    expected = (
        np.sqrt(np.mean(passed**2)),
        np.sqrt(np.mean((passed * np.sin(angles) * rate_hz) ** 2)),
        np.sqrt(np.mean((1.0 - passed) ** 2)),
    )
    assert gains(rate_hz, LIMITS) == pytest.approx(expected, rel=1e-6)


@given(
    values=st.lists(st.integers(-6, 6), min_size=1, max_size=80),
    prominence=st.integers(1, 8),
    reach=st.integers(1, 90),
)
def test_peaks_are_those_of_find_peaks(values: list[int], prominence: int, reach: int) -> None:
    signal = np.array(values, dtype=float)
    expected, _ = find_peaks(signal, prominence=prominence, wlen=2 * reach + 1)
    assert prominent_peaks(signal, prominence, reach).tolist() == expected.tolist()


@given(seed=st.integers(0, 2**32 - 1), reach=st.integers(1, 400))
def test_peaks_of_noise_are_those_of_find_peaks(seed: int, reach: int) -> None:
    signal = np.random.default_rng(seed).normal(size=500).cumsum()
    expected, _ = find_peaks(signal, prominence=1.5, wlen=2 * reach + 1)
    assert prominent_peaks(signal, 1.5, reach).tolist() == expected.tolist()


LONG = 12 * NEAREST
places = st.lists(st.integers(0, LONG - 1), max_size=4)
frames = st.integers(-1, LONG)


@given(places, frames)
def test_the_first_frame_from_one_on_and_the_last_up_to_one_are_found(
    where: list[int], frame: int
) -> None:
    holds = np.isin(np.arange(LONG), where)
    later = [each for each in where if each >= max(frame, 0)]
    sooner = [each for each in where if each <= frame]
    assert first_where(holds.__getitem__, max(frame, 0), LONG) == min(later, default=None)
    assert last_where(holds.__getitem__, min(frame, LONG - 1)) == max(sooner, default=None)
