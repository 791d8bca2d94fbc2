"""A recording of live frames: a file that only grows, and is whole up to the moment of a kill.

After a line that names the format come blocks: length, checksum and kind, then the payload. The
first block describes the tracker, one block is a frame, others are events; a last one with the
counts says that the recording was ended and not cut off. Every frame is handed to the operating
system as it comes, so that a killed process loses none that it was given; a computer that loses
power may lose what its disk had not written.
"""

import json
import os
import struct
import zlib
from collections.abc import Iterator
from dataclasses import asdict, dataclass
from datetime import UTC, datetime
from pathlib import Path
from typing import Any

import numpy as np
from jaxtyping import Float, Int

from capar.model.errors import FileError
from extractors.devices.tracker import Counts, Description, Event, Frame

MAGIC = b"CaPAR recording 1\n"
BLOCK = struct.Struct("<IIB")
STAMPS = struct.Struct("<ddq")
HEAD, FRAME, EVENT, END = range(4)
NO_CYCLE = -1
MOST_BYTES = 1 << 24
"""Payload of the largest block that is believed."""


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
