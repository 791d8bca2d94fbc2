"""What the simulated trackers share: a thread that attends to lines and to a measuring clock."""

import select
import threading
import time
from abc import ABC, abstractmethod
from typing import Self

from extractors.devices.motion_source import MotionSource, Poses

IDLE_S = 0.02
"""Longest wait for anything [s]."""

HELD_UP_S = 0.25
"""A simulator that did not run for longer was held up by its computer [s]: its clock stood still,
too. Else it would send at once what a line carries in all that time, and ports overrun by it."""


class Simulator(ABC):
    """A simulated tracker in a thread of its own, as a context manager.

    One has ``_plug`` and ``_unplug``, ``_handles`` (what to listen to), ``_wait_s`` (until
    something is due), ``_attend`` (listen and send) and ``_measure`` (one measuring cycle).

    Args:
        motion: What is measured.
        rate_hz: Measuring cycles a second.
    """

    def __init__(self, motion: MotionSource, rate_hz: float) -> None:
        self._motion = motion
        self._rate_hz = rate_hz
        self._cycle = 0
        self._start_s = self._next_s = self._ran_s = time.monotonic()
        self._lock = threading.Lock()
        self._running = False
        self._thread = threading.Thread(target=self._run, daemon=True)

    @property
    @abstractmethod
    def place(self) -> str:
        """The place in a device address."""

    def start(self) -> None:
        """Plug it in, and measure."""
        self._plug()
        self._running = True
        self._start_s = self._next_s = self._ran_s = time.monotonic()
        self._thread.start()

    def stop(self) -> None:
        """End, and let go of lines and ports."""
        self._running = False
        self._thread.join()
        self._remove()

    def unplug(self) -> None:
        """Pull all plugs."""
        with self._lock:
            self._unplug()

    def replug(self) -> None:
        """Put the plugs back; the tracker has forgotten what it was told."""
        with self._lock:
            self._plug()

    def __enter__(self) -> Self:
        """Start it."""
        self.start()
        return self

    def __exit__(self, *_: object) -> None:
        """Stop it."""
        self.stop()

    def _run(self) -> None:
        while self._running:
            with self._lock:
                handles, wait_s = self._handles(), self._wait_s()
            if handles:
                ready = select.select(handles, [], [], wait_s)[0]
            else:
                time.sleep(IDLE_S)
                ready = []
            with self._lock:
                self._stand_still(time.monotonic())
                self._attend(set(ready).intersection(self._handles()))
                self._catch_up()

    def _stand_still(self, now_s: float) -> None:
        """Put clocks back by the time in which the simulator was held up."""
        held_up_s, self._ran_s = now_s - self._ran_s, now_s
        if held_up_s > HELD_UP_S:
            self._start_s += held_up_s
            self._next_s += held_up_s
            self._hold_lines(held_up_s)

    def _catch_up(self) -> None:
        """Every measuring cycle that is due."""
        now = time.monotonic()
        while self._next_s <= now:
            self._measure(self._next_s)
            self._cycle += 1
            self._next_s += 1.0 / self._rate_hz

    def _poses(self, at_s: float) -> Poses:
        return self._motion.poses(at_s - self._start_s)

    def _wait_s(self) -> float:
        return min(IDLE_S, max(0.0, self._next_s - time.monotonic()))

    def _remove(self) -> None:
        self._unplug()

    def _hold_lines(self, held_up_s: float) -> None:  # noqa: B027  # networks have no speed
        """Carry nothing for so long [s]."""

    @abstractmethod
    def _plug(self) -> None:
        """Open what a program connects to."""

    @abstractmethod
    def _unplug(self) -> None:
        """Close it, as a device that goes away."""

    @abstractmethod
    def _handles(self) -> list[int]:
        """File descriptors that may have something to attend to."""

    @abstractmethod
    def _attend(self, ready: set[int]) -> None:
        """Answer what came in at the handles that are ready."""

    @abstractmethod
    def _measure(self, at_s: float) -> None:
        """Send what is due at this time of the monotonic clock [s]."""
