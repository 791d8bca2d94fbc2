"""Ascension MotionStar by its Ethernet server: BirdNet packets (protocol 3), driver and simulator.

All numbers are big-endian. Uncertain without the device, and so switches: the sign of the
quaternion (``quaternion``) and the divisor of words (``divisor``). Header times are passed on as
the device's, though it is not certain whether their milliseconds are a time or an interval. Packets
are counted by their sequence numbers; a server that leaves them as they are loses packets unseen,
which is reported.
"""

import random
import socket
import struct
import time
from collections.abc import Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass, replace
from enum import IntEnum

from capar.model.errors import DeviceError
from extractors.devices.bird_formats import (
    FORMATS,
    BirdFormat,
    Scaling,
    pose_of_words,
    words_of_pose,
)
from extractors.devices.flock import (
    ACCESSIBLE,
    ERC,
    EVERY,
    HEMISPHERES,
    MOST_HZ,
    RUNNING,
    SENSOR,
    error_text,
)
from extractors.devices.lines import NetworkLine
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

PROTOCOL = 3
HEADER = struct.Struct(">HHIBBBBHH")
MOST_BODY = 4096  # Bytes of the largest body that is believed; more is no packet.
SYSTEM_STATUS = struct.Struct(">BBBBB6sBBBH")
BIRD_STATUS_SIZE = 70
BUTTONS = 0x80


class Kind(IntEnum):
    """Types of commands, of data, and of answers to what is no command."""

    WAKE_UP = 10
    SHUT_DOWN = 11
    ILLEGAL = 40
    UNKNOWN = 50
    GET_STATUS = 101
    SEND_SETUP = 102
    RUN_CONTINUOUS = 104
    STOP_DATA = 105
    DATA = 210


RESPONSES = {
    Kind.WAKE_UP: 20, Kind.SHUT_DOWN: 21, Kind.GET_STATUS: 201, Kind.SEND_SETUP: 202,
    Kind.RUN_CONTINUOUS: 204, Kind.STOP_DATA: 205,
}  # fmt: skip
"""The type of the response to each command."""


class PacketError(DeviceError):
    """Bytes that are no BirdNet packet."""


@dataclass(frozen=True)
class Packet:
    """A header and its body."""

    kind: int
    sequence: int = 0
    xtype: int = 0
    """0 for the system, else a bird's address."""

    body: bytes = b""
    seconds: int = 0
    milliseconds: int = 0
    error: int = 0
    error_extension: int = 0

    def encode(self) -> bytes:
        """The packet's bytes."""
        head = HEADER.pack(
            self.sequence, self.milliseconds, self.seconds, self.kind, self.xtype,
            PROTOCOL, self.error, self.error_extension, len(self.body),
        )  # fmt: skip
        return head + self.body


def decode_packet(data: bytes | bytearray) -> tuple[Packet, int] | None:
    """The packet at the start of some bytes, and its length; None where more bytes are needed.

    Raises:
        PacketError: The bytes begin no packet of this protocol.
    """
    if len(data) < HEADER.size:
        return None
    sequence, milli, seconds, kind, xtype, protocol, error, extension, size = HEADER.unpack_from(
        data
    )
    if protocol != PROTOCOL or size > MOST_BODY:
        raise PacketError(f"no BirdNet packet: protocol {protocol}, body of {size} bytes")
    end = HEADER.size + size
    if len(data) < end:
        return None
    body = bytes(data[HEADER.size : end])
    return Packet(kind, sequence, xtype, body, seconds, milli, error, extension), end


@dataclass(frozen=True)
class SystemStatus:
    """What the server says of itself and of all units."""

    rate_hz: float
    units: tuple[int, ...]
    """Bits of each unit, from the first address on, as in the flock status."""

    first: int = 1
    flags: int = 0x08
    error: int = 0
    revision: int = 0

    @property
    def birds(self) -> tuple[int, ...]:
        """Addresses of the units that are there and have a sensor."""
        need = ACCESSIBLE | SENSOR
        return tuple(
            self.first + index for index, bits in enumerate(self.units) if bits & need == need
        )

    def encode(self) -> bytes:
        """The status as a body."""
        digits = f"{round(self.rate_hz * 1000.0):06d}".encode()
        return SYSTEM_STATUS.pack(
            self.flags, self.error, 1, 0, 0, digits, 0, len(self.units), self.first, self.revision
        ) + bytes(self.units)


def decode_system_status(body: bytes) -> SystemStatus:
    """The status that a body holds.

    Raises:
        PacketError: It is too short, or its rate is no number.
    """
    if len(body) < SYSTEM_STATUS.size:
        raise PacketError(f"system status of {len(body)} bytes; at least {SYSTEM_STATUS.size}")
    flags, error, _, _, _, digits, _, count, first, revision = SYSTEM_STATUS.unpack_from(body)
    units = body[SYSTEM_STATUS.size : SYSTEM_STATUS.size + count]
    if not digits.isdigit() or len(units) < count:
        raise PacketError(f"system status with rate {digits!r} and {len(units)} of {count} units")
    return SystemStatus(int(digits) / 1000.0, tuple(units), first, flags, error, revision)


@dataclass(frozen=True)
class BirdStatus:
    """One bird's setup, and the bytes of it that are left as they came."""

    address: int
    form: BirdFormat
    range_inch: float
    hemisphere: int = 0
    report_every: int = 1
    error: int = 0
    raw: bytes = bytes(BIRD_STATUS_SIZE)

    def encode(self) -> bytes:
        """The status as a body."""
        out = bytearray(self.raw)
        out[4] = self.error
        out[6] = self.form.words << 4 | self.form.code
        out[7] = self.report_every
        scaling = int.from_bytes(out[8:10], "big") & 0xF000 | int(self.range_inch) & 0x0FFF
        out[8:10] = scaling.to_bytes(2, "big")
        out[10] = self.hemisphere
        out[11] = self.address
        return bytes(out)


def decode_bird_status(body: bytes) -> BirdStatus:
    """The setup that a body holds.

    Raises:
        PacketError: It has another length, or a data format that no bird has.
    """
    if len(body) != BIRD_STATUS_SIZE:
        raise PacketError(f"bird status of {len(body)} bytes; it has {BIRD_STATUS_SIZE}")
    form = form_of(body[6] & 0x0F, body[6] >> 4)
    scaling = int.from_bytes(body[8:10], "big") & 0x0FFF
    return BirdStatus(body[11], form, float(scaling), body[10], body[7], body[4], bytes(body))


def form_of(code: int, words: int) -> BirdFormat:
    """The format of a code and a number of words.

    Raises:
        PacketError: There is none.
    """
    form = _BY_CODE.get(code)
    if form is None or form.words != words:
        raise PacketError(f"data format {code} with {words} words; no bird sends that")
    return form


def encode_data(birds: Mapping[int, tuple[BirdFormat, Sequence[int]]]) -> bytes:
    """The body of a data packet: each bird's address, format and words."""
    out = bytearray()
    for address, (form, words) in birds.items():
        out += bytes([address, form.code << 4 | form.words])
        out += struct.pack(f">{form.words}h", *words)
    return bytes(out)


def decode_data(body: bytes) -> dict[int, tuple[BirdFormat, tuple[int, ...]]]:
    """Format and words of each bird in a data packet.

    Raises:
        PacketError: A format is unknown, the body ends within a bird, or one stands twice.
    """
    out: dict[int, tuple[BirdFormat, tuple[int, ...]]] = {}
    at = 0
    while at < len(body):
        head = body[at : at + 2]
        if len(head) < 2:
            raise PacketError("data end within a bird's head")
        form, bird = form_of(head[1] >> 4, head[1] & 0x0F), head[0] & 0x7F
        start, at = at + 2, at + 2 + 2 * form.words + 2 * bool(head[0] & BUTTONS)
        if at > len(body):
            raise PacketError(f"data end within bird {bird}")
        if bird in out:
            raise PacketError(f"bird {bird} stands twice in a packet")
        out[bird] = form, struct.unpack_from(f">{form.words}h", body, start)
    return out


_BY_CODE = {each.code: each for each in FORMATS.values()}


PORTS = {"tcp": 6000, "udp": 5000}
REPLY_S = 1.0
ATTEMPTS = 3
SILENCE_S = 2.0  # A server that sends nothing for so long is lost [s].
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
        self._host, self._port = address.host_port(address.place, PORTS[transport])
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
        status = decode_system_status(self._ask(Kind.GET_STATUS).body)
        if status.error:
            raise self._address.error(error_text(status.error))
        if len(status.birds) != self._count:
            raise self._address.error(
                f"the server has {len(status.birds)} birds, at {list(status.birds)}; "
                f"birds={self._count}"
            )
        self._birds = status.birds
        self._details = {"revision": str(status.revision), "addresses": str(list(status.birds))}
        self._ask(Kind.SEND_SETUP, body=replace(status, rate_hz=self._rate_hz).encode())
        for bird in self._birds:
            self._set_up(bird)
        self._ask(Kind.RUN_CONTINUOUS)

    def _set_up(self, bird: int) -> None:
        """Format and hemisphere of a bird, whose range the server says."""
        setup = decode_bird_status(self._ask(Kind.GET_STATUS, bird).body)
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
        """The response to a command; data before it are dropped, those after it kept."""
        for _ in range(ATTEMPTS if needed else 1):
            self._sequence = (self._sequence + 1) % SEQUENCES
            self._line.write(Packet(kind, self._sequence, bird, body).encode())
            deadline = time.monotonic() + (REPLY_S if needed else REPLY_S / 4.0)
            while time.monotonic() < deadline:
                packets = self._packets(max(0.0, deadline - time.monotonic()))
                for index, packet in enumerate(packets):
                    if packet.sequence != self._sequence or packet.kind == Kind.DATA:
                        continue
                    if packet.kind != RESPONSES[kind]:
                        raise self._address.error(f"the server refuses {kind.name}")
                    self._early = packets[index + 1 :]
                    return packet
        if not needed:
            return Packet(RESPONSES[kind])
        raise DeviceLostError(f"{self._address.text}: no response to {kind.name}")

    def _packets(self, timeout_s: float) -> list[Packet]:
        """The packets that come within a wait."""
        data = self._line.read(timeout_s)
        out: list[Packet] = []
        if not self._is_stream:
            self._buffer.clear()
        self._buffer += data
        try:
            for packet in take_messages(self._buffer, decode_packet):
                out.append(packet)  # kept, where a later one is damaged
        except PacketError as error:
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
            data = decode_data(packet.body)
        except PacketError:
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
            # if the header's milliseconds belong to its seconds
            stamp_s = packet.seconds + packet.milliseconds / 1000.0
            readings.append(SensorReading(self._birds.index(address), now, *pose, stamp_s))
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


RANGE_INCH = 144.0
RATE_HZ = 103.3


class MotionStarSimulator(ServerSimulator):
    """A server with a controller as unit 1, and one bird a sensor of the motion from 2 on.

    Args:
        motion: What is measured.
        faults: What goes wrong.
        log: Where every data packet is kept, if anywhere.
        port: Port for TCP and UDP; 0 takes a free one.
    """

    def __init__(
        self,
        motion: MotionSource,
        faults: Faults | None = None,
        log: list[Sent] | None = None,
        port: int = 0,
    ) -> None:
        super().__init__(motion, RATE_HZ, faults or Faults(), log, port)
        self._random = random.Random(self._faults.seed)
        self._birds = tuple(range(2, 2 + len(motion.sensors)))
        self._datagrams: socket.socket | None = None
        self._peer: tuple[str, int] | None = None
        self._forget()

    def _forget(self) -> None:
        self._setups = {
            bird: BirdStatus(bird, FORMATS["pos_ang"], RANGE_INCH) for bird in self._birds
        }
        self._rate_hz, self._sending, self._sequence = RATE_HZ, False, 0
        self._buffer = bytearray()

    def _plug(self) -> None:
        self._forget()
        super()._plug()
        self._datagrams = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        self._datagrams.bind(("127.0.0.1", self.port))

    def _unplug(self) -> None:
        super()._unplug()
        if self._datagrams is not None:
            self._datagrams.close()
        self._datagrams = self._peer = None

    def _drop(self) -> None:
        super()._drop()
        self._sending = False

    def _handles(self) -> list[int]:
        return super()._handles() + ([self._datagrams.fileno()] if self._datagrams else [])

    def _attend(self, ready: set[int]) -> None:
        super()._attend(ready)
        with suppress(OSError):
            if self._datagrams is not None and self._datagrams.fileno() in ready:
                data, self._peer = self._datagrams.recvfrom(65536)
                self._obey_all(bytearray(data))

    def _welcome(self) -> None:
        self._peer = None
        self._buffer.clear()

    def _hear(self, data: bytes) -> None:
        self._buffer += data
        self._obey_all(self._buffer)

    def _obey_all(self, buffer: bytearray) -> None:
        with suppress(PacketError):
            for packet in take_messages(buffer, decode_packet):
                self._send(self._obey(packet))

    def _send(self, packet: Packet) -> None:
        if self._peer is not None and self._datagrams is not None:
            with suppress(OSError):
                self._datagrams.sendto(packet.encode(), self._peer)
        else:
            self._put(packet.encode())

    def _obey(self, packet: Packet) -> Packet:
        """The response to a command: its sequence number and address, and the type it answers."""
        known = packet.xtype == 0 or packet.xtype in self._setups
        if packet.kind not in RESPONSES or not known:
            return Packet(Kind.UNKNOWN, packet.sequence, packet.xtype)
        body = b""
        if packet.kind == Kind.GET_STATUS:
            body = self._status(packet.xtype)
        elif packet.kind == Kind.SEND_SETUP:
            try:
                if packet.xtype == 0:
                    self._rate_hz = decode_system_status(packet.body).rate_hz or RATE_HZ
                else:
                    setup = decode_bird_status(packet.body)
                    self._setups[packet.xtype] = replace(setup, range_inch=RANGE_INCH)
            except PacketError:
                return Packet(Kind.ILLEGAL, packet.sequence, packet.xtype)
        elif packet.kind != Kind.WAKE_UP:
            self._sending = packet.kind == Kind.RUN_CONTINUOUS
            self._sequence = packet.sequence
        return Packet(RESPONSES[Kind(packet.kind)], packet.sequence, packet.xtype, body)

    def _status(self, bird: int) -> bytes:
        if bird:
            return self._setups[bird].encode()
        units = (
            ACCESSIBLE | RUNNING | ERC | 0x01,
            *[ACCESSIBLE | RUNNING | SENSOR] * len(self._birds),
        )
        flags = 0x0C | 0x80 * self._sending | 0x40 * bool(self._faults.error)
        return SystemStatus(self._rate_hz, units, 1, flags, self._faults.error).encode()

    def _measure(self, at_s: float) -> None:
        every = self._setups[self._birds[0]].report_every
        if not self._sending or self._cycle % max(1, every):
            return
        self._sequence = (self._sequence + self._faults.numbered) % SEQUENCES
        birds, scaling = {}, Scaling(RANGE_INCH)
        for bird, place, turned in zip(self._birds, *self._poses(at_s), strict=True):
            form = self._setups[bird].form
            birds[bird] = form, words_of_pose(place, turned, form, scaling)
        body = encode_data(birds)
        intact = self._random.random() >= self._faults.lost_share
        self._sent(0, body, intact=intact)
        if intact:
            since_s = at_s - self._start_s
            seconds, milli = int(since_s), int(since_s % 1.0 * 1000.0)
            self._send(Packet(Kind.DATA, self._sequence, 0, body, seconds, milli))
