"""A fitted body among the bodies that are shown: its segments with the mannequin's surfaces."""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
import trimesh
from jaxtyping import Bool, Float
from scipy.spatial.transform import Rotation

from capar.body.body_shapes import forms
from capar.body.fitting import Fit
from capar.body.form_meshes import form_mesh, joined
from capar.body.segment_poses import poses_of
from capar.body.skeleton import skeleton
from capar.model.capture import Shape
from capar.views.viewer.stage import Stage, StagedBody, is_ground

SEEN_SHARE = 0.3
"""A body is not shown while a smaller share of what it follows is seen than this, against the most
that is seen at once [1]: its posture would be made up."""

GROUND = "assumed_ground"
MARGIN_M = 0.8
"""How far the assumed ground goes beyond where the body is [m]."""

THICK_M = 0.01
LOWEST_SHARE = 0.05
"""Share of the frames in which soles may be below the assumed ground [1]."""


def with_mannequin(shown: Stage, fit: Fit) -> Stage:
    """The same stage with a fitted body on it, at the frames of the fit nearest to those shown.

    Segments of which nothing was recorded are faint. Where the recording has no floor, a ground
    under the lowest soles is added and named as assumed.
    """
    nearest = np.abs(shown.times[:, None] - fit.times[None]).argmin(axis=1)
    poses = poses_of(fit.human, fit.motion[nearest])
    known = _known(fit)[nearest]
    parts: dict[str, list[trimesh.Trimesh]] = {}
    segments = skeleton(fit.human.measures)
    for form in forms(fit.human.measures, segments):
        parts.setdefault(form.body, []).append(form_mesh(form))
    bodies, unseen = [], set(fit.unrecorded)
    for number, name in enumerate(poses.names):
        if name in parts:
            mesh = joined(parts[name])
            shape = Shape(np.array(mesh.vertices), np.array(mesh.faces), description="mannequin")
            places = np.where(known[:, None], poses.positions[:, number], np.nan)
            at = places, poses.orientations[:, number]
            one = StagedBody(f"body_{name}", "body", shape, *at, faint=name in unseen)
            bodies.append(one)
    if not any(is_ground(body) for body in shown.bodies):
        bodies.append(_ground(bodies))
    return replace(shown, bodies=(*shown.bodies, *bodies))


def _known(fit: Fit) -> Bool[np.ndarray, "frames"]:
    """Whether enough of what the body follows is seen to show it."""
    if not fit.bridged:
        return np.ones(len(fit.times), dtype=bool)
    seen = np.sum([~lost for lost in fit.bridged.values()], axis=0)
    return np.asarray(seen > SEEN_SHARE * seen.max())


def _ground(bodies: Sequence[StagedBody]) -> StagedBody:
    """A level plate under the soles."""
    soles = [_lowest(body) for body in bodies if body.name.endswith("_foot")]
    top = float(np.nanquantile(np.min(soles, axis=0), LOWEST_SHARE))
    places = np.concatenate([body.positions[:, :2] for body in bodies])
    low, high = np.nanmin(places, axis=0) - MARGIN_M, np.nanmax(places, axis=0) + MARGIN_M
    mesh = trimesh.creation.box([*(high - low), THICK_M])
    shape = Shape(np.array(mesh.vertices), np.array(mesh.faces), description="assumed")
    frames = len(bodies[0].positions)
    middle = np.array([*(low + high) / 2.0, top - THICK_M / 2.0])
    turns = np.tile([1.0, 0.0, 0.0, 0.0], (frames, 1))
    return StagedBody(GROUND, "fixed", shape, np.tile(middle, (frames, 1)), turns, faint=True)


def _lowest(body: StagedBody) -> Float[np.ndarray, "frames"]:
    """Height of a body's lowest point at each frame [m]."""
    assert body.shape is not None
    turns = Rotation.from_quat(body.orientations, scalar_first=True).as_matrix()
    heights = turns[:, 2] @ np.array(body.shape.vertices).T
    return np.asarray(body.positions[:, 2] + heights.min(axis=1))
