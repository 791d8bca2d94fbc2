"""What simulated trackers share: a motion, a clock in a thread, and what programs connect to."""

import os
import pty
import random
import select
import socket
import tempfile
import threading
import time
import tty
from abc import ABC, abstractmethod
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path
from typing import Generic, Protocol, Self, TypeVar

import numpy as np
from jaxtyping import Float
from scipy.spatial.transform import Rotation

from capar.model.capture import Capture
from capar.model.errors import DeviceError, UnknownNameError
from extractors.devices.lines import BITS

IDLE_S = 0.02  # Longest wait for anything [s].
BYTE_S = BITS / 115200  # Time of a byte on a simulated line [s].
TICK_S = 0.002  # How often a serial line that has something to send is attended to [s].
HELD_UP_S = 0.25
"""A simulator that did not run for longer was held up by its computer [s]: its clock stood still,
too. Else it would send at once what a line carries in all that time, and ports overrun by it."""

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
        self.sensors = names or tuple(capture.bodies)
        self._times = capture.times - capture.times[0]
        positions, orientations = [], []
        for name in self.sensors:
            stream = capture.bodies[name].stream
            seen = np.flatnonzero(~stream.lost)
            if not seen.size:
                raise DeviceError(f"{name} is lost throughout {capture.name}; leave it out")
            last = np.searchsorted(seen, np.arange(len(stream.times)), side="right") - 1
            at = seen[np.maximum(last, 0)]
            positions.append(stream.positions[at])
            orientations.append(stream.orientations[at])
        self._positions = np.stack(positions, axis=1)
        self._orientations = np.stack(orientations, axis=1)

    def poses(self, time_s: float) -> Poses:
        """Positions [m] and orientations (w x y z), z up, of the last frame before a time [s]."""
        step_s = self._times[-1] / (len(self._times) - 1)
        within = time_s % (self._times[-1] + step_s)
        frame = int(np.searchsorted(self._times, within, side="right")) - 1
        return self._positions[frame], self._orientations[frame]


@dataclass(frozen=True)
class Faults:
    """What goes wrong with what a device sends."""

    lost_share: float = 0.0
    """Share of the bytes, or of a network's data packets, that are lost."""

    garbled_share: float = 0.0
    """Share of the bytes of which one bit is turned over."""

    wrong_address_share: float = 0.0
    """Share of the records that carry the address of a bird that is not there."""

    error: int = 0
    """Error code that a flock or a MotionStar reports."""

    numbered: bool = True
    """Whether a MotionStar's data packets have sequence numbers of their own."""

    seed: int = 0


@dataclass(frozen=True, slots=True)
class Sent:
    """A record, or the body of a network's data packet, that a simulator sent."""

    address: int
    data: bytes
    """Its bytes before any fault."""

    intact: bool = True
    """Whether all of them went out as they were."""


class Simulator(ABC):
    """A simulated tracker in a thread of its own, as a context manager.

    One has ``_plug`` and ``_unplug``, ``_handles`` (what to listen to), ``_wait_s`` (until
    something is due), ``_attend`` (listen and send) and ``_measure`` (one measuring cycle).

    Args:
        motion: What is measured.
        rate_hz: Measuring cycles a second.
        faults: What goes wrong.
        log: Where everything that is sent is kept, if anywhere.
    """

    def __init__(
        self, motion: MotionSource, rate_hz: float, faults: Faults, log: list[Sent] | None
    ) -> None:
        self._motion = motion
        self._rate_hz = rate_hz
        self._faults = faults
        self._log = log
        self._cycle = 0
        self._start_s = self._next_s = self._ran_s = time.monotonic()
        self._lock = threading.Lock()
        self._running = False
        self._thread = threading.Thread(target=self._run, daemon=True)

    @property
    @abstractmethod
    def place(self) -> str:
        """The place in a device address."""

    def unplug(self) -> None:
        """Pull all plugs."""
        with self._lock:
            self._unplug()

    def replug(self) -> None:
        """Put the plugs back; the tracker has forgotten what it was told."""
        with self._lock:
            self._plug()

    def __enter__(self) -> Self:
        """Plug it in, and measure."""
        self._plug()
        self._running = True
        self._start_s = self._next_s = self._ran_s = time.monotonic()
        self._thread.start()
        return self

    def __exit__(self, *_: object) -> None:
        """End, and let go of lines and ports."""
        self._running = False
        self._thread.join()
        self._unplug()

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
                now = time.monotonic()
                held_up_s, self._ran_s = now - self._ran_s, now
                if held_up_s > HELD_UP_S:
                    self._stand_still(held_up_s)
                self._attend(set(ready).intersection(self._handles()))
                now = time.monotonic()
                while self._next_s <= now:
                    self._measure(self._next_s)
                    self._cycle += 1
                    self._next_s += 1.0 / self._rate_hz

    def _stand_still(self, held_up_s: float) -> None:
        """Put clocks back by the time in which the simulator was held up [s]."""
        self._start_s += held_up_s
        self._next_s += held_up_s

    def _poses(self, at_s: float) -> Poses:
        return self._motion.poses(at_s - self._start_s)

    def _sent(self, address: int, data: bytes, *, intact: bool = True) -> None:
        if self._log is not None:
            self._log.append(Sent(address, data, intact))

    def _wait_s(self) -> float:
        return min(IDLE_S, max(0.0, self._next_s - time.monotonic()))

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


class SimulatedLine:
    """The device's end of a serial line with a speed and faults; the other is a pseudo-terminal.

    Args:
        faults: What goes wrong with the bytes.
    """

    def __init__(self, faults: Faults) -> None:
        self._faults = faults
        self.handle = -1
        self._slave = -1
        self.queue = bytearray()
        self.sent_until_s = 0.0
        """When what was queued before has gone out [s]."""

        self.folder = tempfile.TemporaryDirectory(prefix="capar-simulated-")
        self.path = str(Path(self.folder.name) / "port")
        """The device file; it stays the same when the plug is pulled."""

        self.random = random.Random(faults.seed)
        self.commands = bytearray()
        """What the other end has sent, as far as it was not obeyed."""

        self.poll_at_s = -1.0
        """When a poll is to be answered [s]; negative where none is."""

    @property
    def busy(self) -> bool:
        """Whether something is queued, or a poll is to be answered."""
        return bool(self.queue) or self.poll_at_s >= 0.0

    def plug(self) -> None:
        """Make the device file, raw from the start."""
        self.handle, self._slave = pty.openpty()
        tty.setraw(self._slave)
        os.set_blocking(self.handle, False)
        Path(self.path).symlink_to(os.ttyname(self._slave))
        self.queue.clear()

    def unplug(self) -> None:
        """Pull the plug: the other end fails, and the device file is gone."""
        Path(self.path).unlink(missing_ok=True)
        for handle in (self.handle, self._slave):
            if handle >= 0:
                os.close(handle)
        self.handle = self._slave = -1
        self.queue.clear()
        self.commands.clear()

    def receive(self) -> bytes:
        """What the other end has sent; it is also added to ``commands``."""
        with suppress(OSError):
            data = os.read(self.handle, 4096)
            self.commands += data
            return data
        return b""

    def send(self, data: bytes, at_s: float) -> bool:
        """Queue bytes that the device has at a moment [s]; whether all go out as they are."""
        if not self.queue:
            self.sent_until_s = max(self.sent_until_s, at_s)
        spoilt = bytearray()
        for byte in data:
            if self.random.random() < self._faults.lost_share:
                continue
            garbled = self.random.random() < self._faults.garbled_share
            spoilt.append(byte ^ 1 << self.random.randrange(8) if garbled else byte)
        self.queue += spoilt
        return bytes(spoilt) == data

    def pump(self, now_s: float) -> None:
        """Let out the bytes that the line's speed has carried by now."""
        due = min(len(self.queue), int((now_s - self.sent_until_s) / BYTE_S))
        if due <= 0:
            return
        try:
            written = os.write(self.handle, self.queue[:due])
        except OSError:  # nobody reads: what the port cannot hold is overrun
            written = due
        del self.queue[:written]
        self.sent_until_s += written * BYTE_S

    def forget(self) -> None:
        """Drop what is queued."""
        self.queue.clear()


Line = TypeVar("Line", bound=SimulatedLine)


class SerialSimulator(Simulator, Generic[Line]):
    """A tracker on one or several simulated lines; a cycle for which one has no room is skipped.

    Args:
        motion: What is measured.
        rate_hz: Measuring cycles a second.
        lines: The lines, all with the same faults.
        log: Where every record that is sent is kept, if anywhere.
    """

    def __init__(
        self, motion: MotionSource, rate_hz: float, lines: list[Line], log: list[Sent] | None
    ) -> None:
        super().__init__(motion, rate_hz, lines[0]._faults, log)
        self.skipped = 0
        self._lines = lines

    @property
    def place(self) -> str:
        """The device files, divided by commas."""
        return ",".join(line.path for line in self._lines)

    def __exit__(self, *_: object) -> None:
        """End, and remove the device files."""
        super().__exit__()
        for line in self._lines:
            line.folder.cleanup()

    def _plug(self) -> None:
        self._power_up()
        for line in self._lines:
            line.plug()

    def _unplug(self) -> None:
        for line in self._lines:
            line.unplug()

    def _stand_still(self, held_up_s: float) -> None:
        super()._stand_still(held_up_s)
        for line in self._lines:
            line.sent_until_s += held_up_s

    def _handles(self) -> list[int]:
        return [line.handle for line in self._lines if line.handle >= 0]

    def _wait_s(self) -> float:
        return TICK_S if any(line.busy for line in self._lines) else super()._wait_s()

    def _attend(self, ready: set[int]) -> None:
        for line in self._lines:
            if line.handle in ready:
                self._listen(line)
        now = time.monotonic()
        for line in self._lines:
            if 0.0 <= line.poll_at_s <= now:
                line.poll_at_s = -1.0
                self._report(line, now)
            line.pump(time.monotonic())

    def _stream(self, line: Line, at_s: float, period_s: float) -> None:
        """Report a cycle, if the line has room for it."""
        if line.handle >= 0 and line.sent_until_s + len(line.queue) * BYTE_S - at_s > period_s:
            self.skipped += 1
        elif line.handle >= 0:
            self._report(line, at_s)

    @abstractmethod
    def _power_up(self) -> None:
        """Forget all settings."""

    @abstractmethod
    def _listen(self, line: Line) -> None:
        """Obey what came by a line."""

    @abstractmethod
    def _report(self, line: Line, at_s: float) -> None:
        """Send the records of a line's sensors at a time [s]."""


class ServerSimulator(Simulator):
    """A server on loopback with one TCP client at a time.

    Args:
        motion: What is measured.
        rate_hz: Measuring cycles a second.
        faults: What goes wrong.
        log: Where everything that is sent is kept, if anywhere.
        port: TCP port; 0 takes a free one.
    """

    def __init__(
        self,
        motion: MotionSource,
        rate_hz: float,
        faults: Faults,
        log: list[Sent] | None,
        port: int,
    ) -> None:
        super().__init__(motion, rate_hz, faults, log)
        self.port = port
        self._listening: socket.socket | None = None
        self._client: socket.socket | None = None

    @property
    def place(self) -> str:
        """Host and port."""
        return f"127.0.0.1:{self.port}"

    def _plug(self) -> None:
        self._listening = socket.create_server(("127.0.0.1", self.port))
        self.port = self._listening.getsockname()[1]

    def _unplug(self) -> None:
        if self._listening is not None:
            self._listening.close()
        self._listening = None
        self._drop()

    def _drop(self) -> None:
        """Let the client go."""
        if self._client is not None:
            self._client.close()
        self._client = None

    def _handles(self) -> list[int]:
        return [each.fileno() for each in (self._listening, self._client) if each is not None]

    def _attend(self, ready: set[int]) -> None:
        with suppress(OSError):
            if self._listening is not None and self._listening.fileno() in ready:
                self._client, _ = self._listening.accept()
                self._client.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
                self._welcome()
            elif self._client is not None and self._client.fileno() in ready:
                data = self._client.recv(65536)
                if data:
                    self._hear(data)
                else:
                    self._drop()

    def _put(self, data: bytes) -> None:
        """Send bytes to the client, if there is one."""
        with suppress(OSError):
            if self._client is not None:
                self._client.sendall(data)

    @abstractmethod
    def _welcome(self) -> None:
        """Begin with a client that has just connected."""

    @abstractmethod
    def _hear(self, data: bytes) -> None:
        """Take what the client sent."""
