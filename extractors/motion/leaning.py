"""When an object leans: its upright axis is far from the vertical."""

import numpy as np
from jaxtyping import Bool, Float

from extractors.bodies.poses import Poses, rotation_matrices
from extractors.motion.object_motion import RestPose
from extractors.signals.clock import frame_rate
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
    rather than travels: its middle goes no farther meanwhile than its turning moves one end about
    the other.

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
        over, back = pace >= thresholds.rest_speed_radps, pace <= -thresholds.rest_speed_radps
    reach = np.abs(pace) * length_m
    lapse = round(thresholds.dropout_s * frame_rate(stream.times))
    found: list[Interval] = []
    for first, last in intervals(
        far,
        stream.times,
        dropout_s=thresholds.dropout_s,
        minimum_s=thresholds.contact_minimum_s,
    ):
        before, after = slice(first - 1, None, -1) if first else slice(0, 0), slice(last + 1, None)
        begin = first - _run(over[before] & _turns(speed[before], reach[before]), lapse)
        end = last + _run(back[after] & _turns(speed[after], reach[after]), lapse)
        if found and begin <= found[-1][1]:
            begin = found[-1][1] + 1
        found.append((begin, end))
    return tuple(found)


def _turns(
    speed: Float[np.ndarray, "frames"], reach: Float[np.ndarray, "frames"]
) -> Bool[np.ndarray, "frames"]:
    """Up to which frames it has come no farther than its turning takes it; not where it is lost."""
    with np.errstate(invalid="ignore"):
        return np.asarray(np.cumsum(speed) <= np.cumsum(reach))


def _run(holds: Bool[np.ndarray, "frames"], lapse: int) -> int:
    """For how many frames from the first on it holds, but for lapses of fewer frames than so many.

    Noise makes such lapses in what is told by a rate of change.
    """
    known = np.flatnonzero(holds)
    ends = np.flatnonzero(np.diff(known, prepend=-1) > lapse)
    known = known[: ends[0]] if ends.size else known
    return int(known[-1]) + 1 if known.size else 0


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


def spin_steps(orientations: Float[np.ndarray, "frames 4"]) -> Float[np.ndarray, "steps"]:
    """Angle by which a body turns about the vertical from each frame to the next [rad].

    It is the twist of the step's rotation; lost frames add nothing.
    """
    (w0, x0, y0, z0), (w1, x1, y1, z1) = orientations[:-1].T, orientations[1:].T
    # The step's quaternion: the later orientation times the inverse of the earlier one.
    w = w1 * w0 + x1 * x0 + y1 * y0 + z1 * z0
    x = -w1 * x0 + x1 * w0 - y1 * z0 + z1 * y0
    y = -w1 * y0 + x1 * z0 + y1 * w0 - z1 * x0
    z = -w1 * z0 - x1 * y0 + y1 * x0 + z1 * w0
    length = np.sqrt(x * x + y * y + z * z)
    with np.errstate(invalid="ignore", divide="ignore"):
        angle = 2.0 * np.arctan2(length, np.abs(w)) * np.where(w < 0.0, -1.0, 1.0)
        steps = np.where(length > 0.0, angle * z / length, 0.0)
    lost = np.isnan(orientations[:, 0])
    steps[lost[1:] | lost[:-1]] = 0.0
    return np.asarray(steps)
