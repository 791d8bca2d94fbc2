"""A fit warns of what a user can act on: names, units, floors, and what was not recorded."""

from dataclasses import replace
from pathlib import Path

import motions
import numpy as np
import pytest

from capar.body import body_fitting
from capar.body.anthropometry import ready_made
from capar.body.body_fitting import Places, fit_warnings
from capar.body.human import Human
from capar.body.point_fitting import with_markers
from capar.body.sensor_fitting import Fit
from capar.views.viewer.stage import stage, with_mannequin
from extractors.readers.names import BodyName

CAPTURE = motions.drink_from_mug(motions.WOMAN).capture
BARE = replace(CAPTURE, objects=())
WHOLE = {
    "hips": "pelvis", "chest": "thorax_upper", "skull": "head",
    **{f"{side} {n}": f"{side}_{n}" for side in ("right", "left") for n in ("hand", "foot")},
}  # fmt: skip


def fitted(segments: dict[str, str]) -> Fit:
    """A woman who stands, followed at places of segments."""
    human = Human.of(ready_made("woman"))
    motion = np.tile(human.posture(), (len(CAPTURE.times), 1))
    near = {name: np.full(len(motion), 0.002) for name in segments}
    return Fit(human, CAPTURE.times, motion, {}, near, {}, 0.0, segments)


@pytest.fixture
def warned(monkeypatch: pytest.MonkeyPatch) -> "Warned":
    return Warned(monkeypatch)


class Warned:
    """Warnings of a fit, by what the recording has of the body and of a floor."""

    def __init__(self, patch: pytest.MonkeyPatch) -> None:
        self.patch = patch

    def __call__(
        self, made: Fit, names: dict[str, BodyName] | None = None, floor_m: float | None = 0.0
    ) -> str:
        found = None if names is None else Places(made.times, {}, names)
        self.patch.setattr(body_fitting, "whole_body", lambda _: found)
        self.patch.setattr(body_fitting, "ground", lambda _: floor_m)
        return "\n".join(fit_warnings(Path(), BARE, made))


def test_of_a_body_that_stands_and_is_seen_everywhere_there_is_no_warning(warned: Warned) -> None:
    assert warned(fitted(WHOLE)) == ""


def test_large_residuals_are_named_with_their_peak_and_its_time(warned: Warned) -> None:
    made = fitted(WHOLE)
    off = np.full(len(made.times), 0.01)
    off[-1] = 0.0451
    text = warned(replace(made, residuals_m={**made.residuals_m, "chest": off}))
    assert f"chest by 45 mm at {made.times[-1]:.2f} s" in text
    assert "hips" not in text


def test_limbs_that_are_not_recorded_are_named_and_drawn_faint(warned: Warned) -> None:
    segments = {n: s for n, s in WHOLE.items() if n not in ("left hand", "right foot", "skull")}
    made = fitted(segments | {"right knee": "right_shank"})
    assert "assumed: right_foot, left_upper_arm, head" in warned(made)
    faint = {body.name for body in with_mannequin(stage(CAPTURE), made).bodies if body.faint}
    assert {"body_left_upper_arm", "body_left_hand", "body_right_foot", "body_head"} <= faint
    assert not {"body_right_shank", "body_right_hand", "body_left_foot"} & faint


@pytest.mark.parametrize(
    ("floor_m", "text"), [(None, "floor"), (-0.05, "floor and the unit: 50 mm")]
)
def test_a_missing_floor_and_soles_above_one_are_named(
    floor_m: float | None, text: str, warned: Warned
) -> None:
    assert text in warned(fitted(WHOLE), floor_m=floor_m)


def test_a_marker_far_from_its_landmark_is_named_and_one_on_it_is_not(warned: Warned) -> None:
    names = {"M": BodyName("M", "right_knee_lateral", exact=True, by="words")}
    plain = Human.of(ready_made("woman"))
    _, site = plain.frame("right_knee_lateral")
    where = plain.model.site_pos[site]
    for aside, text in ((0.0, ""), (0.05, "M by 50 mm")):
        human = with_markers(plain.measures, {"M": where + np.array([0.0, aside, 0.0])}, names)
        found = warned(replace(fitted(WHOLE | {"M": "right_thigh"}), human=human), names)
        assert text in found
        assert bool(found) == bool(text)
