"""From another skeleton's joints or key points to the body's motion."""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from capar.body.anthropometry import Measures, MeasuresError, estimate_measures
from capar.body.human import Human
from capar.body.point_following import Guidance, SkeletonError, followed, segment_of
from capar.body.skeleton import HIP_OF_SPINES, SHOULDER_BREADTH
from extractors.readers.body_names.body_names import SIDES
from extractors.readers.body_names.conventions import Convention

LENGTHS = {
    "upper_arm": ("upper_arm", "forearm"),
    "forearm": ("forearm", "hand"),
    "thigh": ("thigh", "shank"),
    "shank": ("shank", "foot"),
}
"""The two joints, of either side, that a limb's length lies between."""

BREADTHS = {
    "shoulder_breadth": ("upper_arm", SHOULDER_BREADTH),
    "spine_breadth": ("thigh", 2 * HIP_OF_SPINES),
}
"""The paired joint, and the share of the measure that lies between its two sides."""

TRUNK = ("thigh", "upper_arm")
"""Paired joints at the lower and upper end of the trunk; skin moves too much over bones there."""

TRUNK_OF_LANDMARKS = ("asis", "acromion")
"""Paired landmarks there, for who has no other measure of the trunk."""

TRUNK_TRUST = 0.5
"""Weight of a trunk's length as it is seen against that by stature [1]: shoulders rise and fall by
as much as trunks of one stature differ."""

TRUNK_HEIGHTS = ("acromial_height", "suprasternale_height", "cervicale_height")
UPPER_HEIGHTS = ("eye_height", "stature")
ANKLE_SHARE = (0.6, 1.7)
"""Ankles are taken to be as high as they are seen if that is between these shares of the usual
height [1]: soles of shoes raise them, and skeletons have them somewhere between heel and shank."""


@dataclass(frozen=True, eq=False)
class SkeletonFit:
    """A body's motion that follows another skeleton's points."""

    human: Human
    motion: Float[np.ndarray, "frames posture"]
    residuals_m: Mapping[str, Float[np.ndarray, "frames"]]
    """By foreign name, distance of the body's place from the point [m]; NaN if lost."""

    segments: Mapping[str, str]
    """By foreign name, the segment that its place is on."""

    derived: bool
    """Whether orientations of segments come of points only, so that turns about the long axes of
    hands, head and feet are assumed and not seen; always so today: given ones are not used yet."""

    @property
    def median_m(self) -> float:
        """Median of all residuals [m]."""
        return float(np.nanmedian(np.concatenate(list(self.residuals_m.values()))))


def measures_from_points(
    points: Mapping[str, Float[np.ndarray, "frames 3"]],
    convention: Convention,
    *,
    sex: str = "male",
    age: float = 30.0,
) -> Measures:
    """Measures that a skeleton's own bones have, the stature from the sum of its limbs.

    Raises:
        SkeletonError: None of the limbs has both its joints.
    """
    places = {place: points[name] for name, place in convention.named(points).items()}
    found = {}
    for measure, (first, second) in LENGTHS.items():
        ends = [(f"{side}_{first}", f"{side}_{second}") for side in SIDES]
        spans = [_apart(places[a], places[b]) for a, b in ends if a in places and b in places]
        if spans:
            found[measure] = float(np.mean(spans))
    for measure, (joint, share) in BREADTHS.items():
        if f"right_{joint}" in places and f"left_{joint}" in places:
            found[measure] = _apart(places[f"right_{joint}"], places[f"left_{joint}"]) / share
    limbs = [name for name in LENGTHS if name in found]
    if not limbs:
        raise SkeletonError(f"no limb has both its joints among {sorted(points)}")
    usual = estimate_measures(sex=sex, age=age)
    scale = sum(found[name] for name in limbs) / sum(usual[name] for name in limbs)
    given = {"stature": scale * usual["stature"], **found}
    made = estimate_measures(sex=sex, age=age, given=given)
    trunk = trunk_share(places, Human.of(made))
    return made if trunk is None else with_trunk(made, trunk)


def trunk_share(
    places: Mapping[str, Float[np.ndarray, "frames 3"]],
    body: Human,
    ends: tuple[str, str] = TRUNK,
) -> float | None:
    """Likely length of somebody's trunk as a share of a body's [1]; None where it is not seen.

    Args:
        places: Joints and landmarks by the body's own names for them.
        body: Of the same stature.
        ends: Which places, paired, are at the lower and upper end of the trunk.
    """
    names = [f"{side}_{end}" for end in ends for side in SIDES]
    if not all(name in places for name in names):
        return None
    own = body.sites(body.posture()[None], names)
    seen, usual = (
        _apart((a + b) / 2, (c + d) / 2)
        for a, b, c, d in ([places[name] for name in names], [own[name][0] for name in names])
    )
    return None if np.isnan(seen) else 1.0 + TRUNK_TRUST * (seen / usual - 1.0)


def with_trunk(measures: Measures, share: float) -> Measures:
    """The same body with a trunk longer by a factor; the same if no body has such a trunk.

    Legs, arms and the head keep their sizes, so that the stature changes by as much as the trunk.
    """
    hip = measures.hip_height
    heights = {name: hip + share * (measures[name] - hip) for name in TRUNK_HEIGHTS}
    longer = heights["cervicale_height"] - measures["cervicale_height"]
    heights |= {name: measures[name] + longer for name in UPPER_HEIGHTS}
    given = {name: measures[name] for name in measures.given} | heights
    try:
        return estimate_measures(sex=measures.sex, age=measures.age, given=given)
    except MeasuresError:
        return measures


def with_head(measures: Measures, higher_m: float) -> Measures:
    """The same body with a neck longer by so much [m]; the same if no body has such a neck."""
    raised = {name: measures[name] + higher_m for name in UPPER_HEIGHTS}
    given = {name: measures[name] for name in measures.given} | raised
    try:
        return estimate_measures(sex=measures.sex, age=measures.age, given=given)
    except MeasuresError:
        return measures


def with_ankles(
    measures: Measures,
    points: Mapping[str, Float[np.ndarray, "frames 3"]],
    places: Mapping[str, str],
    guidance: Guidance,
) -> Measures:
    """The same body with its ankles as high above the ground as they are while its feet are flat.

    All above the ankles moves up or down by as much; the same if no body has such feet.
    """
    heights = [
        float(np.nanmedian(points[name][flat, 2])) - guidance.ground_m
        for name, place in places.items()
        for side, flat in guidance.flat.items()
        if guidance.ground_m is not None
        and place in {f"{side}_foot", f"{side}_ankle_lateral"}
        and np.isfinite(points[name][flat, 2]).any()
    ]
    usual = measures["ankle_height"]
    if not heights or not ANKLE_SHARE[0] < np.mean(heights) / usual < ANKLE_SHARE[1]:
        return measures
    higher = float(np.mean(heights)) - usual
    raised = {name: measures[name] + higher for name in (*TRUNK_HEIGHTS, *UPPER_HEIGHTS)}
    given = {name: measures[name] for name in measures.given} | raised
    given["ankle_height"] = usual + higher
    try:
        return estimate_measures(sex=measures.sex, age=measures.age, given=given)
    except MeasuresError:
        return measures


def with_legs(measures: Measures, lengths: Mapping[str, float]) -> Measures:
    """The same body with other thighs or shanks; all above the hips moves up or down with them.

    Args:
        measures: The body's.
        lengths: Of thigh, shank or both [m].

    Returns:
        The same measures if no body has such legs.
    """
    higher = sum(length - measures[name] for name, length in lengths.items())
    raised = {name: measures[name] + higher for name in (*TRUNK_HEIGHTS, *UPPER_HEIGHTS)}
    given = {name: measures[name] for name in measures.given} | raised | dict(lengths)
    try:
        return estimate_measures(sex=measures.sex, age=measures.age, given=given)
    except MeasuresError:
        return measures


def _apart(first: np.ndarray, second: np.ndarray) -> float:
    """Median distance of two points [m]."""
    return float(np.nanmedian(np.linalg.norm(first - second, axis=1)))


def fit_skeleton(
    points: Mapping[str, Float[np.ndarray, "frames 3"]],
    convention: Convention,
    *,
    human: Human | None = None,
    guidance: Guidance | None = None,
) -> SkeletonFit:
    """Fit the body to joints or key points in a world whose z axis points up.

    Args:
        points: By foreign name [m]; NaN where lost. Names that the convention lacks are ignored.
        convention: What the names mean.
        human: The body; made from the skeleton's own bones where None.
        guidance: What else is known of the motion.

    Raises:
        SkeletonError: Fewer than four places are known, or the points are of no body.
    """
    named = convention.named(points)
    if len(named) < 4:
        raise SkeletonError(f"{len(named)} places of {convention.title}; four or more are needed")
    body = human or Human.of(measures_from_points(points, convention))
    spots = {name: np.asarray(points[name]) for name in named}
    motion = followed(body, spots, named, convention, guidance or Guidance())
    where = body.sites(motion, set(named.values()))
    residuals = {
        name: np.linalg.norm(where[place][0] - spots[name], axis=1) for name, place in named.items()
    }
    segments = {name: segment_of(body, place) for name, place in named.items()}
    return SkeletonFit(body, motion, residuals, segments, derived=True)
