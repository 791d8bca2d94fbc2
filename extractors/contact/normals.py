"""The direction in which two bodies press on each other where they touch."""

import numpy as np
from jaxtyping import Float

from extractors.bodies.body_geometry import BodyGeometry
from extractors.contact.patches import facing_normal
from extractors.contact.surfaces import Surface, surface
from extractors.thresholds import Thresholds


def contact_normal(
    body: BodyGeometry, other: BodyGeometry, frame: int, thresholds: Thresholds
) -> Float[np.ndarray, "3"] | None:
    """The unit normal of a contact, from the other to the body, in the world; None if unknown.

    It is the mean normal of the patch where the true surfaces meet: what stands in a bowl lies on
    the bowl's bottom, however high the bowl's rim. Where either body has no shape, or the patch
    has no direction, it is the axis along which their outlines are furthest apart.
    """
    offset = body.middles[frame] - other.middles[frame]
    if np.isnan(offset).any():
        return None
    if body.shape is not None and other.shape is not None:
        one, two = surface(body.shape), surface(other.shape)
        found = facing_normal(
            _placed(one, body, frame),
            _placed(two, other, frame),
            depth_m=thresholds.patch_m,
            solid=(one.closed, two.closed),
        )
        if found is not None:
            return found
    return _between_outlines(body, other, frame)


def _placed(of: Surface, body: BodyGeometry, frame: int) -> Float[np.ndarray, "triangles 3 3"]:
    """A surface's triangles in the world at a frame [m], outward, where its body's middle is."""
    local = of.triangles - of.centre
    if of.inverted:
        local = local[:, ::-1]
    return np.asarray(local @ body.turn(frame).T + body.middles[frame])


def _between_outlines(
    body: BodyGeometry, other: BodyGeometry, frame: int
) -> Float[np.ndarray, "3"]:
    """The direction along which two bodies' outermost points are furthest apart.

    Sought among the world's and both bodies' axes and the line that joins their middles.
    """
    offset = body.middles[frame] - other.middles[frame]
    length = float(np.linalg.norm(offset))
    axes = np.concatenate([np.eye(3), body.turn(frame).T, other.turn(frame).T])
    directions = np.concatenate([axes, -axes, [offset / length] if length else axes[:1]])
    own = body.corners @ body.turn(frame).T
    others = other.corners @ other.turn(frame).T
    apart = (
        directions @ offset + (own @ directions.T).min(axis=0) - (others @ directions.T).max(axis=0)
    )
    return np.asarray(directions[int(np.argmax(np.round(apart, 6)))])
