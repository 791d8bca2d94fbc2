"""Records of a Polhemus Fastrak: lines of ASCII, or binary with a header; both end in CR LF.

The carriage return is asked for in binary records too (item 1): with the three bytes of the
header it frames a record of fixed length, so that a lost byte shows. A record counts where its
header, its length and its end agree and a quaternion's norm is one.
"""

import math
import struct
from collections.abc import Sequence
from dataclasses import dataclass, replace

END = b"\r\n"
STATIONS = 4
FIELD = 7
"""Characters of a number in an ASCII record."""

MOST_ERRORS = 0x7F
NORM_TOLERANCE = 0.05
CM_M = 0.01

ITEMS = {"pos": (2,), "pos_ang": (2, 4), "pos_quat": (2, 11)}
"""Items of the output list by format: 2 position, 4 azimuth elevation roll, 11 quaternion."""

VALUES = {2: 3, 4: 3, 11: 4}
"""Numbers of an item."""


@dataclass(frozen=True, slots=True)
class StationRecord:
    """What one station's sensor measured, in centimetres, degrees and quaternions w x y z."""

    station: int
    error: str
    """The error character; a space where all is well."""

    values: tuple[float, ...]
    stamp_s: float = 0.0
    """When its first byte arrived [s]."""

    missed: int = 0
    """How many records the bytes were of that were dropped since the record before."""


def layout(form: str) -> str:
    """The fields of a format: ``2`` per number of centimetres or degrees, ``4`` of a quaternion."""
    return "".join(("4" if item == 11 else "2") * VALUES[item] for item in ITEMS[form])


def record_size(form: str, *, binary: bool) -> int:
    """Bytes of a record."""
    return 3 + (4 if binary else FIELD) * len(layout(form)) + len(END)


def encode_record(record: StationRecord, form: str, *, binary: bool) -> bytes:
    """The bytes of a record."""
    head = f"0{record.station}{record.error}".encode("ascii")
    if binary:
        return head + struct.pack(f"<{len(record.values)}f", *record.values) + END
    fields = zip(record.values, layout(form), strict=True)
    return head + "".join(f"{value:{FIELD}.{places}f}" for value, places in fields).encode() + END


def decode_record(data: bytes, form: str, *, binary: bool) -> StationRecord | None:
    """The record that some bytes are; None where they are none."""
    if len(data) != record_size(form, binary=binary) or not _framed(data):
        return None
    body = data[3 : -len(END)]
    values = _binary(body) if binary else _ascii(body)
    if values is None or not all(map(math.isfinite, values)):
        return None
    if form == "pos_quat" and abs(math.hypot(*values[3:]) - 1.0) > NORM_TOLERANCE:
        return None
    return StationRecord(data[1] - ord("0"), chr(data[2]), tuple(values))


def _framed(data: bytes) -> bool:
    """Whether header and end are those of a record."""
    station = 0 < data[1] - ord("0") <= STATIONS
    return data[:1] == b"0" and station and 0x20 <= data[2] < MOST_ERRORS and data.endswith(END)


def _binary(body: bytes) -> Sequence[float] | None:
    return struct.unpack(f"<{len(body) // 4}f", body)


def _ascii(body: bytes) -> Sequence[float] | None:
    fields = [body[at : at + FIELD] for at in range(0, len(body), FIELD)]
    if not all(_DIGITS.issuperset(each) for each in fields):
        return None
    try:
        return [float(each) for each in fields]
    except ValueError:
        return None


_DIGITS = frozenset(b"0123456789+-. ")


class RecordParser:
    """Finds the records in a stream of bytes that may have lost some.

    Args:
        form: The format that was asked for.
        binary: Whether records are binary.
        byte_s: Time of a byte on the line, for time stamps [s].
    """

    def __init__(self, form: str, *, binary: bool, byte_s: float = 0.0) -> None:
        self.dropped_bytes = 0
        self._form = form
        self._is_binary = binary
        self._size = record_size(form, binary=binary)
        self._byte_s = byte_s
        self._buffer = bytearray()
        self._stamp_s = 0.0
        self._dropped = 0

    def feed(self, data: bytes, at_s: float = 0.0) -> list[StationRecord]:
        """The records that some bytes complete, the last of which arrived at a moment [s]."""
        held = len(self._buffer)
        self._buffer += data
        total, at, out = len(self._buffer), 0, []
        while total - at >= self._size:
            record = decode_record(
                bytes(self._buffer[at : at + self._size]), self._form, binary=self._is_binary
            )
            if record is None:
                at += 1
                self.dropped_bytes += 1
                self._dropped += 1
                continue
            stamp_s = self._stamp_s if at < held else at_s - (total - 1 - at) * self._byte_s
            missed = -(-self._dropped // self._size)
            self._dropped = 0
            out.append(replace(record, stamp_s=stamp_s, missed=missed))
            at += self._size
        if at >= held:
            self._stamp_s = at_s - (total - 1 - at) * self._byte_s
        del self._buffer[:at]
        return out

    def clear(self) -> None:
        """Forget what was begun."""
        self._buffer.clear()
        self._dropped = 0
