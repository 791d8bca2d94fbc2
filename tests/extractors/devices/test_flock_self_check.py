"""The sign of quaternions on the wire is found with the device, or not told at all."""

from dataclasses import dataclass

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from capar.model.errors import DeviceError
from extractors.devices.flock import FlockRig, FlockSimulator, find_quaternion_sign
from extractors.devices.simulator import Poses, SmoothMotion


@dataclass(frozen=True)
class Still:
    """One sensor that lies still, or turns about z."""

    turned_deg: float
    deg_s: float = 0.0
    sensors: tuple[str, ...] = ("hand",)

    def poses(self, time_s: float) -> Poses:
        angles = [self.turned_deg + self.deg_s * time_s, self.turned_deg, 0.0]
        turn = Rotation.from_euler("ZYX", angles, degrees=True)
        half = Rotation.from_euler("x", 180.0, degrees=True)
        return np.array([[0.3, 0.0, 0.0]]), (half * turn).as_quat(scalar_first=True)[None]


def found(motion: Still | SmoothMotion, *, conjugated: bool) -> str:
    with FlockSimulator(motion, FlockRig(quiet_s=0.05, conjugated=conjugated)) as simulator:
        return find_quaternion_sign(f"flock:{simulator.place}?settle=0.2")


@pytest.mark.parametrize(("conjugated", "sign"), [(True, "conjugated"), (False, "plain")])
def test_the_sign_is_found(conjugated: bool, sign: str) -> None:
    assert found(Still(40.0), conjugated=conjugated) == sign


def test_a_sensor_that_is_not_turned_tells_nothing() -> None:
    with pytest.raises(DeviceError, match=r"turn the first sensor"):
        found(Still(0.0), conjugated=True)


def test_a_sensor_that_moves_tells_nothing() -> None:
    with pytest.raises(DeviceError, match=r"keep it still"):
        found(Still(40.0, deg_s=170.0), conjugated=True)
