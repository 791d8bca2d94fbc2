"""Carries that a recorder has timed, compared with the times that motion alone gives."""

from collections.abc import Iterable
from dataclasses import dataclass, replace
from enum import StrEnum

import numpy as np

from capar.model import geometry
from capar.model.capture import Stream, TagObject, TagType
from extractors.bodies.poses import poses_of
from extractors.motion.motion_edges import motion_edges
from extractors.motion.object_motion import motion_floor, moving, rest_poses
from extractors.readers.bundle.resampling import resampled
from extractors.thresholds import Thresholds

RATE_HZ = 50.0
"""The clock that carries are brought to [Hz]."""

REST_S = 2.0
"""How long an object is held at rest before its first and after its last recorded pose [s]."""

NEAR_S = 0.1
"""An end is found if it is so near to the recorded one [s]."""


class Miss(StrEnum):
    """Why an end of a carry was not found where it is recorded."""

    STILL = "it lies still, to a hair's width, between the two times"
    CREEPS = "it shifts between the two times, by less than the floor of motion"
    MOVES = "it moves between the two times"


@dataclass(frozen=True, slots=True)
class End:
    """One end of a carry."""

    error_s: float
    """The time found less the recorded one [s]; NaN where nothing was found to move."""

    miss: Miss | None
    """Why it was missed, if it was."""

    shift_m: float
    """How far the object is from its recorded end between the two times, at most [m]."""


@dataclass(frozen=True, slots=True)
class Carry:
    """An object that a recorder saw from the moment of grasp to that of release."""

    name: str
    onset: End
    offset: End


def measure(name: str, recorded: Stream, thresholds: Thresholds | None = None) -> Carry:
    """Find the ends of a carry, from its motion alone.

    The object is extended at rest before its first and after its last pose, so that where its
    stream begins or ends tells nothing.

    Args:
        name: The object.
        recorded: Its poses from grasp to release, on any clock.
        thresholds: What separates motion from rest.
    """
    limits = thresholds or Thresholds()
    begin, finish = float(recorded.times[0]), float(recorded.times[-1])
    clock = np.arange(begin - REST_S, finish + REST_S, 1.0 / RATE_HZ)
    whole = resampled(recorded, clock, extend="rest")
    stream = Stream(clock - clock[0], whole.positions, whole.orientations)
    poses = poses_of(TagObject("thing", TagType.MOBILE, stream), limits)
    floor = motion_floor(poses.noise, RATE_HZ, own_m=None, thresholds=limits)
    rests = rest_poses(poses, floor, limits)
    found = moving(poses, rests, floor, limits)
    if not found:
        ends = (_end(recorded, finish, 0, limits), _end(recorded, begin, -1, limits))
        onset, offset = (replace(each, error_s=float("nan")) for each in ends)
        return Carry(name, onset, offset)
    first = motion_edges(poses, found[0], rests, limits)[0]
    last = motion_edges(poses, found[-1], rests, limits)[1]
    return Carry(
        name,
        _end(recorded, float(clock[first]), 0, limits),
        _end(recorded, float(clock[last]), -1, limits),
    )


def near(carries: Iterable[Carry]) -> np.ndarray:
    """Whether onset and offset of each carry were found near: carries, 2."""
    return np.array([[each.onset.miss is None, each.offset.miss is None] for each in carries])


def _end(recorded: Stream, found_s: float, at: int, limits: Thresholds) -> End:
    """An end at the stream's first (0) or last (-1) pose."""
    error = found_s - float(recorded.times[at])
    between = np.sort([found_s, float(recorded.times[at])])
    part = (recorded.times >= between[0] - 1e-9) & (recorded.times <= between[1] + 1e-9)
    part[at] = True
    away = np.linalg.norm(recorded.positions[part] - recorded.positions[at], axis=1)
    turned = geometry.angle_between(recorded.orientations[part], recorded.orientations[[at]])
    shift, angle = float(np.nanmax(away)), float(np.nanmax(turned))
    if abs(error) <= NEAR_S:
        return End(error, None, shift)
    if shift <= limits.edge_m and angle <= limits.edge_rad:
        return End(error, Miss.STILL, shift)
    small = shift <= limits.motion_floor_m and angle <= limits.motion_floor_rad
    return End(error, Miss.CREEPS if small else Miss.MOVES, shift)
