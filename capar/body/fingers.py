"""Fingers: how far hands are closed, by recorded joints or round a given width."""

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from jaxtyping import Float

from capar.body.human import Human
from capar.body.joint_fitting import RIGID_M
from capar.model import geometry
from capar.model.errors import CaparError
from extractors.readers.drafting.contents import Points
from extractors.readers.names import SIDES, BodyName, without_side

OPEN = {"knuckle_flexion": 0.0, "finger_flexion": 0.0, "thumb_opposition": 0.0}
"""Angles of an open hand [rad]."""

FIST = {"knuckle_flexion": 1.4, "finger_flexion": 1.6, "thumb_opposition": 1.0}
"""Angles of a closed hand [rad] (estimate)."""


class GraspError(CaparError):
    """A width that a hand cannot close round."""


def grasp(human: Human, side: str, width_m: float | None) -> dict[str, float]:
    """Angles of one hand's hinges [rad].

    Args:
        human: Whose hand.
        side: ``right`` or ``left``.
        width_m: What lies between finger and thumb tips [m]; None opens the hand.

    Raises:
        GraspError: The hand is too small for that width, or too large.
    """
    if width_m is None:
        return _angles(side, 0.0)
    grid = np.linspace(0.0, 1.0, 201)
    widths = _apertures(human, side, grid)
    closing = int(np.argmin(widths)) + 1
    if not widths[:closing].min() <= width_m <= widths[0]:
        raise GraspError(
            f"no grasp {width_m * 1000:.0f} mm wide; this hand closes round "
            f"{widths.min() * 1000:.0f} to {widths[0] * 1000:.0f} mm"
        )
    share = np.interp(width_m, widths[:closing][::-1], grid[:closing][::-1])
    return _angles(side, float(share))


def _angles(side: str, share: float) -> dict[str, float]:
    return {f"{side}_{n}": (1.0 - share) * OPEN[n] + share * FIST[n] for n in OPEN}


def _apertures(
    human: Human, side: str, shares: Float[np.ndarray, "shares"]
) -> Float[np.ndarray, "shares"]:
    """Distance between finger tip and thumb tip of a hand so far closed [m]."""
    postures = np.array([human.posture(_angles(side, float(share))) for share in shares])
    tips = (f"{side}_fingertip", f"{side}_thumb_tip")
    places = human.sites(postures, tips)
    return np.array(
        [
            np.linalg.norm(finger - thumb)
            for finger, thumb in zip(places[tips[0]][0], places[tips[1]][0], strict=True)
        ]
    )


FINGERS = ("index", "middle", "ring", "pinky", "little")
"""Words by which names tell whose joint a point is; those of one finger are in order of name."""

THUMB = "thumb"
PLACES = ("hand", "fingers", "thumb", "thumb_tip", "index_knuckle", "fifth_knuckle")
"""What names of joints of fingers are known as."""

REACH_M = 0.25
"""No joint of a finger is farther from the wrist than this [m]."""

THUMB_SHARE = 0.8
"""A thumb begins nearer to the wrist than this share of the fingers' distance [1]; else its name is
another finger's."""

THUMB_AHEAD = float(np.arctan2(0.15, 0.45))
"""Where the open thumb points about the hand's long axis, from forwards to the palm [rad]."""


@dataclass(frozen=True, eq=False)
class Closing:
    """How far the fingers of one hand are closed."""

    names: tuple[str, ...]
    """The recorded points by which."""

    angles: Mapping[str, Float[np.ndarray, "frames"]]
    """By hinge [rad], within its range."""


def closings(
    human: Human,
    motion: Float[np.ndarray, "frames posture"],
    points: Points,
    names: Mapping[str, BodyName],
) -> dict[str, Closing]:
    """How far hands are closed, by the side; those without recorded fingers are left out.

    The fingers of this body bend as one, by the median of the recorded ones: at the knuckles by the
    direction of their first bone in the hand, at the middle joints by that of the second against
    it. Fingers of which only knuckles are recorded tell nothing.

    Args:
        human: The body.
        motion: Its postures, hands turned as recorded.
        points: By name, in the world [m]; NaN where lost.
        names: What the names mean.
    """
    out = {}
    for side in SIDES:
        wrist = next((n for n, name in names.items() if name.place == f"{side}_hand"), None)
        if wrist is None:
            continue
        chains = _chains(points, names, side, points[wrist])
        fingers = [chain for word, chain in chains.items() if word != THUMB]
        turns = geometry.rotations(human.sites(motion, [f"{side}_hand"])[f"{side}_hand"][1]).inv()
        flip = np.array([1.0, 1.0 if side == "right" else -1.0, 1.0])
        bones = [
            [flip * turns.apply(points[end] - points[start]) for start, end in pairwise(chain)]
            for chain in fingers
        ]
        if not bones:
            continue
        knuckles = _median(_flexion(chain[0]) for chain in bones)
        angles = {f"{side}_knuckle_flexion": knuckles}
        further = [_flexion(chain[1]) - _flexion(chain[0]) for chain in bones if len(chain) > 1]
        if further:
            angles[f"{side}_finger_flexion"] = _median(further)
        if THUMB in chains:
            first, *_, last = chains[THUMB]
            way = flip * turns.apply(points[last] - points[first])
            angles[f"{side}_thumb_opposition"] = np.arctan2(way[:, 1], way[:, 0]) - THUMB_AHEAD
        known = {name: _everywhere(human, name, angle) for name, angle in angles.items()}
        used = tuple(name for chain in chains.values() for name in chain)
        out[side] = Closing(used, {name: angle for name, angle in known.items() if angle.size})
    return out


def with_closings(
    human: Human, motion: Float[np.ndarray, "frames posture"], hands: Mapping[str, Closing]
) -> Float[np.ndarray, "frames posture"]:
    """The same motion with hands so far closed."""
    out = motion.copy()
    for closing in hands.values():
        for hinge, angle in closing.angles.items():
            out[:, human.index(hinge)] = angle
    return out


def _chains(
    points: Points, names: Mapping[str, BodyName], side: str, wrist: Float[np.ndarray, "frames 3"]
) -> dict[str, list[str]]:
    """By finger, two points of it or more, from the knuckle on, that begin on this hand."""

    def away(name: str) -> Float[np.ndarray, "frames"]:
        return np.asarray(np.linalg.norm(points[name] - wrist, axis=1))

    out = {}
    for word in (*FINGERS, THUMB):
        chain = sorted(n for n, name in names.items() if _on_finger(n, name, word, side))
        chain = [name for name in chain if np.nanmax(away(name)) < REACH_M]
        if len(chain) > 1 and np.nanstd(away(chain[0])) < RIGID_M:
            out[word] = chain
    begin = {word: float(np.nanmedian(away(chain[0]))) for word, chain in out.items()}
    fingers = [metres for word, metres in begin.items() if word != THUMB]
    if THUMB in out and (not fingers or begin[THUMB] > THUMB_SHARE * float(np.median(fingers))):
        del out[THUMB]
    return out


def _on_finger(name: str, known: BodyName, word: str, side: str) -> bool:
    """Whether a name is that of a point on a finger, or on the thumb, of a side or of none."""
    on = without_side(known.place) in PLACES and known.side in (side, "none")
    return on and word in name.lower()


def _flexion(bone: Float[np.ndarray, "frames 3"]) -> Float[np.ndarray, "frames"]:
    """The angle of a finger's bone to the straight hand, towards the palm [rad]."""
    return np.asarray(np.arctan2(bone[:, 1], -bone[:, 2]))


def _median(angles: Iterable[Float[np.ndarray, "frames"]]) -> Float[np.ndarray, "frames"]:
    return np.asarray(np.median(np.stack(list(angles)), axis=0))


def _everywhere(
    human: Human, hinge: str, angle: Float[np.ndarray, "frames"]
) -> Float[np.ndarray, "frames"]:
    """An angle within its hinge's range, also where points were lost; empty if never seen."""
    seen = np.flatnonzero(np.isfinite(angle))
    if not len(seen):
        return np.zeros(0)
    low, high = human.ranges[human.joints.index(hinge)]
    return np.asarray(np.clip(np.interp(np.arange(len(angle)), seen, angle[seen]), low, high))
