"""VRPN's messages over TCP: cookie, header, descriptions of senders and types, tracker poses."""

import struct
from dataclasses import dataclass

from extractors.devices.tracker import DeviceLostError

COOKIE = b"vrpn: ver. 07.38  0"
COOKIE_SIZE = 24
MAJOR = b"vrpn: ver. 07."
HEADER = struct.Struct(">6i")
ALIGN = 8
MOST_PAYLOAD = 65536
"""Bytes of the largest payload that is believed."""

SENDER_DESCRIPTION = -1
TYPE_DESCRIPTION = -2
POSE = struct.Struct(">2i7d")
POSE_TYPE = "vrpn_Tracker Pos_Quat"
PING_TYPE = "vrpn_Base ping_message"
PONG_TYPE = "vrpn_Base pong_message"


@dataclass(frozen=True)
class Message:
    """One message: when, by whom, of what type, and its payload."""

    seconds: int
    microseconds: int
    sender: int
    type: int
    payload: bytes = b""
    sequence: int = 0

    @property
    def stamp_s(self) -> float:
        """The sender's time [s]."""
        return self.seconds + self.microseconds * 1e-6

    def encode(self) -> bytes:
        """The message's bytes, padded."""
        head = HEADER.pack(
            HEADER.size + len(self.payload), self.seconds, self.microseconds,
            self.sender, self.type, self.sequence,
        )  # fmt: skip
        return head + self.payload + bytes(-len(self.payload) % ALIGN)


def cookie() -> bytes:
    """What each side sends first."""
    return COOKIE.ljust(COOKIE_SIZE, b"\0")


def check_cookie(data: bytes) -> None:
    """Check what the other side sent first.

    Raises:
        DeviceLostError: It is no VRPN of this major version.
    """
    if not data.startswith(MAJOR):
        raise DeviceLostError(f"no VRPN 7 server: it began with {data!r}")


def decode_message(data: bytes | memoryview) -> tuple[Message, int] | None:
    """The message at the start of some bytes, and its length; None where more are needed.

    Raises:
        DeviceLostError: The bytes are no message; the stream cannot be followed any further.
    """
    if len(data) < HEADER.size:
        return None
    size, seconds, micro, sender, kind, sequence = HEADER.unpack_from(data)
    payload = size - HEADER.size
    if not 0 <= payload <= MOST_PAYLOAD:
        raise DeviceLostError(f"no VRPN message: a length of {size} bytes")
    end = HEADER.size + payload + -payload % ALIGN
    if len(data) < end:
        return None
    body = bytes(data[HEADER.size : size])
    return Message(seconds, micro, sender, kind, body, sequence), end


def encode_name(name: str) -> bytes:
    """Payload of a description."""
    text = name.encode() + b"\0"
    return len(text).to_bytes(4, "big") + text


def decode_name(payload: bytes) -> str | None:
    """The name in a description's payload; None where it holds none."""
    size = int.from_bytes(payload[:4], "big")
    text = payload[4 : 4 + size]
    if len(payload) < 4 or len(text) < size or not text.endswith(b"\0"):
        return None
    try:
        return text[:-1].decode()
    except UnicodeDecodeError:
        return None


@dataclass(frozen=True)
class SensorPose:
    """Payload of a pose: the sensor's number, x y z [m], and the quaternion x y z w."""

    sensor: int
    position: tuple[float, ...]
    quaternion: tuple[float, ...]

    def encode(self) -> bytes:
        """The pose as a payload."""
        return POSE.pack(self.sensor, 0, *self.position, *self.quaternion)


def decode_pose(payload: bytes) -> SensorPose | None:
    """The pose that a payload holds; None where it has another length."""
    if len(payload) != POSE.size:
        return None
    sensor, _, *values = POSE.unpack(payload)
    return SensorPose(sensor, tuple(values[:3]), tuple(values[3:]))


class MessageParser:
    """Cuts a stream of bytes into messages."""

    def __init__(self) -> None:
        self._buffer = bytearray()

    def feed(self, data: bytes) -> list[Message]:
        """The messages that some bytes complete.

        Raises:
            DeviceLostError: The bytes are no messages.
        """
        self._buffer += data
        out = []
        view = memoryview(bytes(self._buffer))
        at = 0
        while (found := decode_message(view[at:])) is not None:
            out.append(found[0])
            at += found[1]
        del self._buffer[:at]
        return out
