"""The sensors and objects that a capture.toml declares, on one clock."""

from collections.abc import Mapping
from dataclasses import dataclass
from difflib import get_close_matches
from typing import TYPE_CHECKING

import numpy as np
from jaxtyping import Float
from scipy.spatial.transform import RigidTransform

from capar.model import geometry
from capar.model.capture import (
    Conventions,
    Notice,
    PivotContact,
    Role,
    Sensor,
    Shape,
    Source,
    Stream,
    TagObject,
    TagType,
    notice,
)
from extractors.readers.bundle.bodies import Body, find_body
from extractors.readers.bundle.links import LINKS, chain_of
from extractors.readers.bundle.many import many_objects, many_sensors, pivots
from extractors.readers.bundle.resampling import rate_notices, resampled, shared_clock
from extractors.readers.bundle.shapes import Frame, assumed, build_shape
from extractors.readers.bundle.support import under_object
from extractors.readers.bundle.world import WorldRecording

if TYPE_CHECKING:
    from extractors.readers.schema.bodies import ObjectEntry, SensorEntry
    from extractors.readers.schema.capture import CaptureFile


@dataclass(frozen=True)
class Declared:
    """Everything that a capture consists of, but for its name and performer."""

    sensors: tuple[Sensor, ...]
    objects: tuple[TagObject, ...]
    start_s: float
    """The files' time that is the capture's zero [s]."""

    notices: tuple[Notice, ...]
    sources: tuple[Source, ...]
    pivot_contacts: tuple[PivotContact, ...]
    """Those that many objects declared at once share."""

    conventions: Mapping[str, Conventions]
    """By which each body's file was read, by the body's name."""


@dataclass(frozen=True)
class _Tracked:
    """The body and the shape of a sensor or object, before it is on the common clock."""

    body: Body | None
    shape: Shape | None
    frame: Frame


def declared(document: "CaptureFile", files: Mapping[str, WorldRecording]) -> Declared:
    """The sensors and objects of a capture.toml, resampled to one clock.

    Raises:
        CaparError: A name is unknown, a body cannot be found, or clocks differ.
    """
    many = [many_objects(entry, files) for entry in document.objects_from]
    sensors = [*document.sensor]
    sensors += [each for entry in document.sensors_from for each in many_sensors(entry, files)]
    objects = [*document.object, *(each for found, _ in many for each in found)]
    entries: list[SensorEntry | ObjectEntry] = [*sensors, *objects]
    tracked = [_tracked(entry, files) for entry in entries]
    streams = [each.body.stream for each in tracked if each.body]
    times, start = shared_clock(
        streams,
        rate_hz=document.rate_hz,
        span_s=(document.from_s, document.to_s),
        where=document.where(),
    )
    count = len(sensors)
    pairs = zip(document.objects_from, many, strict=True)
    return Declared(
        sensors=tuple(
            _sensor(entry, each, times, start)
            for entry, each in zip(sensors, tracked[:count], strict=True)
        ),
        objects=_objects(objects, tracked[count:], times, start),
        start_s=start,
        notices=(
            *(notice for each in tracked if each.body for notice in each.body.notices),
            *(notice for _, notices in many for notice in notices),
            *(notice for each in tracked for notice in each.frame.notices),
            *(notice for entry in document.sensor for notice in _doubtful_kind(entry)),
            *rate_notices(streams, document.rate_hz),
        ),
        sources=tuple(source for each in tracked for source in each.frame.sources),
        conventions={
            entry.name: each.body.conventions
            for entry, each in zip(entries, tracked, strict=True)
            if each.body
        },
        pivot_contacts=tuple(pair for entry, (found, _) in pairs for pair in pivots(entry, found)),
    )


def _tracked(entry: "SensorEntry | ObjectEntry", files: Mapping[str, WorldRecording]) -> _Tracked:
    body = find_body(entry, files) if entry.body or entry.markers else None
    frame = body.frame if body else Frame()
    frame.owner = entry.name
    return _Tracked(body, build_shape(entry.shape, frame) if entry.shape else None, frame)


def _stream(body: Body, extend: str, times: Float[np.ndarray, "frames"], start: float) -> Stream:
    own = body.stream
    shifted = Stream(own.times - start, own.positions, own.orientations)
    return resampled(shifted, times, extend=extend)


def _sensor(
    entry: "SensorEntry", tracked: _Tracked, times: Float[np.ndarray, "frames"], start: float
) -> Sensor:
    assert tracked.body is not None
    if not any(entry.gaze):
        raise entry.error("gaze", "gaze of no length.", "It is a direction in the sensor's frame.")
    kind = entry.end_effector
    chain = chain_of(kind)
    role = entry.role or ("attends" if kind in {"head", "eyes"} else "acts")
    return Sensor(
        name=entry.name,
        end_effector=kind,
        side=entry.side,
        link=entry.link or (chain if entry.side == "none" else f"{entry.side}_{chain}"),
        stream=_stream(tracked.body, entry.extend, times, start),
        shape=tracked.shape,
        role=Role(role),
        gaze=(entry.gaze[0], entry.gaze[1], entry.gaze[2]),
        eye=(entry.eye[0], entry.eye[1], entry.eye[2]),
        agent=entry.agent,
    )


def _doubtful_kind(entry: "SensorEntry") -> list[Notice]:
    """A notice if an end-effector is almost, but not quite, one of those that rules know."""
    near = get_close_matches(entry.end_effector.lower(), LINKS, n=1)
    if not near or entry.end_effector in LINKS:
        return []
    return [
        notice(
            "end-effector-unknown",
            entry.name,
            stated=entry.end_effector,
            known=", ".join(LINKS),
            near=near[0],
        )
    ]


def _objects(
    entries: "list[ObjectEntry]",
    tracked: list[_Tracked],
    times: Float[np.ndarray, "frames"],
    start: float,
) -> tuple[TagObject, ...]:
    """Every object in its order; those that are put under others are built after them."""
    built: dict[int, TagObject] = {}
    order = sorted(range(len(entries)), key=lambda index: bool(entries[index].top_at_bottom_of))
    for index in order:
        others = list(built.values())
        built[index] = _object(entries[index], tracked[index], times, start, others)
    return tuple(built[index] for index in range(len(entries)))


def _object(
    entry: "ObjectEntry",
    tracked: _Tracked,
    times: Float[np.ndarray, "frames"],
    start: float,
    others: list[TagObject],
) -> TagObject:
    derivation, shape = entry.assumed, tracked.shape
    if tracked.body is not None:
        stream = _stream(tracked.body, entry.extend, times, start)
    elif entry.top_at_bottom_of:
        pose, derived = under_object(entry, shape, others)
        stream = _still(times, *pose)
        derivation = f"{derivation}; {derived}" if derivation else derived
    else:
        fixed = _fixed_pose(entry)
        stream = _still(times, fixed.translation, fixed.rotation.as_quat(scalar_first=True))
    return TagObject(
        name=entry.name,
        tag=TagType(entry.tag),
        stream=stream,
        shape=assumed(shape) if shape and derivation else shape,
        kind=entry.kind or entry.name,
        assumed=derivation,
        deformable=entry.deformable,
        motion_floor_m=entry.motion_floor_m,
        mass_kg=entry.mass_kg,
        agent=entry.agent,
    )


def _fixed_pose(entry: "ObjectEntry") -> RigidTransform:
    """The stated pose of an object in the world, whose z axis points up."""
    position = entry.position or []
    if len(position) != 3:
        raise entry.error(
            "position",
            f"position = {position}; without top_at_bottom_of it takes x, y and z.",
            "They are in the world, whose z axis points up whatever `up` says of the files.",
        )
    orientation = np.array([entry.orientation or (1.0, 0.0, 0.0, 0.0)])
    return geometry.transforms(np.array(position), geometry.unit(orientation)[0])


def _still(
    times: Float[np.ndarray, "frames"],
    position: Float[np.ndarray, "3"],
    orientation: Float[np.ndarray, "4"],
) -> Stream:
    frames = len(times)
    return Stream(times, np.tile(position, (frames, 1)), np.tile(orientation, (frames, 1)))
