"""Inverse kinematics: a solver whose steps never overshoot; tasks for points, feet, balance."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import mink
import mujoco
import numpy as np
from jaxtyping import Bool, Float
from scipy.linalg import null_space
from scipy.spatial import ConvexHull
from scipy.spatial.transform import RigidTransform, Rotation

from capar.body.human import Human
from capar.body.shapes import segment_surface
from extractors.readers.names import SIDES, parts, without_side

#: A solver whose steps have become shorter has found what there is to find [rad]
SHORTEST_RAD = 1e-3
#: A foot stands flat while each of its points is no higher above its own lowest place [m]
FLAT_M = 0.02
#: Share of the frames of which the highest is taken for a point's lowest place [1]
LOWEST_SHARE = 0.05
#: What of a foot is no higher than this above its lowest place bears weight [m] (estimate)
SOLE_M = 0.01
#: How far inside the edge of the base of support the centre of mass is kept [m] (estimate)
MARGIN_M = 0.015
EDGE_COST = 100.0  # weight of a metre of the centre of mass beyond that margin

Points = Mapping[str, Float[np.ndarray, "frames 3"]]


def joint_limits(
    human: Human, longest_rad: float
) -> tuple[mink.ConfigurationLimit, mink.VelocityLimit]:
    """Joints keep to their ranges, and turn by so much in a step at most [rad]."""
    speeds = mink.VelocityLimit(human.model, dict.fromkeys(human.joints, longest_rad))
    return mink.ConfigurationLimit(human.model), speeds


class Solver:
    """Steps towards what tasks want, within the joints' ranges, shortened where they overshoot.

    Plain steps overshoot at a straight limb or at the end of a range. One that makes the weighted
    errors larger is undone and a shorter one tried (trust region; Nocedal & Wright 2006, ch. 4).
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

        self.left = np.inf
        """The error after the last step [1]."""

        ranges, self.speed = joint_limits(human, longest_rad)
        self.limits = [ranges, self.speed, *limits]

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

    def step(
        self, configuration: mink.Configuration, before: float | None = None
    ) -> Float[np.ndarray, "dofs"]:
        """Take one step [rad, m], or stay (zeros) and take shorter steps from now on.

        ``before``: the error there, if it is known from the step before (``left``).
        """
        before = self.error(configuration) if before is None else before
        posture, self.left = configuration.q.copy(), before
        self.speed.limit = np.full(len(self.human.joints), self.radius)
        velocity = mink.solve_ik(configuration, self.tasks, 1.0, "daqp", limits=self.limits)
        configuration.integrate_inplace(velocity, 1.0)
        longest = float(np.abs(velocity[6:]).max())
        after = self.error(configuration)
        if after > before:
            configuration.update(posture)
            self.radius = 0.4 * min(self.radius, longest)
            return np.zeros_like(velocity)
        self.left = after
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


class PointTask(mink.Task):
    """Draws sites and segments to points, however they turn: many frame tasks in one Jacobian."""

    def __init__(self, human: Human, places: Sequence[str], costs: Sequence[float]) -> None:
        """Set up the task for sites or segments, each with the weight of a metre."""
        self._frames = [human.frame(place) for place in places]
        self._rows = np.repeat(np.asarray(costs, dtype=float), 3)
        super().__init__(cost=self._rows)
        self._targets = np.zeros((len(places), 3))
        self._jacobian = np.empty((3 * len(places), human.model.nv))

    def aim(self, targets: Float[np.ndarray, "places 3"]) -> None:
        """Set where each place is drawn to [m]; one that is NaN is let go."""
        seen = np.isfinite(targets).all(axis=1)
        self._targets = np.where(seen[:, None], targets, 0.0)
        self.cost = self._rows * np.repeat(seen, 3)

    def compute_error(self, configuration: mink.Configuration) -> Float[np.ndarray, "rows"]:
        """Where each place is, less where it is drawn to [m]."""
        data = configuration.data
        spots = {"site": data.site_xpos, "body": data.xpos}
        now = [spots[kind][number] for kind, number in self._frames]
        return np.asarray((np.array(now) - self._targets).reshape(-1))

    def compute_jacobian(self, configuration: mink.Configuration) -> Float[np.ndarray, "rows dofs"]:
        """How each place moves with the joints."""
        for row, (kind, number) in enumerate(self._frames):
            fill = mujoco.mj_jacSite if kind == "site" else mujoco.mj_jacBody
            part = self._jacobian[3 * row : 3 * row + 3]
            fill(configuration.model, configuration.data, part, None, number)
        return self._jacobian


def standing_flat(points: Points, places: Mapping[str, str]) -> dict[str, Bool[np.ndarray, "f"]]:
    """By side, the frames in which a foot stands flat; sides of which no foot is seen are left out.

    Heel and toe are both at their lowest only on a foot that stands flat.
    """
    out = {}
    for side in SIDES:
        heights = [
            points[name][:, 2]
            for name, place in places.items()
            if name in points and not np.isnan(points[name]).all()
            if place.startswith(side) and parts().get(without_side(place)) == "foot"
        ]
        rises = [each - np.nanquantile(each, LOWEST_SHARE) for each in heights]
        if rises:
            stack = np.stack(rises)
            seen = ~np.isnan(stack)
            flat = np.where(seen, stack <= FLAT_M, True).all(axis=0)
            out[side] = flat & (seen.sum(axis=0) > len(rises) / 2)
    return out


class GroundTask(mink.Task):
    """Keeps places on feet out of the ground; above it they are free."""

    def __init__(self, model: mujoco.MjModel, places: Mapping[str, float], cost: float) -> None:
        """Set up the task for sites with their least heights [m]; ``cost`` is of a metre."""
        super().__init__(cost=np.full(len(places), cost))
        self._sites = [model.site(name).id for name in places]
        self._heights = np.array(list(places.values()))

    def compute_error(self, configuration: mink.Configuration) -> Float[np.ndarray, "places"]:
        """Height above what is allowed, where that is negative; else 0 [m]."""
        heights = configuration.data.site_xpos[self._sites, 2]
        return np.asarray(np.minimum(heights - self._heights, 0.0))

    def compute_jacobian(
        self, configuration: mink.Configuration
    ) -> Float[np.ndarray, "places dofs"]:
        """How those heights change with the joints."""
        model, data = configuration.model, configuration.data
        out, part = np.zeros((len(self._sites), model.nv)), np.empty((3, model.nv))
        for row in np.flatnonzero(self.compute_error(configuration) < 0.0):
            mujoco.mj_jacSite(model, data, part, None, self._sites[row])
            out[row] = part[2]
        return out


class DirectionTask(mink.Task):
    """Points a segment's axis in a direction, however the segment turns about it."""

    def __init__(self, segment: str, cost: float, axis: Sequence[float] = (0.0, 0.0, 1.0)) -> None:
        """Aim upwards; ``cost`` is of a radian, the axis in the segment's frame."""
        super().__init__(cost=np.full(2, cost))
        self.segment = segment
        self._across = null_space(np.array([axis], dtype=float)).T
        self._full = np.full(2, cost)
        self._direction = np.array([0.0, 0.0, 1.0])

    def aim(self, direction: Float[np.ndarray, "3"]) -> None:
        """Set the direction in the world [1]."""
        self._direction = np.asarray(direction, dtype=float)

    def trust(self, share: float) -> None:
        """Let it count by a share of its weight [1]."""
        self.cost = share * self._full

    def compute_error(self, configuration: mink.Configuration) -> Float[np.ndarray, "2"]:
        """The direction across the segment's own axis [1]."""
        return np.asarray(self._across @ self._seen(configuration))

    def compute_jacobian(self, configuration: mink.Configuration) -> Float[np.ndarray, "2 dofs"]:
        """How that turns with the joints."""
        turning = configuration.get_frame_jacobian(self.segment, "body")[3:]
        moved = np.cross(self._seen(configuration)[:, None], turning, axis=0)
        return np.asarray(self._across @ moved)

    def _seen(self, configuration: mink.Configuration) -> Float[np.ndarray, "3"]:
        """The direction in the segment's frame [1]."""
        turn = configuration.data.body(self.segment).xmat.reshape(3, 3)
        return np.asarray(turn.T @ self._direction)


@dataclass(frozen=True, eq=False)
class Support:
    """A base of support: the convex hull of the soles that bear weight, seen from above."""

    normals: Float[np.ndarray, "edges 2"]  #: Outward, of length one
    #: How far each edge is from the origin along its normal [m]
    offsets: Float[np.ndarray, "edges"]
    middle: Float[np.ndarray, "2"]  #: The mean of the hull's corners [m]

    def outside(self, places: Float[np.ndarray, "*places 2"]) -> Float[np.ndarray, "*places"]:
        """How far places are beyond an edge, at worst [m]; negative inside."""
        return np.asarray((places @ self.normals.T - self.offsets).max(axis=-1))


def support(human: Human, ankles: Mapping[str, RigidTransform]) -> Support:
    """The base of support, from ``T_world_foot`` of each foot that bears weight, by side."""
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
    """The centre of mass stays over the base less a margin, or goes no further if outside."""

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
