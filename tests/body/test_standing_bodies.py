"""Fitted bodies stand: feet flat on the ground, unseen legs under the pelvis, unseen arms hang."""

from dataclasses import replace

import mink
import motions
import numpy as np
import pytest
from marker_people import walker
from motions.whole import walk
from scipy.spatial.transform import Rotation
from virtual_bodies.moving import swinging

from capar.body.anthropometry import ready_made
from capar.body.body_fitting import ground
from capar.body.human import Human
from capar.body.inverse_kinematics import GroundTask, UprightTask, standing_flat
from capar.body.joint_fitting import fit_joints
from capar.body.marker_fitting import fit_markers
from capar.body.sensor_fitting import Fit
from capar.views.viewer.stage import GROUND, stage, with_mannequin
from extractors.readers.names import SIDES, BodyName, body_names, convention

TIMES = np.arange(0.0, 2.0, 1.0 / 30.0)
LIMBS = ("upper_arm", "forearm", "thigh", "shank", "foot")
SEGMENTS = ("pelvis", "thorax_upper", "head", *(f"{s}_{name}" for s in SIDES for name in LIMBS))


def tilt(motion: np.ndarray, human: Human, segment: str) -> np.ndarray:
    """How far a segment leans from where it points in the standing posture [degrees]."""
    turns = Rotation.from_quat(human.sites(motion, [segment])[segment][1], scalar_first=True)
    return np.degrees(np.arccos(np.clip(turns.apply([0.0, 0.0, 1.0])[:, 2], -1.0, 1.0)))


def swaying() -> tuple[Human, np.ndarray]:
    """A woman whose arms and trunk swing and whose legs bend a little, her feet flat."""
    human = Human.of(ready_made("woman"))
    motion = swinging(human, TIMES, 5, still_s=0.2)
    for side in SIDES:
        for joint in ("hip_abduction", "hip_rotation", "ankle_inversion"):
            motion[:, human.index(f"{side}_{joint}")] = 0.0
        bend = np.radians(12.0 * np.sin(2.0 * TIMES) ** 2)
        motion[:, human.index(f"{side}_hip_flexion")] = bend
        motion[:, human.index(f"{side}_knee_flexion")] = 2.0 * bend
        motion[:, human.index(f"{side}_ankle_dorsiflexion")] = bend
    motion[:, 2] -= human.sites(motion, ["left_sole"])["left_sole"][0][:, 2]
    return human, motion


def clusters(human: Human, motion: np.ndarray) -> tuple[dict[str, np.ndarray], dict[str, BodyName]]:
    """Three markers somewhere on each segment, of which nothing but the segment is known."""
    rng = np.random.default_rng(2)
    points, names = {}, {}
    for segment, (places, turns) in human.sites(motion, SEGMENTS).items():
        frames = Rotation.from_quat(turns, scalar_first=True)
        length = -0.2 if segment.endswith(("arm", "thigh", "shank")) else 0.03
        for number in range(3):
            local = np.array([0.0, 0.0, length]) + rng.uniform(-0.06, 0.06, 3)
            name = f"{segment}_{number}"
            points[name] = frames.apply(local) + places
            names[name] = BodyName(name, segment, exact=False, by="a cluster")
    return points, names


def assert_derivatives(
    task: mink.Task, configuration: mink.Configuration, posture: np.ndarray
) -> None:
    """The Jacobian of a task at a posture is that of finite differences."""
    configuration.update(posture)
    error, jacobian = task.compute_error(configuration), task.compute_jacobian(configuration)
    for dof in range(configuration.model.nv):
        step = np.zeros(configuration.model.nv)
        step[dof] = 1e-6
        configuration.update(posture)
        configuration.integrate_inplace(step, 1.0)
        change = (task.compute_error(configuration) - error) / 1e-6
        np.testing.assert_allclose(change, jacobian[:, dof], atol=1e-5)


def test_the_jacobian_of_an_upright_segment_is_that_of_finite_differences() -> None:
    human, motion = swaying()
    configuration = mink.Configuration(human.model)
    assert_derivatives(UprightTask("left_foot", 1.0), configuration, motion[-1])


def test_places_are_kept_out_of_the_ground_and_are_free_above_it() -> None:
    human, motion = swaying()
    task = GroundTask(human.model, {"left_heel": 0.1, "right_toe_tip": -0.5}, 1.0)
    configuration = mink.Configuration(human.model)
    configuration.update(motion[-1])
    error, jacobian = task.compute_error(configuration), task.compute_jacobian(configuration)
    heel = human.sites(motion[-1:], ["left_heel"])["left_heel"][0][0, 2]
    assert error == pytest.approx([heel - 0.1, 0.0])
    assert not jacobian[1].any()
    assert_derivatives(task, configuration, motion[-1])


def test_toes_and_heels_do_not_go_into_the_ground() -> None:
    human, motion = swaying()
    known = convention("smpl").points
    where = human.sites(motion, set(known.values()))
    points = {name: where[place][0].copy() for name, place in known.items()}
    points["L_Toe"][30:40, 2] -= 0.12
    made = fit_joints(points, convention("smpl"), ground_m=0.0)
    tip = made.human.sites(made.motion, ["left_toe_tip"])["left_toe_tip"][0]
    assert tip[:, 2].min() > 0.0


def test_a_foot_stands_flat_while_it_is_on_the_ground_and_not_while_it_swings() -> None:
    points = walker()
    flat = standing_flat(points, {name: each.place for name, each in body_names(points).items()})
    lifted = points["RANK"][:, 2] - points["RANK"][0, 2]
    assert set(flat) == {"right", "left"}
    assert flat["right"][lifted < 0.001].all()
    assert not flat["right"][lifted > 0.03].any()


def test_feet_are_found_flat_from_markers_of_which_only_the_segment_is_known() -> None:
    human, motion = swaying()
    points, names = clusters(human, motion)
    made = fit_markers(points, names, ground_m=0.0).skeleton
    for side in SIDES:
        assert np.median(tilt(made.motion, made.human, f"{side}_foot")) < 3.0
        sole = made.human.sites(made.motion, [f"{side}_sole"])[f"{side}_sole"][0]
        assert np.abs(np.median(sole[:, 2])) < 0.02
        for joint, most in (("ankle_dorsiflexion", 15.0), ("hip_rotation", 15.0)):
            off = made.motion[:, human.index(f"{side}_{joint}")]
            off = off - motion[:, human.index(f"{side}_{joint}")]
            assert np.degrees(np.abs(np.median(off))) < most


@pytest.mark.parametrize("higher_m", [-0.02, 0.0, 0.035])
def test_soles_are_on_the_ground_wherever_a_skeleton_has_its_ankles(higher_m: float) -> None:
    human, motion = swaying()
    known = convention("smpl").points
    where = human.sites(motion, set(known.values()))
    points = {name: where[place][0] + [0.0, 0.0, higher_m] for name, place in known.items()}
    made = fit_joints(points, convention("smpl"), ground_m=0.0)
    for side in SIDES:
        sole = made.human.sites(made.motion, [f"{side}_sole"])[f"{side}_sole"][0]
        assert np.abs(np.median(sole[:, 2])) < 0.005
        assert np.median(tilt(made.motion, made.human, f"{side}_foot")) < 2.0
    assert made.median_m < 0.006


def test_whose_legs_are_not_seen_stands_while_the_trunk_bends() -> None:
    human = Human.of(ready_made("man"))
    motion = np.tile(human.posture(), (len(TIMES), 1))
    for level in ("lumbar_lower", "lumbar_upper", "thorax_lower", "thorax_upper"):
        motion[:, human.index(f"{level}_flexion")] = np.linspace(0.0, 0.18, len(TIMES))
    motion[:, 3:7] = Rotation.from_euler("y", 0.3 * TIMES[:, None] / TIMES[-1]).as_quat(
        scalar_first=True
    )
    places = ["c7", "t10", "sternum_top", "sternum_low", "right_acromion", "right_elbow_lateral",
              "right_wrist_radial", "right_wrist_ulnar"]  # fmt: skip
    points = {place: each[0] for place, each in human.sites(motion, places).items()}
    names = {place: BodyName(place, place, exact=True, by="a guide") for place in places}
    made = fit_markers(points, names).skeleton
    trunk = tilt(made.motion, made.human, "thorax_upper")
    assert trunk[-1] > 35.0
    for segment in ("right_foot", "left_foot"):
        assert tilt(made.motion, made.human, segment).max() < 3.0
    assert tilt(made.motion, made.human, "pelvis").max() < 25.0
    assert tilt(made.motion, made.human, "left_upper_arm").max() < 8.0
    feet = made.human.sites(made.motion, ["left_foot"])["left_foot"][0]
    assert np.ptp(feet, axis=0).max() < 0.03


def test_the_ground_of_a_capture_is_its_level_floor() -> None:
    capture = motions.drink_from_mug(motions.WOMAN).capture
    assert ground(replace(capture, objects=())) is None
    floor = capture.objects[0]
    walking = walk(motions.WOMAN).capture
    assert ground(walking) == pytest.approx(0.0, abs=1e-6)
    assert ground(replace(capture, objects=(floor,))) is None


def test_a_body_is_shown_on_an_assumed_ground_and_only_where_it_is_seen() -> None:
    capture = motions.drink_from_mug(motions.WOMAN).capture
    human = Human.of(ready_made("woman"))
    motion = np.tile(human.posture(place=(0.0, 0.0, 0.25)), (len(capture.times), 1))
    lost = dict.fromkeys(("hand", "head", "foot"), capture.times < 0.5)
    fit = Fit(human, capture.times, motion, lost, {}, {}, 0.0)
    shown = with_mannequin(stage(capture), fit)
    (plate,) = [body for body in shown.bodies if body.name == GROUND]
    assert plate.shape is not None
    top = plate.positions[0, 2] + np.array(plate.shape.vertices)[:, 2].max()
    assert top == pytest.approx(0.25, abs=0.003)
    (head,) = [body for body in shown.bodies if body.name == "body_head"]
    np.testing.assert_array_equal(np.isnan(head.positions[:, 0]), shown.times < 0.5)
    walking = stage(walk(motions.WOMAN).capture)
    frames = np.zeros(len(walking.times), dtype=int)
    still = Fit(human, walking.times, motion[frames], {}, {}, {}, 0.0)
    assert GROUND not in {body.name for body in with_mannequin(walking, still).bodies}
