"""Every driver and every simulator by the name that begins a device address."""

from collections.abc import Callable

from capar.model.errors import DeviceError, UnknownNameError
from extractors.devices.fastrak import STATIONS, FastrakSimulator, FastrakTracker
from extractors.devices.flock import FlockRig, FlockSimulator, FlockTracker
from extractors.devices.lsl import LslTracker
from extractors.devices.motionstar import MotionStarSimulator, MotionStarTracker
from extractors.devices.simulator import Faults, MotionSource, Simulator
from extractors.devices.tracker import Address, LiveTracker, parse_address
from extractors.devices.vrpn import VrpnSimulator, VrpnTracker

DRIVERS: dict[str, Callable[[Address], LiveTracker]] = {
    "flock": FlockTracker,
    "motionstar": MotionStarTracker,
    "fastrak": FastrakTracker,
    "vrpn": VrpnTracker,
    "lsl": LslTracker,
}

EXAMPLES = {
    "flock": "flock:/dev/ttyUSB0?birds=12&format=pos_quat&rate=51.65",
    "motionstar": "motionstar:HOST?birds=12&rate=103.3",
    "fastrak": "fastrak:/dev/ttyUSB0?stations=4&encoding=binary",
    "vrpn": "vrpn:Tracker0@HOST?sensors=4&up=y",
    "lsl": "lsl:NAME",
}
"""An address of each driver."""


def find_tracker(text: str) -> LiveTracker:
    """The tracker at a device address, not yet open.

    Raises:
        CaparError: There is no such driver, or the address holds what it cannot be set to.
    """
    address = parse_address(text)
    if address.kind not in DRIVERS:
        raise UnknownNameError("driver", address.kind, DRIVERS, where=text)
    return DRIVERS[address.kind](address)


def make_simulator(
    kind: str, motion: MotionSource, faults: Faults, *, erc: bool = False, port: int = 0
) -> tuple[Simulator, str]:
    """A simulator, not yet started, and the options of the address at which it is read.

    Args:
        kind: ``flock``, ``motionstar``, ``fastrak`` or ``vrpn``.
        motion: What is measured.
        faults: What goes wrong.
        erc: Whether a flock has an extended-range controller as unit 1.
        port: TCP or UDP port; 0 takes a free one.

    Raises:
        UnknownNameError: There is none of that name.
        DeviceError: Such a tracker has fewer sensors.
    """
    count = len(motion.sensors)
    if kind == "flock":
        options = f"birds={count}{'&erc=yes' * erc}"
        return FlockSimulator(motion, FlockRig(erc=erc), faults), options
    if kind == "motionstar":
        return MotionStarSimulator(motion, faults, port=port), f"birds={count}"
    if kind == "fastrak":
        if count > STATIONS:
            raise DeviceError(f"a Fastrak has {STATIONS} stations; the motion has {count} sensors")
        return FastrakSimulator(motion, faults), f"stations={count}"
    if kind == "vrpn":
        return VrpnSimulator(motion, port=port), f"sensors={count}"
    raise UnknownNameError("simulator", kind, ["flock", "motionstar", "fastrak", "vrpn"])
