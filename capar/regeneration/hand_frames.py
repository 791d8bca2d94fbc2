"""A frame on any hand's surface: x to the fingers, z out of the palm, origin in the middle.

Hands of several sizes, and sensors strapped on askew, are compared in it.
"""

from dataclasses import dataclass

import numpy as np
import trimesh
from jaxtyping import Float
from scipy.spatial.transform import RigidTransform, Rotation

from capar.body.human import Human
from capar.body.recording import HAND_SEGMENTS
from capar.body.shapes import segment_surface
from capar.model.capture import Shape
from capar.regeneration.errors import PlanError

LEAST_SINE = 0.5
"""Of the angle between a palm's direction and its fingers' [1]."""


@dataclass(frozen=True, eq=False)
class HandFrame:
    """Where the frame is on a body, and how large the hand is in it."""

    pose: RigidTransform
    """``T_body_frame``: of the sensor of a capture, or of the hand's segment of a body."""

    extents: Float[np.ndarray, "3"]
    """Lengths of the hand along the frame's axes [m]."""


@dataclass(frozen=True, eq=False)
class HandAxes:
    """Which way a hand points and faces, as it is known of a recording's sensor."""

    fingers: Float[np.ndarray, "3"]
    """To where the straight fingers point, in the sensor's frame."""

    palm: Float[np.ndarray, "3"]
    """To where the palm faces, likewise."""


def stated_hand_frame(shape: Shape, axes: HandAxes) -> HandFrame:
    """The frame along axes that are known, whatever the shape of the half-bent hand is.

    Args:
        shape: The hand's surface.
        axes: Its directions; the palm's is kept where they are not at right angles.

    Raises:
        PlanError: The two are along one line.
    """
    z = axes.palm / np.linalg.norm(axes.palm)
    x = axes.fingers - (axes.fingers @ z) * z
    if np.linalg.norm(x) < LEAST_SINE * np.linalg.norm(axes.fingers):
        raise PlanError("a palm does not face along its own fingers")
    x = x / np.linalg.norm(x)
    hull = trimesh.convex.convex_hull(np.array(shape.vertices))
    turn = Rotation.from_matrix(np.stack([x, np.cross(z, x), z], axis=1))
    pose = RigidTransform.from_components(np.array(hull.center_mass), turn)
    return HandFrame(pose, np.ptp(pose.inv().apply(hull.vertices), axis=0))


def hand_frame(
    shape: Shape, fingers: Float[np.ndarray, "3"], palm: Float[np.ndarray, "3"]
) -> HandFrame:
    """The frame along the principal axes of a hand's hull.

    Args:
        shape: The hand's surface.
        fingers: Roughly to where the fingers point, in the shape's frame.
        palm: Roughly to where the palm faces, likewise.
    """
    hull = trimesh.convex.convex_hull(np.array(shape.vertices))
    axes = np.array(hull.principal_inertia_vectors)
    moments = np.array(hull.principal_inertia_components)
    x, z = axes[int(np.argmin(moments))], axes[int(np.argmax(moments))]
    x = x if x @ fingers >= 0.0 else -x
    z = z if z @ palm >= 0.0 else -z
    turn = Rotation.from_matrix(np.stack([x, np.cross(z, x), z], axis=1))
    pose = RigidTransform.from_components(np.array(hull.center_mass), turn)
    return HandFrame(pose, np.ptp(pose.inv().apply(hull.vertices), axis=0))


def body_hand_frame(human: Human, side: str) -> HandFrame:
    """The frame on a body's own hand, in the frame of the hand's segment."""
    site = human.model.site(f"{side}_palm")
    palm = Rotation.from_quat(site.quat, scalar_first=True)
    names = tuple(f"{side}_{each}" for each in HAND_SEGMENTS)
    surface = segment_surface(human.measures, names, f"{side}_hand")
    return hand_frame(surface, palm.apply([1.0, 0.0, 0.0]), palm.apply([0.0, 0.0, 1.0]))


def palm_of(human: Human, side: str, frame: HandFrame) -> RigidTransform:
    """``T_frame_palm``: the palm's site in the hand's frame."""
    site = human.model.site(f"{side}_palm")
    turn = Rotation.from_quat(site.quat, scalar_first=True)
    return frame.pose.inv() * RigidTransform.from_components(site.pos, turn)
