"""The serial command set of a Flock of Birds: bytes, parameters and error codes.

A command is one byte and its data, least significant byte first, without terminator or
acknowledgement; a prefix byte ``0xF0 + address`` sends it to one bird.
"""

from extractors.devices.bird_formats import BirdFormat
from extractors.devices.flock_records import record_size

POINT = 0x42
STREAM = 0x40
RUN = 0x46
SLEEP = 0x47
EXAMINE = 0x4F
CHANGE = 0x50
HEMISPHERE = 0x4C
NEXT_TRANSMITTER = 0x30
FBB_RESET = 0x2F
PREFIX = 0xF0

EVERY = {1: 0x51, 2: 0x52, 8: 0x53, 32: 0x54}
"""Report every nth cycle: the command by n."""

HEMISPHERES = {
    "front": b"\x00\x00",
    "rear": b"\x00\x01",
    "right": b"\x06\x00",
    "left": b"\x06\x01",
    "lower": b"\x0c\x00",
    "upper": b"\x0c\x01",
}
"""The half of space in which a sensor moves, seen from the transmitter."""

STATUS, FIRMWARE, CRYSTAL, SCALING, COUNT, RATE, ERROR = 0, 1, 2, 3, 6, 7, 10
MODEL, EXPANDED_ERROR, LINE_FREQUENCY, HEMISPHERE_PARAMETER = 15, 16, 20, 22
GROUP_MODE, FLOCK_STATUS, AUTO_CONFIG = 35, 36, 50

SIZES = {
    STATUS: 2,
    FIRMWARE: 2,
    CRYSTAL: 2,
    SCALING: 2,
    COUNT: 2,
    RATE: 2,
    ERROR: 1,
    MODEL: 10,
    EXPANDED_ERROR: 2,
    LINE_FREQUENCY: 1,
    HEMISPHERE_PARAMETER: 2,
    GROUP_MODE: 1,
    FLOCK_STATUS: 14,
    AUTO_CONFIG: 1,
}
"""Bytes of a parameter's value."""

ACCESSIBLE, RUNNING, SENSOR, ERC = 0x80, 0x40, 0x20, 0x10
"""Bits of a unit in the flock status."""

RATE_UNIT = 256.0
"""Parameter 7 is the measurement rate [Hz] times this."""

MOST_HZ = 144.0
"""Measuring cycles a second that the birds do at most."""

BITS = 10
"""Bits of a byte on an 8N1 line: start, eight of data, stop."""

ERRORS = {
    1: "system memory failed its test",
    2: "non-volatile memory failed its test",
    3: "the configuration in non-volatile memory is corrupt",
    4: "the transmitter's configuration is corrupt",
    5: "the sensor's configuration is corrupt",
    6: "a command it does not know or cannot do now",
    7: "a command that only the master may be given",
    8: "no birds are connected or accessible",
    9: "a bird is not initialised; auto-configure the flock first",
    10: "an error of receiving on the bus between the birds",
    11: "an overrun or framing error on its serial line; check the baud rate",
    13: "a bird on the bus does not answer",
    28: "no pulse to synchronise with a screen",
    29: "the transmitter is not active",
    30: "the extended-range transmitter is not attached",
    31: "the processor's time overflowed; lower the measurement rate",
    32: "a sensor is saturated; it is too near the transmitter",
    34: "its watchdog reset it",
    35: "it is too hot",
}
"""What error codes mean."""

FATAL = frozenset({1, 2, 15, 16, *range(20, 28)})
"""Errors after which a bird does not go on."""


def error_text(code: int, unit: int = 0) -> str:
    """What an error code says, and of which unit where that is known."""
    kind = "fatal error" if code in FATAL else "error"
    meaning = ERRORS.get(code, "of a meaning that is not documented here")
    return f"{kind} {code}: {meaning}" + (f" (unit {unit})" if unit else "")


def examine(parameter: int) -> bytes:
    """Ask for a parameter's value."""
    return bytes([EXAMINE, parameter])


def change(parameter: int, value: int) -> bytes:
    """Set a parameter."""
    return bytes([CHANGE, parameter]) + value.to_bytes(SIZES[parameter], "little")


def addressed(address: int, command: bytes) -> bytes:
    """A command to one bird of the flock."""
    return bytes([PREFIX + address]) + command


def hemisphere(name: str) -> bytes:
    """Choose the hemisphere."""
    return bytes([HEMISPHERE]) + HEMISPHERES[name]


def rate_word(rate_hz: float) -> int:
    """Value of parameter 7 for a measurement rate [Hz]."""
    return round(rate_hz * RATE_UNIT)


def line_limit_hz(form: BirdFormat, birds: int, baud: int, *, group: bool) -> float:
    """Cycles a second of all birds on one line that its speed carries [Hz]."""
    return baud / BITS / (birds * record_size(form, group=group))
