"""Events over a websocket on loopback: one JSON object a message (extra ``live``: websockets)."""

import queue
import re
import threading
from collections import deque
from typing import Any

from capar.model.errors import DeviceError

HOST = "127.0.0.1"  # Nobody else in the network may listen.
ORIGINS = (None, re.compile(r"https?://(localhost|127\.0\.0\.1|\[::1\])(:\d{1,5})?"))
"""Who may listen: programs, which name no origin, and pages that this computer serves. A page of
another site, open in a browser here, reaches loopback too; the browser says where it is from."""

LATEST = 1000  # So many events a program that connects late is still told [1].
WAITING = 10_000  # A program that has so many events not read yet is disconnected [1].
LAST_S = 2.0  # So long programs may take to read the last events once the recording has ended [s].


class EventSocket:
    """A websocket server that tells every program that connects what is announced.

    Pages of other sites are refused (``ORIGINS``). Who connects first gets the latest events
    before, then each one as it comes. When it closes, programs are disconnected in the ordinary
    way, after the last event.

    Raises:
        DeviceError: The library is missing, or the port is in use.
    """

    def __init__(self, port: int) -> None:
        try:
            from websockets.sync.server import serve
        except ImportError as error:
            raise DeviceError(
                f"the library of websockets is not installed ({error}); install capar[live]"
            ) from None
        self._lock = threading.Lock()
        self._latest: deque[str] = deque(maxlen=LATEST)
        self._listeners: dict[Any, queue.Queue[str | None]] = {}
        self._threads: set[threading.Thread] = set()
        self._closed = False
        try:
            self._server: Any = serve(self._serve, HOST, port, origins=ORIGINS)
        except OSError as error:
            raise DeviceError(
                f"no websocket at {HOST}:{port} ({error.strerror}); name another port, or 0 for "
                "one that is free"
            ) from None
        self._thread = threading.Thread(target=self._server.serve_forever, daemon=True)
        self._thread.start()

    @property
    def address(self) -> str:
        """Where programs connect."""
        host, port = self._server.socket.getsockname()[:2]
        return f"ws://{host}:{port}"

    def send(self, line: str) -> None:
        """Tell every program that is connected one more event, as JSON."""
        with self._lock:
            self._latest.append(line)
            for connection, waiting in list(self._listeners.items()):
                try:
                    waiting.put_nowait(line)
                except queue.Full:
                    del self._listeners[connection]
                    connection.close_socket()

    def close(self) -> None:
        """End after the last event; waits for programs that still read, up to ``LAST_S``."""
        with self._lock:
            self._closed = True
            threads = list(self._threads)
            for waiting in self._listeners.values():
                waiting.put(None)
        for thread in threads:
            thread.join(LAST_S)
        self._server.shutdown()
        self._thread.join(LAST_S)

    def _serve(self, connection: Any) -> None:
        """Send events to one program until the recording ends or it leaves."""
        from websockets.exceptions import ConnectionClosed

        waiting: queue.Queue[str | None] = queue.Queue(WAITING)
        with self._lock:
            for line in self._latest:
                waiting.put(line)
            if self._closed:
                waiting.put(None)
            self._listeners[connection] = waiting
            self._threads.add(threading.current_thread())
        try:
            while (event := waiting.get()) is not None:
                connection.send(event)
        except ConnectionClosed:
            pass
        finally:
            with self._lock:
                self._listeners.pop(connection, None)
                self._threads.discard(threading.current_thread())
