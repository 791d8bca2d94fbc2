"""A motion's joint angles and poses as CSV and NPZ, and its body as MJCF."""

import csv
import io
import json
from pathlib import Path

import numpy as np
from jaxtyping import Float

from capar.body.human import ROOT_SIZE, Human, body_spec, poses_of

ROOT = (
    "pelvis_x_m", "pelvis_y_m", "pelvis_z_m", "pelvis_qw", "pelvis_qx", "pelvis_qy", "pelvis_qz",
)  # fmt: skip
"""Columns of the pelvis's pose in the world, z up."""


def csv_text(human: Human, times: Float[np.ndarray, "frames"], motion: np.ndarray) -> str:
    """A row a frame: its time [s], the pelvis's pose, and the angle of every joint [rad]."""
    out = io.StringIO()
    rows = csv.writer(out, lineterminator="\n")
    rows.writerow(["time_s", *ROOT, *(f"{joint}_rad" for joint in human.joints)])
    for time, posture in zip(times, motion, strict=True):
        rows.writerow([f"{time:.6f}", *(f"{value:.9f}" for value in posture)])
    return out.getvalue()


def write_npz(
    path: Path, human: Human, times: Float[np.ndarray, "frames"], motion: np.ndarray
) -> None:
    """Write a motion as arrays.

    They are ``times`` [s], ``qpos`` (postures as MuJoCo takes them with the MJCF), ``joint_names``
    and ``angles`` [rad], ``body_names``, ``body_pos`` [m], ``body_quat_wxyz``, and ``measures`` as
    JSON.
    """
    poses = poses_of(human, motion)
    measures = json.dumps(dict(sorted(human.measures.values.items())))
    with path.open("wb") as file:
        np.savez_compressed(
            file,
            times=times,
            qpos=motion,
            joint_names=np.array(human.joints),
            angles=motion[:, ROOT_SIZE:],
            body_names=np.array(poses.names),
            body_pos=poses.positions,
            body_quat_wxyz=poses.orientations,
            measures=np.array(measures),
        )


def mjcf_text(human: Human) -> str:
    """The body as a MuJoCo model."""
    spec = body_spec(human.measures, fingers=human.fingers)
    spec.compile()
    return str(spec.to_xml())
