"""BirdNet, protocol 3: the packets of a MotionStar's Ethernet server; big-endian throughout."""

import struct
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from enum import IntEnum
from typing import Any

from capar.model.errors import DeviceError
from extractors.devices.bird_formats import FORMATS, BirdFormat
from extractors.devices.flock_commands import ACCESSIBLE, ERC, RUNNING, SENSOR

PROTOCOL = 3
HEADER = struct.Struct(">HHIBBBBHH")
MOST_BODY = 4096
"""Bytes of the largest body that is believed; more is no packet."""

SYSTEM_STATUS = struct.Struct(">BBBBB6sBBBH")
BIRD_STATUS_SIZE = 70
BUTTONS = 0x80


class Kind(IntEnum):
    """Packet types; a response is what its command asks for."""

    WAKE_UP = 10
    SHUT_DOWN = 11
    WAKE_UP_DONE = 20
    SHUT_DOWN_DONE = 21
    ILLEGAL = 40
    UNKNOWN = 50
    GET_STATUS = 101
    SEND_SETUP = 102
    SINGLE_SHOT = 103
    RUN_CONTINUOUS = 104
    STOP_DATA = 105
    SEND_DATA = 106
    STATUS = 201
    SETUP_DONE = 202
    SINGLE_SHOT_DONE = 203
    RUN_CONTINUOUS_DONE = 204
    STOP_DATA_DONE = 205
    SEND_DATA_DONE = 206
    DATA = 210


RESPONSES = {
    Kind.WAKE_UP: Kind.WAKE_UP_DONE,
    Kind.SHUT_DOWN: Kind.SHUT_DOWN_DONE,
    Kind.GET_STATUS: Kind.STATUS,
    Kind.SEND_SETUP: Kind.SETUP_DONE,
    Kind.SINGLE_SHOT: Kind.SINGLE_SHOT_DONE,
    Kind.RUN_CONTINUOUS: Kind.RUN_CONTINUOUS_DONE,
    Kind.STOP_DATA: Kind.STOP_DATA_DONE,
    Kind.SEND_DATA: Kind.SEND_DATA_DONE,
}


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

    @property
    def stamp_s(self) -> float:
        """The server's time [s], if the header's milliseconds belong to its seconds."""
        return self.seconds + self.milliseconds / 1000.0


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
        if at + 2 > len(body):
            raise PacketError("data end within a bird's head")
        address, code = body[at], body[at + 1]
        form = form_of(code >> 4, code & 0x0F)
        at += 2
        end = at + 2 * form.words
        if end + 2 * bool(address & BUTTONS) > len(body):
            raise PacketError(f"data end within bird {address & 0x7F}")
        if address & 0x7F in out:
            raise PacketError(f"bird {address & 0x7F} stands twice in a packet")
        out[address & 0x7F] = form, struct.unpack(f">{form.words}h", body[at:end])
        at = end + 2 * bool(address & BUTTONS)
    return out


def unit_bits(*, sensor: bool) -> int:
    """Bits of a running unit: a bird with a sensor, or the controller."""
    return ACCESSIBLE | RUNNING | (SENSOR if sensor else ERC | 0x01)


def reply(command: Packet, **changes: Any) -> Packet:
    """The response to a command: its sequence number and address, and the type that answers it."""
    kind = RESPONSES.get(Kind(command.kind), Kind.UNKNOWN) if command.kind in _KINDS else 50
    base = Packet(kind, command.sequence, command.xtype)
    return replace(base, **changes)


_BY_CODE = {each.code: each for each in FORMATS.values()}
_KINDS = frozenset(int(each) for each in Kind)
