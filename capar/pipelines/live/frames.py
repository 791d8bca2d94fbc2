"""Frames of a live recording: from a tracker, in a window, and as a capture."""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from tempfile import TemporaryFile

import numpy as np
from jaxtyping import Float

from capar.model.capture import Capture, Sensor, Stream, TagObject
from capar.model.errors import CaptureError, DeviceError
from extractors.devices.tracker import Description, Frame


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


class RecordedFrames:
    """Every frame of a recording, on disk until it ends: memory does not grow with it.

    Args:
        rig: Bodies, shapes, agents; the poses of its streams are not read.
    """

    def __init__(self, rig: Capture) -> None:
        self._rig = rig
        self._file = TemporaryFile()  # noqa: SIM115
        self._bodies = len(body_names(rig))

    def push(self, poses: Poses) -> None:
        """Keep a frame."""
        row = np.concatenate(([poses.time_s], poses.positions.ravel(), poses.orientations.ravel()))
        self._file.write(row.tobytes())

    def capture(self) -> Capture:
        """All frames as a capture.

        Raises:
            CaptureError: There are fewer than two.
        """
        self._file.seek(0)
        table = np.frombuffer(self._file.read()).reshape(-1, 1 + 7 * self._bodies)
        if len(table) < 2:
            raise CaptureError("a live recording of fewer than two frames: nothing can be observed")
        places, turns = np.split(table[:, 1:], [3 * self._bodies], axis=1)
        streams = [
            Stream(
                table[:, 0].copy(),
                places[:, 3 * row : 3 * row + 3].copy(),
                turns[:, 4 * row : 4 * row + 4].copy(),
            )
            for row in range(self._bodies)
        ]
        rows = _distinct(self._rig)
        return with_streams(self._rig, {name: streams[row] for name, row in rows.items()})


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


LONGEST_LOSS_S = 10.0
"""A longer silence is not filled with lost frames [s]: the clock goes on from there."""


class DeviceFrames:
    """Puts frames of a tracker in the order of a rig's bodies and on the rig's clock.

    Bodies that the tracker does not know stand where they stand in the rig's first known frame;
    so do tables and walls. Of cycles that were lost every body is lost.

    Args:
        rig: Bodies, by the names of the tracker's sensors.
        names: Names of the bodies of a frame's rows, in order.
        description: The tracker.
        step_s: Time between two frames [s].

    Raises:
        DeviceError: The tracker has none of the rig's moving bodies, or no full poses.
    """

    def __init__(
        self, rig: Capture, names: Sequence[str], description: Description, step_s: float
    ) -> None:
        known = {name: index for index, name in enumerate(description.sensors)}
        self._rows = [known.get(name.split(" ", 1)[1], -1) for name in names]
        untracked = [
            each.split(" ", 1)[1] for each, row in zip(names, self._rows, strict=True) if row < 0
        ]
        moving = [each for each in untracked if not _stands(rig.bodies[each])]
        if moving or not (description.has_positions and description.has_orientations):
            raise DeviceError(
                f"the tracker sends positions and orientations of {list(description.sensors)}; "
                f"the rig also needs {moving}, which move. Name the tracker's sensors as the rig "
                "does, with names=... in the device address, or take a rig of that tracker"
            )
        self._still = [_first_pose(rig.bodies[each.split(" ", 1)[1]]) for each in names]
        self._step_s = step_s
        self._rate_hz = description.rate_hz
        self._count = 0
        self._start_s = 0.0
        self.filled = 0
        """Frames that were missing, and are told as lost."""

    def poses(self, frame: Frame) -> Iterator[Poses]:
        """The frame, after lost frames in place of those that are missing before it."""
        time_s = self._measured_s(frame)
        if time_s is not None:
            missing = round((time_s - self._start_s) / self._step_s) - self._count
            if self._count == 0 or missing < 0 or missing > LONGEST_LOSS_S / self._step_s:
                # The first frame, or a device that counts anew.
                self._start_s = time_s - self._count * self._step_s
                missing = 0
            for _ in range(missing):
                yield self._next(None)
            self.filled += missing
        yield self._next(frame)

    def _next(self, frame: Frame | None) -> Poses:
        positions, orientations = (
            np.full((len(self._rows), 3), np.nan),
            np.full((len(self._rows), 4), np.nan),
        )
        for index, row in enumerate(self._rows):
            if row < 0:
                positions[index], orientations[index] = self._still[index]
            elif frame is not None:
                positions[index] = frame.positions[row]
                orientations[index] = frame.orientations[row]
        time_s = self._count * self._step_s
        self._count += 1
        return Poses(time_s, positions, orientations)

    def _measured_s(self, frame: Frame) -> float | None:
        """When a frame was measured by the device's own clock [s]; None where it has none.

        The time of arrival jitters by more than a step: such frames are taken to be even.
        """
        if frame.device_s is not None:
            return frame.device_s
        if frame.cycle is not None and np.isfinite(self._rate_hz):
            return frame.cycle / self._rate_hz
        return None


def _stands(body: Sensor | TagObject) -> bool:
    """Whether a body stands at one place throughout."""
    seen = body.stream.positions[~body.stream.lost]
    return bool(len(seen) and np.ptp(seen, axis=0).max() < STANDS_M)


STANDS_M = 0.02  # What has not gone farther in the rig's own recording stands [m]: noise is less.


def _first_pose(body: Sensor | TagObject) -> tuple[np.ndarray, np.ndarray]:
    known = np.flatnonzero(~body.stream.lost)
    if not known.size:
        return np.full(3, np.nan), np.full(4, np.nan)
    return body.stream.positions[known[0]], body.stream.orientations[known[0]]


SHORTEST_S = 1.0  # A shorter lead-in shows neither noise at rest nor what rests on what [s].


def lead_in(capture: Capture, seconds: float) -> Capture:
    """The first seconds of a recorded capture.

    Raises:
        CaptureError: They are fewer than needed.
    """
    frames = [each for each in replayed(capture) if each.time_s <= seconds]
    return capture_of(capture, frames)


def capture_of(rig: Capture, frames: Sequence[Poses]) -> Capture:
    """Frames as a capture of a rig.

    Raises:
        CaptureError: They are fewer than needed.
    """
    lasts_s = frames[-1].time_s - frames[0].time_s if frames else 0.0
    if lasts_s < SHORTEST_S:
        raise CaptureError(
            f"a lead-in of {lasts_s:.2f} s: expected at least {SHORTEST_S:g} s, to tell noise"
        )
    buffer = FrameBuffer(rig, len(frames))
    for frame in frames:
        buffer.push(frame)
    return buffer.window(len(frames)).capture
