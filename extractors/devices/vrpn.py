"""VRPN client: the poses that a VRPN server sends of one of its trackers.

VRPN has metres, but no convention for what is up: ``up`` says which of its axes is. A server may
send only what changed; a frame then has NaN for the other sensors, and that is no loss.
"""

import time

import numpy as np
from scipy.spatial.transform import Rotation

from extractors.devices import vrpn_messages as vrpn
from extractors.devices.addresses import Address
from extractors.devices.frames import SensorReading, frame_of
from extractors.devices.network_line import NetworkLine
from extractors.devices.tracker import Description, DeviceLostError, Frame, LiveTracker
from extractors.devices.vrpn_messages import Message

PORT = 3883
COOKIE_S = 3.0
PING_S = 1.0
"""How often the server is asked whether it is there [s]."""

SILENCE_S = 5.0
"""A server that answers nothing for so long is lost [s]."""

NORM_TOLERANCE = 0.05
OURS = "capar"
PING, PONG = 0, 1
"""Our numbers of the types that we send."""

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
        place = Address(address.text, address.kind, host, {})
        self._line = NetworkLine(*place.host_port(PORT))
        self._count = address.integer("sensors", 1, low=1, high=1000)
        self._names = address.names(f"sensor{index}" for index in range(self._count))
        self._up = UP[address.choice("up", UP, "z")]
        address.close()
        self._start()

    def _start(self) -> None:
        self._parser = vrpn.MessageParser()
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
        self._line.write(vrpn.cookie())
        data, deadline = b"", time.monotonic() + COOKIE_S
        while len(data) < vrpn.COOKIE_SIZE:
            if time.monotonic() > deadline:
                raise DeviceLostError("the server does not say that it is VRPN")
            data += self._line.read(0.1)
        vrpn.check_cookie(data)
        self._describe_ours()
        self._early = data[vrpn.COOKIE_SIZE :]

    def _describe_ours(self) -> None:
        """Name the sender and the types of what we send: the tracker's, as clients do."""
        for kind, number, name in (
            (vrpn.SENDER_DESCRIPTION, 0, self._device),
            (vrpn.TYPE_DESCRIPTION, PING, vrpn.PING_TYPE),
            (vrpn.TYPE_DESCRIPTION, PONG, vrpn.PONG_TYPE),
        ):
            self._send(kind, number, vrpn.encode_name(name))

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
        if message.type in (vrpn.SENDER_DESCRIPTION, vrpn.TYPE_DESCRIPTION):
            names = self._senders if message.type == vrpn.SENDER_DESCRIPTION else self._types
            name = vrpn.decode_name(message.payload)
            if name is not None:
                names[message.sender] = name
            return []
        if self._senders.get(message.sender) != self._device:
            return []
        kind = self._types.get(message.type)
        if kind == vrpn.PING_TYPE:
            self._send(PONG)
        return self._pose(message, now) if kind == vrpn.POSE_TYPE else []

    def _pose(self, message: Message, now: float) -> list[Frame]:
        pose = vrpn.decode_pose(message.payload)
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
