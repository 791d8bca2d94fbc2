"""Programs of others read the exports of a fitted body to the same poses."""

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from scipy.spatial.transform import Rotation
from second_readers import gltf_report, gltf_validator_missing
from virtual_bodies.moving import MILLIMETRE, TENTH_DEG, Moved, turning

from capar.body.anthropometry import ready_made
from capar.body.human import Human, poses_of
from capar.export.bvh import AXES, UNIT_M, bvh_text
from capar.export.c3d import c3d_bytes
from capar.export.glb import glb_bytes
from capar.model import geometry
from capar.model.errors import CaparError
from extractors.readers.registry import read_recording

RATE_HZ = 60.0


@pytest.fixture(scope="module")
def moved() -> Moved:
    """A woman who moves every joint and turns round twice."""
    return turning("woman", rate_hz=RATE_HZ, seed=11, turns_radps=6.0)


def agree(
    positions: np.ndarray, turns: Rotation, expected: np.ndarray, orientations: np.ndarray
) -> None:
    """Whether poses are the same within 1 mm and 0.1 degrees at every frame."""
    assert np.abs(positions - expected).max() < MILLIMETRE
    angles = geometry.angle_between(turns.as_quat(scalar_first=True), orientations)
    assert np.asarray(angles).max() < TENTH_DEG


def test_ezc3d_reads_the_rotations_and_points_of_a_c3d(moved: Moved, tmp_path: Path) -> None:
    ezc3d = pytest.importorskip("ezc3d", reason="ezc3d is not installed")
    human, times, motion = moved
    path = tmp_path / "motion.c3d"
    path.write_bytes(c3d_bytes(human, times, motion))
    read, poses = ezc3d.c3d(str(path)), poses_of(human, motion)
    groups = read["parameters"]
    assert groups["POINT"]["RATE"]["value"][0] == pytest.approx(RATE_HZ)
    assert groups["POINT"]["UNITS"]["value"] == ["mm"]
    assert groups["ROTATION"]["LABELS"]["value"] == list(poses.names)
    matrices, points = read["data"]["rotations"], read["data"]["points"]
    assert matrices.shape[2:] == points.shape[1:] == poses.positions.shape[1::-1]
    for number in range(len(poses.names)):
        turns = Rotation.from_matrix(matrices[:3, :3, number].transpose(2, 0, 1))
        expected = poses.positions[:, number], poses.orientations[:, number]
        agree(matrices[:3, 3, number].T / 1e3, turns, *expected)
        agree(points[:3, number].T / 1e3, turns, *expected)


def test_a_c3d_comes_back_as_bodies_with_the_same_poses(moved: Moved, tmp_path: Path) -> None:
    human, times, motion = moved
    path = tmp_path / "motion.c3d"
    path.write_bytes(c3d_bytes(human, times, motion))
    read, poses = read_recording(path), poses_of(human, motion)
    assert read.unit_m == 1e-3
    for number, name in enumerate(poses.names):
        stream = read.bodies[name]
        assert np.allclose(stream.times, times, atol=1e-6)
        turns = geometry.rotations(stream.orientations)
        expected = poses.positions[:, number], poses.orientations[:, number]
        agree(stream.positions / 1e3, turns, *expected)


@pytest.mark.parametrize("count", [2, 200])
def test_a_c3d_of_two_frames_or_many_is_read_whole(count: int, tmp_path: Path) -> None:
    ezc3d = pytest.importorskip("ezc3d", reason="ezc3d is not installed")
    human = Human.of(ready_made("child"))
    motion = np.broadcast_to(human.posture(), (count, len(human.posture())))
    path = tmp_path / "long.c3d"
    path.write_bytes(c3d_bytes(human, np.arange(count) / 1000.0, motion))
    assert ezc3d.c3d(str(path))["data"]["rotations"].shape[3] == count
    assert len(read_recording(path).marker_times) == count


def test_a_motion_of_more_frames_than_a_c3d_counts_is_refused() -> None:
    human, count = Human.of(ready_made("child")), 65_536
    motion = np.broadcast_to(human.posture(), (count, len(human.posture())))
    with pytest.raises(CaparError, match="65536 frames"):
        c3d_bytes(human, np.arange(count) / 1000.0, motion)


def test_pybvh_reads_every_joint_of_a_bvh_where_it_was(moved: Moved, tmp_path: Path) -> None:
    pybvh = pytest.importorskip("pybvh", reason="pybvh is not installed")
    human, times, motion = moved
    path = tmp_path / "motion.bvh"
    path.write_text(bvh_text(human, times, motion))
    read, poses = pybvh.read_bvh_file(path, world_up="+y"), poses_of(human, motion)
    assert read.frame_time == pytest.approx(1.0 / RATE_HZ)
    assert set(read.joint_names) == set(poses.names)
    ours = Rotation.from_matrix(np.eye(3)[AXES]).inv()
    places, turned = read.node_positions(), _turned(read)
    for number, name in enumerate(poses.names):
        positions = ours.apply(places[:, read.node_index[name]]) * UNIT_M
        turns = ours * turned[name] * ours.inv()
        agree(positions, turns, poses.positions[:, number], poses.orientations[:, number])


def _turned(read: Any) -> dict[str, Rotation]:
    """The rotation of every joint in the file's world, from those against their parents."""
    own = read.to_rotmat()[1]
    out: dict[str, Rotation] = {}
    for node in read.nodes:
        if node.name in read.joint_index:
            turn = Rotation.from_matrix(own[:, read.joint_index[node.name]])
            out[node.name] = out[node.parent.name] * turn if node.parent else turn
    return out


def test_the_gltf_validator_finds_nothing_to_say_of_a_glb(moved: Moved, tmp_path: Path) -> None:
    missing = gltf_validator_missing()
    if missing:
        pytest.skip(missing)
    path = tmp_path / "motion.glb"
    path.write_bytes(glb_bytes(*moved))
    report = gltf_report(path)
    assert report["issues"]["messages"] == []
    assert report["info"]["animationCount"] == 1
    assert report["info"]["hasTextures"] is False
