"""Long work in the background: one job at a time, with its progress and a way to end it."""

import ctypes
import sys
import threading
import time
import traceback
from collections.abc import Callable
from typing import Any

from capar.model.errors import CaparError

UNEXPECTED = "this failed for a reason that is a fault of capar: {}"

#: After this long, work is stopped again whose end got lost in a finalizer [s].
STOPPED_AGAIN_S = 0.05


class Stopped(BaseException):
    """Raised inside of work that is to end; what it began to write is left out or removed."""


def problem(error: Exception) -> str:
    """What a person reads about an error; of a fault of ours the terminal shows more."""
    if isinstance(error, CaparError):
        return str(error)
    if isinstance(error, OSError):
        named = f"{error.filename}: " if error.filename else ""
        return f"{named}cannot be used: {error.strerror or error}"
    traceback.print_exception(error, file=sys.stderr)
    return UNEXPECTED.format(f"{type(error).__name__}: {error}")


class Jobs:
    """Runs work in a thread of its own.

    Args:
        show: Called with what is being done, and which share of it is done [1], from any thread;
            with an empty text when nothing is.
    """

    def __init__(self, show: Callable[[str, float], None] = lambda what, share: None) -> None:
        self.show = show
        self._lock = threading.Lock()
        self._stoppable: threading.Thread | None = None
        self._last: threading.Thread | None = None
        self._title = ""

    @property
    def running(self) -> str:
        """What is being done; empty where nothing is."""
        return self._title

    def start(
        self,
        title: str,
        work: Callable[[Callable[[str, float], None]], Any],
        done: Callable[[Any], None],
        failed: Callable[[str], None],
    ) -> None:
        """Begin work, which may be stopped until its result is handed on to ``done``.

        It is given a function that reports what is done now, and which share. What went wrong, or
        that it was stopped, is handed to ``failed``.

        Raises:
            CaparError: Something else is still being done.
        """
        with self._lock:
            if self._title:
                raise CaparError(f"{self._title}: wait until that is done, or stop it first")
            self._title = title
        self.show(title, 0.0)

        def report(what: str, share: float) -> None:
            self.show(f"{title}: {what}", share)

        told_before = sys.unraisablehook

        def lost(unraisable: "sys.UnraisableHookArgs") -> None:
            if unraisable.exc_type is Stopped:
                job = threading.current_thread()
                threading.Timer(STOPPED_AGAIN_S, self._stop, [job]).start()
            else:
                told_before(unraisable)

        def run() -> None:
            message, result = "", None
            try:
                sys.unraisablehook = lost
                try:
                    result = work(report)
                except Exception as error:
                    message = problem(error)
                with self._lock:
                    self._stoppable = None
            except Stopped:
                message = "stopped; nothing was kept"
            sys.unraisablehook = told_before
            with self._lock:
                self._title, self._stoppable = "", None
            self.show("", 1.0)
            if not message:
                try:
                    done(result)  # which may begin something else
                except Exception as error:
                    message = problem(error)
            if message:
                failed(message)

        with self._lock:
            self._stoppable = self._last = threading.Thread(target=run, name=title, daemon=True)
            self._last.start()

    def stop(self) -> bool:
        """End what is being done at its next line of Python; whether there was anything to end.

        Python drops what is raised in a finalizer, so that what is lost there is raised again.
        """
        return self._stop(self._stoppable)

    def _stop(self, job: threading.Thread | None) -> bool:
        with self._lock:
            if job is None or job is not self._stoppable or job.ident is None:
                return False
            ctypes.pythonapi.PyThreadState_SetAsyncExc(
                ctypes.c_ulong(job.ident), ctypes.py_object(Stopped)
            )
            return True

    def wait(self, seconds: float = 60.0) -> None:
        """Wait until nothing is being done, what follows from it included."""
        end = time.monotonic() + seconds
        while self._last and self._last.is_alive() and (left := end - time.monotonic()) > 0.0:
            self._last.join(left)
