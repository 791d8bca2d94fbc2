"""What is of a body in a file: its parts, sides, stance, floor, marker sets and sensors.

How a person stands is found by the places of the body's parts, by their names: heads are above
pelvises, pelvises above feet, and people are 1.0 to 2.2 m tall.
"""

import re
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import combinations

import numpy as np
from jaxtyping import Float

from capar.model import geometry
from capar.model.capture import upward
from capar.model.errors import CaptureError
from extractors.readers.bundle.bodies import arrangement, fit_cluster
from extractors.readers.names import (
    SIDES,
    BodyName,
    body_names,
    computed,
    conventions,
    without_side,
)
from extractors.readers.recording import UNITS, Recording

Track = Float[np.ndarray, "frames 3"]
Points = Mapping[str, Track]

RIGID_M = 0.004  # Markers whose distance varies less are of one rigid body [m].
NEAR_M, NAMED_NEAR_M = 0.5, 2.0
"""And they are no further apart than this [m]; the latter if their names begin alike."""

RIDING_M, SEGMENT_M = 0.020, 0.3
"""The distance of two markers on the skin of one segment varies by no more than the former, and is
no more than the latter [m]."""

FIXED_M = 0.02  # What never goes further than this from where it usually is does not move [m].
LEAST_PARTS = 3
"""A body is in a file if so many of its parts have a joint or marker, or a hand has a marker."""

STATURE_M = (1.0, 2.2)  # How tall people are, from children of four years on [m].
USUAL_STATURE_M = 1.7  # How tall an adult is of whom nothing is known [m].
CLEAR = 2.0
"""An axis is clear if the body is so many times longer along it than along another."""

HANGING = {
    "pelvis": ("thigh", "shank", "foot"),
    "trunk": ("upper_arm", "forearm", "hand", "fingers"),
}
"""The parts of the limbs that hang on the pelvis and on the trunk, the nearest ones first."""

SPREAD = 0.25
"""Places show how somebody stands if their usual heights differ by so much [share of stature]."""

BREADTH = ("trunk", "pelvis", "thigh", "upper_arm", "head")
"""Parts whose right and left lie next to each other, whatever hands and feet do."""

STANDING_MPS = 0.25  # A foot's lowest point that is slower than this stands [m/s].
LOW_M = 0.05
"""... if it is no higher above the lowest than this [m]: a foot may be held still in the air."""

SHARES = (0.05, 0.95)  # The range in which feet stand is between these shares of their frames [1].
TOLERANCE_M = (0.010, 0.040)
"""The least and largest tolerance of contact that a floor is drafted with [m]."""

MARGIN_M = 1.0  # How far the floor goes beyond where feet are [m].
SEEN_SHARE = 0.4
"""A marker seen in a smaller share of the frames than the one of its limb that is seen most often
is left out: it would blind the whole sensor [1]."""

RESIDUAL_M, LOOSE_M = 0.010, 0.030
"""Median distances of markers from a rigid arrangement: the usual limit, and what no segment has
[m]."""

STRETCH = 1.5  # The stated limit is the measured residual times this [1].

STAGES: Mapping[str, Sequence[Sequence[str]]] = {
    "hand": (
        ("hand",),
        ("wrist_radial", "wrist_ulnar"),
        ("forearm",),
        ("elbow", "elbow_lateral", "elbow_medial"),
        ("fingers",),
    ),
    "foot": (("foot",), ("ankle_lateral", "ankle_medial"), ("shank",)),
    "head": (("head",),),
}
"""Parts and places whose markers carry an end-effector's sensor, the next ones where there are
fewer than three: the joint next to it, then the segment next to it; the fingers of a hand last."""

BENDS = ("toe_tip", "toes", "fingertip", "fingers")
"""Places that bend against the rest of the foot or hand."""


@dataclass(frozen=True)
class Standing:
    """How a person stands in a recording."""

    up: str
    """The axis from the feet to the head: ``z``, ``-y`` ..."""

    height: float
    """Stature, in the file's unit."""

    clear: bool
    """Whether the body is much longer along this axis than along the others."""

    parts: Sequence[str]
    """The parts of the body by whose heights it is known."""

    def is_persons(self, unit_m: float) -> bool:
        """Whether somebody has this height in a unit [m]."""
        return STATURE_M[0] <= self.height * unit_m <= STATURE_M[1]

    @property
    def unit(self) -> str:
        """The unit in which somebody has this height; empty if none makes it so."""
        return next((name for name in UNITS if self.is_persons(UNITS[name])), "")


@dataclass(frozen=True, eq=False)
class Contents:
    """A file's names, sorted into a body's and others."""

    recording: Recording
    body: Mapping[str, BodyName]
    """What is of a body; empty where too few parts of one are there."""

    standing: Standing | None = None
    beside: str | None = None
    """The axis along which left and right lie, where it is y or z."""


def contents(recording: Recording) -> Contents:
    """What of a file is of a body."""
    points = _points(recording)
    metres = {name: each * (recording.unit_m or 1.0) for name, each in points.items()}
    found = sided(body_names([*recording.bodies, *recording.markers]), metres)
    clocks = {len(each) for each in points.values()}
    hand = any(
        e.part == "hand" and e.side != "none" for n, e in found.items() if n in recording.markers
    )
    few = len({each.part for each in found.values()}) < LEAST_PARTS
    if (few and not hand) or len(clocks) != 1:
        return Contents(recording, {})
    across, beside = rightwards(points, found), None
    across = across[~np.isnan(across).any(axis=1)]
    if len(across):
        lengths = np.abs(np.median(across, axis=0))
        axis = int(np.argmax(lengths))
        if axis and lengths[axis] >= CLEAR * np.sort(lengths)[1]:
            beside = "xyz"[axis]
    return Contents(recording, found, standing_by_parts(points, found), beside)


def usual_units_m(body: Mapping[str, BodyName]) -> list[float]:
    """Units that the conventions of a body's names use without stating them [m]."""
    titles = {each.by for each in body.values()}
    return [unit for c in conventions().values() if c.title in titles for unit in c.units_m]


def _points(recording: Recording) -> dict[str, Track]:
    """Every joint and marker of a file, in its own unit and axes."""
    bodies = {name: each.positions for name, each in recording.bodies.items()}
    return bodies | dict(recording.markers)


def world_points(recording: Recording, unit_m: float, up: str) -> dict[str, Track]:
    """Joints and markers in metres with z up."""
    turn = upward(up)
    return {name: turn.apply(each * unit_m) for name, each in _points(recording).items()}


def keeps_distance(
    first: Track, second: Track, *, near_m: float = NEAR_M, rigid_m: float = RIGID_M
) -> bool:
    """Whether two markers are near each other and stay as far apart as they are."""
    apart = np.linalg.norm(first - second, axis=1)
    apart = apart[~np.isnan(apart)]
    if not apart.size or float(np.median(apart)) > near_m:
        return False
    low, high = np.quantile(apart, [0.05, 0.95])
    return bool(high - low < rigid_m)


def _marker_sets(markers: Points) -> dict[str, list[str]]:
    """Sets of three or more markers that keep their distances, by a name.

    They share a prefix or a first word, or are near each other. Positions are in metres.
    """

    def prefix(name: str) -> str:
        parts = re.split(r"[:_. ]", name)
        return parts[0] if len(parts) > 1 else re.sub(r"\d+$", "", name) or name

    def first_word(name: str) -> str:
        """``Wheel`` of ``WheelRearLeft``."""
        found = re.match(r"[A-Z]?[a-z]+", name)
        return found.group() if found else name

    sets: dict[str, list[str]] = {}
    for stem, near_m in ((prefix, NAMED_NEAR_M), (first_word, NAMED_NEAR_M), (None, NEAR_M)):
        taken = {name for members in sets.values() for name in members}
        groups: dict[str, list[str]] = {}
        for name in markers:
            if name not in taken:
                groups.setdefault(stem(name) if stem else "markers", []).append(name)
        for start, names in groups.items():
            for members in _rigid_sets(markers, names, near_m):
                shared = members[0]
                while not all(each.startswith(shared) for each in members):
                    shared = shared[:-1]
                shared = shared.rstrip(":_. 0123456789")
                subject, _, rest = shared.partition(":")
                if len(rest) == 1 or rest.lower() == subject.lower():
                    shared = subject  # ``Box`` of ``Box:B1``, ``Box:BOX1``
                name = shared if len(shared) > 2 else start if stem else "markers_1"
                numbered = (f"{name.removesuffix('_1')}_{n}" for n in range(2, len(sets) + 3))
                free = (each for each in (name, *numbered) if each not in sets)
                sets[next(free)] = members
    return sets


def _rigid_sets(markers: Points, names: list[str], near_m: float) -> list[list[str]]:
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


@dataclass(frozen=True)
class Others:
    """Markers that are of no body by their names."""

    sets: Mapping[str, list[str]]
    """Sets that keep their distances, by a name."""

    fixed: frozenset[str]
    """Those of the sets that never move."""

    riding: Mapping[str, str]
    """Markers that keep their distance to a part of the body, and which part."""

    unseen: Sequence[str]
    computed: Sequence[str]
    loose: Sequence[str]


def others(markers: Points, body: Mapping[str, BodyName]) -> Others:
    """What the markers are that by their names are of no body.

    Args:
        markers: In metres.
        body: Those that are of a body.
    """
    unseen = [name for name, each in markers.items() if np.isnan(each).all()]
    made = computed(name for name in markers if name not in unseen)
    left = [n for n in markers if n not in body and n not in unseen and n not in made]
    sets = _marker_sets({name: markers[name] for name in left})
    taken = {name for members in sets.values() for name in members}
    single = [name for name in left if name not in taken]
    riding = {name: part for name in single if (part := _carrier(name, markers, body))}

    def stays(name: str) -> bool:
        places = markers[name][~np.isnan(markers[name]).any(axis=1)]
        return bool(np.abs(places - np.median(places, axis=0)).max() <= FIXED_M)

    fixed = frozenset(name for name, members in sets.items() if all(map(stays, members)))
    loose = [name for name in single if name not in riding]
    return Others(sets, fixed, riding, unseen, made, loose)


def _carrier(name: str, markers: Points, body: Mapping[str, BodyName]) -> str:
    """The part of the body to two of whose markers a marker keeps its distance."""
    near = [
        f"{each.side} {each.part}".removeprefix("none ")
        for other, each in body.items()
        if other in markers
        and keeps_distance(markers[name], markers[other], near_m=SEGMENT_M, rigid_m=RIDING_M)
    ]
    best = max(near, key=near.count, default="")
    return best if near.count(best) >= 2 else ""


def sided(names: Mapping[str, BodyName], points: Points) -> dict[str, BodyName]:
    """Names of a limb without a side, with that side of the pelvis or trunk which it is nearer to.

    The two hands never keep their distance, nor do the feet: sides in the names of one hand or foot
    (``hand_left``, ``hand_right``) are no sides of the body.
    """
    out = dict(names)
    for part in ("hand", "foot"):
        own = [each for each in names.values() if each.part == part and each.side != "none"]
        pairs = [(a, b) for a in own for b in own if (a.side, b.side) == ("right", "left")]
        if pairs and all(keeps_distance(points[a.name], points[b.name]) for a, b in pairs):
            out |= {each.name: replace(each, place=without_side(each.place)) for each in own}
    for base, limb in HANGING.items():
        parts = [each for each in out.values() if each.part in limb]
        bare = [each for each in parts if each.side == "none"]
        known = {each.side for each in parts} - {"none"}
        side = known.pop() if len(known) == 1 else ""
        if bare and len(bare) == len(parts):
            first = min(parts, key=lambda each: limb.index(each.part)).part
            own_tracks = [points[each.name] for each in parts if each.part == first]
            side = _nearer(out, points, base, own_tracks)
        if side:
            out |= {e.name: replace(e, place=f"{side}_{e.place}") for e in bare}
    return out


def _nearer(names: Mapping[str, BodyName], points: Points, base: str, own: list[Track]) -> str:
    """The side whose points of a part are nearer; an empty string if it has none with a side."""
    seen = [each for each in own if not np.isnan(each).all()]
    distance = {}
    for side in SIDES:
        theirs = [points[name] for name, e in names.items() if e.part == base and e.side == side]
        apart = [np.linalg.norm(a - b, axis=1) for a in seen for b in theirs]
        known = [float(np.nanmean(each)) for each in apart if not np.isnan(each).all()]
        if known:
            distance[side] = float(np.mean(known))
    return min(distance, key=lambda side: distance[side], default="")


def mean_of(points: Points, names: Iterable[str]) -> Track:
    """The mean of some points in every frame in which any of them is seen; else NaN."""
    stack = np.stack([points[name] for name in names])
    seen = ~np.isnan(stack).any(axis=2)
    total = np.where(seen[..., None], stack, 0.0).sum(axis=0)
    with np.errstate(invalid="ignore"):
        return np.asarray(total / np.where(seen.any(axis=0), seen.sum(axis=0), np.nan)[:, None])


def standing_by_parts(points: Points, names: Mapping[str, BodyName]) -> Standing | None:
    """How a person stands by the heights of the parts that are there; None if they do not show it.

    In each frame the places of joints and markers are fitted by a line over their usual heights;
    its slope is the vector from the ground to the top of the head.
    """
    groups: dict[float, list[str]] = {}
    for name, each in names.items():
        if each.height is not None:
            groups.setdefault(each.height, []).append(name)
    if len(groups) < 2:
        return None
    usual = np.array(list(groups))
    places = np.stack([mean_of(points, group) for group in groups.values()])
    seen = ~np.isnan(places).any(axis=2)
    slopes = []
    for frame in range(places.shape[1]):
        heights = usual[seen[:, frame]]
        if len(heights) > 1 and np.ptp(heights) >= SPREAD:
            off = heights - heights.mean()
            slopes.append(off @ places[seen[:, frame], frame] / (off @ off))
    if not slopes:
        return None
    slope = np.median(slopes, axis=0)
    axis, lengths = int(np.argmax(np.abs(slope))), np.sort(np.abs(slope))
    up = f"{'-' if slope[axis] < 0.0 else ''}{'xyz'[axis]}"
    parts = list(dict.fromkeys(names[name].part for group in groups.values() for name in group))
    return Standing(up, float(lengths[2]), bool(lengths[2] > CLEAR * lengths[1]), parts)


def rightwards(points: Points, names: Mapping[str, BodyName]) -> Track:
    """From left to right through the body in each frame; NaN where it is not seen."""
    pairs: dict[str, dict[str, list[str]]] = {}
    for name, each in names.items():
        if each.part in BREADTH and each.side != "none":
            pairs.setdefault(without_side(each.place), {}).setdefault(each.side, []).append(name)
    across = {
        place: mean_of(points, pair["right"]) - mean_of(points, pair["left"])
        for place, pair in pairs.items()
        if len(pair) == 2
    }
    if not across:
        return np.full((len(next(iter(points.values()))), 3), np.nan)
    return mean_of(across, across)


def forwards(rightward: Track) -> Track:
    """Unit vectors to where the body faces, level, in a world whose z axis points up."""
    level = np.stack([-rightward[:, 1], rightward[:, 0], np.zeros(len(rightward))], axis=1)
    length = np.linalg.norm(level, axis=1, keepdims=True)
    with np.errstate(invalid="ignore", divide="ignore"):
        return np.asarray(np.where(length > 0.0, level / length, np.nan))


@dataclass(frozen=True)
class Floor:
    """A level floor under the feet."""

    top_m: float
    """Height of its surface [m]."""

    spread_m: float
    """Range of heights at which feet stand [m]."""

    middle: tuple[float, float]
    size: tuple[float, float]
    """Where it is and how large, along x and y [m]."""

    rests: bool
    """Whether any foot stands; else the floor is under the lowest point of a foot."""

    @property
    def tolerance_m(self) -> float:
        """Distance at which feet touch it: what their heights differ by [m]."""
        return float(np.clip(np.ceil(200 * self.spread_m) / 200, *TOLERANCE_M))


def floor(
    points: Points, feet: Mapping[str, Sequence[str]], rate_hz: float, radius_m: float
) -> Floor:
    """The floor under some feet: where their lowest points are slow, or the lowest of all.

    Args:
        points: In the world: metres, z up.
        feet: The points of each foot.
        rate_hz: Frames a second.
        radius_m: How far the surface of a foot's stand-in is from its points.
    """
    standing, ground = [], []
    for names in feet.values():
        stack = np.stack([points[name] for name in names])
        heights = np.where(np.isnan(stack[..., 2]), np.inf, stack[..., 2])
        lowest, frames = np.argmin(heights, axis=0), np.arange(stack.shape[1])
        speeds = np.full(stack.shape[:2], np.inf)
        speeds[:, 1:] = np.linalg.norm(np.diff(stack, axis=1), axis=2) * rate_hz
        own, height = speeds[lowest, frames], heights[lowest, frames]
        standing.append(height[np.isfinite(height) & (own <= STANDING_MPS)])
        ground.append(stack.reshape(-1, 3))
    seen = np.concatenate(ground)
    seen = seen[~np.isnan(seen).any(axis=1)]
    rested = np.concatenate(standing)
    rests = bool(rested.size)
    heights = rested[rested <= rested.min() + LOW_M] if rests else seen[:, 2].min(keepdims=True)
    low, high = np.quantile(heights, SHARES)
    first, last = seen[:, :2].min(axis=0) - MARGIN_M, seen[:, :2].max(axis=0) + MARGIN_M
    (x, y), (long, wide) = ((first + last) / 2).tolist(), (last - first).tolist()
    return Floor(float(low) - radius_m, float(high - low), (x, y), (long, wide), rests)


@dataclass(frozen=True, eq=False)
class LimbSensor:
    """A sensor to draft: an end-effector and the markers that carry it."""

    limb: str
    side: str
    subject: str
    markers: tuple[str, ...]
    own: tuple[str, ...]
    """Those of them that are on the end-effector itself or the joint next to it."""

    residual_m: float | None
    """A limit for the markers' residual, where the usual one is too narrow [m]."""

    gaze: tuple[float, float, float] | None
    """Forwards, in the sensor's frame, where it is known."""


def limb_sensors(points: Points, names: Mapping[str, BodyName]) -> Iterator[LimbSensor]:
    """The sensors of a body's hands, feet and head that three or more markers carry.

    A hand that has fewer is carried by the one of its own markers that is seen most often.

    Args:
        points: Markers in the world: metres, z up.
        names: What their names mean.
    """
    for subject in dict.fromkeys(each.subject for each in names.values()):
        own = {name: each for name, each in names.items() if each.subject == subject}
        for limb, stages in STAGES.items():
            for side in ("none",) if limb == "head" else (*SIDES, "none"):
                of_side = own
                if limb != "head":
                    of_side = {n: each for n, each in own.items() if each.side == side}
                found = _carriers(points, of_side, stages)
                own_hand = [n for n, e in of_side.items() if side in SIDES and e.part == "hand"]
                if found is None and limb == "hand" and own_hand:
                    best = max(own_hand, key=lambda n: int((~np.isnan(points[n])).sum()))
                    found = (best,), (best,), None
                if found is None:
                    continue
                gaze = None
                if limb == "head":
                    cluster = arrangement("draft", {name: points[name] for name in found[0]})
                    group = np.stack([points[name] for name in found[0]], axis=1)
                    turns = fit_cluster(cluster, group).orientations
                    gaze = mean_forward(turns, forwards(rightwards(points, own)))
                yield LimbSensor(limb, side, subject, *found, gaze)


def _carriers(
    points: Points, names: Mapping[str, BodyName], stages: Sequence[Sequence[str]]
) -> tuple[tuple[str, ...], tuple[str, ...], float | None] | None:
    """Markers, those near the end-effector, and a limit for their residual."""
    markers: list[str] = []
    near: list[str] = []
    places = {name: without_side(each.place) for name, each in names.items()}
    for number, stage in enumerate(stages):
        added = [n for n, each in names.items() if each.part in stage or places[n] in stage]
        markers += [name for name in added if name not in markers]
        near = [*markers] if number < 2 else near
        if not near:
            continue
        counts = {name: int((~np.isnan(points[name]).any(axis=1)).sum()) for name in markers}
        least = max(1.0, SEEN_SHARE * max(counts.values()))
        chosen = [name for name, count in counts.items() if count >= least]
        for group in ([name for name in chosen if places[name] not in BENDS], chosen):
            residual_m = _residual(points, group)
            if residual_m is not None and residual_m <= LOOSE_M:
                limit = float(np.ceil(200 * STRETCH * residual_m)) / 200
                own = tuple(name for name in near if name in group)
                return tuple(group), own, limit if residual_m > RESIDUAL_M else None
    return None


def _residual(points: Points, names: Sequence[str]) -> float | None:
    """How far markers leave a rigid arrangement, in the median [m]; None if they are of none."""
    if len(names) < 3:
        return None
    try:
        cluster = arrangement("draft", {name: points[name] for name in names})
    except CaptureError:
        return None
    fit = fit_cluster(cluster, np.stack([points[name] for name in names], axis=1))
    known = fit.residuals[~np.isnan(fit.residuals)]
    return float(np.median(known)) if known.size else None


def mean_forward(
    orientations: Float[np.ndarray, "frames 4"], directions: Track
) -> tuple[float, float, float] | None:
    """Where the body faces as a direction in a sensor's frame, in the mean."""
    both = ~(np.isnan(orientations).any(axis=1) | np.isnan(directions).any(axis=1))
    if not both.any():
        return None
    inner = geometry.rotations(orientations[both]).inv().apply(directions[both]).mean(axis=0)
    length = float(np.linalg.norm(inner))
    if length < 0.5:
        return None
    x, y, z = (round(float(each), 3) + 0.0 for each in inner / length)
    return x, y, z
