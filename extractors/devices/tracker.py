"""What every live tracker gives: a description, and frames of poses with time stamps."""

import time
from abc import ABC, abstractmethod
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from types import MappingProxyType
from typing import Protocol, Self

import numpy as np
from jaxtyping import Float

from capar.model.errors import DeviceError

RETRY_S = 0.5
"""Pause between two attempts to reach a device that went away [s]."""

POLL_S = 0.1
"""Longest wait for a device's next bytes before anything else is attended to [s]."""


class DeviceLostError(DeviceError):
    """The connection broke off, or a device that was sending is silent."""


@dataclass(frozen=True)
class Description:
    """What a tracker says of itself once it is open."""

    kind: str
    """Name of the driver: ``flock``, ``motionstar``, ``fastrak``, ``vrpn`` or ``lsl``."""

    model: str
    sensors: tuple[str, ...]
    """Names of its sensors, in the order of a frame's rows."""

    rate_hz: float
    """Frames a second that it was told to send; NaN where it decides that itself."""

    has_positions: bool = True
    has_orientations: bool = True
    details: Mapping[str, str] = field(default_factory=dict)
    """What else it said: firmware, format, range ..."""

    def __post_init__(self) -> None:
        """Make the details read-only."""
        object.__setattr__(self, "details", MappingProxyType(dict(self.details)))


@dataclass(frozen=True, slots=True, eq=False)
class Frame:
    """The poses of all sensors in one measuring cycle, in a right-handed world, z up."""

    host_s: float
    """When its first byte arrived: seconds of this computer's monotonic clock."""

    device_s: float | None
    """The device's own time stamp [s], where it sends one."""

    positions: Float[np.ndarray, "sensors 3"]
    """Positions [m]; NaN for a sensor of which nothing was received."""

    orientations: Float[np.ndarray, "sensors 4"]
    """Unit quaternions w x y z, sensor to world; NaN for a sensor without one."""

    cycle: int | None = None
    """Number of the measuring cycle since the connection was made, where cycles are equally long
    and counted; numbers that are left out are cycles that were lost."""


@dataclass
class Counts:
    """What arrived and what did not, since the tracker was made."""

    frames: int = 0
    records: int = 0
    """Poses of single sensors that were accepted."""

    lost_records: int = 0
    """Poses that are known to be missing: the order, the sequence numbers or the time say so."""

    dropped_bytes: int = 0
    """Bytes of records that were damaged, or of no record."""

    refused_records: int = 0
    """Whole records that no tracker could have sent: a wrong address, a norm far from one."""

    reconnections: int = 0


@dataclass(frozen=True)
class Event:
    """Something that happened to the connection."""

    host_s: float
    message: str


class Tracker(Protocol):
    """A source of live poses."""

    counts: Counts
    events: list[Event]
    """What happened to the connection, oldest first."""

    def open(self) -> None:
        """Connect, and have the device send.

        Raises:
            DeviceError: It cannot be reached, or refuses; the message names the remedy.
        """

    def describe(self) -> Description:
        """What the device is, and its sensors."""

    def poll(self, timeout_s: float) -> list[Frame]:
        """The frames that have come since the last call, after at most a wait [s].

        A lost connection raises nothing: it is told in ``events`` and tried again.
        """

    def close(self) -> None:
        """Have the device stop, and let go of it."""


class LiveTracker(ABC):
    """What the drivers share: connecting again, the frames one by one, closing at the end.

    A driver has ``_connect``, ``_disconnect`` and ``_read``; the latter raises
    ``DeviceLostError`` when the connection is gone.
    """

    def __init__(self) -> None:
        self.counts = Counts()
        self.events: list[Event] = []
        self._connected = False
        self._wanted = False
        self._retry_at = 0.0
        self._silent_s = 0.0

    def open(self) -> None:
        """Connect, and have the device send.

        Raises:
            DeviceError: It cannot be reached, or refuses; the message names the remedy.
        """
        self._wanted = True
        try:
            self._connect()
        except DeviceError:
            self._disconnect()
            raise
        self._connected = True

    @abstractmethod
    def describe(self) -> Description:
        """What the device is, and its sensors."""

    def poll(self, timeout_s: float) -> list[Frame]:
        """The frames that have come since the last call, after at most a wait [s]."""
        deadline = time.monotonic() + timeout_s
        if not self._connected and not self._reconnected(deadline):
            return []
        try:
            frames = self._read(max(0.0, deadline - time.monotonic()))
        except DeviceLostError as error:
            self._lose(str(error))
            return []
        self.counts.frames += len(frames)
        return frames

    def frames(self) -> Iterator[Frame]:
        """Every frame until the tracker is closed, waiting for each."""
        while self._wanted:
            yield from self.poll(POLL_S)

    def close(self) -> None:
        """Have the device stop, and let go of it."""
        self._wanted = False
        if self._connected:
            self._connected = False
            self._stop()
        self._disconnect()

    def __enter__(self) -> Self:
        """Open it."""
        self.open()
        return self

    def __exit__(self, *_: object) -> None:
        """Close it."""
        self.close()

    def _listened(self, since_s: float, longest_s: float, *, heard: bool) -> None:
        """Note that the device was listened to from a moment on.

        Only time spent waiting in vain counts as silence: a busy computer may not have listened.

        Raises:
            DeviceLostError: It was silent for too long.
        """
        waited_s = min(time.monotonic() - since_s, POLL_S)
        self._silent_s = 0.0 if heard else self._silent_s + waited_s
        if self._silent_s > longest_s:
            self._silent_s = 0.0
            raise DeviceLostError(f"nothing came for {longest_s:g} s")

    def _say(self, message: str) -> None:
        self.events.append(Event(time.monotonic(), message))

    def _lose(self, why: str) -> None:
        self._connected = False
        self._say(f"connection lost: {why}; trying to reach the device again")
        self._disconnect()
        self._retry_at = time.monotonic()

    def _reconnected(self, deadline: float) -> bool:
        """Whether the device is reached again before a moment, trying now and then."""
        wait_s = self._retry_at - time.monotonic()
        time.sleep(max(0.0, min(wait_s, deadline - time.monotonic())))
        if not self._wanted or time.monotonic() < self._retry_at:
            return False
        try:
            self._connect()
        except DeviceError:
            self._disconnect()
            self._retry_at = time.monotonic() + RETRY_S
            return False
        self._connected = True
        self.counts.reconnections += 1
        self._say("connected again")
        return True

    @abstractmethod
    def _connect(self) -> None:
        """Open the connection and have the device send."""

    @abstractmethod
    def _disconnect(self) -> None:
        """Close the connection."""

    def _stop(self) -> None:  # noqa: B027  # most stop as the connection closes
        """Have the device stop sending, as far as it still listens."""

    @abstractmethod
    def _read(self, timeout_s: float) -> list[Frame]:
        """The frames that come within a wait [s]."""
