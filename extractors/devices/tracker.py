"""What every live tracker gives: a description, and frames of poses with time stamps."""

import time
from abc import ABC, abstractmethod
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Self, TypeVar
from urllib.parse import unquote

import numpy as np
from jaxtyping import Float

from capar.model.capture import NAME
from capar.model.errors import DeviceError, UnknownNameError

RETRY_S = 0.5  # Pause between two attempts to reach a device that went away [s].
POLL_S = 0.1  # Longest wait for a device's next bytes before anything else is attended to [s].


class DeviceLostError(DeviceError):
    """The connection broke off, or a device that was sending is silent."""


@dataclass(frozen=True)
class Address:
    """A device address: a driver's name, where its device is, and options.

    ``flock:/dev/ttyUSB0?birds=12&format=pos_quat&rate=51.65``
    """

    text: str
    kind: str
    place: str
    options: Mapping[str, str]
    _asked: set[str] = field(default_factory=set, repr=False, compare=False)

    def text_of(self, name: str, default: str) -> str:
        """An option as text."""
        self._asked.add(name)
        return self.options.get(name, default)

    def choice(self, name: str, known: Iterable[str], default: str) -> str:
        """An option that is one of some words.

        Raises:
            UnknownNameError: It is another.
        """
        given, names = self.text_of(name, default), list(known)
        if given not in names:
            raise UnknownNameError(name, given, names, where=self.text)
        return given

    def flag(self, name: str) -> bool:
        """An option that is ``yes`` or, if it is not given, ``no``."""
        return self.choice(name, ("yes", "no"), "no") == "yes"

    def number(self, name: str, default: float, *, low: float, high: float) -> float:
        """An option that is a number within bounds, which belong to it.

        Raises:
            DeviceError: It is no number, or lies outside.
        """
        given = self.text_of(name, str(default))
        try:
            value = float(given)
        except ValueError:
            raise self.error(f"{name}={given} is no number") from None
        if not low <= value <= high:
            raise self.error(f"{name}={given}; it lies between {low:g} and {high:g}")
        return value

    def integer(self, name: str, default: int, *, low: int, high: int) -> int:
        """An option that is a whole number within bounds, which belong to it.

        Raises:
            DeviceError: It is none, or lies outside.
        """
        value = self.number(name, default, low=low, high=high)
        if value != int(value):
            raise self.error(f"{name}={self.options[name]} is no whole number")
        return int(value)

    def names(self, default: Iterable[str]) -> tuple[str, ...]:
        """The sensors' names: the option ``names``, as many as there are sensors.

        Raises:
            DeviceError: There are more or fewer, one is given twice, or it is no name.
        """
        usual = tuple(default)
        given = tuple(self.text_of("names", ",".join(usual)).split(","))
        if len(given) != len(usual):
            raise self.error(f"names= lists {len(given)} names; there are {len(usual)} sensors")
        for name in given:
            if not NAME.fullmatch(name):
                rule = "begin with a lower-case letter and hold letters, digits and underscores"
                raise self.error(f"sensor name {name!r}: names {rule}")
        if len(set(given)) < len(given):
            raise self.error("names= lists a name twice")
        return given

    def host_port(self, place: str, port: int) -> tuple[str, int]:
        """A place that is ``HOST`` or ``HOST:PORT``.

        Raises:
            DeviceError: It is neither.
        """
        host, colon, digits = place.rpartition(":")
        if not colon:
            return place, port
        if not host or not digits.isascii() or not digits.isdigit() or not 0 < int(digits) < 65536:
            raise self.error(f"{place!r} is no HOST or HOST:PORT")
        return host, int(digits)

    def close(self) -> None:
        """Refuse options that nothing asked for.

        Raises:
            UnknownNameError: There is one.
        """
        for name in self.options:
            if name not in self._asked:
                raise UnknownNameError("option", name, self._asked, where=self.text)

    def error(self, problem: str) -> DeviceError:
        """An error that names this address."""
        return DeviceError(f"{self.text}: {problem}")


def parse_address(text: str) -> Address:
    """The address that a text holds.

    Raises:
        DeviceError: It has no driver, no place, an option without a value, or one twice.
    """
    kind, colon, rest = text.partition(":")
    place, _, query = rest.partition("?")
    if not colon or not kind or not place:
        raise DeviceError(
            f"{text!r} is no device address; it is DRIVER:PLACE?OPTION=VALUE&..., "
            "like flock:/dev/ttyUSB0?birds=2"
        )
    options: dict[str, str] = {}
    for part in query.split("&") if query else ():
        name, equals, value = part.partition("=")
        if not equals or not name or not value:
            raise DeviceError(f"{text}: option {part!r} is not of the form NAME=VALUE")
        if name in options:
            raise DeviceError(f"{text}: option {name!r} is given twice")
        options[name] = unquote(value)
    return Address(text, kind, place, options)


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


class LiveTracker(ABC):
    """A source of live poses, as a context manager; it connects again when the device goes away.

    A driver has ``_connect``, ``_disconnect`` and ``_read``; the latter raises
    ``DeviceLostError`` when the connection is gone.
    """

    def __init__(self) -> None:
        self.counts = Counts()
        self.events: list[Event] = []
        """What happened to the connection, oldest first."""

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
        """The frames that have come since the last call, after at most a wait [s].

        A lost connection raises nothing: it is reported in ``events``, and tried again.
        """
        deadline = time.monotonic() + timeout_s
        if not self._connected and not self._reconnected(deadline):
            return []
        try:
            frames = self._read(max(0.0, deadline - time.monotonic()))
        except DeviceLostError as error:
            self._connected = False
            self._say(f"connection lost: {error}; trying to reach the device again")
            self._disconnect()
            self._retry_at = time.monotonic()
            return []
        self.counts.frames += len(frames)
        return frames

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
        """
        waited_s = min(time.monotonic() - since_s, POLL_S)
        self._silent_s = 0.0 if heard else self._silent_s + waited_s
        if self._silent_s > longest_s:
            self._silent_s = 0.0
            raise DeviceLostError(f"nothing came for {longest_s:g} s")

    def _say(self, message: str) -> None:
        self.events.append(Event(time.monotonic(), message))

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


@dataclass(frozen=True, slots=True, eq=False)
class SensorReading:
    """One sensor's pose in one cycle."""

    index: int
    """Row of the sensor in a frame."""

    host_s: float
    position: np.ndarray
    orientation: np.ndarray
    device_s: float | None = None


Message = TypeVar("Message")


def take_messages(
    buffer: bytearray, decode: Callable[[bytearray], tuple[Message, int] | None]
) -> Iterator[Message]:
    """The messages that a buffer begins with, each removed from it.

    Args:
        buffer: The bytes that have come.
        decode: The message at the start of some bytes, and its length; None where more are needed.
    """
    while (found := decode(buffer)) is not None:
        del buffer[: found[1]]
        yield found[0]


def frame_of(readings: Sequence[SensorReading], sensors: int, *, cycle: int | None = None) -> Frame:
    """The frame of some sensors' readings; the others are NaN."""
    positions, orientations = np.full((sensors, 3), np.nan), np.full((sensors, 4), np.nan)
    for reading in readings:
        positions[reading.index] = reading.position
        orientations[reading.index] = reading.orientation
    first = min(readings, key=lambda reading: reading.host_s)
    return Frame(first.host_s, first.device_s, positions, orientations, cycle)
