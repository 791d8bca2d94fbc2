"""Guesses from names in a motion file: end-effectors, sides, and how a person stands."""

import re
from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from extractors.readers.recording import UNITS, Recording

HEIGHT_M = (0.85, 2.0)
"""How far the head's joint or markers are above the feet of people of 1.0 to 2.2 m [m]."""

USUAL_M = 1.4
"""That height of an adult of whom nothing is known [m]."""

STATURE_M = (1.0, 2.2)
"""How tall people are, from children of four years on [m]."""

USUAL_STATURE_M = 1.7
"""How tall an adult is of whom nothing is known [m]."""

CLEAR = 2.0
"""The upward axis is clear if the body is so many times longer along it than along another."""

LIMBS = {
    "hand": ("hand", "wrist", "palm", "main"),
    "head": ("head", "skull", "camera", "hmd"),
    "foot": ("foot", "ankle", "toe"),
}
"""Words in names by which end-effectors are known."""

PARTS = {
    "hand": ("hand", "wrist", "palm", "carpal", "metacarpal", "thumb", "index", "middle", "ring",
             "pinky", "little", "finger", "fingers", "fingertip", "fingertips"),
    "foot": ("foot", "ankle", "heel", "calcaneus", "instep", "midfoot", "sole", "forefoot",
             "toe", "toes"),
}  # fmt: skip
"""What hands and feet consist of, in the words of names; those that act for the whole first."""

AMBIGUOUS = {"index", "middle", "ring", "little"}
"""Words for fingers that name other things too."""

WHOLES = {"hand": ("hand", "wrist"), "foot": ("foot", "ankle")}
"""Words that name a hand or foot as a whole, and not a part of it."""

_SIDES = {
    "right": re.compile(
        r"right|(^|[_.\W])[rR]([_.\W]|$)|^r(?=[A-Z])|[a-z]Rt?$|^R(?=[A-Z_])|(?<=[a-z])R$|_r$"
    ),
    "left": re.compile(
        r"left|(^|[_.\W])[lL]([_.\W]|$)|^l(?=[A-Z])|[a-z]Lf?t?$|^L(?=[A-Z_])|(?<=[a-z])L$|_l$"
    ),
}


def limb_of(name: str) -> str:
    """The end-effector that a name mentions, or an empty string."""
    low = name.lower()
    return next((limb for limb, words in LIMBS.items() if any(w in low for w in words)), "")


def words_of(name: str) -> list[str]:
    """The words of a name, in lower case and without numbers: ``L_Index1`` has ``l``, ``index``."""
    parts = re.sub(r"(?<=[a-z0-9])(?=[A-Z])", "_", name)
    return [word for word in re.split(r"[^a-z]+", parts.lower()) if word]


def part_of(name: str) -> tuple[str, int] | None:
    """Which hand or foot a name is a part of, and how far from acting for it; None for no part.

    The palm stands before the fingers and the heel before the toes.
    """
    for limb, words in PARTS.items():
        ranks = [words.index(word) for word in words_of(name) if word in words]
        if ranks:
            return limb, min(ranks)
    return None


def limbs(names: Iterable[str]) -> dict[str, str]:
    """The bodies that are likely end-effectors or parts of one, each with its hand, foot or head.

    Words that mean other things too, such as ``ring``, count where the same side has another part
    of a hand.
    """
    out: dict[str, str] = {}
    doubtful = []
    for name in names:
        part = part_of(name) if side_of(name) != "none" else None
        if part and set(words_of(name)) & AMBIGUOUS and not limb_of(name):
            doubtful.append(name)
        elif limb := limb_of(name) or (part[0] if part else ""):
            out[name] = limb
    hands = {side_of(name) for name, limb in out.items() if limb == "hand"}
    return out | {name: "hand" for name in doubtful if side_of(name) in hands}


def side_of(name: str) -> str:
    """The side that a name mentions: ``right``, ``left`` or ``none``."""
    for side, pattern in _SIDES.items():
        if pattern.search(name) or side in name.lower():
            return side
    return "none"


def end_effectors(recording: Recording) -> dict[str, str]:
    """The bodies of a file that are likely end-effectors, and of which kind.

    In a skeleton these are the first joint of each hand, foot or head, not the fingers below it.
    """
    kinds = {name: limb_of(name) for name in recording.bodies}
    return {
        name: kind
        for name, kind in kinds.items()
        if kind and not any(kinds.get(each) == kind for each in _ancestors(recording, name))
    }


def _ancestors(recording: Recording, name: str) -> list[str]:
    out: list[str] = []
    while name in recording.parents and recording.parents[name] not in out:
        name = recording.parents[name]
        out.append(name)
    return out


@dataclass(frozen=True)
class Standing:
    """How a person stands in a recording, by the names of head and feet."""

    up: str
    """The axis from the feet to the head: ``z``, ``-y`` ..."""

    height: float
    """Median distance from the feet to the head along it, in the file's unit."""

    clear: bool
    """Whether the body is much longer along this axis than along the others."""

    evidence: str
    """What shows the height, in the file's unit."""

    whole: bool = False
    """Whether the height is the person's stature, not that of the head above the feet."""

    @property
    def what(self) -> str:
        """What has this height."""
        return "the person" if self.whole else "the head above the feet"

    @property
    def range_m(self) -> tuple[float, float]:
        """What this height is of people of 1.0 to 2.2 m [m]."""
        return STATURE_M if self.whole else HEIGHT_M

    def is_persons(self, unit_m: float) -> bool:
        """Whether somebody has this height in a unit [m]."""
        low, high = self.range_m
        return low <= self.height * unit_m <= high

    @property
    def unit(self) -> str:
        """The unit in which somebody has this height; empty if none makes it so."""
        return next((name for name in UNITS if self.is_persons(UNITS[name])), "")

    @property
    def scale_m(self) -> float:
        """Metres per unit with which the person has the usual height."""
        return (USUAL_STATURE_M if self.whole else USUAL_M) / self.height


def standing(recording: Recording) -> Standing | None:
    """How a person stands, if the file has a head and a foot by name."""
    points = {name: each.positions for name, each in recording.bodies.items()}
    points |= recording.markers
    ends: dict[str, list[Float[np.ndarray, "3"]]] = {"head": [], "foot": [], "hand": [], "": []}
    for name, places in points.items():
        if not np.isnan(places).all():
            ends[limb_of(name)].append(np.nanmedian(places, axis=0))
    if not ends["head"] or not ends["foot"]:
        return None
    way = np.mean(ends["head"], axis=0) - np.mean(ends["foot"], axis=0)
    axis = int(np.argmax(np.abs(way)))
    lengths = np.sort(np.abs(way))
    if not lengths[2] > 0.0:
        return None
    sign = "-" if way[axis] < 0.0 else ""
    clear = bool(lengths[2] > CLEAR * lengths[1])
    evidence = f"the head is {lengths[2]:.4g} above the feet"
    return Standing(f"{sign}{'xyz'[axis]}", float(lengths[2]), clear, evidence)
