"""Bodies that move along closed-form paths; poses are 4 by 4 matrices, metres and seconds."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from math import comb, inf

import numpy as np
from jaxtyping import Float
from scipy.spatial.transform import Rotation

Poses = Float[np.ndarray, "frames 4 4"]
Times = Float[np.ndarray, "frames"]
UP = (0.0, 0.0, 1.0)
AHEAD = (1.0, 0.0, 0.0)
NEAR = (-1.0, 0.0, 0.0)
LEFTWARD = (0.0, 1.0, 0.0)
RIGHTWARD = (0.0, -1.0, 0.0)
"""Directions of the stage, as its performer sees them."""

Vector = Sequence[float] | Float[np.ndarray, "3"]


def min_jerk(share: Times) -> Times:
    """Way done of a minimum-jerk motion, from 0 to 1, after a share of its time."""
    tau = np.clip(share, 0.0, 1.0)
    return np.asarray(np.clip(tau**3 * (10.0 - 15.0 * tau + 6.0 * tau**2), 0.0, 1.0))


def quintic(share: Times, first: float, last: float) -> Times:
    """Way done from 0 to 1 with given slopes at both ends and no acceleration there."""
    tau = np.clip(share, 0.0, 1.0)
    rest = 1.0 - first
    slope = last - first
    return np.asarray(
        first * tau
        + (10.0 * rest - 4.0 * slope) * tau**3
        + (-15.0 * rest + 7.0 * slope) * tau**4
        + (6.0 * rest - 3.0 * slope) * tau**5
    )


def bezier(way: Times, controls: Float[np.ndarray, "points 3"]) -> Float[np.ndarray, "frames 3"]:
    """Points of a Bezier curve at parameters from 0 to 1."""
    degree = len(controls) - 1
    weights = [comb(degree, k) * way**k * (1.0 - way) ** (degree - k) for k in range(degree + 1)]
    return np.asarray(np.stack(weights, axis=1) @ controls)


def pose(
    position: Vector = (0.0, 0.0, 0.0), rotation: Rotation | None = None
) -> Float[np.ndarray, "4 4"]:
    """The matrix of a position and a rotation."""
    out = np.eye(4)
    out[:3, 3] = position
    if rotation is not None:
        out[:3, :3] = rotation.as_matrix()
    return out


def facing(ahead: Vector, fingers: Vector) -> Rotation:
    """The rotation whose x axis points ahead and whose y axis is nearest to another direction."""
    x = np.asarray(ahead, dtype=float)
    x = x / np.linalg.norm(x)
    y = np.asarray(fingers, dtype=float)
    y = y - (y @ x) * x
    y = y / np.linalg.norm(y)
    return Rotation.from_matrix(np.stack([x, y, np.cross(x, y)], axis=1))


def about(point: Vector, axis: Vector, angles: Times) -> Poses:
    """Turns of the world about an axis through a point, one for each angle [rad]."""
    along = np.asarray(axis, dtype=float)
    turns = Rotation.from_rotvec(np.outer(angles, along / np.linalg.norm(along)))
    out = np.tile(np.eye(4), (len(angles), 1, 1))
    out[:, :3, :3] = turns.as_matrix()
    out[:, :3, 3] = np.asarray(point) - turns.apply(np.asarray(point))
    return out


@dataclass
class Piece:
    """A stretch of a body's motion; after its end the body keeps its last pose."""

    start: float
    end: float
    law: Callable[[Times], Poses]
    """Poses at times [s] from the start to the end."""


@dataclass
class Body:
    """Something that has a pose at every time."""

    name: str
    first: Float[np.ndarray, "4 4"]
    pieces: list[Piece] = field(default_factory=list)

    def poses(self, times: Times) -> Poses:
        """Poses at times [s]."""
        out = np.tile(self.first, (len(times), 1, 1))
        latest = np.full(len(times), -1)
        for number, piece in enumerate(self.pieces):
            latest[times >= piece.start] = number
        for number in np.unique(latest[latest >= 0]):
            now, piece = latest == number, self.pieces[number]
            out[now] = piece.law(np.minimum(times[now], piece.end))
        return out

    def at(self, time: float) -> Float[np.ndarray, "4 4"]:
        """The pose at one time [s]."""
        return np.asarray(self.poses(np.array([time]))[0])

    def play(self, start: float, end: float, law: Callable[[Times], Poses]) -> None:
        """Move by a law of the time since the start."""
        self.pieces.append(Piece(start, end, lambda times: law(times - start)))

    def shift(self, start: float, end: float, way: Callable[[Times], np.ndarray]) -> None:
        """Move without turning by a displacement [m] that is a law of the time since the start."""
        base = self.at(start)

        def law(since: Times) -> Poses:
            out = np.tile(base, (len(since), 1, 1))
            out[:, :3, 3] += way(since)
            return out

        self.play(start, end, law)

    def turn(
        self, start: float, end: float, point: Vector, axis: Vector, law: Callable[[Times], Times]
    ) -> None:
        """Turn about an axis through a point by an angle [rad] that is a law of time."""
        base = self.at(start)
        self.play(start, end, lambda since: about(point, axis, law(since)) @ base)

    def ride(self, carrier: "Body", start: float) -> Piece:
        """Move rigidly with another body from a time on, until the piece's end is set."""
        own = np.linalg.inv(carrier.at(start)) @ self.at(start)
        piece = Piece(start, inf, lambda times: carrier.poses(times) @ own)
        self.pieces.append(piece)
        return piece
