"""VRPN over TCP: messages, client and simulated server."""

import struct
import time
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy.spatial.transform import Rotation

from capar.model.capture import UP, upward
from extractors.devices.bird_formats import NORM_TOLERANCE
from extractors.devices.lines import NetworkLine
from extractors.devices.records import Values
from extractors.devices.simulator import Faults, MotionSource, Sent, ServerSimulator
from extractors.devices.tracker import (
    Address,
    Description,
    DeviceLostError,
    Frame,
    LiveTracker,
    SensorReading,
    frame_of,
    take_messages,
)

COOKIE = b"vrpn: ver. 07.38  0".ljust(24, b"\0")  # What each side sends first.
MAJOR = b"vrpn: ver. 07."
HEADER = struct.Struct(">6i")
ALIGN = 8
MOST_PAYLOAD = 65536  # Bytes of the largest payload that is believed.
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

    def encode(self) -> bytes:
        """The message's bytes, padded."""
        head = HEADER.pack(
            HEADER.size + len(self.payload), self.seconds, self.microseconds,
            self.sender, self.type, self.sequence,
        )  # fmt: skip
        return head + self.payload + bytes(-len(self.payload) % ALIGN)


def check_cookie(data: bytes) -> None:
    """Check what the other side sent first.

    Raises:
        DeviceLostError: It is no VRPN of this major version.
    """
    if not data.startswith(MAJOR):
        raise DeviceLostError(f"no VRPN 7 server: it began with {data!r}")


def decode_message(data: bytes | bytearray) -> tuple[Message, int] | None:
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


def encode_pose(sensor: int, position: Sequence[float], quaternion: Sequence[float]) -> bytes:
    """Payload of a pose: the sensor's number, x y z [m], and the quaternion x y z w."""
    return POSE.pack(sensor, 0, *position, *quaternion)


def decode_pose(payload: bytes) -> tuple[int, Values, Values] | None:
    """Sensor, position and quaternion of a payload; None where it has another length."""
    if len(payload) != POSE.size:
        return None
    sensor, _, *values = POSE.unpack(payload)
    return sensor, tuple(values[:3]), tuple(values[3:])


PORT = 3883
COOKIE_S = 3.0
PING_S = 1.0  # How often the server is asked whether it is there [s].
SILENCE_S = 5.0  # A server that answers nothing for so long is lost [s].
PING, PONG = 0, 1  # Our numbers of the types that we send.


class VrpnTracker(LiveTracker):
    """One tracker of a VRPN server.

    Args:
        address: Like ``vrpn:Tracker0@HOST?sensors=4``.

    Raises:
        CaparError: The address is not of that form, or an option is unknown.
    """

    def __init__(self, address: Address) -> None:
        super().__init__()
        self._device, at, host = address.place.rpartition("@")
        if not at or not self._device:
            raise address.error("the place is TRACKER@HOST or TRACKER@HOST:PORT")
        self._line = NetworkLine(*address.host_port(host, PORT))
        self._count = address.integer("sensors", 1, low=1, high=1000)
        self._names = address.names(f"sensor{index}" for index in range(self._count))
        self._up = upward(address.choice("up", UP, "z"))
        address.close()
        self._start()

    def _start(self) -> None:
        self._buffer = bytearray()
        self._early = b""
        self._senders: dict[int, str] = {}
        self._types: dict[int, str] = {}
        self._partial: dict[int, SensorReading] = {}
        self._asked_s = time.monotonic()

    def describe(self) -> Description:
        """The tracker and its sensors."""
        return Description("vrpn", self._device, self._names, float("nan"))

    def _connect(self) -> None:
        self._start()
        self._line.open()
        self._line.write(COOKIE)
        data, deadline = b"", time.monotonic() + COOKIE_S
        while len(data) < len(COOKIE):
            if time.monotonic() > deadline:
                raise DeviceLostError("the server does not say that it is VRPN")
            data += self._line.read(0.1)
        check_cookie(data)
        self._early = data[len(COOKIE) :]
        # name the sender and the types of what we send: the tracker's, as clients do
        for kind, number, name in (
            (SENDER_DESCRIPTION, 0, self._device),
            (TYPE_DESCRIPTION, PING, PING_TYPE),
            (TYPE_DESCRIPTION, PONG, PONG_TYPE),
        ):
            self._send(kind, number, encode_name(name))

    def _send(self, kind: int, sender: int = 0, payload: bytes = b"") -> None:
        now = time.time()
        seconds, micro = int(now), int(now % 1.0 * 1e6)
        self._line.write(Message(seconds, micro, sender, kind, payload).encode())

    def _disconnect(self) -> None:
        self._line.close()

    def _read(self, timeout_s: float) -> list[Frame]:
        since_s = time.monotonic()
        data, self._early = self._early or self._line.read(timeout_s), b""
        self._buffer += data
        self._listened(since_s, SILENCE_S, heard=bool(data))
        now = time.monotonic()
        if now - self._asked_s > PING_S:
            self._asked_s = now
            self._send(PING)
        messages = take_messages(self._buffer, decode_message)
        return [frame for each in messages for frame in self._take(each, now)]

    def _take(self, message: Message, now: float) -> list[Frame]:
        """What a message brings: a name, a question whether we are there, or a pose."""
        if message.type in (SENDER_DESCRIPTION, TYPE_DESCRIPTION):
            names = self._senders if message.type == SENDER_DESCRIPTION else self._types
            name = decode_name(message.payload)
            if name is not None:
                names[message.sender] = name
            return []
        if self._senders.get(message.sender) != self._device:
            return []
        kind = self._types.get(message.type)
        if kind == PING_TYPE:
            self._send(PONG)
        return self._pose(message, now) if kind == POSE_TYPE else []

    def _pose(self, message: Message, now: float) -> list[Frame]:
        """The frames that a pose ends: by being the last, or of another time."""
        sensor, position, quaternion = decode_pose(message.payload) or (-1, (), ())
        norm = float(np.linalg.norm(quaternion))
        if not 0 <= sensor < self._count or not abs(norm - 1.0) <= NORM_TOLERANCE:
            self.counts.refused_records += 1
            return []
        self.counts.records += 1
        turned = (self._up * Rotation.from_quat(quaternion)).as_quat(scalar_first=True)
        stamp_s = message.seconds + message.microseconds * 1e-6
        reading = SensorReading(sensor, now, self._up.apply(position), turned, stamp_s)
        out = []
        begun = next(iter(self._partial.values()), reading)
        if begun.device_s != stamp_s or sensor in self._partial:
            out.append(frame_of(list(self._partial.values()), self._count))
            self._partial.clear()
        self._partial[sensor] = reading
        if len(self._partial) == self._count:
            out.append(frame_of(list(self._partial.values()), self._count))
            self._partial.clear()
        return out


SENDER = 0
TYPES = {3: POSE_TYPE, 4: PING_TYPE, 5: PONG_TYPE}  # The server's own numbers of its types.
SERVER_POSE, SERVER_PING, SERVER_PONG = TYPES


class VrpnSimulator(ServerSimulator):
    """A server that sends every pose to whoever connects, and asks them whether they are there.

    Args:
        motion: What is measured.
        rate_hz: Frames a second.
        log: Where every pose is kept, if anywhere.
        port: TCP port; 0 takes a free one.
    """

    def __init__(
        self,
        motion: MotionSource,
        rate_hz: float = 100.0,
        log: list[Sent] | None = None,
        port: int = 0,
    ) -> None:
        super().__init__(motion, rate_hz, Faults(), log, port)
        self.answers = 0
        self._ready = False
        self._asked_s = 0.0
        self._buffer = bytearray()
        self._their_types: dict[int, str] = {}

    @property
    def place(self) -> str:
        """The place in a device address."""
        return f"Tracker0@{super().place}"

    def _drop(self) -> None:
        super()._drop()
        self._ready = False

    def _attend(self, ready: set[int]) -> None:
        super()._attend(ready)
        if self._ready and time.monotonic() - self._asked_s > PING_S:
            self._asked_s = time.monotonic()
            self._send(SERVER_PING, time.time())

    def _welcome(self) -> None:
        self._ready = False
        self._buffer.clear()
        self._their_types.clear()
        self._put(COOKIE)

    def _hear(self, data: bytes) -> None:
        self._buffer += data
        try:
            if not self._ready and len(self._buffer) >= len(COOKIE):
                self._begin()
            for message in take_messages(self._buffer, decode_message) if self._ready else ():
                self._take(message)
        except DeviceLostError:
            self._drop()

    def _begin(self) -> None:
        """Check the cookie, and name sender and types."""
        check_cookie(bytes(self._buffer))
        del self._buffer[: len(COOKIE)]
        names = [(SENDER_DESCRIPTION, SENDER, "Tracker0")]
        names += [(TYPE_DESCRIPTION, number, name) for number, name in TYPES.items()]
        for kind, number, name in names:
            self._put(Message(0, 0, number, kind, encode_name(name)).encode())
        self._ready, self._asked_s = True, 0.0

    def _take(self, message: Message) -> None:
        if message.type == TYPE_DESCRIPTION:
            self._their_types[message.sender] = decode_name(message.payload) or ""
        elif self._their_types.get(message.type) == PING_TYPE:
            self._send(SERVER_PONG, time.time())
        elif self._their_types.get(message.type) == PONG_TYPE:
            self.answers += 1

    def _send(self, kind: int, stamp_s: float, payload: bytes = b"") -> None:
        stamp = int(stamp_s), int(stamp_s % 1.0 * 1e6)
        self._put(Message(*stamp, SENDER, kind, payload).encode())

    def _measure(self, at_s: float) -> None:
        if not self._ready:
            return
        for sensor, (position, turned) in enumerate(zip(*self._poses(at_s), strict=True)):
            payload = encode_pose(sensor, position, np.roll(turned, -1))
            self._sent(sensor, payload)
            self._send(SERVER_POSE, at_s, payload)
