"""What a simulated flock consists of, and the settings of its units and lines."""

from dataclasses import dataclass, field

from extractors.devices import flock_commands as commands
from extractors.devices.bird_formats import FORMATS, BirdFormat
from extractors.devices.simulated_line import SimulatedLine

DATA_SIZES = {commands.HEMISPHERE: 2, commands.NEXT_TRANSMITTER: 1, commands.EXAMINE: 1}


@dataclass(frozen=True)
class FlockRig:
    """What the simulated flock consists of."""

    erc: bool = False
    """Whether unit 1 is an extended-range controller without a sensor."""

    line_a_bird: bool = False
    baud: int = 115200
    quiet_s: float = 0.6
    """How long lines must be idle before and after auto-configuration [s]."""

    conjugated: bool = True
    error: int = 0
    """Error code that it reports."""

    missing: tuple[int, ...] = ()
    """Addresses of units that do not answer on the bus."""


@dataclass
class Bird:
    """The settings of one unit."""

    form: BirdFormat = FORMATS["pos_ang"]
    hemisphere: bytes = b"\x00\x00"


@dataclass
class Desk:
    """One line, the commands that come by it, and whether it streams."""

    line: SimulatedLine
    unit: int
    """The unit at its end."""

    commands: bytearray = field(default_factory=bytearray)
    streaming: bool = False
    every: int = 1
    target: int = 0
    poll_at_s: float = -1.0


def range_inch(rig: FlockRig, scaling: int) -> float:
    """Range of positions [inch] at a value of parameter 3."""
    return 144.0 if rig.erc else 72.0 if scaling else 36.0


def command_size(data: bytearray) -> int:
    """Bytes of the command that some bytes begin; more than there are where it is cut off."""
    if not data:
        return 0
    if data[0] == commands.CHANGE:
        return 2 + (commands.SIZES.get(data[1], 0) if len(data) > 1 else 1)
    return 1 + DATA_SIZES.get(data[0], 0)
