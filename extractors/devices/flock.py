"""Ascension Flock of Birds, or a MotionStar, over RS-232.

What no simulator can settle stays a switch: the sign of the quaternion on the wire
(``quaternion=plain``). A flock sends no checksums and no time stamps: a byte whose data bits are
garbled shows only where a quaternion's or matrix's norm gives it away.
"""

import time

from capar.model.errors import DeviceError
from extractors.devices import flock_commands as commands
from extractors.devices.addresses import Address
from extractors.devices.bird_formats import pose_of_words
from extractors.devices.flock_port import FlockPort
from extractors.devices.flock_records import Record
from extractors.devices.flock_settings import FlockSettings, flock_settings
from extractors.devices.frames import FrameCollector, SensorReading
from extractors.devices.tracker import (
    Description,
    DeviceLostError,
    Frame,
    LiveTracker,
)

CONFIGURATIONS = 3
"""How often auto-configuration is tried."""

SILENCE_S = 1.5
"""A flock that sends nothing for so long is lost [s]."""

IDLE_S = 0.006
"""A line without a byte for so long has sent its record [s]."""

AHEAD = 50
"""How many cycles birds with lines of their own may be apart."""


class FlockTracker(LiveTracker):
    """A flock on one line, or on one line a bird.

    Args:
        address: Like ``flock:/dev/ttyUSB0?birds=12&format=pos_quat&rate=51.65``.

    Raises:
        CaparError: The address holds what no flock can be set to.
    """

    def __init__(self, address: Address) -> None:
        super().__init__()
        self._settings: FlockSettings = flock_settings(address)
        self._details: dict[str, str] = {}
        self._ports: list[FlockPort] = []
        self._frames = FrameCollector(len(self._settings.names), self.counts)
        self._start_s = 0.0
        self._next_poll_s = 0.0
        self._cycle = -1

    def describe(self) -> Description:
        """What the flock is, and its sensors."""
        settings = self._settings
        return Description(
            kind="flock",
            model=self._details.get("model", ""),
            sensors=settings.names,
            rate_hz=settings.rate_hz,
            has_positions=settings.form.position,
            has_orientations=bool(settings.form.orientation),
            details=self._details,
        )

    def _connect(self) -> None:
        settings = self._settings
        self._ports = [
            FlockPort(each, index, settings) for index, each in enumerate(settings.ports)
        ]
        for port in self._ports:
            port.open(reset=settings.reset)
        self._details = self._ports[0].identity()
        self._configure()
        self._frames = FrameCollector(
            len(settings.names),
            self.counts,
            ahead=AHEAD if len(self._ports) > 1 else 0,
            counted=settings.stream,
        )
        self._start_s = self._next_poll_s = time.monotonic()
        self._cycle = -1
        if settings.stream:
            for port in self._ports:
                port.stream(settings.every)

    def _configure(self) -> None:
        settings, master = self._settings, self._ports[0]
        for index, address in enumerate(settings.addresses):
            port = self._ports[index % len(self._ports)]
            chosen = bytes([settings.form.command]), commands.hemisphere(settings.hemisphere)
            for command in chosen:
                port.tell(commands.addressed(address, command) if settings.group else command)
        if not settings.erc:
            scale = int(settings.scaling.range_inch > 36.0)
            for port in self._ports:
                port.tell(commands.change(commands.SCALING, scale))
        master.tell(commands.change(commands.RATE, commands.rate_word(settings.measured_hz)))
        if settings.line_frequency_hz:
            master.tell(commands.change(commands.LINE_FREQUENCY, settings.line_frequency_hz))
        if settings.units == 1:
            master.check(settings)
        else:
            self._auto_configure(master)

    def _auto_configure(self, master: FlockPort) -> None:
        """Have the master find the other units, again if some did not hear it.

        Raises:
            DeviceError: Units are missing, or report an error, each time.
        """
        for attempt in range(1, CONFIGURATIONS + 1):
            master.auto_configure(self._settings.units, self._settings.settle_s)
            if self._settings.group:
                master.tell(commands.change(commands.GROUP_MODE, 1))
            try:
                master.check(self._settings)
            except DeviceLostError:
                raise
            except DeviceError:
                if attempt == CONFIGURATIONS:
                    raise
            else:
                return

    def _disconnect(self) -> None:
        for port in self._ports:
            self.counts.dropped_bytes += port.parser.dropped_bytes
            self.counts.refused_records += port.parser.wrong_addresses
            port.parser.dropped_bytes = port.parser.wrong_addresses = 0
            port.line.close()

    def _stop(self) -> None:
        for port in self._ports:
            try:
                port.quieten()
                port.tell(bytes([commands.SLEEP]))
            except DeviceLostError:
                continue

    def _read(self, timeout_s: float) -> list[Frame]:
        since_s, before = time.monotonic(), self.counts.records
        out = self._streamed(timeout_s) if self._settings.stream else self._polled(timeout_s)
        self._take_counts()
        heard = self.counts.records > before
        self._listened(since_s, SILENCE_S + 3.0 / self._settings.rate_hz, heard=heard)
        return out

    def _take_counts(self) -> None:
        for port in self._ports:
            self.counts.dropped_bytes += port.parser.dropped_bytes
            self.counts.refused_records += port.parser.wrong_addresses
            port.parser.dropped_bytes = port.parser.wrong_addresses = 0

    def _streamed(self, timeout_s: float) -> list[Frame]:
        out: list[Frame] = []
        share_s = timeout_s / len(self._ports)
        for port in self._ports:
            waiting = port.parser.pending
            records = port.records(min(share_s, IDLE_S) if waiting else share_s)
            if records and not port.cycles.started:
                self._begin(port, records)
            for record in records:
                out += self._add(port, record)
        return out

    def _begin(self, port: FlockPort, records: list[Record]) -> None:
        """Number a line's first cycle; of several records the last one has just arrived."""
        first = records[0]
        place = self._settings.addresses.index(first.address) if self._settings.group else 0
        cycle = 0
        if len(self._ports) > 1:
            since_s = records[-1].stamp_s - self._start_s
            cycle = max(0, round(since_s * self._settings.rate_hz) - len(records) + 1)
        port.cycles.start(cycle, place - 1)
        self._frames_begin(cycle)

    def _polled(self, timeout_s: float) -> list[Frame]:
        """One cycle of polls, if its time comes before the wait is over."""
        now = time.monotonic()
        time.sleep(max(0.0, min(timeout_s, self._next_poll_s - now)))
        if time.monotonic() < self._next_poll_s:
            return []
        period_s = 1.0 / self._settings.rate_hz
        self._next_poll_s = max(self._next_poll_s + period_s, time.monotonic() - period_s)
        self._cycle += 1
        for port in self._ports:
            port.poll()
        out: list[Frame] = []
        for port in self._ports:
            for record in port.answer():
                out += self._add(port, record)
        return [*out, *self._frames.flush()]

    def _add(self, port: FlockPort, record: Record) -> list[Frame]:
        """The frames that a record completes, once its words are a pose and its cycle is known."""
        settings = self._settings
        index = settings.addresses.index(record.address) if settings.group else port.index
        place = index if settings.group else 0
        streamed = settings.stream
        cycle = port.cycles.cycle_of(place, missed=record.missed) if streamed else self._cycle
        pose = pose_of_words(record.words, settings.form, settings.scaling)
        if pose is None:
            self.counts.refused_records += 1
            return []
        return self._frames.add(cycle, SensorReading(index, record.stamp_s, *pose))

    def _frames_begin(self, cycle: int) -> None:
        """What lies before the first record of all is not missing."""
        if self._cycle < 0:
            self._cycle = cycle
            self._frames.start_after(cycle - 1)
