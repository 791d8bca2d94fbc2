"""Noise is what is left of a motion when its smooth part is taken away."""

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from capar.model.capture import Stream
from extractors.readers.drafting.survey import survey

RATE_HZ = 100.0
TIMES = np.arange(600) / RATE_HZ


def moving(*, noise_m: float, noise_deg: float, turn_deg_s: float, speed_m_s: float) -> Stream:
    """A body that turns and moves steadily and never rests, with noise."""
    chance = np.random.default_rng(7)
    places = np.outer(speed_m_s * np.sin(TIMES), [1.0, 0.0, 0.0])
    places += chance.normal(0.0, noise_m, places.shape)
    turns = Rotation.from_euler("z", (turn_deg_s * np.sin(TIMES))[:, None], degrees=True)
    shaken = Rotation.from_rotvec(chance.normal(0.0, np.radians(noise_deg), places.shape))
    return Stream(TIMES, places, (turns * shaken).as_quat(scalar_first=True))


@settings(max_examples=20, deadline=None)
@given(
    noise_m=st.floats(1e-5, 5e-3),
    noise_deg=st.floats(0.01, 1.0),
    turn=st.floats(-90.0, 90.0),
    speed=st.floats(0.0, 0.3),
)
def test_a_head_that_turns_is_not_taken_for_noise(
    noise_m: float, noise_deg: float, turn: float, speed: float
) -> None:
    stream = moving(noise_m=noise_m, noise_deg=noise_deg, turn_deg_s=turn, speed_m_s=speed)
    found = survey("head", "sensor", stream)
    assert found.noise_mm is not None and found.noise_deg is not None
    least = 1e3 * noise_m * np.sqrt(3.0), noise_deg * np.sqrt(3.0)
    assert 0.7 * least[0] < found.noise_mm < 1.1 * least[0] + 0.01
    assert 0.7 * least[1] < found.noise_deg < 1.1 * least[1] + 0.01


def test_a_stream_that_is_lost_or_short_has_no_noise_to_tell() -> None:
    lost = np.full((600, 3), np.nan)
    assert survey("a", "body", Stream(TIMES, lost, np.full((600, 4), np.nan))).noise_mm is None
    turns = np.tile([1.0, 0.0, 0.0, 0.0], (6, 1))
    assert survey("b", "body", Stream(TIMES[:6], np.zeros((6, 3)), turns)).noise_mm is None
