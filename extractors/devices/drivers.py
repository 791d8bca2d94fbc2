"""Every driver by the name that begins a device address."""

from collections.abc import Callable

from capar.model.errors import UnknownNameError
from extractors.devices.addresses import Address, parse_address
from extractors.devices.fastrak import FastrakTracker
from extractors.devices.flock import FlockTracker
from extractors.devices.lsl import LslTracker
from extractors.devices.motionstar import MotionStarTracker
from extractors.devices.tracker import LiveTracker
from extractors.devices.vrpn import VrpnTracker

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
