"""What is said of a fit: large residuals, what is not recorded or assumed, unusual postures."""

from dataclasses import replace

import motions
import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from capar.body.anthropometry import ready_made
from capar.body.fit_warnings import (
    passing_legs,
    recorded_feet,
    recorded_spine,
    remarks,
    stand_off,
)
from capar.body.human import Human
from capar.body.marker_fitting import with_markers
from capar.body.sensor_fitting import Fit
from capar.model.capture import Capture
from capar.model.notices import notice
from capar.views.viewer.stage import stage, with_mannequin
from extractors.readers.names import BodyName

CAPTURE = motions.drink_from_mug(motions.WOMAN).capture
BARE = replace(CAPTURE, objects=())
WHOLE = {
    "hips": "pelvis", "chest": "thorax_upper", "skull": "head",
    **{f"{side} {n}": f"{side}_{n}" for side in ("right", "left") for n in ("hand", "foot")},
}  # fmt: skip


def fitted(segments: dict[str, str], **angles: float) -> Fit:
    """A woman who stands with some joints bent [rad], followed at places of segments."""
    human = Human.of(ready_made("woman"))
    motion = np.tile(human.posture(angles), (len(CAPTURE.times), 1))
    near = {name: np.full(len(motion), 0.002) for name in segments}
    return Fit(human, CAPTURE.times, motion, {}, near, {}, 0.0, segments)


def told(made: Fit, capture: Capture = BARE, floor_m: float | None = 0.0) -> str:
    """All remarks as one text."""
    return "\n".join(remarks(made, capture, floor_m))


def test_of_a_body_that_stands_and_is_seen_everywhere_nothing_is_said() -> None:
    assert told(fitted(WHOLE, right_shoulder_abduction=0.4, left_shoulder_abduction=0.4)) == ""


def test_large_residuals_are_said_with_their_peak_its_time_and_their_share() -> None:
    made = fitted(WHOLE)
    off = np.full(len(made.times), 0.01)
    off[-1] = 0.0451
    far = replace(made, residuals_m={**made.residuals_m, "chest": off})
    text = told(far)
    assert "farther than 30 mm from their places on the body: chest by up to 45 mm" in text
    assert f"at {made.times[-1]:.2f} s (" in text
    assert "hips" not in text


def test_limbs_that_are_not_recorded_are_named_and_drawn_faint() -> None:
    segments = {
        n: each for n, each in WHOLE.items() if n not in ("left hand", "right foot", "skull")
    }
    made = fitted(segments | {"right knee": "right_shank"})
    assert "not recorded, and drawn faint: right foot, left arm, head" in told(made)
    faint = {body.name for body in with_mannequin(stage(CAPTURE), made).bodies if body.faint}
    assert {"body_left_upper_arm", "body_left_hand", "body_right_foot", "body_head"} <= faint
    assert not {"body_right_shank", "body_right_hand", "body_left_foot"} & faint


def test_assumed_things_and_a_missing_floor_are_said() -> None:
    table = replace(CAPTURE.objects[0], assumed="a plate under the mug")
    text = told(fitted(WHOLE), replace(CAPTURE, objects=(table,)), None)
    assert f"{table.name} is assumed: a plate under the mug" in text
    assert "the recording has no floor" in text
    (shown,) = [
        body for body in stage(replace(CAPTURE, objects=(table,))).bodies if body.name == table.name
    ]
    assert shown.faint
    assert shown.label == f"{table.name} (assumed)".replace("_", " ")


@pytest.mark.parametrize(
    ("angles", "expected"),
    [
        ({"left_knee_flexion": 0.5}, "the left knee is never straighter than 29 degrees"),
        ({"right_hip_rotation": -0.5, "left_hip_rotation": -0.5}, "feet point 57 degrees apart"),
        ({"lumbar_upper_flexion": -0.3, "lumbar_lower_flexion": -0.2}, "backwards by up to 29"),
        ({"right_shoulder_abduction": -0.2}, "right hand is up to"),
    ],
)
def test_unusual_postures_are_said(angles: dict[str, float], expected: str) -> None:
    assert expected in told(fitted(WHOLE, **angles))


def test_soles_above_the_floor_are_said() -> None:
    assert "the lower sole is 50 mm above the floor" in told(fitted(WHOLE), floor_m=-0.05)


def test_a_recorded_spine_that_kinks_is_said_and_a_straight_one_is_not() -> None:
    made = fitted({"P": "pelvis", "T": "lumbar_lower", "S": "thorax_lower", "N": "neck"})
    heights = {"P": 0.9, "T": 1.0, "S": 1.2, "N": 1.4}
    points = {n: np.tile([0.0, 0.0, z], (len(made.times), 1)) for n, z in heights.items()}
    assert recorded_spine(made, points) == []
    points["S"][-1], points["N"][-1] = [0.2, 0.0, 1.0], [0.4, 0.0, 1.0]
    (line,) = recorded_spine(made, points)
    assert line.startswith("the recorded spine bends by up to 90 degrees at T")
    markers = replace(made, segments={**made.segments, "T2": "lumbar_lower"})
    assert recorded_spine(markers, points) == []


def test_a_line_between_points_of_a_foot_that_is_not_its_sole_is_said_with_its_angle() -> None:
    made = fitted({"ankle": "right_foot", "ball": "right_toes"})
    here = made.human.sites(made.motion, ["right_foot"])["right_foot"][0]
    drop = -0.1 * np.tan(np.radians(20.0))
    ball = here + np.array([0.1, 0.0, drop])
    (line,) = recorded_feet(made, {"ankle": here, "ball": ball})
    assert line.startswith("the line from ankle to ball is not the right sole: it lies at 20 deg")
    assert recorded_feet(made, {"ankle": here, "ball": here + np.array([0.1, 0.0, 0.0])}) == []


def test_a_marker_far_from_its_landmark_is_said_and_one_on_it_is_not() -> None:
    names = {"M": BodyName("M", "right_knee_lateral", exact=True, by="words")}
    plain = Human.of(ready_made("woman"))
    where = next(
        plain.model.site_pos[number]
        for number in range(plain.model.nsite)
        if plain.model.site(number).name == "right_knee_lateral"
    )
    said = []
    for aside in (0.0, 0.05):
        human = with_markers(plain.measures, {"M": where + np.array([0.0, aside, 0.0])}, names)
        said.append(stand_off(replace(fitted({"M": "right_thigh"}), human=human), names))
    assert said[0] == []
    assert "the worst of each part: M by 50 mm (right thigh)" in said[1][0]


def test_a_body_whose_bone_changes_its_length_is_shown_as_a_point() -> None:
    name = next(body.name for body in stage(CAPTURE).bodies if body.shape is not None)
    said = notice("bone-stretches", name, "a", "b", shortest_m=0.1, longest_m=0.9)
    shapes = {body.name: body.shape for body in stage(replace(CAPTURE, notices=(said,))).bodies}
    assert shapes[name] is None
    assert sum(shape is not None for shape in shapes.values()) > 1


def test_a_head_that_is_drawn_as_a_point_is_told_with_where_it_is_and_how_the_neck_is_bent() -> (
    None
):
    made = fitted(WHOLE, neck_flexion=0.1, head_flexion=-0.2)
    eyes, turns = made.human.sites(made.motion, ["between_eyes"])["between_eyes"]
    below = Rotation.from_quat(turns, scalar_first=True).apply([-0.025, 0.0, -0.076])
    head = next(sensor for sensor in CAPTURE.sensors if sensor.end_effector == "head")
    tracked = replace(head, shape=None, stream=replace(head.stream, positions=eyes + below))
    text = told(made, replace(BARE, sensors=(tracked,)))
    assert f"{head.name} is drawn as a point" in text
    assert "25 mm behind and 76 mm below the middle between this body's eyes" in text
    assert "with the head on it, bent forwards by -6 to -6 (-6 at 0.00 s) degrees" in text
    assert "sideways by 0 to 0 (0 at 0.00 s)" in text
    assert "drawn as a point" not in told(made)


def test_a_back_that_is_bent_sideways_or_turned_far_is_said() -> None:
    text = told(
        fitted(
            WHOLE,
            lumbar_lower_bend=0.2,
            thorax_lower_bend=0.2,
            thorax_lower_turn=0.2,
            thorax_upper_turn=0.2,
        )
    )
    assert "the back is bent sideways by up to 23 degrees, at 0.00 s and turned by up to 23" in text


def test_a_neck_that_is_bent_far_is_said_with_the_time() -> None:
    made = fitted(WHOLE, neck_bend=0.3, head_bend=0.2)
    assert "is bent sideways by up to 29 degrees, at 0.00 s" in told(made)


def test_of_a_head_that_is_not_recorded_it_is_said_how_near_the_hands_come() -> None:
    made = fitted({name: part for name, part in WHOLE.items() if part != "head"})
    text = told(made)
    where = made.human.sites(made.motion[:1], ["right_fingertip", "neck"])
    below = 1e3 * np.linalg.norm(where["right_fingertip"][0][0] - where["neck"][0][0])
    (line,) = [line for line in text.splitlines() if line.startswith("the right hand comes no")]
    assert below - 400.0 < float(line.split("neck than ")[1].split(" mm")[0]) < below
    assert "comes no nearer" not in told(fitted(WHOLE))


def test_legs_that_pass_each_other_are_said_with_the_times() -> None:
    made = fitted({"ankle": "right_foot", "other": "left_foot"})
    times = np.linspace(0.0, 2.0, len(made.times))
    motion = made.motion.copy()
    swing = 0.4 * np.cos(2.0 * np.pi * (times - 0.1) / 1.6)
    motion[:, made.human.index("right_hip_flexion")] = swing.clip(-0.3, 0.4)
    motion[:, made.human.index("left_hip_flexion")] = -swing.clip(-0.4, 0.3)
    (line,) = passing_legs(replace(made, times=times, motion=motion))
    first, last = (float(word) for word in line.split(" at ")[1].split(" s:")[0].split(" and "))
    assert first == pytest.approx(0.5, abs=0.05)
    assert last == pytest.approx(1.3, abs=0.05)
    assert passing_legs(made) == []


def test_a_chest_that_leans_is_said_with_the_time() -> None:
    made = fitted(WHOLE)
    motion = made.motion.copy()
    motion[-1, 3:7] = [np.cos(0.25), 0.0, np.sin(0.25), 0.0]
    text = told(replace(made, motion=motion))
    assert f"leans from upright by up to 29 degrees, at {made.times[-1]:.2f} s" in text
    assert "leans" not in told(made)


def test_toes_that_point_up_are_said_with_the_times() -> None:
    made = fitted(WHOLE)
    motion = made.motion.copy()
    frames = [len(motion) // 4, len(motion) // 2]
    motion[frames, made.human.index("right_ankle_dorsiflexion")] = np.radians([18.0, 24.0])
    text = told(replace(made, motion=motion))
    first, last = made.times[frames]
    assert (
        f"right foot's toes point up by up to 24 degrees, at {first:.2f} and {last:.2f} s" in text
    )
    assert "left foot's toes" not in text
