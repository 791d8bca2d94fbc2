"""What Ascension's birds send: seven formats of 16-bit words, as poses and back.

Serial lines and Ethernet share the words and their meaning. A bird measures in the transmitter's
frame (x out of its front, y to the right, z down); poses here are in a frame with x as there and
z up, which is the former turned by half a turn about x, for a transmitter that stands level.

The sign of the quaternion on the wire is not certain for every firmware: ``conjugated`` says
whether the wire has the conjugate of the quaternion that takes sensor coordinates to the
transmitter's.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from jaxtyping import Float
from scipy.spatial.transform import Rotation

INCH_M = 0.0254
FULL_SCALE = 32768  # Word of a whole range, half a turn, or one.
NORM_TOLERANCE = 0.05
"""How far a quaternion's norm, or a matrix's product with its transpose, may lie from one [1]."""

Vector = Float[np.ndarray, "3"]
Quaternion = Float[np.ndarray, "4"]


@dataclass(frozen=True)
class BirdFormat:
    """One of the seven formats."""

    name: str
    position: bool
    orientation: str
    """``angles``, ``matrix``, ``quaternion``, or empty."""

    command: int
    """The serial command that chooses it."""

    code: int
    """Its number in BirdNet packets."""

    @property
    def words(self) -> int:
        """Data words of a record."""
        turned = {"": 0, "angles": 3, "quaternion": 4, "matrix": 9}[self.orientation]
        return 3 * self.position + turned


FORMATS = {
    each.name: each
    for each in (
        BirdFormat("pos", True, "", 0x56, 1),
        BirdFormat("ang", False, "angles", 0x57, 2),
        BirdFormat("mat", False, "matrix", 0x58, 3),
        BirdFormat("pos_ang", True, "angles", 0x59, 4),
        BirdFormat("pos_mat", True, "matrix", 0x5A, 5),
        BirdFormat("quat", False, "quaternion", 0x5C, 7),
        BirdFormat("pos_quat", True, "quaternion", 0x5D, 8),
    )
}
"""The formats by name."""


@dataclass(frozen=True)
class Scaling:
    """What turns words into poses."""

    range_inch: float = 36.0
    """Position of a full-scale word: 36 or 72 inches, 144 with an extended-range transmitter."""

    conjugated: bool = True
    """Whether the wire has the conjugate of the quaternion sensor to transmitter."""

    full_scale: int = FULL_SCALE
    """32768; some BirdNet servers may divide by 32767."""

    @property
    def signs(self) -> Quaternion:
        """Factors between the wire's quaternion w x y z and that of sensor to transmitter."""
        return np.array([1.0, -1.0, -1.0, -1.0] if self.conjugated else [1.0] * 4)


def pose_of_words(
    words: Sequence[float], form: BirdFormat, scaling: Scaling
) -> tuple[Vector, Quaternion] | None:
    """Position [m] and orientation (w x y z) of a record, NaN where the format lacks it.

    Returns None where the words are no rotation: their norm is far from one.
    """
    shares = np.array(words) / scaling.full_scale
    position, turned = np.full(3, np.nan), np.full(4, np.nan)
    if form.position:
        position, shares = shares[:3] * scaling.range_inch * INCH_M, shares[3:]
    if form.orientation == "quaternion":
        norm = np.linalg.norm(shares)
        if abs(norm - 1.0) > NORM_TOLERANCE:
            return None
        turned = shares / norm * scaling.signs
    elif form.orientation == "angles":
        turned = Rotation.from_euler("ZYX", shares * np.pi).as_quat(scalar_first=True)
    elif form.orientation:
        matrix = shares.reshape(3, 3)  # the wire has the transpose column by column
        if (
            np.abs(matrix @ matrix.T - np.eye(3)).max() > NORM_TOLERANCE
            or np.linalg.det(matrix) < 0
        ):
            return None
        turned = Rotation.from_matrix(matrix).as_quat(scalar_first=True)
    return to_world(position, turned)


def to_world(position: Vector, orientation: Quaternion) -> tuple[Vector, Quaternion]:
    """A pose in the transmitter's frame, z down, as one with z up: half a turn about x."""
    a, b, c, d = orientation
    return position * [1.0, -1.0, -1.0], np.array([-b, a, -d, c])


def from_world(position: Vector, orientation: Quaternion) -> tuple[Vector, Quaternion]:
    """The pose in the transmitter's frame, of a quaternion whose scalar is not negative."""
    a, b, c, d = orientation
    return position * [1.0, -1.0, -1.0], np.array([b, -a, d, -c]) * (1.0 if b >= 0.0 else -1.0)


def words_of_pose(
    position: Vector, orientation: Quaternion, form: BirdFormat, scaling: Scaling
) -> tuple[int, ...]:
    """The words that a bird at a pose sends; positions beyond its range saturate."""
    place, turned = from_world(position, orientation)
    shares = [place / (scaling.range_inch * INCH_M)] if form.position else []
    if form.orientation == "quaternion":
        shares.append(turned * scaling.signs)
    elif form.orientation:
        turn = Rotation.from_quat(turned, scalar_first=True)
        is_matrix = form.orientation == "matrix"
        shares.append(turn.as_matrix().ravel() if is_matrix else turn.as_euler("ZYX") / np.pi)
    words = np.round(np.concatenate(shares) * scaling.full_scale)
    return tuple(np.clip(words, -FULL_SCALE, FULL_SCALE - 1).astype(int).tolist())
