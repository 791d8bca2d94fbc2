"""From joints and key points to the body's motion, heads and toes where the file has them."""

from capar.body.flat_feet import standing_flat
from capar.body.human import Human
from capar.body.marker_fitting import (
    file_convention,
    local_places,
    sample_frames,
    with_markers,
)
from capar.body.point_following import Guidance
from capar.body.skeleton_fitting import SkeletonFit, fit_skeleton, measures_from_points, with_ankles
from extractors.readers.body_names.body_names import BodyName, without_side
from extractors.readers.body_names.conventions import Convention
from extractors.readers.drafting.stance import Points

LIMB_JOINTS = {"upper_arm", "forearm", "hand", "thigh", "shank", "foot"}
"""Joints that are at the same place in every skeleton."""


def fit_joints(
    points: Points, convention: Convention, *, ground_m: float | None = None
) -> SkeletonFit:
    """Fit the body to joints or key points in a world whose z axis points up.

    Where skeletons have their toes, necks and heads differs. They begin where the body has its
    own; then each is where it is on its segment in the median of the fitted postures, in which
    feet that stand are flat.

    Args:
        points: By foreign name [m]; NaN where lost.
        convention: What the names mean.
        ground_m: Height of the ground on which feet stand, where it is known [m].

    Raises:
        SkeletonError: Fewer than four places are known, or the points are of no body.
    """
    places = convention.named(points)
    known = Guidance(standing_flat(points, places), ground_m)
    measures = with_ankles(measures_from_points(points, convention), points, places, known)
    names = {n: BodyName(n, place, exact=True, by=convention.title) for n, place in places.items()}
    frames = sample_frames(points, names)
    sampled = {name: points[name][frames] for name in places}
    first = fit_skeleton(sampled, convention, human=Human.of(measures), guidance=known.at(frames))
    own = {n: each for n, each in names.items() if without_side(each.place) not in LIMB_JOINTS}
    local = local_places(first, sampled, own)
    found = dict(places) | {name: f"marker_{name}" for name in local}
    weights = {found[name]: convention.weight(place) for name, place in places.items()}
    return fit_skeleton(
        points,
        file_convention(found, weights),
        human=with_markers(measures, local, own),
        guidance=known,
    )
