"""Places on the body drawn to points, all as one task of inverse kinematics."""

from collections.abc import Sequence

import mink
import mujoco
import numpy as np
from jaxtyping import Float

from capar.model.errors import UnknownNameError


class PointTask(mink.Task):
    """Draws sites and segments' origins to points, whichever way they turn.

    It is what a frame task of each place without a cost of orientation is, in one Jacobian: with
    forty markers that is ten times as fast.
    """

    def __init__(self, model: mujoco.MjModel, places: Sequence[str], costs: Sequence[float]):
        """Set up the task.

        Args:
            model: The body's.
            places: Sites or segments.
            costs: Weight of a metre of each.

        Raises:
            UnknownNameError: The body has no such place.
        """
        self._frames = [_frame(model, place) for place in places]
        self._rows = np.repeat(np.asarray(costs, dtype=float), 3)
        super().__init__(cost=self._rows)
        self._targets = np.zeros((len(places), 3))
        self._jacobian = np.empty((3 * len(places), model.nv))

    def aim(self, targets: Float[np.ndarray, "places 3"]) -> None:
        """Set where each place is drawn to [m]; one that is NaN is let go."""
        seen = np.isfinite(targets).all(axis=1)
        self._targets = np.where(seen[:, None], targets, 0.0)
        self.cost = self._rows * np.repeat(seen, 3)

    def compute_error(self, configuration: mink.Configuration) -> Float[np.ndarray, "rows"]:
        """Where each place is, less where it is drawn to [m]."""
        data = configuration.data
        now = [(data.site_xpos if site else data.xpos)[number] for site, number in self._frames]
        return np.asarray((np.array(now) - self._targets).reshape(-1))

    def compute_jacobian(self, configuration: mink.Configuration) -> Float[np.ndarray, "rows dofs"]:
        """How each place moves with the joints."""
        for row, (site, number) in enumerate(self._frames):
            place = mujoco.mj_jacSite if site else mujoco.mj_jacBody
            part = self._jacobian[3 * row : 3 * row + 3]
            place(configuration.model, configuration.data, part, None, number)
        return self._jacobian


def _frame(model: mujoco.MjModel, place: str) -> tuple[bool, int]:
    """Whether a place is a site, and its number."""
    site = mujoco.mj_name2id(model, mujoco.mjtObj.mjOBJ_SITE, place)
    if site >= 0:
        return True, int(site)
    body = mujoco.mj_name2id(model, mujoco.mjtObj.mjOBJ_BODY, place)
    if body < 0:
        known = [model.body(index).name for index in range(1, model.nbody)]
        raise UnknownNameError("place on the body", place, known)
    return False, int(body)
