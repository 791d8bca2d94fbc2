"""How a Flock of Birds is set up, from its address, and whether its lines carry the rate."""

from dataclasses import dataclass

from extractors.devices.addresses import Address
from extractors.devices.bird_formats import FORMATS, BirdFormat, Scaling
from extractors.devices.flock_commands import BITS, EVERY, HEMISPHERES, MOST_HZ, line_limit_hz
from extractors.devices.flock_records import record_size

BAUDS = (2400, 4800, 9600, 19200, 38400, 57600, 115200)
EXTENDED_RANGE_INCH = 144.0
SETTLE_S = 0.75
"""How long the line is left idle around auto-configuration: 0.6 s, and what delays it [s]."""


@dataclass(frozen=True)
class FlockSettings:
    """Units, format, rate and lines of a flock.

    The place is a port, or several divided by commas: then each bird has its own, the first
    one's bird is the master, and records carry no address.
    """

    ports: tuple[str, ...]
    names: tuple[str, ...]
    form: BirdFormat
    rate_hz: float
    """Frames a second."""

    every: int
    """Every how many measuring cycles a frame is sent."""

    baud: int
    stream: bool
    """Whether the flock sends of its own accord, or is polled."""

    erc: bool
    """Whether unit 1 is an extended-range controller, and the birds begin at 2."""

    scaling: Scaling
    hemisphere: str
    line_frequency_hz: int
    """Of the power supply; 0 leaves it as it is set."""

    reset: bool
    settle_s: float

    @property
    def addresses(self) -> tuple[int, ...]:
        """The birds' addresses, in the order of the sensors."""
        first = 2 if self.erc else 1
        return tuple(range(first, first + len(self.names)))

    @property
    def units(self) -> int:
        """Units on the bus between the birds."""
        return len(self.names) + self.erc

    @property
    def group(self) -> bool:
        """Whether one line carries the records of several units, with their addresses."""
        return len(self.ports) == 1 and self.units > 1

    @property
    def measured_hz(self) -> float:
        """Measuring cycles a second."""
        return self.rate_hz * self.every


def flock_settings(address: Address) -> FlockSettings:
    """The settings that an address holds.

    Raises:
        CaparError: An option is unknown or out of bounds, or a line cannot carry the rate.
    """
    ports = tuple(address.place.split(","))
    birds = address.integer("birds", len(ports), low=1, high=13)
    erc = address.flag("erc", default=False)
    if len(ports) > 1 and birds != len(ports):
        raise address.error(f"{len(ports)} ports for {birds} birds; give one port a bird, or one")
    if len(ports) > 1 and erc:
        raise address.error("with a port for each bird the master is the first one's; erc=no")
    first = 2 if erc else 1
    usual = "144" if erc else "36"
    inches = float(address.choice("range", ("144",) if erc else ("36", "72"), usual))
    conjugated = address.choice("quaternion", ("conjugated", "plain"), "conjugated")
    rate_hz = address.number("rate", 30.0, low=0.1, high=MOST_HZ)
    settings = FlockSettings(
        ports=ports,
        names=address.names(f"bird{first + index}" for index in range(birds)),
        form=FORMATS[address.choice("format", FORMATS, "pos_quat")],
        rate_hz=rate_hz,
        every=_every(address, rate_hz),
        baud=int(address.choice("baud", map(str, BAUDS), "115200")),
        stream=address.choice("mode", ("stream", "point"), "stream") == "stream",
        erc=erc,
        scaling=Scaling(inches, conjugated == "conjugated"),
        hemisphere=address.choice("hemisphere", HEMISPHERES, "front"),
        line_frequency_hz=int(address.choice("power", ("0", "50", "60"), "0")),
        reset=address.flag("reset", default=False),
        settle_s=address.number("settle", SETTLE_S, low=0.0, high=10.0),
    )
    address.close()
    _check_rate(address, settings)
    return settings


def _every(address: Address, rate_hz: float) -> int:
    """As few reports a measurement as give the fastest measuring, unless the address says."""
    usual = max(each for each in EVERY if each * rate_hz <= MOST_HZ)
    every = int(address.choice("every", map(str, EVERY), str(usual)))
    if every * rate_hz > MOST_HZ:
        raise address.error(
            f"rate={rate_hz:g} every {every} cycles is {every * rate_hz:g} measurements a second; "
            f"the birds do {MOST_HZ:g}"
        )
    return every


def _check_rate(address: Address, settings: FlockSettings) -> None:
    """Refuse a rate that a line cannot carry, with the arithmetic."""
    birds = len(settings.names) if len(settings.ports) == 1 else 1
    limit_hz = line_limit_hz(settings.form, birds, settings.baud, group=settings.group)
    if settings.rate_hz <= limit_hz:
        return
    size = record_size(settings.form, group=settings.group)
    raise address.error(
        f"rate={settings.rate_hz:g} does not pass the line: {birds} x {size} bytes a frame are "
        f"{birds * size * settings.rate_hz:.0f} bytes a second, {settings.baud} baud carry "
        f"{settings.baud / BITS:.0f}, so at most {limit_hz:.4g} Hz. Lower the rate, choose a "
        "shorter format, give each bird a port of its own, or use a MotionStar's Ethernet."
    )
