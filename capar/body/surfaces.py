"""Surfaces of segments of the standing body."""

import numpy as np

from capar.body.anthropometry import Measures
from capar.body.body_shapes import forms
from capar.body.form_meshes import form_mesh
from capar.body.skeleton import skeleton
from capar.model.capture import Shape


def segment_surface(measures: Measures, segments: tuple[str, ...], frame: str) -> Shape:
    """The surface of some segments of the standing body, in the frame of one of them."""
    bones = skeleton(measures)
    parts = []
    for form in forms(measures, bones):
        if form.body in segments:
            mesh = form_mesh(form)
            mesh.apply_translation(bones[form.body].origin - bones[frame].origin)
            parts.append(mesh)
    mesh = sum(parts[1:], parts[0])
    return Shape(np.array(mesh.vertices), np.array(mesh.faces), description=" and ".join(segments))
