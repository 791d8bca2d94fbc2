"""The direction in which two bodies press on each other where they touch."""

from collections import OrderedDict
from itertools import product
from typing import TypeAlias
from weakref import WeakKeyDictionary

import numpy as np
from jaxtyping import Float

from extractors.bodies.body_geometry import BodyGeometry
from extractors.contact.patches import Box, facing_normal, meeting_box
from extractors.contact.surfaces import Surface, surface
from extractors.thresholds import Thresholds

SLACK_M = 1e-6
"""By so much the box is larger in which triangles are sought, since turning it rounds [m]."""

_Normals: TypeAlias = dict[tuple[int, float], Float[np.ndarray, "3"] | None]
_KEPT: WeakKeyDictionary[BodyGeometry, WeakKeyDictionary[BodyGeometry, _Normals]] = (
    WeakKeyDictionary()
)


_Poses: TypeAlias = tuple[bytes, bytes, bytes, bytes, float]
_LATEST: OrderedDict[_Poses, Float[np.ndarray, "3"] | None] = OrderedDict()
"""Normals of the patches that were sought last, by shapes and poses: windows of a recording begin
at the same frames again and again."""

_MOST_LATEST = 512


def contact_normal(
    body: BodyGeometry, other: BodyGeometry, frame: int, thresholds: Thresholds
) -> Float[np.ndarray, "3"] | None:
    """The unit normal of a contact, from the other to the body, in the world; None if unknown.

    Contacts and seats ask for the same ones, either way about, so those of patches are kept as
    long as both bodies are: the other way about a normal is the opposite one, to the last digit.

    It is the mean normal of the patch where the true surfaces meet: what stands in a bowl lies on
    the bowl's bottom, however high the bowl's rim. Where either body has no shape, or the patch
    has no direction, it is the axis along which their outlines are furthest apart.
    """
    if np.isnan(body.middles[frame] - other.middles[frame]).any():
        return None
    found = _kept_normal(body, other, frame, thresholds.patch_m)
    return _between_outlines(body, other, frame) if found is None else found


def _kept_normal(
    body: BodyGeometry, other: BodyGeometry, frame: int, depth_m: float
) -> Float[np.ndarray, "3"] | None:
    key = frame, depth_m
    turned = _kept(other, body)
    if key in turned:
        opposite = turned[key]
        return None if opposite is None else -opposite
    kept = _kept(body, other)
    if key not in kept:
        kept[key] = _patch_normal(body, other, frame, depth_m)
    return kept[key]


def _kept(body: BodyGeometry, other: BodyGeometry) -> _Normals:
    return _KEPT.setdefault(body, WeakKeyDictionary()).setdefault(other, {})


def _patch_normal(
    body: BodyGeometry, other: BodyGeometry, frame: int, depth_m: float
) -> Float[np.ndarray, "3"] | None:
    """The mean normal of the patch where two surfaces meet; None where either has no shape."""
    if body.shape is None or other.shape is None:
        return None
    key = body.shape.digest, _pose(body, frame), other.shape.digest, _pose(other, frame), depth_m
    found = _LATEST.pop(key) if key in _LATEST else _sought_normal(body, other, frame, depth_m)
    _LATEST[key] = found
    while len(_LATEST) > _MOST_LATEST:
        _LATEST.popitem(last=False)
    return found


def _pose(body: BodyGeometry, frame: int) -> bytes:
    return body.middles[frame].tobytes() + body.orientations[frame].tobytes()


def _sought_normal(
    body: BodyGeometry, other: BodyGeometry, frame: int, depth_m: float
) -> Float[np.ndarray, "3"] | None:
    assert body.shape is not None
    assert other.shape is not None
    one, two = surface(body.shape), surface(other.shape)
    corners = _placed(one.corners, body, frame), _placed(two.corners, other, frame)
    box = meeting_box(*corners, depth_m=depth_m)
    return facing_normal(
        _triangles(one, body, frame, box),
        _triangles(two, other, frame, box),
        depth_m=depth_m,
        solid=(one.closed, two.closed),
        box=box,
    )


def _triangles(
    of: Surface, body: BodyGeometry, frame: int, box: Box
) -> Float[np.ndarray, "triangles 3 3"]:
    """The triangles that may reach into a box, in the world at a frame [m], facing outward."""
    ends = np.array(list(product(*box.T))) - body.middles[frame]
    local = ends @ body.turn(frame) + of.centre
    low, high = of.triangle_boxes
    near = (low <= local.max(axis=0) + SLACK_M) & (high >= local.min(axis=0) - SLACK_M)
    some = of.triangles[near.all(axis=1)] - of.centre
    return _placed(some[:, ::-1] if of.inverted else some, body, frame)


def _placed(
    points: Float[np.ndarray, "*some 3"], body: BodyGeometry, frame: int
) -> Float[np.ndarray, "*some 3"]:
    """Points from the middle of a body [m] where they are in the world at a frame [m]."""
    return np.asarray(points @ body.turn(frame).T + body.middles[frame])


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
