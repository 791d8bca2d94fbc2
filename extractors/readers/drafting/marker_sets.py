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


def marker_sets(
    markers: Mapping[str, Float[np.ndarray, "frames 3"]],
) -> dict[str, list[str]]:
    """Sets of three or more markers that share a prefix or, among the rest, keep their distances.

    Positions are in metres.
    """
    groups: dict[str, list[str]] = {}
    for name in markers:
        groups.setdefault(_prefix(name), []).append(name)
    sets: dict[str, list[str]] = {}
    for prefix, names in groups.items():
        for index, members in enumerate(_rigid_sets(markers, names)):
            sets[prefix if index == 0 else f"{prefix}_{index + 1}"] = members
    taken = {name for members in sets.values() for name in members}
    for index, members in enumerate(_rigid_sets(markers, [n for n in markers if n not in taken])):
        sets[f"markers_{index + 1}"] = members
    return sets


def _prefix(name: str) -> str:
    parts = re.split(r"[:_. ]", name)
    return parts[0] if len(parts) > 1 else re.sub(r"\d+$", "", name) or name


def _rigid_sets(
    markers: Mapping[str, Float[np.ndarray, "frames 3"]], names: list[str]
) -> list[list[str]]:
    """Greedy sets of markers of which each keeps its distance to all the others."""
    rigid = {
        frozenset(pair)
        for pair in combinations(names, 2)
        if keeps_distance(markers[pair[0]], markers[pair[1]])
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
    first: Float[np.ndarray, "frames 3"], second: Float[np.ndarray, "frames 3"]
) -> bool:
    """Whether two markers are near each other and stay as far apart as they are."""
    apart = np.linalg.norm(first - second, axis=1)
    apart = apart[~np.isnan(apart)]
    if not apart.size or float(np.median(apart)) > NEAR_M:
        return False
    low, high = np.quantile(apart, [0.05, 0.95])
    return bool(high - low < RIGID_M)
