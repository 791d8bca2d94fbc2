"""The points of two bodies that come together where they touch, found from frames of contact."""

from dataclasses import dataclass

import numpy as np
from jaxtyping import Bool, Float

from capar.model.capture import Stream
from extractors.bodies.poses import rotation_matrices
from extractors.thresholds import Thresholds

Vector = tuple[float, float, float]


@dataclass(frozen=True, slots=True)
class TouchPoints:
    """A point of each body, in its own frame [m]; they coincide where the bodies touch."""

    first: Vector = (0.0, 0.0, 0.0)
    second: Vector = (0.0, 0.0, 0.0)

    def apart(self, first: Stream, second: Stream) -> Float[np.ndarray, "frames"]:
        """Distance of the two points [m]; NaN where either body is lost."""
        return np.asarray(np.linalg.norm(_at(first, self.first) - _at(second, self.second), axis=1))


def touch_points(
    first: Stream, second: Stream, frames: Bool[np.ndarray, "frames"], thresholds: Thresholds
) -> TouchPoints:
    """The points that stay nearest to each other through some frames, by least squares.

    Another origin of a body's stream moves its point by the same offset the other way, so the
    distance of the points hardly depends on where on its body a marker cluster sits.
    """
    turns = (
        rotation_matrices(first.orientations[frames]),
        rotation_matrices(second.orientations[frames]),
    )
    rows = np.concatenate([turns[0], -turns[1]], axis=2)
    offset = second.positions[frames] - first.positions[frames]
    normal = np.einsum("fij,fik->jk", rows, rows) / len(rows) + thresholds.touch_ridge * np.eye(6)
    right = np.einsum("fij,fi->j", rows, offset) / len(rows)
    found = [float(value) for value in np.linalg.solve(normal, right)]
    return TouchPoints((found[0], found[1], found[2]), (found[3], found[4], found[5]))


def _at(stream: Stream, point: Vector) -> Float[np.ndarray, "frames 3"]:
    return np.asarray(stream.positions + rotation_matrices(stream.orientations) @ np.array(point))
