"""VRPN over TCP: messages, client and simulated server."""

import struct
import time
from dataclasses import dataclass

import numpy as np
from scipy.spatial.transform import Rotation

from extractors.devices.lines import NetworkLine
from extractors.devices.simulator import MotionSource, ServerSimulator
from extractors.devices.tracker import (
    Address,
    Description,
    DeviceLostError,
    Frame,
    LiveTracker,
    SensorReading,
    frame_of,
)

COOKIE = b"vrpn: ver. 07.38  0"
COOKIE_SIZE = 24
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


PORT = 3883
COOKIE_S = 3.0
PING_S = 1.0  # How often the server is asked whether it is there [s].
SILENCE_S = 5.0  # A server that answers nothing for so long is lost [s].
NORM_TOLERANCE = 0.05
OURS = "capar"
PING, PONG = 0, 1  # Our numbers of the types that we send.

UP = {
    "z": Rotation.identity(),
    "y": Rotation.from_euler("x", 90.0, degrees=True),
    "x": Rotation.from_euler("y", -90.0, degrees=True),
    "-z": Rotation.from_euler("x", 180.0, degrees=True),
    "-y": Rotation.from_euler("x", -90.0, degrees=True),
    "-x": Rotation.from_euler("y", 90.0, degrees=True),
}
"""The turn that brings each axis to z."""


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
        self._up = UP[address.choice("up", UP, "z")]
        address.close()
        self._start()

    def _start(self) -> None:
        self._parser = MessageParser()
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
        self._line.write(cookie())
        data, deadline = b"", time.monotonic() + COOKIE_S
        while len(data) < COOKIE_SIZE:
            if time.monotonic() > deadline:
                raise DeviceLostError("the server does not say that it is VRPN")
            data += self._line.read(0.1)
        check_cookie(data)
        self._describe_ours()
        self._early = data[COOKIE_SIZE:]

    def _describe_ours(self) -> None:
        """Name the sender and the types of what we send: the tracker's, as clients do."""
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
        data = self._early or self._line.read(timeout_s)
        self._early = b""
        self._listened(since_s, SILENCE_S, heard=bool(data))
        now = time.monotonic()
        if now - self._asked_s > PING_S:
            self._asked_s = now
            self._send(PING)
        return [f for each in self._parser.feed(data) for f in self._take(each, now)]

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
        pose = decode_pose(message.payload)
        norm = float(np.linalg.norm(pose.quaternion)) if pose is not None else 0.0
        known = pose is not None and 0 <= pose.sensor < self._count
        if pose is None or not known or not abs(norm - 1.0) <= NORM_TOLERANCE:
            self.counts.refused_records += 1
            return []
        self.counts.records += 1
        turn = self._up * Rotation.from_quat(pose.quaternion)
        reading = SensorReading(
            pose.sensor,
            now,
            self._up.apply(pose.position),
            turn.as_quat(scalar_first=True),
            message.stamp_s,
        )
        return self._gather(reading)

    def _gather(self, reading: SensorReading) -> list[Frame]:
        """The frames that a reading ends: by being the last, or of another time."""
        out = []
        begun = next(iter(self._partial.values()), reading)
        if begun.device_s != reading.device_s or reading.index in self._partial:
            out.append(frame_of(list(self._partial.values()), self._count))
            self._partial.clear()
        self._partial[reading.index] = reading
        if len(self._partial) == self._count:
            out.append(frame_of(list(self._partial.values()), self._count))
            self._partial.clear()
        return out


SENDER = 0
TYPES = {3: POSE_TYPE, 4: PING_TYPE, 5: PONG_TYPE}  # The server's own numbers of its types.
SERVER_POSE, SERVER_PING, SERVER_PONG = TYPES


@dataclass(frozen=True, slots=True)
class SentPose:
    """A pose that the server sent."""

    pose: SensorPose
    stamp_s: float


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
        log: list[SentPose] | None = None,
        port: int = 0,
    ) -> None:
        super().__init__(motion, rate_hz, port)
        self.answers = 0
        self._log = log
        self._ready = False
        self._asked_s = 0.0
        self._parser = MessageParser()
        self._first = b""
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
        self._ready, self._first = False, b""
        self._parser, self._their_types = MessageParser(), {}
        self._put(cookie())

    def _hear(self, data: bytes) -> None:
        try:
            if not self._ready:
                data = self._begin(data)
            for message in self._parser.feed(data) if self._ready else ():
                self._take(message)
        except DeviceLostError:
            self._drop()

    def _begin(self, data: bytes) -> bytes:
        """Check the cookie, name sender and types, and give what came after the cookie."""
        self._first += data
        if len(self._first) < COOKIE_SIZE:
            return b""
        check_cookie(self._first)
        names = [(SENDER_DESCRIPTION, SENDER, "Tracker0")]
        names += [(TYPE_DESCRIPTION, number, name) for number, name in TYPES.items()]
        for kind, number, name in names:
            self._put(Message(0, 0, number, kind, encode_name(name)).encode())
        self._ready, self._asked_s = True, 0.0
        return self._first[COOKIE_SIZE:]

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
        positions, orientations = self._poses(at_s)
        for index, (position, turned) in enumerate(zip(positions, orientations, strict=True)):
            quaternion = tuple(np.roll(turned, -1).tolist())
            pose = SensorPose(index, tuple(position.tolist()), quaternion)
            if self._log is not None:
                self._log.append(SentPose(pose, at_s))
            self._send(SERVER_POSE, at_s, pose.encode())
