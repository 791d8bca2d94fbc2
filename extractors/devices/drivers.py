"""Every driver and every simulator by the name that begins a device address."""

from collections.abc import Callable
from dataclasses import dataclass

from capar.model.errors import DeviceError, UnknownNameError
from extractors.devices.fastrak import STATIONS, FastrakSimulator, FastrakTracker
from extractors.devices.flock import FlockRig, FlockSimulator, FlockTracker
from extractors.devices.lsl import LslTracker
from extractors.devices.motionstar import MotionStarSimulator, MotionStarTracker, ServerFaults
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
"""The drivers."""

EXAMPLES = {
    "flock": "flock:/dev/ttyUSB0?birds=12&format=pos_quat&rate=51.65",
    "motionstar": "motionstar:HOST?birds=12&rate=103.3",
    "fastrak": "fastrak:/dev/ttyUSB0?stations=4&encoding=binary",
    "vrpn": "vrpn:Tracker0@HOST?sensors=4&up=y",
    "lsl": "lsl:NAME",
}
"""An address of each."""


def find_tracker(text: str) -> LiveTracker:
    """The tracker at a device address, not yet open.

    Raises:
        CaparError: There is no such driver, or the address holds what it cannot be set to.
    """
    address = parse_address(text)
    if address.kind not in DRIVERS:
        raise UnknownNameError("driver", address.kind, DRIVERS, where=text)
    return DRIVERS[address.kind](address)


@dataclass(frozen=True)
class Wanted:
    """What is to be simulated, and what goes wrong."""

    motion: MotionSource
    erc: bool = False
    lost_share: float = 0.0
    """Share of the bytes, or of a network's packets, that are lost."""

    garbled_share: float = 0.0
    port: int = 0
    """TCP or UDP port; 0 takes a free one."""


def _flock(wanted: Wanted) -> tuple[Simulator, str]:
    faults = Faults(wanted.lost_share, wanted.garbled_share)
    erc = "&erc=yes" if wanted.erc else ""
    made = FlockSimulator(wanted.motion, FlockRig(erc=wanted.erc), faults)
    return made, f"birds={len(wanted.motion.sensors)}{erc}"


def _motionstar(wanted: Wanted) -> tuple[Simulator, str]:
    made = MotionStarSimulator(wanted.motion, ServerFaults(wanted.lost_share), port=wanted.port)
    return made, f"birds={len(wanted.motion.sensors)}"


def _fastrak(wanted: Wanted) -> tuple[Simulator, str]:
    count = len(wanted.motion.sensors)
    if count > STATIONS:
        raise DeviceError(f"a Fastrak has {STATIONS} stations; the motion has {count} sensors")
    faults = Faults(wanted.lost_share, wanted.garbled_share)
    return FastrakSimulator(wanted.motion, faults=faults), f"stations={count}"


def _vrpn(wanted: Wanted) -> tuple[Simulator, str]:
    made = VrpnSimulator(wanted.motion, port=wanted.port)
    return made, f"sensors={len(wanted.motion.sensors)}"


SIMULATORS: dict[str, Callable[[Wanted], tuple[Simulator, str]]] = {
    "flock": _flock,
    "motionstar": _motionstar,
    "fastrak": _fastrak,
    "vrpn": _vrpn,
}
"""The simulators, each with the options of the address at which it is read."""


def make_simulator(kind: str, wanted: Wanted) -> tuple[Simulator, str]:
    """A simulator, not yet started, and the options of its address.

    Raises:
        UnknownNameError: There is none of that name.
        DeviceError: Such a tracker has fewer sensors.
    """
    if kind not in SIMULATORS:
        raise UnknownNameError("simulator", kind, SIMULATORS)
    return SIMULATORS[kind](wanted)
