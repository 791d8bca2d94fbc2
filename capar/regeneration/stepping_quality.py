"""What steps are worth: every gate with what was measured and its limit."""

from collections.abc import Iterator

import mujoco
import numpy as np
from jaxtyping import Float
from scipy.spatial.transform import RigidTransform, Rotation

from capar.body.human import ROOT_SIZE
from capar.body.inverse_kinematics import support
from capar.body.scripts import SIDES
from capar.regeneration.collisions import NEAR_M, Pair, Surroundings
from capar.regeneration.quality import Gate, Quality, is_hand
from capar.regeneration.solving import vectors
from capar.regeneration.stepping import Stepping

INSIDE_MM = 10.0
"""How far inside the soles that bear it the centre of mass stays [mm]."""


def stepping_quality(made: Stepping) -> Quality:
    """Verify steps at every frame."""
    feet = _feet(made)
    return Quality((*_foot_gates(made, feet), *_contact_gates(made), *_joint_gates(made)))


def _feet(made: Stepping) -> dict[str, RigidTransform]:
    sites = made.human.sites(made.postures, [f"{side}_foot" for side in SIDES])
    return {
        side: RigidTransform.from_components(
            sites[f"{side}_foot"][0],
            Rotation.from_quat(sites[f"{side}_foot"][1], scalar_first=True),
        )
        for side in SIDES
    }


def _foot_gates(made: Stepping, feet: dict[str, RigidTransform]) -> Iterator[Gate]:
    slid, missed = (0.0, -1, ""), (0.0, -1, "")
    for side, path in feet.items():
        still = made.bears[side]
        first = 0
        for frame in range(len(still)):
            if not still[frame]:
                first = frame + 1
            elif frame > first:
                by = float(np.linalg.norm(path[frame].translation - path[first].translation))
                slid = max(slid, (by, frame, f"{side}_foot"))
        gone = path[-1].translation - path[0].translation
        off = float(np.linalg.norm(gone - [*(np.asarray(made.goal) - made.scene.place), 0.0]))
        missed = max(missed, (off, len(still) - 1, f"{side}_foot"))
    yield Gate("foot that bears", 1e3 * slid[0], 3.0, "mm", False, *slid[1:])
    yield Gate("foot comes there", 1e3 * missed[0], 3.0, "mm", False, *missed[1:])
    masses = _masses(made)
    inside = [
        -float(
            support(made.human, {s: feet[s][frame] for s in SIDES if made.bears[s][frame]}).outside(
                masses[frame]
            )
        )
        for frame in range(len(masses))
    ]
    worst = int(np.argmin(inside))
    yield Gate("balance", 1e3 * inside[worst], INSIDE_MM, "mm", True, worst)


def _masses(made: Stepping) -> Float[np.ndarray, "frames 2"]:
    """Where the centre of mass is [m]."""
    model = made.human.model
    data, out = mujoco.MjData(model), []
    for posture in made.postures:
        data.qpos[:] = posture
        mujoco.mj_kinematics(model, data)
        mujoco.mj_comPos(model, data)
        out.append(np.array(data.subtree_com[1, :2]))
    return np.array(out)


def _contact_gates(made: Stepping) -> Iterator[Gate]:
    """Penetration of anything, and how far hands keep from what they do not touch."""
    around = Surroundings(made.human, made.scene)
    things = {name: vectors(thing.pose) for name, thing in made.scene.things.items()}
    deepest = nearest = (Pair(NEAR_M, "", ""), -1)
    for frame, posture in enumerate(made.postures):
        around.place(posture, things)
        for pair in around.near():
            deepest = min(deepest, (pair, frame))
            if is_hand(pair.part):
                nearest = min(nearest, (pair, frame))
    for name, limit, (pair, frame) in (
        ("penetration", -1.0, deepest), ("free hand clear", 10.0, nearest),
    ):  # fmt: skip
        bodies = f"{pair.part}, {pair.thing}" if pair.part else ""
        yield Gate(name, 1e3 * pair.distance_m, limit, "mm", True, frame, bodies)


def _joint_gates(made: Stepping) -> Iterator[Gate]:
    rate_hz = 1.0 / float(made.times[1] - made.times[0])
    low, high = made.human.ranges.T
    angles = made.postures[:, ROOT_SIZE:]
    out = np.maximum(np.maximum(low - angles, angles - high), 0.0)
    frame, hinge = np.unravel_index(int(out.argmax()), out.shape)
    yield Gate(
        "joint limits", float(np.degrees(out.max())), 0.01, "deg", False,
        int(frame), made.human.joints[int(hinge)],
    )  # fmt: skip
    speeds = np.abs(np.diff(angles, axis=0)) * rate_hz
    frame, hinge = np.unravel_index(int(speeds.argmax()), speeds.shape)
    yield Gate(
        "joint speed", float(speeds.max()), 15.0, "rad/s", False,
        int(frame), made.human.joints[int(hinge)],
    )  # fmt: skip
    hips = np.linalg.norm(np.diff(made.postures[:, :3], axis=0), axis=1) * rate_hz
    yield Gate("pelvis speed", float(hips.max()), 1.5, "m/s", False, int(hips.argmax()))
