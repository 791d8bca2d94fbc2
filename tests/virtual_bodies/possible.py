"""Which test motions a human body can perform: hands, feet, head and mouth followed within limits.

``benchmarks/possible_motions.py`` prints them all; what is missed is the worst of all frames.
"""

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import overload

import mink
import motions
import numpy as np
from jaxtyping import Float
from motions.doors import DOORS
from motions.encounters import ENCOUNTERS
from motions.shapes import mouth
from motions.uses import USES
from motions.whole import WHOLE
from scipy.spatial.transform import RigidTransform, Rotation

from capar.body.acting import RELAXED
from capar.body.anthropometry import measures_of
from capar.body.gaze import share_costs
from capar.body.human import Human
from capar.body.recording import segment_surface
from capar.body.scripts import SIDES
from capar.body.solving import Solver
from capar.model import geometry
from capar.model.capture import Capture, Sensor
from capar.regeneration.hand_frames import body_hand_frame, hand_frame, palm_of

NEAR_M, NEAR_RAD = 0.010, float(np.radians(10.0))
"""A motion is possible if nothing is missed by more [m, rad]: by skin, and by another grip."""

CLOSE_M, CLOSE_RAD = 0.002, float(np.radians(1.0))
"""What is missed by less is followed [m, rad]."""

FASTEST_RADPS = 25.0
"""... and no joint is faster [rad/s]: elbows of throwers reach about forty."""

BESIDE_M = 0.01
"""... and the centre of mass stays above the soles, but for so much [m]."""

BALANCE = 20.0
"""Weight of a metre of the centre of mass from above the feet."""

RATE_HZ = 10.0
FEWEST, MOST = 4, 60
"""Steps of the inverse kinematics at a frame: more while something is missed."""

PLACES = (
    (0.0, 0.0), (0.15, 0.0), (-0.15, 0.0), (0.0, 0.15), (0.0, -0.15), (0.15, 0.15), (0.15, -0.15),
    (-0.15, 0.15), (-0.15, -0.15),
)  # fmt: skip
"""Where the feet may stand, of which a motion that does not track them tells nothing [m]."""

ARMS = (
    {"shoulder_abduction": 70.0, "elbow_flexion": 90.0},
    {"shoulder_flexion": 60.0, "elbow_flexion": 60.0},
    {"shoulder_flexion": -30.0, "elbow_flexion": 120.0},
    {"shoulder_flexion": 60.0, "shoulder_rotation": 50.0, "elbow_flexion": 90.0},
)
"""Other postures of the arms from which a place is tried to be met [degrees]."""

PALM, FOOT = (60.0, 8.0), (60.0, 8.0)
HEAD, MOUTH = (0.0, 4.0), (60.0, 0.0)
"""Weights of a metre and of a radian; what has no weight is not asked for."""

PUBLISHED = (
    motions.drink_from_mug, motions.touch_from_rest, motions.touch_cycle, motions.slide_object,
    motions.pick_up_with_both_hands, motions.hit, motions.touch_with, motions.move_obj,
    motions.move_obj_to, motions.resume_posture, motions.touch, motions.roll_object,
    motions.stand_on_one_leg,
)  # fmt: skip
ACTS: tuple[Callable[..., motions.Trial], ...] = (*PUBLISHED, *USES, *ENCOUNTERS, *DOORS, *WHOLE)
"""All that one person does; ``hand_over``, of two people, is not judged."""


@dataclass(frozen=True)
class Missed:
    """How well a body follows a motion."""

    metres: float
    radians: float
    what: str
    """Where it is missed by most, and when [s]."""

    frame: int
    """Which frame that is."""

    fastest_radps: float
    beside_m: float = 0.0
    """How far the centre of mass is from above the soles [m]; not of feet that are tracked."""

    stands: tuple[float, float] = (0.0, 0.0)
    """Where the feet, which are not tracked, stay throughout, from the motion's origin [m]."""

    @property
    def possible(self) -> bool:
        return (
            self.metres <= NEAR_M
            and self.radians <= NEAR_RAD
            and self.fastest_radps <= FASTEST_RADPS
            and self.beside_m <= BESIDE_M
        )


@dataclass(frozen=True, eq=False)
class Follow:
    """A site or segment of the body, and where it is to be."""

    frame: str
    kind: str
    costs: tuple[float, float]
    path: RigidTransform

    @property
    def foot(self) -> bool:
        return self.frame.endswith("_foot")


def missed(capture: Capture) -> Missed:
    """How well the body of a capture's first agent can do what its sensors did.

    Feet that are not tracked stay where they are, and the weight above them. Where the way from
    the first posture on is not possible, others are tried: from other places to stand, and then
    over other postures of the arm at the moment at which most was missed.
    """
    human = Human.of(measures_of(capture.agent))
    wanted = list(_wanted(capture, human))
    follower = Follower(capture, human, wanted, PLACES[0])
    first = follower.run(0, follower.rest)
    if first.possible:
        return first
    others = _others(capture, human, wanted, first.frame)
    return next((other for other in others if other is not None and other.possible), first)


def _others(
    capture: Capture, human: Human, wanted: list[Follow], frame: int
) -> Iterator[Missed | None]:
    """What is missed on the other ways, one after the other; None where they were given up."""
    led = any(each.foot for each in wanted)
    for stands in () if led else PLACES[1:]:
        follower = Follower(capture, human, wanted, stands)
        yield follower.run(0, follower.rest, gives_up=True)
    follower = Follower(capture, human, wanted, PLACES[0])
    for arm in ARMS:
        angles = {f"{s}_{n}": float(np.radians(a)) for n, a in arm.items() for s in SIDES}
        yield follower.run(frame, human.posture(angles), gives_up=True)


def _wanted(capture: Capture, human: Human) -> Iterator[Follow]:
    """The body's places that the sensors of the first agent lead."""
    chosen = _frames(capture)
    for each in capture.sensors:
        if capture.agent_of(each) != capture.agent.name or each.part_of:
            continue
        path = geometry.transforms(each.stream.positions[chosen], each.stream.orientations[chosen])
        if each.end_effector == "hand" and each.shape is not None:
            yield Follow(f"{each.side}_palm", "site", PALM, path * _palm(each, human))
        elif each.end_effector == "foot":
            yield Follow(f"{each.side}_foot", "body", FOOT, path * _ankle(each, human))
        elif each.end_effector == "head":
            yield Follow("head", "body", HEAD, path)
            if "head" in {thing.name for thing in capture.objects}:
                spot = RigidTransform.from_translation(mouth())
                yield Follow("mouth", "site", MOUTH, path * spot)


def _frames(capture: Capture) -> np.ndarray:
    step = max(round(capture.rate_hz / RATE_HZ), 1)
    return np.arange(0, len(capture.times), step)


def _palm(sensor: Sensor, human: Human) -> RigidTransform:
    """``T_sensor_palm``: a test motion's hand points along x, and its back is along z."""
    assert sensor.shape is not None
    frame = hand_frame(sensor.shape, np.array([1.0, 0.0, 0.0]), np.array([0.0, 0.0, -1.0]))
    return frame.pose * palm_of(human, sensor.side, body_hand_frame(human, sensor.side))


def _ankle(sensor: Sensor, human: Human) -> RigidTransform:
    """``T_sensor_ankle``: the soles of both feet have the same middle."""
    segments = (f"{sensor.side}_foot", f"{sensor.side}_toes")
    bounds = segment_surface(human.measures, segments, segments[0]).bounds
    own = np.array([*bounds.mean(axis=0)[:2], bounds[0, 2]])
    sole = np.zeros(3)
    if sensor.shape is not None:
        sole = np.array([*sensor.shape.bounds.mean(axis=0)[:2], sensor.shape.bounds[0, 2]])
    return RigidTransform.from_translation(sole - own)


class Follower:
    """A body that follows a motion from one place to stand."""

    def __init__(
        self, capture: Capture, human: Human, wanted: list[Follow], stands: tuple[float, float]
    ) -> None:
        self.times, self.wanted, self.stands = capture.times[_frames(capture)], wanted, stands
        eased = {f"{s}_{n}": float(np.radians(a)) for n, a in RELAXED.items() for s in SIDES}
        self.rest = human.posture(eased, place=(*stands, 0.0))
        self.configuration = mink.Configuration(human.model)
        self.configuration.update(self.rest)
        self.tasks = [mink.FrameTask(each.frame, each.kind, *each.costs) for each in wanted]
        ease = mink.PostureTask(human.model, cost=share_costs(human, 0.05))
        ease.set_target(self.rest)
        led = {each.frame for each in wanted}
        feet = [f"{side}_foot" for side in SIDES if f"{side}_foot" not in led]
        stance = _stance(feet, self.configuration)
        damping = mink.DampingTask(human.model, cost=0.05)
        self.solver = Solver(human, [*self.tasks, ease, damping, *stance])
        self.soles = _soles(human, feet, self.configuration)

    @overload
    def run(self, start: int, posture: Float[np.ndarray, "posture"]) -> Missed: ...

    @overload
    def run(
        self, start: int, posture: Float[np.ndarray, "posture"], *, gives_up: bool
    ) -> Missed | None: ...

    def run(
        self, start: int, posture: Float[np.ndarray, "posture"], *, gives_up: bool = False
    ) -> Missed | None:
        """Follow the motion from one frame to its end, and from there back to its beginning.

        Returns:
            What is missed; None if it was given up at the first frame that is missed.
        """
        postures = np.zeros((len(self.times), len(posture)))
        weights = np.zeros((len(self.times), 2))
        errors = np.zeros((len(self.times), len(self.wanted), 2))
        for frames in (range(start, len(self.times)), range(start - 1, -1, -1)):
            self.configuration.update(posture if frames.step > 0 else postures[start])
            for frame in frames:
                errors[frame] = self._meet(frame)
                postures[frame] = self.configuration.q
                weights[frame] = self.configuration.data.subtree_com[1, :2]
                if gives_up and (errors[frame] > (NEAR_M, NEAR_RAD)).any():
                    return None
        return self._judged(postures, errors, weights)

    def _meet(self, frame: int) -> Float[np.ndarray, "places 2"]:
        """Go to a frame's targets; what is missed then [m, rad]."""
        for task, each in zip(self.tasks, self.wanted, strict=True):
            task.set_target(_se3(each.path[frame]))
        self.solver.restart()
        errors = np.zeros((len(self.wanted), 2))
        for number in range(MOST):
            self.solver.step(self.configuration)
            errors = np.array([_error(self.configuration, each, frame) for each in self.wanted])
            close = number >= FEWEST and (errors < (CLOSE_M, CLOSE_RAD)).all()
            if close or self.solver.settled:
                break
        return errors.reshape(-1, 2)

    def _judged(
        self,
        postures: Float[np.ndarray, "frames posture"],
        errors: Float[np.ndarray, "frames places 2"],
        weights: Float[np.ndarray, "frames 2"],
    ) -> Missed:
        if not self.wanted:
            return Missed(0.0, 0.0, "nothing of the body is tracked", 0, 0.0)
        relative = np.maximum(errors[..., 0] / NEAR_M, errors[..., 1] / NEAR_RAD)
        frame, place = np.unravel_index(int(relative.argmax()), relative.shape)
        speeds = np.abs(np.diff(postures[:, 7:], axis=0)) / np.diff(self.times)[:, None]
        return Missed(
            float(errors[..., 0].max()),
            float(errors[..., 1].max()),
            f"{self.wanted[place].frame} at {self.times[frame]:.2f} s",
            int(frame),
            float(speeds.max(initial=0.0)),
            self._beside(weights),
            self.stands,
        )

    def _beside(self, weights: Float[np.ndarray, "frames 2"]) -> float:
        """How far the centre of mass is from above the soles, at worst [m]."""
        if self.soles is None:
            return 0.0
        low, high = self.soles
        outside = np.maximum(np.maximum(low - weights, weights - high), 0.0)
        return float(np.linalg.norm(outside, axis=1).max())


def _soles(
    human: Human, feet: list[str], configuration: mink.Configuration
) -> Float[np.ndarray, "2 2"] | None:
    """The rectangle round both feet as they stand [m]; None if one of them is tracked."""
    if len(feet) < 2:
        return None
    corners = []
    for foot in feet:
        at = configuration.get_transform_frame_to_world(foot, "body").translation()
        surface = segment_surface(human.measures, (foot, foot.replace("foot", "toes")), foot)
        corners.append(surface.bounds[:, :2] + at[:2])
    return np.array([np.min(corners, axis=(0, 1)), np.max(corners, axis=(0, 1))])


def _stance(feet: list[str], configuration: mink.Configuration) -> list[mink.Task]:
    """Feet that stay, and the weight above both."""
    tasks: list[mink.Task] = [mink.FrameTask(name, "body", *FOOT) for name in feet]
    if len(feet) == 2:
        tasks.append(mink.ComTask(cost=[BALANCE, BALANCE, 0.0]))
    for task in tasks:
        task.set_target_from_configuration(configuration)
    return tasks


def _error(configuration: mink.Configuration, each: Follow, frame: int) -> tuple[float, float]:
    pose = configuration.get_transform_frame_to_world(each.frame, each.kind)
    goal = each.path[frame]
    turn = Rotation.from_quat(pose.rotation().wxyz, scalar_first=True).inv() * goal.rotation
    metres = float(np.linalg.norm(pose.translation() - goal.translation))
    radians = float(turn.magnitude())
    return metres if each.costs[0] else 0.0, radians if each.costs[1] else 0.0


def _se3(pose: RigidTransform) -> mink.SE3:
    return mink.SE3(np.concatenate([pose.rotation.as_quat(scalar_first=True), pose.translation]))
