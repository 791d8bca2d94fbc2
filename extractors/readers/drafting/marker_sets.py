"""Sets of markers that are likely rigid bodies, by their names and distances."""

import re
from collections.abc import Mapping
from itertools import combinations

import numpy as np
from jaxtyping import Float

RIGID_M = 0.004
"""Markers whose distance varies less are of one rigid body [m]."""

NEAR_M = 0.5
"""And they are no further apart than this [m]."""

NAMED_NEAR_M = 2.0
"""... or than this, if their names begin with the same word [m]."""


def marker_sets(
    markers: Mapping[str, Float[np.ndarray, "frames 3"]],
) -> dict[str, list[str]]:
    """Sets of three or more markers that share a prefix or, among the rest, keep their distances.

    Positions are in metres.
    """
    sets: dict[str, list[str]] = {}
    for stem in (_prefix, _first_word):
        groups: dict[str, list[str]] = {}
        for name in _left(markers, sets):
            groups.setdefault(stem(name), []).append(name)
        for prefix, names in groups.items():
            for members in _rigid_sets(markers, names, NAMED_NEAR_M):
                sets[_numbered(prefix, sets)] = members
    for members in _rigid_sets(markers, _left(markers, sets), NEAR_M):
        sets[_numbered("markers_1", sets)] = members
    return sets


def _left(markers: Mapping[str, object], sets: Mapping[str, list[str]]) -> list[str]:
    """Markers that are in no set yet."""
    taken = {name for members in sets.values() for name in members}
    return [name for name in markers if name not in taken]


def _numbered(name: str, taken: Mapping[str, object]) -> str:
    """The name itself, or with the first number that nothing else has."""
    if name not in taken:
        return name
    stem = name.removesuffix("_1")
    return next(each for n in range(2, len(taken) + 3) if (each := f"{stem}_{n}") not in taken)


def _prefix(name: str) -> str:
    parts = re.split(r"[:_. ]", name)
    return parts[0] if len(parts) > 1 else re.sub(r"\d+$", "", name) or name


def _first_word(name: str) -> str:
    """The first word of a name whose words begin with capitals: ``WheelRearLeft``."""
    found = re.match(r"[A-Z]?[a-z]+", name)
    return found.group() if found else name


def _rigid_sets(
    markers: Mapping[str, Float[np.ndarray, "frames 3"]], names: list[str], near_m: float
) -> list[list[str]]:
    """Greedy sets of markers of which each keeps its distance to all the others."""
    rigid = {
        frozenset(pair)
        for pair in combinations(names, 2)
        if keeps_distance(markers[pair[0]], markers[pair[1]], near_m=near_m)
    }
    left, sets = list(names), []
    while left:
        members = [left[0]]
        for name in left[1:]:
            if all(frozenset((name, each)) in rigid for each in members):
                members.append(name)
        left = [each for each in left if each not in members]
        if len(members) >= 3:
            sets.append(members)
    return sets


def keeps_distance(
    first: Float[np.ndarray, "frames 3"],
    second: Float[np.ndarray, "frames 3"],
    *,
    near_m: float = NEAR_M,
    rigid_m: float = RIGID_M,
) -> bool:
    """Whether two markers are near each other and stay as far apart as they are."""
    apart = np.linalg.norm(first - second, axis=1)
    apart = apart[~np.isnan(apart)]
    if not apart.size or float(np.median(apart)) > near_m:
        return False
    low, high = np.quantile(apart, [0.05, 0.95])
    return bool(high - low < rigid_m)
