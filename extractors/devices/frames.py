"""Records of single sensors gathered into frames; what is missing is counted, never filled in."""

from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np

from extractors.devices.tracker import Counts, Frame


@dataclass(frozen=True, slots=True)
class SensorReading:
    """One sensor's pose in one cycle."""

    index: int
    """Row of the sensor in a frame."""

    host_s: float
    position: np.ndarray
    orientation: np.ndarray
    device_s: float | None = None


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
        self._place = -1
        self._is_started = False

    def start(self, cycle: int, index: int) -> int:
        """Begin with a record of a sensor in a cycle."""
        self._place, self._is_started = cycle * self._sensors + index, True
        return cycle

    @property
    def started(self) -> bool:
        """Whether a record was numbered."""
        return self._is_started

    def cycle_of(self, index: int, *, missed: int) -> int:
        """The cycle of the next record, of a sensor."""
        if not self.started:
            return self.start(0, index)
        cycle = round((self._place + 1 + missed - index) / self._sensors)
        while cycle * self._sensors + index <= self._place:
            cycle += 1
        return self.start(cycle, index)


@dataclass
class _Partial:
    readings: dict[int, SensorReading] = field(default_factory=dict)


class FrameCollector:
    """Makes frames of the readings of numbered cycles.

    Args:
        sensors: How many there are.
        counts: Where lost records are counted.
        ahead: How many newer cycles are begun before an incomplete one is given as it is, though
            some sensor has not got past it.
        counted: Whether cycles are equally long, so that frames bear their numbers.
    """

    def __init__(
        self, sensors: int, counts: Counts, *, ahead: int = 0, counted: bool = True
    ) -> None:
        self._sensors = sensors
        self._counts = counts
        self._ahead = ahead
        self._counted = counted
        self._partial: dict[int, _Partial] = {}
        self._given = -1
        self._newest = [-1] * sensors

    def start_after(self, cycle: int) -> None:
        """Count from a cycle on; nothing before it is missing."""
        self._partial.clear()
        self._newest = [cycle] * self._sensors
        self._given = cycle

    def add(self, cycle: int, reading: SensorReading) -> list[Frame]:
        """The frames that a reading completes, or shows to be incomplete."""
        if cycle <= self._given:
            self._counts.refused_records += 1
            return []
        self._counts.records += 1
        self._partial.setdefault(cycle, _Partial()).readings[reading.index] = reading
        self._newest[reading.index] = max(cycle, self._newest[reading.index])
        passed = max(min(self._newest), max(self._newest) - self._ahead - 1)
        done = [
            each
            for each, partial in self._partial.items()
            if len(partial.readings) == self._sensors or each <= passed
        ]
        return self._give(max(done)) if done else []

    def flush(self) -> list[Frame]:
        """The frames that were begun."""
        return self._give(max(self._partial)) if self._partial else []

    def _give(self, last: int) -> list[Frame]:
        """Every frame begun up to a cycle."""
        out = []
        for cycle in sorted(each for each in self._partial if each <= last):
            readings = list(self._partial.pop(cycle).readings.values())
            missing = self._sensors - len(readings)
            self._counts.lost_records += missing + self._sensors * (cycle - self._given - 1)
            self._given = cycle
            out.append(frame_of(readings, self._sensors, cycle=cycle if self._counted else None))
        return out


def frame_of(readings: Sequence[SensorReading], sensors: int, *, cycle: int | None = None) -> Frame:
    """The frame of some sensors' readings; the others are NaN."""
    positions, orientations = np.full((sensors, 3), np.nan), np.full((sensors, 4), np.nan)
    for reading in readings:
        positions[reading.index] = reading.position
        orientations[reading.index] = reading.orientation
    first = min(readings, key=lambda each: each.host_s)
    return Frame(first.host_s, first.device_s, positions, orientations, cycle)
