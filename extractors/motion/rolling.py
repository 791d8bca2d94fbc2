"""When a body rolls: it goes and turns so that the point below its middle is nearly at rest."""

import numpy as np
from jaxtyping import Bool, Float
from scipy.spatial.transform import Rotation

from extractors.bodies.body_geometry import BodyGeometry
from extractors.signals.filters import velocity
from extractors.signals.intervals import Interval, intervals
from extractors.thresholds import Thresholds


def rolling(body: BodyGeometry, thresholds: Thresholds) -> tuple[Interval, ...]:
    """Closed intervals of frames in which a body rolls, as on a level through its lowest point.

    The material point straight below its middle, at the height of its lowest point, has the
    velocity v + w x r. Where the body rolls without slipping that point is at rest while the
    middle goes. Nothing here knows whether there is a support at that height; on a slope of more
    than about fifteen degrees the point of contact lies too far uphill for it to be this one.

    Args:
        body: The body; one without a shape has no lowest point and never rolls.
        thresholds: Least speed and turn, largest slip, and least durations.
    """
    if body.poses.rests or body.shape is None:
        return ()
    stream = body.poses.smooth
    goes = velocity(body.middles, stream.times)
    turns = angular_velocity(stream.orientations, stream.times)
    arm = np.zeros_like(goes)
    arm[:, 2] = body.boxes[0][:, 2] - body.middles[:, 2]
    found = intervals(
        _holds(goes, turns, arm, thresholds),
        stream.times,
        dropout_s=thresholds.dropout_s,
        minimum_s=thresholds.contact_minimum_s,
    )
    angle = _turned(turns, stream.times)
    return tuple(
        (first, last) for first, last in found if angle[last] - angle[first] >= thresholds.roll_rad
    )


def angular_velocity(
    orientations: Float[np.ndarray, "frames 4"], times: Float[np.ndarray, "frames"]
) -> Float[np.ndarray, "frames 3"]:
    """Angular velocity in the world by central differences [rad/s]; NaN beside lost frames."""
    before = np.maximum(np.arange(len(times)) - 1, 0)
    after = np.minimum(np.arange(len(times)) + 1, len(times) - 1)
    lost = np.isnan(orientations[before, 0]) | np.isnan(orientations[after, 0])
    known = np.where(np.isnan(orientations), 0.5, orientations)
    rotation = Rotation.from_quat(known, scalar_first=True)
    out = (rotation[after] * rotation[before].inv()).as_rotvec()
    out /= (times[after] - times[before])[:, None]
    out[lost] = np.nan
    return np.asarray(out)


def _holds(
    goes: Float[np.ndarray, "frames 3"],
    turns: Float[np.ndarray, "frames 3"],
    arm: Float[np.ndarray, "frames 3"],
    thresholds: Thresholds,
) -> Bool[np.ndarray, "frames"]:
    """Whether the middle goes, the axis lies, and the point below the middle stays behind."""
    speed = np.linalg.norm(goes, axis=1)
    slip = np.linalg.norm(goes + np.cross(turns, arm), axis=1)
    level = np.linalg.norm(turns[:, :2], axis=1)
    with np.errstate(invalid="ignore"):
        return np.asarray(
            (speed > thresholds.rest_speed_mps)
            & (slip <= thresholds.slip_share * speed)
            & (np.abs(turns[:, 2]) <= level)
        )


def _turned(
    turns: Float[np.ndarray, "frames 3"], times: Float[np.ndarray, "frames"]
) -> Float[np.ndarray, "frames"]:
    """Angle turned so far [rad]; what is not known adds nothing."""
    rate = np.nan_to_num(np.linalg.norm(turns, axis=1))
    steps = 0.5 * (rate[1:] + rate[:-1]) * np.diff(times)
    return np.concatenate(([0.0], np.cumsum(steps)))
