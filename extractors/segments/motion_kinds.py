"""Whether an object that moves is shifted, turned or both (thesis 4.1.1)."""

import numpy as np

from capar.model import geometry
from capar.model.par import Motion
from extractors.bodies.poses import Poses
from extractors.motion.object_motion import motion_floor
from extractors.thresholds import Thresholds


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
    rate_hz = 1.0 / float(np.median(np.diff(poses.smooth.times)))
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
