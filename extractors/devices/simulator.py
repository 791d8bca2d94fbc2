"""What the simulated trackers share: a motion, a clock in a thread, and a pseudo-terminal."""

import os
import pty
import random
import select
import tempfile
import threading
import time
import tty
from abc import ABC, abstractmethod
from contextlib import suppress
from dataclasses import dataclass, field
from pathlib import Path
from typing import Protocol, Self

import numpy as np
from jaxtyping import Float
from scipy.spatial.transform import Rotation

from capar.model.capture import Capture
from capar.model.errors import DeviceError, UnknownNameError

Poses = tuple[Float[np.ndarray, "sensors 3"], Float[np.ndarray, "sensors 4"]]


class MotionSource(Protocol):
    """Poses of some sensors at any time."""

    @property
    def sensors(self) -> tuple[str, ...]:
        """Their names."""

    def poses(self, time_s: float) -> Poses:
        """Positions [m] and orientations (w x y z), z up, at a time [s]."""


@dataclass(frozen=True)
class SmoothMotion:
    """Every sensor goes round a path of its own, turning, within half a metre of the tracker."""

    count: int

    @property
    def sensors(self) -> tuple[str, ...]:
        """``sensor1`` and so on."""
        return tuple(f"sensor{index + 1}" for index in range(self.count))

    def poses(self, time_s: float) -> Poses:
        """Positions [m] and orientations (w x y z), z up, at a time [s]."""
        index = np.arange(self.count)
        phase = 2.0 * np.pi * time_s * 0.3 + 0.5 * index
        swing = np.stack([np.sin(phase), np.sin(2.0 * phase + 1.0), np.cos(phase)], axis=1)
        positions = np.array([0.3, 0.0, 0.0]) + swing * [0.15, 0.3, 0.25]
        angles = np.stack([phase, 0.8 * np.sin(phase), 0.5 * np.cos(2.0 * phase)], axis=1)
        turns = Rotation.from_euler("ZYX", angles)
        return positions, turns.as_quat(scalar_first=True)


class CapturedMotion:
    """A capture's bodies, played again and again; a lost body stays where it was seen last.

    Args:
        capture: What is played.
        names: Which of its sensors and objects; all, where it is empty.

    Raises:
        UnknownNameError: The capture has no body of a name.
        DeviceError: A body was never seen.
    """

    def __init__(self, capture: Capture, names: tuple[str, ...] = ()) -> None:
        for name in names:
            if name not in capture.bodies:
                raise UnknownNameError("body", name, capture.bodies, where=capture.name)
        self._names = names or tuple(capture.bodies)
        self._times = capture.times - capture.times[0]
        streams = [capture.bodies[name].stream for name in self._names]
        for name, stream in zip(self._names, streams, strict=True):
            if stream.lost.all():
                raise DeviceError(f"{name} is lost throughout {capture.name}; leave it out")
        seen = [_last_seen(stream.lost) for stream in streams]
        self._positions = np.stack(
            [each.positions[at] for each, at in zip(streams, seen, strict=True)], axis=1
        )
        self._orientations = np.stack(
            [each.orientations[at] for each, at in zip(streams, seen, strict=True)], axis=1
        )

    @property
    def sensors(self) -> tuple[str, ...]:
        """The bodies' names."""
        return self._names

    def poses(self, time_s: float) -> Poses:
        """Positions [m] and orientations (w x y z), z up, of the last frame before a time [s]."""
        step_s = self._times[-1] / (len(self._times) - 1)
        within = time_s % (self._times[-1] + step_s)
        frame = int(np.searchsorted(self._times, within, side="right")) - 1
        return self._positions[frame], self._orientations[frame]


def _last_seen(lost: np.ndarray) -> np.ndarray:
    """For each frame the last one that was not lost; before the first, the first."""
    seen = np.flatnonzero(~lost)
    return seen[np.maximum(np.searchsorted(seen, np.arange(len(lost)), side="right") - 1, 0)]


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


BITS = 10
"""Bits of a byte on an 8N1 line."""


@dataclass(frozen=True)
class Faults:
    """What goes wrong with what the device sends."""

    lost_share: float = 0.0
    """Share of the bytes that are lost."""

    garbled_share: float = 0.0
    """Share of the bytes of which one bit is turned over."""

    wrong_address_share: float = 0.0
    """Share of the records that carry the address of a bird that is not there."""

    reply_delay_s: float = 0.0
    """How much later than usual a poll is answered [s]."""

    seed: int = 0


@dataclass(frozen=True, slots=True)
class Sent:
    """A record that a simulator sent."""

    address: int
    data: bytes
    """Its bytes before any fault."""

    intact: bool
    """Whether all of them went out as they were."""


@dataclass
class SimulatedLine:
    """The device's end of a line; the other end is a device file whose path does not change."""

    baud: int
    faults: Faults = field(default_factory=Faults)
    master: int = -1
    _slave: int = -1
    _queue: bytearray = field(default_factory=bytearray)
    _sent_until_s: float = 0.0

    def __post_init__(self) -> None:
        """Make the folder of the device file."""
        self._folder = tempfile.TemporaryDirectory(prefix="capar-simulated-")
        self.path = str(Path(self._folder.name) / "port")
        self._random = random.Random(self.faults.seed)

    @property
    def byte_s(self) -> float:
        """Time of a byte on the line [s]."""
        return BITS / self.baud

    @property
    def busy(self) -> bool:
        """Whether something is queued."""
        return bool(self._queue)

    @property
    def free_at_s(self) -> float:
        """When what is queued will have gone out [s]."""
        return self._sent_until_s + len(self._queue) * self.byte_s

    def plug(self) -> None:
        """Make the device file, raw from the start."""
        self.master, self._slave = pty.openpty()
        tty.setraw(self._slave)
        os.set_blocking(self.master, False)
        Path(self.path).symlink_to(os.ttyname(self._slave))
        self._queue.clear()

    def unplug(self) -> None:
        """Pull the plug: the other end fails, and the device file is gone."""
        Path(self.path).unlink(missing_ok=True)
        for handle in (self.master, self._slave):
            if handle >= 0:
                os.close(handle)
        self.master = self._slave = -1
        self._queue.clear()

    def remove(self) -> None:
        """Unplug, and remove what was made."""
        self.unplug()
        self._folder.cleanup()

    def receive(self) -> bytes:
        """What the other end has sent."""
        with suppress(OSError):
            return os.read(self.master, 4096)
        return b""

    def send(self, data: bytes, at_s: float) -> bool:
        """Queue bytes that the device has at a moment [s]; whether all go out as they are."""
        if not self._queue:
            self._sent_until_s = max(self._sent_until_s, at_s)
        spoilt = bytes(_spoil(data, self.faults, self._random))
        self._queue += spoilt
        return spoilt == data

    def chance(self) -> float:
        """A random share, for faults of whole records."""
        return self._random.random()

    def pump(self, now_s: float) -> None:
        """Let out the bytes that the line's speed has carried by now."""
        due = min(len(self._queue), int((now_s - self._sent_until_s) / self.byte_s))
        if due <= 0:
            return
        try:
            written = os.write(self.master, self._queue[:due])
        except OSError:  # nobody reads: what the port cannot hold is overrun
            written = due
        del self._queue[:written]
        self._sent_until_s += written * self.byte_s

    def hold(self, held_up_s: float) -> None:
        """Carry nothing for so long [s]."""
        self._sent_until_s += held_up_s

    def forget(self) -> None:
        """Drop what is queued."""
        self._queue.clear()


def _spoil(data: bytes, faults: Faults, source: random.Random) -> list[int]:
    if not faults.lost_share and not faults.garbled_share:
        return list(data)
    out = []
    for byte in data:
        if source.random() < faults.lost_share:
            continue
        garbled = source.random() < faults.garbled_share
        out.append(byte ^ 1 << source.randrange(8) if garbled else byte)
    return out
