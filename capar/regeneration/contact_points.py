"""Where two surfaces touch: the middle of the patch in which they are nearest."""

import numpy as np
import trimesh
from jaxtyping import Float
from scipy.spatial import KDTree
from scipy.spatial.transform import RigidTransform

from capar.model.capture import Shape

SAMPLES = 5000
"""Points on each surface."""

PATCH_M = 0.0015
"""Points that are further apart than the nearest by no more than this are in the patch [m]."""


def contact_points(
    first: Shape, second: Shape, relative: RigidTransform
) -> tuple[Float[np.ndarray, "3"], Float[np.ndarray, "3"]]:
    """The middle of the contact on each of two shapes, in each one's own frame [m].

    Args:
        first: The one.
        second: The other.
        relative: ``T_first_second``.
    """
    one, two = _points(first), _points(second)
    gaps, nearest = KDTree(one).query(relative.apply(two))
    patch = gaps < gaps.min() + PATCH_M
    return one[nearest[patch]].mean(axis=0), two[patch].mean(axis=0)


def surface_samples(
    shape: Shape,
) -> tuple[Float[np.ndarray, "points 3"], Float[np.ndarray, "points 3"]]:
    """Points on a surface and its normals there, outwards, in the shape's frame [m, 1]."""
    mesh = trimesh.Trimesh(np.array(shape.vertices), np.array(shape.faces), process=False)
    points, faces = trimesh.sample.sample_surface(mesh, SAMPLES, seed=0)
    outwards = 1.0 if mesh.volume >= 0.0 else -1.0
    return np.array(points), outwards * np.array(mesh.face_normals[faces])


def _points(shape: Shape) -> Float[np.ndarray, "points 3"]:
    mesh = trimesh.Trimesh(np.array(shape.vertices), np.array(shape.faces), process=False)
    points, _ = trimesh.sample.sample_surface(mesh, SAMPLES, seed=0)
    return np.concatenate([np.array(shape.vertices), np.array(points)])
