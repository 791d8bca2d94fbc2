"""A body's motion as poses of its segments, each in the world and against its parent."""

from collections.abc import Sequence
from dataclasses import dataclass

import mujoco
import numpy as np
from jaxtyping import Float
from scipy.spatial.transform import Rotation

from capar.body.human import Human


@dataclass(frozen=True, eq=False)
class Poses:
    """Poses of all segments, parents first; the first is the pelvis."""

    names: tuple[str, ...]
    parents: tuple[int, ...]
    """Number of each segment's parent; -1 for the pelvis."""

    offsets: Float[np.ndarray, "segments 3"]
    """Each segment's joint in its parent's frame [m]; the pelvis's in the world, standing."""

    positions: Float[np.ndarray, "frames segments 3"]
    """In the world [m], z up."""

    orientations: Float[np.ndarray, "frames segments 4"]
    """In the world, w x y z; standing, all are the world's: x forward, y left, z up."""

    turns: Float[np.ndarray, "frames segments 4"]
    """Against the parent, w x y z, without jumps of sign; the pelvis's in the world."""


def poses_of(human: Human, motion: Float[np.ndarray, "frames posture"]) -> Poses:
    """The poses that a motion brings the segments to."""
    model, data = human.model, mujoco.MjData(human.model)
    bodies = range(1, model.nbody)
    positions = np.empty((len(motion), model.nbody - 1, 3))
    orientations = np.empty((len(motion), model.nbody - 1, 4))
    for frame, posture in enumerate(motion):
        data.qpos[:] = posture
        mujoco.mj_kinematics(model, data)
        positions[frame], orientations[frame] = data.xpos[1:], data.xquat[1:]
    parents = tuple(int(model.body_parentid[body]) - 1 for body in bodies)
    return Poses(
        tuple(model.body(body).name for body in bodies),
        parents,
        np.array(model.body_pos[1:]),
        positions,
        _signed(orientations),
        _signed(_against(orientations, parents)),
    )


def _against(
    orientations: Float[np.ndarray, "frames segments 4"], parents: Sequence[int]
) -> Float[np.ndarray, "frames segments 4"]:
    out = orientations.copy()
    for number, parent in enumerate(parents):
        if parent >= 0:
            own, base = (
                Rotation.from_quat(orientations[:, each], scalar_first=True)
                for each in (number, parent)
            )
            out[:, number] = (base.inv() * own).as_quat(scalar_first=True)
    return out


def _signed(
    quaternions: Float[np.ndarray, "frames segments 4"],
) -> Float[np.ndarray, "frames segments 4"]:
    """The same rotations with signs by which neighbouring frames are near each other."""
    near = np.einsum("fsi,fsi->fs", quaternions[1:], quaternions[:-1])
    signs = np.cumprod(np.where(near < 0.0, -1.0, 1.0), axis=0)
    out = quaternions.copy()
    out[1:] *= signs[:, :, None]
    return out
