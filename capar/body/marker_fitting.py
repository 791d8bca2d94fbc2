"""From markers on the skin to the body's motion: size, places of the markers, then postures."""

from collections import Counter
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
from jaxtyping import Bool, Float
from scipy.spatial.transform import RigidTransform, Rotation

from capar.body.anthropometry import Measures, MeasuresError, estimate_measures
from capar.body.human import Human, body_spec
from capar.body.inverse_kinematics import standing_flat
from capar.body.point_fitting import (
    TRUNK_OF_LANDMARKS,
    Guidance,
    SkeletonError,
    SkeletonFit,
    fit_skeleton,
    measures_from_points,
    segment_of,
    trunk_share,
    with_ankles,
    with_legs,
    with_trunk,
)
from capar.body.skeleton import skeleton
from extractors.readers.drafting.contents import Points, mean_of, standing_by_parts
from extractors.readers.names import SIDES, BodyName, Convention

LEAST_MARKERS = 3
"""So many markers tell how a cluster is placed and turned."""

LEAST_FRAMES = 10
"""Frames in which both clusters are seen, at least."""

TRUST = 0.1
"""Weight of the first fit's centre against one frame's motion [1]: skin moves by half a centimetre
or so, while first fits miss joints by about five."""


@dataclass(frozen=True, eq=False)
class Cluster:
    """Markers that ride on one segment, as a rigid body."""

    seen: Bool[np.ndarray, "frames"]
    poses: RigidTransform
    """``T_world_cluster`` of the frames in which all its markers are seen."""


def cluster_of(points: Sequence[Float[np.ndarray, "frames 3"]]) -> Cluster | None:
    """Markers as a rigid body; None if they are too few, or never seen at once.

    Args:
        points: Of markers on one segment, in the world [m]; NaN where lost.
    """
    if len(points) < LEAST_MARKERS:
        return None
    stack = np.stack(points, axis=1)
    seen = np.isfinite(stack).all(axis=(1, 2))
    if not seen.any():
        return None
    known = stack[seen]
    shape = known[len(known) // 2] - known[len(known) // 2].mean(axis=0)
    turns = [Rotation.align_vectors(one - one.mean(axis=0), shape)[0] for one in known]
    poses = RigidTransform.from_components(known.mean(axis=1), Rotation.concatenate(turns))
    return Cluster(seen, poses)


def joint_centre(
    first: Cluster, second: Cluster, guess: Float[np.ndarray, "frames 3"]
) -> Float[np.ndarray, "frames 3"] | None:
    """Where the joint between two clusters is in the world [m]; NaN where one of them is not seen.

    None if both are hardly ever seen at once.

    Args:
        first: On one side of the joint.
        second: On the other.
        guess: Where a first fit has it [m].
    """
    both = first.seen & second.seen & np.isfinite(guess).all(axis=1)
    if both.sum() < LEAST_FRAMES:
        return None
    poses = [shape.poses[both[shape.seen]] for shape in (first, second)]
    usual = [np.median(pose.inv().apply(guess[both]), axis=0) for pose in poses]
    frames = int(both.sum())
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


def joint_centres(
    points: Points,
    segments: Mapping[str, str],
    parents: Mapping[str, str],
    guesses: Mapping[str, Float[np.ndarray, "frames 3"]],
) -> dict[str, Float[np.ndarray, "frames 3"]]:
    """By segment, where its joint with its parent is in the world [m].

    Args:
        points: Markers in the world [m]; NaN where lost.
        segments: The segment of each marker.
        parents: By segment, the one towards the pelvis.
        guesses: By segment, where a first fit has its joint [m].
    """
    clusters: dict[str, Cluster] = {}
    for segment in {*segments.values()}:
        found = cluster_of([points[name] for name, on in segments.items() if on == segment])
        if found is not None:
            clusters[segment] = found
    out = {}
    for segment, own in clusters.items():
        parent = parents.get(segment, "")
        if parent in clusters and segment in guesses:
            centre = joint_centre(clusters[parent], own, guesses[segment])
            if centre is not None:
                out[segment] = centre
    return out


SAMPLES = 60
"""Frames by which sizes and places of markers are found."""

LEAST_EXACT = 6
"""So many markers are at known places of the body at least, so that they place it."""

ROUNDS = 2
"""Times that the places of markers are found anew from postures, and postures from them."""

LEAST_CLUSTER = 2
"""So many markers on one segment at least tell where its middle is."""

MIDDLE_WEIGHT = 0.2
"""Weight of the middle of a segment by the markers that ride on it [1]."""

CLUSTER_EASE = 20.0
"""How much more than usual the standing posture counts until markers of unknown places have found
theirs [1]: which way a segment is turned only they tell."""

CLUSTER_WEIGHT = 0.7
"""Weight of markers whose places are found from the motion itself [1]."""

LARGE_CLUSTER = 4
"""So many such markers on a segment weigh as much as more of them together: a shoulder blade with a
dozen markers would else bend the chest that it glides on."""

SPANS: Mapping[str, tuple[tuple[str, str], ...]] = {
    "upper_arm": (("upper_arm", "forearm"), ("acromion", "elbow_lateral")),
    "forearm": (("forearm", "hand"), ("elbow_lateral", "wrist_radial")),
    "thigh": (("thigh", "shank"), ("trochanter", "knee_lateral")),
    "shank": (("shank", "foot"), ("knee_lateral", "ankle_lateral")),
    "foot_length": (("heel", "toe_tip"),),
    "foot_breadth": (("first_metatarsal", "fifth_metatarsal"),),
}
"""Pairs of places, of one side, between which a measure lies; the first that is there counts."""

LIMBS = (("shank", "thigh"), ("foot", "shank"), ("forearm", "upper_arm"))
"""Segments of limbs, each with the one that it hangs on."""

LEGS = {"thigh": "shank", "shank": "foot"}
"""Segments of legs, whose measures have their names, each with the one that hangs on it."""

BREADTHS: Mapping[str, tuple[str, ...]] = {
    "shoulder_breadth": ("upper_arm", "acromion"),
    "spine_breadth": ("thigh", "asis"),
}
"""Places whose distance between the sides goes with a measure."""

USUAL_SHARE = (0.8, 1.25)
"""A measure is taken from markers if it is between these shares of the estimated one [1]."""


@dataclass(frozen=True, eq=False)
class MarkerFit:
    """A body's motion that follows markers, and where these are on it."""

    skeleton: SkeletonFit
    local: Mapping[str, Float[np.ndarray, "3"]]
    """Place of each marker in its segment's frame [m]."""


def fit_markers(
    points: Points, names: Mapping[str, BodyName], *, ground_m: float | None = None
) -> MarkerFit:
    """Fit the body to markers in a world whose z axis points up.

    The size comes from distances of landmarks, what they do not tell from the stature that the
    heights of all markers show. Markers begin where landmarks usually are; then each one's place on
    its segment is the one where it is in the median of the fitted postures.

    Args:
        points: By name [m]; NaN where lost.
        names: What the names mean; points of no name are ignored.
        ground_m: Height of the ground on which feet stand, where it is known [m].

    Raises:
        SkeletonError: Too few markers are at known places, or none three of them at once.
    """
    seen = {n: each for n, each in names.items() if n in points and not np.isnan(points[n]).all()}
    exact = {name: each for name, each in seen.items() if each.exact and _is_sided(each)}
    clusters = _clusters(seen)
    if len(exact) + len(clusters) < LEAST_EXACT:
        raise SkeletonError(
            f"{len(exact)} markers at known places of the body ({', '.join(sorted(exact))}) and "
            f"{len(clusters)} segments with clusters of them; {LEAST_EXACT} or more place it"
        )
    human = Human.of(measures_from_markers(points, exact, seen))
    frames = sample_frames(points, seen)
    sampled = {name: points[name][frames] for name in seen}
    places = {name: each.place for name, each in seen.items()}
    known = Guidance(standing_flat(points, places), ground_m)
    human = Human.of(with_ankles(human.measures, points, places, known))
    ease = 1.0 if len(exact) >= LEAST_EXACT else CLUSTER_EASE
    eased = replace(known.at(frames), ease=ease)
    first = _by_landmarks(human.measures, sampled, exact, clusters, eased)
    legs = [measure for measure in LEGS if ease == 1.0 and measure not in human.measures.given]
    for _ in range(ROUNDS if legs else 0):
        lengths = _leg_lengths(_joints(first, sampled, seen), human.measures, legs)
        if lengths:
            human = _with_legs(human.measures, lengths, {exact[n].place: sampled[n] for n in exact})
            first = _by_landmarks(human.measures, sampled, exact, clusters, eased)
    local = local_places(first, sampled, seen)
    joints = {} if ease == 1.0 else _joints(first, sampled, seen)
    if len(joints) >= LEAST_EXACT:
        human = Human.of(_measures_by_joints(human.measures, joints, known.at(frames)))
        local = {}
    else:
        joints = {}
    for _ in range(ROUNDS):
        human = with_markers(human.measures, local, seen)
        own = _own_places(local, seen, joints)
        again = fit_skeleton({**sampled, **joints}, own, human=human, guidance=known.at(frames))
        local = local_places(again, sampled, seen)
    human = with_markers(human.measures, local, seen)
    own = _own_places(local, seen)
    shown = {name: points[name] for name in local}
    return MarkerFit(fit_skeleton(shown, own, human=human, guidance=known), local)


def _joints(
    made: SkeletonFit, points: Points, names: Mapping[str, BodyName]
) -> dict[str, Float[np.ndarray, "frames 3"]]:
    """Centres of joints between segments with three markers or more, by the segment below [m]."""
    segments = {
        n: segment_of(made.human, each.place) for n, each in names.items() if _is_sided(each)
    }
    parents = {child: parent for side in SIDES for child, parent in _jointed(side)}
    where = made.human.sites(made.motion, parents)
    guesses = {name: one[0] for name, one in where.items()}
    return joint_centres(points, segments, parents, guesses)


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


def _jointed(side: str) -> list[tuple[str, str]]:
    """Segments of limbs with the one that they hang on; that of an arm is the chest."""
    pairs = [(f"{side}_{child}", f"{side}_{parent}") for child, parent in LIMBS]
    return [*pairs, (f"{side}_thigh", "pelvis"), (f"{side}_upper_arm", "thorax_upper")]


def _measures_by_joints(measures: Measures, joints: Points, guidance: Guidance) -> Measures:
    """Measures by the centres of joints; the same ones if they tell no limb's length."""
    places = {name: name for name in joints}
    try:
        made = measures_from_points(joints, file_convention(places, {}))
    except SkeletonError:
        return measures
    return with_ankles(made, joints, places, guidance)


def _clusters(names: Mapping[str, BodyName]) -> dict[str, list[str]]:
    """Markers that ride on a segment, by the segment, where it has three or more."""
    out: dict[str, list[str]] = {}
    for name, each in names.items():
        if _is_sided(each) and not each.exact:
            out.setdefault(each.place, []).append(name)
    return {segment: group for segment, group in out.items() if len(group) >= LEAST_CLUSTER}


def _by_landmarks(
    measures: Measures,
    points: Points,
    exact: Mapping[str, BodyName],
    clusters: Mapping[str, list[str]],
    guidance: Guidance,
) -> SkeletonFit:
    """A first fit: landmarks to where they usually are, clusters to the middles of segments."""
    spec, bones = body_spec(measures), skeleton(measures)
    places = {name: each.place for name, each in exact.items()}
    known = {name: points[name] for name in exact}
    for segment in (name for name in clusters if name in bones):
        bone = bones[segment]
        middle = 0.5 * (bone.tip - bone.origin)
        spec.body(segment).add_site(name=f"middle_{segment}", pos=middle, size=[0.006, 0.0, 0.0])
        known[f"middle_{segment}"] = mean_of(points, clusters[segment])
        places[f"middle_{segment}"] = f"middle_{segment}"
    weights = {place: MIDDLE_WEIGHT for place in places.values() if place.startswith("middle_")}
    human = Human(measures, spec.compile())
    return fit_skeleton(known, file_convention(places, weights), human=human, guidance=guidance)


def _with_legs(measures: Measures, lengths: Mapping[str, float], places: Points) -> Human:
    """The body with other legs; its trunk, which the stature no longer tells, by its landmarks."""
    longer = Human.of(with_legs(measures, lengths))
    share = trunk_share(places, longer, TRUNK_OF_LANDMARKS)
    return longer if share is None else Human.of(with_trunk(longer.measures, share))


def _is_sided(each: BodyName) -> bool:
    """Whether a name tells all that a place of the body needs."""
    return each.side != "none" or each.place in MIDDLE


MIDDLE = {
    "c7", "t10", "sternum_top", "sternum_low", "sacrum", "head_top", "head", "neck", "pelvis",
    "nose", "thorax_upper", "thorax_lower", "lumbar_upper", "lumbar_lower",
}  # fmt: skip
"""Places of the middle of the body."""


def sample_frames(points: Points, names: Mapping[str, BodyName]) -> np.ndarray:
    """Frames in which most markers are seen, evenly through the recording."""
    seen = np.sum([~np.isnan(points[name]).any(axis=1) for name in names], axis=0)
    known = np.flatnonzero(seen >= 0.8 * seen.max())
    return known[np.unique(np.linspace(0, len(known) - 1, SAMPLES).round().astype(int))]


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
    by_place: dict[str, list[str]] = {}
    for name, each in names.items():
        by_place.setdefault(each.place, []).append(name)
    found = {}
    for measure, pairs in _pairs().items():
        shares = [_share(points, by_place, where, *pair) for pair in pairs]
        known = [each for each in shares if each is not None]
        if known and USUAL_SHARE[0] < float(np.mean(known[:2])) < USUAL_SHARE[1]:
            found[measure] = usual[measure] * float(np.mean(known[:2]))
    try:
        made = estimate_measures(given=given | found)
    except MeasuresError:
        made = usual
    places = {place: points[group[0]] for place, group in by_place.items()}
    share = trunk_share(places, Human.of(made))
    return made if share is None else with_trunk(made, share)


def _pairs() -> dict[str, list[tuple[str, str]]]:
    """By measure, the pairs of places that it lies between, both sides in a row."""
    out = {
        measure: [(f"{side}_{a}", f"{side}_{b}") for a, b in pairs for side in ("right", "left")]
        for measure, pairs in SPANS.items()
    }
    return out | {
        measure: [(f"right_{place}", f"left_{place}") for place in places]
        for measure, places in BREADTHS.items()
    }


def _share(
    points: Points,
    by_place: Mapping[str, list[str]],
    where: Mapping[str, tuple[np.ndarray, np.ndarray]],
    first: str,
    second: str,
) -> float | None:
    """How far two places are apart, as a share of the body's own distance [1]."""
    if first not in by_place or second not in by_place:
        return None
    apart = np.linalg.norm(points[by_place[first][0]] - points[by_place[second][0]], axis=1)
    if np.isnan(apart).all():
        return None
    own = float(np.linalg.norm(where[first][0][0] - where[second][0][0]))
    return float(np.nanmedian(apart)) / own


def file_convention(places: Mapping[str, str], weights: Mapping[str, float]) -> Convention:
    """Names of a file with their places on the body, as a convention of its own."""
    return Convention(
        "file", "the file's own markers", "", oriented=False, markers=True,
        points=dict(places), weights=weights, whole_names=True,
    )  # fmt: skip


def _own_places(
    local: Mapping[str, Float[np.ndarray, "3"]],
    names: Mapping[str, BodyName],
    joints: Iterable[str] = (),
) -> Convention:
    """Every marker at the site that was made for it, and joints at the origins of segments."""
    riding = [name for name in local if not names[name].exact]
    count = Counter(names[name].place for name in riding)
    weights = {
        f"marker_{n}": CLUSTER_WEIGHT * min(1.0, (LARGE_CLUSTER / count[names[n].place]) ** 0.5)
        for n in riding
    }
    places = {name: f"marker_{name}" for name in local} | {name: name for name in joints}
    return file_convention(places, weights)


def local_places(
    made: SkeletonFit, points: Points, names: Mapping[str, BodyName]
) -> dict[str, Float[np.ndarray, "3"]]:
    """The median place of every marker in its segment's frame [m]."""
    human = made.human
    sided = {name: each.place for name, each in names.items() if _is_sided(each)}
    segments = {name: segment_of(human, place) for name, place in sided.items()}
    known = {human.model.body(each).name for each in range(human.model.nbody)}
    segments = {name: each for name, each in segments.items() if each in known}
    poses = human.sites(made.motion, set(segments.values()))
    out = {}
    for name, segment in segments.items():
        places, turns = poses[segment]
        seen = ~np.isnan(points[name]).any(axis=1)
        if seen.any():
            frame = RigidTransform.from_components(
                places[seen], Rotation.from_quat(turns[seen], scalar_first=True)
            )
            out[name] = np.median(frame.inv().apply(points[name][seen]), axis=0)
    return out


def with_markers(
    measures: Measures,
    local: Mapping[str, Float[np.ndarray, "3"]],
    names: Mapping[str, BodyName],
) -> Human:
    """The body with a site for every marker, ``marker_<name>``."""
    plain = Human.of(measures)
    spec = body_spec(measures)
    for name, place in local.items():
        segment = segment_of(plain, names[name].place)
        spec.body(segment).add_site(name=f"marker_{name}", pos=place, size=[0.006, 0.0, 0.0])
    return Human(measures, spec.compile())
