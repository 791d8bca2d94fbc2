"""What is of a body and what is not in a file that a capture.toml is drafted for."""

from collections.abc import Iterable, Mapping
from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from capar.model.capture import upward
from extractors.readers.body_names.body_names import BodyName, body_names, computed
from extractors.readers.body_names.conventions import conventions
from extractors.readers.drafting.marker_sets import keeps_distance, marker_sets
from extractors.readers.drafting.sides import sided
from extractors.readers.drafting.stance import points_of, standing_by_parts, up_beside
from extractors.readers.name_guesses import Standing, standing
from extractors.readers.recording import Recording

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
