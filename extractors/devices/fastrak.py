"""Polhemus Fastrak over RS-232: up to four stations; records, driver and simulator.

The transmitter's frame is taken as x forward, y to the right, z down; quaternions are w x y z,
sensor to transmitter, as they come. Records are lines of ASCII, or binary with a header; both end
in CR LF. The carriage return is asked for in binary records too (item 1): with the three bytes of
the header it frames a record of fixed length, so that a lost byte shows. A record counts where its
header, its length and its end agree and a quaternion's norm is one.
"""

import math
import struct
import time
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from scipy.spatial.transform import Rotation

from extractors.devices.bird_formats import Quaternion, Vector, from_world, to_world
from extractors.devices.lines import BAUDS, BITS, SerialLine
from extractors.devices.simulator import Faults, MotionSource, Sent, SerialSimulator, SimulatedLine
from extractors.devices.tracker import (
    Address,
    CycleCounter,
    Description,
    DeviceLostError,
    Frame,
    FrameCollector,
    LiveTracker,
    SensorReading,
)

END = b"\r\n"
STATIONS = 4
FIELD = 7  # Characters of a number in an ASCII record.
MOST_ERRORS = 0x7F
NORM_TOLERANCE = 0.05
CM_M = 0.01

ITEMS = {"pos": (2,), "pos_ang": (2, 4), "pos_quat": (2, 11)}
"""Items of the output list by format: 2 position, 4 azimuth elevation roll, 11 quaternion."""

VALUES = {2: 3, 4: 3, 11: 4}  # Numbers of an item.


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


RECORDS_HZ = 120.0  # Records a second of all stations together.
SETTLE_S = 0.2  # How long the line is left to end what was being sent [s].
SILENCE_S = 2.0
ANSWER_S = 1.0  # How long the answer to a poll may pause [s].


@dataclass(frozen=True)
class FastrakSettings:
    """Stations, format and line."""

    port: str
    names: tuple[str, ...]
    form: str
    binary: bool
    baud: int
    stream: bool

    @property
    def rate_hz(self) -> float:
        """Frames a second: the stations share the device's rate."""
        return RECORDS_HZ / len(self.names)


def fastrak_settings(address: Address) -> FastrakSettings:
    """The settings that an address holds.

    Raises:
        CaparError: An option is unknown or out of bounds, or the line is too slow.
    """
    stations = address.integer("stations", 1, low=1, high=STATIONS)
    settings = FastrakSettings(
        port=address.place,
        names=address.names(f"station{index + 1}" for index in range(stations)),
        form=address.choice("format", ITEMS, "pos_quat"),
        binary=address.choice("encoding", ("binary", "ascii"), "binary") == "binary",
        baud=int(address.choice("baud", map(str, BAUDS), "115200")),
        stream=address.choice("mode", ("stream", "point"), "stream") == "stream",
    )
    address.close()
    size = record_size(settings.form, binary=settings.binary)
    if RECORDS_HZ * size > settings.baud / BITS and settings.stream:
        raise address.error(
            f"{RECORDS_HZ:g} records of {size} bytes are {RECORDS_HZ * size:.0f} bytes a second; "
            f"{settings.baud} baud carry {settings.baud / BITS:.0f}. Raise the baud rate, choose "
            "encoding=binary, or poll with mode=point."
        )
    return settings


class FastrakTracker(LiveTracker):
    """A Fastrak.

    Args:
        address: Like ``fastrak:/dev/ttyUSB0?stations=4&encoding=binary``.

    Raises:
        CaparError: The address holds what no Fastrak can be set to.
    """

    def __init__(self, address: Address) -> None:
        super().__init__()
        self._settings = fastrak_settings(address)
        self._line = SerialLine(self._settings.port, self._settings.baud)
        self._start()

    def _start(self) -> None:
        settings = self._settings
        self._parser = RecordParser(
            settings.form, binary=settings.binary, byte_s=BITS / settings.baud
        )
        self._frames = FrameCollector(len(settings.names), self.counts, counted=settings.stream)
        self._cycles = CycleCounter(len(settings.names))
        self._cycle = -1
        self._next_poll_s = time.monotonic()

    def describe(self) -> Description:
        """The stations, and how they were configured to send."""
        settings = self._settings
        return Description(
            kind="fastrak",
            model="Fastrak",
            sensors=settings.names,
            rate_hz=settings.rate_hz,
            has_orientations=settings.form != "pos",
            details={"encoding": "binary" if settings.binary else "ascii"},
        )

    def _connect(self) -> None:
        self._line.open()
        self._line.write(b"c")
        time.sleep(SETTLE_S)
        items = ",".join(str(each) for each in (*ITEMS[self._settings.form], 1))
        for station in range(1, len(self._settings.names) + 1):
            self._line.write(f"O{station},{items}\r".encode())
        self._line.write(b"u" + (b"f" if self._settings.binary else b"F"))
        time.sleep(SETTLE_S)
        self._line.drop_input()
        self._start()
        if self._settings.stream:
            self._line.write(b"C")

    def _disconnect(self) -> None:
        self._take_counts()
        self._line.close()

    def _stop(self) -> None:
        try:
            self._line.write(b"c")
        except DeviceLostError:
            return

    def _take_counts(self) -> None:
        self.counts.dropped_bytes += self._parser.dropped_bytes
        self._parser.dropped_bytes = 0

    def _read(self, timeout_s: float) -> list[Frame]:
        since_s, before = time.monotonic(), self.counts.records
        out = self._streamed(timeout_s) if self._settings.stream else self._polled(timeout_s)
        self._take_counts()
        self._listened(since_s, SILENCE_S, heard=self.counts.records > before)
        return out

    def _streamed(self, timeout_s: float) -> list[Frame]:
        data = self._line.read(timeout_s)
        return [
            frame
            for record in self._parser.feed(data, time.monotonic())
            for frame in self._add(record)
        ]

    def _polled(self, timeout_s: float) -> list[Frame]:
        """One set of records, if its time comes before the wait is over."""
        time.sleep(max(0.0, min(timeout_s, self._next_poll_s - time.monotonic())))
        now = time.monotonic()
        if now < self._next_poll_s:
            return []
        period_s = 1.0 / self._settings.rate_hz
        self._next_poll_s = max(self._next_poll_s + period_s, now - period_s)
        self._parser.clear()
        self._cycle += 1
        self._line.write(b"P")
        out: list[Frame] = []
        count = 0
        while count < len(self._settings.names) and (data := self._line.read(ANSWER_S)):
            for record in self._parser.feed(data, time.monotonic()):
                count += 1
                out += self._add(record)
        return [*out, *self._frames.flush()]

    def _add(self, record: StationRecord) -> list[Frame]:
        """The frames that a record completes: stations come in order, so a lower one is next."""
        index = record.station - 1
        if index >= len(self._settings.names):
            self.counts.refused_records += 1
            return []
        if self._settings.stream:
            self._cycle = self._cycles.cycle_of(index, missed=record.missed)
        pose = pose_of_record(record, self._settings.form)
        return self._frames.add(self._cycle, SensorReading(index, record.stamp_s, *pose))


def pose_of_record(record: StationRecord, form: str) -> tuple[Vector, Quaternion]:
    """Position [m] and orientation (w x y z), z up; NaN where the format has none."""
    position = np.array(record.values[:3]) * CM_M
    turned = np.full(4, np.nan)
    if form == "pos_quat":
        quaternion = np.array(record.values[3:])
        turned = quaternion / np.linalg.norm(quaternion)
    elif form == "pos_ang":
        angles = Rotation.from_euler("ZYX", record.values[3:], degrees=True)
        turned = angles.as_quat(scalar_first=True)
    return to_world(position, turned)


FORMS = {items: form for form, items in ITEMS.items()}
INCH_CM = 2.54


class FastrakSimulator(SerialSimulator):
    """A Fastrak with one station a sensor of the motion, at most four.

    Args:
        motion: What is measured.
        baud: Speed of the line.
        faults: What goes wrong on it.
        log: Where every record is kept, if anywhere.
    """

    def __init__(
        self,
        motion: MotionSource,
        baud: int = 115200,
        faults: Faults | None = None,
        log: list[Sent] | None = None,
    ) -> None:
        stations = min(STATIONS, len(motion.sensors))
        self._faults = faults or Faults()
        super().__init__(motion, RECORDS_HZ / stations, [SimulatedLine(baud, self._faults)], log)
        self._stations = range(1, stations + 1)
        self._power_up()

    def _power_up(self) -> None:
        self._forms = dict.fromkeys(self._stations, "pos_ang")
        self._binary = self._streaming = False
        self._unit_cm = INCH_CM

    def _listen(self, line: SimulatedLine) -> None:
        """Obey every command that is whole: one letter, or a letter and a list up to the return."""
        line.receive()
        while line.commands:
            code = chr(line.commands[0])
            size = line.commands.find(b"\r") + 1 if code == "O" else 1
            if size == 0:
                return
            command = bytes(line.commands[:size])
            del line.commands[:size]
            self._obey(line, code, command)

    def _obey(self, line: SimulatedLine, code: str, command: bytes) -> None:
        if code == "P":
            line.poll_at_s = time.monotonic() + self._faults.reply_delay_s
        elif code in "Cc":
            self._streaming = code == "C"
            if not self._streaming:
                line.forget()
        elif code in "Ff":
            self._binary = code == "f"
        elif code in "Uu":
            self._unit_cm = 1.0 if code == "u" else INCH_CM
        elif code == "O":
            self._choose(command)

    def _choose(self, command: bytes) -> None:
        """An output list: a station, and items of which the last one ends the record."""
        try:
            station, *items = (int(each) for each in command[1:-1].split(b","))
        except ValueError:
            return
        form = FORMS.get(tuple(each for each in items if each > 1))
        if station in self._forms and form is not None and items[-1] == 1:
            self._forms[station] = form

    def _measure(self, at_s: float) -> None:
        if self._streaming:
            self._stream(self._lines[0], at_s, 1.0 / self._rate_hz)

    def _report(self, line: SimulatedLine, at_s: float) -> None:
        """The records of all stations at a time."""
        positions, orientations = self._poses(at_s)
        for station in self._stations:
            form = self._forms[station]
            position, turned = from_world(positions[station - 1], orientations[station - 1])
            values = list(position / CM_M / self._unit_cm)
            if form == "pos_quat":
                values += list(turned)
            elif form == "pos_ang":
                turn = Rotation.from_quat(turned, scalar_first=True)
                values += list(turn.as_euler("ZYX", degrees=True))
            record = StationRecord(station, " ", tuple(values))
            data = encode_record(record, form, binary=self._binary)
            self._sent(station, data, intact=line.send(data, at_s))
