"""Records of sensors in turn on serial lines: found in the bytes, numbered, gathered to frames."""

import time
from abc import abstractmethod
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Protocol

import numpy as np

from extractors.devices.lines import BITS, SerialLine
from extractors.devices.tracker import Counts, Frame, LiveTracker, SensorReading, frame_of

Values = tuple[float, ...]

SLACK_S = 0.004
"""What a record may take longer than its bytes do, and count without a byte after it [s]."""

POLL_REPLY_S = 1.0  # How long the answer to a poll may take to begin [s].
POLL_IDLE_S = 0.1  # A poll's answer that stops for so long has ended [s].
SILENCE_S = 1.5  # A device that sends nothing for so long and three frames is lost [s].
IDLE_S = 0.006  # A line without a byte for so long has sent its record [s].
AHEAD = 50  # How many cycles sensors with lines of their own may be apart.


class Layout(Protocol):
    """How a record of fixed length lies in bytes."""

    @property
    def size(self) -> int:
        """Bytes of a record."""

    def decode(self, data: bytes, *, ended: bool = False) -> tuple[int, Values] | int | None:
        """What some bytes, one more than a record at most, begin with.

        Args:
            data: The bytes; at least one.
            ended: Whether nothing follows them.

        Returns:
            Address and values of a record, the number of bytes that are of none, or None where
            more bytes are needed.
        """


@dataclass(frozen=True, slots=True)
class Record:
    """What one sensor sent."""

    address: int
    values: Values
    stamp_s: float
    """When its first byte arrived [s]."""

    missed: int
    """How many records the bytes were of that were dropped since the record before."""


class RecordParser:
    """Finds the records in a stream of bytes that may have lost some.

    Args:
        layout: How a record lies in bytes.
        addresses: Those that there are; records of others are counted and left out.
        byte_s: Time of a byte on the line, for time stamps [s].
    """

    def __init__(self, layout: Layout, addresses: Sequence[int], byte_s: float = 0.0) -> None:
        self.dropped_bytes = 0
        self.wrong_addresses = 0
        self._layout = layout
        self._addresses = addresses
        self._byte_s = byte_s
        self._buffer = bytearray()
        self._stamp_s = self._fed_s = 0.0
        self._dropped = self._refused = 0

    @property
    def pending(self) -> int | None:
        """Address of the record that waits for the byte after it; None where none does."""
        if len(self._buffer) != self._layout.size:
            return None
        found = self._layout.decode(bytes(self._buffer), ended=True)
        return found[0] if isinstance(found, tuple) else None

    def feed(self, data: bytes, at_s: float = 0.0, *, ended: bool = False) -> list[Record]:
        """The records that some bytes complete, the last of which arrived at a moment [s].

        Args:
            data: The bytes.
            at_s: The moment [s].
            ended: Whether nothing can follow them.
        """
        held, out, at = len(self._buffer), [], 0
        self._buffer += data
        total, size = len(self._buffer), self._layout.size
        self._fed_s = at_s
        while at < total:
            stamp_s = self._stamp_s if at < held else at_s - (total - 1 - at) * self._byte_s
            found = self._layout.decode(bytes(self._buffer[at : at + size + 1]), ended=ended)
            if found is None:
                self._stamp_s = stamp_s
                break
            if isinstance(found, int):
                self.dropped_bytes += found
                self._dropped += found
                at += found
                continue
            at += size
            address, values = found
            if address not in self._addresses:
                self.wrong_addresses += 1
                self._refused += 1
                continue
            missed = -(-self._dropped // size) + self._refused
            self._dropped = self._refused = 0
            out.append(Record(address, values, stamp_s, missed))
        del self._buffer[:at]
        return out

    def settle(self, *, answered: bool = False) -> list[Record]:
        """The last record, if it is whole and came in one go, and the line is idle after it.

        Args:
            answered: Whether it ends the answer to a poll, so that nothing can follow it.
        """
        longest_s = 2.0 * self._layout.size * self._byte_s + SLACK_S
        late = self._byte_s > 0.0 and self._fed_s - self._stamp_s > longest_s
        if self.pending is None or (late and not answered):
            return []
        return self.feed(b"", self._fed_s, ended=True)

    def clear(self) -> None:
        """Forget what was begun."""
        self._buffer.clear()


class CycleCounter:
    """Numbers the measuring cycles of records that carry no number, but come in order.

    A record follows the one before; where bytes were dropped, as many are taken to be missing as
    the bytes are of, to the nearest that the order of the sensors allows. Time is not asked: a
    busy computer reads late.

    Args:
        sensors: How many send in turn.
    """

    def __init__(self, sensors: int) -> None:
        self._sensors = sensors
        self._place: int | None = None

    @property
    def started(self) -> bool:
        """Whether a record was numbered."""
        return self._place is not None

    def start(self, cycle: int, index: int) -> int:
        """Begin with a record of a sensor in a cycle."""
        self._place = cycle * self._sensors + index
        return cycle

    def cycle_of(self, index: int, *, missed: int) -> int:
        """The cycle of the next record, of a sensor."""
        if self._place is None:
            return self.start(0, index)
        after = (self._place - index) // self._sensors + 1
        cycle = round((self._place + 1 + missed - index) / self._sensors)
        return self.start(max(cycle, after), index)


class FrameCollector:
    """Makes frames of the readings of numbered cycles; what is missing is counted, not filled in.

    Args:
        sensors: How many there are.
        counts: Where lost records are counted.
        ahead: How many newer cycles are begun before an incomplete one is given as it is, though
            some sensor has not got past it.
        counted: Whether cycles are equally long, so that frames bear their numbers.
    """

    def __init__(self, sensors: int, counts: Counts, *, ahead: int, counted: bool) -> None:
        self._sensors = sensors
        self._counts = counts
        self._ahead = ahead
        self._counted = counted
        self._begun: dict[int, dict[int, SensorReading]] = {}
        self.start_after(-1)

    def start_after(self, cycle: int) -> None:
        """Count from a cycle on; nothing before it is missing."""
        self._begun.clear()
        self._newest = [cycle] * self._sensors
        self._given = cycle

    def add(self, cycle: int, reading: SensorReading) -> list[Frame]:
        """The frames that a reading completes, or shows to be incomplete."""
        if cycle <= self._given:
            self._counts.refused_records += 1
            return []
        self._counts.records += 1
        self._begun.setdefault(cycle, {})[reading.index] = reading
        self._newest[reading.index] = max(cycle, self._newest[reading.index])
        passed = max(min(self._newest), max(self._newest) - self._ahead - 1)
        whole = [n for n, readings in self._begun.items() if len(readings) == self._sensors]
        return self.give(max([passed, *whole]))

    def give(self, last: int | None = None) -> list[Frame]:
        """Every frame begun up to a cycle, or every frame."""
        out = []
        for cycle in sorted(n for n in self._begun if last is None or n <= last):
            readings = list(self._begun.pop(cycle).values())
            missing = self._sensors - len(readings)
            self._counts.lost_records += missing + self._sensors * (cycle - self._given - 1)
            self._given = cycle
            out.append(frame_of(readings, self._sensors, cycle=cycle if self._counted else None))
        return out


class SerialPort:
    """One line, and what finds the records on it.

    Args:
        path: The port.
        baud: Its speed [bits a second].
        layout: How a record lies in bytes.
        addresses: Those of its sensors, in the order of a frame's rows.
        first: Row of the first of them.
    """

    def __init__(
        self, path: str, baud: int, layout: Layout, addresses: Sequence[int], first: int = 0
    ) -> None:
        self.path = path
        self.addresses = addresses
        self.first = first
        self.line = SerialLine(path, baud)
        self.cycles = CycleCounter(len(addresses))
        self.parser = RecordParser(layout, addresses, BITS / baud)
        self._late = False

    def records(self, timeout_s: float) -> list[Record]:
        """The records that come within a wait, or that the idle line shows to be whole."""
        waiting = self.parser.pending is not None
        data = self.line.read(min(timeout_s, IDLE_S) if waiting else timeout_s)
        return self.parser.feed(data, time.monotonic()) if data else self.parser.settle()

    def poll(self, command: bytes) -> None:
        """Ask for one cycle; what came too late for the last one is forgotten."""
        if self._late:
            self.line.drop_input()
        self.parser.clear()
        self.line.write(command)

    def answer(self) -> list[Record]:
        """The records that answer a poll, until the last one is there or the line is silent."""
        out: list[Record] = []
        while not out or out[-1].address != self.addresses[-1]:
            if self.parser.pending == self.addresses[-1]:
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
        self._late = len(out) < len(self.addresses)
        return out


class SerialTracker(LiveTracker):
    """A tracker whose sensors send records in turn on serial lines, in a stream or when polled.

    A driver has ``_connect``, which makes the ports and ends with ``_begin``, and ``_pose``.

    Args:
        sensors: How many there are.
        rate_hz: Frames a second.
        poll: The command that asks for one cycle; empty where the device sends by itself.
    """

    def __init__(self, sensors: int, rate_hz: float, poll: bytes) -> None:
        super().__init__()
        self._ports: list[SerialPort] = []
        self._sensors = sensors
        self._hz = rate_hz
        self._poll = poll

    def _begin(self) -> None:
        self._frames = FrameCollector(
            self._sensors,
            self.counts,
            ahead=AHEAD if len(self._ports) > 1 else 0,
            counted=not self._poll,
        )
        self._start_s = self._next_poll_s = time.monotonic()
        self._cycle = -1

    @abstractmethod
    def _pose(self, values: Values) -> tuple[np.ndarray, np.ndarray] | None:
        """Position [m] and orientation of a record; None where it is none."""

    def _disconnect(self) -> None:
        self._take_counts()
        for port in self._ports:
            port.line.close()

    def _take_counts(self) -> None:
        for parser in (port.parser for port in self._ports):
            self.counts.dropped_bytes += parser.dropped_bytes
            self.counts.refused_records += parser.wrong_addresses
            parser.dropped_bytes = parser.wrong_addresses = 0

    def _read(self, timeout_s: float) -> list[Frame]:
        since_s, before = time.monotonic(), self.counts.records
        out = self._polled(timeout_s) if self._poll else self._streamed(timeout_s)
        self._take_counts()
        heard = self.counts.records > before
        self._listened(since_s, SILENCE_S + 3.0 / self._hz, heard=heard)
        return out

    def _streamed(self, timeout_s: float) -> list[Frame]:
        out: list[Frame] = []
        for port in self._ports:
            records = port.records(timeout_s / len(self._ports))
            if records and len(self._ports) > 1 and not port.cycles.started:
                # number the line's first cycle; of several records the last has just arrived
                since_s = records[-1].stamp_s - self._start_s
                cycle = max(0, round(since_s * self._hz) - len(records) + 1)
                port.cycles.start(cycle, -1)
                if self._cycle < 0:  # what lies before the first record of all is not missing
                    self._cycle = cycle
                    self._frames.start_after(cycle - 1)
            for record in records:
                out += self._add(port, record)
        return out

    def _polled(self, timeout_s: float) -> list[Frame]:
        """One cycle of polls, if its time comes before the wait is over."""
        time.sleep(max(0.0, min(timeout_s, self._next_poll_s - time.monotonic())))
        now = time.monotonic()
        if now < self._next_poll_s:
            return []
        self._next_poll_s = max(self._next_poll_s + 1.0 / self._hz, now - 1.0 / self._hz)
        self._cycle += 1
        for port in self._ports:
            port.poll(self._poll)
        out: list[Frame] = []
        for port in self._ports:
            for record in port.answer():
                out += self._add(port, record)
        return [*out, *self._frames.give()]

    def _add(self, port: SerialPort, record: Record) -> list[Frame]:
        """The frames that a record completes, once its values are a pose and its cycle is known."""
        index, cycle = port.addresses.index(record.address), self._cycle
        if not self._poll:
            cycle = port.cycles.cycle_of(index, missed=record.missed)
        pose = self._pose(record.values)
        if pose is None:
            self.counts.refused_records += 1
            return []
        return self._frames.add(cycle, SensorReading(port.first + index, record.stamp_s, *pose))
