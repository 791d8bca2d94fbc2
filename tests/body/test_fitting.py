"""A body fitted to noisy sensors moves as the true body did."""

import numpy as np
import pytest
from virtual_bodies.trials import (
    Trial,
    joint_errors_rad,
    measured,
    palm_errors_m,
    rms,
    virtual_trial,
)

from capar.body.human import Human
from capar.body.sensor_fitting import Fit, FitError, fit
from capar.body.sensors import PERFECT, CalibrationError, Tracker, calibrate, places
from capar.model.capture import Stream
from capar.model.errors import UnknownNameError

ON_THE_MARKS = (np.zeros(3), 0.0)


def _cut(stream: Stream, first: int, last: int) -> Stream:
    spots, turns = stream.positions.copy(), stream.orientations.copy()
    spots[first:last], turns[first:last] = np.nan, np.nan
    return Stream(stream.times, spots, turns)


def _fastest(human: Human, motion: np.ndarray) -> float:
    """Largest step of the right palm from frame to frame [m]."""
    palm, _ = human.sites(motion, ["right_palm"])["right_palm"]
    return float(np.linalg.norm(np.diff(palm, axis=0), axis=1).max())


@pytest.fixture(scope="module")
def tracked() -> tuple[Trial, Fit]:
    trial = virtual_trial()
    body = Human.of(measured(trial.human.measures))
    return trial, fit(body, trial.streams, calibrate(body, trial.streams, placed=ON_THE_MARKS))


def test_eleven_noisy_sensors_give_palms_to_5_mm_and_joints_to_a_degree(
    tracked: tuple[Trial, Fit],
) -> None:
    trial, made = tracked
    assert len(trial.streams) == 11
    assert rms(palm_errors_m(trial, made)) < 0.005
    assert rms(joint_errors_rad(trial, made)) < np.radians(1.0)


def test_the_fit_respects_every_joint_range_and_says_what_is_left(
    tracked: tuple[Trial, Fit],
) -> None:
    trial, made = tracked
    assert not made.human.outside(made.motion, margin=1e-4).any()
    for place in trial.streams:
        assert 0.0 < rms(made.residuals_m[place]) < 0.005
        assert 0.0 < rms(made.residuals_rad[place]) < np.radians(2.0)
        assert not made.bridged[place].any()


def test_standing_on_no_marks_the_body_is_placed_by_its_sensors() -> None:
    errors = []
    for seed in (1, 2, 3):
        trial = virtual_trial(seed=seed, seconds=2.0)
        body = Human.of(measured(trial.human.measures))
        errors.append(
            palm_errors_m(trial, fit(body, trial.streams, calibrate(body, trial.streams)))
        )
    assert rms(np.concatenate(errors)) < 0.005


@pytest.mark.parametrize("who", ["woman", "child"])
def test_perfect_sensors_give_the_motion_back_for_any_body(who: str) -> None:
    trial = virtual_trial(who, tracker=PERFECT, seconds=2.0)
    made = fit(trial.human, trial.streams, calibrate(trial.human, trial.streams))
    assert rms(palm_errors_m(trial, made)) < 0.0015
    assert rms(joint_errors_rad(trial, made)) < np.radians(0.5)


@pytest.mark.parametrize("where", [["right_hand", "head"], ["right_hand", "l5", "neck"]])
def test_any_subset_of_sensors_is_followed(where: list[str]) -> None:
    trial = virtual_trial(where=where, seconds=2.0, tracker=PERFECT)
    made = fit(trial.human, trial.streams, calibrate(trial.human, trial.streams))
    for place in where:
        assert rms(made.residuals_m[place]) < 0.005
    assert np.isfinite(made.motion).all()


def test_a_long_loss_is_marked_and_bridged_without_a_jump() -> None:
    trial = virtual_trial(seconds=3.0)
    first, last = 150, 220
    streams = {**trial.streams, "right_hand": _cut(trial.streams["right_hand"], first, last)}
    made = fit(trial.human, streams, calibrate(trial.human, streams, placed=ON_THE_MARKS))
    np.testing.assert_array_equal(
        np.flatnonzero(made.bridged["right_hand"]), np.arange(first, last)
    )
    assert _fastest(made.human, made.motion) < 2.0 * _fastest(trial.human, trial.motion)
    whole = palm_errors_m(trial, made)
    left = whole[len(whole) // 2 :]
    assert rms(left) < 0.005


def test_a_short_loss_is_filled_and_not_marked() -> None:
    trial = virtual_trial(seconds=2.0, tracker=Tracker(dropouts_per_s=1.0, dropout_s=0.02))
    streams = {**trial.streams, "head": _cut(trial.streams["head"], 100, 105)}
    made = fit(trial.human, streams, calibrate(trial.human, streams, placed=ON_THE_MARKS))
    assert not made.bridged["head"][95:110].any()


def test_what_cannot_be_calibrated_is_said() -> None:
    trial = virtual_trial(seconds=1.0, where=["right_hand", "head"])
    human, streams = trial.human, trial.streams
    with pytest.raises(UnknownNameError, match="no place of a sensor 'elbow'"):
        calibrate(human, {"elbow": streams["head"]})
    with pytest.raises(CalibrationError, match="two or more place the body"):
        calibrate(human, {"head": streams["head"]})
    with pytest.raises(CalibrationError, match=r"'head' is lost throughout the first 0.4 s"):
        calibrate(human, {**streams, "head": _cut(streams["head"], 0, 60)})
    with pytest.raises(FitError, match="none of the sensors was calibrated"):
        fit(human, {"l5": streams["head"]}, calibrate(human, streams))
    assert len(places()) == 11
