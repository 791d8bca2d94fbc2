"""Standing balance: the centre of mass is kept above the base of support."""

from collections.abc import Mapping
from dataclasses import dataclass

import mink
import mujoco
import numpy as np
from jaxtyping import Float
from scipy.spatial import ConvexHull
from scipy.spatial.transform import RigidTransform, Rotation

from capar.body.human import Human
from capar.body.surfaces import segment_surface

SOLE_M = 0.01
"""What of a foot is no higher than this above its lowest place bears weight [m] (estimate)."""

MARGIN_M = 0.015
"""How far inside the edge of the base of support the centre of mass is kept [m] (estimate)."""

EDGE_COST = 100.0
"""Weight of a metre of the centre of mass beyond that margin."""


@dataclass(frozen=True, eq=False)
class Support:
    """A base of support: the convex hull of the soles that bear weight, seen from above."""

    normals: Float[np.ndarray, "edges 2"]
    """Outward, of length one."""

    offsets: Float[np.ndarray, "edges"]
    """How far each edge is from the origin along its normal [m]."""

    middle: Float[np.ndarray, "2"]
    """The mean of the hull's corners [m]."""

    def outside(self, places: Float[np.ndarray, "*places 2"]) -> Float[np.ndarray, "*places"]:
        """How far places are beyond an edge, at worst [m]; negative inside.

        Beside a corner this is less than the distance from the corner.
        """
        return np.asarray((places @ self.normals.T - self.offsets).max(axis=-1))


def support(human: Human, ankles: Mapping[str, RigidTransform]) -> Support:
    """The base of support.

    Args:
        human: Who stands.
        ankles: ``T_world_foot`` of each foot that bears weight, by side; one at least.
    """
    corners = [pose.apply(sole(human, side))[:, :2] for side, pose in ankles.items()]
    hull = ConvexHull(np.concatenate(corners))
    edges = np.unique(hull.equations.round(9), axis=0)
    return Support(edges[:, :2], -edges[:, 2], hull.points[hull.vertices].mean(axis=0))


def sole(human: Human, side: str) -> Float[np.ndarray, "corners 3"]:
    """What bears weight of a foot, in the frame of its ankle [m]."""
    segments = (f"{side}_foot", f"{side}_toes")
    corners = segment_surface(human.measures, segments, segments[0]).vertices
    return np.asarray(corners[corners[:, 2] <= corners[:, 2].min() + SOLE_M])


def standing_support(human: Human, posture: Float[np.ndarray, "posture"]) -> Support:
    """The base of support of somebody who stands on both feet in a posture."""
    ankles = {}
    for name, (spots, turns) in human.sites(posture[None], ("right_foot", "left_foot")).items():
        turn = Rotation.from_quat(turns[0], scalar_first=True)
        pose = RigidTransform.from_components(spots[0], turn)
        ankles[name.removesuffix("_foot")] = pose
    return support(human, ankles)


class BalanceLimit(mink.Limit):
    """The centre of mass does not go beyond the base of support, less a margin.

    One that is beyond it already goes no further; ``BalanceTask`` draws it back.
    """

    def __init__(self, base: Support, *, margin_m: float = MARGIN_M) -> None:
        self.base, self.margin_m = base, margin_m

    def compute_qp_inequalities(
        self, configuration: mink.Configuration, dt: float
    ) -> mink.Constraint:
        """How far the centre of mass may go towards each edge."""
        room = -_beyond(self.base, configuration, self.margin_m)
        return mink.Constraint(
            G=self.base.normals @ _mass_jacobian(configuration), h=np.maximum(room, 0.0)
        )


class BalanceTask(mink.Task):
    """Draws the centre of mass back above the base of support, less a margin; inside it is free."""

    def __init__(
        self, base: Support, *, cost: float = EDGE_COST, margin_m: float = MARGIN_M
    ) -> None:
        super().__init__(cost=np.array([cost]))
        self.base, self.margin_m = base, margin_m

    def compute_error(self, configuration: mink.Configuration) -> Float[np.ndarray, "1"]:
        """How far the centre of mass is beyond the edge that it is furthest beyond [m]."""
        beyond = _beyond(self.base, configuration, self.margin_m).max()
        return np.array([max(float(beyond), 0.0)])

    def compute_jacobian(self, configuration: mink.Configuration) -> Float[np.ndarray, "1 dofs"]:
        """How the centre of mass goes beyond that edge with the joints; zero inside."""
        beyond = _beyond(self.base, configuration, self.margin_m)
        edge = int(beyond.argmax())
        if beyond[edge] <= 0.0:
            return np.zeros((1, configuration.nv))
        return np.asarray(self.base.normals[edge : edge + 1] @ _mass_jacobian(configuration))


def _beyond(
    base: Support, configuration: mink.Configuration, margin_m: float
) -> Float[np.ndarray, "edges"]:
    """How far the centre of mass is beyond each edge, less a margin [m]."""
    place = configuration.data.subtree_com[1, :2]
    return np.asarray(base.normals @ place - base.offsets + margin_m)


def _mass_jacobian(configuration: mink.Configuration) -> Float[np.ndarray, "2 dofs"]:
    """How the centre of mass moves on the floor with the joints."""
    out = np.empty((3, configuration.nv))
    mujoco.mj_jacSubtreeCom(configuration.model, configuration.data, out, 1)
    return out[:2]
