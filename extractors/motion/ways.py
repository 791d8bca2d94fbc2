"""How far a body has gone from a place, told by its own poses and by what moves as one with it."""

from collections.abc import Collection
from dataclasses import dataclass

import numpy as np
from jaxtyping import Float, Int

from capar.model import geometry
from capar.model.capture import Stream
from extractors.bodies.poses import Poses, rotation_matrices
from extractors.motion.object_motion import Floor, RestPose
from extractors.motion.onsets import QUIET, Ways

AS_ONE = 2.0
"""Poses of two that move as one differ by so many deviations of what noise the filter leaves [1];
the more they differ beyond that, the less the one tells of the other."""

REFINED = 2
"""How often it is estimated how the one sits on the other [1]: from the motion, then from all
frames in which the two agree with that."""

Frames = Int[np.ndarray, "frames"]
Places = Float[np.ndarray, "frames 3"]
Turns = Float[np.ndarray, "frames 4"]


@dataclass(frozen=True, slots=True, eq=False)
class Direction:
    """Where a body goes to, or about what it turns, from a place."""

    stay: RestPose
    to: Float[np.ndarray, "3"]
    """Direction in the world, in units of displacement [1/m or 1/rad]."""

    turns: bool
    """Whether it is an axis that the body turns about."""

    def along(self, places: Places, turns: Turns) -> Ways:
        """Displacement along it at each pose [1]; NaN where the pose is unknown."""
        return np.asarray(
            (_turned(turns, self.stay) if self.turns else places - self.stay.position) @ self.to
        )

    def noise(self, poses: Poses, lever_m: float = 0.0) -> float:
        """Deviation along it [1] of a body as recorded, or of a point so far from its origin."""
        noise = poses.noise
        goes = float(np.hypot(noise.position_m, lever_m * noise.orientation_rad))
        along = noise.orientation_rad if self.turns else goes
        return max(float(np.linalg.norm(self.to)) * along, QUIET)


@dataclass(frozen=True, slots=True, eq=False)
class Mount:
    """How a body sits on another one that it moves with."""

    lever: Float[np.ndarray, "3"]
    """Its origin in the frame of the other [m]."""

    turn: Float[np.ndarray, "4"]
    """Its orientation in that frame, a unit quaternion w x y z."""

    def carried(self, stream: Stream, frames: Frames) -> tuple[Places, Turns]:
        """Its poses by those of the other."""
        turns = stream.orientations[frames]
        places = stream.positions[frames] + rotation_matrices(turns) @ self.lever
        return places, geometry.products(turns, self.turn[None])


def way_out(
    poses: Poses,
    partners: Collection[Poses],
    frames: Frames,
    seen: int,
    stay: RestPose,
    unit: Floor,
    left: float,
) -> tuple[Ways, Ways, Ways]:
    """How far a body goes toward its last pose, or turns, whichever is clearer.

    Where a hand holds a thing the pose of the thing follows from the hand's, whose sensor has noise
    of its own: the mean of both, weighted by inverse variances, has less noise than either. What
    the two differ by beyond noise, as while the hand still comes near, adds to the variance of what
    the hand tells.

    Args:
        poses: The body's poses.
        partners: Those of what may move as one with it.
        frames: From the place to where it is well beyond it.
        seen: Index of the one at which it is first seen to have left the place.
        stay: The place.
        unit: The unit of displacement.
        left: What the filter leaves of a deviation of noise [1].

    Returns:
        Displacement as recorded and low-passed, and the deviation of each recorded one [1].
    """
    ahead = _direction(poses, int(frames[-1]), stay, unit)
    way, smooth = (ahead.along(*_at(stream, frames)) for stream in (poses.filled, poses.smooth))
    own = ahead.noise(poses)
    told = np.full(len(frames), own**-2)
    total = told * way
    for partner in partners:
        held = np.arange(len(frames)) >= seen
        for _ in range(REFINED):
            mount = _mount(poses, partner, frames, held.astype(float))
            its = ahead.noise(partner, float(np.linalg.norm(mount.lever)))
            calm = ahead.along(*mount.carried(partner.smooth, frames))
            differ = (smooth - calm) ** 2 - (AS_ONE * left) ** 2 * (own**2 + its**2)
            held = its**2 / (its**2 + np.maximum(differ, 0.0))
        raw = ahead.along(*mount.carried(partner.filled, frames))
        known = ~np.isnan(raw * held)
        total[known] += (raw * held)[known] / its**2
        told[known] += held[known] / its**2
    return total / told, smooth, np.asarray(told**-0.5)


def _at(stream: Stream, frames: Frames) -> tuple[Places, Turns]:
    return stream.positions[frames], stream.orientations[frames]


def _direction(poses: Poses, last: int, stay: RestPose, unit: Floor) -> Direction:
    """Where a body goes to until a frame, or about what it turns."""
    places, turns = _at(poses.smooth, np.array([last]))
    way, turn = places[0] - stay.position, _turned(turns, stay)[0]
    goes = np.linalg.norm(way) / unit.position_m >= np.linalg.norm(turn) / unit.rotation_rad
    to, one = (way, unit.position_m) if goes else (turn, unit.rotation_rad)
    return Direction(stay, to / (np.linalg.norm(to) * one), not goes)


def _mount(body: Poses, other: Poses, frames: Frames, held: Ways) -> Mount:
    """How a body sits on another one, in the mean over frames by how much it is held in each.

    It is NaN where it is never known.
    """
    places, turns = _at(body.smooth, frames)
    origins, bearings = _at(other.smooth, frames)
    known = ~np.isnan(places[:, 0] + origins[:, 0]) & (held > 0.0)
    if not known.any():
        return Mount(np.full(3, np.nan), np.full(4, np.nan))
    offsets = (places - origins)[known, None, :] @ rotation_matrices(bearings[known])
    within = geometry.products(_inverse(bearings[known]), turns[known])
    turn = held[known] @ within
    lever = np.average(offsets[:, 0], axis=0, weights=held[known])
    return Mount(lever, turn / np.linalg.norm(turn))


def _inverse(turns: Turns) -> Turns:
    return turns * np.array([1.0, -1.0, -1.0, -1.0])


def _turned(orientations: Turns, stay: RestPose) -> Places:
    """Rotation vectors from the orientation of a place [rad]; NaN where the body is lost."""
    turn = geometry.products(orientations, _inverse(stay.orientation[None]))
    turn = np.where(turn[:, :1] < 0.0, -turn, turn)
    sine = np.linalg.norm(turn[:, 1:], axis=1, keepdims=True)
    angle = 2.0 * np.arctan2(sine, turn[:, :1])
    # As the angle vanishes, the vector is twice the quaternion's.
    return np.asarray(turn[:, 1:] * np.where(sine > 0.0, angle / np.maximum(sine, 1e-300), 2.0))
