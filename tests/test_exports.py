"""Motions of fitted bodies are read back to the same poses, by us and by programs of others."""

import json
import shutil
import struct
import subprocess
from pathlib import Path
from typing import Any

import mujoco
import numpy as np
import pytest
from scipy.spatial.transform import Rotation
from virtual_bodies.moving import MILLIMETRE, TENTH_DEG, Moved, turning

from capar.body.anthropometry import ready_made
from capar.body.human import Human, poses_of
from capar.export.bvh import AXES, UNIT_M, bvh_text
from capar.export.c3d import c3d_bytes
from capar.export.glb import glb_bytes
from capar.export.motion_tables import csv_text, mjcf_text, write_npz
from capar.model import geometry
from capar.model.errors import CaparError
from extractors.readers.registry import read_recording

RATE_HZ = 30.0


@pytest.fixture(scope="module")
def moved() -> Moved:
    """A child that moves every joint and turns round."""
    return turning("child", rate_hz=RATE_HZ, seed=7, turns_radps=4.0)


def angles_between(first: np.ndarray, second: np.ndarray) -> np.ndarray:
    return np.asarray(geometry.angle_between(first, second))


def test_a_bvh_is_read_back_to_the_same_poses(moved: Moved, tmp_path: Path) -> None:
    human, times, motion = moved
    path = tmp_path / "motion.bvh"
    path.write_text(bvh_text(human, times, motion))
    read, poses = read_recording(path), poses_of(human, motion)
    assert set(read.bodies) == set(poses.names)
    assert np.allclose(read.times, times, atol=1e-6)
    turned = Rotation.from_matrix(np.eye(3)[AXES])
    for number, name in enumerate(poses.names):
        stream = read.bodies[name]
        places = turned.inv().apply(stream.positions * UNIT_M)
        assert np.abs(places - poses.positions[:, number]).max() < MILLIMETRE
        found = turned.inv() * geometry.rotations(stream.orientations) * turned
        quaternions = found.as_quat(scalar_first=True)
        assert angles_between(quaternions, poses.orientations[:, number]).max() < TENTH_DEG


def test_a_table_and_a_model_give_mujoco_the_same_poses(moved: Moved, tmp_path: Path) -> None:
    human, times, motion = moved
    write_npz(tmp_path / "motion.npz", human, times, motion)
    (tmp_path / "body.xml").write_text(mjcf_text(human))
    (tmp_path / "motion.csv").write_text(csv_text(human, times, motion))
    arrays = np.load(tmp_path / "motion.npz")
    rows = np.genfromtxt(tmp_path / "motion.csv", delimiter=",", names=True)
    model = mujoco.MjModel.from_xml_path(str(tmp_path / "body.xml"))
    data = mujoco.MjData(model)
    assert list(arrays["joint_names"]) == [model.joint(n).name for n in range(1, model.njnt)]
    for frame in (0, 17, len(motion) - 1):
        table = np.array([rows[frame][name] for name in rows.dtype.names[1:]])
        for posture in (arrays["qpos"][frame], table):
            data.qpos[:] = posture
            mujoco.mj_kinematics(model, data)
            assert np.abs(data.xpos[1:] - arrays["body_pos"][frame]).max() < 1e-6
    assert json.loads(str(arrays["measures"]))["stature"] == human.measures["stature"]


def _glb(data: bytes) -> tuple[dict[str, Any], bytes]:
    magic, version, size = struct.unpack_from("<4sII", data)
    assert (magic, version, size) == (b"glTF", 2, len(data))
    length, kind = struct.unpack_from("<I4s", data, 12)
    assert kind == b"JSON"
    return json.loads(data[20 : 20 + length]), data[28 + length :]


def _array(document: dict[str, Any], data: bytes, number: int) -> np.ndarray:
    accessor = document["accessors"][number]
    view = document["bufferViews"][accessor["bufferView"]]
    wide = {"SCALAR": 1, "VEC3": 3, "VEC4": 4}[accessor["type"]]
    flat = np.frombuffer(data, "<f4", accessor["count"] * wide, view["byteOffset"])
    return flat.reshape(accessor["count"], wide)


def test_a_glb_animates_its_nodes_to_the_same_poses(moved: Moved) -> None:
    human, times, motion = moved
    document, data = _glb(glb_bytes(human, times, motion))
    poses, frame = poses_of(human, motion), 41
    nodes = document["nodes"]
    (animation,) = document["animations"]
    for channel in animation["channels"]:
        sampler = animation["samplers"][channel["sampler"]]
        clock = _array(document, data, sampler["input"])[:, 0]
        assert np.allclose(clock, times - times[0], atol=1e-5)
        values = _array(document, data, sampler["output"])
        nodes[channel["target"]["node"]][channel["target"]["path"]] = values[frame]
    (root,) = document["scenes"][0]["nodes"]
    found: dict[str, tuple[np.ndarray, Rotation]] = {}

    def visit(number: int, at: np.ndarray, turn: Rotation) -> None:
        node = nodes[number]
        at = at + turn.apply(node.get("translation", np.zeros(3)))
        turn = turn * Rotation.from_quat(node["rotation"])
        found[node["name"]] = (at, turn)
        for child in node.get("children", []):
            visit(child, at, turn)

    visit(root, np.zeros(3), Rotation.identity())
    up = Rotation.from_euler("x", -90.0, degrees=True)
    for number, name in enumerate(poses.names):
        at, turn = found[name]
        assert np.abs(at - up.apply(poses.positions[frame, number])).max() < MILLIMETRE
        expected = up * Rotation.from_quat(poses.orientations[frame, number], scalar_first=True)
        assert (expected.inv() * turn).magnitude() < TENTH_DEG


SCRIPT = """
const validator = require("gltf-validator");
const bytes = new Uint8Array(require("fs").readFileSync(process.argv[1]));
validator.validateBytes(bytes).then(report => console.log(JSON.stringify(report)));
"""


def gltf_validator_missing() -> str:
    """Why GLB files cannot be validated here; empty if they can."""
    node = shutil.which("node")
    if node is None:
        return "no Node.js on this machine"
    asked = subprocess.run(
        [node, "-e", 'require("gltf-validator")'], check=False, capture_output=True
    )
    return "" if asked.returncode == 0 else "gltf-validator not found: npm install gltf-validator"


def gltf_report(path: Path) -> dict[str, Any]:
    """The validator's report on a file."""
    node = shutil.which("node")
    assert node is not None
    told = subprocess.run(
        [node, "-e", SCRIPT, str(path)], capture_output=True, check=True, text=True, timeout=60
    )
    report: dict[str, Any] = json.loads(told.stdout)
    return report


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


def test_a_motion_of_more_frames_than_a_c3d_counts_is_refused() -> None:
    human, count = Human.of(ready_made("child")), 65_536
    motion = np.broadcast_to(human.posture(), (count, len(human.posture())))
    with pytest.raises(CaparError, match="65536 frames"):
        c3d_bytes(human, np.arange(count) / 1000.0, motion)


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
