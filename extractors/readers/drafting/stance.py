"""How a person stands in a file: which axis points up, how tall the person is, which way it faces.

Evidence are the places of the body's parts, by their names: heads are above pelvises, pelvises
above feet, and people are 1.0 to 2.2 m tall.
"""

from collections.abc import Iterable, Mapping

import numpy as np
from jaxtyping import Float

from extractors.readers.body_names.body_names import BodyName, without_side
from extractors.readers.name_guesses import CLEAR, Standing
from extractors.readers.recording import Recording

Points = Mapping[str, Float[np.ndarray, "frames 3"]]

SPREAD = 0.25
"""Places tell how somebody stands if their usual heights differ by so much [share of stature]."""

BREADTH = ("trunk", "pelvis", "thigh", "upper_arm", "head")
"""Parts whose right and left lie beside each other, whatever hands and feet do."""


def points_of(recording: Recording) -> dict[str, Float[np.ndarray, "frames 3"]]:
    """Every joint and marker of a file, in its own unit and axes."""
    return {name: each.positions for name, each in recording.bodies.items()} | dict(
        recording.markers
    )


def mean_of(points: Points, names: Iterable[str]) -> Float[np.ndarray, "frames 3"]:
    """The mean of some points in every frame in which any of them is seen; else NaN."""
    stack = np.stack([points[name] for name in names])
    seen = ~np.isnan(stack).any(axis=2)
    total = np.where(seen[..., None], stack, 0.0).sum(axis=0)
    with np.errstate(invalid="ignore"):
        return np.asarray(total / np.where(seen.any(axis=0), seen.sum(axis=0), np.nan)[:, None])


def standing_by_parts(points: Points, names: Mapping[str, BodyName]) -> Standing | None:
    """How a person stands by the heights of the parts that are there; None if they do not tell.

    In each frame the places of joints and markers are fitted by a line over their usual heights;
    its slope is the vector from the ground to the top of the head.
    """
    groups: dict[float, list[str]] = {}
    for name, each in names.items():
        if each.height is not None:
            groups.setdefault(each.height, []).append(name)
    if len(groups) < 2:
        return None
    places = np.stack([mean_of(points, group) for group in groups.values()])
    way = _slopes(np.array(list(groups)), places)
    if way is None:
        return None
    axis = int(np.argmax(np.abs(way)))
    lengths = np.sort(np.abs(way))
    up = f"{'-' if way[axis] < 0.0 else ''}{'xyz'[axis]}"
    known = {names[name].part: None for group in groups.values() for name in group}
    evidence = f"by how high {_listed(known)} are the person is {lengths[2]:.4g} tall"
    return Standing(
        up, float(lengths[2]), bool(lengths[2] > CLEAR * lengths[1]), evidence, whole=True
    )


def _slopes(
    usual: Float[np.ndarray, "heights"], places: Float[np.ndarray, "heights frames 3"]
) -> Float[np.ndarray, "3"] | None:
    """The median over frames of the place's slope over usual height."""
    seen = ~np.isnan(places).any(axis=2)
    out = []
    for frame in range(places.shape[1]):
        heights = usual[seen[:, frame]]
        if len(heights) > 1 and np.ptp(heights) >= SPREAD:
            off = heights - heights.mean()
            out.append(off @ places[seen[:, frame], frame] / (off @ off))
    return np.median(out, axis=0) if out else None


def _listed(names: Iterable[str]) -> str:
    *most, last = names
    return f"{', '.join(most)} and {last}" if most else last


def rightwards(points: Points, names: Mapping[str, BodyName]) -> Float[np.ndarray, "frames 3"]:
    """From left to right through the body in each frame; NaN where it is not seen."""
    pairs: dict[str, dict[str, list[str]]] = {}
    for name, each in names.items():
        if each.part in BREADTH and each.side != "none":
            pairs.setdefault(without_side(each.place), {}).setdefault(each.side, []).append(name)
    ways = [
        mean_of(points, pair["right"]) - mean_of(points, pair["left"])
        for pair in pairs.values()
        if len(pair) == 2
    ]
    frames = len(next(iter(points.values())))
    if not ways:
        return np.full((frames, 3), np.nan)
    numbered = {str(number): way for number, way in enumerate(ways)}
    return mean_of(numbered, numbered)


def up_beside(points: Points, names: Mapping[str, BodyName]) -> tuple[str, str] | None:
    """The axis that points up, by the one along which right and left lie, with the evidence.

    Files have y or z up; the one of them that is not across the body is.
    """
    way = rightwards(points, names)
    way = way[~np.isnan(way).any(axis=1)]
    if not len(way):
        return None
    lengths = np.abs(np.median(way, axis=0))
    across = int(np.argmax(lengths))
    if across == 0 or lengths[across] < CLEAR * np.sort(lengths)[1]:
        return None
    up = "yz"[across == 1]
    return up, f"left and right lie along {'xyz'[across]}, and files have y or z up"


def forwards(rightward: Float[np.ndarray, "frames 3"]) -> Float[np.ndarray, "frames 3"]:
    """Unit vectors to where the body faces, level, in a world whose z axis points up."""
    level = np.stack([-rightward[:, 1], rightward[:, 0], np.zeros(len(rightward))], axis=1)
    length = np.linalg.norm(level, axis=1, keepdims=True)
    with np.errstate(invalid="ignore", divide="ignore"):
        return np.asarray(np.where(length > 0.0, level / length, np.nan))
