"""A body fitted to noisy sensors moves as the true body did, and says what is left."""

import json
from dataclasses import replace
from functools import cache
from pathlib import Path
from typing import TypeAlias

import numpy as np
import pytest
from combinations import EVERY
from scipy.spatial.transform import Rotation
from typer.testing import CliRunner
from virtual_bodies.drinking import steps_of
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

from capar.body.anthropometry import Measures, ready_made
from capar.body.body_fitting import with_body_parts
from capar.body.human import Human
from capar.body.performing import RELAXED, Performance, perform
from capar.body.recording import record, truth_of, write_bundle
from capar.body.scripted_actions import performed
from capar.body.scripts import SIDES, touch
from capar.body.sensor_fitting import (
    NOISE_M,
    Fit,
    FitError,
    fit,
    fit_capture,
    fit_refined,
    refine,
    worn,
    worst_m,
)
from capar.body.sensors import (
    PERFECT,
    Calibration,
    CalibrationError,
    calibrate,
    places,
    sense,
    strap_on,
)
from capar.body.virtual_scenes import Thing, box, scene, table
from capar.cli import app
from capar.model.capture import Capture, Stream, TagType
from capar.model.errors import UnknownNameError
from capar.pipelines.observation import observe

pytestmark = pytest.mark.long

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


@pytest.mark.parametrize("who", ["woman", "child"])
def test_perfect_sensors_give_the_motion_back_for_any_body(who: str) -> None:
    trial = virtual_trial(who, tracker=PERFECT, seconds=2.0)
    made = fit(trial.human, trial.streams, calibrate(trial.human, trial.streams))
    assert rms(palm_errors_m(trial, made)) < 0.0015
    assert rms(joint_errors_rad(trial, made)) < np.radians(0.5)


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


@pytest.fixture(scope="module", params=[0.97, 1.03] if EVERY else [1.03])
def wrong_arms(request: pytest.FixtureRequest) -> tuple[Trial, Fit, tuple[Measures, Calibration]]:
    """A body whose arms were guessed 3 % off, fitted, and what its motion says."""
    trial = virtual_trial(seconds=4.0)
    body = Human.of(guessed(trial.human.measures, arms=request.param))
    found = calibrate(body, trial.streams)
    made = fit(body, trial.streams, found)
    return trial, made, refine(made, trial.streams, found, samples=40)


def test_palms_are_within_10_mm_though_the_arms_were_3_percent_wrong(
    wrong_arms: tuple[Trial, Fit, tuple[Measures, Calibration]],
) -> None:
    trial, _, (measures, calibration) = wrong_arms
    made = fit(Human.of(measures), trial.streams, calibration)
    assert rms(palm_errors_m(trial, made)) < 0.010
    assert rms(joint_errors_rad(trial, made)) < np.radians(1.5)


def test_arm_lengths_are_found_within_their_stated_uncertainty(
    wrong_arms: tuple[Trial, Fit, tuple[Measures, Calibration]],
) -> None:
    trial, made, (measures, _) = wrong_arms
    for name in ARM:
        true, before = trial.human.measures[name], made.human.measures[name]
        assert abs(measures[name] - true) < 0.5 * abs(before - true)
        assert abs(measures[name] - true) < 3.0 * measures.deviations[name]


def test_a_body_that_fits_keeps_its_measures() -> None:
    trial = virtual_trial()
    body = Human.of(measured(trial.human.measures))
    found = calibrate(body, trial.streams, placed=(np.zeros(3), 0.0))
    given = fit_refined(body, trial.streams, found)
    assert worst_m(given) <= NOISE_M
    assert given.human.measures.values == body.measures.values


Performed: TypeAlias = tuple[Performance, Capture]
"""What a virtual body did, and what was recorded of it."""


@pytest.fixture(scope="module")
def touching() -> Performed:
    """A man touches a crate, all eleven sensors on."""
    human = Human.of(ready_made("man"))
    crate = Thing("crate", box(0.15, 0.20, 0.15), (0.42, 0.10, 0.91))
    made = perform(human, scene(table(0.91, near_m=0.23), crate), touch("crate"), rate_hz=30.0)
    return made, record(made, name="touches", seed=2, sensors=tuple(places()))


def test_a_performers_capture_is_fitted_back_to_its_motion(touching: Performed) -> None:
    made, capture = touching
    assert set(worn(capture)) == set(places())
    ease = {f"{s}_{n}": float(np.radians(a)) for n, a in RELAXED.items() for s in SIDES}
    found = fit_capture(capture, angles=ease)
    palms = (
        h.sites(q, ["right_palm"])["right_palm"][0]
        for h, q in ((made.human, made.motion), (found.human, found.motion))
    )
    true, fitted = palms
    assert rms(np.linalg.norm(true - fitted, axis=1)) < 0.010
    for place in places():
        assert rms(found.residuals_m[place]) < 0.02


def test_the_command_says_what_is_left(touching: Performed, tmp_path: Path) -> None:
    made, capture = touching
    write_bundle(capture, truth_of(made), tmp_path / "touches")
    about = tmp_path / "touches" / "capture.toml"
    about.write_text(f"to_s = 1.0\n{about.read_text()}")
    told = CliRunner().invoke(app, ["fit", str(tmp_path / "touches")])
    assert told.exit_code == 0, told.output
    assert "right_elbow" in told.output
    assert "median_mm" in told.output
    asked = CliRunner().invoke(app, ["fit", str(tmp_path / "touches"), "--json"])
    answer = json.loads(asked.output)
    assert set(answer["sensors"]) == set(places())
    assert answer["seconds"] > 0.0


RATE_HZ = 60.0
TILTED = float(np.radians(12.0))


@pytest.mark.parametrize("who", ["man", "child"])
def test_who_bends_over_a_table_is_not_tilted_like_a_board(who: str) -> None:
    human = Human.of(ready_made(who))
    times = np.arange(0.0, 2.0, 1.0 / RATE_HZ)
    share = np.clip((times - 0.6) / 1.0, 0.0, 1.0) ** 2
    motion = np.tile(human.posture(), (len(times), 1))
    for joint in human.joints:
        if joint.startswith(("lumbar", "thorax")) and joint.endswith("flexion"):
            motion[:, human.index(joint)] = share * 0.6 * human.ranges[human.joints.index(joint), 1]
    for side in SIDES:
        motion[:, human.index(f"{side}_elbow_flexion")] = share * 1.2
    rng = np.random.default_rng(3)
    mounts = strap_on(human, ("right_hand", "left_hand", "head"), PERFECT, rng)
    streams = sense(human, times, motion, mounts, PERFECT, rng)
    made = fit(human, streams, calibrate(human, streams))
    places = made.human.sites(made.motion, ["pelvis", "right_sole", "left_sole"])
    up = Rotation.from_quat(places["pelvis"][1], scalar_first=True).apply([0.0, 0.0, 1.0])
    assert np.arccos(np.clip(up[:, 2], -1.0, 1.0)).max() < TILTED
    for side in SIDES:
        assert np.abs(places[f"{side}_sole"][0][:, 2]).max() < 0.03
    for metres in made.residuals_m.values():
        assert np.median(metres) < 0.005


WORN = ("right_hand", "left_hand", "head", "neck", "l5", "right_elbow", "left_elbow",
        "right_knee", "left_knee")  # fmt: skip


@cache
def stated() -> Capture:
    """Somebody who sips, with the shapes that a careful recording states."""
    done = performed("sip", rate_hz=30.0)
    return record(done, name="sip", seed=3, tracker=PERFECT, sensors=WORN)


@cache
def bare() -> tuple[Capture, Fit]:
    """Somebody who sips, recorded without shapes of hands and head and without SELF objects."""
    capture = stated()
    sensors = tuple(replace(each, shape=None) for each in capture.sensors)
    objects = tuple(each for each in capture.objects if each.tag is not TagType.SELF)
    stripped = replace(capture, sensors=sensors, objects=objects)
    return stripped, fit_capture(stripped)


def test_a_sip_at_the_fitted_head_is_told_like_one_at_the_stated_head() -> None:
    capture, made = bare()
    found = with_body_parts(capture, made)
    assert steps_of(observe(found)) == steps_of(observe(stated()))


def test_parts_of_which_nothing_is_recorded_are_not_added() -> None:
    capture, made = bare()
    found = with_body_parts(capture, made)
    own = [each for each in found.objects if each.tag is TagType.SELF]
    assert [each.name for each in own] == ["head"]
    assert {each.name for each in found.sensors if each.shape is not None} == {
        "right_hand",
        "left_hand",
    }
