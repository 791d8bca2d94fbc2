"""The body fitted to all that a capture holds of its performer, and its parts to be touched."""

import time
from collections.abc import Mapping
from contextlib import suppress
from dataclasses import dataclass, field, replace
from pathlib import Path

import numpy as np
from jaxtyping import Bool, Float, Int
from scipy.spatial.transform import RigidTransform

from capar.body.fingers import closed_hands
from capar.body.joint_fitting import fit_joints
from capar.body.marker_fitting import LEAST_EXACT, fit_markers
from capar.body.point_fitting import PointFit
from capar.body.recording import HAND_SEGMENTS
from capar.body.sensor_fitting import Fit, fit_capture
from capar.body.shapes import moved, segment_surface
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

#: Bodies are the joints of a skeleton if a convention has so many of its places among them [1]
LEAST_JOINTS = 0.6
#: A fixed object as wide as this both ways, and no thicker, is a floor [m]
FLOOR_M, FLOOR_THICK_M = 1.5, 0.3
#: Residuals, and heights of the lower sole above the floor in the median, that are reported [m];
#: how many names a warning lists
FAR_M, FLOATING_M, MOST_NAMES = 0.03, 0.03, 10
TOUCHED = {"head": ("head",), **{f"{s}_foot": (f"{s}_foot", f"{s}_toes") for s in SIDES}}
#: Parts of the body that are touched, and hands, with the segments that their surfaces are of
HANDS = {f"{side}_hand": tuple(f"{side}_{name}" for name in HAND_SEGMENTS) for side in SIDES}
#: Surfaces of a fitted body count as touching up to this distance at least [m]: they are off by as
#: much as its limb lengths and the places of its sensors are, some millimetres
FITTED_M = 0.01
_LIMBS = (("upper_arm", "forearm", "hand"), ("thigh", "foot"))
CHAINS = [tuple(f"{side}_{part}" for part in limb) for side in SIDES for limb in _LIMBS]
CHAINS += [("head",), ("pelvis",)]
"""What is reported as not recorded, of each chain the first part alone."""

SOLES = ("right_sole", "left_sole")
#: What is reported of a fitted body, with the remedy
WARNINGS = {
    "far": "far from their places on the body; check their names, the unit and the measures",
    "misplaced": "markers far from the landmarks of their names; check which is which",
    "unrecorded": "nothing is recorded of these parts, their posture is assumed",
    "no floor": "floor; state it as a fixed object",
    "floating": "the lower sole is above the floor; check the floor and the unit",
    "stretching": "bones change their length; check which points belong together",
}


@dataclass(frozen=True, eq=False)
class Places:
    """Joints and markers of one body on one clock."""

    times: Float[np.ndarray, "frames"]  #: In the capture's time [s]
    points: dict[str, Float[np.ndarray, "frames 3"]]  #: In the world [m]
    names: dict[str, BodyName]

    #: Places on the body that the capture itself states
    stated: Mapping[str, str] = field(default_factory=dict)
    #: Where the face looks, as a direction in the world [1]; None where it is not known
    faces: Float[np.ndarray, "frames 3"] | None = None


def whole_body(place: str | Path) -> Places | None:
    """The joints or markers of the body most of a capture's names are of; None if too few."""
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

    Names of strapped-on trackers, such as ``right_knee``, are in conventions too, but few of each.
    """
    known = {each.place for name, each in names.items() if name in markers}
    if len(known) >= LEAST_EXACT:
        return True
    joints = {each.place for name, each in names.items() if each.by != BY_WORDS}
    shares = coverage(name for name in names if name not in markers)
    return len(known | joints) >= LEAST_EXACT and max(shares.values()) >= LEAST_JOINTS


def fit_body(place: str | Path, capture: Capture) -> Fit:
    """The body of a capture's performer, fitted to its joints or markers, else to its sensors.

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


def fit_warnings(place: str | Path, capture: Capture, made: Fit) -> list[str]:
    """What does not suit the body, each with what a user can do about it (``WARNINGS``)."""
    found = whole_body(place)
    floor = ground(capture)
    lower = np.minimum(*(made.human.sites(made.motion, [s])[s][0][:, 2] for s in SOLES))
    floats_m = 0.0 if floor is None else float(np.median(lower)) - floor
    stretching = [each.message for each in capture.notices if each.code == "bone-stretches"]
    unseen = set(made.unrecorded)
    missing = (next((part for part in chain if part in unseen), "") for chain in CHAINS)
    floats = floats_m > FLOATING_M and not {"right_foot", "left_foot"} & unseen
    found_of = {
        "far": _far(made),
        "misplaced": _misplaced(made, found.names) if found else [],
        "unrecorded": [part for part in missing if part],
        "no floor": ["none in the capture"] if floor is None else [],
        "floating": [f"{1e3 * floats_m:.0f} mm"] if floats else [],
        "stretching": list(dict.fromkeys(stretching)),
    }
    return [
        f"{text}: {', '.join(found_of[kind])}" for kind, text in WARNINGS.items() if found_of[kind]
    ]


def _far(made: Fit) -> list[str]:
    """Points and sensors that are far from their places on the body, the worst first."""
    peaks = {n: float(np.nanmax(m)) for n, m in made.residuals_m.items() if np.isfinite(m).any()}
    worst = sorted((name for name in peaks if peaks[name] > FAR_M), key=lambda name: -peaks[name])
    return [
        f"{name} by {1e3 * peaks[name]:.0f} mm at "
        f"{made.times[int(np.nanargmax(made.residuals_m[name]))]:.2f} s"
        for name in worst[:MOST_NAMES]
    ]


def _misplaced(made: Fit, names: Mapping[str, BodyName]) -> list[str]:
    """Markers that are far from the landmarks of their names, the worst of each segment."""
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
    return [f"{name} by {1e3 * metres:.0f} mm" for metres, name in sorted(apart.values())[::-1]]


def ground(capture: Capture) -> float | None:
    """Height of the lowest level floor that a capture has, as wide as one [m]."""
    tops = []
    for thing in capture.objects:
        if thing.shape is not None and thing.tag is TagType.FIXED:
            pose = geometry.transforms(thing.stream.positions[0], thing.stream.orientations[0])
            corners = pose.apply(np.array(thing.shape.vertices))
            wide = np.ptp(corners[:, :2], axis=0).min() > FLOOR_M
            if wide and np.ptp(corners[:, 2]) < FLOOR_THICK_M:
                tops.append(float(corners[:, 2].max()))
    return min(tops, default=None)


def fit_places(found: Places, *, ground_m: float | None = None) -> Fit:
    """The body fitted to joints or markers; feet stand on a ground of known height [m]."""
    began = time.perf_counter()
    made = _followed(found, ground_m)
    motion = closed_hands(made.human, made.motion, found.points, found.names)
    seconds = time.perf_counter() - began
    lost = {name: np.isnan(found.points[name]).any(axis=1) for name in made.residuals_m}
    return Fit(made.human, found.times, motion, lost, made.residuals_m, {}, seconds, made.segments)


def _followed(found: Places, ground_m: float | None) -> PointFit:
    """By the convention of a skeleton, where there are joints only; else by places of markers."""
    titles = {each.title for each in conventions().values() if each.markers}
    if not any(each.by in titles for each in found.names.values()):
        with suppress(ConventionError):
            return fit_joints(
                found.points,
                recognise(found.names),
                ground_m=ground_m,
                stated=found.stated,
                faces=found.faces,
            )
    return fit_markers(found.points, found.names, ground_m=ground_m)


def with_body_parts(capture: Capture, made: Fit) -> Capture:
    """The capture with head and feet of the fitted body as SELF objects that are touched.

    Parts that the capture has, or of which nothing was recorded, are not added. Hands without a
    shape get that of the body. The tolerance of contact is then ``FITTED_M`` or larger.
    """
    nearest = np.abs(made.times[None] - capture.times[:, None]).argmin(axis=1)
    own = [each for each in capture.sensors if capture.agent_of(each) == capture.agent.name]
    taken = {thing.name for thing in capture.objects} | set(made.unrecorded)
    taken |= {_place(sensor) for sensor in own if sensor in capture.acting}
    added = [_part(capture, made, name, nearest) for name in TOUCHED if name not in taken]
    sensors = tuple(
        replace(each, shape=_shape_on(made, _place(each), each.stream, nearest))
        if each in own and _place(each) in HANDS and each.shape is None and not each.part_of
        else each
        for each in capture.sensors
    )
    if not added and sensors == capture.sensors:
        return capture
    return replace(
        capture,
        sensors=sensors,
        objects=(*capture.objects, *added),
        contact_tolerance_m=max(capture.contact_tolerance_m or 0.0, FITTED_M),
    )


def _place(sensor: Sensor) -> str:
    """The place that a sensor's end-effector is: ``right_hand``, ``head``."""
    side = "" if sensor.side == "none" else f"{sensor.side}_"
    return f"{side}{sensor.end_effector}"


def _part(capture: Capture, made: Fit, name: str, nearest: Int[np.ndarray, "frames"]) -> TagObject:
    """A part of the body that is touched; with the sensor of its name where there is one."""
    worn = next((sensor.stream for sensor in capture.sensors if sensor.name == name), None)
    if worn is not None:
        shape = _shape_on(made, name, worn, nearest)
        return TagObject(name, TagType.SELF, worn, shape, name)
    spots, turns = made.human.sites(made.motion, [name])[name]
    lost = _lost(made)[nearest][:, None]
    stream = Stream(
        times=capture.times,
        positions=np.where(lost, np.nan, spots[nearest]),
        orientations=np.where(lost, np.nan, turns[nearest]),
    )
    shape = segment_surface(made.human.measures, TOUCHED[name], name)
    kind = name.rpartition("_")[2]
    return TagObject(name, TagType.SELF, stream, shape, kind, agent=capture.agent.name)


def _shape_on(made: Fit, name: str, stream: Stream, nearest: Int[np.ndarray, "frames"]) -> Shape:
    """A part's surface in the frame of what rides on it: mean turn, median place of all frames."""
    surface = segment_surface(made.human.measures, (TOUCHED | HANDS)[name], name)
    spots, turns = (rows[nearest] for rows in made.human.sites(made.motion, [name])[name])
    known = ~stream.lost & ~_lost(made)[nearest]
    worn = geometry.transforms(stream.positions[known], stream.orientations[known])
    relative = worn.inv() * geometry.transforms(spots[known], turns[known])
    middle: Float[np.ndarray, "3"] = np.median(relative.translation, axis=0)
    return moved(surface, RigidTransform.from_components(middle, relative.rotation.mean()))


def _lost(made: Fit) -> Bool[np.ndarray, "frames"]:
    """Frames in which nothing that the body follows is seen."""
    if not made.bridged:
        return np.zeros(len(made.times), dtype=bool)
    return np.asarray(np.all([*made.bridged.values()], axis=0))
