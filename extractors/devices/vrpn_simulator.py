"""A VRPN server with one tracker, for those who have none, on loopback."""

import socket
import time
from contextlib import suppress
from dataclasses import dataclass

import numpy as np

from extractors.devices import vrpn_messages as vrpn
from extractors.devices.motion_source import MotionSource
from extractors.devices.simulator import Simulator
from extractors.devices.tracker import DeviceLostError
from extractors.devices.vrpn_messages import Message, SensorPose

SENDER = 0
TYPES = {3: vrpn.POSE_TYPE, 4: vrpn.PING_TYPE, 5: vrpn.PONG_TYPE}
"""The server's own numbers of its types."""

POSE, PING, PONG = TYPES
PING_EVERY_S = 1.0


@dataclass(frozen=True, slots=True)
class SentPose:
    """A pose that the server sent."""

    pose: SensorPose
    stamp_s: float


class VrpnSimulator(Simulator):
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
        super().__init__(motion, rate_hz)
        self.port, self.answers = port, 0
        self._log = log
        self._listening: socket.socket | None = None
        self._client: socket.socket | None = None
        self._ready = False
        self._asked_s = 0.0
        self._parser = vrpn.MessageParser()
        self._first = b""
        self._their_types: dict[int, str] = {}

    @property
    def place(self) -> str:
        """The place in a device address."""
        return f"Tracker0@127.0.0.1:{self.port}"

    def _plug(self) -> None:
        self._listening = socket.create_server(("127.0.0.1", self.port))
        self.port = self._listening.getsockname()[1]

    def _unplug(self) -> None:
        for connection in (self._listening, self._client):
            if connection is not None:
                connection.close()
        self._listening = self._client = None
        self._ready = False

    def _handles(self) -> list[int]:
        return [each.fileno() for each in (self._listening, self._client) if each is not None]

    def _attend(self, ready: set[int]) -> None:
        with suppress(OSError):
            if self._listening is not None and self._listening.fileno() in ready:
                self._welcome(self._listening.accept()[0])
            elif self._client is not None and self._client.fileno() in ready:
                self._hear(self._client)
        if self._ready and time.monotonic() - self._asked_s > PING_EVERY_S:
            self._asked_s = time.monotonic()
            self._send(PING, time.time())

    def _welcome(self, client: socket.socket) -> None:
        self._client, self._ready, self._first = client, False, b""
        client.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
        self._parser, self._their_types = vrpn.MessageParser(), {}
        client.sendall(vrpn.cookie())

    def _hear(self, client: socket.socket) -> None:
        data = client.recv(65536)
        if not data:
            self._drop(client)
            return
        try:
            if not self._ready:
                data = self._begin(client, data)
            for message in self._parser.feed(data) if self._ready else ():
                self._take(message)
        except DeviceLostError:
            self._drop(client)

    def _drop(self, client: socket.socket) -> None:
        client.close()
        self._client, self._ready = None, False

    def _begin(self, client: socket.socket, data: bytes) -> bytes:
        """Check the cookie, name sender and types, and give what came after the cookie."""
        self._first += data
        if len(self._first) < vrpn.COOKIE_SIZE:
            return b""
        vrpn.check_cookie(self._first)
        names = [(vrpn.SENDER_DESCRIPTION, SENDER, "Tracker0")]
        names += [(vrpn.TYPE_DESCRIPTION, number, name) for number, name in TYPES.items()]
        for kind, number, name in names:
            client.sendall(Message(0, 0, number, kind, vrpn.encode_name(name)).encode())
        self._ready, self._asked_s = True, 0.0
        return self._first[vrpn.COOKIE_SIZE :]

    def _take(self, message: Message) -> None:
        if message.type == vrpn.TYPE_DESCRIPTION:
            self._their_types[message.sender] = vrpn.decode_name(message.payload) or ""
        elif self._their_types.get(message.type) == vrpn.PING_TYPE:
            self._send(PONG, time.time())
        elif self._their_types.get(message.type) == vrpn.PONG_TYPE:
            self.answers += 1

    def _send(self, kind: int, stamp_s: float, payload: bytes = b"") -> None:
        message = Message(int(stamp_s), int(stamp_s % 1.0 * 1e6), SENDER, kind, payload)
        with suppress(OSError):
            if self._client is not None:
                self._client.sendall(message.encode())

    def _measure(self, at_s: float) -> None:
        if not self._ready:
            return
        positions, orientations = self._poses(at_s)
        for index, (position, turned) in enumerate(zip(positions, orientations, strict=True)):
            quaternion = tuple(np.roll(turned, -1).tolist())
            pose = SensorPose(index, tuple(position.tolist()), quaternion)
            if self._log is not None:
                self._log.append(SentPose(pose, at_s))
            self._send(POSE, at_s, pose.encode())
