"""Steps of the whole body to where an action can be done, and their gates."""

import itertools
from collections.abc import Iterator
from dataclasses import dataclass, replace

import mink
import mujoco
import numpy as np
from jaxtyping import Bool, Float
from scipy.spatial.transform import RigidTransform, Rotation

from capar.body.human import ROOT_SIZE, Human
from capar.body.inverse_kinematics import Solver as Steps
from capar.body.inverse_kinematics import support
from capar.body.scripts import SIDES, minimum_jerk
from capar.regeneration.collisions import NEAR_M, Pair, Surroundings
from capar.regeneration.quality import Gate, Quality, is_hand
from capar.regeneration.scenes import Scene
from capar.regeneration.solving import DAMPING_COST, FrameLimit, vectors
from capar.regeneration.solving import Solver as Standing

STRIDE = 0.16
"""How far a foot goes in a step at most [share of stature] (estimate: half a usual step)."""

RISE_M = 0.05
"""How high a foot is lifted [m]."""

SHIFT_S, SWING_S, STAND_S = 0.7, 0.7, 0.5
"""How long the weight is shifted to a foot, the other one is moved, and both stand before and
after [s]."""

FOOT_COST, MASS_COST, UPRIGHT_COST = 240.0, 60.0, 4.0
"""Weights of a metre and a radian at the feet, of a metre of the centre of mass, and of a radian
of the pelvis."""

EASE_COSTS = (0.1, 5.0)
"""Weights of a radian from standing at ease: of the legs, and of all else [1/rad]."""

LEGS = ("hip", "knee", "ankle", "toe")
"""What the names of the legs' joints hold."""

ITERATIONS = 12
"""Steps of inverse kinematics a frame at most [1]."""


Place = tuple[float, float]
"""Where somebody stands [m]."""


@dataclass(frozen=True)
class Stride:
    """A step of one foot."""

    side: str
    by: tuple[float, float]
    """How far it goes in the world [m]."""


@dataclass(frozen=True, eq=False)
class Stepping:
    """A body that steps from one place to another."""

    human: Human
    scene: Scene
    """Where it stands at first, and the things."""

    goal: Place
    """Where it stands in the end [m]."""

    strides: tuple[Stride, ...]
    times: Float[np.ndarray, "frames"]
    """[s]."""

    postures: Float[np.ndarray, "frames posture"]
    bears: dict[str, Bool[np.ndarray, "frames"]]
    """By side, whether a foot bears weight."""

    @property
    def after(self) -> Scene:
        """The scene with the performer standing there, to stay."""
        return replace(self.scene, place=self.goal, stays=True)


def strides_to(human: Human, scene: Scene, goal: Place) -> tuple[Stride, ...]:
    """The fewest steps of at most ``STRIDE`` straight there; each foot comes beside the other.

    The foot on the side to which it goes steps first, else the right one.

    Args:
        human: Who.
        scene: Where it stands at first.
        goal: Where it is to stand [m].
    """
    x, y = np.asarray(goal) - scene.place
    far = float(np.hypot(x, y))
    count = max(int(np.ceil(far / (STRIDE * human.measures["stature"]) - 1e-9)), 1)
    left = -np.sin(scene.heading) * x + np.cos(scene.heading) * y
    order = ("left", "right") if left > 1e-6 else ("right", "left")
    return tuple(Stride(side, (x / count, y / count)) for _ in range(count) for side in order)


def step_to(human: Human, scene: Scene, *places: Place, rate_hz: float = 30.0) -> Stepping:
    """Step to other places, facing the same way.

    Args:
        human: Who.
        scene: Where it stands at first.
        places: Where it is to stand, one after the other [m]; one at least.
        rate_hz: Frames a second.
    """
    stations = [scene.place, *places]
    strides = tuple(
        stride
        for before, after in itertools.pairwise(stations)
        for stride in strides_to(human, replace(scene, place=before), after)
    )
    goal = stations[-1]
    body = _Stepper(human, scene, 1.0 / rate_hz)
    for _ in range(round(STAND_S * rate_hz)):
        body.frame()
    for stride in strides:
        other = SIDES[1 - SIDES.index(stride.side)]
        body.shift(body.over(other), SHIFT_S)
        body.swing(stride, SWING_S)
    body.shift(np.asarray(goal) + body.ahead, SHIFT_S)
    for _ in range(round(STAND_S * rate_hz)):
        body.frame()
    times = np.arange(len(body.postures)) / rate_hz
    bears = {side: np.array(rows) for side, rows in body.bears.items()}
    return Stepping(human, scene, goal, strides, times, np.array(body.postures), bears)


class _Stepper:
    """Inverse kinematics of feet, the centre of mass and an upright pelvis, frame by frame."""

    def __init__(self, human: Human, scene: Scene, step_s: float) -> None:
        self.human, self.step_s = human, step_s
        standing = Standing(human, (*scene.place, scene.floor_m), scene.heading)
        self.configuration = standing.configuration
        self.feet = {s: mink.FrameTask(f"{s}_foot", "body", FOOT_COST, FOOT_COST) for s in SIDES}
        self.mass = mink.ComTask(cost=[MASS_COST, MASS_COST, 0.0])
        pelvis = mink.FrameTask("pelvis", "body", 0.0, UPRIGHT_COST)
        ease = mink.PostureTask(human.model, cost=_ease_costs(human))
        ease.set_target(standing.rest)
        for frame in (*self.feet.values(), pelvis):
            frame.set_target_from_configuration(self.configuration)
        self.mass.set_target_from_configuration(self.configuration)
        self.poses = {side: self._foot(side) for side in SIDES}
        self.spot = np.array(self.configuration.data.subtree_com[1, :2])
        self.ahead = self.spot - scene.place
        """Where the centre of mass is from the middle of a standing place [m]."""

        self.limit = FrameLimit(len(human.joints))
        slow = mink.DampingTask(human.model, cost=DAMPING_COST)
        tasks = [*self.feet.values(), self.mass, pelvis, ease, slow]
        self.steps = Steps(human, tasks, longest_rad=0.15, limits=[self.limit])
        self.limit.bound(step_s)
        self.postures: list[np.ndarray] = []
        self.bears: dict[str, list[bool]] = {side: [] for side in SIDES}

    def over(self, side: str) -> Float[np.ndarray, "2"]:
        """Above the middle of a foot's sole [m]."""
        return support(self.human, {side: self.poses[side]}).middle

    def shift(self, spot: Float[np.ndarray, "2"], seconds: float) -> None:
        """Bring the centre of mass above a spot, both feet bearing."""
        start, count = self.spot, round(seconds / self.step_s)
        for number in range(count):
            self.spot = start + minimum_jerk((number + 1) / count) * (spot - start)
            self.frame()

    def swing(self, stride: Stride, seconds: float) -> None:
        """Lift a foot, move it and set it down."""
        start, count = self.poses[stride.side], round(seconds / self.step_s)
        for number in range(count):
            share = (number + 1) / count
            way, rise = minimum_jerk(share), RISE_M * np.sin(np.pi * share) ** 2
            by = [way * stride.by[0], way * stride.by[1], rise]
            self.poses[stride.side] = RigidTransform.from_translation(by) * start
            self.frame("" if number + 1 == count else stride.side)

    def frame(self, swings: str = "") -> None:
        """Go on to one frame, a foot being in the air."""
        for side, task in self.feet.items():
            pose = self.poses[side]
            turn = pose.rotation.as_quat(scalar_first=True)
            task.set_target(mink.SE3(np.concatenate([turn, pose.translation])))
        self.mass.set_target(np.array([*self.spot, 0.0]))
        self.limit.begin()
        self.steps.restart()
        for _ in range(ITERATIONS):
            self.limit.gone += self.steps.step(self.configuration)
            if self.steps.settled:
                break
        self.postures.append(np.array(self.configuration.q))
        for side in SIDES:
            self.bears[side].append(side != swings)

    def _foot(self, side: str) -> RigidTransform:
        pose = self.configuration.get_transform_frame_to_world(f"{side}_foot", "body")
        turn = Rotation.from_quat(pose.rotation().wxyz, scalar_first=True)
        return RigidTransform.from_components(pose.translation(), turn)


def _ease_costs(human: Human) -> Float[np.ndarray, "dofs"]:
    """The legs step, and all above them stays as it is at ease."""
    legs, others = EASE_COSTS
    own = [legs if any(part in joint for part in LEGS) else others for joint in human.joints]
    return np.array([*np.zeros(6), *own])


INSIDE_MM = 10.0
"""How far inside the soles that bear it the centre of mass stays [mm]."""


def stepping_quality(made: Stepping) -> Quality:
    """Verify steps at every frame."""
    feet = _feet(made)
    return Quality((*_foot_gates(made, feet), *_contact_gates(made), *_joint_gates(made)))


def _feet(made: Stepping) -> dict[str, RigidTransform]:
    sites = made.human.sites(made.postures, [f"{side}_foot" for side in SIDES])
    return {
        side: RigidTransform.from_components(
            sites[f"{side}_foot"][0],
            Rotation.from_quat(sites[f"{side}_foot"][1], scalar_first=True),
        )
        for side in SIDES
    }


def _foot_gates(made: Stepping, feet: dict[str, RigidTransform]) -> Iterator[Gate]:
    slid, missed = (0.0, -1, ""), (0.0, -1, "")
    for side, path in feet.items():
        still = made.bears[side]
        first = 0
        for frame in range(len(still)):
            if not still[frame]:
                first = frame + 1
            elif frame > first:
                by = float(np.linalg.norm(path[frame].translation - path[first].translation))
                slid = max(slid, (by, frame, f"{side}_foot"))
        gone = path[-1].translation - path[0].translation
        off = float(np.linalg.norm(gone - [*(np.asarray(made.goal) - made.scene.place), 0.0]))
        missed = max(missed, (off, len(still) - 1, f"{side}_foot"))
    yield Gate("foot that bears", 1e3 * slid[0], 3.0, "mm", False, *slid[1:])
    yield Gate("foot comes there", 1e3 * missed[0], 3.0, "mm", False, *missed[1:])
    masses = _masses(made)
    inside = [
        -float(
            support(made.human, {s: feet[s][frame] for s in SIDES if made.bears[s][frame]}).outside(
                masses[frame]
            )
        )
        for frame in range(len(masses))
    ]
    worst = int(np.argmin(inside))
    yield Gate("balance", 1e3 * inside[worst], INSIDE_MM, "mm", True, worst)


def _masses(made: Stepping) -> Float[np.ndarray, "frames 2"]:
    """Where the centre of mass is [m]."""
    model = made.human.model
    data, out = mujoco.MjData(model), []
    for posture in made.postures:
        data.qpos[:] = posture
        mujoco.mj_kinematics(model, data)
        mujoco.mj_comPos(model, data)
        out.append(np.array(data.subtree_com[1, :2]))
    return np.array(out)


def _contact_gates(made: Stepping) -> Iterator[Gate]:
    """Penetration of anything, and how far hands keep from what they do not touch."""
    around = Surroundings(made.human, made.scene)
    things = {name: vectors(thing.pose) for name, thing in made.scene.things.items()}
    deepest = nearest = (Pair(NEAR_M, "", ""), -1)
    for frame, posture in enumerate(made.postures):
        around.place(posture, things)
        for pair in around.near():
            deepest = min(deepest, (pair, frame))
            if is_hand(pair.part):
                nearest = min(nearest, (pair, frame))
    for name, limit, (pair, frame) in (
        ("penetration", -1.0, deepest), ("free hand clear", 10.0, nearest),
    ):  # fmt: skip
        bodies = f"{pair.part}, {pair.thing}" if pair.part else ""
        yield Gate(name, 1e3 * pair.distance_m, limit, "mm", True, frame, bodies)


def _joint_gates(made: Stepping) -> Iterator[Gate]:
    rate_hz = 1.0 / float(made.times[1] - made.times[0])
    low, high = made.human.ranges.T
    angles = made.postures[:, ROOT_SIZE:]
    out = np.maximum(np.maximum(low - angles, angles - high), 0.0)
    frame, hinge = np.unravel_index(int(out.argmax()), out.shape)
    yield Gate(
        "joint limits", float(np.degrees(out.max())), 0.01, "deg", False,
        int(frame), made.human.joints[int(hinge)],
    )  # fmt: skip
    speeds = np.abs(np.diff(angles, axis=0)) * rate_hz
    frame, hinge = np.unravel_index(int(speeds.argmax()), speeds.shape)
    yield Gate(
        "joint speed", float(speeds.max()), 15.0, "rad/s", False,
        int(frame), made.human.joints[int(hinge)],
    )  # fmt: skip
    hips = np.linalg.norm(np.diff(made.postures[:, :3], axis=0), axis=1) * rate_hz
    yield Gate("pelvis speed", float(hips.max()), 1.5, "m/s", False, int(hips.argmax()))
