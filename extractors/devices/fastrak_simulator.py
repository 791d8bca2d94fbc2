"""A Polhemus Fastrak for those who have none, on a pseudo-terminal."""

import time

import numpy as np
from scipy.spatial.transform import Rotation

from extractors.devices import fastrak_records as records
from extractors.devices.bird_formats import from_world
from extractors.devices.fastrak_records import StationRecord
from extractors.devices.motion_source import MotionSource
from extractors.devices.simulated_line import Faults, Sent, SimulatedLine
from extractors.devices.simulator import Simulator

TICK_S = 0.002
CM_M = records.CM_M
FORMS = {items: form for form, items in records.ITEMS.items()}
INCH_CM = 2.54


class FastrakSimulator(Simulator):
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
        stations = min(records.STATIONS, len(motion.sensors))
        super().__init__(motion, 120.0 / stations)
        self.skipped = 0
        self._stations = range(1, stations + 1)
        self._faults = faults or Faults()
        self._line = SimulatedLine(baud, self._faults)
        self._log = log
        self._power_up()

    def _power_up(self) -> None:
        self._forms = dict.fromkeys(self._stations, "pos_ang")
        self._binary = self._streaming = False
        self._unit_cm = INCH_CM
        self._commands = bytearray()
        self._poll_at_s = -1.0

    @property
    def place(self) -> str:
        """The device file."""
        return self._line.path

    def _plug(self) -> None:
        self._power_up()
        self._line.plug()

    def _unplug(self) -> None:
        self._line.unplug()

    def _remove(self) -> None:
        self._line.remove()

    def _hold_lines(self, held_up_s: float) -> None:
        self._line.hold(held_up_s)

    def _handles(self) -> list[int]:
        return [self._line.master] if self._line.master >= 0 else []

    def _wait_s(self) -> float:
        if self._line.busy or self._poll_at_s >= 0.0:
            return TICK_S
        return super()._wait_s()

    def _attend(self, ready: set[int]) -> None:
        if ready:
            self._commands += self._line.receive()
            self._obey_all()
        now = time.monotonic()
        if 0.0 <= self._poll_at_s <= now:
            self._poll_at_s = -1.0
            self._report(now)
        self._line.pump(now)

    def _obey_all(self) -> None:
        """Every command that is whole: one letter, or a letter and a list up to the return."""
        while self._commands:
            code = chr(self._commands[0])
            size = self._commands.find(b"\r") + 1 if code == "O" else 1
            if size == 0:
                return
            command = bytes(self._commands[:size])
            del self._commands[:size]
            self._obey(code, command)

    def _obey(self, code: str, command: bytes) -> None:
        if code == "P":
            self._poll_at_s = time.monotonic() + self._faults.reply_delay_s
        elif code in "Cc":
            self._streaming = code == "C"
            if not self._streaming:
                self._line.forget()
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
        if not self._streaming or self._line.master < 0:
            return
        if self._line.free_at_s - at_s > 1.0 / self._rate_hz:
            self.skipped += 1
        else:
            self._report(at_s)

    def _report(self, at_s: float) -> None:
        """The records of all stations at a time."""
        positions, orientations = self._poses(at_s)
        for station in self._stations:
            form = self._forms[station]
            position, turned = from_world(positions[station - 1], orientations[station - 1])
            values = [*(position / CM_M / self._unit_cm), *_turned(form, turned)]
            record = StationRecord(station, " ", tuple(values))
            data = records.encode_record(record, form, binary=self._binary)
            intact = self._line.send(data, at_s)
            if self._log is not None:
                self._log.append(Sent(station, data, intact))


def _turned(form: str, quaternion: np.ndarray) -> list[float]:
    if form == "pos_quat":
        return list(quaternion)
    if form == "pos_ang":
        turn = Rotation.from_quat(quaternion, scalar_first=True)
        return list(turn.as_euler("ZYX", degrees=True))
    return []
