"""A body that follows the sensors of a test motion: palms, feet, head and mouth, and in balance."""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass

import mink
import numpy as np
from jaxtyping import Bool, Float
from motions.shapes import mouth
from scipy.spatial.transform import RigidTransform, Rotation

from capar.body.gaze import share_costs
from capar.body.human import Human
from capar.body.inverse_kinematics import BalanceLimit, BalanceTask, Solver, Support, sole, support
from capar.body.performing import RELAXED
from capar.body.scripts import SIDES
from capar.model import geometry
from capar.model.capture import Capture, Sensor
from capar.regeneration.sources import body_hand_frame, hand_frame, palm_of

CLOSE_M, CLOSE_RAD = 0.002, float(np.radians(1.0))
"""What is missed by less is followed [m, rad]."""

RATE_HZ = 10.0
FEWEST, MOST = 4, 60
"""Steps of the inverse kinematics at a frame: more while something is missed."""

PALM, FOOT = (60.0, 8.0), (60.0, 8.0)
HEAD, MOUTH = (0.0, 4.0), (60.0, 0.0)
"""Weights of a metre and of a radian; what has no weight is not asked for."""

MIDDLE = 2.0
"""Weight of a metre of the centre of mass from above the middle of the feet."""

BEARS_M = 0.015
"""A foot that is no higher than this above its lowest place bears weight [m]."""

SHIFT = 2
"""So many frames before and after it a foot that is lifted or set down moves the weight."""


@dataclass(frozen=True, eq=False)
class Follow:
    """A site or segment of the body, and where it is to be."""

    frame: str
    kind: str
    costs: tuple[float, float]
    path: RigidTransform


@dataclass(frozen=True, eq=False)
class Course:
    """What a body did that followed a motion."""

    times: Float[np.ndarray, "frames"]
    """[s]."""

    postures: Float[np.ndarray, "frames posture"]
    errors: Float[np.ndarray, "frames places 2"]
    """By how much each place is missed [m, rad]."""

    beside: Float[np.ndarray, "frames"]
    """How far the centre of mass is beyond the base of support [m]; negative inside."""


def chosen_frames(capture: Capture) -> np.ndarray:
    """The frames that are followed, about ``RATE_HZ`` a second."""
    step = max(round(capture.rate_hz / RATE_HZ), 1)
    return np.arange(0, len(capture.times), step)


def followed(capture: Capture, human: Human) -> Iterator[Follow]:
    """The body's places that the sensors of the first agent lead."""
    chosen = chosen_frames(capture)
    for sensor in capture.sensors:
        if capture.agent_of(sensor) != capture.agent.name or sensor.part_of:
            continue
        stream = sensor.stream
        path = geometry.transforms(stream.positions[chosen], stream.orientations[chosen])
        if sensor.end_effector == "hand" and sensor.shape is not None:
            yield Follow(f"{sensor.side}_palm", "site", PALM, path * _palm(sensor, human))
        elif sensor.end_effector == "foot":
            yield Follow(f"{sensor.side}_foot", "body", FOOT, path * _ankle(sensor, human))
        elif sensor.end_effector == "head":
            yield Follow("head", "body", HEAD, path)
            if "head" in {thing.name for thing in capture.objects}:
                spot = RigidTransform.from_translation(mouth())
                yield Follow("mouth", "site", MOUTH, path * spot)


def _palm(sensor: Sensor, human: Human) -> RigidTransform:
    """``T_sensor_palm``: a test motion's hand points along x, and its back is along z."""
    assert sensor.shape is not None
    frame = hand_frame(sensor.shape, np.array([1.0, 0.0, 0.0]), np.array([0.0, 0.0, -1.0]))
    return frame.pose * palm_of(human, sensor.side, body_hand_frame(human, sensor.side))


def _ankle(sensor: Sensor, human: Human) -> RigidTransform:
    """``T_sensor_ankle``: the soles of both feet have the same middle."""
    own = _middle(sole(human, sensor.side))
    if sensor.shape is None:
        return RigidTransform.from_translation(-own)
    return RigidTransform.from_translation(_middle(sensor.shape.vertices) - own)


def _middle(corners: Float[np.ndarray, "corners 3"]) -> Float[np.ndarray, "3"]:
    """The middle of a foot from above, at the height of its sole [m]."""
    low, high = corners.min(axis=0), corners.max(axis=0)
    return np.array([*(low + high)[:2] / 2.0, low[2]])


class Follower:
    """A body that follows a motion from one place to stand."""

    def __init__(
        self,
        times: Float[np.ndarray, "frames"],
        human: Human,
        wanted: list[Follow],
        stands: tuple[float, float],
        *,
        balanced: bool = True,
    ) -> None:
        """Set the body up.

        Args:
            times: Of the frames [s].
            human: The body.
            wanted: What it follows.
            stands: Where the feet stay that are not led [m].
            balanced: Whether the weight is kept above the feet that bear it.
        """
        self.times, self.wanted = times, wanted
        eased = {f"{s}_{n}": float(np.radians(a)) for n, a in RELAXED.items() for s in SIDES}
        self.rest = human.posture(eased, place=(*stands, 0.0))
        self.configuration = mink.Configuration(human.model)
        self.configuration.update(self.rest)
        self.supports = _supports(human, _feet(wanted, self.configuration, len(times)))
        self.middles = _middles(self.supports)
        self.tasks = [mink.FrameTask(place.frame, place.kind, *place.costs) for place in wanted]
        ease = mink.PostureTask(human.model, cost=share_costs(human, 0.05))
        ease.set_target(self.rest)
        led = {place.frame for place in wanted}
        feet = [f"{side}_foot" for side in SIDES if f"{side}_foot" not in led]
        stance = [mink.FrameTask(name, "body", *FOOT) for name in feet]
        for task in stance:
            task.set_target_from_configuration(self.configuration)
        self.middle = mink.ComTask(cost=[MIDDLE, MIDDLE, 0.0])
        self.middle.set_target_from_configuration(self.configuration)
        self.above = self.configuration.data.subtree_com[1] - [*self.middles[0], 0.0]
        self.back, self.edge = BalanceTask(self.supports[0]), BalanceLimit(self.supports[0])
        damping = mink.DampingTask(human.model, cost=0.05)
        tasks = [*self.tasks, ease, damping, *stance, self.middle]
        if balanced:
            self.solver = Solver(human, [*tasks, self.back], limits=[self.edge])
        else:
            self.solver = Solver(human, tasks)
        self.balanced = balanced

    def run(
        self,
        start: int,
        posture: Float[np.ndarray, "posture"],
        *,
        enough: tuple[float, float] | None = None,
    ) -> Course | None:
        """Follow the motion from one frame to its end, and from there back to its beginning.

        Args:
            start: The first frame that is followed.
            posture: That the body then comes from.
            enough: What may be missed [m, rad].

        Returns:
            What was done; None if it was given up at the first frame that missed more than enough.
        """
        count = len(self.times)
        postures, beside = np.zeros((count, len(posture))), np.zeros(count)
        errors = np.zeros((count, len(self.wanted), 2))
        for frames in (range(start, count), range(start - 1, -1, -1)):
            self.configuration.update(posture if frames.step > 0 else postures[start])
            for frame in frames:
                errors[frame] = self._meet(frame)
                postures[frame] = self.configuration.q
                weight = self.configuration.data.subtree_com[1, :2]
                beside[frame] = self.supports[frame].outside(weight)
                if enough is not None and (errors[frame] > enough).any():
                    return None
        return Course(self.times, postures, errors, beside)

    def _meet(self, frame: int) -> Float[np.ndarray, "places 2"]:
        """Go to a frame's targets; what is missed then [m, rad]."""
        for task, place in zip(self.tasks, self.wanted, strict=True):
            task.set_target(_se3(place.path[frame]))
        self.back.base = self.edge.base = self.supports[frame]
        self.middle.set_target(self.above + np.array([*self.middles[frame], 0.0]))
        self.solver.restart()
        errors = np.zeros((len(self.wanted), 2))
        for number in range(MOST):
            self.solver.step(self.configuration)
            errors = np.array([_error(self.configuration, place, frame) for place in self.wanted])
            close = number >= FEWEST and (errors < (CLOSE_M, CLOSE_RAD)).all()
            beside = self.back.compute_error(self.configuration)[0] if self.balanced else 0.0
            if (close and beside < CLOSE_M) or self.solver.settled:
                break
        return errors.reshape(-1, 2)


def _feet(
    wanted: list[Follow], configuration: mink.Configuration, frames: int
) -> dict[str, RigidTransform]:
    """``T_world_foot`` at each frame by side: where it is led, and else where it stands."""
    led = {place.frame: place.path for place in wanted}
    out = {}
    for side in SIDES:
        pose = configuration.get_transform_frame_to_world(f"{side}_foot", "body")
        turn = Rotation.from_quat(pose.rotation().wxyz, scalar_first=True)
        still = RigidTransform.from_components(np.tile(pose.translation(), (frames, 1)), turn)
        out[side] = led.get(f"{side}_foot", still)
    return out


def _supports(human: Human, feet: Mapping[str, RigidTransform]) -> list[Support]:
    """The base of support at each frame; where no foot is down, the one before."""
    bears = {side: _bears(path) for side, path in feet.items()}
    known: dict[tuple[float, ...], Support] = {}
    out: list[Support] = []
    for frame in range(len(next(iter(bears.values())))):
        ankles = {side: path[frame] for side, path in feet.items() if bears[side][frame]}
        if not ankles:
            out.append(out[-1])
            continue
        places = np.concatenate([ankle.as_matrix().ravel() for ankle in ankles.values()])
        key = tuple(places.round(6))
        if key not in known:
            known[key] = support(human, ankles)
        out.append(known[key])
    return out


def _bears(path: RigidTransform) -> Bool[np.ndarray, "frames"]:
    heights = path.translation[:, 2]
    return np.asarray(heights <= heights.min() + BEARS_M)


def _middles(supports: list[Support]) -> Float[np.ndarray, "frames 2"]:
    """Where the weight is drawn to [m]: to a foot that will bear it some frames before it does."""
    middles = np.array([base.middle for base in supports])
    padded = np.pad(middles, ((SHIFT, SHIFT), (0, 0)), mode="edge")
    windows = np.lib.stride_tricks.sliding_window_view(padded, 2 * SHIFT + 1, axis=0)
    return np.asarray(windows.mean(axis=-1))


def _error(configuration: mink.Configuration, place: Follow, frame: int) -> tuple[float, float]:
    pose = configuration.get_transform_frame_to_world(place.frame, place.kind)
    goal = place.path[frame]
    turn = Rotation.from_quat(pose.rotation().wxyz, scalar_first=True).inv() * goal.rotation
    metres = float(np.linalg.norm(pose.translation() - goal.translation))
    radians = float(turn.magnitude())
    return metres if place.costs[0] else 0.0, radians if place.costs[1] else 0.0


def _se3(pose: RigidTransform) -> mink.SE3:
    return mink.SE3(np.concatenate([pose.rotation.as_quat(scalar_first=True), pose.translation]))
