"""What is of a body in a file: its parts, sides, stance, floor, marker sets and sensors."""

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
    CLEAR,
    SIDES,
    BodyName,
    Standing,
    body_names,
    computed,
    conventions,
    standing,
    without_side,
)
from extractors.readers.recording import Recording

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


LEAST_PARTS = 3
"""A body is in a file if so many of its parts have a joint or marker."""

RIDING_M = 0.020
"""The distance of two markers on the skin of one segment varies by no more than this [m]."""

SEGMENT_M = 0.3
"""... and they are no further apart than this [m]."""

FIXED_M = 0.02
"""What never goes further than this from where it usually is does not move [m]."""


@dataclass(frozen=True, eq=False)
class Contents:
    """A file's names, sorted into a body's and others."""

    recording: Recording
    body: Mapping[str, BodyName]
    """What is of a body; empty where too few parts of one are there."""

    standing: Standing | None
    beside: tuple[str, str] | None
    """The axis that points up by left and right, and the evidence."""

    @property
    def usual_units_m(self) -> list[float]:
        """Units that the conventions of its names use without stating them [m]."""
        titles = {each.by for each in self.body.values()}
        return [unit for c in conventions().values() if c.title in titles for unit in c.units_m]

    @property
    def subjects(self) -> list[str]:
        """Whose bodies are in it."""
        return list(dict.fromkeys(each.subject for each in self.body.values()))


def contents(recording: Recording) -> Contents:
    """What of a file is of a body."""
    points = points_of(recording)
    metres = {name: each * (recording.unit_m or 1.0) for name, each in points.items()}
    found = sided(body_names([*recording.bodies, *recording.markers]), metres)
    if len({each.part for each in found.values()}) < LEAST_PARTS or not _one_clock(points):
        return Contents(recording, {}, standing(recording), None)
    stands = standing(recording)
    if stands is None or not stands.clear:
        stands = standing_by_parts(points, found) or stands
    return Contents(recording, found, stands, up_beside(points, found))


def _one_clock(points: Mapping[str, Float[np.ndarray, "frames 3"]]) -> bool:
    return len({len(each) for each in points.values()}) == 1


def world_points(
    recording: Recording, unit_m: float, up: str
) -> dict[str, Float[np.ndarray, "frames 3"]]:
    """Joints and markers in metres with z up."""
    turn = upward(up)
    return {name: turn.apply(each * unit_m) for name, each in points_of(recording).items()}


@dataclass(frozen=True)
class Others:
    """Markers that are of no body by their names."""

    sets: Mapping[str, list[str]]
    """Sets that keep their distances, by a name."""

    fixed: frozenset[str]
    """Those of the sets that never move."""

    riding: Mapping[str, str]
    """Markers that keep their distance to a part of the body, and which part."""

    unseen: tuple[str, ...]
    computed: tuple[str, ...]
    loose: tuple[str, ...]


def others(
    markers: Mapping[str, Float[np.ndarray, "frames 3"]], body: Mapping[str, BodyName]
) -> Others:
    """What the markers are that no name tells to be of a body.

    Args:
        markers: In metres.
        body: Those that are of a body.
    """
    unseen = [name for name, each in markers.items() if np.isnan(each).all()]
    made = computed(name for name in markers if name not in unseen)
    left = [n for n in markers if n not in body and n not in unseen and n not in made]
    sets = marker_sets({name: markers[name] for name in left})
    taken = {name for members in sets.values() for name in members}
    single = [name for name in left if name not in taken]
    riding = {name: part for name in single if (part := _carrier(name, markers, body))}
    return Others(
        sets={_set_name(name, members): members for name, members in sets.items()},
        fixed=frozenset(
            _set_name(name, members) for name, members in sets.items() if _stays(markers, members)
        ),
        riding=riding,
        unseen=tuple(unseen),
        computed=tuple(made),
        loose=tuple(name for name in single if name not in riding),
    )


def _carrier(
    name: str,
    markers: Mapping[str, Float[np.ndarray, "frames 3"]],
    body: Mapping[str, BodyName],
) -> str:
    """The part of the body to two of whose markers a marker keeps its distance."""
    near: dict[str, int] = {}
    for other, each in body.items():
        if other in markers and keeps_distance(
            markers[name], markers[other], near_m=SEGMENT_M, rigid_m=RIDING_M
        ):
            part = f"{each.side} {each.part}".removeprefix("none ")
            near[part] = near.get(part, 0) + 1
    best = max(near, key=lambda part: near[part], default="")
    return best if near.get(best, 0) >= 2 else ""


def _set_name(name: str, members: Iterable[str]) -> str:
    """The beginning that all members' names share, or the set's own name."""
    first, *rest = members
    length = 0
    while length < len(first) and all(each[: length + 1] == first[: length + 1] for each in rest):
        length += 1
    shared = first[:length].rstrip(":_. 0123456789")
    return shared if len(shared) > 2 else name


def _stays(markers: Mapping[str, Float[np.ndarray, "frames 3"]], members: Iterable[str]) -> bool:
    for name in members:
        places = markers[name][~np.isnan(markers[name]).any(axis=1)]
        if np.abs(places - np.median(places, axis=0)).max() > FIXED_M:
            return False
    return True


STANDING_MPS = 0.25
"""A foot's lowest point that is slower than this stands [m/s]."""

LOW_M = 0.05
"""... if it is no higher above the lowest than this [m]: a foot may be held still in the air."""

SHARES = (0.05, 0.95)
"""The range in which feet stand is between these shares of their frames [1]."""

TOLERANCE_M = (0.010, 0.040)
"""The least and largest tolerance of contact that a floor is drafted with [m]."""

MARGIN_M = 1.0
"""How far the floor goes beyond where feet are [m]."""

THICK_M = 0.02
RADIUS_M = 0.03
"""Radius of a foot's stand-in: half the thickness of a foot [m]."""


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
        low, high = TOLERANCE_M
        return float(np.clip(np.ceil(200 * self.spread_m) / 200, low, high))


def floor(
    points: Points, feet: Mapping[str, Sequence[str]], rate_hz: float, radius_m: float = RADIUS_M
) -> Floor:
    """The floor under some feet.

    Args:
        points: In the world: metres, z up.
        feet: The points of each foot.
        rate_hz: Frames a second.
        radius_m: How far the surface of a foot's stand-in is from its points.
    """
    standing = [_standing_heights(points, names, rate_hz) for names in feet.values()]
    heights = np.concatenate(standing)
    rests = bool(heights.size)
    if not rests:
        heights = np.array([np.nanmin(points[n][:, 2]) for group in feet.values() for n in group])
    heights = heights[heights <= heights.min() + (LOW_M if rests else 0.0)]
    low, high = np.quantile(heights, SHARES)
    ground = np.concatenate([points[name] for names in feet.values() for name in names])
    ground = ground[~np.isnan(ground).any(axis=1), :2]
    first, last = ground.min(axis=0) - MARGIN_M, ground.max(axis=0) + MARGIN_M
    (x, y), (long, wide) = (first + last) / 2, last - first
    return Floor(
        float(low) - radius_m,
        float(high - low),
        (float(x), float(y)),
        (float(long), float(wide)),
        rests,
    )


def _standing_heights(
    points: Points, names: Sequence[str], rate_hz: float
) -> Float[np.ndarray, "frames"]:
    """Heights of a foot's lowest point in the frames in which it stands [m]."""
    stack = np.stack([points[name] for name in names])
    heights = np.where(np.isnan(stack[..., 2]), np.inf, stack[..., 2])
    lowest = np.argmin(heights, axis=0)
    frames = np.arange(stack.shape[1])
    speeds = np.full(stack.shape[:2], np.inf)
    speeds[:, 1:] = np.linalg.norm(np.diff(stack, axis=1), axis=2) * rate_hz
    own = speeds[lowest, frames]
    height = heights[lowest, frames]
    return height[np.isfinite(height) & (np.nan_to_num(own, nan=np.inf) <= STANDING_MPS)]


SEEN_SHARE = 0.4
"""A marker seen in a smaller share of the frames than the one of its limb that is seen most often
is left out: it would blind the whole sensor [1]."""

RESIDUAL_M = 0.010
"""Median distance of markers from a rigid arrangement that needs no word [m]."""

LOOSE_M = 0.030
"""Markers that leave their arrangement further than this are of no one segment [m]."""

STRETCH = 1.5
"""The stated limit is the measured residual times this [1]."""

STAGES: Mapping[str, Sequence[Sequence[str]]] = {
    "hand": (
        ("hand",),
        ("wrist_radial", "wrist_ulnar"),
        ("forearm",),
        ("elbow", "elbow_lateral", "elbow_medial"),
    ),
    "foot": (("foot",), ("ankle_lateral", "ankle_medial"), ("shank",)),
    "head": (("head",),),
}
"""Parts and places whose markers carry an end-effector's sensor, the next ones where there are
fewer than three: the joint beside it, then the segment next to it."""

BENDS = ("toe_tip", "toes", "fingertip", "fingers")
"""Places that bend against the rest of the foot or hand."""


@dataclass(frozen=True, eq=False)
class LimbSensor:
    """A sensor to draft: an end-effector and the markers that carry it."""

    limb: str
    side: str
    subject: str
    markers: tuple[str, ...]
    own: tuple[str, ...]
    """Those of them that are on the end-effector itself or the joint beside it."""

    residual_m: float | None
    """A limit for the markers' residual, where the usual one is too narrow [m]."""

    gaze: tuple[float, float, float] | None
    """Forwards, in the sensor's frame, where it is known."""

    @property
    def borrowed(self) -> bool:
        """Whether it rides on the segment beside it."""
        return len(self.own) < len(self.markers)


def limb_sensors(points: Points, names: Mapping[str, BodyName]) -> Iterator[LimbSensor]:
    """The sensors of a body's hands, feet and head that three or more markers carry.

    Args:
        points: Markers in the world: metres, z up.
        names: What their names mean.
    """
    for subject in dict.fromkeys(each.subject for each in names.values()):
        own = {name: each for name, each in names.items() if each.subject == subject}
        for limb, stages in STAGES.items():
            for side in (*SIDES, "none"):
                sided = own if limb == "head" else _of_side(own, side)
                if limb == "head" and side != "none":
                    continue
                found = _sensor(points, sided, own, limb, stages)
                if found is not None:
                    markers, near, residual_m = found
                    gaze = _gaze(points, own, markers) if limb == "head" else None
                    yield LimbSensor(limb, side, subject, markers, near, residual_m, gaze)


def _of_side(names: Mapping[str, BodyName], side: str) -> dict[str, BodyName]:
    return {name: each for name, each in names.items() if each.side == side}


def _sensor(
    points: Points,
    sided: Mapping[str, BodyName],
    everything: Mapping[str, BodyName],
    limb: str,
    stages: Sequence[Sequence[str]],
) -> tuple[tuple[str, ...], tuple[str, ...], float | None] | None:
    """Markers, those near the end-effector, and a limit for their residual."""
    markers: list[str] = []
    near: list[str] = []
    for number, stage in enumerate(stages):
        added = [n for n, each in sided.items() if _is_of(each, stage) and n not in markers]
        markers += added
        if number < 2:
            near += added
        if not near:
            continue
        chosen = _often_seen(points, markers)
        for group in (_unbent(chosen, everything), chosen):
            residual_m = _residual(points, group)
            if residual_m is not None and residual_m <= LOOSE_M:
                limit = None if residual_m <= RESIDUAL_M else np.ceil(200 * STRETCH * residual_m)
                kept = tuple(name for name in near if name in group)
                return tuple(group), kept, None if limit is None else float(limit) / 200
    return None


def _is_of(each: BodyName, stage: Iterable[str]) -> bool:
    place = without_side(each.place)
    return each.part in stage or place in stage


def _unbent(group: Sequence[str], names: Mapping[str, BodyName]) -> list[str]:
    return [name for name in group if without_side(names[name].place) not in BENDS]


def _often_seen(points: Points, names: Iterable[str]) -> list[str]:
    counts = {name: int((~np.isnan(points[name]).any(axis=1)).sum()) for name in names}
    most = max(counts.values(), default=0)
    return [name for name, count in counts.items() if count and count >= SEEN_SHARE * most]


def _residual(points: Points, names: Sequence[str]) -> float | None:
    """How far markers leave a rigid arrangement, in the median [m]; None if they are of none."""
    if len(names) < 3:
        return None
    markers = {name: points[name] for name in names}
    try:
        cluster = arrangement("draft", markers)
    except CaptureError:
        return None
    fit = fit_cluster(cluster, np.stack(list(markers.values()), axis=1))
    known = fit.residuals[~np.isnan(fit.residuals)]
    return float(np.median(known)) if known.size else None


def _gaze(
    points: Points, names: Mapping[str, BodyName], markers: Sequence[str]
) -> tuple[float, float, float] | None:
    """Forwards in the frame of a marker set, in the mean."""
    group = {name: points[name] for name in markers}
    fit = fit_cluster(arrangement("draft", group), np.stack(list(group.values()), axis=1))
    return mean_forward(fit.orientations, forwards(rightwards(points, names)))


def mean_forward(
    orientations: Float[np.ndarray, "frames 4"], ways: Float[np.ndarray, "frames 3"]
) -> tuple[float, float, float] | None:
    """Where the body faces as a direction in a sensor's frame, in the mean."""
    both = ~(np.isnan(orientations).any(axis=1) | np.isnan(ways).any(axis=1))
    if not both.any():
        return None
    inner = geometry.rotations(orientations[both]).inv().apply(ways[both]).mean(axis=0)
    length = float(np.linalg.norm(inner))
    if length < 0.5:
        return None
    x, y, z = (round(float(each), 3) + 0.0 for each in inner / length)
    return x, y, z
