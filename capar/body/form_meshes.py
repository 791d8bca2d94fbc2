"""Surfaces of the mannequin's primitives."""

import numpy as np
import trimesh
from scipy.spatial.transform import Rotation

from capar.body.body_shapes import Form


def form_mesh(form: Form) -> trimesh.Trimesh:
    """A primitive's surface in its segment's frame [m]."""
    if form.kind == "box":
        mesh: trimesh.Trimesh = trimesh.creation.box(extents=2.0 * form.half)
    elif form.kind == "ellipsoid":
        mesh = trimesh.creation.icosphere(subdivisions=2, radius=1.0)
        mesh.vertices = np.array(mesh.vertices) * form.half
    else:
        radius, half = form.half[:2]
        mesh = trimesh.creation.capsule(height=2.0 * half, radius=radius, count=[16, 12])
        mesh.apply_translation(-mesh.bounds.mean(axis=0))
        turn, _ = Rotation.align_vectors([form.axis / np.linalg.norm(form.axis)], [[0.0, 0.0, 1.0]])
        mesh.vertices = turn.apply(np.array(mesh.vertices))
    mesh.apply_translation(form.centre)
    return mesh


def joined(group: list[trimesh.Trimesh]) -> trimesh.Trimesh:
    """Several surfaces as one."""
    starts = np.cumsum([0, *(len(mesh.vertices) for mesh in group)])
    faces = [np.array(each.faces) + start for each, start in zip(group, starts, strict=False)]
    vertices = np.concatenate([np.array(mesh.vertices) for mesh in group])
    return trimesh.Trimesh(vertices, np.concatenate(faces), process=False)
