"""A Flock of Birds for those who have none: its commands and records on pseudo-terminals."""

import time

from extractors.devices import flock_commands as commands
from extractors.devices.bird_formats import FORMATS, Scaling, words_of_pose
from extractors.devices.flock_records import encode_record
from extractors.devices.flock_rig import Bird, Desk, FlockRig, command_size, range_inch
from extractors.devices.motion_source import MotionSource
from extractors.devices.simulated_line import Faults, Sent, SimulatedLine
from extractors.devices.simulator import Simulator

TICK_S = 0.002
"""How often a line that has something to send is attended to [s]."""

MEASURED_HZ = 103.3
"""Measuring cycles a second until it is told otherwise."""

WRONG_ADDRESS = 0x7F
"""Address of no bird."""

BY_COMMAND = {each.command: each for each in FORMATS.values()}
EVERY_BY_COMMAND = {command: every for every, command in commands.EVERY.items()}


class FlockSimulator(Simulator):
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
        super().__init__(motion, MEASURED_HZ)
        self.rig = rig or FlockRig()
        self.faults = faults or Faults()
        self.skipped = 0
        self._log = log
        first = 2 if self.rig.erc else 1
        self._addresses = tuple(range(first, first + len(motion.sensors)))
        self._units = len(motion.sensors) + self.rig.erc
        ends = self._addresses if self.rig.line_a_bird else (1,)
        self._desks = [Desk(SimulatedLine(self.rig.baud, self.faults), unit) for unit in ends]
        self._power_up()

    def _power_up(self) -> None:
        self._birds = {each: Bird() for each in range(1, self._units + 1)}
        self._rate_hz = MEASURED_HZ
        self._range_inch = range_inch(self.rig, 0)
        self._group = False
        self._configured = self._units == 1
        self._error, self._error_unit = self.rig.error, 0
        self._heard_s = self._configured_s = -1e9

    @property
    def paths(self) -> tuple[str, ...]:
        """The lines' device files; they stay the same when a plug is pulled."""
        return tuple(each.line.path for each in self._desks)

    @property
    def place(self) -> str:
        """The place in an address: the device files, divided by commas."""
        return ",".join(self.paths)

    def _plug(self) -> None:
        self._power_up()
        for desk in self._desks:
            desk.line.plug()

    def _unplug(self) -> None:
        for desk in self._desks:
            desk.line.unplug()
            desk.streaming = False
            desk.commands.clear()

    def _remove(self) -> None:
        for desk in self._desks:
            desk.line.remove()

    def _hold_lines(self, held_up_s: float) -> None:
        for desk in self._desks:
            desk.line.hold(held_up_s)

    def _handles(self) -> list[int]:
        return [each.line.master for each in self._desks if each.line.master >= 0]

    def _wait_s(self) -> float:
        """Until something is to be sent."""
        if any(each.line.busy or each.poll_at_s >= 0.0 for each in self._desks):
            return TICK_S
        return super()._wait_s()

    def _attend(self, ready: set[int]) -> None:
        for desk in self._desks:
            if desk.line.master in ready:
                self._listen(desk)
        now = time.monotonic()
        for desk in self._desks:
            if 0.0 <= desk.poll_at_s <= now:
                desk.poll_at_s = -1.0
                self._report(desk, now)
            desk.line.pump(time.monotonic())

    def _measure(self, at_s: float) -> None:
        """One measuring cycle: every line that streams sends it, if its turn has come."""
        period_s = 1.0 / self._rate_hz
        for desk in self._desks:
            if desk.streaming and self._cycle % desk.every == 0:
                if desk.line.free_at_s - at_s > desk.every * period_s:
                    self.skipped += 1
                else:
                    self._report(desk, at_s)

    def _report(self, desk: Desk, at_s: float) -> None:
        """The records of the birds of a line, at a time."""
        if not self._configured or time.monotonic() - self._configured_s < self.rig.quiet_s:
            self._error, self._error_unit = 9, desk.unit
            return
        positions, orientations = self._poses(at_s)
        addresses = self._addresses if self._group else (desk.unit,)
        for address in addresses:
            if address not in self._addresses:
                continue
            index, bird = self._addresses.index(address), self._birds[address]
            scaling = Scaling(self._range_inch, self.rig.conjugated)
            words = words_of_pose(positions[index], orientations[index], bird.form, scaling)
            self._send(desk, address, words, at_s)

    def _send(self, desk: Desk, address: int, words: tuple[int, ...], at_s: float) -> None:
        shown = address if self._group else None
        data = encode_record(words, address=shown)
        wrong = self._group and self._is_wrong(desk)
        out = encode_record(words, address=WRONG_ADDRESS) if wrong else data
        intact = desk.line.send(out, at_s) and not wrong
        if self._log is not None:
            self._log.append(Sent(address, data, intact))

    def _is_wrong(self, desk: Desk) -> bool:
        share = self.faults.wrong_address_share
        return bool(share) and desk.line.chance() < share

    def _listen(self, desk: Desk) -> None:
        try:
            data = desk.line.receive()
        except OSError:
            return
        now = time.monotonic()
        if data and self._configured_s > 0.0 and now - self._configured_s < self.rig.quiet_s:
            self._configured, self._error, self._error_unit = False, 13, self._units
        desk.commands += data
        while (size := command_size(desk.commands)) and len(desk.commands) >= size:
            command = bytes(desk.commands[:size])
            del desk.commands[:size]
            self._obey(desk, command, now)
            self._heard_s = now

    def _obey(self, desk: Desk, command: bytes, now: float) -> None:
        code, target = command[0], desk.target or desk.unit
        desk.target = 0
        if commands.PREFIX < code < commands.PREFIX + 15:
            desk.target = code - commands.PREFIX
        elif code == commands.POINT:
            self._poll(desk, now)
        elif code == commands.STREAM:
            desk.streaming = True
        elif code in EVERY_BY_COMMAND:
            desk.every = EVERY_BY_COMMAND[code]
        elif code in BY_COMMAND and target in self._birds:
            self._birds[target].form = BY_COMMAND[code]
        elif code == commands.HEMISPHERE and target in self._birds:
            self._birds[target].hemisphere = command[1:]
        elif code == commands.EXAMINE:
            self._examine(desk, command[1])
        elif code == commands.CHANGE and command[1] in commands.SIZES:
            self._change(command[1], int.from_bytes(command[2:], "little"), now)
        elif code == commands.SLEEP:
            desk.streaming = False
        elif code not in (commands.RUN, commands.FBB_RESET, commands.NEXT_TRANSMITTER):
            self._error, self._error_unit = 6, target

    def _poll(self, desk: Desk, now: float) -> None:
        """Answer, soon; a stream ends instead."""
        if desk.streaming:
            desk.streaming = False
            desk.line.forget()
        else:
            desk.poll_at_s = now + self.faults.reply_delay_s

    def _change(self, parameter: int, value: int, now: float) -> None:
        if parameter == commands.RATE and value:
            self._rate_hz = value / commands.RATE_UNIT
        elif parameter == commands.GROUP_MODE:
            self._group = bool(value)
        elif parameter == commands.SCALING:
            self._range_inch = range_inch(self.rig, value)
        elif parameter == commands.AUTO_CONFIG:
            self._auto_configure(value, now)

    def _auto_configure(self, units: int, now: float) -> None:
        """Find the other units, if the line was idle before and all that were named are there."""
        there = [each for each in range(1, units + 1) if self._is_there(each)]
        absent = [each for each in range(1, units + 1) if not self._is_there(each)]
        self._configured_s = now
        self._configured = now - self._heard_s >= self.rig.quiet_s and len(there) == self._units
        if absent:
            self._error, self._error_unit = 13, absent[0]
        elif not self._configured:
            self._error, self._error_unit = 9, 1
        else:
            self._error, self._error_unit = self.rig.error, 0

    def _is_there(self, unit: int) -> bool:
        return unit <= self._units and unit not in self.rig.missing

    def _examine(self, desk: Desk, parameter: int) -> None:
        model = b"6DERC     " if self.rig.erc else b"6DFOB     "
        values = {
            commands.STATUS: self._status(desk),
            commands.FIRMWARE: b"\x03\x2f",
            commands.CRYSTAL: (25).to_bytes(2, "little"),
            commands.SCALING: int(self._range_inch > 36.0).to_bytes(2, "little"),
            commands.RATE: commands.rate_word(self._rate_hz).to_bytes(2, "little"),
            commands.ERROR: bytes([self._error]),
            commands.MODEL: model,
            commands.EXPANDED_ERROR: bytes([self._error_unit, 0]),
            commands.LINE_FREQUENCY: b"\x3c",
            commands.HEMISPHERE_PARAMETER: self._birds[desk.unit].hemisphere,
            commands.GROUP_MODE: bytes([self._group]),
            commands.FLOCK_STATUS: bytes(map(self._unit_bits, range(1, 15))),
        }
        if parameter == commands.ERROR:
            self._error = 0
        value = values.get(parameter, bytes(commands.SIZES.get(parameter, 2)))
        desk.line.send(value, time.monotonic())

    def _status(self, desk: Desk) -> bytes:
        """Master, initialised, error, running, and whether it streams."""
        bits = (desk.unit == 1) << 15 | self._configured << 14 | bool(self._error) << 13
        return (bits | self._configured << 12 | desk.streaming).to_bytes(2, "little")

    def _unit_bits(self, unit: int) -> int:
        if not self._is_there(unit) or (unit > 1 and not self._configured):
            return 0
        kind = commands.SENSOR if unit in self._addresses else commands.ERC | 0x01
        return commands.ACCESSIBLE | (commands.RUNNING if self._configured else 0) | kind
