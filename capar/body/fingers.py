"""How far hands are closed, by the recorded joints of their fingers."""

from collections.abc import Mapping
from itertools import pairwise

import numpy as np
from jaxtyping import Float

from capar.body.human import ROOT_SIZE, Human
from capar.body.joint_fitting import RIGID_M
from capar.model import geometry
from extractors.readers.drafting.contents import Points
from extractors.readers.names import SIDES, BodyName, without_side

#: Words by which names tell whose joint a point is; those of one finger are in order of name
FINGERS, THUMB = ("index", "middle", "ring", "pinky", "little"), "thumb"
#: What names of joints of fingers are known as
PLACES = ("hand", "fingers", "thumb", "thumb_tip", "index_knuckle", "fifth_knuckle")
REACH_M = 0.25  # no joint of a finger is farther from the wrist than this [m]

#: A thumb begins nearer to the wrist than this share of the fingers' distance [1]; else its name is
#: another finger's
THUMB_SHARE = 0.8
#: Where the open thumb points about the hand's long axis, from forwards to the palm [rad]
THUMB_AHEAD = float(np.arctan2(0.15, 0.45))


def closed_hands(
    human: Human,
    motion: Float[np.ndarray, "frames posture"],
    points: Points,
    names: Mapping[str, BodyName],
) -> Float[np.ndarray, "frames posture"]:
    """The motion [frames posture] with hands closed as the joints of their fingers are recorded.

    The fingers of this body bend as one, by the median of the recorded ones: at the knuckles by the
    direction of their first bone in the hand, at the middle joints by that of the second.
    """
    out = motion.copy()
    for side in SIDES:
        wrist = next((n for n, name in names.items() if name.place == f"{side}_hand"), None)
        if wrist is None:
            continue
        turns = geometry.rotations(human.sites(motion, [f"{side}_hand"])[f"{side}_hand"][1]).inv()
        flip = np.array([1.0, 1.0 if side == "right" else -1.0, 1.0])
        chains = _chains(points, names, side, points[wrist])
        thumb = chains.pop(THUMB, None)
        # Angles of the bones of each finger to the straight hand, towards the palm.
        bones = [
            [
                np.arctan2(bone[:, 1], -bone[:, 2])
                for start, end in pairwise(chain)
                for bone in [flip * turns.apply(points[end] - points[start])]
            ]
            for chain in chains.values()
        ]
        if not bones:
            continue
        angles = {"knuckle_flexion": np.median([bone[0] for bone in bones], axis=0)}
        if further := [bone[1] - bone[0] for bone in bones if len(bone) > 1]:
            angles["finger_flexion"] = np.median(further, axis=0)
        if thumb:
            way = flip * turns.apply(points[thumb[-1]] - points[thumb[0]])
            angles["thumb_opposition"] = np.arctan2(way[:, 1], way[:, 0]) - THUMB_AHEAD
        for hinge, angle in angles.items():
            seen = np.flatnonzero(np.isfinite(angle))
            if len(seen):
                index = human.index(f"{side}_{hinge}")
                everywhere = np.interp(np.arange(len(angle)), seen, angle[seen])
                out[:, index] = np.clip(everywhere, *human.ranges[index - ROOT_SIZE])
    return out


def _chains(
    points: Points, names: Mapping[str, BodyName], side: str, wrist: Float[np.ndarray, "frames 3"]
) -> dict[str, list[str]]:
    """By finger, two points of it or more, from the knuckle on, that begin on this hand."""
    away = {
        name: np.linalg.norm(points[name] - wrist, axis=1)
        for name, body in sorted(names.items())
        if without_side(body.place) in PLACES and body.side in (side, "none")
    }
    near = [name for name, metres in away.items() if np.nanmax(metres) < REACH_M]
    chains = {word: [n for n in near if word in n.lower()] for word in (*FINGERS, THUMB)}
    out = {
        word: chain
        for word, chain in chains.items()
        if len(chain) > 1 and np.nanstd(away[chain[0]]) < RIGID_M
    }
    begin = {word: float(np.nanmedian(away[chain[0]])) for word, chain in out.items()}
    thumb, fingers = begin.pop(THUMB, 0.0), list(begin.values())
    if thumb and (not fingers or thumb > THUMB_SHARE * float(np.median(fingers))):
        del out[THUMB]
    return out
