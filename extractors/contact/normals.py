"""The direction in which two bodies press on each other where they touch."""

import numpy as np
from jaxtyping import Float

from extractors.bodies.body_geometry import BodyGeometry


def contact_normal(
    body: BodyGeometry, other: BodyGeometry, frame: int
) -> Float[np.ndarray, "3"] | None:
    """The unit normal of a contact, from the other to the body, in the world; None if unknown.

    Among the directions of the world's and both bodies' axes and the one that joins their
    middles, it is the one along which their hulls are furthest apart, or cut each other least.
    """
    offset = body.middles[frame] - other.middles[frame]
    if np.isnan(offset).any():
        return None
    length = float(np.linalg.norm(offset))
    axes = np.concatenate([np.eye(3), body.turn(frame).T, other.turn(frame).T])
    directions = np.concatenate([axes, -axes, [offset / length] if length else axes[:1]])
    own = body.corners @ body.turn(frame).T
    others = other.corners @ other.turn(frame).T
    apart = (
        directions @ offset + (own @ directions.T).min(axis=0) - (others @ directions.T).max(axis=0)
    )
    return np.asarray(directions[int(np.argmax(np.round(apart, 6)))])
