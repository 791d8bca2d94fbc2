"""What the motions of several bodies are worth together: gates between them."""

import itertools
from collections.abc import Iterator, Mapping

import mujoco
import numpy as np
from jaxtyping import Float
from scipy.spatial.transform import RigidTransform

from capar.body.human import Human, body_spec
from capar.regeneration.joint_sources import HandOver, JointSource
from capar.regeneration.motions import Motion
from capar.regeneration.quality import Gate, performed_hands

FAR_M = 0.1
"""Larger distances between two bodies are not measured [m]."""


class TwoBodies:
    """Two bodies, to be posed and measured."""

    def __init__(self, first: Human, second: Human) -> None:
        spec = body_spec(first.measures)
        spec.worldbody.add_frame().attach_body(
            body_spec(second.measures).worldbody.first_body(), "other_", ""
        )
        self.model = spec.compile()
        self.data = mujoco.MjData(self.model)
        names = [
            self.model.body(int(self.model.geom_bodyid[geom])).name
            for geom in range(self.model.ngeom)
        ]
        own = [geom for geom, name in enumerate(names) if not name.startswith("other_")]
        others = [geom for geom, name in enumerate(names) if name.startswith("other_")]
        self.pairs = np.array(list(itertools.product(own, others)))
        self.names = [name.removeprefix("other_") for name in names]
        self.reach = self.model.geom_rbound[self.pairs].sum(axis=1)

    def nearest(
        self, first: Float[np.ndarray, "posture"], second: Float[np.ndarray, "posture"]
    ) -> tuple[float, str, str]:
        """How far two bodies are apart in some postures, negative inside [m], and which parts.

        Args:
            first: Posture of the first body.
            second: Likewise.
        """
        self.data.qpos[:] = np.concatenate([first, second])
        mujoco.mj_kinematics(self.model, self.data)
        middles = self.data.geom_xpos[self.pairs]
        apart = np.linalg.norm(middles[:, 0] - middles[:, 1], axis=1) - self.reach
        worst = (FAR_M, "", "")
        for row in np.flatnonzero(apart < FAR_M):
            one, two = (int(geom) for geom in self.pairs[row])
            found = mujoco.mj_geomDistance(self.model, self.data, one, two, FAR_M, None)
            worst = min(worst, (float(found), self.names[one], self.names[two]))
        return worst


def joint_gates(source: JointSource, motions: Mapping[str, Motion]) -> tuple[Gate, ...]:
    """Gates between all bodies, at every frame.

    Args:
        source: What was recorded.
        motions: By the agent's name.
    """
    return (*_between(motions), *_coupled(source, motions))


def _between(motions: Mapping[str, Motion]) -> Iterator[Gate]:
    for (one, first), (two, second) in itertools.combinations(motions.items(), 2):
        both = TwoBodies(first.plan.human, second.plan.human)
        rows = zip(first.postures, second.postures, strict=True)
        found = [(*both.nearest(*postures), frame) for frame, postures in enumerate(rows)]
        gap_m, part, other, frame = min(found)
        bodies = f"{one}'s {part}, {two}'s {other}" if part else ""
        yield Gate("bodies apart", 1e3 * gap_m, -1.0, "mm", True, frame, bodies)


def _coupled(source: JointSource, motions: Mapping[str, Motion]) -> Iterator[Gate]:
    """Both hands are where they hold the thing as long as both were recorded to hold it."""
    for passed in source.hand_overs:
        worst = max(_missed(motions[name], passed, name) for name in (passed.giver, passed.taker))
        missed_m, frame, bodies = worst
        yield Gate("hand-over", 1e3 * missed_m, 1.0, "mm", False, frame, bodies)


def _missed(motion: Motion, passed: HandOver, name: str) -> tuple[float, int, str]:
    """How far a performer's hands are from their grips while a thing is handed over [m]."""
    plan, part = motion.plan, slice(passed.first, passed.last + 1)
    hands, worst = performed_hands(motion), (0.0, passed.first, name)
    for grip in plan.grips:
        hold = grip.hold
        if hold.thing == passed.thing and hold.first <= passed.first <= passed.last <= hold.last:
            wanted: RigidTransform = plan.things[hold.thing][part] * grip.pose
            off = np.linalg.norm(hands[hold.side][part].translation - wanted.translation, axis=1)
            row = int(off.argmax())
            found = (float(off[row]), passed.first + row, f"{name}'s {hold.side} hand")
            worst = max(worst, found)
    return worst
