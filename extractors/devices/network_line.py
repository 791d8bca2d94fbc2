"""TCP and UDP connections as the drivers need them."""

import select
import socket

from capar.model.errors import DeviceError
from extractors.devices.tracker import DeviceLostError

CONNECT_S = 3.0
LARGEST = 65536
RECEIVED = 1 << 20
"""Bytes of datagrams that may wait while this computer is busy, as far as its system allows."""


class NetworkLine:
    """A connection to a host, whose failures are errors of ours.

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
                self._socket = self._datagrams()
        except OSError as error:
            raise DeviceError(
                f"cannot reach {self._where}: {error}. Is the server on, and the name right?"
            ) from None

    def _datagrams(self) -> socket.socket:
        family, kind, *_, to = socket.getaddrinfo(*self._to, type=socket.SOCK_DGRAM)[0]
        out = socket.socket(family, kind)
        out.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, RECEIVED)
        out.connect(to)
        return out

    def read(self, timeout_s: float) -> bytes:
        """What has arrived, or one datagram, after at most a wait [s]; empty if nothing has.

        Raises:
            DeviceLostError: The connection is gone.
        """
        if self._socket is None:
            raise DeviceLostError(f"{self._where} is closed")
        try:
            if not select.select([self._socket], [], [], max(0.0, timeout_s))[0]:
                return b""
            data = self._socket.recv(LARGEST)
        except (OSError, ValueError) as error:
            raise DeviceLostError(f"{self._where} is gone ({error})") from None
        if not data and self._is_stream:
            raise DeviceLostError(f"{self._where} has closed the connection")
        return data

    def write(self, data: bytes) -> None:
        """Send bytes.

        Raises:
            DeviceLostError: The connection is gone.
        """
        if self._socket is None:
            raise DeviceLostError(f"{self._where} is closed")
        try:
            self._socket.sendall(data)
        except OSError as error:
            raise DeviceLostError(f"{self._where} is gone ({error})") from None

    def close(self) -> None:
        """Let go of the connection."""
        if self._socket is not None:
            self._socket.close()
            self._socket = None
