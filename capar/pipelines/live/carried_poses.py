"""Poses from before a window, by which it is told where bodies rest there."""

from dataclasses import dataclass, replace

import numpy as np
from jaxtyping import Float

from capar.model.calibration import Calibration
from capar.model.capture import Stream
from capar.pipelines.live.frames import Window
from extractors.bodies.bodies import Bodies, BodyGeometry, bodies_of
from extractors.bodies.poses import Poses
from extractors.calibration import check_clock, thresholds_of


@dataclass(frozen=True, eq=False)
class _Past:
    """The settled poses of a body, up to the frontier."""

    positions: Float[np.ndarray, "frames 3"]
    orientations: Float[np.ndarray, "frames 4"]


class CarriedPoses:
    """The low-passed poses of the last seconds up to the last settled frame.

    Args:
        calibration: What was decided before.
        frames: How many frames are kept: a longer rest is told by its last ones.
    """

    def __init__(self, calibration: Calibration, frames: int) -> None:
        self._calibration = calibration
        self._limits = thresholds_of(calibration)
        self._frames = frames
        self._past: dict[str, _Past] = {}
        self._frontier = -1

    def bodies(self, window: Window) -> Bodies:
        """The bodies of a window, each with its poses from longer ago.

        Raises:
            CaptureError: The calibration is for another rate.
        """
        check_clock(window.capture, self._calibration)
        plain = bodies_of(window.capture, self._limits, self._calibration)
        longer: dict[int, Poses] = {}

        def extended(kind: str, body: BodyGeometry) -> BodyGeometry:
            key = id(body.poses)
            if key not in longer:
                longer[key] = self._extended(f"{kind} {body.name}", body.poses, window)
            return replace(body, poses=longer[key])

        return Bodies(
            {name: extended("sensor", body) for name, body in plain.sensors.items()},
            {name: extended("object", body) for name, body in plain.objects.items()},
            plain.parts,
        )

    def advance(self, window: Window, bodies: Bodies, frontier: int) -> None:
        """Keep the poses up to a later frame of the recording."""
        if frontier <= self._frontier:
            return
        part = slice(self._frontier + 1 - window.first, frontier + 1 - window.first)
        groups = (("sensor", bodies.sensors), ("object", bodies.objects))
        for kind, group in groups:
            for name, body in group.items():
                if not body.poses.rests:
                    self._keep(f"{kind} {name}", body.poses.smooth, part)
        self._frontier = frontier

    def _keep(self, name: str, stream: Stream, part: slice) -> None:
        new = _Past(stream.positions[part], stream.orientations[part])
        past = self._past.get(name)
        if past is not None:
            new = _Past(
                np.concatenate((past.positions, new.positions))[-self._frames :],
                np.concatenate((past.orientations, new.orientations))[-self._frames :],
            )
        self._past[name] = new

    def _extended(self, name: str, poses: Poses, window: Window) -> Poses:
        past = self._past.get(name)
        begin = window.first
        if past is None or self._frontier + 1 - len(past.positions) >= begin:
            return poses
        older = len(past.positions) - (self._frontier + 1 - begin)
        stream = poses.smooth
        step_s = self._calibration.step_s
        times = stream.times[0] - step_s * np.arange(older, 0, -1)
        longer = Stream(
            np.concatenate((times, stream.times)),
            np.concatenate((past.positions[:older], stream.positions)),
            np.concatenate((past.orientations[:older], stream.orientations)),
        )
        known = _smooth_before(longer, past, older)
        inside = slice(older, None)
        smooth = Stream(stream.times, known.positions[inside], known.orientations[inside])
        settled = smooth if poses.settled is stream else poses.settled
        return replace(poses, smooth=smooth, settled=settled, longer=known)


def _smooth_before(longer: Stream, past: _Past, older: int) -> Stream:
    """The same, with settled poses also where a window begins: its filter has no past there."""
    count = min(len(past.positions) - older, len(longer.times) - older)
    positions, orientations = longer.positions.copy(), longer.orientations.copy()
    part = slice(older, older + count)
    positions[part] = past.positions[older : older + count]
    orientations[part] = past.orientations[older : older + count]
    return Stream(longer.times, positions, orientations)
