"""Whole bodies in a capture's files: joints and markers that its sensors are only a part of."""

import time
from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from pathlib import Path

import numpy as np
from jaxtyping import Float

from capar.body.capture_fitting import fit_capture
from capar.body.finger_postures import closings, with_closings
from capar.body.fit_remarks import remarks
from capar.body.fitting import Fit
from capar.body.joint_fitting import fit_joints
from capar.body.marker_fitting import LEAST_EXACT, fit_markers
from capar.body.object_remarks import corners_of, is_floor, object_remarks
from capar.body.posture_remarks import posture_remarks
from capar.body.recording_remarks import (
    closed_hands,
    passing_legs,
    recorded_feet,
    recorded_spine,
    stand_off,
)
from capar.body.skeleton_fitting import SkeletonFit
from capar.model import geometry
from capar.model.capture import Capture
from extractors.readers.body_names.body_names import BY_WORDS, BodyName, body_names
from extractors.readers.body_names.conventions import (
    ConventionError,
    conventions,
    coverage,
    recognise,
)
from extractors.readers.bundle.capture_toml import files_of
from extractors.readers.drafting.sides import sided

LEAST_JOINTS = 0.6
"""Bodies are the joints of a skeleton if a convention has so many of its places among them [1]."""


@dataclass(frozen=True, eq=False)
class Places:
    """Joints and markers of one body on one clock."""

    times: Float[np.ndarray, "frames"]
    """In the capture's time [s]."""

    points: dict[str, Float[np.ndarray, "frames 3"]]
    """In the world [m]."""

    names: dict[str, BodyName]

    stated: Mapping[str, str] = field(default_factory=dict)
    """Places on the body that the capture itself states."""

    faces: Float[np.ndarray, "frames 3"] | None = None
    """Where the face looks, as a direction in the world [1]; None where it is not known."""


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
            stated = {name: place for name, place in file.places.items() if name in points}
            kept = {name: points[name] for name in {**names, **stated}}
            best = Places(times - start_s, kept, names, stated)
    return best


def _places_it(names: dict[str, BodyName], markers: set[str]) -> bool:
    """Whether enough names are of a body's markers, or of its joints by a convention.

    Trackers that are strapped on are called by words that are in conventions too, such as
    ``right_hand`` and ``right_knee``; but by few of each.
    """
    known = {each.place for name, each in names.items() if name in markers}
    if len(known) >= LEAST_EXACT:
        return True
    joints = {each.place for name, each in names.items() if each.by != BY_WORDS}
    shares = coverage(name for name in names if name not in markers)
    return len(known | joints) >= LEAST_EXACT and max(shares.values()) >= LEAST_JOINTS


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
    if found is None:
        return fit_capture(capture)
    seen = replace(found, faces=_faces(capture, found.times))
    return fit_places(seen, ground_m=ground(capture))


def _faces(
    capture: Capture, times: Float[np.ndarray, "frames"]
) -> Float[np.ndarray, "frames 3"] | None:
    """Where the performer's face looks at times, by the sensor of the head; None without one."""
    for sensor in capture.sensors:
        if sensor.end_effector == "head" and capture.agent_of(sensor) == capture.agent.name:
            nearest = np.abs(capture.times[None] - times[:, None]).argmin(axis=1)
            out = np.full((len(times), 3), np.nan)
            turns = sensor.stream.orientations[nearest]
            known = np.isfinite(turns).all(axis=1)
            ahead = np.array(sensor.gaze) / np.linalg.norm(sensor.gaze)
            out[known] = geometry.rotations(turns[known]).apply(ahead)
            return out
    return None


def remarks_on(place: str | Path, capture: Capture, made: Fit) -> list[str]:
    """What a reader of the fitted body's pictures asks about.

    Args:
        place: Where the capture is described.
        capture: The same, read.
        made: The body fitted to it.

    Raises:
        CaparError: As of ``fit_body``.
    """
    found = whole_body(place)
    said = [*remarks(made, capture, ground(capture)), *_stretching(capture)]
    said += posture_remarks(made, capture) + object_remarks(made, capture) + passing_legs(made)
    if found is not None:
        hands = closings(made.human, made.motion, found.points, found.names)
        said += closed_hands(made, hands)
        said += recorded_spine(made, found.points) + recorded_feet(made, found.points)
        said += stand_off(made, found.names)
    return said


def _stretching(capture: Capture) -> list[str]:
    """The notices of bones that change their length, of which views draw no shape."""
    told = [one.message for one in capture.notices if one.code == "bone-stretches"]
    return [f"{text}; views draw its body as a point" for text in dict.fromkeys(told)]


def ground(capture: Capture) -> float | None:
    """Height of the lowest level floor that a capture has, as wide as one [m]."""
    tops = []
    for thing in capture.objects:
        corners = corners_of(thing)
        if len(corners) and is_floor(thing, corners):
            tops.append(float(corners[:, 2].max()))
    return min(tops, default=None)


def fit_places(found: Places, *, ground_m: float | None = None) -> Fit:
    """The body fitted to joints or markers.

    Args:
        found: Where they are.
        ground_m: Height of the ground on which feet stand, where it is known [m].
    """
    began = time.perf_counter()
    made = _skeleton(found, ground_m)
    hands = closings(made.human, made.motion, found.points, found.names)
    motion = with_closings(made.human, made.motion, hands)
    seconds = time.perf_counter() - began
    lost = {name: np.isnan(found.points[name]).any(axis=1) for name in made.residuals_m}
    return Fit(made.human, found.times, motion, lost, made.residuals_m, {}, seconds, made.segments)


def _skeleton(found: Places, ground_m: float | None) -> SkeletonFit:
    """By the convention of a skeleton, where there are joints only; else by places of markers."""
    titles = {each.title for each in conventions().values() if each.markers}
    if not any(each.by in titles for each in found.names.values()):
        try:
            return fit_joints(
                found.points,
                recognise(found.names),
                ground_m=ground_m,
                stated=found.stated,
                faces=found.faces,
            )
        except ConventionError:
            pass
    return fit_markers(found.points, found.names, ground_m=ground_m).skeleton
