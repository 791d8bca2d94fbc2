"""The body fitted to all that a capture holds of its performer, and its parts to be touched."""

import time
from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from pathlib import Path

import numpy as np
from jaxtyping import Bool, Float, Int
from scipy.spatial.transform import RigidTransform

from capar.body.fingers import closings, with_closings
from capar.body.fit_warnings import (
    closed_hands,
    corners_of,
    is_floor,
    object_remarks,
    passing_legs,
    posture_remarks,
    recorded_feet,
    recorded_spine,
    remarks,
    stand_off,
)
from capar.body.joint_fitting import fit_joints
from capar.body.marker_fitting import LEAST_EXACT, fit_markers
from capar.body.point_fitting import SkeletonFit
from capar.body.recording import HAND_SEGMENTS
from capar.body.sensor_fitting import Fit, fit_capture
from capar.body.shapes import segment_surface
from capar.model import geometry
from capar.model.capture import Capture, Sensor, Shape, Stream, TagObject, TagType
from extractors.readers.bundle.capture_toml import files_of
from extractors.readers.drafting.contents import sided
from extractors.readers.names import (
    BY_WORDS,
    SIDES,
    BodyName,
    ConventionError,
    body_names,
    conventions,
    coverage,
    recognise,
)

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


FEET = {f"{side}_foot": (f"{side}_foot", f"{side}_toes") for side in SIDES}
"""Feet with the segments that their surfaces are of."""

HEAD = {"head": ("head",)}
"""The same of the head, of which the mouth is a part."""

HANDS = {f"{side}_hand": tuple(f"{side}_{name}" for name in HAND_SEGMENTS) for side in SIDES}
"""The same of hands."""

FITTED_M = 0.01
"""Surfaces of a fitted body count as touching up to this distance at least [m]: they are off by as
much as its limb lengths and the places of its sensors are, some millimetres."""


def with_body_parts(capture: Capture, made: Fit) -> Capture:
    """The capture with parts of its performer's body as things to touch.

    The head and the feet become SELF objects, unless the capture has an object of that name, an
    end-effector is there, or nothing of them was recorded. Hands without a shape get that of the
    fitted body. The tolerance of contact is then ``FITTED_M`` or larger.

    Args:
        capture: What was recorded.
        made: The body fitted to it.
    """
    nearest = np.abs(made.times[None] - capture.times[:, None]).argmin(axis=1)
    taken = {thing.name for thing in capture.objects} | {
        _place(sensor) for sensor in capture.acting if _is_own(capture, sensor)
    }
    parts = {name: segments for name, segments in (HEAD | FEET).items() if name not in taken}
    unseen = set(made.unrecorded)
    added = [
        _part(capture, made, name, segments, nearest)
        for name, segments in parts.items()
        if name not in unseen
    ]
    sensors = tuple(_with_surface(capture, made, sensor, nearest) for sensor in capture.sensors)
    shaped = sensors != capture.sensors or bool(added)
    tolerance = max(capture.contact_tolerance_m or 0.0, FITTED_M) if shaped else None
    return replace(
        capture,
        sensors=sensors,
        objects=(*capture.objects, *added),
        contact_tolerance_m=tolerance or capture.contact_tolerance_m,
    )


def _is_own(capture: Capture, sensor: Sensor) -> bool:
    """Whether a sensor rides on the first agent's body, which is the fitted one."""
    return capture.agent_of(sensor) == capture.agent.name


def _place(sensor: Sensor) -> str:
    """The place that a sensor's end-effector is: ``right_hand``, ``head``."""
    side = "" if sensor.side == "none" else f"{sensor.side}_"
    return f"{side}{sensor.end_effector}"


def _part(
    capture: Capture,
    made: Fit,
    name: str,
    segments: tuple[str, ...],
    nearest: Int[np.ndarray, "frames"],
) -> TagObject:
    """A part of the body that is touched; with the sensor of its name where there is one."""
    surface = segment_surface(made.human.measures, segments, name)
    worn = next((sensor for sensor in capture.sensors if sensor.name == name), None)
    if worn is not None:
        moved = _in_frame(made, name, worn.stream, nearest)
        return TagObject(name, TagType.SELF, worn.stream, _moved(surface, moved), name)
    spots, turns = made.human.sites(made.motion, [name])[name]
    lost = _lost(made)[nearest][:, None]
    stream = Stream(
        times=capture.times,
        positions=np.where(lost, np.nan, spots[nearest]),
        orientations=np.where(lost, np.nan, turns[nearest]),
    )
    kind = name.rpartition("_")[2]
    return TagObject(name, TagType.SELF, stream, surface, kind, agent=capture.agent.name)


def _with_surface(
    capture: Capture, made: Fit, sensor: Sensor, nearest: Int[np.ndarray, "frames"]
) -> Sensor:
    """A hand with the fitted body's surface, where it has none of its own."""
    place = _place(sensor)
    if (
        sensor.shape is not None
        or sensor.part_of
        or place not in HANDS
        or not _is_own(capture, sensor)
    ):
        return sensor
    surface = segment_surface(made.human.measures, HANDS[place], place)
    moved = _in_frame(made, place, sensor.stream, nearest)
    return replace(sensor, shape=_moved(surface, moved))


def _in_frame(
    made: Fit, segment: str, stream: Stream, nearest: Int[np.ndarray, "frames"]
) -> RigidTransform:
    """A segment in the frame of what rides on it: mean turn, median place of all frames."""
    spots, turns = (rows[nearest] for rows in made.human.sites(made.motion, [segment])[segment])
    known = ~stream.lost & ~_lost(made)[nearest]
    worn = geometry.transforms(stream.positions[known], stream.orientations[known])
    relative = worn.inv() * geometry.transforms(spots[known], turns[known])
    middle: Float[np.ndarray, "3"] = np.median(relative.translation, axis=0)
    return RigidTransform.from_components(middle, relative.rotation.mean())


def _lost(made: Fit) -> Bool[np.ndarray, "frames"]:
    """Frames in which nothing that the body follows is seen."""
    if not made.bridged:
        return np.zeros(len(made.times), dtype=bool)
    return np.asarray(np.all([*made.bridged.values()], axis=0))


def _moved(shape: Shape, pose: RigidTransform) -> Shape:
    return Shape(pose.apply(shape.vertices), np.array(shape.faces), description=shape.description)
