"""The trunk of an agent: by which sensor it is known, and where others are from it."""

from collections.abc import Iterable

import numpy as np
from jaxtyping import Float

from capar.model.capture import Sensor
from extractors.bodies.body_geometry import BodyGeometry
from extractors.bodies.poses import rotation_matrices

TRUNK = ("pelvis", "l5", "hips", "waist", "spine", "torso", "trunk", "chest", "neck")
"""General types of sensors on the trunk, those first that are nearest to the body's middle."""


def trunk_sensor(sensors: Iterable[Sensor]) -> Sensor | None:
    """The trunk's sensor that is nearest to the body's middle, of one agent's; None without one."""
    by_type = {sensor.end_effector: sensor for sensor in sensors if sensor.end_effector in TRUNK}
    return next((by_type[kind] for kind in TRUNK if kind in by_type), None)


def from_trunk(
    body: BodyGeometry, trunk: BodyGeometry, upright: Float[np.ndarray, "3"]
) -> Float[np.ndarray, "frames 3"]:
    """The middle of a body from the trunk's origin [m], by axes that turn with the trunk.

    They turn about the vertical only, and do not lean: who bends has not raised a hand.

    Args:
        body: The body.
        trunk: The trunk; where either is lost, the answer is NaN.
        upright: The axis of the trunk that points up while it stands, in its own frame.
    """
    stream = trunk.poses.smooth
    offset = body.middles - stream.positions
    ahead = _levelled(rotation_matrices(stream.orientations), upright)
    x = ahead[:, 0] * offset[:, 0] + ahead[:, 1] * offset[:, 1]
    y = ahead[:, 0] * offset[:, 1] - ahead[:, 1] * offset[:, 0]
    return np.stack([x, y, offset[:, 2]], axis=1)


def _levelled(
    rotations: Float[np.ndarray, "frames 3 3"], upright: Float[np.ndarray, "3"]
) -> Float[np.ndarray, "frames 2"]:
    """The direction on the level of some axis across ``upright``, as if it had been righted.

    The shortest rotation from ``a`` to ``b`` takes ``v``, which is across ``a``, to
    ``v - (b v) (a + b) / (1 + a b)``.
    """
    across = np.eye(3)[int(np.argmin(np.abs(upright)))]
    across = across - (across @ upright) * upright
    up, side = rotations @ upright, rotations @ (across / np.linalg.norm(across))
    with np.errstate(divide="ignore", invalid="ignore"):
        share = side[:, 2] / (1.0 + up[:, 2])
    level = side[:, :2] - share[:, None] * up[:, :2]
    return np.asarray(level / np.linalg.norm(level, axis=1, keepdims=True))
