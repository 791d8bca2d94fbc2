"""A drafted capture.toml takes unit, upward axis and end-effectors from what bodies can be."""

import re
from pathlib import Path

import numpy as np
import pytest

from capar.model.capture import Source
from extractors.readers.bundle.capture_toml import read_capture
from extractors.readers.drafting.draft import EDIT, draft
from extractors.readers.recording import Recording, track
from extractors.readers.registry import read_recording

PEOPLE = {"m": 1.0, "cm": 100.0, "mm": 1000.0, "dm": 10.0}
PLACES = {"Hips": 0.95, "Head": 1.5, "LeftHand": 1.1, "LeftHandThumb": 1.05, "LeftFoot": 0.08}
PARENTS = {"Head": "Hips", "LeftHand": "Hips", "LeftHandThumb": "LeftHand", "LeftFoot": "Hips"}
BVH = """HIERARCHY
ROOT Hips
{{
 OFFSET 0 0 0
 CHANNELS 6 Xposition Yposition Zposition Zrotation Xrotation Yrotation
{joints}}}
MOTION
Frames: 3
Frame Time: 0.01
"""


def person(scale: float, axis: int, sign: float = 1.0) -> Recording:
    """Somebody who stands and moves a little, in a unit, along an axis."""
    times = np.arange(20) / 50.0
    turns = np.tile([1.0, 0.0, 0.0, 0.0], (20, 1))
    bodies = {}
    for name, height in PLACES.items():
        places = np.tile([0.1, 0.1, 0.1], (20, 1)) + 0.01 * np.sin(times)[:, None]
        places[:, axis] = sign * height
        bodies[name] = track(name, times, places * scale, turns)
    return Recording(Source("walk.bvh", "bvh", ""), bodies=bodies, parents=PARENTS)


@pytest.mark.parametrize("unit", PEOPLE)
@pytest.mark.parametrize(("axis", "sign", "up"), [(1, 1.0, "y"), (2, 1.0, "z"), (1, -1.0, "-y")])
def test_the_unit_and_axis_in_which_a_person_stands_are_drafted_with_the_evidence(
    unit: str, axis: int, sign: float, up: str
) -> None:
    text = draft([person(PEOPLE[unit], axis, sign)], Path(), "walk")
    assert f'unit = "{unit}"' in text
    assert re.search(rf"1\.\d\d m if the unit is {unit}$", text, re.MULTILINE)
    assert f'up = "{up}"' in text
    assert EDIT not in text


def test_a_scale_that_is_no_unit_is_drafted_as_a_number_to_look_at() -> None:
    text = draft([person(18.0, 1)], Path(), "walk")
    (line,) = [each for each in text.splitlines() if each.startswith("unit = ")]
    assert float(line.split()[2]) == pytest.approx(1.0 / 18.0, rel=0.06)
    assert EDIT in line


def test_finger_joints_are_no_hands_and_no_objects_but_head_and_floor_are() -> None:
    text = draft([person(1.0, 1)], Path(), "walk")
    assert text.count("[[sensor]]") == 3
    assert text.count("[[object]]") == 2
    assert 'kind = "floor"' in text
    assert not [each for each in text.splitlines() if "Thumb" in each and each[0] != "#"]


def test_a_skeleton_in_a_unit_of_its_own_is_read_to_the_height_that_was_drafted(
    tmp_path: Path,
) -> None:
    joints = "".join(
        f" JOINT {name}\n {{\n  OFFSET 0 {18.0 * (PLACES[name] - PLACES['Hips']):.3f} 0\n"
        "  CHANNELS 3 Zrotation Xrotation Yrotation\n  End Site\n  {\n   OFFSET 0 1 0\n  }\n }\n"
        for name in ("Head", "LeftHand", "LeftFoot")
    )
    row = " ".join(["0 17.1 0", *["0"] * 12])
    path = tmp_path / "walk.bvh"
    path.write_text(BVH.format(joints=joints) + "\n".join([row] * 3) + "\n")
    (tmp_path / "capture.toml").write_text(draft([read_recording(path)], tmp_path, "walk"))
    capture = read_capture(tmp_path)
    head, foot = (capture.sensor(each).stream.positions[0] for each in ("head", "left_foot"))
    assert head[2] - foot[2] == pytest.approx(1.49, abs=0.01)
