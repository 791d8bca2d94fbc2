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
    (x, y, z), (a, b, c, d) = position.tolist(), orientation.tolist()
    return np.array([x, -y, -z]), np.array([-b, a, -d, c])


def from_world(position: Vector, orientation: Quaternion) -> tuple[Vector, Quaternion]:
    """The pose in the transmitter's frame, of a quaternion whose scalar is not negative."""
    (x, y, z), (a, b, c, d) = position.tolist(), orientation.tolist()
    turned = (b, -a, d, -c) if b >= 0.0 else (-b, a, -d, c)
    return np.array([x, -y, -z]), np.array(turned)


def words_of_pose(
    position: Vector, orientation: Quaternion, form: BirdFormat, scaling: Scaling
) -> tuple[int, ...]:
    """The words that a bird at a pose sends; positions beyond its range saturate."""
    shares: list[float] = []
    place, turned = from_world(position, orientation)
    if form.position:
        shares += list(place / (scaling.range_inch * INCH_M))
    w, x, y, z = turned.tolist()
    if form.orientation == "quaternion":
        sign = -1.0 if scaling.conjugated else 1.0
        shares += [w, sign * x, sign * y, sign * z]
    elif form.orientation:
        matrix = matrix_of(w, x, y, z)
        shares += matrix if form.orientation == "matrix" else _angles(matrix)
    return tuple(_word(each * scaling.full_scale) for each in shares)


def matrix_of(w: float, x: float, y: float, z: float) -> list[float]:
    """The rotation matrix of a unit quaternion, row by row."""
    return [
        1.0 - 2.0 * (y * y + z * z), 2.0 * (x * y - w * z), 2.0 * (x * z + w * y),
        2.0 * (x * y + w * z), 1.0 - 2.0 * (x * x + z * z), 2.0 * (y * z - w * x),
        2.0 * (x * z - w * y), 2.0 * (y * z + w * x), 1.0 - 2.0 * (x * x + y * y),
    ]  # fmt: skip


def _angles(matrix: list[float]) -> list[float]:
    """Azimuth, elevation and roll of a matrix, in half turns."""
    azimuth = math.atan2(matrix[3], matrix[0])
    elevation = math.asin(max(-1.0, min(1.0, -matrix[6])))
    roll = math.atan2(matrix[7], matrix[8])
    return [each / math.pi for each in (azimuth, elevation, roll)]


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
    rows = [shares[0:3], shares[3:6], shares[6:9]]
    (a, b, c), (d, e, f), (g, h, i) = rows
    products = [[sum(p * q for p, q in zip(r, s, strict=True)) for s in rows] for r in rows]
    off = max(abs(products[j][k] - (j == k)) for j in range(3) for k in range(3))
    if off > NORM_TOLERANCE or a * (e * i - f * h) - b * (d * i - f * g) + c * (d * h - e * g) < 0:
        return None
    return _quaternion(_orthonormal(rows, products))


def _orthonormal(rows: list[list[float]], products: list[list[float]]) -> list[list[float]]:
    """The nearest rotation, by one step of Newton and Schulz from a matrix that is almost one."""
    return [
        [
            1.5 * rows[j][k] - 0.5 * sum(products[j][m] * rows[m][k] for m in range(3))
            for k in range(3)
        ]
        for j in range(3)
    ]


def _quaternion(rows: list[list[float]]) -> tuple[float, ...]:
    """The quaternion w x y z of a rotation, from whichever of its parts is largest (Shepperd)."""
    (a, b, c), (d, e, f), (g, h, i) = rows
    found = max(
        ((1.0 + a + e + i), (1.0 + a + e + i, h - f, c - g, d - b)),
        ((1.0 + a - e - i), (h - f, 1.0 + a - e - i, b + d, c + g)),
        ((1.0 - a + e - i), (c - g, b + d, 1.0 - a + e - i, f + h)),
        ((1.0 - a - e + i), (d - b, c + g, f + h, 1.0 - a - e + i)),
    )[1]
    norm = math.hypot(*found)
    return tuple(each / norm for each in found)


def _of_quaternion(shares: list[float], scaling: Scaling) -> tuple[float, ...] | None:
    norm = math.hypot(*shares)
    if abs(norm - 1.0) > NORM_TOLERANCE:
        return None
    sign = -1.0 if scaling.conjugated else 1.0
    w, x, y, z = (each / norm for each in shares)
    return w, sign * x, sign * y, sign * z


_TURNS = {"angles": _of_angles, "matrix": _of_matrix, "quaternion": _of_quaternion}
