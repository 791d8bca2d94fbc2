"""A fitted body among the bodies that are shown: its segments with the mannequin's surfaces."""

from dataclasses import replace

import numpy as np
import trimesh

from capar.body.body_shapes import forms
from capar.body.fitting import Fit
from capar.body.form_meshes import form_mesh, joined
from capar.body.segment_poses import poses_of
from capar.body.skeleton import skeleton
from capar.model.capture import Shape
from capar.views.viewer.stage import Stage, StagedBody


def with_mannequin(shown: Stage, fit: Fit) -> Stage:
    """The same stage with a fitted body on it, at the frames of the fit nearest to those shown."""
    nearest = np.abs(shown.times[:, None] - fit.times[None]).argmin(axis=1)
    poses = poses_of(fit.human, fit.motion[nearest])
    parts: dict[str, list[trimesh.Trimesh]] = {}
    segments = skeleton(fit.human.measures)
    for form in forms(fit.human.measures, segments):
        parts.setdefault(form.body, []).append(form_mesh(form))
    bodies = []
    for number, name in enumerate(poses.names):
        if name in parts:
            mesh = joined(parts[name])
            shape = Shape(np.array(mesh.vertices), np.array(mesh.faces), description="mannequin")
            at = poses.positions[:, number], poses.orientations[:, number]
            bodies.append(StagedBody(f"body_{name}", "body", shape, *at))
    return replace(shown, bodies=(*shown.bodies, *bodies))
