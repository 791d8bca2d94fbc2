"""When an object leans: its upright axis is far from the vertical."""

import numpy as np
from jaxtyping import Bool, Float
from scipy.spatial.transform import Rotation

from extractors.bodies.poses import Poses, rotation_matrices
from extractors.motion.object_motion import RestPose
from extractors.signals.filters import derivative
from extractors.signals.intervals import Interval, intervals
from extractors.thresholds import Thresholds


def leaning(
    poses: Poses,
    upright: Float[np.ndarray, "3"],
    thresholds: Thresholds,
    *,
    length_m: float = 0.0,
) -> tuple[Interval, ...]:
    """Closed intervals of frames in which an object leans, from when it began to lean over.

    It leans while its axis is far from the vertical. The interval also covers the tipping over
    before and the righting after, as long as it turns faster than a body at rest does, and turns
    rather than travels: its middle goes no faster than its turning moves one end about the other.

    Args:
        poses: The object's poses.
        upright: The axis that points up while it stands, in its own frame.
        thresholds: The angle, and least durations.
        length_m: The object's greatest length [m]; a point's turning moves nothing.
    """
    stream = poses.smooth
    angle = lean(stream.orientations, upright)
    pace = derivative(angle, stream.times)
    speed = np.linalg.norm(derivative(stream.positions, stream.times), axis=1)
    with np.errstate(invalid="ignore"):
        far = angle > thresholds.lean_rad
        turns = (np.abs(pace) >= thresholds.rest_speed_radps) & (speed <= np.abs(pace) * length_m)
        over, back = turns & (pace > 0.0), turns & (pace < 0.0)
    found: list[Interval] = []
    for first, last in intervals(
        far,
        stream.times,
        dropout_s=thresholds.dropout_s,
        minimum_s=thresholds.contact_minimum_s,
    ):
        begin = first - _run(over[:first][::-1])
        end = last + _run(back[last + 1 :])
        if found and begin <= found[-1][1]:
            begin = found[-1][1] + 1
        found.append((begin, end))
    return tuple(found)


def _run(holds: Bool[np.ndarray, "frames"]) -> int:
    """For how many frames from the first on it holds."""
    gaps = np.flatnonzero(~holds)
    return int(gaps[0]) if gaps.size else len(holds)


def upright_axis(poses: Poses, rest: RestPose | None) -> Float[np.ndarray, "3"]:
    """The axis that points up where a body first rests, or else in its first known frame."""
    known = np.flatnonzero(~poses.smooth.lost)
    up = np.array([0.0, 0.0, 1.0])
    if rest is not None:
        turn = rest.orientation
    elif known.size:
        turn = poses.smooth.orientations[known[0]]
    else:
        return up
    return np.asarray(rotation_matrices(turn[None])[0].T @ up)


def lean(
    orientations: Float[np.ndarray, "frames 4"], upright: Float[np.ndarray, "3"]
) -> Float[np.ndarray, "frames"]:
    """Angle of an axis of the body from the vertical at each frame [rad]."""
    up = (rotation_matrices(orientations) @ upright)[:, 2]
    return np.arccos(np.clip(up, -1.0, 1.0))


def spin(orientations: Float[np.ndarray, "frames 4"]) -> Float[np.ndarray, "frames"]:
    """Angle by which a body has turned about the vertical since the first frame [rad].

    Each step's turn about the vertical is the twist of its rotation; lost frames add nothing.
    """
    rotation = Rotation.from_quat(np.nan_to_num(orientations, nan=0.5), scalar_first=True)
    steps = (rotation[1:] * rotation[:-1].inv()).as_rotvec()[:, 2]
    lost = np.isnan(orientations[:, 0])
    steps[lost[1:] | lost[:-1]] = 0.0
    return np.concatenate(([0.0], np.cumsum(steps)))
