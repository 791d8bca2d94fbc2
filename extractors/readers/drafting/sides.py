"""The side of a limb that no name tells: that of the pelvis or trunk that it is nearer to."""

from collections.abc import Mapping
from dataclasses import replace

import numpy as np
from jaxtyping import Float

from extractors.readers.body_names.body_names import SIDES, BodyName

LIMBS = {
    "pelvis": ("thigh", "shank", "foot"),
    "trunk": ("upper_arm", "forearm", "hand", "fingers"),
}
"""The parts of the limbs that hang on the pelvis and on the trunk, the nearest ones first."""


def sided(
    names: Mapping[str, BodyName], points: Mapping[str, Float[np.ndarray, "frames 3"]]
) -> dict[str, BodyName]:
    """Names of one limb that has no side, with the side of what its nearest part is nearer to."""
    out = dict(names)
    for base, limb in LIMBS.items():
        parts = [each for each in names.values() if each.part in limb]
        if parts and all(each.side == "none" for each in parts):
            first = min(parts, key=lambda each: limb.index(each.part)).part
            own = [points[each.name] for each in parts if each.part == first]
            side = _nearer(names, points, base, own)
            if side:
                out |= {e.name: replace(e, place=f"{side}_{e.place}") for e in parts}
    return out


def _nearer(
    names: Mapping[str, BodyName],
    points: Mapping[str, Float[np.ndarray, "frames 3"]],
    base: str,
    own: list[Float[np.ndarray, "frames 3"]],
) -> str:
    """The side whose points of a part are nearer; an empty string if it does not have both."""
    seen = [each for each in own if not np.isnan(each).all()]
    distance = {}
    for side in SIDES:
        others = [points[name] for name, e in names.items() if e.part == base and e.side == side]
        apart = [np.linalg.norm(a - b, axis=1) for a in seen for b in others]
        known = [float(np.nanmean(each)) for each in apart if not np.isnan(each).all()]
        if known:
            distance[side] = float(np.mean(known))
    return min(distance, key=lambda side: distance[side]) if len(distance) == 2 else ""
