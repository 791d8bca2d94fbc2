"""What simulated trackers measure: a generated smooth motion, or a capture played in a loop."""

from dataclasses import dataclass
from typing import Protocol

import numpy as np
from jaxtyping import Float
from scipy.spatial.transform import Rotation

from capar.model.capture import Capture
from capar.model.errors import DeviceError, UnknownNameError

Poses = tuple[Float[np.ndarray, "sensors 3"], Float[np.ndarray, "sensors 4"]]


class MotionSource(Protocol):
    """Poses of some sensors at any time."""

    @property
    def sensors(self) -> tuple[str, ...]:
        """Their names."""

    def poses(self, time_s: float) -> Poses:
        """Positions [m] and orientations (w x y z), z up, at a time [s]."""


@dataclass(frozen=True)
class SmoothMotion:
    """Every sensor goes round a path of its own, turning, within half a metre of the tracker."""

    count: int

    @property
    def sensors(self) -> tuple[str, ...]:
        """``sensor1`` and so on."""
        return tuple(f"sensor{index + 1}" for index in range(self.count))

    def poses(self, time_s: float) -> Poses:
        """Positions [m] and orientations (w x y z), z up, at a time [s]."""
        index = np.arange(self.count)
        phase = 2.0 * np.pi * time_s * 0.3 + 0.5 * index
        swing = np.stack([np.sin(phase), np.sin(2.0 * phase + 1.0), np.cos(phase)], axis=1)
        positions = np.array([0.3, 0.0, 0.0]) + swing * [0.15, 0.3, 0.25]
        angles = np.stack([phase, 0.8 * np.sin(phase), 0.5 * np.cos(2.0 * phase)], axis=1)
        turns = Rotation.from_euler("ZYX", angles)
        return positions, turns.as_quat(scalar_first=True)


class CapturedMotion:
    """A capture's bodies, played again and again; a lost body stays where it was seen last.

    Args:
        capture: What is played.
        names: Which of its sensors and objects; all, where it is empty.

    Raises:
        UnknownNameError: The capture has no body of a name.
        DeviceError: A body was never seen.
    """

    def __init__(self, capture: Capture, names: tuple[str, ...] = ()) -> None:
        for name in names:
            if name not in capture.bodies:
                raise UnknownNameError("body", name, capture.bodies, where=capture.name)
        self._names = names or tuple(capture.bodies)
        self._times = capture.times - capture.times[0]
        streams = [capture.bodies[name].stream for name in self._names]
        for name, stream in zip(self._names, streams, strict=True):
            if stream.lost.all():
                raise DeviceError(f"{name} is lost throughout {capture.name}; leave it out")
        seen = [_last_seen(stream.lost) for stream in streams]
        self._positions = np.stack(
            [each.positions[at] for each, at in zip(streams, seen, strict=True)], axis=1
        )
        self._orientations = np.stack(
            [each.orientations[at] for each, at in zip(streams, seen, strict=True)], axis=1
        )

    @property
    def sensors(self) -> tuple[str, ...]:
        """The bodies' names."""
        return self._names

    def poses(self, time_s: float) -> Poses:
        """Positions [m] and orientations (w x y z), z up, of the last frame before a time [s]."""
        step_s = self._times[-1] / (len(self._times) - 1)
        within = time_s % (self._times[-1] + step_s)
        frame = int(np.searchsorted(self._times, within, side="right")) - 1
        return self._positions[frame], self._orientations[frame]


def _last_seen(lost: np.ndarray) -> np.ndarray:
    """For each frame the last one that was not lost; before the first, the first."""
    seen = np.flatnonzero(~lost)
    return seen[np.maximum(np.searchsorted(seen, np.arange(len(lost)), side="right") - 1, 0)]
