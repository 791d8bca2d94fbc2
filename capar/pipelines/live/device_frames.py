"""Frames of a tracker as poses of a rig on an even clock; what was lost is lost, never invented."""

from collections.abc import Iterator, Sequence

import numpy as np

from capar.model.capture import Capture, Sensor, TagObject
from capar.model.errors import DeviceError
from capar.pipelines.live.frames import Poses
from extractors.devices.tracker import Description, Frame

LONGEST_LOSS_S = 10.0
"""A longer silence is not filled with lost frames [s]: the clock goes on from there."""


class DeviceFrames:
    """Puts frames of a tracker in the order of a rig's bodies and on the rig's clock.

    Bodies that the tracker does not know stand where they stand in the rig's first known frame;
    so do tables and walls. Of cycles that were lost every body is lost.

    Args:
        rig: Bodies, by the names of the tracker's sensors.
        names: Names of the bodies of a frame's rows, in order.
        description: The tracker.
        step_s: Time between two frames [s].

    Raises:
        DeviceError: The tracker has none of the rig's moving bodies, or no full poses.
    """

    def __init__(
        self, rig: Capture, names: Sequence[str], description: Description, step_s: float
    ) -> None:
        known = {name: index for index, name in enumerate(description.sensors)}
        self._rows = [known.get(name.split(" ", 1)[1], -1) for name in names]
        untracked = [
            each.split(" ", 1)[1] for each, row in zip(names, self._rows, strict=True) if row < 0
        ]
        moving = [each for each in untracked if not _stands(rig.bodies[each])]
        if moving or not (description.has_positions and description.has_orientations):
            raise DeviceError(
                f"the tracker sends positions and orientations of {list(description.sensors)}; "
                f"the rig also needs {moving}, which move. Name the tracker's sensors as the rig "
                "does, with names=... in the device address, or take a rig of that tracker"
            )
        self._still = [_first_pose(rig.bodies[each.split(" ", 1)[1]]) for each in names]
        self._step_s = step_s
        self._rate_hz = description.rate_hz
        self._count = 0
        self._start_s = 0.0
        self.filled = 0
        """Frames that were missing, and are told as lost."""

    def poses(self, frame: Frame) -> Iterator[Poses]:
        """The frame, after lost frames in place of those that are missing before it."""
        time_s = self._measured_s(frame)
        if time_s is not None:
            missing = round((time_s - self._start_s) / self._step_s) - self._count
            if self._count == 0 or missing < 0 or missing > LONGEST_LOSS_S / self._step_s:
                # The first frame, or a device that counts anew.
                self._start_s = time_s - self._count * self._step_s
                missing = 0
            for _ in range(missing):
                yield self._next(None)
            self.filled += missing
        yield self._next(frame)

    def _next(self, frame: Frame | None) -> Poses:
        positions, orientations = (
            np.full((len(self._rows), 3), np.nan),
            np.full((len(self._rows), 4), np.nan),
        )
        for index, row in enumerate(self._rows):
            if row < 0:
                positions[index], orientations[index] = self._still[index]
            elif frame is not None:
                positions[index] = frame.positions[row]
                orientations[index] = frame.orientations[row]
        time_s = self._count * self._step_s
        self._count += 1
        return Poses(time_s, positions, orientations)

    def _measured_s(self, frame: Frame) -> float | None:
        """When a frame was measured by the device's own clock [s]; None where it has none.

        The time of arrival jitters by more than a step: such frames are taken to be even.
        """
        if frame.device_s is not None:
            return frame.device_s
        if frame.cycle is not None and np.isfinite(self._rate_hz):
            return frame.cycle / self._rate_hz
        return None


def _stands(body: Sensor | TagObject) -> bool:
    """Whether a body stands at one place throughout."""
    seen = body.stream.positions[~body.stream.lost]
    return bool(len(seen) and np.ptp(seen, axis=0).max() < STANDS_M)


STANDS_M = 0.02
"""What has not gone farther in the rig's own recording stands [m]: noise is less."""


def _first_pose(body: Sensor | TagObject) -> tuple[np.ndarray, np.ndarray]:
    known = np.flatnonzero(~body.stream.lost)
    if not known.size:
        return np.full(3, np.nan), np.full(4, np.nan)
    return body.stream.positions[known[0]], body.stream.orientations[known[0]]
