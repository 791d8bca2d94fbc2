"""One writer at a time for a folder; the lock ends with its process, however that ends."""

import fcntl
import json
import os
import socket
import time
from datetime import UTC, datetime
from pathlib import Path

from kb.errors import LockedError

POLL_S = 0.05
"""How often a waiting writer looks again [s]."""


class WriterLock:
    """The right to write a store's folder, held from construction to release.

    The system releases the lock of a process that ends in any way; the text that a killed
    process left in the file does not count.
    """

    def __init__(self, folder: Path, *, wait_s: float = 0.0) -> None:
        """Take the lock.

        Args:
            folder: The folder of the store, which exists.
            wait_s: How long to wait for another writer [s].

        Raises:
            LockedError: Another process holds it for longer than that.
        """
        self._path = folder / "writer.lock"
        self._file = os.open(self._path, os.O_RDWR | os.O_CREAT | os.O_CLOEXEC, 0o644)
        try:
            self._take(time.monotonic() + wait_s)
        except LockedError:
            os.close(self._file)
            raise
        text = json.dumps(
            {
                "pid": os.getpid(),
                "host": socket.gethostname(),
                "since": datetime.now(UTC).isoformat(timespec="seconds"),
            }
        )
        os.ftruncate(self._file, 0)
        os.pwrite(self._file, text.encode(), 0)

    def _take(self, deadline: float) -> None:
        while True:
            try:
                fcntl.flock(self._file, fcntl.LOCK_EX | fcntl.LOCK_NB)
                return
            except BlockingIOError:
                if time.monotonic() >= deadline:
                    raise LockedError(str(self._path.parent), self._holder()) from None
            time.sleep(POLL_S)

    def _holder(self) -> str:
        try:
            seen = json.loads(os.pread(self._file, 4096, 0))
            return f"process {seen['pid']} on {seen['host']}, since {seen['since']},"
        except (ValueError, KeyError, TypeError):
            return "another process"

    def release(self) -> None:
        """Release the lock; safe to call twice."""
        if self._file >= 0:
            os.ftruncate(self._file, 0)
            os.close(self._file)
            self._file = -1
