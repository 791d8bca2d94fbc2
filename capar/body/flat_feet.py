"""When feet stand flat on the ground, and tasks of inverse kinematics that keep segments level."""

from collections.abc import Mapping, Sequence

import mink
import mujoco
import numpy as np
from jaxtyping import Bool, Float
from scipy.linalg import null_space

from extractors.readers.body_names.body_names import SIDES, parts, without_side

FLAT_M = 0.02
"""A foot stands flat while each of its points is no higher above its own lowest place [m]."""

LOWEST_SHARE = 0.05
"""Share of the frames of which the highest is taken for a point's lowest place [1]."""

Points = Mapping[str, Float[np.ndarray, "frames 3"]]


def standing_flat(points: Points, places: Mapping[str, str]) -> dict[str, Bool[np.ndarray, "f"]]:
    """By side, the frames in which a foot stands flat; sides of which no foot is seen are left out.

    Heel and toe are both at their lowest only on a foot that stands flat, on the ground as on the
    belt of a treadmill.

    Args:
        points: By name [m], z up; NaN where lost.
        places: The place on the body of each.
    """
    out = {}
    for side in SIDES:
        own = [name for name, place in places.items() if name in points and _on_foot(place, side)]
        rises = [_rise(points[name][:, 2]) for name in own if not np.isnan(points[name]).all()]
        if rises:
            stack = np.stack(rises)
            seen = ~np.isnan(stack)
            flat = np.where(seen, stack <= FLAT_M, True).all(axis=0)
            out[side] = flat & (seen.sum(axis=0) > len(rises) / 2)
    return out


def _on_foot(place: str, side: str) -> bool:
    return place.startswith(side) and parts().get(without_side(place)) == "foot"


def _rise(heights: Float[np.ndarray, "frames"]) -> Float[np.ndarray, "frames"]:
    return np.asarray(heights - np.nanquantile(heights, LOWEST_SHARE))


class GroundTask(mink.Task):
    """Keeps places on feet out of the ground; above it they are free."""

    def __init__(self, model: mujoco.MjModel, places: Mapping[str, float], cost: float) -> None:
        """Set up the task.

        Args:
            model: The body's.
            places: Sites, each with the height that it may not be below [m].
            cost: Weight of a metre.
        """
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
    """Points a segment's own axis in a direction, however the segment is turned about it."""

    def __init__(self, segment: str, axis: Sequence[float], cost: float) -> None:
        """Set up the task, which aims upwards.

        Args:
            segment: Name of the body.
            axis: In the segment's frame [1].
            cost: Weight of a radian.
        """
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


class UprightTask(DirectionTask):
    """Keeps a segment's own z axis upright, whichever way it faces."""

    def __init__(self, segment: str, cost: float) -> None:
        """Set up the task.

        Args:
            segment: Name of the body.
            cost: Weight of a radian.
        """
        super().__init__(segment, (0.0, 0.0, 1.0), cost)
