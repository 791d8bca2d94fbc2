"""Room in bodies: in which of those that something moves to and fro at nothing can be."""

from collections.abc import Iterable, Iterator, Mapping
from typing import cast

import numpy as np
import trimesh
from jaxtyping import Float
from scipy.spatial import ConvexHull, QhullError, cKDTree

from capar.model.capture import Shape
from capar.model.facts import Fact, Shapeless, Solid, Swings, Touching
from extractors.bodies.body_geometry import BodyGeometry
from extractors.thresholds import Thresholds

RESOLUTION = 40
"""Into how many edges the longest side of a body is divided, to sample its surface [1]."""


def rooms(
    things: Mapping[str, BodyGeometry],
    touches: Iterable[Touching],
    known: Iterable[Fact],
    thresholds: Thresholds,
) -> Iterator[Fact]:
    """Where nothing fits in, and where that is not known.

    Args:
        things: Bodies of all tag objects, by their names.
        touches: What touches what.
        known: Facts that say what moves to and fro; that, and what it touches, is asked about.
        thresholds: How deep a hollow holds something.
    """
    swung = {each.body for each in known if isinstance(each, Swings)}
    met = {each.other for each in touches if each.body in swung}
    for name in sorted((swung | met) & set(things)):
        shape = things[name].shape
        if shape is None:
            yield Shapeless(name)
        elif pocket_m(shape) <= thresholds.pocket_share * shape.size.max():
            yield Solid(name)


def pocket_m(shape: Shape) -> float:
    """The largest distance of a body's convex hull from its own surface [m].

    Of a bowl it is how far the middle of its opening is from its wall or bottom; of a box or a loaf
    nearly zero. It is known to a fortieth of the body's size. Zero for what has no volume.
    """
    vertices = np.asarray(shape.vertices)
    try:
        hull = ConvexHull(vertices).simplices
    except (QhullError, ValueError):
        return 0.0
    edge_m = float(np.max(shape.size)) / RESOLUTION
    own = _sampled(vertices, np.asarray(shape.faces), edge_m)
    around = _sampled(vertices, hull, edge_m)
    return float(cKDTree(own).query(around)[0].max())


def _sampled(
    vertices: Float[np.ndarray, "vertices 3"], faces: np.ndarray, edge_m: float
) -> Float[np.ndarray, "points 3"]:
    """Points of a surface, no further apart than an edge; what no face uses is left out."""
    mesh = trimesh.Trimesh(vertices, faces, process=False)
    fine = cast(trimesh.Trimesh, mesh.subdivide_to_size(edge_m, max_iter=20))
    return np.asarray(fine.vertices)[np.unique(fine.faces)]
