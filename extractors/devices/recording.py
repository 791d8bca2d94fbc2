"""Recordings of live frames: a file that only grows, and its capture bundle."""

import json
import os
import shutil
import struct
import tempfile
import zlib
from collections.abc import Mapping
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
        head = asdict(description) | {"address": address}
        head["started"] = datetime.now(UTC).isoformat(timespec="milliseconds")
        self._put(MAGIC + _block(HEAD, head))

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
        self._put(_block(EVENT, asdict(event)))

    def close(self, counts: Counts) -> None:
        """End the recording with what arrived and what did not.

        Raises:
            FileError: It cannot be written.
        """
        self._put(_block(END, asdict(counts)))
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
    try:
        return _read_blocks(Path(path), data)
    except (ValueError, KeyError, TypeError) as error:
        raise FileError(path, f"holds a block that cannot be read: {error}.") from None


def _read_blocks(path: Path, data: bytes) -> Recording:
    """Every block before the first that is cut off or damaged."""
    blocks: dict[int, list[bytes]] = {HEAD: [], FRAME: [], EVENT: [], END: []}
    end = len(MAGIC)
    while end + BLOCK.size <= len(data):
        size, check, kind = BLOCK.unpack_from(data, end)
        payload = data[end + BLOCK.size : end + BLOCK.size + size]
        if size > MOST_BYTES or len(payload) < size or zlib.crc32(payload, kind) != check:
            break
        end += BLOCK.size + size
        blocks.setdefault(kind, []).append(payload)
    if not blocks[HEAD]:
        raise FileError(path, "was cut off before it described the tracker.")
    head, counts = json.loads(blocks[HEAD][-1]), blocks[END]
    address, started = str(head.pop("address")), str(head.pop("started"))
    description = Description(**head | {"sensors": tuple(head["sensors"])})
    frames = blocks[FRAME]
    stamps = np.array([STAMPS.unpack_from(each) for each in frames]).reshape(-1, 3)
    numbers = b"".join(each[STAMPS.size :] for each in frames)
    poses = np.frombuffer(numbers, "<f8").reshape(len(frames), len(description.sensors), 7)
    return Recording(
        description=description,
        address=address,
        started=started,
        host_s=stamps[:, 0],
        device_s=stamps[:, 1],
        cycles=stamps[:, 2].astype(np.int64),
        positions=poses[..., :3],
        orientations=poses[..., 3:],
        events=tuple(Event(**json.loads(each)) for each in blocks[EVENT]),
        counts=Counts(**json.loads(counts[-1])) if counts else None,
        dropped_bytes=len(data) - end,
    )


def _block(kind: int, value: dict[str, Any] | bytes) -> bytes:
    payload = value if isinstance(value, bytes) else json.dumps(value).encode()
    return BLOCK.pack(len(payload), zlib.crc32(payload, kind), kind) + payload


PARTS = ("x", "y", "z", "qx", "qy", "qz", "qw", "valid")
END_EFFECTORS = ("hand", "foot", "head")
SIDES = ("right", "left")
FEWEST = 20  # Frames of a connection through which a line is laid; fewer keep their arrival.


@dataclass(frozen=True)
class Mount:
    """What a sensor rides on: a body segment, or an object where ``end_effector`` is empty."""

    end_effector: str = ""
    side: str = "none"


def usual_mount(name: str) -> Mount:
    """What a name says: ``right_hand`` rides on the right hand, ``mug`` on an object."""
    side, _, rest = name.partition("_")
    part = rest if side in SIDES else name
    if part not in END_EFFECTORS:
        return Mount()
    return Mount(part, side if side in SIDES else "none")


def frame_times(recording: Recording) -> Float[np.ndarray, "frames"]:
    """When each frame was measured [s], from the first on; it does not always increase.

    It is the device's time, or arrival on a line by cycle number within each connection.
    """
    times, cycles = recording.device_s, recording.cycles
    if not np.isfinite(times).all() or not (np.diff(times) > 0.0).all():
        times = recording.host_s.copy()
        starts = [0, *(np.flatnonzero(np.diff(cycles) <= 0) + 1).tolist(), len(cycles)]
        for first, end in pairwise(starts):
            part = slice(first, end)
            if end - first >= FEWEST and cycles[first] != NO_CYCLE:
                slope, offset = np.polyfit(cycles[part], times[part], 1)
                times[part] = offset + slope * cycles[part]
    return np.asarray(times - times[0])


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
    description = recording.description
    for name in mounts or {}:
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


def _write_table(path: Path, recording: Recording, times: np.ndarray, kept: np.ndarray) -> None:
    """The table of poses, in which a sensor that lacks a number is lost."""
    names = recording.description.sensors
    poses = np.concatenate([recording.positions, np.roll(recording.orientations, -1, axis=2)], 2)
    seen = np.isfinite(poses).all(axis=2, keepdims=True)
    rows = np.concatenate([np.where(seen, poses, np.nan), seen], axis=2).reshape(len(times), -1)
    head = ",".join(["t_s", *(f"{name}_{part}" for name in names for part in PARTS)])
    form = ["%.6f", *[*["%.6f"] * 3, *["%.7f"] * 4, "%d"] * len(names)]
    table = np.column_stack([times, rows])[kept]
    np.savetxt(path, table, fmt=form, delimiter=",", header=head, comments="")


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
    bare = "".join(each if each.isalnum() or each in "-_." else "_" for each in name)
    out += [f'name = "{bare}"', f'recorded = "{recording.started}"', 'unit = "m"', 'up = "z"', ""]
    out += ["[files]", 'motion = "motion.csv"', "", "[agent]", 'name = "agent"']
    names = recording.description.sensors
    rides = {each: mounts.get(each, usual_mount(each)) for each in names}
    if not any(each.end_effector for each in rides.values()):
        out += ["", "# No sensor's name says what it rides on: correct end_effector and side."]
        rides = {each: Mount(each) for each in names}
    for each, mount in rides.items():
        out += ["", "[[sensor]]" if mount.end_effector else "[[object]]", f'name = "{each}"']
        if not mount.end_effector:
            out.append('tag = "mobile"')
        else:
            out.append(f'end_effector = "{mount.end_effector}"')
            out += [f'side = "{mount.side}"'] if mount.side != "none" else []
            out += ['role = "attends"'] if mount.end_effector == "head" else []
        out.append(f'body = "{each}"')
    return "\n".join(out) + "\n"
