"""Whether an object that moves is shifted, turned or both (thesis 4.1.1), and between where."""

import numpy as np
from jaxtyping import Float

from capar.model import geometry
from capar.model.capture import Capture
from capar.model.observation import Segment
from capar.model.par import Motion
from extractors.bodies.poses import Poses
from extractors.measure import Measurements
from extractors.motion.object_motion import motion_floor
from extractors.signals.clock import frame_rate
from extractors.thresholds import Thresholds

Place = tuple[float, float, float]
"""A place in the world [m]."""


def moved_path(
    capture: Capture, measurements: Measurements, segment: Segment, thresholds: Thresholds
) -> tuple[Motion, tuple[Place, ...]]:
    """How the object that a segment moves moves, and where it begins and ends [m].

    Where the segment moves none, the motion is none and the places are the end-effector's. A place
    at which the body was lost is left out.
    """
    moves, name = followed(segment)
    kind = Motion.NONE
    if moves:
        moved = capture.tag_object(name)
        poses = measurements.bodies.objects[moved.name].poses
        positions = poses.smooth.positions
        span = segment.first, segment.last
        kind = motion_kind(poses, *span, own_m=moved.motion_floor_m, thresholds=thresholds)
    else:
        positions = measurements.tracks[name].positions
    ends = (positions[segment.first], positions[segment.last])
    return kind, tuple(_place(each) for each in ends if not np.isnan(each).any())


def followed(segment: Segment) -> tuple[bool, str]:
    """The body whose way tells where a segment leads, after whether it is an object that is moved.

    It is the first object that the segment moves, or else the end-effector.
    """
    if "1" in segment.features.change_loc:
        return True, segment.objects[segment.features.change_loc.index("1")]
    return False, segment.ee


def _place(position: Float[np.ndarray, "3"]) -> Place:
    x, y, z = map(float, position)
    return x, y, z


def motion_kind(
    poses: Poses, first: int, last: int, *, own_m: float | None, thresholds: Thresholds
) -> Motion:
    """How the body moves between two frames, against its pose at the first.

    Args:
        poses: The body's poses.
        first: Frame of the reference pose.
        last: Frame up to which motion counts.
        own_m: The object's own floor of motion [m], if it has one.
        thresholds: Least floors, and deviations of noise that they must exceed.
    """
    span = slice(first, last + 1)
    places, turns = poses.smooth.positions[span], poses.smooth.orientations[span]
    rate_hz = frame_rate(poses.smooth.times)
    floor = motion_floor(poses.noise, rate_hz, own_m=own_m, thresholds=thresholds)
    known = ~np.isnan(places[:, 0])
    if not known.any():
        return Motion.NONE
    places, turns = places[known], turns[known]
    shifts = np.linalg.norm(places - places[0], axis=1).max() > floor.position_m
    turned = geometry.angle_between(turns, turns[:1]).max() > floor.rotation_rad
    if shifts and turned:
        return Motion.BOTH
    if shifts:
        return Motion.TRANSLATION
    return Motion.ROTATION if turned else Motion.NONE
