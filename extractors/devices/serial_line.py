"""A serial port as the drivers need it; the only module that knows pyserial."""

import time

import serial
from serial.tools.list_ports import comports

from capar.model.errors import DeviceError
from extractors.devices.tracker import DeviceLostError


def _failures() -> tuple[type[Exception], ...]:
    """What a port raises when its device is gone, or cannot be set as it should."""
    usual: tuple[type[Exception], ...] = (OSError, serial.SerialException, ValueError, TypeError)
    try:
        import termios
    except ImportError:  # pragma: no cover
        return usual
    return (*usual, termios.error)  # which is neither of the others


FAILURES = _failures()
RESET_S = 1.0
"""How long RTS is held to reset a Flock of Birds [s]."""


class SerialLine:
    """An 8N1 port without flow control, whose failures are errors of ours.

    Args:
        port: The device file, or the port's name.
        baud: Its speed [bits a second].
    """

    def __init__(self, port: str, baud: int) -> None:
        self._port_name = port
        self._port = serial.Serial()
        self._port.port = port
        self._port.baudrate = baud
        self._port.timeout = 0.1
        self._port.write_timeout = 1.0
        # To open a port asserts RTS unless it is cleared before, which resets a Flock of Birds.
        self._port.rts = False

    def open(self) -> None:
        """Open the port; what it had received before is dropped.

        Raises:
            DeviceError: There is no such port, or it may not be used.
        """
        try:
            self._port.open()
        except FAILURES as error:
            raise DeviceError(
                f"cannot open {self._port_name}: {error}. Is the device plugged in, and may this "
                "user open it (group dialout)?"
            ) from None

    def read(self, timeout_s: float) -> bytes:
        """What has arrived, after at most a wait for the first byte [s].

        Raises:
            DeviceLostError: The port is gone.
        """
        try:
            self._port.timeout = max(0.0, timeout_s)
            return self._port.read(self._port.in_waiting or 1)
        except FAILURES as error:
            raise DeviceLostError(f"{self._port_name} is gone ({error})") from None

    def read_exactly(self, count: int, timeout_s: float) -> bytes:
        """A number of bytes, or fewer if they do not arrive in time.

        Raises:
            DeviceLostError: The port is gone.
        """
        deadline, out = time.monotonic() + timeout_s, b""
        while len(out) < count and time.monotonic() < deadline:
            out += self.read(min(0.05, deadline - time.monotonic()))
        return out

    def write(self, data: bytes) -> None:
        """Send bytes.

        Raises:
            DeviceLostError: The port is gone.
        """
        try:
            self._port.write(data)
        except FAILURES as error:
            raise DeviceLostError(f"{self._port_name} is gone ({error})") from None

    def drop_input(self) -> None:
        """Forget what has arrived.

        Raises:
            DeviceLostError: The port is gone.
        """
        try:
            self._port.reset_input_buffer()
        except FAILURES as error:
            raise DeviceLostError(f"{self._port_name} is gone ({error})") from None

    def reset_device(self) -> bool:
        """Reset a device by RTS; whether the port has that line."""
        try:
            self._port.rts = True
            time.sleep(RESET_S)
            self._port.rts = False
        except FAILURES:  # a pseudo-terminal has no modem lines
            return False
        return True

    def close(self) -> None:
        """Let go of the port, whatever state it is in."""
        try:
            self._port.close()
        except FAILURES:
            return


def find_ports() -> dict[str, str]:
    """The serial ports of this computer, and what is plugged into each."""
    return {each.device: each.description for each in sorted(comports())}
