"""Frames of a live recording: from a tracker or a capture, in a window, and as a capture."""

import time
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from tempfile import TemporaryFile

import numpy as np
from jaxtyping import Float

from capar.model.capture import Capture, Sensor, Stream, TagObject
from capar.model.errors import CaptureError, DeviceError
from extractors.devices.tracker import Description, Frame
from extractors.signals.intervals import time_step

LONGEST_LOSS_S = 10.0
"""A longer silence is not filled with lost frames [s]: the clock goes on from there."""

STANDS_M = 0.02
"""What has not gone farther in the rig's own recording stands [m]: noise is less."""

SHORTEST_S = 1.0
"""A shorter lead-in shows neither noise at rest nor what rests on what [s]."""

WAIT_S = 0.02
"""Pause while no frame of a replayed capture is due [s]."""


@dataclass(frozen=True, slots=True, eq=False)
class Poses:
    """One frame: where every body of a rig is."""

    time_s: float
    """Seconds since the first frame, later than that of the frame before."""

    positions: Float[np.ndarray, "bodies 3"]
    """World positions [m]; NaN where a body was lost."""

    orientations: Float[np.ndarray, "bodies 4"]
    """Unit quaternions w x y z, body to world; NaN where a body was lost."""

    def row(self) -> Float[np.ndarray, "values"]:
        """Time, positions and orientations in a row."""
        return np.concatenate(([self.time_s], self.positions.ravel(), self.orientations.ravel()))


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
    """Holds the last frames of all bodies of a rig, and all of them on disk."""

    def __init__(self, rig: Capture, longest: int) -> None:
        self.rig = rig
        self.longest = longest
        self.count = 0
        """Frames that were pushed since the beginning."""

        self._bodies = body_names(rig)
        self._table = np.empty((2 * longest, 1 + 7 * len(self._bodies)))
        self._filled = 0
        self._file = TemporaryFile()  # noqa: SIM115

    def push(self, poses: Poses) -> None:
        """Add a frame.

        Raises:
            CaptureError: It is of another number of bodies, or not later than the one before.
        """
        expected, last_s = len(self._bodies), self._table[self._filled - 1, 0]
        if poses.positions.shape != (expected, 3) or poses.orientations.shape != (expected, 4):
            raise CaptureError(
                f"a frame of positions {poses.positions.shape} and orientations "
                f"{poses.orientations.shape}; the rig has {expected} bodies: {list(self._bodies)}"
            )
        if self._filled and not poses.time_s > last_s:
            raise CaptureError(
                f"frame {self.count} at {poses.time_s:.6f} s does not follow the one before at "
                f"{last_s:.6f} s"
            )
        if self._filled == len(self._table):
            self._table[: self.longest] = self._table[-self.longest :].copy()
            self._filled = self.longest
        self._table[self._filled] = poses.row()
        self._file.write(self._table[self._filled].tobytes())
        self._filled += 1
        self.count += 1

    def window(self, frames: int) -> Window:
        """The last frames, as many as there are of those asked for."""
        begin = self._filled - min(frames, self._filled, self.longest)
        capture = _moved(self.rig, self._table[begin : self._filled])
        return Window(self.count - (self._filled - begin), capture)

    def recording(self) -> Capture:
        """All frames as a capture.

        Raises:
            CaptureError: There are fewer than two.
        """
        if self.count < 2:
            raise CaptureError("a live recording of fewer than two frames: nothing can be observed")
        self._file.seek(0)
        table = np.frombuffer(self._file.read()).reshape(self.count, -1)
        return _moved(self.rig, table)


def _moved(rig: Capture, table: Float[np.ndarray, "frames values"]) -> Capture:
    """A rig that moves as the rows of frames say."""
    rows = body_rows(rig)
    count = len(set(rows.values()))
    places, turns = np.split(table[:, 1:], [3 * count], axis=1)
    streams = [
        Stream(
            table[:, 0].copy(),
            places[:, 3 * row : 3 * row + 3].copy(),
            turns[:, 4 * row : 4 * row + 4].copy(),
        )
        for row in range(count)
    ]
    return with_streams(rig, {name: streams[row] for name, row in rows.items()})


def body_rows(rig: Capture) -> dict[str, int]:
    """The row of each body in a frame, by ``sensor NAME`` or ``object NAME``.

    An object that is also a sensor shares its row.
    """
    rows: dict[int, int] = {}
    return {
        name: rows.setdefault(id(body.stream), len(rows)) for name, body in _bodies(rig).items()
    }


def body_names(rig: Capture) -> tuple[str, ...]:
    """The bodies of a frame's rows, in order; of one that is two things, its first name."""
    firsts = {row: name for name, row in reversed(body_rows(rig).items())}
    return tuple(firsts[row] for row in sorted(firsts))


def with_streams(rig: Capture, streams: Mapping[str, Stream]) -> Capture:
    """A rig whose bodies move as some streams say, by ``sensor NAME`` and ``object NAME``."""
    sensors = tuple(replace(each, stream=streams[f"sensor {each.name}"]) for each in rig.sensors)
    objects = tuple(replace(each, stream=streams[f"object {each.name}"]) for each in rig.objects)
    return replace(rig, sensors=sensors, objects=objects)


def _bodies(rig: Capture) -> dict[str, Sensor | TagObject]:
    sensors = {f"sensor {each.name}": each for each in rig.sensors}
    return {**sensors, **{f"object {each.name}": each for each in rig.objects}}


def replayed(capture: Capture) -> list[Poses]:
    """The frames of a recorded capture, as a tracker would have given them."""
    bodies = _bodies(capture)
    streams = [bodies[name].stream for name in body_names(capture)]
    positions = np.stack([each.positions for each in streams], axis=1)
    orientations = np.stack([each.orientations for each in streams], axis=1)
    frames = zip(capture.times, positions, orientations, strict=True)
    return [Poses(float(time_s), *poses) for time_s, *poses in frames]


def paced(frames: list[Poses], speed: float) -> Iterator[list[Poses]]:
    """The frames that are due, again and again, at a speed; one at a time as fast as it goes."""
    if speed <= 0.0:
        yield from ([each] for each in frames)
        return
    started, sent = time.monotonic(), 0
    while sent < len(frames):
        due_s = (time.monotonic() - started) * speed + frames[0].time_s
        due = sent
        while due < len(frames) and frames[due].time_s <= due_s:
            due += 1
        if due == sent:
            time.sleep(WAIT_S)
        yield frames[sent:due]
        sent = due


class DeviceFrames:
    """Puts frames of a tracker in the order of a rig's bodies and on the rig's clock.

    Bodies that the tracker does not know stand where they stand in the rig's first known frame;
    so do tables and walls. Of cycles that were lost every body is lost.

    Args:
        rig: Bodies, by the names of the tracker's sensors.
        description: The tracker.
        step_s: Time between two frames [s]; None for the tracker's, else the rig's.

    Raises:
        DeviceError: The tracker has none of the rig's moving bodies, or no full poses.
    """

    def __init__(self, rig: Capture, description: Description, step_s: float | None) -> None:
        known = {name: index for index, name in enumerate(description.sensors)}
        names = [name.split(" ", 1)[1] for name in body_names(rig)]
        self._rows = [known.get(name, -1) for name in names]
        self._still: list[tuple[np.ndarray, np.ndarray]] = []
        moving = []
        for name in names:
            stream = rig.bodies[name].stream
            seen = np.flatnonzero(~stream.lost)
            if name not in known and (
                not seen.size or np.ptp(stream.positions[seen], axis=0).max() >= STANDS_M
            ):
                moving.append(name)
            at = seen[0] if seen.size else 0  # of a body that was never seen, NaN
            self._still.append((stream.positions[at], stream.orientations[at]))
        if moving or not (description.has_positions and description.has_orientations):
            raise DeviceError(
                f"the tracker sends positions and orientations of {list(description.sensors)}; "
                f"the rig also needs {moving}, which move. Name the tracker's sensors as the rig "
                "does, with names=... in the device address, or take a rig of that tracker"
            )
        self._rate_hz = description.rate_hz
        own_s = 1.0 / self._rate_hz if self._rate_hz > 0.0 else time_step(rig.times)
        self.step_s = step_s or own_s
        self._count = 0
        self._start_s = 0.0
        self.filled = 0
        """Frames that were missing, and are given as lost."""

    def poses(self, frame: Frame) -> Iterator[Poses]:
        """The frame, after lost frames in place of those that are missing before it."""
        # By the device's own clock: the time of arrival jitters by more than a step, so that
        # frames of a device without one are taken to be even.
        time_s = frame.device_s
        if time_s is None and frame.cycle is not None and np.isfinite(self._rate_hz):
            time_s = frame.cycle / self._rate_hz
        if time_s is not None:
            missing = round((time_s - self._start_s) / self.step_s) - self._count
            if self._count == 0 or missing < 0 or missing > LONGEST_LOSS_S / self.step_s:
                # The first frame, or a device that counts anew.
                self._start_s = time_s - self._count * self.step_s
                missing = 0
            for _ in range(missing):
                yield self._next(None)
            self.filled += missing
        yield self._next(frame)

    def _next(self, frame: Frame | None) -> Poses:
        positions = np.full((len(self._rows), 3), np.nan)
        orientations = np.full((len(self._rows), 4), np.nan)
        for index, row in enumerate(self._rows):
            if row < 0:
                positions[index], orientations[index] = self._still[index]
            elif frame is not None:
                positions[index] = frame.positions[row]
                orientations[index] = frame.orientations[row]
        self._count += 1
        return Poses((self._count - 1) * self.step_s, positions, orientations)


def lead_in(capture: Capture, seconds: float) -> Capture:
    """The first seconds of a recorded capture.

    Raises:
        CaptureError: They are fewer than needed.
    """
    return capture_of(capture, [each for each in replayed(capture) if each.time_s <= seconds])


def capture_of(rig: Capture, frames: Sequence[Poses]) -> Capture:
    """Frames as a capture of a rig.

    Raises:
        CaptureError: They are fewer than needed.
    """
    duration_s = frames[-1].time_s - frames[0].time_s if frames else 0.0
    if duration_s < SHORTEST_S:
        raise CaptureError(
            f"a lead-in of {duration_s:.2f} s: expected at least {SHORTEST_S:g} s, to tell noise"
        )
    return _moved(rig, np.stack([frame.row() for frame in frames]))
