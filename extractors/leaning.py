"""When an object leans: its upright axis is far from the vertical."""

import numpy as np
from jaxtyping import Float

from extractors.intervals import Interval, intervals
from extractors.object_motion import Stay
from extractors.poses import Poses, rotation_matrices
from extractors.thresholds import Thresholds


def leaning(
    where: Poses, rests: tuple[Stay, ...], thresholds: Thresholds
) -> tuple[Interval, ...]:
    """Closed intervals of frames in which an object leans.

    Its upright axis is the one that pointed up where it first rested; an object that never
    rests has none, and never leans.

    Args:
        where: The object's poses.
        rests: The places where it rests, in time.
        thresholds: The angle, and least durations.
    """
    if not rests:
        return ()
    stream = where.smooth
    upright = rotation_matrices(rests[0].orientation[None])[0].T @ np.array([0.0, 0.0, 1.0])
    angle = lean(stream.orientations, upright)
    with np.errstate(invalid="ignore"):
        far = angle > thresholds.lean_rad
    return tuple(
        intervals(
            far,
            stream.times,
            dropout_s=thresholds.dropout_s,
            minimum_s=thresholds.contact_minimum_s,
        )
    )


def lean(
    orientations: Float[np.ndarray, "frames 4"], upright: Float[np.ndarray, "3"]
) -> Float[np.ndarray, "frames"]:
    """Angle of an axis of the body from the vertical at each frame [rad]."""
    up = (rotation_matrices(orientations) @ upright)[:, 2]
    return np.arccos(np.clip(up, -1.0, 1.0))
