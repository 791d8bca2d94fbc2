"""The side of a limb that no name tells: that of the pelvis or trunk that it is nearer to."""

from collections.abc import Mapping
from dataclasses import replace

import numpy as np
from jaxtyping import Float

from extractors.readers.body_names.body_names import SIDES, BodyName, without_side
from extractors.readers.drafting.marker_sets import keeps_distance

LIMBS = {
    "pelvis": ("thigh", "shank", "foot"),
    "trunk": ("upper_arm", "forearm", "hand", "fingers"),
}
"""The parts of the limbs that hang on the pelvis and on the trunk, the nearest ones first."""


def sided(
    names: Mapping[str, BodyName], points: Mapping[str, Float[np.ndarray, "frames 3"]]
) -> dict[str, BodyName]:
    """Names of one limb that has no side, with the side of what its nearest part is nearer to."""
    out = _one_sided(names, points)
    for base, limb in LIMBS.items():
        parts = [each for each in out.values() if each.part in limb]
        bare = [each for each in parts if each.side == "none"]
        known = {each.side for each in parts} - {"none"}
        side = known.pop() if len(known) == 1 else ""
        if bare and len(bare) == len(parts):
            first = min(parts, key=lambda each: limb.index(each.part)).part
            own = [points[each.name] for each in parts if each.part == first]
            side = _nearer(out, points, base, own)
        if side:
            out |= {e.name: replace(e, place=f"{side}_{e.place}") for e in bare}
    return out


def _one_sided(
    names: Mapping[str, BodyName], points: Mapping[str, Float[np.ndarray, "frames 3"]]
) -> dict[str, BodyName]:
    """Names without the sides that are those of one hand or foot: ``hand_left``, ``hand_right``.

    The two hands never keep their distance, nor do the feet.
    """
    out = dict(names)
    for part in ("hand", "foot"):
        own = {side: [e for e in names.values() if (e.part, e.side) == (part, side)]
               for side in SIDES}  # fmt: skip
        pairs = [(a.name, b.name) for a in own["right"] for b in own["left"]]
        if pairs and all(keeps_distance(points[a], points[b]) for a, b in pairs):
            out |= {
                e.name: replace(e, place=without_side(e.place))
                for each in own.values()
                for e in each
            }
    return out


def _nearer(
    names: Mapping[str, BodyName],
    points: Mapping[str, Float[np.ndarray, "frames 3"]],
    base: str,
    own: list[Float[np.ndarray, "frames 3"]],
) -> str:
    """The side whose points of a part are nearer; an empty string if it has none with a side."""
    seen = [each for each in own if not np.isnan(each).all()]
    distance = {}
    for side in SIDES:
        others = [points[name] for name, e in names.items() if e.part == base and e.side == side]
        apart = [np.linalg.norm(a - b, axis=1) for a in seen for b in others]
        known = [float(np.nanmean(each)) for each in apart if not np.isnan(each).all()]
        if known:
            distance[side] = float(np.mean(known))
    return min(distance, key=lambda side: distance[side], default="")
