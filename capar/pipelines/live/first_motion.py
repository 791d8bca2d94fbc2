"""Whether a thing has moved since it was touched, asked of each frame as it comes."""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from capar.model.calibration import BodyCalibration, Calibration
from capar.pipelines.live.frames import Poses, Window
from extractors.calibration import thresholds_of


@dataclass(frozen=True, slots=True, eq=False)
class _Place:
    """Where a thing was when it was touched, and its row in a frame."""

    row: int
    position: Float[np.ndarray, "3"]
    orientation: Float[np.ndarray, "4"]
    known: BodyCalibration

    def is_left(self, poses: Poses) -> bool:
        """Whether the thing is beyond the floor of its motion; not where it is lost."""
        way_m = float(np.linalg.norm(poses.positions[self.row] - self.position))
        cosine = abs(float(poses.orientations[self.row] @ self.orientation))
        angle = 2.0 * float(np.arccos(min(cosine, 1.0)))
        return way_m > self.known.motion_floor_m or angle > self.known.motion_floor_rad


class FirstMotion:
    """Things whose first motion is awaited: once one moves, something is decided.

    It is asked of the poses as they are recorded, which costs next to nothing, so that the window
    is measured as soon as there is something new to see in it.

    Args:
        calibration: The floor of each thing's motion.
        rows: The row of each body in a frame, by ``object NAME``.
    """

    def __init__(self, calibration: Calibration, rows: Mapping[str, int]) -> None:
        self._calibration = calibration
        self._rows = rows
        self._places: list[_Place] = []
        limits = thresholds_of(calibration)
        self._least = 1 + round(limits.moving_minimum_s / calibration.step_s)
        self._away = 0

    def await_(self, window: Window, things: Mapping[str, int]) -> None:
        """Ask of these things from now on, and of no others.

        Args:
            window: The last frames.
            things: The frame at which each was touched first.
        """
        self._places = []
        for name, frame in things.items():
            stream = window.capture.bodies[name].stream
            at = max(frame - window.first, 0)
            self._places.append(
                _Place(
                    self._rows[f"object {name}"],
                    stream.positions[at],
                    stream.orientations[at],
                    self._calibration.tag_object(name),
                )
            )

    def is_seen(self, poses: Poses) -> bool:
        """Whether one of them has moved in a frame, and for as long as makes a motion."""
        self._away = self._away + 1 if any(place.is_left(poses) for place in self._places) else 0
        return self._away >= self._least
