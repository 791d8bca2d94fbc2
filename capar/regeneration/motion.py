"""The motion of a whole body along a plan, by inverse kinematics frame by frame."""

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from capar.regeneration.collisions import ClearTask, Surroundings
from capar.regeneration.planning import Draft, Plan
from capar.regeneration.solving import Solver, vectors

FADE_S = 0.6
"""How long before the first key frame and after the last one a motion is drawn to them [s]."""


@dataclass(frozen=True, eq=False)
class Guide:
    """A posture for every frame, and how strongly a motion is drawn to it."""

    postures: Float[np.ndarray, "frames posture"]
    weights: Float[np.ndarray, "frames"]
    """[1]."""


def guide_of(draft: Draft) -> Guide:
    """The key postures of a draft whose grips are chosen, and straight paths between them."""
    keys, rest = draft.key_postures()
    times, shown = draft.source.times, sorted(keys)
    at_s = [times[shown[0]] - FADE_S, *times[shown], times[shown[-1]] + FADE_S]
    rows = np.array([rest, *(keys[frame] for frame in shown), rest])
    postures = np.stack([np.interp(times, at_s, column) for column in rows.T], axis=1)
    weights = np.interp(times, at_s, [0.0, *np.ones(len(shown)), 0.0])
    return Guide(postures, weights)


SETTLING = 60
"""Iterations for the first frame."""


@dataclass(frozen=True, eq=False)
class Motion:
    """A body's postures along a plan."""

    plan: Plan
    postures: Float[np.ndarray, "frames posture"]


def perform_plan(plan: Plan, guide: Guide | None = None) -> Motion:
    """Follow a plan frame by frame."""
    scene = plan.scene
    clear = ClearTask(Surroundings(plan.human, scene), plan.source.met)
    solver = Solver(plan.human, (*scene.place, scene.floor_m), scene.heading, (clear,))
    targets = plan.targets()
    things = {name: vectors(path) for name, path in plan.things.items()}
    if guide is not None:
        solver.draw_to(guide.postures[0], float(guide.weights[0]))
    for clear.active in (False, True):  # the path from standing at ease may lead through objects
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
