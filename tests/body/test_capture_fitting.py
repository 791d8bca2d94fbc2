"""A capture is fitted through the names of its sensors, from Python and from the command line."""

import json
from pathlib import Path
from typing import TypeAlias

import numpy as np
import pytest
from typer.testing import CliRunner
from virtual_bodies.trials import rms

from capar.body.anthropometry import ready_made
from capar.body.human import Human
from capar.body.performing import RELAXED, Performance, perform
from capar.body.recording import record, truth_of, write_bundle
from capar.body.scenes import Thing, box, scene, table
from capar.body.scripts import SIDES, touch
from capar.body.sensor_fitting import FitError, fit_capture, worn
from capar.body.sensors import places
from capar.cli import app
from capar.model import geometry
from capar.model.capture import Capture, Sensor

Performed: TypeAlias = tuple[Performance, Capture]
"""What a virtual body did, and what was recorded of it."""


@pytest.fixture(scope="module")
def performed() -> Performed:
    """A man touches a crate, all eleven sensors on."""
    human = Human.of(ready_made("man"))
    crate = Thing("crate", box(0.15, 0.20, 0.15), (0.42, 0.10, 0.91))
    made = perform(human, scene(table(0.91, near_m=0.23), crate), touch("crate"), rate_hz=60.0)
    return made, record(made, name="touches", seed=2, sensors=tuple(places()))


def test_a_performers_capture_is_fitted_back_to_its_motion(performed: Performed) -> None:
    made, capture = performed
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


def test_the_command_says_what_is_left(performed: Performed, tmp_path: Path) -> None:
    made, capture = performed
    write_bundle(capture, truth_of(made), tmp_path / "touches")
    told = CliRunner().invoke(app, ["fit", str(tmp_path / "touches")])
    assert told.exit_code == 0, told.output
    assert "right_elbow" in told.output
    assert "fitted in" in told.output
    asked = CliRunner().invoke(app, ["fit", str(tmp_path / "touches"), "--json"])
    answer = json.loads(asked.output)
    assert set(answer["sensors"]) == set(places())
    assert answer["seconds"] > 0.0


def test_sensors_on_no_place_of_the_body_are_refused(performed: Performed) -> None:
    _, capture = performed
    stray = Sensor("wand", "wand", "none", "wand", capture.sensors[0].stream)
    with pytest.raises(FitError, match=r"none of the sensors \(wand\) is on a known place"):
        fit_capture(Capture("stray", (stray,), ()))


def test_a_trunk_that_only_hands_and_head_tell_of_leans_no_further_than_it_did(
    performed: Performed,
) -> None:
    made, _ = performed
    three = record(made, name="three", seed=3, sensors=("right_hand", "left_hand", "head"))
    found = fit_capture(three)
    true, fitted = (
        geometry.rotations(h.sites(q, ["thorax_upper"])["thorax_upper"][1]).apply([0.0, 0.0, 1.0])
        for h, q in ((made.human, made.motion), (found.human, found.motion))
    )
    leaning, own = (
        np.degrees(np.arccos(np.clip(each[:, 2], -1.0, 1.0))) for each in (fitted, true)
    )
    assert leaning.max() < own.max() + 8.0
    assert np.median(np.abs(leaning - own)) < 6.0
    for metres in found.residuals_m.values():
        assert metres.max() < 0.025
