"""Which sign a Flock of Birds' quaternions have on the wire, found with the flock itself.

The vendor's documents and drivers disagree for some firmware. A sensor that lies still and
turned is read as a matrix, which is unambiguous, and as a quaternion in both ways.
"""

import time
from dataclasses import replace

import numpy as np
from scipy.spatial.transform import Rotation

from capar.model.errors import DeviceError
from extractors.devices.addresses import Address, parse_address
from extractors.devices.flock import FlockTracker

AGREE_DEG = 3.0
"""How far readings of a sensor that lies still may be apart [degrees]."""

READ_S = 5.0


def find_quaternion_sign(text: str) -> str:
    """The value of the option ``quaternion`` that is right for a flock.

    Args:
        text: The flock's address. Its first sensor lies still, turned by a good deal.

    Raises:
        DeviceError: It gives no poses, moves, or is turned too little to tell.
    """
    address = parse_address(text)
    matrix = _orientation(address, "mat", "conjugated")
    apart = {
        sign: np.degrees((_orientation(address, "quat", sign).inv() * matrix).magnitude())
        for sign in ("conjugated", "plain")
    }
    agreeing = [sign for sign, angle in apart.items() if angle < AGREE_DEG]
    if len(agreeing) == 1:
        return agreeing[0]
    said = " and ".join(f"{angle:.1f} degrees as {sign}" for sign, angle in apart.items())
    remedy = "turn the first sensor by about 45 degrees" if agreeing else "keep it still"
    raise DeviceError(f"{text}: matrix and quaternion differ by {said}; {remedy} and try again")


def _orientation(address: Address, form: str, sign: str) -> Rotation:
    """The first sensor's orientation, read once in a format."""
    options = {**address.options, "format": form, "quaternion": sign, "mode": "point"}
    options["rate"] = "10"
    with FlockTracker(replace(address, options=options)) as flock:
        end = time.monotonic() + READ_S
        while time.monotonic() < end:
            for frame in flock.poll(0.2):
                if np.isfinite(frame.orientations[0]).all():
                    return Rotation.from_quat(frame.orientations[0], scalar_first=True)
    raise DeviceError(f"{address.text}: the first sensor gives no {form} in {READ_S:g} s")
