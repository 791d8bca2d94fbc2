"""What readers of a fitted body's pictures ask about the recording: its spine, feet and markers."""

from collections.abc import Mapping
from itertools import combinations, pairwise

import numpy as np
from jaxtyping import Float
from scipy.spatial.transform import Rotation

from capar.body.fit_remarks import FAR_M, SPINE
from capar.body.fitting import Fit
from extractors.readers.body_names.body_names import SIDES, BodyName

TILTED = 8.0
"""A line between recorded points of a foot that lies steeper than this to its sole is reported
[degrees]."""

Points = Mapping[str, Float[np.ndarray, "frames 3"]]


def recorded_spine(made: Fit, points: Points) -> list[str]:
    """What is said of a recorded spine that bends more than this body's can.

    Args:
        made: The body fitted to it.
        points: What was followed, in the world [m]; NaN where lost.
    """
    order = ("pelvis", *SPINE, "neck")
    on = {part: [name for name, own in made.segments.items() if own == part] for part in order}
    chain = [names[0] for names in on.values() if names]
    if len(chain) < 3 or max(map(len, on.values())) > 1:  # several on a segment: markers
        return []
    links = [points[below] - points[above] for above, below in pairwise(chain)]
    own = max(np.degrees(made.human.ranges[made.human.index(f"{n}_flexion") - 7, 1]) for n in SPINE)
    out = []
    for name, (first, second) in zip(chain[1:], pairwise(links), strict=False):
        turn = np.degrees(_angle(first, second))
        if np.nanmax(turn) > 2.0 * own:
            at = made.times[int(np.nanargmax(turn))]
            out.append(
                f"the recorded spine bends by up to {np.nanmax(turn):.0f} degrees at {name}, at "
                f"{at:.2f} s; no joint of this body's spine bends by more than {own:.0f}"
            )
    return out


def recorded_feet(made: Fit, points: Points) -> list[str]:
    """At what angles to the soles the lines between the recorded points of feet lie.

    Views draw such lines as bars, and they are not the soles.

    Args:
        made: The body fitted to them.
        points: What was followed, in the world [m]; NaN where lost.
    """
    out = []
    for side in SIDES:
        on = (f"{side}_foot", f"{side}_toes")
        names = [name for name, segment in made.segments.items() if segment in on]
        if len(names) < 2:
            continue
        turns = made.human.sites(made.motion, on[:1])[on[0]][1]
        back = Rotation.from_quat(turns, scalar_first=True).inv()
        tilts = {}
        for first, second in combinations(names, 2):
            way = back.apply(points[second] - points[first])
            tilts[first, second] = np.degrees(np.arctan2(way[:, 2], np.hypot(*way[:, :2].T)))
        pair = max(tilts, key=lambda one: abs(np.nanmedian(tilts[one])))
        up = np.sign(np.nanmedian(tilts[pair]))
        low, middle, high = np.nanquantile(up * tilts[pair], [0.05, 0.5, 0.95])
        if middle > TILTED:
            out.append(
                f"the line from {pair[0]} to {pair[1]} is not the {side} sole: it lies at "
                f"{middle:.0f} degrees to it in the median ({low:.0f} to {high:.0f} "
                "in nine of ten frames)"
            )
    return out


def stand_off(made: Fit, names: Mapping[str, BodyName]) -> list[str]:
    """Markers that ride far from the landmarks that they are named after, the worst of each part.

    Args:
        made: The body fitted to them, with a site for each.
        names: What their names mean.
    """
    model = made.human.model
    sites = {model.site(number).name: number for number in range(model.nsite)}
    apart: dict[str, tuple[float, str]] = {}
    for name, segment in made.segments.items():
        own = sites.get(f"marker_{name}")
        usual = sites.get(names[name].place) if name in names and names[name].exact else None
        if own is not None and usual is not None:
            metres = float(np.linalg.norm(model.site_pos[own] - model.site_pos[usual]))
            same = model.site_bodyid[own] == model.site_bodyid[usual]
            if same and metres > FAR_M:
                apart[segment] = max(apart.get(segment, (0.0, "")), (metres, name))
    return [
        f"{name} rides {1e3 * metres:.0f} mm from where this body has that landmark on its "
        f"{segment.replace('_', ' ')}; distances from its place on the body do not contain that"
        for segment, (metres, name) in apart.items()
    ]


def _angle(
    first: Float[np.ndarray, "frames 3"], second: Float[np.ndarray, "frames 3"]
) -> Float[np.ndarray, "frames"]:
    """The angle between two directions [rad]."""
    lengths = np.linalg.norm(first, axis=1) * np.linalg.norm(second, axis=1)
    return np.asarray(np.arccos(np.clip((first * second).sum(axis=1) / lengths, -1.0, 1.0)))
