"""The last seconds of a live recording as a capture on the recording's own clock."""

from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np
from jaxtyping import Float

from capar.model.capture import Capture, Sensor, Stream, TagObject
from capar.model.errors import CaptureError


@dataclass(frozen=True, slots=True, eq=False)
class Poses:
    """One frame: where every body of a rig is."""

    time_s: float
    """Seconds since the first frame, later than that of the frame before."""

    positions: Float[np.ndarray, "bodies 3"]
    """World positions [m]; NaN where a body was lost."""

    orientations: Float[np.ndarray, "bodies 4"]
    """Unit quaternions w x y z, body to world; NaN where a body was lost."""


@dataclass(frozen=True, slots=True, eq=False)
class Window:
    """Some frames in a row, as a capture."""

    first: int
    """The frame of the recording with which it begins."""

    capture: Capture

    @property
    def last(self) -> int:
        """The frame of the recording with which it ends."""
        return self.first + len(self.capture.times) - 1


class FrameBuffer:
    """Holds the last frames of all bodies of a rig, and no more.

    Args:
        rig: Bodies, shapes, agents; the poses of its streams are not read.
        longest: Most frames that are asked for.
    """

    def __init__(self, rig: Capture, longest: int) -> None:
        self.rig = rig
        self.streams = _distinct(rig)
        bodies = len(set(self.streams.values()))
        self.longest = longest
        """Most frames that a window holds."""

        self._times = np.empty(2 * longest)
        self._positions = np.empty((2 * longest, bodies, 3))
        self._orientations = np.empty((2 * longest, bodies, 4))
        self._filled = 0
        self.count = 0
        """Frames that were pushed since the beginning."""

    def push(self, poses: Poses) -> None:
        """Add a frame.

        Raises:
            CaptureError: It is of another number of bodies, or not later than the one before.
        """
        expected = self._positions.shape[1]
        if poses.positions.shape != (expected, 3) or poses.orientations.shape != (expected, 4):
            raise CaptureError(
                f"a frame of positions {poses.positions.shape} and orientations "
                f"{poses.orientations.shape}; the rig has {expected} bodies: {list(self.bodies)}"
            )
        if self._filled and not poses.time_s > self._times[self._filled - 1]:
            raise CaptureError(
                f"frame {self.count} at {poses.time_s:.6f} s does not follow the one before at "
                f"{self._times[self._filled - 1]:.6f} s"
            )
        if self._filled == len(self._times):
            self._forget()
        self._times[self._filled] = poses.time_s
        self._positions[self._filled] = poses.positions
        self._orientations[self._filled] = poses.orientations
        self._filled += 1
        self.count += 1

    @property
    def bodies(self) -> tuple[str, ...]:
        """The bodies of a frame's rows, in order; of one that is two things, its first name."""
        return body_names(self.rig)

    def time_s(self, frame: int) -> float:
        """The time of a frame that is still held [s]."""
        return float(self._times[frame - (self.count - self._filled)])

    def window(self, frames: int) -> Window:
        """The last frames, as many as there are of those asked for."""
        begin = self._filled - min(frames, self._filled, self.longest)
        part = slice(begin, self._filled)
        rows: dict[int, Stream] = {}
        for row in set(self.streams.values()):
            rows[row] = Stream(
                self._times[part].copy(),
                self._positions[part, row].copy(),
                self._orientations[part, row].copy(),
            )
        by_name: Mapping[str, Stream] = {name: rows[row] for name, row in self.streams.items()}
        return Window(self.count - (self._filled - begin), with_streams(self.rig, by_name))

    def _forget(self) -> None:
        """Keep the last frames only."""
        kept = slice(self._filled - self.longest, self._filled)
        for rows in (self._times, self._positions, self._orientations):
            rows[: self.longest] = rows[kept].copy()
        self._filled = self.longest


def body_names(rig: Capture) -> tuple[str, ...]:
    """The bodies of a frame's rows, in order, as ``sensor NAME`` or ``object NAME``."""
    firsts: dict[int, str] = {}
    for name, row in _distinct(rig).items():
        firsts.setdefault(row, name)
    return tuple(firsts[row] for row in sorted(firsts))


def with_streams(rig: Capture, streams: Mapping[str, Stream]) -> Capture:
    """A rig whose bodies move as some streams say, by ``sensor NAME`` and ``object NAME``."""
    sensors = tuple(replace(each, stream=streams[_key(each)]) for each in rig.sensors)
    objects = tuple(replace(each, stream=streams[_key(each)]) for each in rig.objects)
    return replace(rig, sensors=sensors, objects=objects)


def replayed(capture: Capture) -> list[Poses]:
    """The frames of a recorded capture, as a tracker would have given them."""
    everything = {_key(each): each.stream for each in _bodies(capture)}
    streams = [everything[name] for name in body_names(capture)]
    positions = np.stack([each.positions for each in streams], axis=1)
    orientations = np.stack([each.orientations for each in streams], axis=1)
    return [
        Poses(float(time_s), positions[frame], orientations[frame])
        for frame, time_s in enumerate(capture.times)
    ]


def _distinct(rig: Capture) -> dict[str, int]:
    """The row of each body's stream; an object that is also a sensor shares its row."""
    rows: dict[int, int] = {}
    return {_key(each): rows.setdefault(id(each.stream), len(rows)) for each in _bodies(rig)}


def _bodies(rig: Capture) -> tuple[Sensor | TagObject, ...]:
    return (*rig.sensors, *rig.objects)


def _key(body: Sensor | TagObject) -> str:
    return f"{'sensor' if isinstance(body, Sensor) else 'object'} {body.name}"
