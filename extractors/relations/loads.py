"""What is borne in or on something that moves, and goes along: a cup on a tray, a ball in a box."""

from collections.abc import Iterable

import numpy as np

from extractors.bodies.body_geometry import BodyGeometry
from extractors.contact.normals import contact_normal
from extractors.contact.surfaces import surface
from extractors.signals.intervals import Interval
from extractors.thresholds import Thresholds


def rides(
    load: BodyGeometry,
    bearer: BodyGeometry,
    touching: Interval,
    motions: Iterable[Interval],
    thresholds: Thresholds,
) -> bool:
    """Whether a body is borne by another one, in a contact, and goes along when that one moves.

    It is borne if it lies on it as the motion begins, or in it with its bottom below: what stands
    between the shaft of a rake and its teeth has none below. It goes along if it stays at its
    place on the bearer, in comparison with the bearer's own way, or in the bearer: a ball may
    roll about in a box.

    Args:
        load: The body.
        bearer: What may bear it.
        touching: Their contact, as a closed interval of frames.
        motions: When the bearer moves.
        thresholds: What is steep, and how far a load may shift.
    """
    for begin, end in motions:
        first, last = max(begin, touching[0]), min(end, touching[1])
        if first < last and _goes_along(load, bearer, (first, last), thresholds):
            return True
    return False


def _goes_along(
    load: BodyGeometry, bearer: BodyGeometry, span: Interval, thresholds: Thresholds
) -> bool:
    first, last = span
    part = slice(first, last + 1)
    offset = load.middles[part] - bearer.middles[part]
    own = np.swapaxes(bearer.turns_at(part), 1, 2) @ offset[..., None]
    if np.isnan(own).any():
        return False
    contained = [
        _contains(bearer, load, frame) and _bottom_below(bearer, load, frame) for frame in span
    ]
    if not contained[0]:
        normal = contact_normal(load, bearer, first, thresholds)
        if normal is None or normal[2] < thresholds.steep:
            return False
    if all(contained):
        return True
    stray = float(np.linalg.norm(own - own[0], axis=1).max())
    way = float(np.linalg.norm(bearer.middles[part] - bearer.middles[first], axis=1).max())
    return stray <= max(thresholds.motion_floor_m, thresholds.ride_share * way)


def _contains(bearer: BodyGeometry, load: BodyGeometry, frame: int) -> bool:
    """Whether the middle of a load is within the convex outline of its bearer, which is larger."""
    if bearer.planes is None or _size(load) >= _size(bearer):
        return False
    point = bearer.turn(frame).T @ (load.middles[frame] - bearer.middles[frame])
    return bool((bearer.planes[:, :3] @ point + bearer.planes[:, 3] <= 0.0).all())


def _bottom_below(bearer: BodyGeometry, load: BodyGeometry, frame: int) -> bool:
    """Whether the bearer's true surface is below the middle of a load, as a bottom is."""
    if bearer.shape is None:
        return False
    down = np.array([[0.0, 0.0, -1.0]]) @ bearer.turn(frame)
    centre = bearer.shape.bounds.mean(axis=0)
    point = (load.middles[frame] - bearer.middles[frame]) @ bearer.turn(frame) + centre
    places, _, _ = surface(bearer.shape).mesh.ray.intersects_location(point[None], down)
    return bool(len(places))


def _size(body: BodyGeometry) -> float:
    """The volume of the box around a body [m3]; 0 without a shape."""
    return float(np.prod(body.shape.size)) if body.shape else 0.0
