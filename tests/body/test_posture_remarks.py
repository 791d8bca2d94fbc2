"""What is said of arms, of feet at each other and of recorded shapes that stand off the body."""

from dataclasses import replace

import motions
import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from capar.body.anthropometry import ready_made
from capar.body.fit_warnings import posture_remarks
from capar.body.human import Human
from capar.body.scenes import box
from capar.body.sensor_fitting import Fit
from capar.model.capture import Capture

CAPTURE = motions.drink_from_mug(motions.WOMAN).capture
HUMAN = Human.of(ready_made("woman"))
SEGMENTS = {
    "hips": "pelvis",
    **{f"{side} {n}": f"{side}_{n}" for side in ("right", "left") for n in ("hand", "foot")},
}
BARE = replace(CAPTURE, sensors=tuple(replace(sensor, shape=None) for sensor in CAPTURE.sensors))


def posed(**angles: float) -> Fit:
    """A woman who stands upright, and at the last moment has some joints bent [rad]."""
    motion = np.tile(HUMAN.posture(), (len(CAPTURE.times), 1))
    motion[-1] = HUMAN.posture(angles)
    return Fit(HUMAN, CAPTURE.times, motion, {}, {}, {}, 0.0, SEGMENTS)


def told(made: Fit, capture: Capture = BARE) -> str:
    """All sentences as one text."""
    return "\n".join(posture_remarks(made, capture))


def test_of_a_body_that_stands_with_its_arms_down_nothing_is_said() -> None:
    assert told(posed(right_hip_abduction=0.2, left_hip_abduction=0.2)) == ""


@pytest.mark.parametrize(
    ("angles", "expected"),
    [
        ({"right_shoulder_abduction": 1.0}, "the right upper arm is up to 57 degrees from hanging"),
        (
            {"left_shoulder_flexion": -0.6},
            "the left upper arm is up to 34 degrees behind the plane",
        ),
    ],
)
def test_raised_arms_are_said_with_the_time(angles: dict[str, float], expected: str) -> None:
    text = told(posed(**angles))
    assert expected in text
    assert f"at {CAPTURE.times[-1]:.2f} s: as shoulders and elbows are recorded" in text


def test_feet_that_overlap_are_said_with_how_far() -> None:
    text = told(posed(right_hip_abduction=-0.09, left_hip_abduction=-0.09))
    (line,) = [line for line in text.splitlines() if line.startswith("the drawn feet overlap")]
    assert f"at {CAPTURE.times[-1]:.2f} s" in line


def test_a_recorded_foot_beside_the_bodys_is_said_with_how_far_and_where() -> None:
    side = next(sensor.side for sensor in CAPTURE.sensors if sensor.end_effector == "hand")
    where = HUMAN.sites(posed().motion, [f"{side}_sole", f"{side}_foot"])
    out = -1.0 if side == "right" else 1.0
    half_m = 0.01
    place = where[f"{side}_sole"][0] + [0.0, out * 0.12, 0.02]
    hand = next(sensor for sensor in CAPTURE.sensors if sensor.end_effector == "hand")
    turns = Rotation.identity(len(place)).as_quat(scalar_first=True)
    stream = replace(hand.stream, positions=place, orientations=turns)
    small = box(2 * half_m, 2 * half_m, 2 * half_m)
    foot = replace(hand, end_effector="foot", shape=small, stream=stream)
    made = replace(posed(), motion=np.tile(HUMAN.posture(), (len(CAPTURE.times), 1)))
    text = told(made, replace(BARE, sensors=(foot,), objects=(), pivot_contacts=(), purposes=()))
    (line,) = [line for line in text.splitlines() if line.startswith("shapes that the capture")]
    assert f"{hand.name} by up to " in line
    assert "(outside of it)" in line
    breadth = HUMAN.measures["foot_breadth"]
    expected = 1e3 * (0.12 + half_m - 0.5 * breadth)
    assert float(line.split("by up to ")[1].split(" mm")[0]) == pytest.approx(expected, abs=12.0)
