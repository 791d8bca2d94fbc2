"""Every simulator by the name of the driver that reads it."""

from collections.abc import Callable
from dataclasses import dataclass

from capar.model.errors import DeviceError, UnknownNameError
from extractors.devices.fastrak_records import STATIONS
from extractors.devices.fastrak_simulator import FastrakSimulator
from extractors.devices.flock_rig import FlockRig
from extractors.devices.flock_simulator import FlockSimulator
from extractors.devices.motion_source import MotionSource
from extractors.devices.motionstar_simulator import MotionStarSimulator, ServerFaults
from extractors.devices.simulated_line import Faults
from extractors.devices.simulator import Simulator
from extractors.devices.vrpn_simulator import VrpnSimulator


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
