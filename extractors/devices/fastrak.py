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
from contextlib import suppress
from dataclasses import dataclass

import numpy as np
from scipy.spatial.transform import Rotation

from extractors.devices.bird_formats import NORM_TOLERANCE, from_world, to_world
from extractors.devices.lines import BAUDS, BITS
from extractors.devices.records import SerialPort, SerialTracker, Values
from extractors.devices.simulator import Faults, MotionSource, Sent, SerialSimulator, SimulatedLine
from extractors.devices.tracker import Address, Description, DeviceLostError

END = b"\r\n"
STATIONS = 4
FIELD = 7  # Characters of a number in an ASCII record.
CM_M = 0.01
RECORDS_HZ = 120.0  # Records a second of all stations together.
SETTLE_S = 0.2  # How long the line is left to end what was being sent [s].

ITEMS = {"pos": (2,), "pos_ang": (2, 4), "pos_quat": (2, 11)}
"""Items of the output list by format: 2 position, 4 azimuth elevation roll, 11 quaternion."""

PLACES = {"pos": "222", "pos_ang": "222222", "pos_quat": "2224444"}
"""Decimals of each number of a format: centimetres, then degrees or a quaternion w x y z."""

FORMS = {items: form for form, items in ITEMS.items()}


@dataclass(frozen=True)
class FastrakLayout:
    """A station's record: a header, numbers in ASCII or binary, and CR LF."""

    form: str
    binary: bool

    @property
    def size(self) -> int:
        """Bytes of a record."""
        return 3 + (4 if self.binary else FIELD) * len(PLACES[self.form]) + len(END)

    def encode(self, station: int, values: Sequence[float]) -> bytes:
        """The bytes of a record of centimetres, degrees and quaternions w x y z, without error."""
        head = f"0{station} ".encode("ascii")
        if self.binary:
            return head + struct.pack(f"<{len(values)}f", *values) + END
        fields = zip(values, PLACES[self.form], strict=True)
        return head + "".join(f"{value:{FIELD}.{n}f}" for value, n in fields).encode() + END

    def decode(self, data: bytes, *, ended: bool = False) -> tuple[int, Values] | int | None:
        """Station and numbers, as of ``Layout``."""
        data = data[: self.size]
        if len(data) < self.size:
            return None
        station, body = data[1] - ord("0"), data[3 : -len(END)]
        framed = data[:1] == b"0" and 0x20 <= data[2] < 0x7F and data.endswith(END)
        if not framed or not 0 < station <= STATIONS:
            return 1
        if self.binary:
            values = struct.unpack(f"<{len(body) // 4}f", body)
        elif _DIGITS.issuperset(body):
            try:
                values = tuple(float(body[at : at + FIELD]) for at in range(0, len(body), FIELD))
            except ValueError:
                return 1
        else:
            return 1
        wild = self.form == "pos_quat" and abs(math.hypot(*values[3:]) - 1.0) > NORM_TOLERANCE
        return 1 if wild or not all(map(math.isfinite, values)) else (station, values)


_DIGITS = frozenset(b"0123456789+-. ")


class FastrakTracker(SerialTracker):
    """A Fastrak.

    Args:
        address: Like ``fastrak:/dev/ttyUSB0?stations=4&encoding=binary``.

    Raises:
        CaparError: The address holds what no Fastrak can be set to, or the line is too slow.
    """

    def __init__(self, address: Address) -> None:
        stations = address.integer("stations", 1, low=1, high=STATIONS)
        self._names = address.names(f"station{index + 1}" for index in range(stations))
        self._form = address.choice("format", ITEMS, "pos_quat")
        self._encoding = address.choice("encoding", ("binary", "ascii"), "binary")
        self._baud = int(address.choice("baud", map(str, BAUDS), "115200"))
        self._stream = address.choice("mode", ("stream", "point"), "stream") == "stream"
        address.close()
        self._layout = FastrakLayout(self._form, self._encoding == "binary")
        self._path = address.place
        size = self._layout.size
        if RECORDS_HZ * size > self._baud / BITS and self._stream:
            raise address.error(
                f"{RECORDS_HZ:g} records of {size} bytes are {RECORDS_HZ * size:.0f} bytes a "
                f"second; {self._baud} baud carry {self._baud / BITS:.0f}. Raise the baud rate, "
                "choose encoding=binary, or poll with mode=point."
            )
        super().__init__(stations, RECORDS_HZ / stations, b"" if self._stream else b"P")

    def describe(self) -> Description:
        """The stations, and how they were configured to send."""
        return Description(
            kind="fastrak",
            model="Fastrak",
            sensors=self._names,
            rate_hz=self._hz,
            has_orientations=self._form != "pos",
            details={"encoding": self._encoding},
        )

    def _connect(self) -> None:
        stations = range(1, self._sensors + 1)
        self._ports = [SerialPort(self._path, self._baud, self._layout, stations)]
        line = self._ports[0].line
        line.open()
        line.write(b"c")
        time.sleep(SETTLE_S)
        items = ",".join(str(each) for each in (*ITEMS[self._form], 1))
        for station in stations:
            line.write(f"O{station},{items}\r".encode())
        line.write(b"u" + (b"f" if self._layout.binary else b"F"))
        time.sleep(SETTLE_S)
        line.drop_input()
        self._begin()
        if self._stream:
            line.write(b"C")

    def _stop(self) -> None:
        with suppress(DeviceLostError):
            self._ports[0].line.write(b"c")

    def _pose(self, values: Values) -> tuple[np.ndarray, np.ndarray]:
        turned = np.full(4, np.nan)
        if self._form == "pos_quat":
            turned = np.array(values[3:]) / math.hypot(*values[3:])
        elif self._form == "pos_ang":
            angles = Rotation.from_euler("ZYX", values[3:], degrees=True)
            turned = angles.as_quat(scalar_first=True)
        return to_world(np.array(values[:3]) * CM_M, turned)


class FastrakSimulator(SerialSimulator[SimulatedLine]):
    """A Fastrak with one station a sensor of the motion, at most four.

    Args:
        motion: What is measured.
        faults: What goes wrong on its line.
        log: Where every record is kept, if anywhere.
    """

    def __init__(
        self, motion: MotionSource, faults: Faults | None = None, log: list[Sent] | None = None
    ) -> None:
        self._stations = range(1, min(STATIONS, len(motion.sensors)) + 1)
        line = SimulatedLine(faults or Faults())
        super().__init__(motion, RECORDS_HZ / len(self._stations), [line], log)
        self._power_up()

    def _power_up(self) -> None:
        self._forms = dict.fromkeys(self._stations, "pos_ang")
        self._binary = self._streaming = False
        self._unit_cm = 2.54

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
            if code == "P":
                line.poll_at_s = time.monotonic()
            elif code in "Cc":
                self._streaming = code == "C"
                if not self._streaming:
                    line.forget()
            elif code in "Ff":
                self._binary = code == "f"
            elif code in "Uu":
                self._unit_cm = 1.0 if code == "u" else 2.54
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
        for station, *pose in zip(self._stations, *self._poses(at_s), strict=False):
            position, turned = from_world(*pose)
            values, form = list(position / CM_M / self._unit_cm), self._forms[station]
            if form == "pos_quat":
                values += list(turned)
            elif form == "pos_ang":
                turn = Rotation.from_quat(turned, scalar_first=True)
                values += list(turn.as_euler("ZYX", degrees=True))
            data = FastrakLayout(form, self._binary).encode(station, values)
            self._sent(station, data, intact=line.send(data, at_s))
