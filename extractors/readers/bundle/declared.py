"""The sensors and objects that a capture.toml declares, on one clock."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from jaxtyping import Float

from capar.model.capture import (
    Notice,
    PivotContact,
    Role,
    Sensor,
    Shape,
    Source,
    Stream,
    TagObject,
    TagType,
)
from extractors.readers.bundle.bodies import Body, find_body
from extractors.readers.bundle.bulk import Bulk, bulk_sensors
from extractors.readers.bundle.bulk_objects import bulk_objects
from extractors.readers.bundle.clock import resampled, shared_clock
from extractors.readers.bundle.shapes import Frame, assumed, read_pose, read_shape
from extractors.readers.bundle.support import under_object
from extractors.readers.bundle.toml_table import Table
from extractors.readers.bundle.world import WorldRecording

LINKS = {"hand": "arm", "foot": "leg", "head": "neck"}
"""The chain that an end-effector ends, where capture.toml does not say."""

ROLES: dict[str, Role] = {each.value: each for each in Role}
TAGS: dict[str, TagType] = {each.value: each for each in TagType}
EXTEND = {"none": None, "rest": None}


@dataclass(frozen=True)
class Declared:
    """Everything that a capture consists of, but for its name and performer."""

    sensors: tuple[Sensor, ...]
    objects: tuple[TagObject, ...]
    start_s: float
    """The files' time that is the capture's zero [s]."""

    notices: tuple[Notice, ...]
    sources: tuple[Source, ...]
    pivot_contacts: tuple[PivotContact, ...] = ()
    """Those that many objects declared at once share."""


@dataclass
class _Pending:
    """A sensor or object whose stream waits for the common clock."""

    table: Table
    body: Body | None
    shape: Shape | None
    bulk: Bulk | None = None
    place: Callable[[Sequence[TagObject]], tuple[Any, str]] | None = field(default=None)


def declared(
    table: Table,
    files: Mapping[str, WorldRecording],
    *,
    rate_hz: float | None,
    span_s: tuple[float | None, float | None],
) -> Declared:
    """The sensors and objects of a capture.toml.

    Args:
        table: The whole of it.
        files: Its files, in the world.
        rate_hz: The clock to resample to; None keeps the files' own, if they share one.
        span_s: What is kept, after the first frame [s].

    Raises:
        CaparError: A name is unknown, a value is not of its kind, or clocks differ.
    """
    sources: list[Source] = []
    sensors = [_pending(each, files, sources) for each in table.tables("sensor")]
    for each in table.tables("sensors_from"):
        sensors += [_Pending(each, b.body, b.shape, b) for b in bulk_sensors(each, files, sources)]
    objects = [_pending(each, files, sources) for each in table.tables("object")]
    many = [bulk_objects(each, files) for each in table.tables("objects_from")]
    objects += [_pending(each, files, sources) for group in many for each in group.tables]
    if not sensors:
        raise table.error("", "declares no sensor.", "Add [[sensor]] with a name and a body.")
    streams = [each.body.stream for each in (*sensors, *objects) if each.body]
    times, start = shared_clock(streams, rate_hz=rate_hz, span_s=span_s, where=table.where())
    return Declared(
        sensors=tuple(_sensor(each, times, start) for each in sensors),
        objects=_objects(objects, times, start),
        start_s=start,
        notices=(
            *(n for each in (*sensors, *objects) if each.body for n in each.body.notices),
            *(notice for group in many for notice in group.notices),
        ),
        sources=tuple(sources),
        pivot_contacts=tuple(pair for group in many for pair in group.pivot_contacts),
    )


def _pending(table: Table, files: Mapping[str, WorldRecording], sources: list[Source]) -> _Pending:
    moves = "body" in table or "markers" in table
    body = find_body(table, files) if moves else None
    frame = body.frame if body else Frame()
    shape_table = table.table("shape")
    shape = read_shape(shape_table, frame) if shape_table else None
    sources += frame.sources
    return _Pending(table, body, shape)


def _stream(pending: _Pending, times: Float[np.ndarray, "frames"], start: float) -> Stream:
    table, body = pending.table, pending.body
    if body is None:
        raise table.error("", "says not where it is.", "Give body, markers or a fixed position.")
    own = body.stream
    shifted = Stream(own.times - start, own.positions, own.orientations)
    extend = table.choice("extend", EXTEND, "none")
    return resampled(shifted, times, extend=extend)


def _sensor(pending: _Pending, times: Float[np.ndarray, "frames"], start: float) -> Sensor:
    stream = _stream(pending, times, start)
    if pending.bulk:
        return pending.bulk.sensor(stream)
    table = pending.table
    kind = table.text("end_effector")
    side = table.choice("side", {"right": 0, "left": 0, "none": 0}, "none")
    chain = LINKS.get(kind, kind)
    gaze, eye = table.vector("gaze", 3, (1.0, 0.0, 0.0)), table.vector("eye", 3, (0.0, 0.0, 0.0))
    if not np.linalg.norm(gaze) > 0.0:
        raise table.error("gaze", "gaze of no length.", "It is a direction in the sensor's frame.")
    default = Role.ATTENDS if kind == "head" else Role.ACTS
    sensor = Sensor(
        name=table.text("name"),
        end_effector=kind,
        side=side,
        link=table.text("link", chain if side == "none" else f"{side}_{chain}"),
        stream=stream,
        shape=pending.shape,
        role=ROLES[table.choice("role", ROLES, default.value)],
        gaze=(gaze[0], gaze[1], gaze[2]),
        eye=(eye[0], eye[1], eye[2]),
        agent=table.text("agent", ""),
    )
    table.close()
    return sensor


def _objects(
    pending: list[_Pending], times: Float[np.ndarray, "frames"], start: float
) -> tuple[TagObject, ...]:
    """Every object in its order; those that stand under others are placed after them."""
    built: dict[int, TagObject] = {}
    waiting = [n for n, each in enumerate(pending) if "top_at_bottom_of" in each.table]
    for index in [n for n in range(len(pending)) if n not in waiting] + waiting:
        built[index] = _object(pending[index], times, start, list(built.values()))
    return tuple(built[index] for index in range(len(pending)))


def _object(
    pending: _Pending,
    times: Float[np.ndarray, "frames"],
    start: float,
    others: list[TagObject],
) -> TagObject:
    table = pending.table
    derivation = table.text("assumed", "")
    if pending.body is not None:
        stream = _stream(pending, times, start)
    elif "top_at_bottom_of" in table:
        pose, derived = under_object(table, pending.shape, others)
        stream = _still(times, pose[0], pose[1])
        derivation = f"{derivation}; {derived}" if derivation else derived
    elif "position" in table:
        pose = read_pose(table)
        turn = pose.rotation.as_quat(scalar_first=True)
        stream = _still(times, pose.translation, turn)
    else:
        stream = _stream(pending, times, start)
    name = table.text("name")
    shape = assumed(pending.shape) if pending.shape and derivation else pending.shape
    out = TagObject(
        name=name,
        tag=TAGS[table.choice("tag", TAGS)],
        stream=stream,
        shape=shape,
        kind=table.text("kind", name),
        assumed=derivation,
        deformable=table.flag("deformable"),
        motion_floor_m=_length(table, "motion_floor_m"),
        mass_kg=_length(table, "mass_kg"),
        agent=table.text("agent", ""),
    )
    table.close()
    return out


def _length(table: Table, key: str) -> float | None:
    if key not in table:
        return None
    value = table.number(key)
    if value <= 0.0:
        raise table.error(key, f"{key} = {value:g}; it is positive.")
    return value


def _still(
    times: Float[np.ndarray, "frames"],
    position: Float[np.ndarray, "3"],
    orientation: Float[np.ndarray, "4"],
) -> Stream:
    frames = len(times)
    return Stream(times, np.tile(position, (frames, 1)), np.tile(orientation, (frames, 1)))
