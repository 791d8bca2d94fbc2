"""Where points of a skeleton's hands and head sit on the body's, if three or more are seen.

Such points turn a hand or a head fully. Where they sit on the body is not found from its postures,
which they are to turn, but from their own shape, laid onto the same points of the body.
"""

from collections.abc import Mapping, Sequence
from warnings import catch_warnings

import numpy as np
from jaxtyping import Float
from scipy.spatial.transform import Rotation

from capar.body.human import Human
from capar.model import geometry
from extractors.readers.body_names.body_names import SIDES
from extractors.readers.drafting.stance import Points

FACE = "face"
"""Name of a point that is put before the head, in the direction in which the face looks."""

FACE_M = 0.2
"""How far before the head's joint it is [m]."""

RIGID_M = 0.01
"""Points are rigid together if they stay so near to a common shape (root mean square) [m]."""

LEAST_POINTS = 3
"""So many points of a part at least tell how it is turned; of a face two, its joint and where it
looks."""

JOINT_WEIGHT = 0.1
"""Weight of the head's joint, its top and the thumb against eyes, face and knuckles [1]: skeletons
have them at different places."""

HAND = ("hand", "index_knuckle", "fingers", "fifth_knuckle", "thumb_tip")
HEAD = ("head", "head_top", "right_eye", "left_eye", FACE)


def rigid_places(
    human: Human,
    points: Points,
    places: Mapping[str, str],
    faces: Float[np.ndarray, "frames 3"] | None = None,
) -> dict[str, Float[np.ndarray, "3"]]:
    """Where points of hands and head are in the frame of ``part_of`` their place [m], by name.

    A hand hangs on its wrist, a head on its eyes, or on its joint where eyes are not seen.

    Args:
        human: The body.
        points: By name, in the world [m]; NaN where lost.
        places: The place on the body of each.
        faces: Directions in which the face looks [1], where they are known.
    """
    out: dict[str, Float[np.ndarray, "3"]] = {}
    heads = [name for name, place in places.items() if place == "head"]
    if faces is not None and heads:
        points = {**points, FACE: points[heads[0]] + FACE_M * faces}
        places = {**places, FACE: FACE}
    for segment, own in _parts().items():
        names = [name for name, place in places.items() if place in own]
        told = len(names) >= LEAST_POINTS or FACE in (places[name] for name in names)
        shape = rigid_shape([points[name] for name in names]) if told else None
        if shape is not None:
            usual = _usual(human, segment, [places[name] for name in names])
            out |= dict(zip(names, _laid(shape, usual, [places[n] for n in names]), strict=True))
    return {name: spot for name, spot in out.items() if name in places and name != FACE}


def part_of(place: str) -> str:
    """The segment with which a place is rigid: a hand, the head, or what the place is on."""
    return next((segment for segment, own in _parts().items() if place in own), place)


def _parts() -> dict[str, tuple[str, ...]]:
    """By segment, the places whose points are rigid with it."""
    hands = {f"{side}_hand": tuple(f"{side}_{place}" for place in HAND) for side in SIDES}
    return {**hands, "head": HEAD}


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
    """A shape turned as the body has its places, and moved to where it hangs."""
    held = [place.endswith("_eye") for place in places]
    if not any(held):
        held = [place in {"head", "right_hand", "left_hand"} for place in places]
    weights = np.array([JOINT_WEIGHT if _doubtful(place) else 1.0 for place in places])
    middle = shape[held].mean(axis=0)
    turn = _turn(shape - middle, usual - usual[held].mean(axis=0), places, weights)
    return np.asarray(turn.apply(shape - middle) + usual[held].mean(axis=0))


def _turn(
    shape: Float[np.ndarray, "points 3"],
    usual: Float[np.ndarray, "points 3"],
    places: Sequence[str],
    weights: Float[np.ndarray, "points"],
) -> Rotation:
    """The turn that takes a shape to the usual one; of the face only its direction counts."""
    if FACE in places:
        joint, face = list(places).index("head"), list(places).index(FACE)
        shape, usual = shape.copy(), usual.copy()
        shape[face] -= shape[joint]
        usual[face] -= usual[joint]
    with catch_warnings(action="ignore", category=UserWarning):  # a face alone leaves its roll open
        turn, _ = Rotation.align_vectors(usual, shape, weights=weights)
    return turn


def _doubtful(place: str) -> bool:
    return place in {"head", "head_top"} or place.endswith("thumb_tip")
