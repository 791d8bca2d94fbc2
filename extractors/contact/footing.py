"""Feet on the ground: a foot that glides over it fast is not set down; and a ground that moves."""

from collections.abc import Iterator, Mapping, Sequence

import numpy as np
from jaxtyping import Bool, Float

from capar.model.calibration import MovingGround
from capar.model.capture import Capture, TagType
from extractors.bodies.bodies import Bodies
from extractors.bodies.body_geometry import BodyGeometry, blocks
from extractors.contact.proximity import near
from extractors.contact.touch_distances import touchable
from extractors.motion.rest import resting
from extractors.thresholds import Thresholds

FOOT = "foot"
"""The general type of an end-effector that may stand."""


def soles(capture: Capture) -> Mapping[str, str]:
    """The agent of each sensor that is an acting foot, or is part of one, by sensor."""
    return {
        part.name: capture.agent_of(part)
        for foot in capture.acting
        if foot.end_effector == FOOT
        for part in capture.parts_of(foot.name)
    }


def gliding(
    foot: BodyGeometry,
    ground: BodyGeometry,
    thresholds: Thresholds,
    ground_mps: tuple[float, float] = (0.0, 0.0),
) -> Bool[np.ndarray, "frames"]:
    """Frames in which no part of a foot's underside is nearly still against the ground.

    Only a foot whose middle is above the whole ground can glide over it; what it does to walls is
    not asked here, nor is a slope or a room whose floor and walls are one body.

    Args:
        foot: The foot.
        ground: A fixed body that it may stand on.
        thresholds: How slowly a foot that is set down shifts.
        ground_mps: The level velocity of the ground's surface [m/s].
    """
    pace = np.linalg.norm(sole_velocities(foot, thresholds, ground_mps) - ground_mps, axis=1)
    with np.errstate(invalid="ignore"):
        above = foot.middles[:, 2] > ground.boxes[1][:, 2]
        return np.asarray(above & (pace > thresholds.foot_glides_mps))


def sole_velocities(
    foot: BodyGeometry, thresholds: Thresholds, ground_mps: tuple[float, float] = (0.0, 0.0)
) -> Float[np.ndarray, "frames 2"]:
    """Level velocity of the lowest part of a foot that is stillest against the ground [m/s].

    A foot rolls over its heel and its ball: while any of its lowest points is still, it stands.
    Beside a loss of tracking the nearest velocity that is known is taken.
    """
    count = len(foot.middles)
    out = np.full((count, 2), np.nan)
    if count < 2:
        return out
    stream = foot.poses.smooth
    for block in blocks(count):
        first, last = max(block.start - 1, 0), min(block.stop + 1, count)
        points = foot.middles[first:last, None] + np.swapaxes(
            foot.turns_at(slice(first, last)) @ foot.corners.T, 1, 2
        )
        moves = np.gradient(points[:, :, :2], stream.times[first:last], axis=0)
        height = points[:, :, 2]
        lowest = height <= height.min(axis=1, keepdims=True) + thresholds.patch_m
        pace = np.linalg.norm(moves - ground_mps, axis=2)
        pace = np.where(lowest & ~np.isnan(pace), pace, np.inf)
        stillest = moves[np.arange(len(moves)), pace.argmin(axis=1)]
        out[block] = stillest[block.start - first : block.stop - first]
    return _known_nearest(out, foot.poses.lost)


def _known_nearest(
    velocities: Float[np.ndarray, "frames 2"], lost: Bool[np.ndarray, "frames"]
) -> Float[np.ndarray, "frames 2"]:
    """Velocities with those that are unknown beside a loss filled; where lost they stay unknown."""
    unknown = np.isnan(velocities).any(axis=1)
    known = np.flatnonzero(~unknown)
    for frame in np.flatnonzero(unknown & ~lost) if known.size else ():
        velocities[frame] = velocities[known[np.abs(known - frame).argmin()]]
    return velocities


def moving_grounds(
    capture: Capture, bodies: Bodies, touch_m: Mapping[tuple[str, str], float], limits: Thresholds
) -> Iterator[MovingGround]:
    """Grounds over which the two feet of an agent go by steadily: the belts of treadmills.

    A ground is taken to move if neither foot ever rests in the world, and if each of them, through
    most of its contact with the ground, has the same velocity, beyond that of a foot that is set
    down. Against a belt that has stopped for a while feet rest, and no velocity is found; who
    glides on skates without a rest cannot be told from who walks on a belt.

    Args:
        capture: The recording.
        bodies: Its bodies.
        touch_m: Distance up to which each pair of bodies touches [m].
        limits: How slowly a foot that is set down shifts, and in what share of its contact.
    """
    feet: dict[str, list[BodyGeometry]] = {}
    for name, agent in soles(capture).items():
        feet.setdefault(agent, []).append(bodies.sensors[name])
    grounds = [thing.name for thing in capture.objects if thing.tag is TagType.FIXED]
    for agent, own in feet.items():
        if len(own) < 2 or any(resting(foot.poses, limits) for foot in own):
            continue
        for name in grounds:
            distances = [touch_m.get((foot.name, name)) for foot in own]
            velocity = _common_velocity(own, bodies.objects[name], distances, limits)
            if velocity is not None:
                yield MovingGround(agent, name, velocity)


def _common_velocity(
    feet: Sequence[BodyGeometry],
    ground: BodyGeometry,
    distances_m: Sequence[float | None],
    limits: Thresholds,
) -> tuple[float, float] | None:
    """The velocity that every foot has through most of its contact with a ground [m/s]."""
    moves = []
    for foot, distance_m in zip(feet, distances_m, strict=True):
        surfaces = touchable(foot), touchable(ground)
        if distance_m is None or surfaces[0] is None or surfaces[1] is None:
            return None
        down = near(surfaces[0], surfaces[1], distance_m=distance_m)
        own = sole_velocities(foot, limits)[down]
        own = own[~np.isnan(own).any(axis=1)]
        times = foot.poses.smooth.times
        if len(own) * float(times[1] - times[0]) < limits.rest_minimum_s:
            return None
        moves.append(own)
    middle = np.median([np.median(own, axis=0) for own in moves], axis=0)
    if np.hypot(*middle) <= limits.foot_glides_mps:
        return None
    steady = [np.linalg.norm(own - middle, axis=1) <= limits.foot_glides_mps for own in moves]
    if min(frames.mean() for frames in steady) < limits.belt_share:
        return None
    with_it = np.concatenate([own[frames] for own, frames in zip(moves, steady, strict=True)])
    x, y = (float(value) for value in np.median(with_it, axis=0))
    return x, y
