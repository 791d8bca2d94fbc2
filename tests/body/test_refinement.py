"""A motion reveals its performer's limb lengths, and how well it does."""

import numpy as np
import pytest
from virtual_bodies.trials import (
    ARM,
    Trial,
    guessed,
    joint_errors_rad,
    measured,
    palm_errors_m,
    rms,
    virtual_trial,
)

from capar.body.human import Human
from capar.body.sensor_fitting import (
    NOISE_M,
    Fit,
    Refinement,
    RefinementError,
    fit,
    fit_refined,
    refine,
    worst_m,
)
from capar.body.sensors import Calibration, calibrate

pytestmark = pytest.mark.long


@pytest.fixture(scope="module", params=[0.97, 1.03])
def wrong_arms(request: pytest.FixtureRequest) -> tuple[Trial, Fit, Calibration, Refinement]:
    """A body whose arms were guessed 3 % off, fitted, and what its motion says."""
    trial = virtual_trial(seconds=4.0)
    body = Human.of(guessed(trial.human.measures, arms=request.param))
    found = calibrate(body, trial.streams)
    made = fit(body, trial.streams, found)
    return trial, made, found, refine(made, trial.streams, found, samples=40)


def test_palms_are_within_10_mm_though_the_arms_were_3_percent_wrong(
    wrong_arms: tuple[Trial, Fit, Calibration, Refinement],
) -> None:
    trial, _, _, better = wrong_arms
    made = fit(Human.of(better.measures), trial.streams, better.calibration)
    assert rms(palm_errors_m(trial, made)) < 0.010
    assert rms(joint_errors_rad(trial, made)) < np.radians(1.5)


def test_arm_lengths_are_found_within_their_stated_uncertainty(
    wrong_arms: tuple[Trial, Fit, Calibration, Refinement],
) -> None:
    trial, made, _, better = wrong_arms
    for name in ARM:
        true, before = trial.human.measures[name], made.human.measures[name]
        assert abs(better.measures[name] - true) < 0.5 * abs(before - true)
        assert abs(better.measures[name] - true) < 3.0 * better.measures.deviations[name]


def test_a_motion_adds_knowledge_and_never_takes_it_away(
    wrong_arms: tuple[Trial, Fit, Calibration, Refinement],
) -> None:
    *_, better = wrong_arms
    assert max(better.gained.values()) < 1.0 + 1e-9
    assert all(better.gained[name] < 0.9 for name in ARM)


def test_arms_measured_3_percent_wrong_do_no_harm_either() -> None:
    trial = virtual_trial(seconds=4.0)
    body = Human.of(measured(trial.human.measures, arms=1.03))
    found = calibrate(body, trial.streams)
    better = refine(fit(body, trial.streams, found), trial.streams, found, samples=40)
    made = fit(Human.of(better.measures), trial.streams, better.calibration)
    assert rms(palm_errors_m(trial, made)) < 0.010


@pytest.mark.parametrize("arms", [0.97, 1.03])
def test_arms_that_are_3_percent_wrong_are_refined_unasked(arms: float) -> None:
    trial = virtual_trial(seed=2)
    body = Human.of(guessed(trial.human.measures, arms=arms))
    found = calibrate(body, trial.streams)
    first, given = fit(body, trial.streams, found), fit_refined(body, trial.streams, found)
    assert worst_m(given) < worst_m(first)
    assert rms(palm_errors_m(trial, given)) < min(0.010, rms(palm_errors_m(trial, first)))


def test_a_body_that_fits_keeps_its_measures() -> None:
    trial = virtual_trial()
    body = Human.of(measured(trial.human.measures))
    found = calibrate(body, trial.streams, placed=(np.zeros(3), 0.0))
    given = fit_refined(body, trial.streams, found)
    assert worst_m(given) <= NOISE_M
    assert given.human.measures.values == body.measures.values


def test_too_short_a_motion_is_refused() -> None:
    trial = virtual_trial(seconds=0.6)
    found = calibrate(trial.human, trial.streams)
    made = fit(trial.human, trial.streams, found)
    few = {
        k: type(s)(s.times[:8], s.positions[:8], s.orientations[:8])
        for k, s in trial.streams.items()
    }
    with pytest.raises(RefinementError, match=r"8 frames.*ten are needed"):
        refine(made, few, found)
