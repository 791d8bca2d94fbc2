"""Inverse kinematics of a body that follows its sensors frame by frame."""

from collections.abc import Mapping

import mink
import numpy as np
from jaxtyping import Float

from capar.body.flat_feet import UprightTask
from capar.body.human import Human
from capar.body.mounting import places
from capar.body.solving import Solver
from capar.body.targets import Target

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

ON_SPOT_COST = (2.0, 1.0)
"""Weights of a metre of a foot and of the pelvis from where they stood, where sensors stay near."""

ON_SPOT_M = 0.5
"""Who moves no further than this, by the mean of all sensors, stands on one spot [m]."""

TRUNK_COST = 0.15
"""Weight of a radian of the upper trunk's tilt where no sensor is on it: hands and head alone
would let it lean as far as they reach together."""

SETTLING = 60
"""Iterations for the first frame."""

FAR_BEHIND_M = 0.02
"""Where a sensor is still farther from its place on the body than this after the usual steps, more
are taken [m]."""

CATCHING_UP = 20
"""Steps of that kind at most."""

STEP_S = 1.0
"""Unit of time of one step [s]; steps are bounded as angles, whatever the recording's rate."""

LARGEST_STEP = 0.35
"""Largest step of a hinge in one iteration [rad]."""


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

    def _stance(self, rest: Float[np.ndarray, "posture"]) -> list[mink.Task]:
        """Tasks of a body of which only the upper part is seen: it stands, wherever that is.

        The pelvis keeps upright, and the feet flat at the height at which they are in the
        reference posture, on one spot if the sensors stay near; else a body that bends forward
        would tilt as one piece.
        """
        self.configuration.update(rest)
        level, stays = np.array([1.0, 1.0, 0.0]), float(self._stays())
        foot, pelvis = (np.multiply(stays * cost, level) for cost in ON_SPOT_COST)
        foot[2] = STANDING_COST[0]
        standing = [mink.FrameTask("pelvis", "body", pelvis, UPRIGHT_COST * level)]
        for side in ("right", "left"):
            flat = STANDING_COST[1] * level
            standing.append(mink.FrameTask(f"{side}_foot", "body", foot, flat))
        for task in standing:
            task.set_target_from_configuration(self.configuration)
        trunk = [] if self._sees_trunk() else [UprightTask("thorax_upper", TRUNK_COST)]
        return [*standing, *trunk]

    def _stays(self) -> bool:
        """Whether the body stands on one spot, by the middle of its sensors."""
        middle = np.mean([target.positions[:, :2] for target in self.targets.values()], axis=0)
        return bool(np.linalg.norm(np.ptp(middle, axis=0)) < ON_SPOT_M)

    def _sees_trunk(self) -> bool:
        """Whether a sensor is on the trunk above the pelvis."""
        return any(places()[place].startswith(("thorax", "lumbar")) for place in self.targets)

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
            self._catch_up()
            out[row] = self.configuration.q
        return out

    def _catch_up(self) -> None:
        """Go on in steps that never lead away, where plain ones leave sensors far behind.

        At a straight limb, or at the end of a joint's range, plain steps overshoot.
        """
        if self._behind_m() < FAR_BEHIND_M:
            return
        tasks = [*self._seen(), *self.stance, self.posture]
        solver = Solver(self.human, tasks, longest_rad=LARGEST_STEP)
        for _ in range(CATCHING_UP):
            solver.step(self.configuration)
            if solver.settled or self._behind_m() < FAR_BEHIND_M:
                break

    def _behind_m(self) -> float:
        """How far the farthest of the sensors seen is from where it should be [m]."""
        errors = [task.compute_error(self.configuration)[:3] for task in self._seen()]
        return max((float(np.linalg.norm(error)) for error in errors), default=0.0)

    def _seen(self) -> list[mink.FrameTask]:
        """Tasks of sensors that are not lost."""
        return [task for task in self.frames.values() if task.cost[0] > 0.0]

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
        weights = {places()[place]: target.weights[frame] for place, target in self.targets.items()}
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
        velocity = mink.solve_ik(
            self.configuration,
            [*self._seen(), *self.stance, self.posture, self.damping],
            STEP_S,
            SOLVER,
            limits=self.limits,
        )
        self.configuration.integrate_inplace(velocity, STEP_S)
