"""Hands, heads and spines of other skeletons are turned and placed as their points tell."""

from pathlib import Path

import numpy as np
import pytest
from scipy.spatial.transform import Rotation
from virtual_bodies.moving import swinging

from capar.body.anthropometry import ready_made
from capar.body.body_fitting import fit_body
from capar.body.human import Human
from capar.body.joint_fitting import fit_joints, rigid_places, rigid_shape
from capar.body.point_fitting import SkeletonFit
from capar.model import geometry
from extractors.readers.bundle.capture_toml import read_capture
from extractors.readers.names import SIDES, convention

EXAMPLES = Path(__file__).parents[2] / "examples"

TIMES = np.arange(0.0, 1.5, 1.0 / 30.0)
KNUCKLES = {"index": "index_knuckle", "middle": "fingers", "little": "fifth_knuckle"}
STATED = {f"{side}_{n}": f"{side}_{place}" for side in SIDES for n, place in KNUCKLES.items()}
EYES = {f"{side} eye": f"{side}_eye" for side in SIDES}


def moved() -> tuple[Human, np.ndarray]:
    """A woman who moves all her joints, her hands open."""
    human = Human.of(ready_made("woman"))
    return human, swinging(human, TIMES, 6, still_s=0.2)


def recorded(human: Human, motion: np.ndarray, *, larger: float = 1.0) -> dict[str, np.ndarray]:
    """Her joints, knuckles and eyes; hands larger by a factor than her limbs tell."""
    places = dict(convention("smpl").points) | STATED | EYES
    where = human.sites(motion, set(places.values()))
    points = {name: where[place][0] for name, place in places.items()}
    for name in STATED:
        wrist = where[f"{name.partition('_')[0]}_hand"][0]
        points[name] = wrist + larger * (points[name] - wrist)
    return {name: each for name, each in points.items() if name not in ("L_Middle1", "R_Middle1")}


def turned_off(human: Human, motion: np.ndarray, made: SkeletonFit, segment: str) -> np.ndarray:
    """The angle between a segment's true and its fitted orientation [degrees]."""
    true = human.sites(motion, [segment])[segment][1]
    return np.degrees(
        geometry.angle_between(true, made.human.sites(made.motion, [segment])[segment][1])
    )


@pytest.mark.parametrize("larger", [0.9, 1.0, 1.15])
def test_hands_turn_as_their_knuckles_whatever_their_size(larger: float) -> None:
    human, motion = moved()
    points = recorded(human, motion, larger=larger)
    made = fit_joints(points, convention("smpl"), ground_m=0.0, stated=STATED | EYES)
    for side in SIDES:
        assert np.median(turned_off(human, motion, made, f"{side}_hand")) < 5.0
        wrist = made.residuals_m[f"{side[0].upper()}_Wrist"]
        assert np.median(wrist) < 0.01


def test_a_head_is_where_its_eyes_are() -> None:
    human, motion = moved()
    made = fit_joints(recorded(human, motion), convention("smpl"), stated=STATED | EYES)
    for name in EYES:
        assert np.median(made.residuals_m[name]) < 0.01
    assert np.median(turned_off(human, motion, made, "head")) < 8.0


def test_a_head_without_eyes_looks_where_the_face_looks() -> None:
    human, motion = moved()
    points = {name: each for name, each in recorded(human, motion).items() if name not in EYES}
    turns = Rotation.from_quat(human.sites(motion, ["head"])["head"][1], scalar_first=True)
    faces = turns.apply([1.0, 0.0, 0.0])
    faces[:5] = np.nan
    made = fit_joints(points, convention("smpl"), stated=STATED, faces=faces)
    own = made.human.sites(made.motion, ["head"])["head"][1]
    ahead = Rotation.from_quat(own, scalar_first=True).apply([1.0, 0.0, 0.0])
    off = np.degrees(np.arccos(np.clip((ahead * faces).sum(axis=1), -1.0, 1.0)))
    assert np.nanmedian(off) < 3.0


def test_places_stated_of_points_that_do_not_move_as_one_are_left_out() -> None:
    human, motion = moved()
    points = recorded(human, motion)
    points["right eye"] = points["L_Wrist"] + 0.01
    made = fit_joints(points, convention("smpl"), stated=STATED | EYES)
    assert not {*STATED, *EYES} & set(made.residuals_m)
    assert {"L_Wrist", "Head"} <= set(made.residuals_m)


def test_the_toes_of_a_foot_are_straight_ahead_of_its_ankle() -> None:
    human, motion = moved()
    points = recorded(human, motion)
    made = fit_joints(points, convention("smpl"), ground_m=0.0, stated=STATED | EYES)
    for letter in ("L", "R"):
        assert made.human.model.site(f"marker_{letter}_Toe").pos[1] == 0.0


def test_joints_of_the_toes_do_not_turn_the_toes_of_which_nothing_is_recorded() -> None:
    human, motion = moved()
    points = recorded(human, motion)
    rng = np.random.default_rng(8)
    for name in ("L_Toe", "R_Toe"):
        points[name] = points[name] + rng.normal(0.0, 0.01, points[name].shape)
    made = fit_joints(points, convention("smpl"), stated=STATED | EYES)
    for side in SIDES:
        angle = made.motion[:, made.human.index(f"{side}_toe_extension")]
        assert np.abs(angle).max() < np.radians(2.0)


def test_joints_of_a_spine_that_is_recorded_behind_the_back_are_put_into_the_trunk() -> None:
    human, motion = moved()
    points = recorded(human, motion)
    turns = Rotation.from_quat(human.sites(motion, ["pelvis"])["pelvis"][1], scalar_first=True)
    points["Torso"] = points["Torso"] + turns.apply([-0.15, 0.0, 0.0])
    made = fit_joints(points, convention("smpl"), stated=STATED | EYES)
    assert np.linalg.norm(made.human.model.site("marker_Torso").pos[:2]) < 0.0501
    assert made.residuals_m["Torso"].max() > 0.03


def test_a_shape_is_found_back_from_how_it_moves_and_none_from_what_bends() -> None:
    rng = np.random.default_rng(1)
    local = rng.uniform(-0.1, 0.1, (4, 3))
    turns = Rotation.from_rotvec(rng.normal(0.0, 0.5, (20, 3)))
    spots = rng.uniform(-1.0, 1.0, (20, 3))
    points = [turns.apply(each) + spots for each in local]
    shape = rigid_shape(points)
    assert shape is not None
    apart = [np.linalg.norm(one[:, None] - one[None], axis=2) for one in (shape, local)]
    np.testing.assert_allclose(apart[0], apart[1], atol=1e-9)
    points[0] = points[0] + np.linspace(0.0, 0.1, 20)[:, None]
    assert rigid_shape(points) is None


def test_rigid_places_of_a_body_are_its_own() -> None:
    human, motion = moved()
    places = STATED | {"R_Wrist": "right_hand", "L_Wrist": "left_hand"}
    where = human.sites(motion, {*places.values()})
    found = rigid_places(human, {name: where[p][0] for name, p in places.items()}, places)
    assert set(found) == set(places)
    np.testing.assert_allclose(found["R_Wrist"], 0.0, atol=1e-6)
    index = human.model.site("right_index_knuckle").pos
    np.testing.assert_allclose(found["right_index"], index, atol=1e-6)


@pytest.mark.usefixtures("recordings")
@pytest.mark.parametrize("clip", ["sub2_largetable_000", "sub2_woodchair_005"])
def test_recorded_eyes_are_in_the_head_and_recorded_knuckles_in_the_hands(clip: str) -> None:
    place = f"{EXAMPLES / 'omomo_intermimic'}:{clip}"
    made = fit_body(place, read_capture(place))
    for eye in ("L_Index2", "L_Index3"):
        assert np.median(made.residuals_m[eye]) < 0.015
    for knuckle in ("L_Middle1", "L_Pinky1", "L_Ring1", "R_Middle1", "R_Pinky1", "R_Ring1"):
        assert np.median(made.residuals_m[knuckle]) < 0.01


@pytest.mark.usefixtures("recordings")
def test_a_take_with_other_names_is_followed_by_its_convention_alone(tmp_path: Path) -> None:
    """Places are stated for names that are three joints off, which in this take they are not."""
    text = (EXAMPLES / "omomo_intermimic" / "capture.toml").read_text()
    place = tmp_path / "capture.toml"
    place.write_text(
        text.replace("sub2_largetable_000", "sub3_largebox_003")
        .replace("largetable", "largebox")
        .replace('L_Index1 = "Head"', 'L_Index1 = "L_Wrist"')
        .replace('L_Index2 = "Head"', 'L_Index2 = "L_Wrist"')
        .replace('L_Index3 = "Head"', 'L_Index3 = "L_Wrist"')
        .replace('R_Index1 = "L_Wrist"', 'R_Index1 = "R_Wrist"')
    )
    made = fit_body(f"{place}:sub3_largebox_003", read_capture(f"{place}:sub3_largebox_003"))
    assert not {"L_Index2", "L_Ring1"} & set(made.residuals_m)
    assert np.median(made.residuals_m["L_Wrist"]) < 0.01
