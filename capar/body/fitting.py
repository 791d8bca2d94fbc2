"""From sensors to motion: the body follows its sensors frame by frame within its joint limits."""

import time
from collections.abc import Mapping
from dataclasses import dataclass, field, replace

import numpy as np
from jaxtyping import Bool, Float

from capar.body.human import ROOT_SIZE, Human
from capar.body.mounting import Calibration, mounted, places
from capar.body.sensor_following import Follower
from capar.body.skeleton import skeleton
from capar.body.targets import Target, target
from capar.model import geometry
from capar.model.capture import Stream
from capar.model.errors import CaparError
from extractors.readers.body_names.body_names import without_side

BRIDGE_COST = 0.5
"""Weight of the posture where a sensor is lost."""

LIMIT_MARGIN = float(np.radians(0.1))
"""A hinge this near its limit counts as at it [rad]."""


class FitError(CaparError):
    """Sensors that the body cannot be fitted to."""


ENDS = ("fingers", "fingertips", "thumb", "toes", "eye")
"""Segments that are taken to be seen with those that they are on."""


@dataclass(frozen=True, eq=False)
class Fit:
    """A body's motion that follows a recording."""

    human: Human
    """With its sensors where they were found."""

    times: Float[np.ndarray, "frames"]
    """[s]."""

    motion: Float[np.ndarray, "frames posture"]
    bridged: Mapping[str, Bool[np.ndarray, "frames"]]
    """By place, where its sensor was lost and the posture was interpolated."""

    residuals_m: Mapping[str, Float[np.ndarray, "frames"]]
    """By place, distance of the body's sensor site from the filtered sensor [m]; NaN if lost."""

    residuals_rad: Mapping[str, Float[np.ndarray, "frames"]]
    """Likewise the angle between them [rad]."""

    seconds: float
    """How long fitting took [s]."""

    segments: Mapping[str, str] = field(default_factory=dict)
    """By place followed, the segment that it is on."""

    @property
    def unrecorded(self) -> tuple[str, ...]:
        """Segments of which nothing is followed, on them or beyond them from the pelvis."""
        parents = {name: one.parent for name, one in skeleton(self.human.measures).items()}
        seen: set[str] = set()
        for followed in self.segments.values():
            above = followed
            while above and above not in seen:
                seen.add(above)
                above = parents[above]
        ends = {name for name in parents if without_side(name) in ENDS and parents[name] in seen}
        ends |= {name for name in parents if parents[name] in ends}
        return tuple(name for name in parents if name not in seen | ends)

    @property
    def at_limit(self) -> Bool[np.ndarray, "frames hinges"]:
        """Which hinges are at the end of their range."""
        low, high = self.human.ranges.T
        angles = self.motion[:, ROOT_SIZE:]
        return (angles <= low + LIMIT_MARGIN) | (angles >= high - LIMIT_MARGIN)


def fit(
    human: Human, streams: Mapping[str, Stream], calibration: Calibration, *, iterations: int = 1
) -> Fit:
    """Fit the body to any subset of its sensors.

    Args:
        human: The body.
        streams: By place, as recorded, on one clock.
        calibration: Where they sit on it.
        iterations: Of inverse kinematics a frame.

    Raises:
        FitError: No sensor is calibrated, or the clocks differ.
    """
    began = time.perf_counter()
    known = {place: each for place, each in streams.items() if place in calibration.mounts}
    if not known:
        raise FitError("none of the sensors was calibrated; calibrate with the same ones")
    clock = next(iter(known.values())).times
    for place, stream in known.items():
        if not np.array_equal(stream.times, clock):
            raise FitError(f"sensor {place!r} is on another clock; resample them to one")
    body = mounted(human, calibration)
    targets = {place: target(each) for place, each in known.items()}
    follower = Follower(body, targets, calibration.posture)
    motion = follower.run(range(len(clock)), calibration.posture, iterations)
    motion = _bridge(follower, motion, targets, iterations)
    seconds = time.perf_counter() - began
    bridged = {place: each.weights == 0.0 for place, each in targets.items()}
    segments = {place: places()[place] for place in known}
    made = Fit(body, clock, motion, bridged, {}, {}, seconds, segments)
    return _with_residuals(made, targets)


def _bridge(
    follower: Follower,
    motion: Float[np.ndarray, "frames posture"],
    targets: Mapping[str, Target],
    iterations: int,
) -> Float[np.ndarray, "frames posture"]:
    """The motion with unseen hinges led from the one end of every loss to the other."""
    faint = np.min([each.weights for each in targets.values()], axis=0) < 1.0
    out = motion.copy()
    for first, last in geometry.runs(faint):
        ends = [max(first - 1, 0), min(last + 1, len(motion) - 1)]
        if faint[ends[0]] or faint[ends[1]]:  # a loss at an end of the recording: hold the other
            ends = ends[1:] * 2 if faint[ends[0]] else ends[:1] * 2
        follower.configuration.update(motion[ends[0]])
        for frame in range(first, last + 1):
            share = (frame - first + 1) / (last - first + 2)
            follower.posture.set_target(_between(motion[ends[0]], motion[ends[1]], share))
            follower.posture.set_cost(follower.posture_cost + follower.blind(frame) * BRIDGE_COST)
            follower.aim(frame)
            for _ in range(iterations + 1):
                follower.step()
            out[frame] = follower.configuration.q
    return out


def _between(
    first: Float[np.ndarray, "posture"], last: Float[np.ndarray, "posture"], share: float
) -> Float[np.ndarray, "posture"]:
    """A posture on the way, of minimum jerk; the pelvis's pose is the last's."""
    way = share**3 * (10.0 - 15.0 * share + 6.0 * share**2)
    return first + way * (last - first)


def _with_residuals(made: Fit, targets: Mapping[str, Target]) -> Fit:
    sites = made.human.sites(made.motion, [f"sensor_{each}" for each in targets])
    metres, radians = {}, {}
    for place, one in targets.items():
        spots, turns = sites[f"sensor_{place}"]
        metres[place] = np.linalg.norm(spots - one.positions, axis=1)
        radians[place] = geometry.angle_between(turns, one.orientations)
    return replace(made, residuals_m=metres, residuals_rad=radians)
