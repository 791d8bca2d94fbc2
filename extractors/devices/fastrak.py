"""Polhemus Fastrak over RS-232: up to four stations, ASCII or binary.

The transmitter's frame is taken as x forward, y to the right, z down; quaternions are w x y z,
sensor to transmitter, as they come.
"""

import time
from dataclasses import dataclass

import numpy as np
from scipy.spatial.transform import Rotation

from extractors.devices import fastrak_records as records
from extractors.devices.addresses import Address
from extractors.devices.bird_formats import Quaternion, Vector, to_world
from extractors.devices.fastrak_records import RecordParser, StationRecord
from extractors.devices.flock_commands import BITS
from extractors.devices.frames import CycleCounter, FrameCollector, SensorReading
from extractors.devices.serial_line import SerialLine
from extractors.devices.tracker import Description, DeviceLostError, Frame, LiveTracker

RECORDS_HZ = 120.0
"""Records a second of all stations together."""

BAUDS = (2400, 4800, 9600, 19200, 38400, 57600, 115200)
SETTLE_S = 0.2
"""How long the line is left to end what was being sent [s]."""

SILENCE_S = 2.0
ANSWER_S = 1.0
"""How long the answer to a poll may pause [s]."""


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
    stations = address.integer("stations", 1, low=1, high=records.STATIONS)
    settings = FastrakSettings(
        port=address.place,
        names=address.names(f"station{index + 1}" for index in range(stations)),
        form=address.choice("format", records.ITEMS, "pos_quat"),
        binary=address.choice("encoding", ("binary", "ascii"), "binary") == "binary",
        baud=int(address.choice("baud", map(str, BAUDS), "115200")),
        stream=address.choice("mode", ("stream", "point"), "stream") == "stream",
    )
    address.close()
    size = records.record_size(settings.form, binary=settings.binary)
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
        items = ",".join(str(each) for each in (*records.ITEMS[self._settings.form], 1))
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
    position = np.array(record.values[:3]) * records.CM_M
    turned = np.full(4, np.nan)
    if form == "pos_quat":
        quaternion = np.array(record.values[3:])
        turned = quaternion / np.linalg.norm(quaternion)
    elif form == "pos_ang":
        angles = Rotation.from_euler("ZYX", record.values[3:], degrees=True)
        turned = angles.as_quat(scalar_first=True)
    return to_world(position, turned)
