"""Parts of a fitted body as things that are touched: its head and feet, and surfaces of its hands.

A capture may state such parts itself, as SELF objects with shapes of their own; then nothing is
added for them.
"""

from dataclasses import replace

import numpy as np
from jaxtyping import Bool, Float, Int
from scipy.spatial.transform import RigidTransform

from capar.body.fitting import Fit
from capar.body.recording import HAND_SEGMENTS
from capar.body.surfaces import segment_surface
from capar.model import geometry
from capar.model.capture import Capture, Sensor, Shape, Stream, TagObject, TagType
from extractors.readers.body_names.body_names import SIDES

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
