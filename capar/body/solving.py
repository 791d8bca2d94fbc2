"""Steps of inverse kinematics that never lead further from what is wanted."""

from collections.abc import Sequence

import mink
import numpy as np
from jaxtyping import Float

from capar.body.human import Human

SHORTEST_RAD = 1e-3
"""A solver whose steps have become shorter has found what there is to find [rad]."""


class Solver:
    """Steps towards what tasks want, within the joints' ranges, shortened where they overshoot.

    A plain step of the quadratic programme overshoots at a straight limb or at the end of a joint's
    range, and goes to and fro for ever. Here a step that makes the weighted errors larger is taken
    back and a shorter one is tried, as in a trust region (Nocedal & Wright 2006, chapter 4).
    """

    def __init__(
        self,
        human: Human,
        tasks: Sequence[mink.Task],
        *,
        longest_rad: float = 0.25,
        limits: Sequence[mink.Limit] = (),
    ) -> None:
        self.human, self.tasks = human, list(tasks)
        self.longest_rad = self.radius = longest_rad
        """Most that a joint may turn in a step, ever and now [rad]."""

        self.speed = mink.VelocityLimit(human.model, dict.fromkeys(human.joints, longest_rad))
        self.limits = [mink.ConfigurationLimit(human.model), self.speed, *limits]

    @property
    def settled(self) -> bool:
        """Whether no step longer than the shortest is of use any more."""
        return self.radius < SHORTEST_RAD

    @property
    def shortened(self) -> bool:
        """Whether steps are shorter than they may be, because longer ones overshot."""
        return self.radius < self.longest_rad

    def restart(self) -> None:
        """Allow long steps again, because the targets are new."""
        self.radius = self.longest_rad

    def step(self, configuration: mink.Configuration) -> Float[np.ndarray, "dofs"]:
        """Go one step, or stay and take shorter steps from now on.

        Returns:
            What was gone [rad], of the pelvis [m] and [rad].
        """
        before, posture = self.error(configuration), configuration.q.copy()
        self.speed.limit = np.full(len(self.human.joints), self.radius)
        velocity = mink.solve_ik(configuration, self.tasks, 1.0, "daqp", limits=self.limits)
        configuration.integrate_inplace(velocity, 1.0)
        longest = float(np.abs(velocity[6:]).max())
        if self.error(configuration) > before:
            configuration.update(posture)
            self.radius = 0.4 * min(self.radius, longest)
            return np.zeros_like(velocity)
        if longest < SHORTEST_RAD:
            self.radius = longest
        elif longest > 0.9 * self.radius:
            self.radius = min(2.0 * self.radius, self.longest_rad)
        return np.asarray(velocity)

    def error(self, configuration: mink.Configuration) -> float:
        """Sum of the squares of all weighted errors [1]; damping, which wants nothing, has none."""
        out = 0.0
        for task in self.tasks:
            if not isinstance(task, mink.DampingTask):
                weighted = task.cost * task.compute_error(configuration)
                out += float(weighted @ weighted)
        return out
