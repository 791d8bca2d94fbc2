"""Where hands are throughout: on what they hold, and in between on paths clear of the scene."""

from collections.abc import Mapping

import numpy as np
from scipy.spatial.transform import RigidTransform

from capar.body.recording import HAND_SEGMENTS
from capar.regeneration.body_frames import BodyFrames, rest_pose
from capar.regeneration.collisions import Surroundings
from capar.regeneration.path_mapping import STRAIGHT, Detour, mapped
from capar.regeneration.scenes import Scene
from capar.regeneration.solving import Solver
from capar.regeneration.sources import Hold, Source

LIFTS_M = (0.0, 0.04, 0.08, 0.12, 0.18, 0.25)
BACKS_M = (0.0, 0.05, 0.1, 0.15, 0.2)
"""Detours that are tried [m]."""

STRIDE = 2
"""Frames between two at which a path is checked."""

CUT_M = 0.0003
"""How far a hand may cut what it is about to hold or has just left [m]."""


def hand_paths(
    source: Source,
    scene: Scene,
    old: BodyFrames,
    new: BodyFrames,
    grips: Mapping[Hold, RigidTransform],
    things: Mapping[str, RigidTransform],
    *,
    margin_m: float,
) -> tuple[dict[str, RigidTransform], dict[tuple[str, int], Detour]]:
    """``T_world_hand`` by side at every frame, and the detours that were taken."""
    clearance = _Clearance(scene, new, things, margin_m)
    out, detours = {}, {}
    for side in source.hands:
        holds = [hold for hold in source.holds if hold.side == side]
        poses: list[RigidTransform] = [new.rest[side]] * len(source.times)
        for hold in holds:
            for frame in range(hold.first, hold.last + 1):
                poses[frame] = things[hold.thing][frame] * grips[hold]
        for before, after in zip([None, *holds], [*holds, None], strict=True):
            first = before.last if before else 0
            last = after.first if after else len(source.times) - 1
            if last <= first:
                continue
            start = poses[first] if before else rest_pose(source, old, new, side, 0)
            goal = poses[last] if after else rest_pose(source, old, new, side, last)
            touched = {each.thing for each in (before, after) if each}
            part = source.hands[side].path[first : last + 1]
            turn = scene.heading - source.scene.heading
            options = {
                detour: mapped(part, start, goal, turn=turn, detour=detour, heading=scene.heading)
                for detour in DETOURS
            }
            best = clearance.first_clear(side, options, first, touched)
            poses[first : last + 1] = list(options[best])
            if best != STRAIGHT:
                detours[side, first] = best
        out[side] = RigidTransform.concatenate(poses)
    return out, detours


DETOURS = sorted(
    (Detour(lift, back) for lift in LIFTS_M for back in BACKS_M),
    key=lambda each: each.lift_m + each.back_m,
)


class _Clearance:
    """How far a hand on its way is from things, whatever the arm does."""

    def __init__(
        self, scene: Scene, new: BodyFrames, things: Mapping[str, RigidTransform], margin_m: float
    ) -> None:
        self.around = Surroundings(new.human, scene)
        self.posture = Solver(new.human, (*scene.place, scene.floor_m), scene.heading).rest
        self.new, self.things, self.margin_m = new, things, margin_m

    def first_clear(
        self, side: str, options: Mapping[Detour, RigidTransform], first: int, touched: set[str]
    ) -> Detour:
        """The smallest detour that is clear, or else the one that comes nearest to it."""
        best, least = STRAIGHT, np.inf
        for detour, path in options.items():
            short = self._short(side, path, first, touched, least)
            if short < least:
                best, least = detour, short
            if least <= 0.0:
                break
        return best

    def _short(
        self, side: str, path: RigidTransform, first: int, touched: set[str], enough: float
    ) -> float:
        """By how much the path is too near, at worst; not further than is decided [m]."""
        ends = [self._gaps(side, path[k], first + k) for k in (0, len(path) - 1)]
        wanted = {
            name: min(self.margin_m, *(gap.get(name, self.margin_m) - 0.001 for gap in ends))
            for name in self.things
        }
        wanted |= dict.fromkeys(touched, -CUT_M)
        worst = 0.0
        for frame in range(0, len(path), STRIDE):
            for name, gap in self._gaps(side, path[frame], first + frame).items():
                worst = max(worst, wanted[name] - gap)
            if worst >= enough:
                break
        return worst

    def _gaps(self, side: str, hand: RigidTransform, frame: int) -> dict[str, float]:
        """The hand's distance from each thing near it: the scene is moved to the hand at ease."""
        shift = self.new.rest[side] * hand.inv()
        self.around.pose(self.posture, {n: shift * path[frame] for n, path in self.things.items()})
        out: dict[str, float] = {}
        for pair in self.around.near([f"{side}_{each}" for each in HAND_SEGMENTS]):
            out[pair.thing] = min(out.get(pair.thing, np.inf), pair.distance_m)
        return out
