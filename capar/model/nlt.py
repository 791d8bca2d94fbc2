"""Normalised local transforms: where a constraint is on an object, in the object's own measures.

A normalised local transform (NLT) is a place in an object's frame divided by the object's size,
axis by axis, so that it holds for any object of its kind, and an orientation (thesis 4.4.2.2). An
axis along which the object has no extent keeps its metres.
"""

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from capar.model import geometry

NO_EXTENT_M = 1e-6
"""A size below this is none [m]."""

ACROSS = 1
"""The axis (y) across an object's plane that parts its left (+y) from its right."""


@dataclass(frozen=True, slots=True, order=True)
class Nlt:
    """Normalised local transform: a place in an object's frame over its size, and a quaternion."""

    position: tuple[float, float, float]
    orientation: tuple[float, float, float, float]
    """Unit quaternion w x y z that takes the constraint's axes to the object's."""

    def mirrored(self, axis: int = ACROSS) -> "Nlt":
        """The same place for the other side of the body (thesis 4.4.2.2).

        Mirrored in the plane through the object's origin across an axis; the constraint's own axes
        are those of the other side's end-effector, mirrored alike.

        Args:
            axis: 0, 1 or 2 for x, y or z; by default the one that points to the object's left.
        """
        x, y, z = (0.0 - each if i == axis else each for i, each in enumerate(self.position))
        w, *vector = self.orientation
        i, j, k = (each if n == axis else 0.0 - each for n, each in enumerate(vector))
        return Nlt((x, y, z), (w, i, j, k))


def normalised(
    point: Float[np.ndarray, "3"],
    orientation: Float[np.ndarray, "4"],
    size_m: Float[np.ndarray, "3"],
) -> Nlt:
    """The NLT of a place [m] and an orientation in the frame of an object of a size [m]."""
    x, y, z = map(float, point / _divisors(size_m))
    w, i, j, k = map(float, orientation * (-1.0 if orientation[0] < 0.0 else 1.0))
    return Nlt((x, y, z), (w, i, j, k))


def restored(
    nlt: Nlt, size_m: Float[np.ndarray, "3"]
) -> tuple[Float[np.ndarray, "3"], Float[np.ndarray, "4"]]:
    """The place [m] and orientation that an NLT means in the frame of an object of a size [m]."""
    return np.asarray(nlt.position) * _divisors(size_m), np.asarray(nlt.orientation)


def relative_orientation(
    base: Float[np.ndarray, "4"], other: Float[np.ndarray, "4"]
) -> Float[np.ndarray, "4"]:
    """An orientation in the frame of another one, both given in the world (w x y z)."""
    return geometry.quaternions(geometry.rotations(base).inv() * geometry.rotations(other))


def local_point(
    position: Float[np.ndarray, "3"],
    orientation: Float[np.ndarray, "4"],
    point: Float[np.ndarray, "3"],
) -> Float[np.ndarray, "3"]:
    """A point of the world [m] in the frame of a body at a position [m] and orientation."""
    return np.asarray(geometry.rotations(orientation).inv().apply(point - position))


def _divisors(size_m: Float[np.ndarray, "3"]) -> Float[np.ndarray, "3"]:
    return np.where(np.asarray(size_m) > NO_EXTENT_M, size_m, 1.0)
