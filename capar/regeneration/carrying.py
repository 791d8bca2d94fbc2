"""The way of a held thing between two goals, lifted over what stands in it."""

from collections.abc import Iterator, Mapping
from types import MappingProxyType

import numpy as np
from jaxtyping import Float
from scipy.ndimage import maximum_filter1d, uniform_filter1d
from scipy.spatial.transform import RigidTransform

from capar.body.human import Human
from capar.model.capture import TagType
from capar.regeneration.collisions import Surroundings
from capar.regeneration.errors import PlanError
from capar.regeneration.path_mapping import STRAIGHT, Detour, mapped
from capar.regeneration.scenes import Scene
from capar.regeneration.solving import Solver, vectors
from capar.regeneration.style_kinds import Kind

LIFTS_M = (0.0, 0.02, 0.04, 0.07, 0.1, 0.15, 0.2, 0.3)
"""How far a way is lifted half-way, in order [m]."""

BESIDE_M = 0.01
"""How far a held thing keeps from what stands beside its way [m]."""

SLACK_M = 0.0005
"""How much nearer than at both ends it may come [m]."""

CUT_M = 0.001
"""How much deeper than at both ends it may be inside something [m]."""

SUNK_M = 0.005
"""A recorded thing that sinks no deeper into what is fixed does so by error [m]."""

SPREAD = 9
"""Over so many frames it is raised out of it [1]."""

STEEPEST_M = 0.001
"""Nor faster than this from either end of its way [m a frame]."""

STRIDE = 2
"""Frames between two at which a way is checked."""


class Carrying:
    """Ways of held things through a scene."""

    def __init__(self, human: Human, scene: Scene, kind: Kind) -> None:
        self.scene, self.kind = scene, kind
        self.around = Surroundings(human, scene)
        self.posture = Solver(human, (*scene.place, scene.floor_m), scene.heading).rest

    def way(
        self,
        name: str,
        part: RigidTransform,
        ends: tuple[RigidTransform, RigidTransform],
        others: Mapping[str, RigidTransform],
        turn: float,
        along: Mapping[str, RigidTransform] = MappingProxyType({}),
    ) -> tuple[RigidTransform, Detour]:
        """``T_world_thing`` from one goal to the next, and the detour that it makes.

        Args:
            name: Of the thing.
            part: As it was recorded.
            ends: Where it starts and where it has to go.
            others: Where the other things are meanwhile.
            turn: How far the scene's way is turned about z [rad].
            along: ``T_thing_borne`` of what it bears, which goes the same way.

        Raises:
            PlanError: However far it is lifted, it goes through something.
        """
        best, least = STRAIGHT, np.inf
        for detour in (Detour(lift) for lift in LIFTS_M):
            path = self._mapped(name, part, ends, turn, detour, others)
            short = self._short(name, path, others)
            for borne, seat in along.items():
                short = max(short, self._short(borne, path * seat, others))
            if short < least:
                best, least = detour, short
            if least <= 0.0:
                break
        path = self._mapped(name, part, ends, turn, best, others)
        if least > 0.0:
            self._check_free(name, path, others)
            for borne, seat in along.items():
                self._check_free(borne, path * seat, others)
        return path, best

    def _mapped(
        self,
        name: str,
        part: RigidTransform,
        ends: tuple[RigidTransform, RigidTransform],
        turn: float,
        detour: Detour,
        others: Mapping[str, RigidTransform],
    ) -> RigidTransform:
        facing = self.scene.heading
        path = mapped(part, *ends, turn=turn, detour=detour, heading=facing, kind=self.kind)
        return self._out_of_ground(name, path, others)

    def _out_of_ground(
        self, name: str, path: RigidTransform, others: Mapping[str, RigidTransform]
    ) -> RigidTransform:
        """The way raised where it sinks a little deeper into something fixed than both ends do.

        Recorded things do, as they are tipped up: their poses are a few millimetres off.
        """
        things = self.scene.things
        fixed = {n: vectors(p) for n, p in others.items() if things[n].tag is TagType.FIXED}
        gaps = [dict(self._gaps(name, pose, fixed)) for pose in vectors(path)]
        usual = {n: min(0.0, gaps[0].get(n, 0.0), gaps[-1].get(n, 0.0)) for n in fixed}
        sunk = np.array([max([0.0, *(usual[n] - gap for n, gap in g.items())]) for g in gaps])
        if not 0.0 < sunk.max() <= SUNK_M:
            return path
        wide = uniform_filter1d(maximum_filter1d(sunk, SPREAD), SPREAD)
        frames = np.arange(len(sunk))
        by_m = np.minimum(wide, STEEPEST_M * np.minimum(frames, frames[::-1]))
        return RigidTransform.from_translation(np.outer(by_m, [0.0, 0.0, 1.0])) * path

    def _check_free(
        self, name: str, path: RigidTransform, others: Mapping[str, RigidTransform]
    ) -> None:
        """No way leads deeper into something than both of its ends are."""
        poses, still = vectors(path), {n: vectors(pose) for n, pose in others.items()}
        ends = [dict(self._gaps(name, poses[row], still)) for row in (0, -1)]
        found = (pair for pose in poses for pair in self._gaps(name, pose, still))
        other, gap = min(found, key=lambda pair: pair[1], default=("", 0.0))
        if gap < min(0.0, *(end.get(other, 0.0) for end in ends)) - CUT_M:
            raise PlanError(
                f"{name!r} would go {-1e3 * gap:.0f} mm into {other!r} on its way, however far it "
                "is lifted"
            )

    def _short(
        self, name: str, path: RigidTransform, others: Mapping[str, RigidTransform]
    ) -> float:
        """By how much it comes too near something, at worst [m]."""
        poses, still = vectors(path), {n: vectors(pose) for n, pose in others.items()}
        ends = [dict(self._gaps(name, poses[row], still)) for row in (0, -1)]
        worst = 0.0
        for row in range(0, len(path), STRIDE):
            for other, gap in self._gaps(name, poses[row], still):
                least = min(BESIDE_M, *(end.get(other, BESIDE_M) for end in ends))
                worst = max(worst, least - SLACK_M - gap)
        return worst

    def _gaps(
        self,
        name: str,
        pose: Float[np.ndarray, "7"],
        others: Mapping[str, Float[np.ndarray, "7"]],
    ) -> Iterator[tuple[str, float]]:
        self.around.place(self.posture, {**others, name: pose})
        for pair in self.around.things_near():
            other = pair.thing if pair.part == name else pair.part
            if name in (pair.part, pair.thing) and other in others:
                yield other, pair.distance_m
