"""Where triangles cut each other."""

import numpy as np
from jaxtyping import Float

_NEXT, _LAST = np.array([1, 2, 0]), np.array([2, 0, 1])


def meeting_points(
    first: Float[np.ndarray, "pairs 3 3"], second: Float[np.ndarray, "pairs 3 3"]
) -> Float[np.ndarray, "pairs 3"]:
    """A point on both triangles of each pair; NaN where they do not cut each other.

    It is the middle of the places at which an edge of one goes through the other, which lies on
    the line that the two share. Triangles in one plane count as not cutting.
    """
    edges = np.stack([first, second], axis=1)
    others = np.stack([second, first], axis=1)
    way = edges[:, :, _NEXT] - edges
    base = others[:, :, :1]
    one, two = others[:, :, 1:2] - base, others[:, :, 2:] - base
    normal = _cross(one, two)
    offset = edges - base
    with np.errstate(divide="ignore", invalid="ignore"):
        slope = np.einsum("...i,...i", way, normal)
        share = -np.einsum("...i,...i", offset, normal) / slope
        point = offset + share[..., None] * way
        area = np.einsum("...i,...i", normal, normal)
        u = np.einsum("...i,...i", _cross(point, two), normal) / area
        v = np.einsum("...i,...i", _cross(one, point), normal) / area
        hit = (share >= 0.0) & (share <= 1.0) & (u >= 0.0) & (v >= 0.0) & (u + v <= 1.0)
        places = np.where(hit[..., None], point + base, 0.0)
        return places.sum(axis=(1, 2)) / hit.sum(axis=(1, 2))[:, None]


def _cross(
    one: Float[np.ndarray, "*some 3"], two: Float[np.ndarray, "*others 3"]
) -> Float[np.ndarray, "*broadcast 3"]:
    """The cross product; for few vectors, which come by the thousand, faster than the library's."""
    return one[..., _NEXT] * two[..., _LAST] - one[..., _LAST] * two[..., _NEXT]
