"""Whole bodies in a capture's files: joints and markers that its sensors are only a part of."""

import time
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from jaxtyping import Float

from capar.body.capture_fitting import fit_capture
from capar.body.fitting import Fit
from capar.body.marker_fitting import LEAST_EXACT, fit_markers
from capar.body.skeleton_fitting import SkeletonFit, fit_skeleton
from capar.model.capture import Capture
from extractors.readers.body_names.body_names import BY_WORDS, BodyName, body_names
from extractors.readers.body_names.conventions import (
    ConventionError,
    conventions,
    recognise,
)
from extractors.readers.bundle.capture_toml import files_of
from extractors.readers.drafting.sides import sided


@dataclass(frozen=True, eq=False)
class Places:
    """Joints and markers of one body on one clock."""

    times: Float[np.ndarray, "frames"]
    """In the capture's time [s]."""

    points: dict[str, Float[np.ndarray, "frames 3"]]
    """In the world [m]."""

    names: dict[str, BodyName]


def whole_body(place: str | Path) -> Places | None:
    """The joints or markers of the body that most names of a capture's files are of.

    None if there are too few of a body at known places.
    """
    best: Places | None = None
    files, start_s = files_of(place)
    for file in files.values():
        points = {name: each.positions for name, each in file.bodies.items()} | dict(file.markers)
        if len({len(each) for each in points.values()}) != 1:
            continue
        found = sided(body_names(points), points)
        subjects = [each.subject for each in found.values()]
        first = max(dict.fromkeys(subjects), key=subjects.count, default="")
        names = {name: each for name, each in found.items() if each.subject == first}
        times = file.marker_times if file.markers else next(iter(file.bodies.values())).times
        if _places_it(names, set(file.markers)) and (best is None or len(names) > len(best.names)):
            best = Places(times - start_s, {name: points[name] for name in names}, names)
    return best


def _places_it(names: dict[str, BodyName], markers: set[str]) -> bool:
    """Whether enough names are of a body's markers, or of its joints by a convention.

    Words alone do not tell joints from trackers that are strapped on.
    """
    known = {e.place for name, e in names.items() if name in markers or e.by != BY_WORDS}
    return len(known) >= LEAST_EXACT


def fit_body(place: str | Path, capture: Capture) -> Fit:
    """The body of a capture's performer, fitted to all that its files hold of it.

    Joints and markers of a whole body are followed where there are any; else the sensors are.

    Args:
        place: Where the capture is described.
        capture: The same, read.

    Raises:
        CaparError: Neither joints, markers nor sensors place a body.
    """
    found = whole_body(place)
    return fit_capture(capture) if found is None else fit_places(found)


def fit_places(found: Places) -> Fit:
    """The body fitted to joints or markers."""
    began = time.perf_counter()
    made = _skeleton(found)
    seconds = time.perf_counter() - began
    lost = {name: np.isnan(found.points[name]).any(axis=1) for name in made.residuals_m}
    return Fit(made.human, found.times, made.motion, lost, made.residuals_m, {}, seconds)


def _skeleton(found: Places) -> SkeletonFit:
    """By the convention of a skeleton, where there are joints only; else by places of markers."""
    titles = {each.title for each in conventions().values() if each.markers}
    if not any(each.by in titles for each in found.names.values()):
        try:
            return fit_skeleton(found.points, recognise(found.names))
        except ConventionError:
            pass
    return fit_markers(found.points, found.names).skeleton
