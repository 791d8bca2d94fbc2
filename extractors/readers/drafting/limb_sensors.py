"""Which markers of a body carry the sensors of its hands, feet and head."""

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from capar.model import geometry
from capar.model.errors import CaptureError
from extractors.readers.body_names.body_names import SIDES, BodyName, without_side
from extractors.readers.bundle.marker_fit import arrangement, fit_cluster
from extractors.readers.drafting.stance import Points, forwards, rightwards

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
