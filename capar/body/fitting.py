"""From sensors to motion: the body follows its sensors frame by frame within its joint limits."""

import time
from collections.abc import Mapping
from dataclasses import dataclass, replace

import mink
import numpy as np
from jaxtyping import Bool, Float

from capar.body.human import ROOT_SIZE, Human
from capar.body.mounting import Calibration, mounted, places
from capar.body.targets import Target, target
from capar.model import geometry
from capar.model.capture import Stream
from capar.model.errors import CaparError

SOLVER = "daqp"
POSITION_COST = 10.0
"""Weight of a metre."""

ORIENTATION_COST = 3.0
"""Weight of a radian."""

POSTURE_COST = 0.05
"""Weight of a radian away from the posture aimed at, for a hinge of one radian's range."""

DAMPING_COST = 0.03
"""Weight of a radian's step from frame to frame: without it solutions chatter at joint limits."""

LOWER = ("pelvis", "thigh", "shank", "foot", "toes")
"""How the names of segments of the lower body end."""

UPRIGHT_COST = 0.5
"""Weight of a radian of the pelvis's tilt where nothing below the chest is seen."""

STANDING_COST = (5.0, 0.5)
"""Weights of a metre of a foot's height and of a radian of its tilt, likewise."""

BRIDGE_COST = 0.5
"""Weight of the posture where a sensor is lost."""

SETTLING = 60
"""Iterations for the first frame."""

STEP_S = 1.0
"""Unit of time of one step [s]; steps are bounded as angles, whatever the recording's rate."""

LARGEST_STEP = 0.35
"""Largest step of a hinge in one iteration [rad]."""

LIMIT_MARGIN = float(np.radians(0.1))
"""A hinge this near its limit counts as at it [rad]."""


class FitError(CaparError):
    """Sensors that the body cannot be fitted to."""


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
    made = Fit(body, clock, motion, bridged, {}, {}, seconds)
    return _with_residuals(made, targets)


class Follower:
    """Inverse kinematics that keeps the sites of sensors on their targets."""

    def __init__(
        self, human: Human, targets: Mapping[str, Target], rest: Float[np.ndarray, "posture"]
    ) -> None:
        self.human, self.targets = human, targets
        self.frames = {
            place: mink.FrameTask(f"sensor_{place}", "site", POSITION_COST, ORIENTATION_COST)
            for place in targets
        }
        self.posture_cost = np.zeros(human.model.nv)
        self.posture_cost[6:] = POSTURE_COST / np.sqrt(np.ptp(human.ranges, axis=1))
        self.posture = mink.PostureTask(human.model, cost=self.posture_cost)
        self.posture.set_target(rest)
        self.damping = mink.DampingTask(human.model, cost=DAMPING_COST)
        speeds = dict.fromkeys(human.joints, LARGEST_STEP / STEP_S)
        self.limits = [
            mink.ConfigurationLimit(human.model),
            mink.VelocityLimit(human.model, speeds),
        ]
        self.configuration = mink.Configuration(human.model)
        self.stance = [] if self._sees_legs() else self._stance(rest)

    def _sees_legs(self) -> bool:
        """Whether a sensor is on the pelvis or below it."""
        return any(places()[place].endswith(LOWER) for place in self.targets)

    def _stance(self, rest: Float[np.ndarray, "posture"]) -> list[mink.FrameTask]:
        """Tasks of a body of which only the upper part is seen: it stands, wherever that is.

        The pelvis keeps upright, and the feet flat at the height at which they are in the
        reference posture; else a body that bends forward would tilt as one piece.
        """
        self.configuration.update(rest)
        level = [1.0, 1.0, 0.0]
        upright = np.multiply(UPRIGHT_COST, level)
        height, flat = np.array([0.0, 0.0, STANDING_COST[0]]), np.multiply(STANDING_COST[1], level)
        tasks = [mink.FrameTask("pelvis", "body", 0.0, upright)]
        tasks += [mink.FrameTask(f"{s}_foot", "body", height, flat) for s in ("right", "left")]
        for task in tasks:
            task.set_target_from_configuration(self.configuration)
        return tasks

    def run(
        self, frames: range, start: Float[np.ndarray, "posture"], iterations: int
    ) -> Float[np.ndarray, "frames posture"]:
        """Postures at some frames in a row, from a posture near the first."""
        self.configuration.update(start)
        out = np.empty((len(frames), len(start)))
        for row, frame in enumerate(frames):
            self.aim(frame)
            for _ in range(iterations if row else SETTLING):
                self.step()
            out[row] = self.configuration.q
        return out

    def aim(self, frame: int) -> None:
        """Set every task to a frame's targets."""
        for place, task in self.frames.items():
            one = self.targets[place]
            weight = one.weights[frame]
            task.set_position_cost(POSITION_COST * weight)
            task.set_orientation_cost(ORIENTATION_COST * weight)
            if weight > 0.0:
                pose = np.concatenate([one.orientations[frame], one.positions[frame]])
                task.set_target(mink.SE3(pose))

    def blind(self, frame: int) -> Float[np.ndarray, "dofs"]:
        """How little each hinge is seen at a frame: 1 between a lost sensor and the next seen."""
        model, out = self.human.model, np.zeros(self.human.model.nv)
        weights = {places()[place]: each.weights[frame] for place, each in self.targets.items()}
        for segment, weight in weights.items():
            body = model.body(segment).id
            while weight < 1.0 and body > model.body("pelvis").id:
                start = model.body_dofadr[body]
                out[start : start + model.body_dofnum[body]] = 1.0 - weight
                body = model.body_parentid[body]
                if weights.get(model.body(body).name, 0.0) >= 1.0:
                    break
        return out

    def step(self) -> None:
        """One step of inverse kinematics."""
        tasks = [task for task in self.frames.values() if task.cost[0] > 0.0]
        velocity = mink.solve_ik(
            self.configuration,
            [*tasks, *self.stance, self.posture, self.damping],
            STEP_S,
            SOLVER,
            limits=self.limits,
        )
        self.configuration.integrate_inplace(velocity, STEP_S)


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
