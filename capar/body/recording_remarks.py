"""What readers of a fitted body's pictures ask about the recording: its spine, feet and markers."""

from collections.abc import Mapping
from itertools import combinations, pairwise

import numpy as np
from jaxtyping import Float
from scipy.spatial.transform import Rotation

from capar.body.finger_postures import Closing
from capar.body.fit_remarks import FAR_M, SPINE, listed
from capar.body.fitting import Fit
from extractors.readers.body_names.body_names import SIDES, BodyName

TILTED = 8.0
"""A line between recorded points of a foot that lies steeper than this to its sole is reported
[degrees]."""

STEP_M, LEAST_STEPS, MOST_STEPS = 0.15, 2, 8
"""Legs pass each other where one foot is so far ahead [m] before, and the other after; fewer such
times are no walk, and no more of them are named."""

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
    return [f"{listed(out)}, so that one end stands off the drawn foot"] if out else []


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
    told = [
        f"{name} by {1e3 * metres:.0f} mm ({segment.replace('_', ' ')})"
        for segment, (metres, name) in sorted(apart.items(), key=lambda one: -one[1][0])
    ]
    if not told:
        return []
    return [
        "markers or joints that ride aside from where this body has the landmarks of their names, "
        f"the worst of each part: {', '.join(told)}; distances from their places on the body do "
        "not contain that"
    ]


def passing_legs(made: Fit) -> list[str]:
    """When the legs of somebody who walks pass each other, and how near the ankles are then.

    Args:
        made: The body, both of whose feet were followed.
    """
    feet = [f"{side}_foot" for side in SIDES]
    if set(feet) & set(made.unrecorded):
        return []
    where = made.human.sites(made.motion, [*feet, "pelvis"])
    ahead = Rotation.from_quat(where["pelvis"][1], scalar_first=True).apply([1.0, 0.0, 0.0])
    apart = where[feet[0]][0] - where[feet[1]][0]
    along = (apart * ahead)[:, :2].sum(axis=1)
    crossings = np.flatnonzero(np.diff(np.sign(along)) != 0)
    between = np.split(np.abs(along), crossings + 1)
    steps = [
        frame
        for frame, before, after in zip(crossings, between, between[1:], strict=False)
        if before.max() > STEP_M and after.max() > STEP_M
    ]
    if len(steps) < LEAST_STEPS:
        return []
    metres = np.linalg.norm(apart[steps], axis=1)
    knees = np.degrees(
        [made.motion[steps, made.human.index(f"{side}_knee_flexion")] for side in SIDES]
    )
    times = [f"{made.times[frame]:.2f}" for frame in steps]
    more = [f"{len(times) - MOST_STEPS} more times"] if len(times) > MOST_STEPS else []
    return [
        f"the legs pass each other at {listed([*times[:MOST_STEPS], *more])} s: the ankles are "
        f"then {1e3 * metres.min():.0f} to {1e3 * metres.max():.0f} mm apart, as recorded, one "
        f"knee bent by {knees.min(axis=0).min():.0f} to {knees.min(axis=0).max():.0f} degrees and "
        f"the other by {knees.max(axis=0).min():.0f} to {knees.max(axis=0).max():.0f}; from "
        "aside one leg hides the other"
    ]


def closed_hands(made: Fit, hands: Mapping[str, Closing]) -> list[str]:
    """How far hands are closed by their recorded fingers, or that these are not recorded.

    Args:
        made: The body.
        hands: What is known of them, by the side.
    """
    seen = [side for side in SIDES if f"{side}_hand" not in made.unrecorded]
    told, out = [], []
    for side in (side for side in seen if side in hands):
        bent = [
            float(np.degrees(np.median(made.motion[:, made.human.index(f"{side}_{hinge}")])))
            for hinge in ("knuckle_flexion", "finger_flexion")
        ]
        names = hands[side].names
        told.append(
            f"of the {side} hand by {bent[0]:.0f} degrees at the knuckles and {bent[1]:.0f} beyond "
            f"in the median ({names[0]} to {names[-1]})"
        )
    if told:
        out.append(f"fingers, which bend as one, are bent as recorded: {listed(told)}")
    without = [f"{side} hand" for side in seen if side not in hands]
    if without:
        out.append(
            f"no fingers are recorded of the {listed(without)}: they are drawn straight, whatever "
            "they hold"
        )
    return out


def _angle(
    first: Float[np.ndarray, "frames 3"], second: Float[np.ndarray, "frames 3"]
) -> Float[np.ndarray, "frames"]:
    """The angle between two directions [rad]."""
    lengths = np.linalg.norm(first, axis=1) * np.linalg.norm(second, axis=1)
    return np.asarray(np.arccos(np.clip((first * second).sum(axis=1) / lengths, -1.0, 1.0)))
