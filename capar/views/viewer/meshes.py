"""The surfaces of bodies as one binary glTF file, a node for each body, in its own frame."""

import numpy as np
import trimesh
from trimesh.exchange.gltf import export_glb

from capar.views.viewer.stage import Stage


def surfaces_glb(shown: Stage) -> bytes:
    """The surfaces [m], z up as in the world; a body without one has no node."""
    scene = trimesh.Scene()
    for body in shown.bodies:
        if body.shape is not None:
            mesh = trimesh.Trimesh(
                np.array(body.shape.vertices), np.array(body.shape.faces), process=False
            )
            scene.add_geometry(mesh, node_name=body.name, geom_name=body.name)
    if not scene.geometry:
        scene.add_geometry(_nothing(), node_name="nothing", geom_name="nothing")
    return bytes(export_glb(scene))  # type: ignore[no-untyped-call]


def _nothing() -> trimesh.Trimesh:
    """A file without a surface would be none: this one is too small to be seen."""
    corners = np.array([[0.0, 0.0, 0.0], [1e-9, 0.0, 0.0], [0.0, 1e-9, 0.0]])
    return trimesh.Trimesh(corners, np.array([[0, 1, 2]]), process=False)
