"""A fitted body's motion is written so that it is read back to the same poses."""

import json
import struct
from pathlib import Path
from typing import Any

import mujoco
import numpy as np
import pytest
import trimesh
from scipy.spatial.transform import Rotation
from virtual_bodies.moving import MILLIMETRE, TENTH_DEG, Moved, turning

from capar.body.human import poses_of
from capar.export.bvh import AXES, UNIT_M, bvh_text
from capar.export.glb import glb_bytes
from capar.export.motion_tables import csv_text, mjcf_text, write_npz
from capar.model import geometry
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


def test_a_glb_is_loaded_by_trimesh_as_tall_as_the_child(moved: Moved, tmp_path: Path) -> None:
    human, times, _ = moved
    standing = np.tile(human.posture(), (len(times), 1))
    (tmp_path / "body.glb").write_bytes(glb_bytes(human, times, standing))
    low, high = trimesh.load(tmp_path / "body.glb").bounds
    assert high[1] - low[1] == pytest.approx(human.measures["stature"], rel=0.03)
    assert low[1] == pytest.approx(0.0, abs=0.02)


def test_the_same_motion_is_the_same_bytes(moved: Moved) -> None:
    human, times, motion = moved
    assert glb_bytes(human, times, motion) == glb_bytes(human, times, motion)
    assert bvh_text(human, times, motion) == bvh_text(human, times, motion)
