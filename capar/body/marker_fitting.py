"""From markers on the skin to the body's motion: size, places of the markers, then postures."""

from collections import Counter
from collections.abc import Iterable, Mapping, Sequence
from contextlib import suppress
from dataclasses import replace

import numpy as np
from jaxtyping import Bool, Float
from scipy.spatial.transform import RigidTransform, Rotation

from capar.body.anthropometry import Measures, MeasuresError, estimate_measures
from capar.body.human import Human, body_spec
from capar.body.inverse_kinematics import standing_flat
from capar.body.point_fitting import (
    TRUNK_OF_LANDMARKS,
    Guidance,
    PointFit,
    SkeletonError,
    fit_points,
    is_sided,
    local_places,
    measures_from_points,
    sample_frames,
    segment_of,
    trunk_share,
    with_ankles,
    with_legs,
    with_markers,
    with_trunk,
)
from capar.body.skeleton import skeleton
from extractors.readers.drafting.contents import Points, mean_of, standing_by_parts
from extractors.readers.names import SIDES, BodyName

#: Markers at known places that place a body at least, those on a segment that tell where its middle
#: is, and those that tell how it is placed and turned
LEAST_EXACT, LEAST_CLUSTER, LEAST_MARKERS = 6, 2, 3
#: Frames in which markers on both sides of a joint are seen at least; and the weight of a first
#: fit's centre against one frame's motion [1]: skin moves by half a centimetre or so, while first
#: fits miss joints by about five
LEAST_FRAMES, TRUST = 10, 0.1
ROUNDS = 2  # times that the places of markers are found anew from postures, and postures from them

#: Weights of the middle of a segment by the markers on it, and of markers whose places are found
#: from the motion itself [1]; so many of these on a segment weigh as much as more of them together:
#: a shoulder blade with a dozen markers would else bend the chest that it glides on
MIDDLE_WEIGHT, CLUSTER_WEIGHT, LARGE_CLUSTER = 0.2, 0.7, 4
#: How much more than usual the standing posture counts until markers of unknown places have found
#: theirs [1]: which way a segment is turned only they tell
CLUSTER_EASE = 20.0
#: Pairs of places, of one side, between which a measure lies; the first that is there counts
SPANS: Mapping[str, tuple[tuple[str, str], ...]] = {
    "upper_arm": (("upper_arm", "forearm"), ("acromion", "elbow_lateral")),
    "forearm": (("forearm", "hand"), ("elbow_lateral", "wrist_radial")),
    "thigh": (("thigh", "shank"), ("trochanter", "knee_lateral")),
    "shank": (("shank", "foot"), ("knee_lateral", "ankle_lateral")),
    "foot_length": (("heel", "toe_tip"),),
    "foot_breadth": (("first_metatarsal", "fifth_metatarsal"),),
}
#: Places whose distance between the sides goes with a measure
BREADTHS: Mapping[str, tuple[str, ...]] = {
    "shoulder_breadth": ("upper_arm", "acromion"),
    "spine_breadth": ("thigh", "asis"),
}
#: Segments of limbs with the one that they hang on; that of an arm is the chest
PARENTS = {
    f"{side}_{child}": parent if parent in ("pelvis", "thorax_upper") else f"{side}_{parent}"
    for side in SIDES
    for child, parent in (
        ("shank", "thigh"), ("foot", "shank"), ("forearm", "upper_arm"), ("thigh", "pelvis"),
        ("upper_arm", "thorax_upper"),
    )
}  # fmt: skip
#: Segments of legs, whose measures have their names, each with the one that hangs on it
LEGS = {"thigh": "shank", "shank": "foot"}
#: A measure is taken from markers if it is between these shares of the estimated one [1]
USUAL_SHARE = (0.8, 1.25)


def fit_markers(
    points: Points, names: Mapping[str, BodyName], *, ground_m: float | None = None
) -> PointFit:
    """Fit the body to markers [m] in a world whose z axis points up; NaN where lost.

    The size comes from distances of landmarks and from the stature that all heights show. Markers
    begin where landmarks usually are; then each is where it is on its segment in the median. Each
    has a site ``marker_<name>``. Feet stand on a ground of known height [m].

    Raises:
        SkeletonError: Too few markers are at known places, or none three of them at once.
    """
    seen = {n: each for n, each in names.items() if n in points and not np.isnan(points[n]).all()}
    exact = {name: each for name, each in seen.items() if each.exact and is_sided(each)}
    riding = [each.place for each in seen.values() if is_sided(each) and not each.exact]
    clusters = {
        segment: [n for n, e in seen.items() if is_sided(e) and not e.exact and e.place == segment]
        for segment, count in Counter(riding).items()
        if count >= LEAST_CLUSTER
    }
    if len(exact) + len(clusters) < LEAST_EXACT:
        raise SkeletonError(
            f"{len(exact)} markers at known places of the body ({', '.join(sorted(exact))}) and "
            f"{len(clusters)} segments with clusters of them; {LEAST_EXACT} or more place it"
        )
    measures = measures_from_markers(points, exact, seen)
    frames = sample_frames(points, seen)
    sampled = {name: points[name][frames] for name in seen}
    places = {name: each.place for name, each in seen.items()}
    known = Guidance(standing_flat(points, places), ground_m)
    measures = with_ankles(measures, points, places, known)
    ease = 1.0 if len(exact) >= LEAST_EXACT else CLUSTER_EASE
    eased = replace(known.at(frames), ease=ease)
    first = _by_landmarks(measures, sampled, exact, clusters, eased)
    legs = [measure for measure in LEGS if ease == 1.0 and measure not in measures.given]
    for _ in range(ROUNDS if legs else 0):
        lengths = _leg_lengths(_joints(first, sampled, seen), measures, legs)
        if lengths:  # of the trunk the stature then tells no more
            measures = with_legs(measures, lengths)
            landmarks = {exact[name].place: sampled[name] for name in exact}
            share = trunk_share(landmarks, Human.of(measures), TRUNK_OF_LANDMARKS)
            measures = measures if share is None else with_trunk(measures, share)
            first = _by_landmarks(measures, sampled, exact, clusters, eased)
    local = local_places(first, sampled, seen)
    joints = {} if ease == 1.0 else _joints(first, sampled, seen)
    if len(joints) >= LEAST_EXACT:
        own, local = {name: name for name in joints}, {}
        with suppress(SkeletonError):
            measures = measures_from_points(joints, own)
            measures = with_ankles(measures, joints, own, known.at(frames))
    else:
        joints = {}
    for _ in range(ROUNDS):
        again = _on_sites(measures, {**sampled, **joints}, local, seen, joints, known.at(frames))
        local = local_places(again, sampled, seen)
    return _on_sites(measures, {name: points[name] for name in local}, local, seen, (), known)


def _on_sites(
    measures: Measures,
    points: Points,
    local: Mapping[str, Float[np.ndarray, "3"]],
    names: Mapping[str, BodyName],
    joints: Iterable[str],
    guidance: Guidance,
) -> PointFit:
    """Every marker at the site that was made for it, and joints at the origins of segments."""
    riding = [name for name in local if not names[name].exact]
    count = Counter(names[name].place for name in riding)
    weights = {
        f"marker_{n}": CLUSTER_WEIGHT * min(1.0, (LARGE_CLUSTER / count[names[n].place]) ** 0.5)
        for n in riding
    }
    places = {name: f"marker_{name}" for name in local} | {name: name for name in joints}
    human = with_markers(measures, local, names)
    return fit_points(human, points, places, weights, guidance)


def _joints(
    made: PointFit, points: Points, names: Mapping[str, BodyName]
) -> dict[str, Float[np.ndarray, "frames 3"]]:
    """Centres of joints between segments with three markers or more, by the segment below [m]."""
    riding: dict[str, list[np.ndarray]] = {}
    for name, each in names.items():
        if is_sided(each):
            riding.setdefault(segment_of(made.human, each.place), []).append(points[name])
    clusters = {segment: found for segment, group in riding.items() if (found := cluster_of(group))}
    where = made.human.sites(made.motion, PARENTS)
    out = {}
    for segment, own in clusters.items():
        if PARENTS.get(segment) in clusters:
            centre = joint_centre(clusters[PARENTS[segment]], own, where[segment][0])
            if centre is not None:
                out[segment] = centre
    return out


#: Markers on one segment as a rigid body: frames in which all are seen, and its poses in these
Cluster = tuple[Bool[np.ndarray, "frames"], RigidTransform]


def cluster_of(points: Sequence[Float[np.ndarray, "frames 3"]]) -> Cluster | None:
    """Markers on one segment [m] as a rigid body; None if too few, or never seen at once."""
    if len(points) < LEAST_MARKERS:
        return None
    stack = np.stack(points, axis=1)
    seen = np.isfinite(stack).all(axis=(1, 2))
    if not seen.any():
        return None
    known = stack[seen]
    shape = known[len(known) // 2] - known[len(known) // 2].mean(axis=0)
    turns = [Rotation.align_vectors(one - one.mean(axis=0), shape)[0] for one in known]
    return seen, RigidTransform.from_components(known.mean(axis=1), Rotation.concatenate(turns))


def joint_centre(
    first: Cluster, second: Cluster, guess: Float[np.ndarray, "frames 3"]
) -> Float[np.ndarray, "frames 3"] | None:
    """Where the joint between two clusters is in the world [m]; NaN where one of them is not seen.

    It keeps its place in both (symmetrical centre of rotation estimation; Ehrig et
    al. 2006, J Biomech 39:2798). Along axes about which the joint hardly turns it stays where a
    first fit has it, the guess. None if both are hardly ever seen at once.
    """
    both = first[0] & second[0] & np.isfinite(guess).all(axis=1)
    frames = int(both.sum())
    if frames < LEAST_FRAMES:
        return None
    poses = [poses[both[seen]] for seen, poses in (first, second)]
    usual = [np.median(pose.inv().apply(guess[both]), axis=0) for pose in poses]
    turns = [pose.rotation.as_matrix() for pose in poses]
    matrix = np.concatenate([turns[0], -turns[1]], axis=2).reshape(3 * frames, 6)
    rest = (poses[1].translation - poses[0].translation).reshape(-1)
    weight = TRUST * np.sqrt(frames)
    matrix = np.concatenate([matrix, weight * np.eye(6)])
    rest = np.concatenate([rest, weight * np.concatenate(usual)])
    places = np.linalg.lstsq(matrix, rest, rcond=None)[0].reshape(2, 3)
    out = np.full_like(guess, np.nan)
    out[both] = (poses[0].apply(places[0]) + poses[1].apply(places[1])) / 2.0
    return out


def _leg_lengths(joints: Points, measures: Measures, legs: Iterable[str]) -> dict[str, float]:
    """Lengths of thighs, shanks or both between centres of joints [m], if a body has such."""
    found = {}
    for measure in legs:
        ends = [(f"{side}_{measure}", f"{side}_{LEGS[measure]}") for side in SIDES]
        pairs = [(joints[a], joints[b]) for a, b in ends if a in joints and b in joints]
        known = [np.linalg.norm(first - second, axis=1) for first, second in pairs]
        if known:
            length = float(np.mean([np.nanmedian(apart) for apart in known]))
            if USUAL_SHARE[0] < length / measures[measure] < USUAL_SHARE[1]:
                found[measure] = length
    return found


def _by_landmarks(
    measures: Measures,
    points: Points,
    exact: Mapping[str, BodyName],
    clusters: Mapping[str, list[str]],
    guidance: Guidance,
) -> PointFit:
    """A first fit: landmarks to where they usually are, clusters to the middles of segments."""
    spec, bones = body_spec(measures), skeleton(measures)
    places = {name: each.place for name, each in exact.items()}
    known = {name: points[name] for name in exact}
    for segment in (name for name in clusters if name in bones):
        bone, name = bones[segment], f"middle_{segment}"
        middle = 0.5 * (bone.tip - bone.origin)
        spec.body(segment).add_site(name=name, pos=middle, size=[0.006, 0.0, 0.0])
        known[name], places[name] = mean_of(points, clusters[segment]), name
    weights = {place: MIDDLE_WEIGHT for place in places.values() if place.startswith("middle_")}
    return fit_points(Human(measures, spec.compile()), known, places, weights, guidance)


def measures_from_markers(
    points: Points, names: Mapping[str, BodyName], every: Mapping[str, BodyName]
) -> Measures:
    """Measures by the distances of landmarks, the stature by the heights of all."""
    stands = standing_by_parts(points, every)
    stature = min(max(stands.height, 1.0), 2.2) if stands and stands.clear else None
    given = {"stature": stature} if stature else {}
    usual = estimate_measures(given=given)
    body = Human.of(usual)
    where = body.sites(body.posture()[None], {each.place for each in names.values()})
    places: dict[str, Float[np.ndarray, "frames 3"]] = {}
    for name, each in names.items():
        places.setdefault(each.place, points[name])
    found = {}
    pairs_of = {
        measure: [(f"{side}_{a}", f"{side}_{b}") for a, b in pairs for side in SIDES]
        for measure, pairs in SPANS.items()
    } | {
        measure: [(f"right_{place}", f"left_{place}") for place in paired]
        for measure, paired in BREADTHS.items()
    }
    for measure, pairs in pairs_of.items():
        known = []
        for first, second in pairs:
            if first in places and second in places:
                apart = np.linalg.norm(places[first] - places[second], axis=1)
                own = float(np.linalg.norm(where[first][0][0] - where[second][0][0]))
                known += [] if np.isnan(apart).all() else [float(np.nanmedian(apart)) / own]
        if known and USUAL_SHARE[0] < float(np.mean(known[:2])) < USUAL_SHARE[1]:
            found[measure] = usual[measure] * float(np.mean(known[:2]))
    try:
        made = estimate_measures(given=given | found)
    except MeasuresError:
        made = usual
    share = trunk_share(places, Human.of(made))
    return made if share is None else with_trunk(made, share)
