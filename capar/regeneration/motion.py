"""The motion of a whole body along a plan, by inverse kinematics frame by frame."""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from jaxtyping import Float

from capar.body.grasping import CLOSE_S, Grasp, fingered, flexions, hand_grasps
from capar.body.human import Human
from capar.body.scripts import SIDES
from capar.model.geometry import transforms
from capar.regeneration.collisions import ClearTask, Surroundings
from capar.regeneration.holds import hand_spans
from capar.regeneration.planning import Draft, Plan
from capar.regeneration.solving import Solver, Targets, vectors

FADE_S = 0.6
"""How long before the first key frame and after the last one a motion is drawn to them [s]."""

SETTLING = 60  # Iterations for the first frame.

Guide = tuple[np.ndarray, np.ndarray]
"""A posture for every frame, and how strongly a motion is drawn to it [1]."""


def guide_of(draft: Draft) -> Guide:
    """The key postures of a draft whose grips are chosen, and straight paths between them."""
    solver, times = draft.solver(), draft.source.times
    shown = draft.key_frames(draft.source.holds)
    rows = [solver.rest]
    for frame in shown:
        draft.follow(solver, list(draft.grips), frame)
        rows.append(solver.posture)
    rows.append(solver.rest)
    at_s = [times[shown[0]] - FADE_S, *times[shown], times[shown[-1]] + FADE_S]
    postures = [np.interp(times, at_s, column) for column in np.array(rows).T]
    weights = np.interp(times, at_s, [0.0, *np.ones(len(shown)), 0.0])
    return np.stack(postures, axis=1), weights


@dataclass(frozen=True, eq=False)
class Motion:
    """A body's postures along a plan."""

    plan: Plan
    postures: Float[np.ndarray, "frames posture"]
    looks: int = 0
    """How often it was looked up what of a hollow object is near a limb [1]."""

    @cached_property
    def grasps(self) -> Mapping[str, tuple[Grasp, ...]]:
        """How the fingers of each hand close on what it holds."""
        plan, out = self.plan, {}
        things = {n: (t.shape, plan.things[n]) for n, t in plan.scene.things.items()}
        sites = plan.human.sites(self.postures, [f"{side}_hand" for side in SIDES])
        for side in SIDES:
            hand = transforms(*sites[f"{side}_hand"])
            found = hand_grasps(
                plan.human.measures, side, hand, things, self._spans(side), plan.source.rate_hz
            )
            out[side] = tuple(found)
        return out

    def _spans(self, side: str) -> Iterator[tuple[int, int, frozenset[str]]]:
        """When a hand's fingers are closed on what; open when it throws and when it catches.

        On nothing all the time, where it holds nothing: they keep out of what is near.
        """
        source = self.plan.source
        opens = round(CLOSE_S * source.rate_hz)
        holds = [hold for hold in source.holds if hold.side == side]
        if not holds:
            yield 0, len(self.postures) - 1, frozenset()
        for span, names in hand_spans(holds, source.co_held):
            thrown = any((t.side, t.first) == (side, span.last) for t in source.throws)
            caught = any((t.catcher, t.last) == (side, span.first) for t in source.throws)
            first, last = span.first + opens * caught, span.last - opens * thrown
            if first <= last:
                yield first, last, names

    @cached_property
    def fingered(self) -> tuple[Human, Float[np.ndarray, "frames posture"]]:
        """The body with five fingers on each hand, and its postures."""
        frames = len(self.postures)
        hands = {side: flexions(frames, own) for side, own in self.grasps.items()}
        return fingered(self.plan.human, self.postures, hands)


def perform_plan(plan: Plan, guide: Guide | None = None) -> Motion:
    """Follow a plan frame by frame."""
    scene = plan.scene
    clear = ClearTask(Surroundings(plan.human, scene), plan.source.met, plan.hands)
    solver = Solver(plan.human, (*scene.place, scene.floor_m), scene.heading, (clear,))
    palms = {side: vectors(path * plan.frames.palms[side]) for side, path in plan.hands.items()}
    head = vectors(plan.head)
    things = {name: vectors(path) for name, path in plan.things.items()}
    postures = np.empty((len(head), len(solver.posture)))
    for frame in range(len(head)):
        target = Targets(
            {side: rows[frame] for side, rows in palms.items()},
            {side: float(firm[frame]) for side, firm in plan.grasps.items()},
            head[frame], float(plan.firmness[frame]), plan.looks[frame],
        )  # fmt: skip
        if guide is not None:
            solver.draw_to(guide[0][frame], float(guide[1][frame]))
        if frame == 0:
            for clear.active in (False, True):  # the way from ease may lead through objects
                solver.follow(target, most=SETTLING)
            solver.frame.bound(1.0 / plan.source.rate_hz)
        clear.place({name: rows[frame] for name, rows in things.items()})
        solver.follow(target)
        postures[frame] = solver.posture
    return Motion(plan, postures, clear.around.looks)
