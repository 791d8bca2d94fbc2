"""Recordings of live frames: a file that only grows, and its capture bundle."""

import json
import os
import shutil
import struct
import tempfile
import zlib
from collections.abc import Iterator, Mapping
from dataclasses import asdict, dataclass
from datetime import UTC, datetime
from itertools import pairwise
from pathlib import Path
from typing import Any

import numpy as np
from jaxtyping import Float, Int

from capar.model.errors import FileError, UnknownNameError
from extractors.devices.tracker import Counts, Description, Event, Frame

MAGIC = b"CaPAR recording 1\n"
BLOCK = struct.Struct("<IIB")
STAMPS = struct.Struct("<ddq")
HEAD, FRAME, EVENT, END = range(4)
NO_CYCLE = -1
MOST_BYTES = 1 << 24  # Payload of the largest block that is believed.


class RecordingWriter:
    """Writes a recording.

    Args:
        path: A file that does not exist yet.
        description: The tracker.
        address: Its address.

    Raises:
        FileError: The file exists, or cannot be written.
    """

    def __init__(self, path: Path | str, description: Description, address: str) -> None:
        self._path = Path(path)
        self._sensors = len(description.sensors)
        try:
            flags = os.O_WRONLY | os.O_CREAT | os.O_EXCL | os.O_APPEND
            self._file = os.open(self._path, flags, 0o644)
        except FileExistsError:
            remedy = "Recordings are never overwritten; choose another name."
            raise FileError(self._path, "exists already.", remedy) from None
        except OSError as error:
            raise FileError(self._path, f"cannot be written: {error}.") from None
        head = _values(description) | {"address": address}
        head["started"] = datetime.now(UTC).isoformat(timespec="milliseconds")
        self._put(MAGIC + _block(HEAD, _text(head)))

    def write(self, frame: Frame) -> None:
        """Append a frame.

        Raises:
            FileError: It cannot be written.
        """
        device_s = np.nan if frame.device_s is None else frame.device_s
        cycle = NO_CYCLE if frame.cycle is None else frame.cycle
        poses = np.hstack([frame.positions, frame.orientations]).astype("<f8")
        stamps = STAMPS.pack(frame.host_s, device_s, cycle)
        self._put(_block(FRAME, stamps + poses.tobytes()))

    def tell(self, event: Event) -> None:
        """Append what happened to the connection.

        Raises:
            FileError: It cannot be written.
        """
        self._put(_block(EVENT, _text(asdict(event))))

    def close(self, counts: Counts) -> None:
        """End the recording with what arrived and what did not.

        Raises:
            FileError: It cannot be written.
        """
        self._put(_block(END, _text(asdict(counts))))
        os.fsync(self._file)
        os.close(self._file)

    def _put(self, data: bytes) -> None:
        try:
            while data:
                data = data[os.write(self._file, data) :]
        except OSError as error:
            raise FileError(self._path, f"cannot be written: {error}.") from None


@dataclass(frozen=True, eq=False)
class Recording:
    """What a file of frames holds."""

    description: Description
    address: str
    started: str
    """When, as UTC in ISO 8601."""

    host_s: Float[np.ndarray, "frames"]
    device_s: Float[np.ndarray, "frames"]
    """NaN where the device sent no time."""

    cycles: Int[np.ndarray, "frames"]
    """-1 where cycles are not counted."""

    positions: Float[np.ndarray, "frames sensors 3"]
    orientations: Float[np.ndarray, "frames sensors 4"]
    events: tuple[Event, ...]
    counts: Counts | None
    """What arrived and what did not; None where the recording was cut off."""

    dropped_bytes: int
    """Bytes at the end that are no whole block."""


def read_live_recording(path: Path | str) -> Recording:
    """The recording in a file, up to the last whole block.

    Raises:
        FileError: It is no recording, or was cut off before it described the tracker.
    """
    try:
        data = Path(path).read_bytes()
    except OSError as error:
        raise FileError(path, f"cannot be read: {error}.") from None
    if not data.startswith(MAGIC):
        raise FileError(path, "is no recording of a live tracker.", f"It begins with {MAGIC!r}.")
    return _Reader(Path(path), data).recording()


class _Reader:
    """Gathers the blocks of a file."""

    def __init__(self, path: Path, data: bytes) -> None:
        self._path, self._data = path, data
        self._end = len(MAGIC)

    def recording(self) -> Recording:
        head: dict[str, Any] | None = None
        counts: Counts | None = None
        frames: list[bytes] = []
        events: list[Event] = []
        try:
            for kind, payload in self._blocks():
                if kind == HEAD:
                    head = json.loads(payload)
                elif kind == FRAME:
                    frames.append(payload)
                elif kind == EVENT:
                    events.append(Event(**json.loads(payload)))
                elif kind == END:
                    counts = Counts(**json.loads(payload))
            if head is None:
                raise FileError(self._path, "was cut off before it described the tracker.")
            return self._made(head, frames, tuple(events), counts)
        except (ValueError, KeyError, TypeError) as error:
            raise FileError(self._path, f"holds a block that cannot be read: {error}.") from None

    def _blocks(self) -> Iterator[tuple[int, bytes]]:
        """Kind and payload of every block before the first that is cut off or damaged."""
        while self._end + BLOCK.size <= len(self._data):
            size, check, kind = BLOCK.unpack_from(self._data, self._end)
            start = self._end + BLOCK.size
            payload = self._data[start : start + size]
            if size > MOST_BYTES or len(payload) < size or zlib.crc32(payload, kind) != check:
                return
            self._end = start + size
            yield kind, payload

    def _made(
        self,
        head: dict[str, Any],
        frames: list[bytes],
        events: tuple[Event, ...],
        counts: Counts | None,
    ) -> Recording:
        address, started = str(head.pop("address")), str(head.pop("started"))
        description = Description(**head | {"sensors": tuple(head["sensors"])})
        count = len(description.sensors)
        stamps = np.array([STAMPS.unpack_from(each) for each in frames]).reshape(-1, 3)
        numbers = b"".join(each[STAMPS.size :] for each in frames)
        poses = np.frombuffer(numbers, "<f8").reshape(len(frames), count, 7)
        return Recording(
            description=description,
            address=address,
            started=started,
            host_s=stamps[:, 0],
            device_s=stamps[:, 1],
            cycles=stamps[:, 2].astype(np.int64),
            positions=poses[..., :3],
            orientations=poses[..., 3:],
            events=events,
            counts=counts,
            dropped_bytes=len(self._data) - self._end,
        )


def _block(kind: int, payload: bytes) -> bytes:
    return BLOCK.pack(len(payload), zlib.crc32(payload, kind), kind) + payload


def _text(value: dict[str, Any]) -> bytes:
    return json.dumps(value).encode()


def _values(description: Description) -> dict[str, Any]:
    names = ("kind", "model", "sensors", "rate_hz", "has_positions", "has_orientations")
    out = {name: getattr(description, name) for name in names}
    return out | {"details": dict(description.details)}


PARTS = ("x", "y", "z", "qx", "qy", "qz", "qw", "valid")
END_EFFECTORS = ("hand", "foot", "head")
SIDES = ("right", "left")
FEWEST = 20  # Frames of a connection through which a line is laid; fewer keep their arrival.


@dataclass(frozen=True)
class Mount:
    """What a sensor rides on: a body segment, or an object where ``end_effector`` is empty."""

    end_effector: str = ""
    side: str = "none"

    @property
    def attends(self) -> bool:
        """Whether it shows where the performer looks, rather than what is done."""
        return self.end_effector == "head"


def usual_mount(name: str) -> Mount:
    """What a name says: ``right_hand`` rides on the right hand, ``mug`` on an object."""
    side, _, rest = name.partition("_")
    part = rest if side in SIDES else name
    if part not in END_EFFECTORS:
        return Mount()
    return Mount(part, side if side in SIDES else "none")


def frame_times(recording: Recording) -> Float[np.ndarray, "frames"]:
    """When each frame was measured [s], from the first on; it does not always increase."""
    device_s = recording.device_s
    if np.isfinite(device_s).all() and (np.diff(device_s) > 0.0).all():
        times = device_s
    else:
        times = _straightened(recording)
    return np.asarray(times - times[0])


def _straightened(recording: Recording) -> np.ndarray:
    """Arrival, on a line by cycle number within each connection."""
    times, cycles = recording.host_s.copy(), recording.cycles
    starts = [0, *(np.flatnonzero(np.diff(cycles) <= 0) + 1).tolist(), len(cycles)]
    for first, end in pairwise(starts):
        part = slice(first, end)
        if end - first >= FEWEST and cycles[first] != NO_CYCLE:
            slope, offset = np.polyfit(cycles[part], times[part], 1)
            times[part] = offset + slope * cycles[part]
    return times


def write_bundle(
    recording: Recording, folder: Path | str, mounts: Mapping[str, Mount] | None = None
) -> None:
    """Write a recording as a capture bundle, whole or not at all.

    Args:
        recording: What was recorded.
        folder: A folder that does not exist yet.
        mounts: What the sensors ride on; otherwise their names say it.

    Raises:
        FileError: The folder exists, or the recording is too short or lacks positions or
            orientations.
        UnknownNameError: A mount is of no sensor.
    """
    folder = Path(folder)
    _check(recording, folder, mounts or {})
    times = frame_times(recording)
    later = np.maximum.accumulate(np.append(-np.inf, times[:-1]))
    kept = np.flatnonzero(times > later)
    folder.parent.mkdir(parents=True, exist_ok=True)
    made = Path(tempfile.mkdtemp(prefix=f".{folder.name}-", dir=folder.parent))
    try:
        _write_table(made / "motion.csv", recording, times, kept)
        late = len(times) - len(kept)
        text = _capture_toml(recording, folder.name, mounts or {}, late)
        (made / "capture.toml").write_text(text, encoding="utf-8")
        made.chmod(0o755)
        made.rename(folder)
    except OSError as error:
        raise FileError(folder, f"cannot be written: {error}.") from None
    finally:
        shutil.rmtree(made, ignore_errors=True)


def _check(recording: Recording, folder: Path, mounts: Mapping[str, Mount]) -> None:
    description = recording.description
    for name in mounts:
        if name not in description.sensors:
            raise UnknownNameError("sensor", name, description.sensors, where=recording.address)
    if not description.has_positions or not description.has_orientations:
        raise FileError(
            folder,
            "a capture needs positions and orientations, and the recording lacks one of them.",
            "Record with format=pos_quat.",
        )
    if len(recording.host_s) < 2:
        frames = len(recording.host_s)
        raise FileError(folder, f"the recording has {frames} frames; a capture has at least two.")
    if folder.exists():
        raise FileError(folder, "exists already.", "Bundles are never overwritten.")


def _write_table(path: Path, recording: Recording, times: np.ndarray, kept: np.ndarray) -> None:
    names = recording.description.sensors
    lines = [",".join(["t_s", *(f"{name}_{part}" for name in names for part in PARTS)])]
    for frame in kept:
        cells = [f"{times[frame]:.6f}"]
        for place, turned in zip(
            recording.positions[frame], recording.orientations[frame], strict=True
        ):
            seen = bool(np.isfinite(place).all() and np.isfinite(turned).all())
            cells += [f"{value:.6f}" if seen else "nan" for value in place]
            cells += [f"{value:.7f}" if seen else "nan" for value in np.roll(turned, -1)]
            cells.append(str(int(seen)))
        lines.append(",".join(cells))
    path.write_text("\n".join(lines) + "\n", encoding="utf-8")


def _capture_toml(recording: Recording, name: str, mounts: Mapping[str, Mount], late: int) -> str:
    whole = "ended" if recording.counts is not None else "cut off"
    head = [
        f"# Recorded live from {recording.address}",
        f"# at {recording.started}; the recording was {whole}.",
    ]
    if late:
        head.append(f"# {late} frames came with a time that was not later, and are left out.")
    head += [f"# {event.message}" for event in recording.events]
    out = [each.replace("\n", " ") for each in head]
    out += [
        f'name = "{_bare(name)}"',
        f'recorded = "{recording.started}"',
        'unit = "m"',
        'up = "z"',
        "",
        "[files]",
    ]
    out += ['motion = "motion.csv"', "", "[agent]", 'name = "agent"']
    names = recording.description.sensors
    rides = {each: mounts.get(each, usual_mount(each)) for each in names}
    if not any(each.end_effector for each in rides.values()):
        out += ["", "# No sensor's name says what it rides on: correct end_effector and side."]
        rides = {each: Mount(each) for each in names}
    for each, mount in rides.items():
        out += ["", *_body(each, mount)]
    return "\n".join(out) + "\n"


def _body(name: str, mount: Mount) -> list[str]:
    if not mount.end_effector:
        return ["[[object]]", f'name = "{name}"', 'tag = "mobile"', f'body = "{name}"']
    out = ["[[sensor]]", f'name = "{name}"', f'end_effector = "{mount.end_effector}"']
    out += [f'side = "{mount.side}"'] if mount.side != "none" else []
    out += ['role = "attends"'] if mount.attends else []
    return [*out, f'body = "{name}"']


def _bare(name: str) -> str:
    return "".join(each if each.isalnum() or each in "-_." else "_" for each in name)
