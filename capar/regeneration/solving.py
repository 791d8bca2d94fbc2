"""Inverse kinematics of a whole body: palms, head, gaze, feet and balance together."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import mink
import numpy as np
from jaxtyping import Float
from scipy.spatial.transform import RigidTransform, Rotation

from capar.body.gaze_control import LOOK_COST, look_tasks, share_costs
from capar.body.human import ROOT_SIZE, Human
from capar.body.inverse_kinematics import Solver as Steps
from capar.body.performing import RELAXED
from capar.body.scripts import SIDES

PALM_COST = (150.0, 10.0)
"""Weights of a metre and of a radian at the palms: so that balance does not cost a millimetre."""

HEAD_COST = (150.0, 20.0)  # Likewise of the head while an object is at it.

FREE_PALM = (0.27, 0.1)
"""Shares of a palm's weights while its hand is free: how it is turned then is only a wish [1]."""

FASTEST = 13.0  # What no hinge exceeds [rad/s].
ROOT_MPS, ROOT_RADPS = 0.7, 2.0  # Likewise the pelvis, along each axis [m/s] and about it [rad/s].
FREE_HEAD = 0.002  # Share of that weight otherwise [1].

FOOT_COST = 240.0
BALANCE_COST = 20.0  # Weight of a metre of the centre of mass from above the feet.

DAMPING_COST = 0.1  # Weight of a radian from one iteration to the next.
EASE_COST, GUIDE_COST = 0.15, 1.0
"""Weights of a radian from standing at ease, and at least so from a posture that guides."""

LARGEST_STEP = 0.15  # Largest step of a hinge in one iteration [rad].

LEAST_STEP = 1e-5

FEWEST, MOST = 2, 10  # Iterations a frame.
STALLED, STALL = 8, 2e-4  # After so many iterations, less progress than this ends them [m, rad].
NEAR_M, NEAR_RAD = 4e-4, 4e-3  # An error of the palms at which iteration ends.


@dataclass(frozen=True, eq=False)
class Targets:
    """Where the body's parts are to be at one moment."""

    palms: Mapping[str, Float[np.ndarray, "7"]]
    """``T_world_palm`` by side, as ``vectors`` has it; a side that is left out hangs at ease."""

    grasps: Mapping[str, float]
    """How firmly each palm is kept there [1]."""

    head: Float[np.ndarray, "7"]
    """``T_world_eyes``: between the eyes, as ``vectors`` has it."""

    firmness: float
    """How firmly the head is kept there [1]."""

    look: Float[np.ndarray, "3"]
    """The point looked at [m]."""


class FrameLimit(mink.Limit):
    """Nothing goes further than a step from where it was at the frame before."""

    def __init__(self, hinges: int) -> None:
        self.steps = np.full(6 + hinges, np.inf)
        self.largest = np.full(6 + hinges, np.inf)
        self.gone = np.zeros(6 + hinges)
        self.rows = np.vstack([np.eye(6 + hinges), -np.eye(6 + hinges)])

    def bound(self, step_s: float) -> None:
        """Take the speeds that nothing exceeds, at a time between frames [s]."""
        hinges = np.full(len(self.gone) - 6, FASTEST)
        self.steps = step_s * np.concatenate([np.full(3, ROOT_MPS), np.full(3, ROOT_RADPS), hinges])

    def begin(self) -> None:
        """A frame begins."""
        self.gone = np.zeros_like(self.gone)

    def compute_qp_inequalities(
        self, configuration: mink.Configuration, dt: float
    ) -> mink.Constraint:
        """The inequalities of one iteration."""
        room = np.stack([self.steps - self.gone, self.steps + self.gone])
        # Without any room the bounds of both sides meet, on which the QP solver may cycle.
        room = np.clip(room, LEAST_STEP, self.largest).ravel()
        bounded = np.isfinite(room)
        return mink.Constraint(G=self.rows[bounded], h=room[bounded])


class Solver:
    """The body in a posture, led from target to target."""

    def __init__(
        self,
        human: Human,
        place: tuple[float, float, float],
        heading: float,
        further: Sequence[mink.Task] = (),
    ) -> None:
        """Stand at ease."""
        self.human, self.further = human, further
        eased = {f"{s}_{n}": float(np.radians(a)) for n, a in RELAXED.items() for s in SIDES}
        self.rest = human.posture(eased, place=place, heading=heading)
        self.configuration = mink.Configuration(human.model)
        self.configuration.update(self.rest)
        self.palms = {s: mink.FrameTask(f"{s}_palm", "site", *PALM_COST) for s in SIDES}
        self.head = mink.FrameTask("between_eyes", "site", *HEAD_COST)
        self.looks = look_tasks()
        self.home = {side: vectors(self.palm(side)) for side in SIDES}
        self.turning = 1.0
        """Share of its weight that the path has in which a palm is turned [1]."""

        self.goals = {side: pose[4:] for side, pose in self.home.items()}
        self.ease = mink.PostureTask(human.model, cost=share_costs(human, EASE_COST))
        self.ease.set_target(self.rest)
        feet = [mink.FrameTask(f"{s}_foot", "body", FOOT_COST, FOOT_COST) for s in SIDES]
        balance = mink.ComTask(cost=[BALANCE_COST, BALANCE_COST, 0.0])
        standing: list[mink.FrameTask | mink.ComTask] = [*feet, balance]
        for task in standing:
            task.set_target_from_configuration(self.configuration)
        damping = mink.DampingTask(human.model, cost=DAMPING_COST)
        self.tasks = [
            *self.palms.values(), self.head, *self.looks.values(), *standing, self.ease,
            damping, *further,
        ]  # fmt: skip
        self.frame = FrameLimit(len(human.joints))
        self.steps = Steps(human, self.tasks, longest_rad=LARGEST_STEP, limits=[self.frame])

    def palm(self, side: str) -> RigidTransform:
        """Where a palm is."""
        return self.site(f"{side}_palm")

    def site(self, name: str) -> RigidTransform:
        """Where a site of the body is."""
        pose = self.configuration.get_transform_frame_to_world(name, "site")
        turn = Rotation.from_quat(pose.rotation().wxyz, scalar_first=True)
        return RigidTransform.from_components(pose.translation(), turn)

    @property
    def posture(self) -> Float[np.ndarray, "posture"]:
        """As it is."""
        return np.array(self.configuration.q)

    def draw_to(self, posture: Float[np.ndarray, "posture"], weight: float) -> None:
        """From now on be drawn to a posture's joint angles, more or less strongly."""
        guide = self.rest.copy()
        guide[ROOT_SIZE:] = posture[ROOT_SIZE:]
        self.ease.set_target(guide)
        usual = share_costs(self.human, EASE_COST)
        firmer = np.maximum(usual, GUIDE_COST)
        firmer[:6] = 0.0
        self.ease.set_cost(usual + weight * (firmer - usual))

    def follow(self, targets: Targets, *, most: int = MOST) -> None:
        """Go on to the targets."""
        for side, task in self.palms.items():
            goal = targets.palms.get(side, self.home[side])
            self.goals[side] = goal[4:]
            task.set_target(mink.SE3(goal))
            firm = targets.grasps.get(side, 0.0)
            costs = [c * (f + (1.0 - f) * firm) for c, f in zip(PALM_COST, FREE_PALM, strict=True)]
            task.set_position_cost(costs[0])
            task.set_orientation_cost(costs[1] * self.turning)
        self.head.set_target(mink.SE3(targets.head))
        firm = FREE_HEAD + (1.0 - FREE_HEAD) * targets.firmness
        self.head.set_position_cost(HEAD_COST[0] * firm)
        self.head.set_orientation_cost(HEAD_COST[1] * firm)
        for look in self.looks.values():
            look.set_target(targets.look)
            look.set_cost(LOOK_COST * (1.0 - 0.9 * targets.firmness))
        self.frame.begin()
        self.steps.restart()
        missed_m, missed_rad, error = np.inf, np.inf, None
        for number in range(most):
            self.frame.gone += self.steps.step(self.configuration, error)
            error = self.steps.left
            before, (missed_m, missed_rad) = (missed_m, missed_rad), self.missed(targets)
            gained = abs(before[0] - missed_m) + abs(before[1] - missed_rad)
            stalled = number >= STALLED and not self.steps.shortened and gained < STALL
            if stalled or self.steps.settled:
                return
            if number + 1 >= FEWEST and missed_m < NEAR_M and missed_rad < NEAR_RAD:
                errors = (task.compute_error(self.configuration) for task in self.further)
                if all(np.abs(error).max(initial=0.0) < NEAR_M for error in errors):
                    return

    def missed(self, targets: Targets) -> tuple[float, float]:
        """How far the worst palm that holds something is from its target [m, rad].

        Of the targets that were followed last.
        """
        metres, radians = 0.0, 0.0
        for side, goal in self.goals.items():
            if side in targets.palms and targets.grasps.get(side, 0.0) > 0.5:
                spot = self.configuration.data.site(f"{side}_palm").xpos
                twist = self.palms[side].compute_error(self.configuration)
                metres = max(metres, float(np.linalg.norm(spot - goal)))
                radians = max(radians, float(np.linalg.norm(twist[3:])))
        return metres, radians


def vectors(pose: RigidTransform) -> Float[np.ndarray, "*frames 7"]:
    """Unit quaternions (w, x, y, z) and positions of one pose or of many."""
    return np.concatenate([pose.rotation.as_quat(scalar_first=True), pose.translation], axis=-1)
