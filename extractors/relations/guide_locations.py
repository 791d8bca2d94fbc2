"""Where on an object, and on the fixed one beside it, its hinge or its rail is (thesis 4.4.2.2)."""

import numpy as np
from jaxtyping import Float
from scipy.spatial.transform import Rotation

from capar.model import geometry
from capar.model.locations import GuideLocation, Nlt, local_point, normalised, relative_orientation
from extractors.bodies.body_geometry import BodyGeometry
from extractors.motion.guide_fitting import HINGE
from extractors.relations.guides import Guide

ALONG = np.array([1.0, 0.0, 0.0])
"""The constraint's own axis that is the line of the guide."""


def guide_location(body: BodyGeometry, base: BodyGeometry, guide: Guide) -> GuideLocation:
    """The line of a body's hinge or rail as places on the body and on its base.

    The place on a hinge is the one beside the middle of the body; on a rail it is that middle,
    where the body is closed.

    Args:
        body: The body that moves.
        base: The fixed one.
        guide: The hinge or rail.
    """
    fit, frame = guide.fit, guide.closed
    opens = 1.0 if fit.course[guide.opened] > fit.course[frame] else -1.0
    point = fit.point if fit.kind == HINGE else body.middles[frame]
    turn = geometry.quaternions(_turn_to(opens * fit.axis))
    return GuideLocation(
        object=body.name,
        base=base.name,
        kind=fit.kind,
        object_nlt=_nlt(body, frame, point, turn),
        base_nlt=_nlt(base, frame, point, turn),
        opened=float(np.nanmax(guide.opening)),
        residual_m=fit.residual_m,
    )


def _turn_to(axis: Float[np.ndarray, "3"]) -> Rotation:
    """The shortest turn that takes the constraint's axis to one of the world; half about z."""
    about = np.cross(ALONG, axis)
    sine, cosine = float(np.linalg.norm(about)), float(axis @ ALONG)
    unit = about / sine if sine > 0.0 else np.array([0.0, 0.0, 1.0])
    return Rotation.from_rotvec(np.arctan2(sine, cosine) * unit)


def _nlt(
    body: BodyGeometry, frame: int, point: Float[np.ndarray, "3"], turn: Float[np.ndarray, "4"]
) -> Nlt:
    stream = body.poses.settled if body.poses.rests else body.poses.smooth
    size = np.zeros(3) if body.shape is None else body.shape.size
    local = local_point(stream.positions[frame], stream.orientations[frame], point)
    return normalised(local, relative_orientation(stream.orientations[frame], turn), size)
