"""A second decoder of Flock of Birds records: numpy over the whole array of bytes at once.

Written from the protocol's description alone, before and without the decoder under test, so that
a misreading in one of the two shows. It keeps every record that has exactly its length between
two phase bits, and knows nothing of streams, losses or time.
"""

from dataclasses import dataclass

import numpy as np
from scipy.spatial.transform import Rotation

COLUMNS = {
    "pos": "ppp",
    "ang": "aaa",
    "mat": "mmmmmmmmm",
    "quat": "qqqq",
    "pos_ang": "pppaaa",
    "pos_mat": "pppmmmmmmmmm",
    "pos_quat": "pppqqqq",
}
"""What each word of a record is, by format."""

INCH_M = 0.0254


@dataclass(frozen=True)
class Decoded:
    """Records in the order of the bytes; poses in the transmitter's frame (z down)."""

    addresses: np.ndarray
    words: np.ndarray
    positions: np.ndarray | None
    rotations: Rotation | None


def decode(data: bytes, form: str, *, group: bool, range_inch: float) -> Decoded:
    """Every whole record of the bytes."""
    kinds = np.array(list(COLUMNS[form]))
    rows = whole_records(data, 2 * len(kinds) + group)
    pairs = rows[:, : 2 * len(kinds)].astype(np.uint16).reshape(len(rows), len(kinds), 2) & 0x7F
    low, high = pairs[..., 0] << 2, pairs[..., 1] << 9
    words = (low | high).view(np.int16).astype(float)
    addresses = rows[:, -1].astype(int) if group else np.zeros(len(rows), int)
    return Decoded(addresses, words, *poses_of(words, form, range_inch=range_inch))


def poses_of(
    words: np.ndarray, form: str, *, range_inch: float
) -> tuple[np.ndarray | None, Rotation | None]:
    """Positions [m] and rotations of rows of words."""
    kinds = np.array(list(COLUMNS[form]))
    shares = words / 32768.0
    places = shares[:, kinds == "p"] * range_inch * INCH_M if "p" in kinds else None
    return places, _rotations(shares, kinds)


def whole_records(data: bytes, length: int) -> np.ndarray:
    """The bytes of each record of the right length, one row a record."""
    octets = np.frombuffer(data, np.uint8)
    starts = np.flatnonzero(octets >= 0x80)
    lengths = np.diff(np.append(starts, len(octets)))
    good = starts[lengths == length]
    return octets[good[:, None] + np.arange(length)[None, :]]


def _rotations(shares: np.ndarray, kinds: np.ndarray) -> Rotation | None:
    """Rotations that take sensor coordinates to the transmitter's."""
    if not len(shares):
        return None
    if "a" in kinds:
        return Rotation.from_euler("ZYX", shares[:, kinds == "a"] * 180.0, degrees=True)
    if "m" in kinds:
        return Rotation.from_matrix(shares[:, kinds == "m"].reshape(-1, 3, 3))
    if "q" in kinds:
        scalar, x, y, z = shares[:, kinds == "q"].T
        return Rotation.from_quat(np.stack([x, y, z, scalar], axis=1)).inv()
    return None
