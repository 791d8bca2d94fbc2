"""What Ascension's birds send: seven formats of 16-bit words, as poses and back.

Serial lines and Ethernet share the words and their meaning. A bird measures in the transmitter's
frame (x out of its front, y to the right, z down); poses here are in a frame with x as there and
z up, which is the former turned by half a turn about x, for a transmitter that stands level.

The sign of the quaternion on the wire is not certain for every firmware: ``conjugated`` says
whether the wire has the conjugate of the quaternion that takes sensor coordinates to the
transmitter's.
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from jaxtyping import Float
from scipy.spatial.transform import Rotation

INCH_M = 0.0254
FULL_SCALE = 32768
"""Word of a whole range, half a turn, or one."""

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


def pose_of_words(
    words: Sequence[int], form: BirdFormat, scaling: Scaling
) -> tuple[Vector, Quaternion] | None:
    """Position [m] and orientation (w x y z) of a record, NaN where the format lacks it.

    Returns None where the words are no rotation: their norm is far from one.
    """
    shares = [word / scaling.full_scale for word in words]
    position, orientation = np.full(3, np.nan), np.full(4, np.nan)
    if form.position:
        metres = scaling.range_inch * INCH_M
        position = np.array(shares[:3]) * metres
        shares = shares[3:]
    if form.orientation:
        turned = _TURNS[form.orientation](shares, scaling)
        if turned is None:
            return None
        orientation = np.array(turned)
    return to_world(position, orientation)


def to_world(position: Vector, orientation: Quaternion) -> tuple[Vector, Quaternion]:
    """A pose in the transmitter's frame, z down, as one with z up: half a turn about x."""
    w, x, y, z = orientation
    return position * [1.0, -1.0, -1.0], np.array([-x, w, -z, y])


def from_world(position: Vector, orientation: Quaternion) -> tuple[Vector, Quaternion]:
    """The pose in the transmitter's frame, of a quaternion whose scalar is not negative."""
    w, x, y, z = orientation
    turned = np.array([x, -w, z, -y])
    return position * [1.0, -1.0, -1.0], turned if x >= 0.0 else -turned


def words_of_pose(
    position: Vector, orientation: Quaternion, form: BirdFormat, scaling: Scaling
) -> tuple[int, ...]:
    """The words that a bird at a pose sends; positions beyond its range saturate."""
    shares: list[float] = []
    place, turned = from_world(position, orientation)
    if form.position:
        shares += list(place / (scaling.range_inch * INCH_M))
    turn = Rotation.from_quat(turned, scalar_first=True)
    if form.orientation == "angles":
        shares += list(turn.as_euler("ZYX") / math.pi)
    elif form.orientation == "matrix":
        shares += list(turn.as_matrix().ravel())
    elif form.orientation == "quaternion":
        sent = turn.inv() if scaling.conjugated else turn
        shares += list(sent.as_quat(scalar_first=True))
    return tuple(_word(each * scaling.full_scale) for each in shares)


def _word(value: float) -> int:
    return max(-FULL_SCALE, min(FULL_SCALE - 1, round(value)))


def _of_angles(shares: list[float], _: Scaling) -> tuple[float, ...]:
    """R = Rz(azimuth) Ry(elevation) Rx(roll), as the product of three half-angle quaternions."""
    cz, cy, cx = (math.cos(each * math.pi / 2.0) for each in shares)
    sz, sy, sx = (math.sin(each * math.pi / 2.0) for each in shares)
    return (
        cz * cy * cx + sz * sy * sx,
        cz * cy * sx - sz * sy * cx,
        cz * sy * cx + sz * cy * sx,
        sz * cy * cx - cz * sy * sx,
    )


def _of_matrix(shares: list[float], _: Scaling) -> tuple[float, ...] | None:
    """The wire has the transpose column by column, so its rows are those of R."""
    matrix = np.array(shares).reshape(3, 3)
    if np.abs(matrix @ matrix.T - np.eye(3)).max() > NORM_TOLERANCE:
        return None
    if np.linalg.det(matrix) < 0.0:
        return None
    return tuple(Rotation.from_matrix(matrix).as_quat(scalar_first=True).tolist())


def _of_quaternion(shares: list[float], scaling: Scaling) -> tuple[float, ...] | None:
    norm = math.hypot(*shares)
    if abs(norm - 1.0) > NORM_TOLERANCE:
        return None
    sign = -1.0 if scaling.conjugated else 1.0
    w, x, y, z = (each / norm for each in shares)
    return w, sign * x, sign * y, sign * z


_TURNS = {"angles": _of_angles, "matrix": _of_matrix, "quaternion": _of_quaternion}
