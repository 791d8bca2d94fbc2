"""Closed-form motion: minimum-jerk moves along curves, with stillness between them."""

from dataclasses import dataclass
from typing import Protocol

import numpy as np
from jaxtyping import Float
from scipy.spatial.transform import RigidTransform, Rotation

Vector = tuple[float, float, float]


class Path(Protocol):
    """Where a body is at any time."""

    def at(self, times: Float[np.ndarray, "frames"]) -> RigidTransform:
        """``T_world_body`` at each time [s]."""
        ...


def minimum_jerk(
    tau: Float[np.ndarray, "frames"], *, launch: float = 0.0, halt: float = 0.0
) -> Float[np.ndarray, "frames"]:
    """Share of the way at a share of the time, from rest to rest, of least squared jerk.

    Among all ways with given accelerations at both ends the quintic has the least squared jerk
    (Flash and Hogan 1985); with none it is 10 t^3 - 15 t^4 + 6 t^5.

    Args:
        tau: Share of the time [1]; held at the ends outside [0, 1].
        launch: Acceleration at the start [ways / duration^2].
        halt: Deceleration at the end [ways / duration^2]: what is touched stops the hand.
    """
    t = np.clip(tau, 0.0, 1.0)
    rest = 1.0 - t
    plain = t**3 * (10.0 - 15.0 * t + 6.0 * t**2)
    ends = 0.5 * launch * t**2 * rest**3 - 0.5 * halt * t**3 * rest**2
    return np.asarray(plain + ends)


@dataclass(frozen=True, eq=False)
class Move:
    """From rest to rest along a cubic Bezier curve, while the orientation turns along an arc."""

    start_s: float
    end_s: float
    begin: RigidTransform
    end: RigidTransform
    depart: Vector | None = None
    """From the beginning to the first handle of the curve [m]; None makes the way straight."""

    arrive: Vector | None = None
    """From the last handle to the end [m]."""

    launch_mps2: float = 0.0
    halt_mps2: float = 0.0

    def share(self, times: Float[np.ndarray, "frames"]) -> Float[np.ndarray, "frames"]:
        """Share of the curve's parameter at each time [1]."""
        duration = self.end_s - self.start_s
        first, last = (3.0 * float(np.linalg.norm(each)) for each in self._handles())
        launch = self.launch_mps2 * duration**2 / first if first else 0.0
        halt = self.halt_mps2 * duration**2 / last if last else 0.0
        return minimum_jerk((times - self.start_s) / duration, launch=launch, halt=halt)

    def at(self, times: Float[np.ndarray, "frames"]) -> RigidTransform:
        """``T_world_body`` at each time [s]."""
        s = self.share(times)[:, None]
        first, last = self.begin.translation, self.end.translation
        depart, arrive = self._handles()
        position = (
            (1.0 - s) ** 3 * first
            + 3.0 * (1.0 - s) ** 2 * s * (first + depart)
            + 3.0 * (1.0 - s) * s**2 * (last - arrive)
            + s**3 * last
        )
        turn = (self.begin.rotation.inv() * self.end.rotation).as_rotvec()
        rotation = self.begin.rotation * Rotation.from_rotvec(s * turn)
        return RigidTransform.from_components(position, rotation)

    def _handles(self) -> tuple[np.ndarray, np.ndarray]:
        third = (self.end.translation - self.begin.translation) / 3.0
        return (
            third if self.depart is None else np.asarray(self.depart),
            third if self.arrive is None else np.asarray(self.arrive),
        )


@dataclass(frozen=True, eq=False)
class Still:
    """A body that stays where it is."""

    pose: RigidTransform

    def at(self, times: Float[np.ndarray, "frames"]) -> RigidTransform:
        """``T_world_body``, the same at each time."""
        return RigidTransform.concatenate([self.pose] * len(times))


@dataclass(frozen=True, eq=False)
class Moves:
    """One move after the other, and rest before, between and after them."""

    moves: tuple[Move, ...]

    def at(self, times: Float[np.ndarray, "frames"]) -> RigidTransform:
        """``T_world_body`` at each time [s]."""
        out = np.empty((len(times), 4, 4))
        latest = np.zeros(len(times), dtype=int)
        for number, move in enumerate(self.moves[1:], 1):
            latest[times >= move.start_s] = number
        for number in np.unique(latest):
            now = latest == number
            out[now] = self.moves[number].at(times[now]).as_matrix()
        return RigidTransform.from_matrix(out)


@dataclass(frozen=True, eq=False)
class Riding:
    """A body with a path of its own that is fixed to another for a while."""

    own: Path
    leader: Path
    grip: RigidTransform
    """``T_leader_body`` while it rides."""

    start_s: float
    end_s: float = np.inf

    def at(self, times: Float[np.ndarray, "frames"]) -> RigidTransform:
        """``T_world_body`` at each time [s]."""
        out = self.own.at(times).as_matrix()
        riding = (times >= self.start_s) & (times <= self.end_s)
        if riding.any():
            out[riding] = (self.leader.at(times[riding]) * self.grip).as_matrix()
        return RigidTransform.from_matrix(out)


@dataclass(frozen=True, eq=False)
class Swaying:
    """A path with the slow sway of a standing body on top of it."""

    own: Path
    amplitude_m: float
    frequency_hz: float = 0.31
    nod_rad: float = 0.01

    def at(self, times: Float[np.ndarray, "frames"]) -> RigidTransform:
        """``T_world_body`` at each time [s]."""
        phase = 2.0 * np.pi * self.frequency_hz * times
        sway = np.stack([np.sin(phase), np.cos(0.7 * phase), 0.3 * np.sin(1.3 * phase)], axis=1)
        nod = np.stack([0.0 * phase, np.sin(0.9 * phase), np.cos(0.6 * phase)], axis=1)
        own = self.own.at(times)
        return RigidTransform.from_components(
            own.translation + self.amplitude_m * sway,
            own.rotation * Rotation.from_rotvec(self.nod_rad * nod),
        )


def pose(place: Vector | np.ndarray, rotation: Rotation | None = None) -> RigidTransform:
    """``T_world_body`` of one place [m] and orientation."""
    return RigidTransform.from_components(
        np.asarray(place, dtype=float), Rotation.identity() if rotation is None else rotation
    )


def aimed(*, x: Vector | np.ndarray, z: Vector | np.ndarray) -> Rotation:
    """The orientation whose first axis lies along ``x`` and whose third lies nearest to ``z``."""
    first = np.asarray(x, dtype=float) / np.linalg.norm(x)
    third = np.asarray(z, dtype=float) - first * float(np.dot(first, z))
    third = third / np.linalg.norm(third)
    return Rotation.from_matrix(np.stack([first, np.cross(third, first), third], axis=1))
