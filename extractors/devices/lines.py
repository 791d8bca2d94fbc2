"""Serial ports and network connections as the drivers need them; only here pyserial is known."""

import select
import socket
import time
from collections.abc import Iterator
from contextlib import contextmanager, suppress

import serial
from serial.tools.list_ports import comports

from capar.model.errors import DeviceError
from extractors.devices.tracker import DeviceLostError

BITS = 10  # Bits of a byte on an 8N1 line: start, eight of data, stop.
BAUDS = (2400, 4800, 9600, 19200, 38400, 57600, 115200)
"""Speeds of the trackers' serial lines [bits a second]."""

RESET_S = 1.0  # How long RTS is held to reset a Flock of Birds [s].
CONNECT_S = 3.0
LARGEST = 65536
RECEIVED = 1 << 20
"""Bytes of datagrams that may wait while this computer is busy, as far as its system allows."""


FAILURES: tuple[type[Exception], ...] = (OSError, ValueError, TypeError)
"""What a port raises when its device is gone, or cannot be set as it should."""

with suppress(ImportError):  # only Unix has it; its error is none of the others
    import termios

    FAILURES += (termios.error,)


@contextmanager
def _present(name: str) -> Iterator[None]:
    """Report that the device of this name is gone."""
    try:
        yield
    except FAILURES as error:
        raise DeviceLostError(f"{name} is gone ({error})") from None


class SerialLine:
    """An 8N1 port without flow control; where it is gone, its methods raise ``DeviceLostError``.

    Args:
        port: The device file, or the port's name.
        baud: Its speed [bits a second].
    """

    def __init__(self, port: str, baud: int) -> None:
        self._name = port
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
                f"cannot open {self._name}: {error}. Is the device plugged in, and may this "
                "user open it (group dialout)?"
            ) from None

    def read(self, timeout_s: float) -> bytes:
        """What has arrived, after at most a wait for the first byte [s]."""
        with _present(self._name):
            self._port.timeout = max(0.0, timeout_s)
            return self._port.read(self._port.in_waiting or 1)

    def read_exactly(self, count: int, timeout_s: float) -> bytes:
        """A number of bytes, or fewer if they do not arrive in time [s]."""
        deadline, out = time.monotonic() + timeout_s, b""
        while len(out) < count and time.monotonic() < deadline:
            out += self.read(min(0.05, deadline - time.monotonic()))
        return out

    def write(self, data: bytes) -> None:
        """Send bytes."""
        with _present(self._name):
            self._port.write(data)

    def drop_input(self) -> None:
        """Forget what has arrived."""
        with _present(self._name):
            self._port.reset_input_buffer()

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
        with suppress(*FAILURES):
            self._port.close()


def find_ports() -> dict[str, str]:
    """The serial ports of this computer, and what is plugged into each."""
    return {each.device: each.description for each in sorted(comports())}


class NetworkLine:
    """A connection to a host; where it is gone, its methods raise ``DeviceLostError``.

    Args:
        host: Name or number.
        port: Port.
        stream: Whether TCP or UDP.
    """

    def __init__(self, host: str, port: int, *, stream: bool = True) -> None:
        self._where = f"{host}:{port} ({'TCP' if stream else 'UDP'})"
        self._to = (host, port)
        self._is_stream = stream
        self._socket: socket.socket | None = None

    def open(self) -> None:
        """Connect.

        Raises:
            DeviceError: Nothing answers there.
        """
        try:
            if self._is_stream:
                self._socket = socket.create_connection(self._to, timeout=CONNECT_S)
                self._socket.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
            else:
                family, kind, *_, to = socket.getaddrinfo(*self._to, type=socket.SOCK_DGRAM)[0]
                self._socket = socket.socket(family, kind)
                self._socket.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, RECEIVED)
                self._socket.connect(to)
        except OSError as error:
            raise DeviceError(
                f"cannot reach {self._where}: {error}. Is the server on, and the name right?"
            ) from None

    def _opened(self) -> socket.socket:
        if self._socket is None:
            raise DeviceLostError(f"{self._where} is closed")
        return self._socket

    def read(self, timeout_s: float) -> bytes:
        """What has arrived, or one datagram, after at most a wait [s]; empty if nothing has."""
        with _present(self._where):
            if not select.select([self._opened()], [], [], max(0.0, timeout_s))[0]:
                return b""
            data = self._opened().recv(LARGEST)
        if not data and self._is_stream:
            raise DeviceLostError(f"{self._where} has closed the connection")
        return data

    def write(self, data: bytes) -> None:
        """Send bytes."""
        with _present(self._where):
            self._opened().sendall(data)

    def close(self) -> None:
        """Let go of the connection."""
        if self._socket is not None:
            self._socket.close()
            self._socket = None
