"""The motion of a whole body that does what a plan says, and what it comes to."""

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from capar.regeneration.guides import Guide
from capar.regeneration.planning import Plan
from capar.regeneration.solving import Solver

SETTLING = 60
"""Iterations for the first frame."""


@dataclass(frozen=True, eq=False)
class Motion:
    """A body's postures along a plan."""

    plan: Plan
    postures: Float[np.ndarray, "frames posture"]


def perform_plan(plan: Plan, guide: Guide | None = None) -> Motion:
    """Follow a plan frame by frame.

    Args:
        plan: What is to be done.
        guide: Postures to which the body is drawn meanwhile; standing at ease, unless stated.
    """
    scene = plan.scene
    solver = Solver(plan.human, (*scene.place, scene.floor_m), scene.heading)
    targets = plan.targets()
    solver.follow(targets[0], most=SETTLING)
    solver.frame.bound(1.0 / plan.source.rate_hz)
    postures = np.empty((len(plan.source.times), len(solver.posture)))
    for frame in range(len(postures)):
        if guide is not None:
            solver.draw_to(guide.postures[frame], float(guide.weights[frame]))
        solver.follow(targets[frame])
        postures[frame] = solver.posture
    return Motion(plan, postures)
