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
from collections.abc import Iterable
from contextlib import suppress
from dataclasses import dataclass

import numpy as np

from capar.model.errors import DeviceError
from extractors.devices.bird_formats import (
    FORMATS,
    BirdFormat,
    Scaling,
    pose_of_words,
    words_of_pose,
)
from extractors.devices.lines import BAUDS, BITS
from extractors.devices.records import SerialPort, SerialTracker, Values
from extractors.devices.simulator import Faults, MotionSource, Sent, SerialSimulator, SimulatedLine
from extractors.devices.tracker import Address, Description, DeviceLostError

POINT, STREAM, RUN, SLEEP, EXAMINE, CHANGE = 0x42, 0x40, 0x46, 0x47, 0x4F, 0x50
HEMISPHERE, PREFIX = 0x4C, 0xF0
EVERY = {1: 0x51, 2: 0x52, 8: 0x53, 32: 0x54}  # Report every nth cycle: the command by n.

HEMISPHERES = {"front": b"\x00\x00", "rear": b"\x00\x01", "right": b"\x06\x00",
               "left": b"\x06\x01", "lower": b"\x0c\x00", "upper": b"\x0c\x01"}  # fmt: skip
"""The half of space in which a sensor moves, seen from the transmitter."""

FIRMWARE, SCALING, RATE, ERROR, MODEL, EXPANDED_ERROR = 1, 3, 7, 10, 15, 16
LINE_FREQUENCY, GROUP_MODE, FLOCK_STATUS, AUTO_CONFIG = 20, 35, 36, 50
SIZES = {FIRMWARE: 2, SCALING: 2, RATE: 2, ERROR: 1, MODEL: 10, EXPANDED_ERROR: 2,
         LINE_FREQUENCY: 1, GROUP_MODE: 1, FLOCK_STATUS: 14, AUTO_CONFIG: 1}  # fmt: skip
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

SETTLE_S = 0.75
"""How long the line is left idle around auto-configuration: 0.6 s, and what delays it [s]."""

REPLY_S = 0.3  # How long a reply to a question may take beyond its bytes [s].
ATTEMPTS = 6  # How often a question is put, on a line that may lose bytes.
AFTER_RESET_S = 2.0  # How long units take to restart [s].
CONFIGURATIONS = 3  # How often auto-configuration is tried.


def error_text(code: int, unit: int = 0) -> str:
    """What an error code says, and of which unit where that is known."""
    kind = "fatal error" if code in FATAL else "error"
    meaning = ERRORS.get(code, "of a meaning that is not documented here")
    return f"{kind} {code}: {meaning}" + (f" (unit {unit})" if unit else "")


def change(parameter: int, value: int) -> bytes:
    """The command that sets a parameter."""
    return bytes([CHANGE, parameter]) + value.to_bytes(SIZES[parameter], "little")


@dataclass(frozen=True)
class FlockLayout:
    """A bird's record: its words, then its address if several birds share the line."""

    form: BirdFormat
    group: bool

    @property
    def size(self) -> int:
        """Bytes of a record."""
        return 2 * self.form.words + self.group

    def encode(self, words: Iterable[int], address: int = 0) -> bytes:
        """The bytes of a record."""
        out = bytearray(part for word in words for part in (word >> 2 & 0x7F, word >> 9 & 0x7F))
        out[0] |= PHASE
        return bytes(out) + bytes([address & 0x7F] * self.group)

    def decode(self, data: bytes, *, ended: bool = False) -> tuple[int, Values] | int | None:
        """Address (0 where records carry none) and signed words, as of ``Layout``."""
        phases = [at for at, byte in enumerate(data) if byte & PHASE]
        if not phases or phases[0]:
            return phases[0] if phases else len(data)
        if len(phases) > 1 and phases[1] < self.size:
            return phases[1]
        if len(data) <= self.size and not (ended and len(data) == self.size):
            return None
        if len(data) > self.size and len(phases) < 2:
            return 1
        pairs = np.frombuffer(data, np.uint8, 2 * self.form.words).astype(np.uint16) & 0x7F
        words = (pairs[0::2] << 2 | pairs[1::2] << 9).view(np.int16)
        return data[self.size - 1] if self.group else 0, tuple(words.tolist())

    def limit_hz(self, birds: int, baud: int) -> float:
        """Cycles a second of all birds on one line that its speed carries [Hz]."""
        return baud / BITS / (birds * self.size)


class FlockTracker(SerialTracker):
    """A flock on one line, or on one line a bird.

    The place is a port, or several divided by commas: then each bird has its own, the first
    one's bird is the master, and records carry no address.

    Args:
        address: Like ``flock:/dev/ttyUSB0?birds=12&format=pos_quat&rate=51.65``.

    Raises:
        CaparError: An option is unknown or out of bounds, or a line cannot carry the rate.
    """

    def __init__(self, address: Address) -> None:
        self._paths = paths = address.place.split(",")
        birds = address.integer("birds", len(paths), low=1, high=13)
        self._erc = erc = address.flag("erc")
        if len(paths) > 1 and birds != len(paths):
            problem = f"{len(paths)} ports for {birds} birds; give one port a bird, or one"
            raise address.error(problem)
        if len(paths) > 1 and erc:
            raise address.error("with a port for each bird the master is the first one's; erc=no")
        ranges = ("144",) if erc else ("36", "72")
        inches = float(address.choice("range", ranges, ranges[0]))
        conjugated = address.choice("quaternion", ("conjugated", "plain"), "conjugated")
        rate_hz = address.number("rate", 30.0, low=0.1, high=MOST_HZ)
        # as few reports a measurement as give the fastest measuring, unless the address says
        usual = max(each for each in EVERY if each * rate_hz <= MOST_HZ)
        self._every = every = int(address.choice("every", map(str, EVERY), str(usual)))
        if every * rate_hz > MOST_HZ:
            raise address.error(
                f"rate={rate_hz:g} every {every} cycles is {every * rate_hz:g} measurements a "
                f"second; the birds do {MOST_HZ:g}"
            )
        self._names = address.names(f"bird{1 + erc + index}" for index in range(birds))
        self._form = FORMATS[address.choice("format", FORMATS, "pos_quat")]
        self._baud = int(address.choice("baud", map(str, BAUDS), "115200"))
        self._streams = address.choice("mode", ("stream", "point"), "stream") == "stream"
        self._scaling = Scaling(inches, conjugated == "conjugated")
        self._hemisphere = HEMISPHERES[address.choice("hemisphere", HEMISPHERES, "front")]
        self._power_hz = int(address.choice("power", ("0", "50", "60"), "0"))
        self._reset = address.flag("reset")
        self._settle_s = address.number("settle", SETTLE_S, low=0.0, high=10.0)
        address.close()
        self._units = birds + erc
        self._addresses = range(1 + erc, 1 + self._units)
        self._layout = FlockLayout(self._form, len(paths) == 1 and self._units > 1)
        on_line = birds if len(paths) == 1 else 1
        limit_hz, size = self._layout.limit_hz(on_line, self._baud), self._layout.size
        if rate_hz > limit_hz:
            raise address.error(
                f"rate={rate_hz:g} does not pass the line: {on_line} x {size} bytes a frame are "
                f"{on_line * size * rate_hz:.0f} bytes a second, {self._baud} baud carry "
                f"{self._baud / BITS:.0f}, so at most {limit_hz:.4g} Hz. Lower the rate, choose a "
                "shorter format, give each bird a port, or use a MotionStar's Ethernet."
            )
        super().__init__(birds, rate_hz, b"" if self._streams else bytes([POINT]))
        self._details: dict[str, str] = {}

    def describe(self) -> Description:
        """What the flock is, and its sensors."""
        return Description(
            kind="flock",
            model=self._details.get("model", ""),
            sensors=self._names,
            rate_hz=self._hz,
            has_positions=self._form.position,
            has_orientations=bool(self._form.orientation),
            details=self._details,
        )

    def _connect(self) -> None:
        addresses = self._addresses if self._layout.group else (0,)
        self._ports = [
            SerialPort(path, self._baud, self._layout, addresses, first)
            for first, path in enumerate(self._paths)
        ]
        for port in self._ports:
            port.line.open()
            if self._reset and port.line.reset_device():
                time.sleep(AFTER_RESET_S)
            self._quieten(port)
        firmware = self._ask(FIRMWARE)
        model = self._ask(MODEL).decode("ascii", "replace").strip()
        self._details = {"model": model, "firmware": f"{firmware[0]}.{firmware[1]}"}
        self._configure()
        self._begin()
        if self._streams:
            for port in self._ports:
                port.line.write(bytes([EVERY[self._every], STREAM]))

    def _quieten(self, port: SerialPort) -> None:
        """End whatever a unit is sending."""
        port.line.write(bytes([POINT]))
        time.sleep(self._settle_s / 3.0)
        port.line.drop_input()

    def _ask(self, parameter: int) -> bytes:
        """The value of a parameter of the master."""
        size, master = SIZES[parameter], self._ports[0]
        for _ in range(ATTEMPTS):
            master.line.drop_input()
            master.line.write(bytes([EXAMINE, parameter]))
            wait_s = REPLY_S + size * BITS / self._baud
            value = master.line.read_exactly(size, wait_s)
            if len(value) == size:
                return value
        raise DeviceError(
            f"{master.path}: no answer to examine parameter {parameter}; check the power, the fly "
            "switch, the cable and the baud rate (DIP switches)"
        )

    def _configure(self) -> None:
        """Set up every unit, and have the master find the others, again if some did not hear it."""
        master = self._ports[0].line
        hemisphere = bytes([HEMISPHERE]) + self._hemisphere
        for index, address in enumerate(self._addresses):
            line = self._ports[index % len(self._ports)].line
            for command in (bytes([self._form.command]), hemisphere):
                line.write(bytes([PREFIX + address] * self._layout.group) + command)
        if not self._erc:
            for port in self._ports:
                port.line.write(change(SCALING, int(self._scaling.range_inch > 36.0)))
        measured_hz = self._hz * self._every
        master.write(change(RATE, round(measured_hz * RATE_UNIT)))
        if self._power_hz:
            master.write(change(LINE_FREQUENCY, self._power_hz))
        for attempt in range(1, CONFIGURATIONS + 1):
            if self._units > 1:  # the line stays idle before and after
                time.sleep(self._settle_s)
                master.write(change(AUTO_CONFIG, self._units))
                time.sleep(self._settle_s)
                master.drop_input()
            if self._layout.group:
                master.write(change(GROUP_MODE, 1))
            try:
                self._check()
            except DeviceLostError:
                raise
            except DeviceError:
                if attempt == CONFIGURATIONS or self._units == 1:
                    raise
            else:
                return

    def _check(self) -> None:
        """Check that all units run and none has an error."""
        path, units = self._ports[0].path, self._units
        code = self._ask(ERROR)[0]
        if code:
            raise DeviceError(f"{path}: {error_text(code, self._ask(EXPANDED_ERROR)[0])}")
        status = self._ask(FLOCK_STATUS) if units > 1 else b""
        need = ACCESSIBLE | RUNNING
        for address in self._addresses if units > 1 else ():
            if status[address - 1] & need != need:
                found = sum(bool(each & ACCESSIBLE) for each in status)
                raise DeviceError(
                    f"{path}: unit {address} of {units} does not run; {found} are there. "
                    "Check its fly switch and address, and birds= and erc= of the address"
                )

    def _stop(self) -> None:
        for port in self._ports:
            with suppress(DeviceLostError):
                self._quieten(port)
                port.line.write(bytes([SLEEP]))

    def _pose(self, values: Values) -> tuple[np.ndarray, np.ndarray] | None:
        return pose_of_words(values, self._form, self._scaling)


MEASURED_HZ = 103.3  # Measuring cycles a second of a simulated flock until it is told otherwise.
WRONG_ADDRESS = 0x7F  # Address of no bird.
BY_COMMAND = {each.command: each for each in FORMATS.values()}
EVERY_BY_COMMAND = {command: every for every, command in EVERY.items()}
DATA_SIZES = {HEMISPHERE: 2, EXAMINE: 1}


@dataclass(frozen=True)
class FlockRig:
    """What a simulated flock consists of."""

    erc: bool = False
    """Whether unit 1 is an extended-range controller without a sensor."""

    line_a_bird: bool = False
    quiet_s: float = 0.6
    """How long lines must be idle before and after auto-configuration [s]."""

    missing: tuple[int, ...] = ()
    """Addresses of units that do not answer on the bus."""


class _BirdLine(SimulatedLine):
    """One line, the unit at its end, and whether it streams."""

    def __init__(self, unit: int, faults: Faults) -> None:
        super().__init__(faults)
        self.unit = unit
        self.streaming = False
        self.every = 1
        self.target = 0


class FlockSimulator(SerialSimulator[_BirdLine]):
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
        faults = faults or Faults()
        first = 1 + self.rig.erc
        self._addresses = tuple(range(first, first + len(motion.sensors)))
        self._units = len(motion.sensors) + self.rig.erc
        ends = self._addresses if self.rig.line_a_bird else (1,)
        super().__init__(motion, MEASURED_HZ, [_BirdLine(unit, faults) for unit in ends], log)
        self._power_up()

    def _power_up(self) -> None:
        for line in self._lines:
            line.streaming = False
        self._forms = dict.fromkeys(range(1, self._units + 1), FORMATS["pos_ang"])
        self._rate_hz = MEASURED_HZ
        self._scaling = 0
        self._group = False
        self._configured = self._units == 1
        self._error, self._error_unit = self._faults.error, 0
        self._heard_s = self._configured_s = -1e9

    def _measure(self, at_s: float) -> None:
        """One measuring cycle: every line that streams sends it, if its turn has come."""
        for line in self._lines:
            if line.streaming and self._cycle % line.every == 0:
                self._stream(line, at_s, line.every / self._rate_hz)

    def _report(self, line: _BirdLine, at_s: float) -> None:
        """The records of the birds of a line, at a time."""
        if not self._configured or time.monotonic() - self._configured_s < self.rig.quiet_s:
            self._error, self._error_unit = 9, line.unit
            return
        positions, orientations = self._poses(at_s)
        scaling = Scaling(144.0 if self.rig.erc else 72.0 if self._scaling else 36.0)
        share = self._faults.wrong_address_share
        on_line = self._addresses if self._group else (line.unit,)
        for address in [each for each in on_line if each in self._addresses]:
            index, form = self._addresses.index(address), self._forms[address]
            words = words_of_pose(positions[index], orientations[index], form, scaling)
            layout = FlockLayout(form, self._group)
            data = layout.encode(words, address)
            wrong = self._group and bool(share) and line.random.random() < share
            out = layout.encode(words, WRONG_ADDRESS) if wrong else data
            intact = line.send(out, at_s) and not wrong
            self._sent(address, data, intact=intact)

    def _listen(self, line: _BirdLine) -> None:
        data, now = line.receive(), time.monotonic()
        if data and self._configured_s > 0.0 and now - self._configured_s < self.rig.quiet_s:
            self._configured, self._error, self._error_unit = False, 13, self._units
        while line.commands:
            code = line.commands[0]
            size = 1 + DATA_SIZES.get(code, 0)
            if code == CHANGE:
                size = 3 if len(line.commands) < 2 else 2 + SIZES.get(line.commands[1], 0)
            if len(line.commands) < size:
                return
            command = bytes(line.commands[:size])
            del line.commands[:size]
            self._obey(line, command, now)
            self._heard_s = now

    def _obey(self, line: _BirdLine, command: bytes, now: float) -> None:
        code, target = command[0], line.target or line.unit
        line.target = 0
        if PREFIX < code < PREFIX + 15:
            line.target = code - PREFIX
        elif code == POINT and line.streaming:  # a stream ends instead
            line.streaming = False
            line.forget()
        elif code == POINT:
            line.poll_at_s = now
        elif code == STREAM:
            line.streaming = True
        elif code in EVERY_BY_COMMAND:
            line.every = EVERY_BY_COMMAND[code]
        elif code in BY_COMMAND and target in self._forms:
            self._forms[target] = BY_COMMAND[code]
        elif code == EXAMINE:
            self._examine(line, command[1])
        elif code == CHANGE and command[1] in SIZES:
            self._change(command[1], int.from_bytes(command[2:], "little"), now)
        elif code == SLEEP:
            line.streaming = False
        elif code not in (RUN, HEMISPHERE):
            self._error, self._error_unit = 6, target

    def _change(self, parameter: int, value: int, now: float) -> None:
        if parameter == RATE and value:
            self._rate_hz = value / RATE_UNIT
        elif parameter == GROUP_MODE:
            self._group = bool(value)
        elif parameter == SCALING:
            self._scaling = value
        elif parameter == AUTO_CONFIG:
            # found are all, if the line was idle before and all that were named are there
            absent = [each for each in range(1, value + 1) if not self._is_there(each)]
            self._configured_s = now
            idle = now - self._heard_s >= self.rig.quiet_s
            self._configured = idle and value - len(absent) == self._units
            self._error, self._error_unit = self._faults.error, 0
            if absent:
                self._error, self._error_unit = 13, absent[0]
            elif not self._configured:
                self._error, self._error_unit = 9, 1

    def _is_there(self, unit: int) -> bool:
        return unit <= self._units and unit not in self.rig.missing

    def _examine(self, line: _BirdLine, parameter: int) -> None:
        """Answer with a parameter's value."""
        values = {
            FIRMWARE: b"\x03\x2f",
            ERROR: bytes([self._error]),
            MODEL: b"6DERC     " if self.rig.erc else b"6DFOB     ",
            EXPANDED_ERROR: bytes([self._error_unit, 0]),
            FLOCK_STATUS: bytes(map(self._unit_bits, range(1, 15))),
        }
        if parameter == ERROR:
            self._error = 0
        line.send(values.get(parameter, bytes(SIZES.get(parameter, 2))), time.monotonic())

    def _unit_bits(self, unit: int) -> int:
        if not self._is_there(unit) or (unit > 1 and not self._configured):
            return 0
        kind = SENSOR if unit in self._addresses else ERC | 0x01
        return ACCESSIBLE | RUNNING * self._configured | kind
