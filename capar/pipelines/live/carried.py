"""What is known of the frames before a window: low-passed poses, and sums since the first frame."""

from dataclasses import replace

import numpy as np
from jaxtyping import Float

from capar.model.calibration import Calibration
from capar.model.capture import Stream, TagType
from capar.pipelines.live.frames import Window
from extractors.bodies.bodies import Bodies, BodyGeometry, bodies_of
from extractors.bodies.poses import Poses
from extractors.calibration import check_clock, thresholds_of
from extractors.measure import Measurements
from extractors.relations.places import FROM_THE_BEGINNING, Sums, sums_at


class Carried:
    """Poses up to the last settled frame, and paths and turns summed up to it.

    Resting bodies are placed by the poses, and rules compare the sums of different windows.
    """

    def __init__(self, calibration: Calibration, frames: int) -> None:
        self._calibration = calibration
        self._limits = thresholds_of(calibration)
        self._frames = frames
        self._past: dict[str, Float[np.ndarray, "frames 7"]] = {}
        self._frontier = -1
        self._sums = FROM_THE_BEGINNING
        self.sums_frame = 0
        """The frame of the recording at which the sums are known."""

    def sums(self, window: Window) -> Sums:
        """The sums for a window that holds the frame at which they are known."""
        return replace(self._sums, anchor=self.sums_frame - window.first)

    def advance_sums(self, window: Window, measurements: Measurements, frame: int) -> None:
        """Take from a measured window the sums at a later frame of the recording."""
        capture, bodies = window.capture, measurements.bodies
        hands = {each.name: bodies.sensors[each.name] for each in capture.acting}
        mobile = {
            each.name: bodies.objects[each.name]
            for each in capture.objects
            if each.tag is TagType.MOBILE
        }
        self._sums = sums_at(
            (mobile | hands).values(),
            bodies.objects.values(),
            frame - window.first,
            self.sums(window),
        )
        self.sums_frame = frame

    def bodies(self, window: Window) -> Bodies:
        """The bodies of a window, each with its poses from before it.

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

    def advance_poses(self, window: Window, bodies: Bodies, frontier: int) -> None:
        """Keep the poses up to a later frame of the recording."""
        if frontier <= self._frontier:
            return
        part = slice(self._frontier + 1 - window.first, frontier + 1 - window.first)
        for kind, group in (("sensor", bodies.sensors), ("object", bodies.objects)):
            for name, body in group.items():
                if body.poses.rests:
                    continue
                stream, key = body.poses.smooth, f"{kind} {name}"
                new = np.hstack([stream.positions[part], stream.orientations[part]])
                past = self._past.get(key, np.empty((0, 7)))
                self._past[key] = np.concatenate((past, new))[-self._frames :] if len(past) else new
        self._frontier = frontier

    def _extended(self, name: str, poses: Poses, window: Window) -> Poses:
        """Poses with the settled ones before the window, and in it where its filter had no past."""
        past = self._past.get(name)
        if past is None or self._frontier + 1 - len(past) >= window.first:
            return poses
        older = len(past) - (self._frontier + 1 - window.first)
        stream = poses.smooth
        inside = np.hstack([stream.positions, stream.orientations])
        known = min(len(past) - older, len(inside))
        inside[:known] = past[older : older + known]
        earlier = stream.times[0] - self._calibration.step_s * np.arange(older, 0, -1)
        table = np.concatenate((past[:older], inside))
        longer = Stream(np.concatenate((earlier, stream.times)), table[:, :3], table[:, 3:])
        smooth = Stream(stream.times, inside[:, :3], inside[:, 3:])
        settled = smooth if poses.settled is stream else poses.settled
        return replace(poses, smooth=smooth, settled=settled, longer=longer)
