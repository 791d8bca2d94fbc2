"""One line of a Flock of Birds: commands, questions to the unit at its end, and its records."""

import time

from capar.model.errors import DeviceError
from extractors.devices import flock_commands as commands
from extractors.devices.flock_records import Record, RecordParser
from extractors.devices.flock_settings import FlockSettings
from extractors.devices.frames import CycleCounter
from extractors.devices.serial_line import SerialLine

REPLY_S = 0.3
"""How long a reply to a question may take beyond its bytes [s]."""

ATTEMPTS = 6
"""How often a question is put, on a line that may lose bytes."""

POLL_REPLY_S = 1.0
"""How long the answer to a poll may take to begin [s]."""

POLL_IDLE_S = 0.1
"""A poll's answer that stops for so long has ended [s]."""

AFTER_RESET_S = 2.0
"""How long units take to restart [s]."""


class FlockPort:
    """One line, the parser of what comes from it, and questions to the unit at its end."""

    def __init__(self, path: str, index: int, settings: FlockSettings) -> None:
        self.index = index
        self.path = path
        self.line = SerialLine(path, settings.baud)
        self._byte_s = commands.BITS / settings.baud
        self._expected = len(settings.names) if settings.group else 1
        self._last = settings.addresses[-1] if settings.group else 0
        self._late = False
        self.cycles = CycleCounter(self._expected)
        self._quiet_s = settings.settle_s / 3.0
        self.parser = RecordParser(
            settings.form,
            addresses=settings.addresses if settings.group else None,
            byte_s=self._byte_s,
        )

    def tell(self, command: bytes) -> None:
        """Give a command, which nothing acknowledges."""
        self.line.write(command)

    def open(self, *, reset: bool) -> None:
        """Open the line, and have the unit quiet."""
        self.line.open()
        if reset and self.line.reset_device():
            time.sleep(AFTER_RESET_S)
        self.quieten()

    def quieten(self) -> None:
        """End whatever the unit is sending."""
        self.tell(bytes([commands.POINT]))
        time.sleep(self._quiet_s)
        self.line.drop_input()

    def ask(self, parameter: int) -> bytes:
        """The value of a parameter.

        Raises:
            DeviceError: No answer comes.
        """
        size = commands.SIZES[parameter]
        for _ in range(ATTEMPTS):
            self.line.drop_input()
            self.tell(commands.examine(parameter))
            value = self.line.read_exactly(size, REPLY_S + size * self._byte_s)
            if len(value) == size:
                return value
        raise DeviceError(
            f"{self.path}: no answer to examine parameter {parameter}; check the power, the fly "
            "switch, the cable and the baud rate (DIP switches)"
        )

    def identity(self) -> dict[str, str]:
        """Model and firmware."""
        firmware = self.ask(commands.FIRMWARE)
        model = self.ask(commands.MODEL).decode("ascii", "replace").strip()
        return {"model": model, "firmware": f"{firmware[0]}.{firmware[1]}"}

    def auto_configure(self, units: int, settle_s: float) -> None:
        """Have the master find the other units; the line stays idle before and after."""
        time.sleep(settle_s)
        self.tell(commands.change(commands.AUTO_CONFIG, units))
        time.sleep(settle_s)
        self.line.drop_input()

    def check(self, settings: FlockSettings) -> None:
        """Check that all units run and none has an error.

        Raises:
            DeviceError: One is missing, or reports an error.
        """
        code = self.ask(commands.ERROR)[0]
        if code:
            unit = self.ask(commands.EXPANDED_ERROR)[0]
            raise DeviceError(f"{self.path}: {commands.error_text(code, unit)}")
        if settings.units == 1:
            return
        status = self.ask(commands.FLOCK_STATUS)
        for address in settings.addresses:
            bits = status[address - 1]
            if not bits & commands.ACCESSIBLE or not bits & commands.RUNNING:
                found = sum(bool(each & commands.ACCESSIBLE) for each in status)
                raise DeviceError(
                    f"{self.path}: unit {address} of {settings.units} does not run; {found} are "
                    "there. Check its fly switch and address, and birds= and erc= of the address"
                )

    def stream(self, every: int) -> None:
        """Have the unit send every nth cycle."""
        self.tell(bytes([commands.EVERY[every], commands.STREAM]))

    def records(self, timeout_s: float) -> list[Record]:
        """The records that come within a wait, or that the idle line shows to be whole."""
        data = self.line.read(timeout_s)
        if data:
            return self.parser.feed(data, time.monotonic())
        return self.parser.settle()

    def poll(self) -> None:
        """Ask for one cycle; what came too late for the last one is forgotten."""
        if self._late:
            self.line.drop_input()
        self.parser.clear()
        self.tell(bytes([commands.POINT]))

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
