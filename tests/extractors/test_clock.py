"""The step of a clock is that of its values, whenever it is asked."""

import numpy as np
import pytest

from extractors.signals.intervals import frame_rate, time_step


def test_a_clock_that_changes_has_the_step_of_its_present_values() -> None:
    times = np.arange(100) / 50.0
    assert frame_rate(times) == pytest.approx(50.0)
    times *= 0.5
    assert frame_rate(times) == pytest.approx(100.0)


def test_clocks_that_live_one_after_the_other_have_steps_of_their_own() -> None:
    for rate_hz in (30.0, 60.0, 100.0, 240.0) * 25:
        times = np.arange(64) / rate_hz
        times.flags.writeable = False
        assert time_step(times) == time_step(times) == pytest.approx(1.0 / rate_hz)
        del times
