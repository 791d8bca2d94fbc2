"""A serial line that is a pseudo-terminal: with a speed, faults to order, and a plug."""

import os
import pty
import random
import tempfile
import tty
from contextlib import suppress
from dataclasses import dataclass, field
from pathlib import Path

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
