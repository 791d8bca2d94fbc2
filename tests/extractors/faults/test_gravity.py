"""A throw with a wrong axis, unit or rate is noticed, and the remedy names the right one."""

from collections.abc import Callable

import numpy as np
import pytest
from faulty import changed, found, scaled, slowed, turned
from hypothesis import given, settings
from hypothesis import strategies as st
from motions.encounters import catch, throw
from motions.performers import CHILD, PERFORMERS, TALL_MAN, Performer
from motions.trials import Trial
from scipy.spatial.transform import Rotation

from capar.model.capture import UP, Conventions, upward

Motion = Callable[..., Trial]
PERFORMED = st.sampled_from([throw, catch])
PERFORMER = st.sampled_from(PERFORMERS)
RATE = st.sampled_from([60.0, 103.3, 240.0])


@settings(max_examples=6, deadline=None)
@given(motion=PERFORMED, performer=PERFORMER, rate_hz=RATE, seed=st.integers(0, 99))
def test_a_sound_flight_is_not_noticed(
    motion: Motion, performer: Performer, rate_hz: float, seed: int
) -> None:
    trial = motion(performer, rate_hz=rate_hz, noise_m=0.001, noise_rad=0.01, seed=seed)
    assert found(trial.capture) == []


@settings(max_examples=12, deadline=None)
@given(
    motion=PERFORMED,
    performer=PERFORMER,
    right=st.sampled_from(sorted(UP)),
    declared=st.sampled_from(sorted(UP)),
    seed=st.integers(0, 99),
)
def test_a_wrong_axis_is_noticed_with_the_right_one(
    motion: Motion, performer: Performer, right: str, declared: str, seed: int
) -> None:
    sound = motion(performer, noise_m=0.001, noise_rad=0.01, seed=seed).capture
    read = changed(sound, turned(upward(declared) * upward(right).inv()), Conventions(up=declared))
    axes = [dict(each.values)["up"] for each in found(read) if each.code == "up-contradicted"]
    assert axes == ([] if right == declared else [right] * len(axes))
    assert bool(axes) == (right != declared)


@pytest.mark.parametrize("motion", [throw, catch])
@pytest.mark.parametrize(("right", "declared"), [("mm", "m"), ("cm", "m"), ("mm", "cm")])
def test_a_wrong_unit_is_noticed_with_the_right_one(
    motion: Motion, right: str, declared: str
) -> None:
    metres = {"m": 1.0, "cm": 0.01, "mm": 0.001}
    factor = metres[declared] / metres[right]
    sound = motion(TALL_MAN, noise_m=0.0005).capture
    read = changed(sound, scaled(factor), Conventions(unit_m=metres[declared]))
    notices = [each for each in found(read) if each.code == "unit-contradicted"]
    assert {(each["unit"], each["declared"]) for each in notices} == {(right, declared)}


@pytest.mark.parametrize("factor", [0.5, 2.0, 3.0])
def test_a_wrong_rate_is_noticed_with_the_right_one(factor: float) -> None:
    sound = throw(CHILD, rate_hz=100.0, noise_m=0.0005).capture
    (each,) = [one for one in found(changed(sound, slowed(factor))) if one.code == "fall-rate"]
    assert each["rate_hz"] == pytest.approx(100.0, rel=0.03)
    assert each["declared_hz"] == pytest.approx(100.0 / factor, rel=1e-3)


def test_a_world_that_leans_has_no_axis_to_state() -> None:
    lean = Rotation.from_rotvec(np.radians([45.0, 0.0, 0.0]))
    sound = throw(TALL_MAN, noise_m=0.0005).capture
    (each,) = [one for one in found(changed(sound, turned(lean))) if one.code == "up-contradicted"]
    assert each["up"] == "" and each["angle_deg"] == pytest.approx(45.0, abs=3.0)
