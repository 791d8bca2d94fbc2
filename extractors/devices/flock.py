"""Ascension Flock of Birds, or a MotionStar, over RS-232: records, commands, driver, simulator.

A command is one byte and its data, least significant byte first, without terminator or
acknowledgement; a prefix byte ``0xF0 + address`` sends it to one bird.

A record's words have two bytes of seven bits each, so their two lowest bits are lost; bit 7 is set
only on the first byte of a record. There is no checksum and no time stamp: a record counts where a
phasing bit begins it, none stands in it, its address is a known one, and the next byte, if it is
there, has the next phasing bit. Lost bytes are found so; a byte whose lower bits are garbled shows
only where a quaternion's or matrix's norm gives it away.

What no simulator can settle stays a switch: the sign of the quaternion on the wire
(``quaternion=plain``).
"""

import time
from collections.abc import Collection, Iterable
from dataclasses import dataclass

from capar.model.errors import DeviceError
from extractors.devices.bird_formats import (
    FORMATS,
    BirdFormat,
    Scaling,
    pose_of_words,
    words_of_pose,
)
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

POINT, STREAM, RUN, SLEEP, EXAMINE, CHANGE = 0x42, 0x40, 0x46, 0x47, 0x4F, 0x50
HEMISPHERE, NEXT_TRANSMITTER, FBB_RESET, PREFIX = 0x4C, 0x30, 0x2F, 0xF0
EVERY = {1: 0x51, 2: 0x52, 8: 0x53, 32: 0x54}  # Report every nth cycle: the command by n.

HEMISPHERES = {"front": b"\x00\x00", "rear": b"\x00\x01", "right": b"\x06\x00",
               "left": b"\x06\x01", "lower": b"\x0c\x00", "upper": b"\x0c\x01"}  # fmt: skip
"""The half of space in which a sensor moves, seen from the transmitter."""

STATUS, FIRMWARE, CRYSTAL, SCALING, COUNT, RATE, ERROR = 0, 1, 2, 3, 6, 7, 10
MODEL, EXPANDED_ERROR, LINE_FREQUENCY, HEMISPHERE_PARAMETER = 15, 16, 20, 22
GROUP_MODE, FLOCK_STATUS, AUTO_CONFIG = 35, 36, 50
SIZES = {STATUS: 2, FIRMWARE: 2, CRYSTAL: 2, SCALING: 2, COUNT: 2, RATE: 2, ERROR: 1, MODEL: 10,
         EXPANDED_ERROR: 2, LINE_FREQUENCY: 1, HEMISPHERE_PARAMETER: 2, GROUP_MODE: 1,
         FLOCK_STATUS: 14, AUTO_CONFIG: 1}  # fmt: skip
"""Bytes of a parameter's value."""

ACCESSIBLE, RUNNING, SENSOR, ERC = 0x80, 0x40, 0x20, 0x10  # Bits of a unit in the flock status.
RATE_UNIT = 256.0  # Parameter 7 is the measurement rate [Hz] times this.
MOST_HZ = 144.0  # Measuring cycles a second that the birds do at most.

ERRORS = {
    1: "system memory failed its test",
    2: "non-volatile memory failed its test",
    3: "the configuration in non-volatile memory is corrupt",
    4: "the transmitter's configuration is corrupt",
    5: "the sensor's configuration is corrupt",
    6: "a command it does not know or cannot do now",
    7: "a command that only the master may be given",
    8: "no birds are connected or accessible",
    9: "a bird is not initialised; auto-configure the flock first",
    10: "an error of receiving on the bus between the birds",
    11: "an overrun or framing error on its serial line; check the baud rate",
    13: "a bird on the bus does not answer",
    28: "no pulse to synchronise with a screen",
    29: "the transmitter is not active",
    30: "the extended-range transmitter is not attached",
    31: "the processor's time overflowed; lower the measurement rate",
    32: "a sensor is saturated; it is too near the transmitter",
    34: "its watchdog reset it",
    35: "it is too hot",
}
"""What error codes mean."""

FATAL = frozenset({1, 2, 15, 16, *range(20, 28)})  # Errors after which a bird does not go on.
PHASE = 0x80
KEPT = 0xFFFC  # Bits of a word that the wire carries.
SLACK_S = 0.004
"""What a record may take longer than its bytes do, and count without a byte after it [s]."""

SETTLE_S = 0.75
"""How long the line is left idle around auto-configuration: 0.6 s, and what delays it [s]."""

REPLY_S = 0.3  # How long a reply to a question may take beyond its bytes [s].
ATTEMPTS = 6  # How often a question is put, on a line that may lose bytes.
POLL_REPLY_S = 1.0  # How long the answer to a poll may take to begin [s].
POLL_IDLE_S = 0.1  # A poll's answer that stops for so long has ended [s].
AFTER_RESET_S = 2.0  # How long units take to restart [s].
CONFIGURATIONS = 3  # How often auto-configuration is tried.
SILENCE_S = 1.5  # A flock that sends nothing for so long is lost [s].
IDLE_S = 0.006  # A line without a byte for so long has sent its record [s].
AHEAD = 50  # How many cycles birds with lines of their own may be apart.


def error_text(code: int, unit: int = 0) -> str:
    """What an error code says, and of which unit where that is known."""
    kind = "fatal error" if code in FATAL else "error"
    meaning = ERRORS.get(code, "of a meaning that is not documented here")
    return f"{kind} {code}: {meaning}" + (f" (unit {unit})" if unit else "")


def change(parameter: int, value: int) -> bytes:
    """The command that sets a parameter."""
    return bytes([CHANGE, parameter]) + value.to_bytes(SIZES[parameter], "little")


@dataclass(frozen=True, slots=True)
class Record:
    """One bird's words."""

    address: int
    """Address in the flock; 0 where records carry none."""

    words: tuple[int, ...]
    stamp_s: float
    """When its first byte arrived [s]."""

    missed: int
    """How many records the bytes were of that were dropped since the record before."""


def encode_word(word: int) -> tuple[int, int]:
    """The two bytes of a signed word, without a phasing bit."""
    return word >> 2 & 0x7F, word >> 9 & 0x7F


def decode_word(low: int, high: int) -> int:
    """The signed word of two bytes."""
    value = (high & 0x7F) << 9 | (low & 0x7F) << 2
    return value - 0x10000 if value & 0x8000 else value


def encode_record(words: Iterable[int], *, address: int | None = None) -> bytes:
    """The bytes of a record; with an address in group mode."""
    out = bytearray(byte for word in words for byte in encode_word(word))
    out[0] |= PHASE
    return bytes(out) + (b"" if address is None else bytes([address & 0x7F]))


def record_size(form: BirdFormat, *, group: bool) -> int:
    """Bytes of a record."""
    return 2 * form.words + group


def line_limit_hz(form: BirdFormat, birds: int, baud: int, *, group: bool) -> float:
    """Cycles a second of all birds on one line that its speed carries [Hz]."""
    return baud / BITS / (birds * record_size(form, group=group))


class RecordParser:
    """Finds the records in a stream of bytes that may have lost some.

    Args:
        form: The format that the birds were told to send.
        addresses: The birds in the group; None where each bird has a line of its own.
        byte_s: Time of a byte on the line, for time stamps [s].
    """

    def __init__(
        self, form: BirdFormat, *, addresses: Collection[int] | None = None, byte_s: float = 0.0
    ) -> None:
        self.dropped_bytes = 0
        self.wrong_addresses = 0
        self._words = form.words
        self._addresses = addresses
        self._size = record_size(form, group=addresses is not None)
        self._byte_s = byte_s
        self._buffer = bytearray()
        self._stamp_s = 0.0
        self._fed_s = 0.0
        self._dropped = self._refused = 0

    @property
    def pending(self) -> bool:
        """Whether a whole record waits for the byte after it."""
        return len(self._buffer) == self._size

    @property
    def pending_address(self) -> int | None:
        """Address of the record that waits for the byte after it; 0 where there are none."""
        if not self.pending:
            return None
        return self._buffer[-1] if self._addresses is not None else 0

    def feed(self, data: bytes, at_s: float = 0.0) -> list[Record]:
        """The records that some bytes complete, the last of which arrived at a moment [s]."""
        held = len(self._buffer)
        self._buffer += data
        self._fed_s = at_s
        total, at, out = len(self._buffer), 0, []
        while at < total:
            if (self._buffer[at] & PHASE) == 0:
                at = self._skip(at, 1)
                continue
            if at or not held:
                self._stamp_s = at_s - (total - 1 - at) * self._byte_s
            inside = self._phase_within(at)
            if inside:
                at = self._skip(at, inside)
            elif total - at <= self._size:
                break
            elif self._buffer[at + self._size] & PHASE:
                out += self._accept(at)
                at += self._size
            else:
                at = self._skip(at, 1)
        del self._buffer[:at]
        return out

    def settle(self, *, answered: bool = False) -> list[Record]:
        """The last record, if it is whole and came in one go, and the line is idle after it.

        Args:
            answered: Whether it ends the answer to a poll, so that nothing can follow it.
        """
        longest_s = 2.0 * self._size * self._byte_s + SLACK_S
        late = self._byte_s > 0.0 and self._fed_s - self._stamp_s > longest_s
        if not self.pending or (late and not answered):
            return []
        out = self._accept(0)
        self._buffer.clear()
        return out

    def clear(self) -> None:
        """Forget what was begun."""
        self._buffer.clear()

    def _phase_within(self, at: int) -> int:
        """How far on the next phasing bit stands where none may; 0 where there is none."""
        end = min(at + self._size, len(self._buffer))
        for index in range(at + 1, end):
            if self._buffer[index] & PHASE:
                return index - at
        return 0

    def _skip(self, at: int, count: int) -> int:
        self.dropped_bytes += count
        self._dropped += count
        return at + count

    def _accept(self, at: int) -> list[Record]:
        data = self._buffer[at : at + self._size]
        address = data[-1] if self._addresses is not None else 0
        if self._addresses is not None and address not in self._addresses:
            self.wrong_addresses += 1
            self._refused += 1
            return []
        words = tuple(decode_word(data[2 * i], data[2 * i + 1]) for i in range(self._words))
        missed = -(-self._dropped // self._size) + self._refused
        self._dropped = self._refused = 0
        record = Record(address, words, self._stamp_s, missed)
        return [record]


@dataclass(frozen=True)
class FlockSettings:
    """Units, format, rate and lines of a flock.

    The place is a port, or several divided by commas: then each bird has its own, the first
    one's bird is the master, and records carry no address.
    """

    ports: tuple[str, ...]
    names: tuple[str, ...]
    form: BirdFormat
    rate_hz: float
    """Frames a second."""

    every: int
    """Every how many measuring cycles a frame is sent."""

    baud: int
    stream: bool
    """Whether the flock sends of its own accord, or is polled."""

    erc: bool
    """Whether unit 1 is an extended-range controller, and the birds begin at 2."""

    scaling: Scaling
    hemisphere: str
    line_frequency_hz: int
    """Of the power supply; 0 leaves it as it is set."""

    reset: bool
    settle_s: float

    @property
    def addresses(self) -> tuple[int, ...]:
        """The birds' addresses, in the order of the sensors."""
        first = 2 if self.erc else 1
        return tuple(range(first, first + len(self.names)))

    @property
    def units(self) -> int:
        """Units on the bus between the birds."""
        return len(self.names) + self.erc

    @property
    def group(self) -> bool:
        """Whether one line carries the records of several units, with their addresses."""
        return len(self.ports) == 1 and self.units > 1


def flock_settings(address: Address) -> FlockSettings:
    """The settings that an address holds.

    Raises:
        CaparError: An option is unknown or out of bounds, or a line cannot carry the rate.
    """
    ports = tuple(address.place.split(","))
    birds = address.integer("birds", len(ports), low=1, high=13)
    erc = address.flag("erc")
    if len(ports) > 1 and birds != len(ports):
        raise address.error(f"{len(ports)} ports for {birds} birds; give one port a bird, or one")
    if len(ports) > 1 and erc:
        raise address.error("with a port for each bird the master is the first one's; erc=no")
    first = 2 if erc else 1
    ranges = ("144",) if erc else ("36", "72")
    inches = float(address.choice("range", ranges, ranges[0]))
    conjugated = address.choice("quaternion", ("conjugated", "plain"), "conjugated")
    rate_hz = address.number("rate", 30.0, low=0.1, high=MOST_HZ)
    settings = FlockSettings(
        ports=ports,
        names=address.names(f"bird{first + index}" for index in range(birds)),
        form=FORMATS[address.choice("format", FORMATS, "pos_quat")],
        rate_hz=rate_hz,
        every=_every(address, rate_hz),
        baud=int(address.choice("baud", map(str, BAUDS), "115200")),
        stream=address.choice("mode", ("stream", "point"), "stream") == "stream",
        erc=erc,
        scaling=Scaling(inches, conjugated == "conjugated"),
        hemisphere=address.choice("hemisphere", HEMISPHERES, "front"),
        line_frequency_hz=int(address.choice("power", ("0", "50", "60"), "0")),
        reset=address.flag("reset"),
        settle_s=address.number("settle", SETTLE_S, low=0.0, high=10.0),
    )
    address.close()
    on_line = birds if len(ports) == 1 else 1
    limit_hz = line_limit_hz(settings.form, on_line, settings.baud, group=settings.group)
    if rate_hz > limit_hz:
        size = record_size(settings.form, group=settings.group)
        raise address.error(
            f"rate={rate_hz:g} does not pass the line: {on_line} x {size} bytes a frame are "
            f"{on_line * size * rate_hz:.0f} bytes a second, {settings.baud} baud carry "
            f"{settings.baud / BITS:.0f}, so at most {limit_hz:.4g} Hz. Lower the rate, choose a "
            "shorter format, give each bird a port of its own, or use a MotionStar's Ethernet."
        )
    return settings


def _every(address: Address, rate_hz: float) -> int:
    """As few reports a measurement as give the fastest measuring, unless the address says."""
    usual = max(each for each in EVERY if each * rate_hz <= MOST_HZ)
    every = int(address.choice("every", map(str, EVERY), str(usual)))
    if every * rate_hz > MOST_HZ:
        raise address.error(
            f"rate={rate_hz:g} every {every} cycles is {every * rate_hz:g} measurements a second; "
            f"the birds do {MOST_HZ:g}"
        )
    return every


class FlockPort:
    """One line, the parser of what comes from it, and questions to the unit at its end."""

    def __init__(self, path: str, index: int, settings: FlockSettings) -> None:
        self.index = index
        self.path = path
        self.line = SerialLine(path, settings.baud)
        self._settings = settings
        self._byte_s = BITS / settings.baud
        self._expected = len(settings.names) if settings.group else 1
        self._last = settings.addresses[-1] if settings.group else 0
        self._late = False
        self.cycles = CycleCounter(self._expected)
        self.parser = RecordParser(
            settings.form,
            addresses=settings.addresses if settings.group else None,
            byte_s=self._byte_s,
        )

    def open(self) -> None:
        """Open the line, and have the unit quiet."""
        self.line.open()
        if self._settings.reset and self.line.reset_device():
            time.sleep(AFTER_RESET_S)
        self.quieten()

    def quieten(self) -> None:
        """End whatever the unit is sending."""
        self.line.write(bytes([POINT]))
        time.sleep(self._settings.settle_s / 3.0)
        self.line.drop_input()

    def ask(self, parameter: int) -> bytes:
        """The value of a parameter.

        Raises:
            DeviceError: No answer comes.
        """
        size = SIZES[parameter]
        for _ in range(ATTEMPTS):
            self.line.drop_input()
            self.line.write(bytes([EXAMINE, parameter]))
            value = self.line.read_exactly(size, REPLY_S + size * self._byte_s)
            if len(value) == size:
                return value
        raise DeviceError(
            f"{self.path}: no answer to examine parameter {parameter}; check the power, the fly "
            "switch, the cable and the baud rate (DIP switches)"
        )

    def auto_configure(self) -> None:
        """Have the master find the other units; the line stays idle before and after."""
        time.sleep(self._settings.settle_s)
        self.line.write(change(AUTO_CONFIG, self._settings.units))
        time.sleep(self._settings.settle_s)
        self.line.drop_input()

    def check(self) -> None:
        """Check that all units run and none has an error.

        Raises:
            DeviceError: One is missing, or reports an error.
        """
        code = self.ask(ERROR)[0]
        if code:
            raise DeviceError(f"{self.path}: {error_text(code, self.ask(EXPANDED_ERROR)[0])}")
        units = self._settings.units
        status = self.ask(FLOCK_STATUS) if units > 1 else b""
        for address in self._settings.addresses if units > 1 else ():
            bits = status[address - 1]
            if not bits & ACCESSIBLE or not bits & RUNNING:
                found = sum(bool(each & ACCESSIBLE) for each in status)
                raise DeviceError(
                    f"{self.path}: unit {address} of {units} does not run; {found} are there. "
                    "Check its fly switch and address, and birds= and erc= of the address"
                )

    def records(self, timeout_s: float) -> list[Record]:
        """The records that come within a wait, or that the idle line shows to be whole."""
        data = self.line.read(timeout_s)
        return self.parser.feed(data, time.monotonic()) if data else self.parser.settle()

    def poll(self) -> None:
        """Ask for one cycle; what came too late for the last one is forgotten."""
        if self._late:
            self.line.drop_input()
        self.parser.clear()
        self.line.write(bytes([POINT]))

    def answer(self) -> list[Record]:
        """The records that answer a poll, until the last one is there or the line is silent."""
        out: list[Record] = []
        while not out or out[-1].address != self._last:
            if self.parser.pending_address == self._last:
                new = self.parser.settle(answered=True)
            else:
                data = self.line.read(POLL_IDLE_S if out else POLL_REPLY_S)
                if not data:
                    break
                new = self.parser.feed(data, time.monotonic())
            for record in new:
                if out and record.address <= out[-1].address:
                    out.clear()  # the end of an answer that came too late
                out.append(record)
        self._late = len(out) < self._expected
        return out


class FlockTracker(LiveTracker):
    """A flock on one line, or on one line a bird.

    Args:
        address: Like ``flock:/dev/ttyUSB0?birds=12&format=pos_quat&rate=51.65``.

    Raises:
        CaparError: The address holds what no flock can be set to.
    """

    def __init__(self, address: Address) -> None:
        super().__init__()
        self._settings = flock_settings(address)
        self._details: dict[str, str] = {}
        self._ports: list[FlockPort] = []
        self._frames = FrameCollector(len(self._settings.names), self.counts)
        self._start_s = self._next_poll_s = 0.0
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
        self._ports = [FlockPort(path, n, settings) for n, path in enumerate(settings.ports)]
        for port in self._ports:
            port.open()
        firmware = self._ports[0].ask(FIRMWARE)
        model = self._ports[0].ask(MODEL).decode("ascii", "replace").strip()
        self._details = {"model": model, "firmware": f"{firmware[0]}.{firmware[1]}"}
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
                port.line.write(bytes([EVERY[settings.every], STREAM]))

    def _configure(self) -> None:
        """Set up every unit, and have the master find the others, again if some did not hear it."""
        settings, master = self._settings, self._ports[0]
        hemisphere = bytes([HEMISPHERE]) + HEMISPHERES[settings.hemisphere]
        for index, address in enumerate(settings.addresses):
            line = self._ports[index % len(self._ports)].line
            for command in (bytes([settings.form.command]), hemisphere):
                line.write(bytes([PREFIX + address] * settings.group) + command)
        if not settings.erc:
            for port in self._ports:
                port.line.write(change(SCALING, int(settings.scaling.range_inch > 36.0)))
        measured_hz = settings.rate_hz * settings.every
        master.line.write(change(RATE, round(measured_hz * RATE_UNIT)))
        if settings.line_frequency_hz:
            master.line.write(change(LINE_FREQUENCY, settings.line_frequency_hz))
        for attempt in range(1, CONFIGURATIONS + 1):
            if settings.units > 1:
                master.auto_configure()
            if settings.group:
                master.line.write(change(GROUP_MODE, 1))
            try:
                master.check()
            except DeviceLostError:
                raise
            except DeviceError:
                if attempt == CONFIGURATIONS or settings.units == 1:
                    raise
            else:
                return

    def _disconnect(self) -> None:
        self._take_counts()
        for port in self._ports:
            port.line.close()

    def _stop(self) -> None:
        for port in self._ports:
            try:
                port.quieten()
                port.line.write(bytes([SLEEP]))
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
        """Number a line's first cycle; of several records the last one has just arrived.

        What lies before the first record of all is not missing.
        """
        first = records[0]
        place = self._settings.addresses.index(first.address) if self._settings.group else 0
        cycle = 0
        if len(self._ports) > 1:
            since_s = records[-1].stamp_s - self._start_s
            cycle = max(0, round(since_s * self._settings.rate_hz) - len(records) + 1)
        port.cycles.start(cycle, place - 1)
        if self._cycle < 0:
            self._cycle = cycle
            self._frames.start_after(cycle - 1)

    def _polled(self, timeout_s: float) -> list[Frame]:
        """One cycle of polls, if its time comes before the wait is over."""
        time.sleep(max(0.0, min(timeout_s, self._next_poll_s - time.monotonic())))
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
        cycle = self._cycle
        if settings.stream:
            cycle = port.cycles.cycle_of(index if settings.group else 0, missed=record.missed)
        pose = pose_of_words(record.words, settings.form, settings.scaling)
        if pose is None:
            self.counts.refused_records += 1
            return []
        return self._frames.add(cycle, SensorReading(index, record.stamp_s, *pose))


MEASURED_HZ = 103.3  # Measuring cycles a second of a simulated flock until it is told otherwise.
WRONG_ADDRESS = 0x7F  # Address of no bird.
BY_COMMAND = {each.command: each for each in FORMATS.values()}
EVERY_BY_COMMAND = {command: every for every, command in EVERY.items()}
DATA_SIZES = {HEMISPHERE: 2, NEXT_TRANSMITTER: 1, EXAMINE: 1}


@dataclass(frozen=True)
class FlockRig:
    """What a simulated flock consists of."""

    erc: bool = False
    """Whether unit 1 is an extended-range controller without a sensor."""

    line_a_bird: bool = False
    baud: int = 115200
    quiet_s: float = 0.6
    """How long lines must be idle before and after auto-configuration [s]."""

    conjugated: bool = True
    error: int = 0
    """Error code that it reports."""

    missing: tuple[int, ...] = ()
    """Addresses of units that do not answer on the bus."""


class _BirdLine(SimulatedLine):
    """One line, the unit at its end, and whether it streams."""

    def __init__(self, unit: int, baud: int, faults: Faults) -> None:
        super().__init__(baud, faults)
        self.unit = unit
        self.streaming = False
        self.every = 1
        self.target = 0


class FlockSimulator(SerialSimulator):
    """A flock whose birds measure a motion, one sensor a bird.

    What it does where the protocol's description is silent: a cycle for which the line has no
    room left is skipped, whole, and counted in ``skipped``.

    Args:
        motion: What is measured.
        rig: What the flock consists of.
        faults: What goes wrong on the lines.
        log: Where every record that is sent is kept, if anywhere.
    """

    def __init__(
        self,
        motion: MotionSource,
        rig: FlockRig | None = None,
        faults: Faults | None = None,
        log: list[Sent] | None = None,
    ) -> None:
        self.rig = rig or FlockRig()
        self.faults = faults or Faults()
        first = 2 if self.rig.erc else 1
        self._addresses = tuple(range(first, first + len(motion.sensors)))
        self._units = len(motion.sensors) + self.rig.erc
        ends = self._addresses if self.rig.line_a_bird else (1,)
        self._desks = [_BirdLine(unit, self.rig.baud, self.faults) for unit in ends]
        super().__init__(motion, MEASURED_HZ, [*self._desks], log)
        self._power_up()

    def _power_up(self) -> None:
        for desk in self._desks:
            desk.streaming = False
        self._forms = dict.fromkeys(range(1, self._units + 1), FORMATS["pos_ang"])
        self._hemispheres = dict.fromkeys(self._forms, HEMISPHERES["front"])
        self._rate_hz = MEASURED_HZ
        self._scaling = 0
        self._group = False
        self._configured = self._units == 1
        self._error, self._error_unit = self.rig.error, 0
        self._heard_s = self._configured_s = -1e9

    def _measure(self, at_s: float) -> None:
        """One measuring cycle: every line that streams sends it, if its turn has come."""
        for desk in self._desks:
            if desk.streaming and self._cycle % desk.every == 0:
                self._stream(desk, at_s, desk.every / self._rate_hz)

    @property
    def _range_inch(self) -> float:
        return 144.0 if self.rig.erc else 72.0 if self._scaling else 36.0

    def _report(self, line: SimulatedLine, at_s: float) -> None:
        """The records of the birds of a line, at a time."""
        assert isinstance(line, _BirdLine)
        if not self._configured or time.monotonic() - self._configured_s < self.rig.quiet_s:
            self._error, self._error_unit = 9, line.unit
            return
        positions, orientations = self._poses(at_s)
        scaling = Scaling(self._range_inch, self.rig.conjugated)
        for address in self._addresses if self._group else (line.unit,):
            if address not in self._addresses:
                continue
            index = self._addresses.index(address)
            pose = positions[index], orientations[index]
            words = words_of_pose(*pose, self._forms[address], scaling)
            data = out = encode_record(words, address=address if self._group else None)
            share = self.faults.wrong_address_share
            wrong = self._group and bool(share) and line.random.random() < share
            if wrong:
                out = encode_record(words, address=WRONG_ADDRESS)
            intact = line.send(out, at_s) and not wrong
            self._sent(address, data, intact=intact)

    def _listen(self, line: SimulatedLine) -> None:
        assert isinstance(line, _BirdLine)
        data, now = line.receive(), time.monotonic()
        if data and self._configured_s > 0.0 and now - self._configured_s < self.rig.quiet_s:
            self._configured, self._error, self._error_unit = False, 13, self._units
        while (size := _command_size(line.commands)) and len(line.commands) >= size:
            command = bytes(line.commands[:size])
            del line.commands[:size]
            self._obey(line, command, now)
            self._heard_s = now

    def _obey(self, desk: _BirdLine, command: bytes, now: float) -> None:
        code, target = command[0], desk.target or desk.unit
        desk.target = 0
        if PREFIX < code < PREFIX + 15:
            desk.target = code - PREFIX
        elif code == POINT and desk.streaming:  # a stream ends instead
            desk.streaming = False
            desk.forget()
        elif code == POINT:
            desk.poll_at_s = now + self.faults.reply_delay_s
        elif code == STREAM:
            desk.streaming = True
        elif code in EVERY_BY_COMMAND:
            desk.every = EVERY_BY_COMMAND[code]
        elif code in BY_COMMAND and target in self._forms:
            self._forms[target] = BY_COMMAND[code]
        elif code == HEMISPHERE and target in self._forms:
            self._hemispheres[target] = command[1:]
        elif code == EXAMINE:
            self._examine(desk, command[1])
        elif code == CHANGE and command[1] in SIZES:
            self._change(command[1], int.from_bytes(command[2:], "little"), now)
        elif code == SLEEP:
            desk.streaming = False
        elif code not in (RUN, FBB_RESET, NEXT_TRANSMITTER):
            self._error, self._error_unit = 6, target

    def _change(self, parameter: int, value: int, now: float) -> None:
        if parameter == RATE and value:
            self._rate_hz = value / RATE_UNIT
        elif parameter == GROUP_MODE:
            self._group = bool(value)
        elif parameter == SCALING:
            self._scaling = value
        elif parameter == AUTO_CONFIG:
            self._auto_configure(value, now)

    def _auto_configure(self, units: int, now: float) -> None:
        """Find the other units, if the line was idle before and all that were named are there."""
        absent = [each for each in range(1, units + 1) if not self._is_there(each)]
        self._configured_s = now
        idle = now - self._heard_s >= self.rig.quiet_s
        self._configured = idle and units - len(absent) == self._units
        if absent:
            self._error, self._error_unit = 13, absent[0]
        elif not self._configured:
            self._error, self._error_unit = 9, 1
        else:
            self._error, self._error_unit = self.rig.error, 0

    def _is_there(self, unit: int) -> bool:
        return unit <= self._units and unit not in self.rig.missing

    def _examine(self, desk: _BirdLine, parameter: int) -> None:
        """Answer with a parameter's value: master, initialised, error, running, streaming ..."""
        bits = (desk.unit == 1) << 15 | self._configured << 14 | bool(self._error) << 13
        bits |= self._configured << 12 | desk.streaming
        values = {
            STATUS: bits.to_bytes(2, "little"),
            FIRMWARE: b"\x03\x2f",
            CRYSTAL: (25).to_bytes(2, "little"),
            SCALING: int(self._range_inch > 36.0).to_bytes(2, "little"),
            RATE: round(self._rate_hz * RATE_UNIT).to_bytes(2, "little"),
            ERROR: bytes([self._error]),
            MODEL: b"6DERC     " if self.rig.erc else b"6DFOB     ",
            EXPANDED_ERROR: bytes([self._error_unit, 0]),
            LINE_FREQUENCY: b"\x3c",
            HEMISPHERE_PARAMETER: self._hemispheres[desk.unit],
            GROUP_MODE: bytes([self._group]),
            FLOCK_STATUS: bytes(map(self._unit_bits, range(1, 15))),
        }
        if parameter == ERROR:
            self._error = 0
        value = values.get(parameter, bytes(SIZES.get(parameter, 2)))
        desk.send(value, time.monotonic())

    def _unit_bits(self, unit: int) -> int:
        if not self._is_there(unit) or (unit > 1 and not self._configured):
            return 0
        kind = SENSOR if unit in self._addresses else ERC | 0x01
        return ACCESSIBLE | (RUNNING if self._configured else 0) | kind


def _command_size(data: bytearray) -> int:
    """Bytes of the command that some bytes begin; more than there are where it is cut off."""
    if not data:
        return 0
    if data[0] == CHANGE:
        return 2 + (SIZES.get(data[1], 0) if len(data) > 1 else 1)
    return 1 + DATA_SIZES.get(data[0], 0)
