"""Bodies follow other people's skeletons, key points and markers, and stand while they do."""

import json
import os
from pathlib import Path

import mink
import numpy as np
import pytest
from marker_people import walker, write_trc
from scipy.spatial.transform import Rotation
from typer.testing import CliRunner
from virtual_bodies.moving import swinging

from capar.body.anthropometry import ready_made
from capar.body.body_fitting import fit_body
from capar.body.fingers import closed_hands
from capar.body.human import Human
from capar.body.inverse_kinematics import DirectionTask, GroundTask, standing_flat
from capar.body.joint_fitting import fit_joints
from capar.body.marker_fitting import cluster_of, fit_markers, joint_centre
from capar.body.point_fitting import (
    PointFit,
    SkeletonError,
    fit_points,
    measures_from_points,
    with_legs,
)
from capar.cli import app
from capar.model import geometry
from capar.model.errors import UnknownNameError
from extractors.readers.bundle.capture_toml import read_capture
from extractors.readers.drafting.draft import draft
from extractors.readers.names import (
    SIDES,
    BodyName,
    Convention,
    ConventionError,
    body_names,
    convention,
    conventions,
    recognise,
)
from extractors.readers.registry import read_recording

DATA = Path(os.environ.get("CAPAR_DATA", Path(__file__).parents[3] / "shared" / "data"))
recorded = pytest.mark.skipif(not DATA.exists(), reason=f"no recordings at {DATA}")


def _own_points(name: str) -> tuple[Human, np.ndarray, dict[str, np.ndarray]]:
    """A woman's motion under another skeleton's names."""
    human = Human.of(ready_made("woman"))
    times = np.arange(0.0, 2.0, 1.0 / 30.0)
    motion = swinging(human, times, 4, still_s=0.2)
    named = convention(name).points
    places = human.sites(motion, set(named.values()))
    return human, motion, {point: places[place][0] for point, place in named.items()}


def follow(points: dict[str, np.ndarray], known: Convention) -> PointFit:
    """The body of a skeleton's own bones, drawn to its points."""
    places = known.named(points)
    human = Human.of(measures_from_points(points, places))
    return fit_points(human, points, places, known.weights)


JOINTS = sorted(name for name, each in conventions().items() if not each.markers)


@pytest.mark.parametrize("name", JOINTS)
def test_a_skeleton_is_known_by_its_names_and_the_body_follows_it(name: str) -> None:
    _, _, points = _own_points(name)
    assert set(recognise(points).named(points).values()) == set(convention(name).points.values())
    made = follow(points, convention(name))
    assert made.median_m < 0.010
    assert not made.human.outside(made.motion, margin=1e-4).any()


def test_names_of_no_convention_are_refused_with_the_nearest() -> None:
    with pytest.raises(ConventionError, match=r"nearest is '\w+', of which there are \d+%"):
        recognise(["mug", "table", "L_Hip"])
    with pytest.raises(UnknownNameError, match=r"no convention 'smlp'.*'smpl'"):
        convention("smlp")
    with pytest.raises(SkeletonError, match="four or more are needed"):
        fit_points(
            Human.of(ready_made("man")), {"L_Hip": np.zeros((3, 3))}, {"L_Hip": "left_thigh"}
        )


FRAMES = 80
RNG = np.random.default_rng(4)
LOCAL = RNG.uniform(-0.05, 0.05, (3, 3))


def jointed(
    swing_rad: float, noise_m: float, *, hinge: bool = False
) -> tuple[list[np.ndarray], list[np.ndarray], np.ndarray]:
    """Markers on two bodies that turn about a common point, and where this is [m].

    A hinge turns about an axis across its upper body only, which then turns about the same axis.
    """
    rng = np.random.default_rng(5)
    share = np.linspace(0.0, 2.0 * np.pi, FRAMES)
    centre = np.column_stack([0.8 * share, 0.1 * np.sin(share), 0.9 + 0.02 * np.cos(share)])
    upper = Rotation.from_rotvec(np.column_stack([0 * share, swing_rad * np.sin(share), 0 * share]))
    others = 0.0 if hinge else 0.8
    bend = np.column_stack(
        [others * np.cos(2.0 * share), np.cos(share), others * np.sin(2.0 * share)]
    )
    lower = upper * Rotation.from_rotvec(swing_rad * bend)
    above = [upper.apply(each + np.array([0.02, 0.03, 0.2])) + centre for each in LOCAL]
    below = [lower.apply(each + np.array([-0.03, 0.01, -0.2])) + centre for each in LOCAL]
    noisy = [
        [each + rng.normal(0.0, noise_m, each.shape) for each in one] for one in (above, below)
    ]
    return noisy[0], noisy[1], centre


def centre_of(above: list[np.ndarray], below: list[np.ndarray], guess: np.ndarray) -> np.ndarray:
    """Where the joint between two clusters of markers is found."""
    first, second = cluster_of(above), cluster_of(below)
    assert first is not None
    assert second is not None
    found = joint_centre(first, second, guess)
    assert found is not None
    return found


@pytest.mark.parametrize(("noise_m", "most_m"), [(0.0, 0.005), (0.001, 0.008)])
def test_a_guess_that_is_five_centimetres_off_is_corrected(noise_m: float, most_m: float) -> None:
    above, below, centre = jointed(0.5, noise_m)
    found = centre_of(above, below, centre + np.array([0.03, -0.03, 0.03]))
    assert np.median(np.linalg.norm(found - centre, axis=1)) < most_m


EXAMPLES = Path(__file__).parents[2] / "examples"

TIMES = np.arange(0.0, 2.0, 1.0 / 30.0)
KNUCKLES = {"index": "index_knuckle", "middle": "fingers", "little": "fifth_knuckle"}
STATED = {f"{side}_{n}": f"{side}_{place}" for side in SIDES for n, place in KNUCKLES.items()}
EYES = {f"{side} eye": f"{side}_eye" for side in SIDES}


def moved() -> tuple[Human, np.ndarray]:
    """A woman who moves all her joints, her hands open."""
    human = Human.of(ready_made("woman"))
    return human, swinging(human, TIMES, 6, still_s=0.2)


def of_skeleton(human: Human, motion: np.ndarray, *, larger: float = 1.0) -> dict[str, np.ndarray]:
    """Her joints, knuckles and eyes; hands larger by a factor than her limbs tell."""
    places = dict(convention("smpl").points) | STATED | EYES
    where = human.sites(motion, set(places.values()))
    points = {name: where[place][0] for name, place in places.items()}
    for name in STATED:
        wrist = where[f"{name.partition('_')[0]}_hand"][0]
        points[name] = wrist + larger * (points[name] - wrist)
    return {name: each for name, each in points.items() if name not in ("L_Middle1", "R_Middle1")}


def turned_off(human: Human, motion: np.ndarray, made: PointFit, segment: str) -> np.ndarray:
    """The angle between a segment's true and its fitted orientation [degrees]."""
    true = human.sites(motion, [segment])[segment][1]
    return np.degrees(
        geometry.angle_between(true, made.human.sites(made.motion, [segment])[segment][1])
    )


@pytest.mark.parametrize("larger", [0.9, 1.0, 1.15])
def test_hands_turn_as_their_knuckles_whatever_their_size(larger: float) -> None:
    human, motion = moved()
    points = of_skeleton(human, motion, larger=larger)
    made = fit_joints(points, convention("smpl"), ground_m=0.0, stated=STATED | EYES)
    for side in SIDES:
        assert np.median(turned_off(human, motion, made, f"{side}_hand")) < 5.0
        wrist = made.residuals_m[f"{side[0].upper()}_Wrist"]
        assert np.median(wrist) < 0.01


def test_a_head_without_eyes_looks_where_the_face_looks() -> None:
    human, motion = moved()
    points = {name: each for name, each in of_skeleton(human, motion).items() if name not in EYES}
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
    points = of_skeleton(human, motion)
    points["right eye"] = points["L_Wrist"] + 0.01
    made = fit_joints(points, convention("smpl"), stated=STATED | EYES)
    assert not {*STATED, *EYES} & set(made.residuals_m)
    assert {"L_Wrist", "Head"} <= set(made.residuals_m)


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


PLACES = (
    "c7", "sternum_top", "sternum_low", "t10", "sacrum", "right_asis", "left_asis",
    *(f"{side}_{name}" for side in ("right", "left") for name in (
        "head_front", "head_back", "acromion", "elbow_lateral", "wrist_radial", "wrist_ulnar",
        "hand_back", "trochanter", "knee_lateral", "ankle_lateral", "heel", "toe_tip",
    )),
)  # fmt: skip
RIDING = {"right_thigh": (0.05, -0.06, -0.2), "left_shank": (-0.03, 0.05, -0.15)}


def marked() -> tuple[Human, np.ndarray, dict[str, np.ndarray], dict[str, BodyName]]:
    """A woman's motion, her markers a centimetre off their landmarks, and two that ride along."""
    human = Human.of(ready_made("woman"))
    motion = swinging(human, np.arange(0.0, 1.5, 1.0 / 30.0), 4, still_s=0.2)
    rng = np.random.default_rng(3)
    points, names = {}, {}
    places = human.sites(motion, {*PLACES, *RIDING, "pelvis"})
    for place in PLACES:
        points[place] = places[place][0] + rng.normal(0.0, 0.0005, (len(motion), 3))
        names[place] = BodyName(place, place, exact=True, by="a guide")
    for segment, local in RIDING.items():
        at, turn = places[segment]
        points[segment] = geometry.transforms(at, turn).apply(np.tile(local, (len(at), 1)))
        names[segment] = BodyName(segment, segment, exact=False, by="a guide")
    return human, motion, points, names


def test_a_body_is_found_back_from_its_markers_with_its_size_and_their_places() -> None:
    human, motion, points, names = marked()
    points["c7"][:10] = np.nan
    made = fit_markers(points, names)
    assert made.median_m < 0.005
    for limb in ("upper_arm", "shank"):
        assert made.human.measures[limb] == pytest.approx(human.measures[limb], rel=0.05)
    for joint in ("right_hand", "left_foot", "right_forearm"):
        true = human.sites(motion, [joint])[joint][0]
        found = made.human.sites(made.motion, [joint])[joint][0]
        assert float(np.median(np.linalg.norm(true - found, axis=1))) < 0.03
    assert np.isnan(made.residuals_m["c7"][:10]).all()
    assert not made.human.outside(made.motion, margin=1e-4).any()


def test_legs_without_landmarks_are_as_long_as_their_clusters_move() -> None:
    usual = ready_made("woman")
    longer = {"thigh": 1.08 * usual["thigh"], "shank": 1.06 * usual["shank"]}
    human = Human.of(with_legs(usual, longer))
    motion = swinging(human, np.arange(0.0, 4.0, 1.0 / 30.0), 4, still_s=0.2)
    above = [place for place in PLACES if not place.endswith(("trochanter", "knee_lateral"))]
    above = [place for place in above if "ankle" not in place]
    legs = [f"{side}_{part}" for side in ("right", "left") for part in ("thigh", "shank", "foot")]
    where = human.sites(motion, {*above, *legs})
    points = {place: where[place][0] for place in above}
    names = {place: BodyName(place, place, exact=True, by="a guide") for place in above}
    rng = np.random.default_rng(6)
    for segment in legs:
        at, turn = where[segment]
        for number in range(3):
            local = rng.uniform(-0.05, 0.05, 3) - [0.0, 0.0, 0.02 if "foot" in segment else 0.2]
            name = f"{segment}_{number}"
            points[name] = geometry.transforms(at, turn).apply(np.tile(local, (len(at), 1)))
            names[name] = BodyName(name, segment, exact=False, by="a guide")
    made = fit_markers(points, names)
    for leg, length in longer.items():
        assert made.human.measures[leg] == pytest.approx(length, rel=0.035), leg


@recorded
@pytest.mark.parametrize(
    "file, median_m", [("walk_free_01.trc", 0.006), ("std_walking2_markers.trc", 0.006)]
)
def test_recorded_walks_are_followed_and_told_by_marker(
    file: str, median_m: float, tmp_path: Path
) -> None:
    source = DATA / "foreign_files" / file
    (tmp_path / "capture.toml").write_text(draft([read_recording(source)], tmp_path, "walk"))
    asked = CliRunner().invoke(app, ["fit", str(tmp_path), "--json"])
    assert asked.exit_code == 0, asked.output
    answer = json.loads(asked.output)
    assert answer["median_mm"] < 1e3 * median_m
    assert 1.4 < answer["stature_m"] < 1.95
    assert len(answer["sensors"]) >= 16


@pytest.fixture(scope="module")
def walking(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The capture of somebody who walks with Plug-in Gait markers on, from its draft."""
    folder = tmp_path_factory.mktemp("walk")
    write_trc(folder / "walk.trc", {name: 1000.0 * at[100:160] for name, at in walker().items()})
    text = draft([read_recording(folder / "walk.trc")], folder, "walk")
    (folder / "capture.toml").write_text(text)
    return folder


def test_a_fit_is_exported_and_its_bvh_reads_back(walking: Path) -> None:
    forms = ("bvh", "glb", "npz", "csv", "mjcf")
    files = {form: walking / f"walk_{form}.{form}" for form in forms}
    options = [word for form, path in files.items() for word in (f"--{form}", str(path))]
    asked = CliRunner().invoke(app, ["fit", str(walking), "--json", *options])
    assert asked.exit_code == 0, asked.output
    assert all(path.stat().st_size for path in files.values())
    joints = read_recording(files["bvh"]).bodies
    markers = read_recording(walking / "walk.trc").markers
    ankles = (markers["RANK"][30], markers["LANK"][30])
    feet = [joints[f"{side}_foot"].positions[30][[2, 0, 1]] * 10.0 for side in ("right", "left")]
    for ankle, foot in zip(ankles, feet, strict=True):
        assert np.linalg.norm(ankle - foot) < 70.0  # the joint is half a foot's breadth inside
    again = draft([read_recording(files["bvh"])], walking, "again")
    assert 'unit = "cm"' in again
    assert 'up = "y"' in again
    assert again.count("[[sensor]]") == 5


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
    assert_derivatives(DirectionTask("left_foot", 1.0), configuration, motion[-1])


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
    made = fit_markers(points, names, ground_m=0.0)
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
    made = fit_markers(points, names)
    trunk = tilt(made.motion, made.human, "thorax_upper")
    assert trunk[-1] > 35.0
    for segment in ("right_foot", "left_foot"):
        assert tilt(made.motion, made.human, segment).max() < 3.0
    assert tilt(made.motion, made.human, "pelvis").max() < 25.0
    assert tilt(made.motion, made.human, "left_upper_arm").max() < 8.0
    feet = made.human.sites(made.motion, ["left_foot"])["left_foot"][0]
    assert np.ptp(feet, axis=0).max() < 0.03


HUMAN = Human.of(ready_made("woman"))
HAND_FRAMES = 5
KNUCKLE, MIDDLE = 0.5, 0.9
BONES_M = (0.04, 0.025)


def of_hand(side: str) -> tuple[np.ndarray, dict[str, np.ndarray], dict[str, BodyName]]:
    """A body with one arm raised, and the joints of two bent fingers of that hand."""
    angles = {f"{side}_shoulder_flexion": 1.0, f"{side}_forearm_pronation": 0.6}
    motion = np.tile(HUMAN.posture(angles), (HAND_FRAMES, 1))
    bent = {f"{side}_knuckle_flexion": KNUCKLE, f"{side}_finger_flexion": MIDDLE}
    closed = np.tile(HUMAN.posture(angles | bent), (HAND_FRAMES, 1))
    parts = [f"{side}_{part}" for part in ("hand", "fingers", "fingertips")]
    where = HUMAN.sites(closed, parts)
    wrist = where[parts[0]][0]
    points, names = {"wrist": wrist}, {}
    for finger, aside in (("index", 0.02), ("ring", -0.02)):
        turns = [geometry.rotations(where[part][1]) for part in parts]
        first = where[parts[1]][0] + turns[0].apply([aside, 0.0, 0.0])
        second = first + turns[1].apply([0.0, 0.0, -BONES_M[0]])
        chain = (first, second, second + turns[2].apply([0.0, 0.0, -BONES_M[1]]))
        points |= {f"{finger}_{number}": at for number, at in enumerate(chain)}
    for name in points:
        place = f"{side}_hand" if name == "wrist" else f"{side}_fingers"
        names[name] = BodyName(name, place, exact=False, by="its words")
    return motion, points, names


@pytest.mark.parametrize("side", ["right", "left"])
def test_fingers_are_bent_as_recorded_on_either_side(side: str) -> None:
    motion, points, names = of_hand(side)
    points["ring_2"][2] = np.nan
    made = closed_hands(HUMAN, motion, points, names)
    for hinge, expected in (("knuckle_flexion", KNUCKLE), ("finger_flexion", MIDDLE)):
        np.testing.assert_allclose(
            made[:, HUMAN.index(f"{side}_{hinge}")], expected, atol=1e-6, err_msg=hinge
        )
    changed = {int(number) for number in np.flatnonzero((made != motion).any(axis=0))}
    assert changed == {HUMAN.index(f"{side}_{n}_flexion") for n in ("knuckle", "finger")}


def test_points_that_do_not_begin_on_the_hand_close_nothing() -> None:
    motion, points, names = of_hand("right")
    away = np.linspace(0.0, 0.4, HAND_FRAMES)[:, None] * [1.0, 0.0, 0.0]
    far = {name: at + away if name != "wrist" else at for name, at in points.items()}
    np.testing.assert_array_equal(closed_hands(HUMAN, motion, far, names), motion)


def test_a_thumb_that_begins_where_fingers_do_is_another_finger() -> None:
    motion, points, names = of_hand("right")
    names |= {
        f"thumb_{n}": BodyName(f"thumb_{n}", "right_thumb", exact=False, by="") for n in (0, 1)
    }
    thumb = HUMAN.index("right_thumb_opposition")
    points |= {f"thumb_{n}": points[f"index_{n}"] for n in (0, 1)}
    assert not closed_hands(HUMAN, motion, points, names)[:, thumb].any()
    points |= {f"thumb_{n}": 0.5 * (points["wrist"] + points[f"index_{n}"]) for n in (0, 1)}
    assert closed_hands(HUMAN, motion, points, names)[:, thumb].any()
