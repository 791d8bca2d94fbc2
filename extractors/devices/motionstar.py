"""Ascension MotionStar by its Ethernet server: BirdNet over TCP or UDP.

Uncertain without the device, and so switches: the sign of the quaternion (``quaternion``) and
the divisor of words (``divisor``). Header times are passed on as the device's, though it is not
certain whether their milliseconds are a time or an interval. Packets are counted by their
sequence numbers; a server that leaves them as they are loses packets unseen, which is told.
"""

import time
from dataclasses import replace

from capar.model.errors import DeviceError
from extractors.devices import birdnet_packets as birdnet
from extractors.devices.addresses import Address
from extractors.devices.bird_formats import FORMATS, Scaling, pose_of_words
from extractors.devices.birdnet_packets import Kind, Packet
from extractors.devices.flock_commands import EVERY, HEMISPHERES, MOST_HZ, error_text
from extractors.devices.frames import SensorReading, frame_of
from extractors.devices.network_line import NetworkLine
from extractors.devices.tracker import Description, DeviceLostError, Frame, LiveTracker

PORTS = {"tcp": 6000, "udp": 5000}
REPLY_S = 1.0
ATTEMPTS = 3
SILENCE_S = 2.0
"""A server that sends nothing for so long is lost [s]."""

SEQUENCES = 0x10000


class MotionStarTracker(LiveTracker):
    """The birds of a MotionStar.

    Args:
        address: Like ``motionstar:HOST?birds=12&rate=103.3``.

    Raises:
        CaparError: The address holds what no MotionStar can be set to.
    """

    def __init__(self, address: Address) -> None:
        super().__init__()
        transport = address.choice("transport", PORTS, "tcp")
        self._is_stream = transport == "tcp"
        self._host, self._port = address.host_port(PORTS[transport])
        self._rate_hz = address.number("rate", 103.3, low=1.0, high=MOST_HZ)
        self._every = int(address.choice("every", map(str, EVERY), "1"))
        self._form = FORMATS[address.choice("format", FORMATS, "pos_quat")]
        self._hemisphere = HEMISPHERES[address.choice("hemisphere", HEMISPHERES, "front")]
        conjugated = address.choice("quaternion", ("conjugated", "plain"), "conjugated")
        divisor = int(address.choice("divisor", ("32768", "32767"), "32768"))
        self._scaling = Scaling(144.0, conjugated == "conjugated", divisor)
        self._count = address.integer("birds", 12, low=1, high=120)
        self._names = address.names(f"bird{index + 1}" for index in range(self._count))
        address.close()
        self._address = address
        self._line = NetworkLine(self._host, self._port, stream=self._is_stream)
        self._buffer = bytearray()
        self._early: list[Packet] = []
        self._birds: tuple[int, ...] = ()
        self._ranges: dict[int, Scaling] = {}
        self._details: dict[str, str] = {}
        self._sequence = 0
        self._last: int | None = None
        self._cycle = -1
        self._numbered = True

    def describe(self) -> Description:
        """What the server said, and its birds."""
        return Description(
            kind="motionstar",
            model="MotionStar",
            sensors=self._names,
            rate_hz=self._rate_hz / self._every,
            has_positions=self._form.position,
            has_orientations=bool(self._form.orientation),
            details=self._details,
        )

    def _connect(self) -> None:
        self._line.open()
        self._buffer.clear()
        self._early.clear()
        self._last = None
        self._cycle = -1
        self._ask(Kind.STOP_DATA, needed=False)
        self._ask(Kind.WAKE_UP)
        status = birdnet.decode_system_status(self._ask(Kind.GET_STATUS).body)
        self._take_birds(status)
        self._ask(Kind.SEND_SETUP, body=replace(status, rate_hz=self._rate_hz).encode())
        for bird in self._birds:
            self._set_up(bird)
        self._ask(Kind.RUN_CONTINUOUS)

    def _take_birds(self, status: birdnet.SystemStatus) -> None:
        """The birds that are there, as many as the address says.

        Raises:
            DeviceError: There are others, or the server reports an error.
        """
        if status.error:
            raise self._address.error(error_text(status.error))
        if len(status.birds) != self._count:
            raise self._address.error(
                f"the server has {len(status.birds)} birds, at {list(status.birds)}; "
                f"birds={self._count}"
            )
        self._birds = status.birds
        self._details = {"revision": str(status.revision), "addresses": str(list(status.birds))}

    def _set_up(self, bird: int) -> None:
        """Format and hemisphere of a bird, whose range the server says."""
        setup = birdnet.decode_bird_status(self._ask(Kind.GET_STATUS, bird).body)
        if setup.error:
            raise self._address.error(error_text(setup.error, bird))
        self._ranges[bird] = replace(self._scaling, range_inch=setup.range_inch)
        wanted = replace(
            setup,
            form=self._form,
            hemisphere=self._hemisphere[0] | self._hemisphere[1],
            report_every=self._every,
        )
        self._ask(Kind.SEND_SETUP, bird, body=wanted.encode())

    def _ask(self, kind: Kind, bird: int = 0, *, body: bytes = b"", needed: bool = True) -> Packet:
        """The response to a command; data before it are dropped, those after it kept.

        Raises:
            DeviceError: None comes, though it is needed, or the server refuses the command.
        """
        for _ in range(ATTEMPTS if needed else 1):
            self._sequence = (self._sequence + 1) % SEQUENCES
            self._line.write(Packet(kind, self._sequence, bird, body).encode())
            deadline = time.monotonic() + (REPLY_S if needed else REPLY_S / 4.0)
            while time.monotonic() < deadline:
                packets = self._packets(max(0.0, deadline - time.monotonic()))
                for index, packet in enumerate(packets):
                    if packet.sequence != self._sequence or packet.kind == Kind.DATA:
                        continue
                    if packet.kind != birdnet.RESPONSES[kind]:
                        raise self._address.error(f"the server refuses {kind.name}")
                    self._early = packets[index + 1 :]
                    return packet
        if not needed:
            return Packet(birdnet.RESPONSES[kind])
        raise DeviceLostError(f"{self._address.text}: no response to {kind.name}")

    def _packets(self, timeout_s: float) -> list[Packet]:
        """The packets that come within a wait.

        Raises:
            DeviceLostError: A stream's bytes are no packets, so that it cannot be followed.
        """
        data = self._line.read(timeout_s)
        out: list[Packet] = []
        try:
            if not self._is_stream:
                self._buffer.clear()
            self._buffer += data
            while (found := birdnet.decode_packet(self._buffer)) is not None:
                out.append(found[0])
                del self._buffer[: found[1]]
        except birdnet.PacketError as error:
            self.counts.dropped_bytes += len(self._buffer)
            if self._is_stream:
                raise DeviceLostError(str(error)) from None
        return out

    def _disconnect(self) -> None:
        self._line.close()

    def _stop(self) -> None:
        try:
            self._ask(Kind.STOP_DATA)
            self._ask(Kind.SHUT_DOWN)
        except DeviceError as error:
            self._say(f"the server did not confirm the end: {error}")

    def _read(self, timeout_s: float) -> list[Frame]:
        since_s = time.monotonic()
        packets, self._early = self._early or self._packets(timeout_s), []
        longest_s = SILENCE_S + 3.0 * self._every / self._rate_hz
        self._listened(since_s, longest_s, heard=bool(packets))
        now = time.monotonic()
        return [
            frame
            for packet in packets
            if packet.kind == Kind.DATA
            for frame in self._frame(packet, now)
        ]

    def _frame(self, packet: Packet, now: float) -> list[Frame]:
        try:
            data = birdnet.decode_data(packet.body)
        except birdnet.PacketError:
            self.counts.refused_records += 1
            return []
        if not self._follows(packet.sequence):
            return []
        readings = []
        for address, (form, words) in data.items():
            pose = None
            if address in self._birds and form == self._form:
                pose = pose_of_words(words, form, self._ranges[address])
            if pose is None:
                self.counts.refused_records += 1
                continue
            index = self._birds.index(address)
            readings.append(SensorReading(index, now, *pose, packet.stamp_s))
        self.counts.records += len(readings)
        self.counts.lost_records += self._count - len(readings)
        return [frame_of(readings, self._count, cycle=self._cycle)] if readings else []

    def _follows(self, sequence: int) -> bool:
        """Whether a packet is later than the one before; those between are counted as lost."""
        step = 1 if self._last is None else (sequence - self._last) % SEQUENCES
        if step >= SEQUENCES // 2:
            self.counts.refused_records += 1
            return False
        if step == 0 and self._numbered:
            self._numbered = False
            self._say("the server does not number its packets, so losses cannot be counted")
        self._last = sequence
        self._cycle += max(1, step)
        self.counts.lost_records += max(0, step - 1) * self._count
        return True
