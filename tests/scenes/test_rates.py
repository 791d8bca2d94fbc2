"""Scenes keep their names at other rates, with other noise and in other draws (spec 10)."""

import numpy as np
import pytest

from scenes.hands import SCENES
from scenes.rates import stays
from scenes.score import Outcome, observed

RATES_HZ = (30.0, 100.0, 240.0)
NOISES_M = (0.0, 0.0005, 0.0015)
NOISE_RAD_PER_M = np.radians(0.2) / 0.001
"""Rotations are as noisy as the tip of a hand is: a fifth of a degree beside a millimetre."""

SOME = 4
"""One scene in so many is observed here, each with a rate, noise and draw of its own."""

WAYS = [
    (name, RATES_HZ[place % 3], NOISES_M[place // 3 % 3], place // 9 % 3)
    for place, name in enumerate(sorted(SCENES)[::SOME])
]


@pytest.mark.parametrize(("name", "rate_hz", "noise_m", "draw"), WAYS)
def test_a_scene_has_its_names_at_any_rate_and_noise(
    name: str, rate_hz: float, noise_m: float, draw: int
) -> None:
    for each in observed(name, SCENES[name], rate_hz, noise_m, NOISE_RAD_PER_M * noise_m, draw):
        assert each.named, f"{each.ee} at {rate_hz:g} Hz: {each.expected}, found {each.found}"


def outcome(end_s: float, *, named: bool = True) -> Outcome:
    """One unit of one step."""
    return Outcome(
        "a", "hand", ("Rest() 0.00-1.00",), (f"Rest() 0.00-{end_s:.2f}",), named, named, 0
    )


def test_a_border_stays_within_50_ms_and_other_steps_do_not_count() -> None:
    assert stays(outcome(1.04), outcome(1.0)) is True
    assert stays(outcome(1.05), outcome(1.0)) is True
    assert stays(outcome(1.06), outcome(1.0)) is False
    other = Outcome("a", "hand", (), ("Touch(cup) 0.00-1.00",), False, False, None)
    assert stays(other, outcome(1.0)) is None
