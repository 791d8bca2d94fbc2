"""The motion of a whole body that does what a plan says, and what it comes to."""

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from capar.regeneration.clearing import ClearTask
from capar.regeneration.collisions import Surroundings
from capar.regeneration.guides import Guide
from capar.regeneration.planning import Plan
from capar.regeneration.solving import Solver, vectors

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
    clear = ClearTask(Surroundings(plan.human, scene), plan.source.met)
    solver = Solver(plan.human, (*scene.place, scene.floor_m), scene.heading, (clear,))
    targets = plan.targets()
    things = {name: vectors(path) for name, path in plan.things.items()}
    if guide is not None:
        solver.draw_to(guide.postures[0], float(guide.weights[0]))
    for clear.active in (False, True):  # the way from standing at ease may lead through things
        solver.follow(targets[0], most=SETTLING)
    solver.frame.bound(1.0 / plan.source.rate_hz)
    postures = np.empty((len(plan.source.times), len(solver.posture)))
    for frame in range(len(postures)):
        if guide is not None:
            solver.draw_to(guide.postures[frame], float(guide.weights[frame]))
        clear.place({name: rows[frame] for name, rows in things.items()})
        solver.follow(targets[frame])
        postures[frame] = solver.posture
    return Motion(plan, postures)
