"""Conventions by which a motion file was read: unit, upward axis, handedness."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from jaxtyping import Float

from capar.model.errors import UnknownNameError

if TYPE_CHECKING:
    from scipy.spatial.transform import Rotation

UNITS: Mapping[str, float] = {
    "m": 1.0, "dm": 0.1, "cm": 0.01, "mm": 0.001, "in": 0.0254, "ft": 0.3048,
}  # fmt: skip
"""Metres per unit, by the names that headers and capture.toml use."""

UP: Mapping[str, tuple[str, float]] = {
    "z": ("x", 0.0),
    "y": ("x", 90.0),
    "x": ("y", -90.0),
    "-z": ("x", 180.0),
    "-y": ("x", -90.0),
    "-x": ("y", 90.0),
}
"""The rotation that brings each axis to z: about which axis, and by how much [degrees]."""

AXIS_COSINE = 0.9
"""A direction is an axis's if the cosine of the angle between them is at least this [1]."""


def upward(axis: str) -> "Rotation":
    """The rotation that brings an axis of ``UP`` to z."""
    from scipy.spatial.transform import Rotation

    about, angle_deg = UP[axis]
    return Rotation.from_euler(about, angle_deg, degrees=True)


@dataclass(frozen=True, slots=True)
class Conventions:
    """What a file's numbers were taken to mean, as a capture.toml states it."""

    unit_m: float = 1.0
    """Metres per unit."""

    up: str = "z"
    """Upward axis of the file, or of its mirror image in x if it is left-handed."""

    left_handed: bool = False

    def __post_init__(self) -> None:
        """Check that the axis is one."""
        if self.up not in UP:
            raise UnknownNameError("upward axis", self.up, UP)

    def axis(self, direction: Float[np.ndarray, "3"]) -> str | None:
        """The axis of the file along a direction of the world; None where none is near it."""
        for name in UP:
            along = (upward(self.up) * upward(name).inv()).apply(np.array([0.0, 0.0, 1.0]))
            if float(along @ direction) >= AXIS_COSINE * float(np.linalg.norm(direction)):
                return name
        return None

    def unit(self, factor: float, share: float) -> str | None:
        """The unit that makes lengths so many times as long; None where none is near it.

        Args:
            factor: By what lengths in metres are to be multiplied [1].
            share: Largest deviation of a unit from the wanted one, as a share of it [1].
        """
        wanted = self.unit_m * factor
        near = min(UNITS, key=lambda name: abs(np.log(UNITS[name] / wanted)))
        return near if abs(UNITS[near] / wanted - 1.0) <= share else None
