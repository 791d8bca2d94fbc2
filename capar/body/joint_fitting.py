"""From joints and key points to the body's motion, heads and toes where the file has them.

Three points or more of a hand or the head turn it fully. Where they sit on the body is not found
from its postures, which they are to turn, but from their own shape, laid onto the same points of
the body.
"""

from collections.abc import Mapping, Sequence
from dataclasses import replace
from warnings import catch_warnings

import numpy as np
from jaxtyping import Float
from scipy.spatial.transform import Rotation

from capar.body.anthropometry import Measures
from capar.body.human import Human
from capar.body.inverse_kinematics import standing_flat
from capar.body.point_fitting import (
    Guidance,
    PointFit,
    fit_points,
    local_places,
    measures_from_points,
    sample_frames,
    with_ankles,
    with_head,
    with_markers,
)
from capar.model import geometry
from extractors.readers.drafting.contents import Points
from extractors.readers.names import SIDES, BodyName, Convention, parts, without_side

#: Name of a point that is put before the head where the face looks, and how far before [m]
FACE, FACE_M = "face", 0.2
#: Points are rigid together if they stay so near to a common shape (root mean square) [m]
RIGID_M = 0.01
#: So many points of a part at least tell how it is turned; of a face two, its joint and where it
#: looks
LEAST_POINTS = 3
#: Weight of the head's joint, its top and the thumb against eyes, face and knuckles [1]: skeletons
#: have them at different places
JOINT_WEIGHT = 0.1
#: By segment, the places whose points are rigid with it
RIGID_PARTS = {
    **{
        f"{side}_hand": tuple(
            f"{side}_{place}"
            for place in ("hand", "index_knuckle", "fingers", "fifth_knuckle", "thumb_tip")
        )
        for side in SIDES
    },
    "head": ("head", "head_top", "right_eye", "left_eye", FACE),
}
#: Joints that are at the same place in every skeleton
SHARED = {"upper_arm", "forearm", "hand", "thigh", "shank", "foot", "fingers", "thumb_tip"}
#: How much places on the hand count, and joints of the spine once their places are known [1]
WEIGHTS = {
    "index_knuckle": 0.5, "fingers": 0.5, "fifth_knuckle": 0.5, "thumb_tip": 0.2,
    "pelvis": 1.0, "lumbar_lower": 1.0, "lumbar_upper": 1.0, "thorax_lower": 1.0,
    "thorax_upper": 1.0,
}  # fmt: skip
#: How much the head's joint counts where eyes are seen, and how much of their weight necks and
#: heads have before it is known where on the body theirs are [1]
HEAD_BY_EYES, EARLY_SHARE = 0.3, 0.1
SPINE_M = 0.05  # how far from the axis of its segment a joint of the spine may be [m]
ROUNDS = 3  # times that places are found anew from postures

Local = Mapping[str, Float[np.ndarray, "3"]]


def fit_joints(
    points: Points,
    convention: Convention,
    *,
    ground_m: float | None = None,
    stated: Mapping[str, str] | None = None,
    faces: Float[np.ndarray, "frames 3"] | None = None,
) -> PointFit:
    """Fit the body to joints or key points [m] in a world whose z axis points up; NaN where lost.

    Hands and heads of which three points are seen are turned as these are. Toes, necks, spines and
    other heads, which skeletons have at different places, begin where the body has its own; then
    each is where it is on its segment in the median of the fitted postures. Feet stand on a ground
    of known height [m]; faces look in known directions [1]. Places that a capture states beyond the
    convention count if they move as one.

    Raises:
        SkeletonError: Fewer than four places are known, or the points are of no body.
    """
    places = _believed(points, convention.named(points), stated or {})
    known = Guidance(standing_flat(points, places), ground_m, faces)
    measures = with_ankles(measures_from_points(points, places), points, places, known)
    weights = {
        name: WEIGHTS.get(without_side(place), convention.weight(place))
        for name, place in places.items()
    }
    if "right_eye" in places.values():
        weights |= {n: HEAD_BY_EYES for n, place in places.items() if place == "head"}
    names = {n: BodyName(n, place, exact=True, by=convention.title) for n, place in places.items()}
    frames = sample_frames(points, names)
    sampled = {name: points[name][frames] for name in places}
    shaped = rigid_places(Human.of(measures), sampled, places, known.at(frames).faces)
    names |= {name: replace(names[name], place=part_of(places[name])) for name in shaped}
    early = {name: weight * _early(name, names, places) for name, weight in weights.items()}
    # Toes turn about their joint, which moves with the foot: on them it would turn them.
    differing = {
        n: replace(name, place=name.place.replace("_toes", "_foot"))
        for n, name in names.items()
        if n not in shaped and without_side(name.place) not in SHARED
    }
    names |= differing
    local: Local = shaped
    for _ in range(ROUNDS):
        first = _fit(sampled, measures, local, names, places, early, known.at(frames))
        settled = _settled(shaped, first, sampled, names, places)
        measures = with_head(measures, _eyes_higher_m(first, sampled, places))
        local = {**settled, **_anatomical(local_places(first, sampled, differing), places)}
    return _fit(points, measures, local, names, places, weights, known)


def _fit(
    points: Points,
    measures: Measures,
    local: Local,
    names: Mapping[str, BodyName],
    places: Mapping[str, str],
    weights: Mapping[str, float],
    guidance: Guidance,
) -> PointFit:
    """The body fitted to points, some of which have places of their own on it."""
    found = {name: f"marker_{name}" if name in local else places[name] for name in names}
    by_place = {place: weights[name] for name, place in found.items()}
    return fit_points(with_markers(measures, local, names), points, found, by_place, guidance)


def _believed(
    points: Points, named: Mapping[str, str], stated: Mapping[str, str]
) -> dict[str, str]:
    """Places as a convention has and a capture states them; the latter if each part is rigid."""
    both = {**named, **stated}
    for part in {part_of(place) for place in stated.values()}:
        own = [points[name] for name, place in both.items() if part_of(place) == part]
        if len(own) > 1 and rigid_shape(own) is None:
            return dict(named)
    return both


def _early(name: str, names: Mapping[str, BodyName], places: Mapping[str, str]) -> float:
    """How much of its weight a point has until places on spine, neck and head are found [1]."""
    place = names[name].place
    if parts().get(without_side(place)) in {"trunk", "pelvis"} and place != "neck":
        return 0.0
    eyed = any(place.endswith("_eye") for place in places.values())
    return EARLY_SHARE if place == "neck" or (place == "head" and not eyed) else 1.0


def _settled(
    shaped: Local,
    first: PointFit,
    points: Points,
    names: Mapping[str, BodyName],
    places: Mapping[str, str],
) -> dict[str, Float[np.ndarray, "3"]]:
    """Rigid places; those of a head without eyes moved to where its joint is in the postures."""
    heads = {name for name in shaped if names[name].place == "head"}
    joint = next((name for name in heads if places[name] == "head"), None)
    moved = np.zeros(3)
    if joint is not None and not any(places[name].endswith("_eye") for name in heads):
        moved = local_places(first, points, {joint: names[joint]})[joint] - shaped[joint]
    return {name: spot + moved if name in heads else spot for name, spot in shaped.items()}


def _eyes_higher_m(made: PointFit, points: Points, places: Mapping[str, str]) -> float:
    """How much higher above the chest eyes are than the body has them [m]; 0 where unseen."""
    eyes = [name for name, place in places.items() if place.endswith("_eye")]
    if not eyes:
        return 0.0
    where = made.human.sites(made.motion, [*(f"marker_{name}" for name in eyes), "thorax_upper"])
    chest = geometry.rotations(where["thorax_upper"][1])
    off = [chest.inv().apply(points[n] - where[f"marker_{n}"][0])[:, 2] for n in eyes]
    return float(np.nanmedian(off))


def _anatomical(local: Local, places: Mapping[str, str]) -> dict[str, Float[np.ndarray, "3"]]:
    """Places where a body can have them: toes straight ahead, joints of the spine in the trunk."""
    out = {}
    for name, spot in local.items():
        place, aside = without_side(places[name]), 1.0
        if parts().get(place) in {"trunk", "pelvis"}:
            aside = max(float(np.linalg.norm(spot[:2])) / SPINE_M, 1.0)
        ahead = np.array([1.0, 0.0, 1.0]) if place == "toes" else 1.0
        out[name] = ahead * spot / np.array([aside, aside, 1.0])
    return out


def rigid_places(
    human: Human,
    points: Points,
    places: Mapping[str, str],
    faces: Float[np.ndarray, "frames 3"] | None = None,
) -> dict[str, Float[np.ndarray, "3"]]:
    """Where points of hands and head are in the frame of ``part_of`` their place [m], by name.

    A hand hangs on its wrist, a head on its eyes, or on its joint where eyes are not seen.
    """
    out: dict[str, Float[np.ndarray, "3"]] = {}
    heads = [name for name, place in places.items() if place == "head"]
    if faces is not None and heads:
        points = {**points, FACE: points[heads[0]] + FACE_M * faces}
        places = {**places, FACE: FACE}
    for segment, own in RIGID_PARTS.items():
        names = [name for name, place in places.items() if place in own]
        told = len(names) >= LEAST_POINTS or FACE in (places[name] for name in names)
        shape = rigid_shape([points[name] for name in names]) if told else None
        if shape is not None:
            usual = _usual(human, segment, [places[name] for name in names])
            out |= dict(zip(names, _laid(shape, usual, [places[n] for n in names]), strict=True))
    return {name: spot for name, spot in out.items() if name in places and name != FACE}


def part_of(place: str) -> str:
    """The segment with which a place is rigid: a hand, the head, or what the place is on."""
    return next((segment for segment, own in RIGID_PARTS.items() if place in own), place)


def rigid_shape(
    points: Sequence[Float[np.ndarray, "frames 3"]],
) -> Float[np.ndarray, "points 3"] | None:
    """The shape that points keep [m], their middle at zero; None if they are not rigid."""
    stack = np.stack(points, axis=1)
    stack = stack[np.isfinite(stack).all(axis=(1, 2))]
    if not len(stack):
        return None
    centred = stack - stack.mean(axis=1, keepdims=True)
    shape = centred[0]
    with catch_warnings(action="ignore", category=UserWarning):  # two points leave a turn open
        turns = [Rotation.align_vectors(shape, frame)[0] for frame in centred]
    turned = np.stack([turn.apply(frame) for turn, frame in zip(turns, centred, strict=True)])
    rest = turned - turned.mean(axis=0)
    rigid = np.sqrt((rest**2).sum(axis=2).mean()) < RIGID_M
    return np.asarray(turned.mean(axis=0)) if rigid else None


def _usual(human: Human, segment: str, places: Sequence[str]) -> Float[np.ndarray, "points 3"]:
    """Where the body itself has places, in the frame of their segment [m]."""
    known = {place for place in places if place != FACE} | {segment}
    where = human.sites(human.posture()[None], known)
    frame = geometry.transforms(where[segment][0][0], where[segment][1][0])
    ahead = {FACE: frame.apply([FACE_M, 0.0, 0.0])}
    world = [ahead[place] if place in ahead else where[place][0][0] for place in places]
    return np.asarray(frame.inv().apply(np.array(world)))


def _laid(
    shape: Float[np.ndarray, "points 3"],
    usual: Float[np.ndarray, "points 3"],
    places: Sequence[str],
) -> Float[np.ndarray, "points 3"]:
    """A shape turned as the body has its places and moved to where it hangs."""
    held = [place.endswith("_eye") for place in places]
    if not any(held):
        held = [place in {"head", "right_hand", "left_hand"} for place in places]
    weights = np.array([
        JOINT_WEIGHT if place in {"head", "head_top"} or place.endswith("thumb_tip") else 1.0
        for place in places
    ])  # fmt: skip
    middle, hangs = shape[held].mean(axis=0), usual[held].mean(axis=0)
    own, other = shape - middle, usual - hangs
    if FACE in places:
        joint, face = list(places).index("head"), list(places).index(FACE)
        own[face] -= own[joint]
        other[face] -= other[joint]
    with catch_warnings(action="ignore", category=UserWarning):  # a face alone leaves its roll open
        turn, _ = Rotation.align_vectors(other, own, weights=weights)
    return np.asarray(turn.apply(shape - middle) + hangs)
