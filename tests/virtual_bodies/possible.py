"""Which test motions a human body can perform: hands, feet, head and mouth followed within limits.

``benchmarks/possible_motions.py`` prints them all; what is missed is the worst of all frames.
"""

from collections.abc import Callable, Iterator
from dataclasses import dataclass

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
from capar.model import geometry
from capar.model.capture import Capture, Sensor
from capar.regeneration.hand_frames import body_hand_frame, hand_frame, palm_of

NEAR_M, NEAR_RAD = 0.010, float(np.radians(10.0))
"""A motion is possible if nothing is missed by more [m, rad]: by skin, and by another grip."""

CLOSE_M, CLOSE_RAD = 0.002, float(np.radians(1.0))
"""What is missed by less is followed [m, rad]."""

FASTEST_RADPS = 25.0
"""... and no joint is faster [rad/s]: elbows of throwers reach about forty."""

RATE_HZ = 10.0
SETTLING, FEWEST, MOST = 80, 4, 24
"""Iterations at the first frame, and at the others: more while something is missed."""

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

    fastest_radps: float
    steps: bool
    """Whether the feet, which are not tracked, must step for it."""

    @property
    def possible(self) -> bool:
        return (
            self.metres <= NEAR_M
            and self.radians <= NEAR_RAD
            and self.fastest_radps <= FASTEST_RADPS
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

    The feet stay where they are unless they are tracked; where that is not enough they may step.
    """
    human = Human.of(measures_of(capture.agent))
    wanted = list(_wanted(capture, human))
    staying = _followed(capture, human, wanted, steps=False)
    if staying.possible or any(each.foot for each in wanted):
        return staying
    stepping = _followed(capture, human, wanted, steps=True)
    return stepping if _worse(staying) > _worse(stepping) else staying


def _worse(each: Missed) -> float:
    return max(each.metres / NEAR_M, each.radians / NEAR_RAD, each.fastest_radps / FASTEST_RADPS)


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


def _followed(capture: Capture, human: Human, wanted: list[Follow], *, steps: bool) -> Missed:
    eased = {f"{s}_{n}": np.radians(a) for n, a in RELAXED.items() for s in ("right", "left")}
    rest = human.posture({name: float(angle) for name, angle in eased.items()})
    configuration = mink.Configuration(human.model)
    configuration.update(rest)
    tasks = [mink.FrameTask(each.frame, each.kind, *each.costs) for each in wanted]
    ease = mink.PostureTask(human.model, cost=share_costs(human, 0.05))
    ease.set_target(rest)
    others: list[mink.Task] = [ease, mink.DampingTask(human.model, cost=0.05)]
    led = {each.frame for each in wanted}
    free = [name for name in ("right_foot", "left_foot") if name not in led]
    others += _stance(free, configuration, steps=steps)
    limits = [
        mink.ConfigurationLimit(human.model),
        mink.VelocityLimit(human.model, dict.fromkeys(human.joints, 0.25)),
    ]
    count = len(_frames(capture))
    postures, errors = [], np.zeros((count, len(wanted), 2))
    for frame in range(count):
        for task, each in zip(tasks, wanted, strict=True):
            task.set_target(_se3(each.path[frame]))
        for number in range(MOST if frame else SETTLING):
            velocity = mink.solve_ik(configuration, [*tasks, *others], 1.0, "daqp", limits=limits)
            configuration.integrate_inplace(velocity, 1.0)
            if number % FEWEST == FEWEST - 1:
                errors[frame] = [_error(configuration, each, frame) for each in wanted]
                if (errors[frame] < (CLOSE_M, CLOSE_RAD)).all():
                    break
        postures.append(np.array(configuration.q))
    return _judged(capture, np.array(postures), errors, wanted, steps=steps)


def _stance(feet: list[str], configuration: mink.Configuration, *, steps: bool) -> list[mink.Task]:
    """Feet that stay, or that are flat on the floor anywhere; and the weight above both."""
    level = np.array([0.0, 0.0, FOOT[0]]) if steps else FOOT[0]
    turn = np.array([FOOT[1], FOOT[1], 0.0]) if steps else FOOT[1]
    tasks: list[mink.Task] = [mink.FrameTask(name, "body", level, turn) for name in feet]
    if len(feet) == 2 and not steps:
        tasks.append(mink.ComTask(cost=[2.0, 2.0, 0.0]))
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


def _judged(
    capture: Capture,
    postures: Float[np.ndarray, "frames posture"],
    errors: Float[np.ndarray, "frames places 2"],
    wanted: list[Follow],
    *,
    steps: bool,
) -> Missed:
    if not wanted:
        return Missed(0.0, 0.0, "nothing of the body is tracked", 0.0, steps)
    times = capture.times[_frames(capture)]
    relative = np.maximum(errors[..., 0] / NEAR_M, errors[..., 1] / NEAR_RAD)
    frame, place = np.unravel_index(int(relative.argmax()), relative.shape)
    speeds = np.abs(np.diff(postures[:, 7:], axis=0)) / np.diff(times)[:, None]
    return Missed(
        float(errors[..., 0].max()),
        float(errors[..., 1].max()),
        f"{wanted[place].frame} at {times[frame]:.2f} s",
        float(speeds.max(initial=0.0)),
        steps,
    )


def _se3(pose: RigidTransform) -> mink.SE3:
    return mink.SE3(np.concatenate([pose.rotation.as_quat(scalar_first=True), pose.translation]))
