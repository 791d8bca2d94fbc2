"""The capture bundle: a capture.toml that says what is what in the files it names."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from difflib import get_close_matches
from fnmatch import fnmatchcase
from pathlib import Path
from typing import Any

import numpy as np
from jaxtyping import Float
from scipy.spatial.transform import RigidTransform

from capar.model import geometry
from capar.model.capture import (
    Agent,
    Capture,
    Conventions,
    Notice,
    PivotContact,
    Purpose,
    Role,
    Sensor,
    Shape,
    Source,
    Stream,
    TagObject,
    TagType,
    notice,
)
from capar.model.errors import CaptureError, FileError, UnknownNameError
from capar.model.geometry import runs
from extractors.contact.contacts import with_meeting_hands
from extractors.readers.bundle.bodies import (
    GAP_S,
    Body,
    WorldRecording,
    find_body,
    rate_notices,
    resampled,
    shared_clock,
    to_world,
)
from extractors.readers.bundle.shapes import Frame, assumed, build_shape, under_object
from extractors.readers.files import source_of
from extractors.readers.names import (
    WHOLES,
    constant_name,
    part_of,
    parts,
    without_side,
    words_of,
)
from extractors.readers.recording import UNITS
from extractors.readers.registry import READER_OPTIONS, read_recording, reader_for
from extractors.readers.schema.capture import (
    CaptureFile,
    ManyObjects,
    ManySensors,
    MotionFile,
    ObjectEntry,
    ObjectTraits,
    SensorEntry,
    Takes,
)
from extractors.readers.schema.entry import Location, expanded, read_toml, substituted, validated

LINKS = {"hand": "arm", "foot": "leg", "head": "neck", "eyes": "neck"}
"""The chain by the end-effectors that rules know."""


def chain_of(end_effector: str) -> str:
    """The chain that an end-effector ends; of one that rules do not know, its own name."""
    return LINKS.get(end_effector, end_effector)


def many_sensors(entry: ManySensors, files: Mapping[str, WorldRecording]) -> list[SensorEntry]:
    """A ``[[sensor]]`` for each body that a ``[[sensors_from]]`` stands for.

    Raises:
        UnknownNameError: A file or body that is not there.
    """
    known = _bodies(entry, files)
    names = list(known) if entry.bodies == "*" else entry.bodies
    names = [names] if isinstance(names, str) else names
    for name in [*names, *entry.names, *entry.end_effectors, *entry.attends]:
        if name not in known:
            raise entry.unknown("body", name, known, "bodies")
    out = []
    for name in names:
        called = entry.names.get(name, name)
        side, stem = _side(called, entry.sides)
        values = {
            "name": constant_name(called),
            "end_effector": entry.end_effectors.get(name, constant_name(stem)),
            "side": side,
            "link": constant_name(called),
            "role": "attends" if name in entry.attends else "acts",
            "file": entry.file,
            "body": name,
            **entry.given({"shape", "extend"}),
        }
        out.append(validated(SensorEntry, values, entry.location))
    return out


def _side(name: str, sides: Mapping[Any, str]) -> tuple[str, str]:
    """The side that a name's beginning states, and the name without it."""
    for side, start in sorted(sides.items()):
        if name.startswith(start):
            return side, name.removeprefix(start)
    return "none", name


def _bodies(
    entry: ManySensors | ManyObjects, files: Mapping[str, WorldRecording]
) -> Mapping[str, Any]:
    if entry.file not in files:
        raise entry.unknown("file", entry.file, files, "file")
    return files[entry.file].bodies


def many_objects(
    entry: ManyObjects, files: Mapping[str, WorldRecording]
) -> tuple[list[ObjectEntry], list[Notice]]:
    """An ``[[object]]`` for each body that an ``[[objects_from]]`` stands for.

    Several bodies of one kind are numbered in the order of their names. Bodies of no stated kind
    are left out; a notice counts them.

    Raises:
        UnknownNameError: A file that is not there, or a pattern that no body fits.
        FileError: A kind lacks a key that an object needs.
    """
    known = _bodies(entry, files)
    bodies = sorted(name for name in known if fnmatchcase(name, entry.bodies))
    if not bodies:
        raise entry.unknown("body", entry.bodies, known, "bodies")
    shared = entry.given(ObjectTraits.model_fields)
    out: list[ObjectEntry] = []
    counts: dict[str, int] = {}
    left_out: list[str] = []
    for body in bodies:
        start = next((each for each in entry.kinds if body.startswith(each)), None)
        if start is None:
            left_out.append(body)
            continue
        kind = entry.kinds[start]
        counts[kind.name] = counts.get(kind.name, 0) + 1
        number = f"_{counts[kind.name]}" if counts[kind.name] > 1 else ""
        own = {"name": f"{kind.name}{number}", "file": entry.file, "body": body}
        values = {**shared, "kind": kind.name, **kind.given(), **own}
        out.append(validated(ObjectEntry, values, kind.location))
    return out, _left_out(left_out, len(bodies))


def pivots(entry: ManyObjects, objects: list[ObjectEntry]) -> list[PivotContact]:
    """The contacts by distance of the sensor in ``touched_by`` with every object."""
    if entry.touched_within_m is None:
        return []
    return [PivotContact(entry.touched_by, each.name, entry.touched_within_m) for each in objects]


def _left_out(names: list[str], bodies: int) -> list[Notice]:
    if not names:
        return []
    return [notice("objects-left-out", *names, objects=bodies)]


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


def declared(document: CaptureFile, files: Mapping[str, WorldRecording]) -> Declared:
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


def _tracked(entry: SensorEntry | ObjectEntry, files: Mapping[str, WorldRecording]) -> _Tracked:
    body = find_body(entry, files) if entry.body or entry.markers else None
    frame = body.frame if body else Frame()
    frame.owner = entry.name
    return _Tracked(body, build_shape(entry.shape, frame) if entry.shape else None, frame)


def _stream(body: Body, extend: str, times: Float[np.ndarray, "frames"], start: float) -> Stream:
    own = body.stream
    shifted = Stream(own.times - start, own.positions, own.orientations)
    return resampled(shifted, times, extend=extend)


def _sensor(
    entry: SensorEntry, tracked: _Tracked, times: Float[np.ndarray, "frames"], start: float
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


def _doubtful_kind(entry: SensorEntry) -> list[Notice]:
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
    entries: list[ObjectEntry],
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
    entry: ObjectEntry,
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


def _fixed_pose(entry: ObjectEntry) -> RigidTransform:
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


Parts = list[tuple[int, Sensor]]
"""Sensors of one end-effector, each with its rank in acting for it."""


def grouped(capture: Capture) -> Capture:
    """The capture with one end-effector for each hand and foot that several sensors ride on.

    Sensors are parts of one end-effector if they are of one agent and one side, act, and what they
    are (``end_effector``) names a part of a hand or of a foot: a palm and its fingers, a heel and
    its toes. The one that stands for the whole, as a palm does, acts for all; if it is named after
    a part it is called after the whole, such as ``right_hand``. What a part touches the
    end-effector touches; only its own motion, and that of what acts for it, are told.
    """
    for group in _groups(capture).values():
        if len(group) > 1:
            _, leader = min(group, key=lambda each: each[0])
            capture = _joined(capture, leader, [each for _, each in group if each is not leader])
    return capture


def _groups(capture: Capture) -> dict[tuple[str, str, str], Parts]:
    """The sensors of each agent's hands and feet."""
    out: dict[tuple[str, str, str], Parts] = {}
    for sensor in capture.sensors:
        found = part_of(sensor.end_effector)
        if found and sensor.side != "none" and sensor.role is Role.ACTS and not sensor.part_of:
            limb, rank = found
            _, named = part_of(sensor.name) or (limb, rank)
            key = (capture.agent_of(sensor), sensor.side, limb)
            out.setdefault(key, []).append((max(rank, named), sensor))
    return out


def _joined(capture: Capture, leader: Sensor, parts: Sequence[Sensor]) -> Capture:
    limb, _ = part_of(leader.end_effector) or (leader.end_effector, 0)
    name = _name(capture, leader, limb)
    link = leader.link if leader.end_effector == limb else f"{leader.side}_{chain_of(limb)}"
    whole = replace(leader, name=name, end_effector=limb, link=link)
    changed = {leader.name: whole}
    changed |= {each.name: replace(each, part_of=name, link=link) for each in parts}
    pivots = tuple(
        replace(
            each,
            first=name if each.first == leader.name else each.first,
            second=name if each.second == leader.name else each.second,
        )
        for each in capture.pivot_contacts
    )
    return replace(
        capture,
        sensors=tuple(changed.get(each.name, each) for each in capture.sensors),
        pivot_contacts=pivots,
        notices=(*capture.notices, _told(name, leader, parts)),
    )


def _name(capture: Capture, leader: Sensor, limb: str) -> str:
    """What the end-effector is called: its own name, or that of the whole where that is free."""
    whole = f"{leader.side}_{limb}"
    if leader.agent and capture.others:
        whole = f"{leader.agent}_{whole}"
    taken = leader.name in {each.name for each in capture.objects} or whole in capture.bodies
    called_whole = set(words_of(leader.name)) & set(WHOLES[limb])
    return leader.name if taken or called_whole else whole


def _told(name: str, leader: Sensor, parts: Sequence[Sensor]) -> Notice:
    names = [each.name for each in (leader, *parts)]
    return notice("sensors-grouped", name, sensors=", ".join(names))


FILE = "capture.toml"


@dataclass(frozen=True)
class Place:
    """Where a capture is described, and which take of it is meant."""

    file: Path
    take: str = ""


def find_place(place: str | Path) -> Place:
    """The capture.toml of a folder, a file, or a motion file beside it, and a ``:take``.

    Raises:
        FileError: There is none.
    """
    text = str(place)
    path, take = Path(text), ""
    if not path.exists() and ":" in text:
        stem, _, take = text.rpartition(":")
        path = Path(stem)
    if path.is_dir():
        path = path / FILE
    elif path.is_file() and path.suffix != ".toml":
        beside = path.parent / FILE
        if not beside.is_file():
            raise FileError(
                text,
                f"is no {FILE}, and there is none beside it.",
                f"If it is a recording, write one with: capar new-capture {path} -o {beside}",
            )
        path = beside
    if not path.is_file():
        raise FileError(
            text,
            f"no capture here: there is no file {path}.",
            f"Write one with: capar new-capture FILES... -o {_wanted(path)}",
        )
    return Place(path, take)


def _wanted(path: Path) -> Path:
    """Where a capture.toml ought to be, by a path that leads nowhere: a file or a folder."""
    if path.suffix == ".toml":
        return path
    return (path.parent if path.suffix else path) / FILE


def takes(place: str | Path) -> list[str]:
    """The names of a bundle's takes; empty where it has one only."""
    data, location = read_toml(find_place(place).file)
    return list(_takes(data, location))


def take_words(place: str | Path) -> dict[str, dict[str, str]]:
    """What ``{...}`` stands for in each take of a bundle; empty where it has one take only."""
    data, location = read_toml(find_place(place).file)
    return _takes(data, location)


def open_bundle(place: str | Path) -> tuple[CaptureFile, str]:
    """A capture.toml with the take's names filled in, validated, and the take.

    Raises:
        FileError: The bundle has several takes and none was named, or it is not valid TOML.
        UnknownNameError: It has no such take.
        CaparError: A key or value is not as the schema says.
    """
    where = find_place(place)
    data, location = read_toml(where.file)
    known = _takes(data, location)
    if where.take not in known and (where.take or known):
        if where.take:
            raise UnknownNameError("take", where.take, known, where=location.where("takes"))
        raise FileError(
            location.where("takes"),
            "has several takes.",
            f"Name one of them: {place}:{next(iter(known))}",
        )
    words = known.get(where.take, {})
    return validated(CaptureFile, substituted(data, words), location), where.take


def _takes(data: dict[str, Any], location: Location) -> dict[str, dict[str, str]]:
    """Each take's name and what ``{...}`` stands for in it."""
    if "takes" not in data:
        return {}
    found = validated(Takes, {"takes": data["takes"]}, location).takes
    words = [{"take": take} if isinstance(take, str) else take for take in found]
    return {take["take"]: take for take in words}


__all__ = ["files_of", "find_place", "frame_times", "read_capture", "takes"]


def read_capture(place: str | Path) -> Capture:
    """The capture that a bundle describes.

    Args:
        place: A folder with a capture.toml, or that file, or a motion file beside it; then
            ``:take`` where the bundle has several.

    Raises:
        CaparError: A file, body or value is not as the capture.toml says; it names the line.
    """
    document, take = open_bundle(place)
    _check_names(document)
    files = read_files(document)
    group = declared(document, files)
    agents = [Agent(each.name, each.kind, each.measures) for each in document.performers]
    notices = [*(notice for file in files.values() for notice in file.notices), *group.notices]
    contact = document.contact
    try:
        trial = Capture(
            name=_name_capture_toml(document, take),
            sensors=group.sensors,
            objects=group.objects,
            agent=agents[0],
            contact_tolerance_m=contact.tolerance_m if contact else None,
            contact_dropout_s=contact.dropout_s if contact else None,
            contact_minimum_s=contact.minimum_s if contact else None,
            pivot_contacts=(*_pivots(document, group), *group.pivot_contacts),
            purposes=tuple(
                Purpose(p.purpose, p.action, p.object, p.goal) for p in document.purpose
            ),
            force_transfer=document.force_transfer,
            sources=_sources(document, files, group),
            notices=(*notices, *_gap_notices(group.sensors, group.objects)),
            others=tuple(agents[1:]),
            conventions=group.conventions,
        )
        return with_meeting_hands(trial if document.parts == "apart" else grouped(trial))
    except CaptureError as error:
        raise CaptureError(f"{document.file_path}: {error}") from None


def _sources(
    document: CaptureFile, files: Mapping[str, WorldRecording], group: Declared
) -> tuple[Source, ...]:
    """The capture.toml, the motion files, and each mesh once."""
    own = source_of(document.file_path, "capture.toml", recorded_at=document.recorded or "")
    own = replace(own, path=document.file_path.name)
    return (own, *(file.source for file in files.values()), *dict.fromkeys(group.sources))


def frame_times(place: str | Path, *, file: str = "") -> Float[np.ndarray, "frames"]:
    """When each frame of a source file was taken, in seconds of the capture's clock [s].

    With it the frame numbers of labels become times, whatever rate the capture has.
    """
    document, _ = open_bundle(place)
    files = read_files(document)
    if file and file not in files:
        raise document.unknown("file", file, files, "files")
    recording = files[file or next(iter(files))]
    return _clock(recording) - declared(document, files).start_s


def files_of(place: str | Path) -> tuple[dict[str, WorldRecording], float]:
    """Everything in a capture's files in the world, and when in their time it begins [s].

    Raises:
        CaparError: As of ``read_capture``.
    """
    document, _ = open_bundle(place)
    files = read_files(document)
    return files, declared(document, files).start_s


def _clock(recording: WorldRecording) -> Float[np.ndarray, "frames"]:
    """The times of a file's frames [s]."""
    if recording.markers:
        return recording.marker_times
    return next(iter(recording.bodies.values())).times


def _name_capture_toml(document: CaptureFile, take: str) -> str:
    folder = document.file_path.parent
    name = document.name or folder.name.strip(".") or folder.resolve().name
    return f"{name}_{take}" if take and take not in name else name


def _check_names(document: CaptureFile) -> None:
    """Check that sensors and objects have names of their own, and that named agents exist."""
    agents = [each.name for each in document.performers]
    for kind, entries in (("sensor", document.sensor), ("object", document.object)):
        lines: dict[str, str] = {}
        for entry in entries:
            if entry.name in lines:
                also = f"also {lines[entry.name]}."
                raise entry.error("name", f"two {kind}s are called {entry.name!r}; {also}")
            lines[entry.name] = entry.where("name")
            if entry.agent and entry.agent not in agents:
                raise entry.unknown("agent", entry.agent, agents, "agent")


def read_files(document: CaptureFile) -> dict[str, WorldRecording]:
    """Every file under ``[files]``, in the world.

    Raises:
        CaparError: One cannot be read, or its unit or axes are stated nowhere.
    """
    return {name: _read_file(document, name) for name in document.files}


def _read_file(document: CaptureFile, name: str) -> WorldRecording:
    entry = _entry(document, name)
    path = expanded(entry, "path")
    options = entry.given(READER_OPTIONS)
    for key in sorted(set(options) - (allowed := reader_for(path).options)):
        raise entry.unknown(f"{reader_for(path).format} option", key, allowed, key)
    plain = {key: _plain(value) for key, value in options.items()}
    recording = read_recording(path, options=plain)
    recording = replace(recording, source=replace(recording.source, path=entry.path))
    if entry.parents:
        recording = replace(recording, parents=_parents(entry, recording.names))
    world = to_world(
        recording,
        unit_m=_unit_m(document, entry, recording.unit_m),
        up=_up(document, entry, recording.up),
        left_handed=(entry.handedness or document.handedness) == "left",
    )
    return replace(world, places=_places(entry, recording.names)) if entry.places else world


def _entry(document: CaptureFile, name: str) -> MotionFile:
    """The table of a motion file, of which a path alone may be given."""
    given = document.files[name]
    if isinstance(given, MotionFile):
        return given
    location = document.location.inside("files").inside(name)
    return validated(MotionFile, {"path": given}, location)


def _plain(value: Any) -> Any:
    """A validated value as the readers take it: tables as mappings."""
    if isinstance(value, list):
        return [_plain(item) for item in value]
    return value.given() if hasattr(value, "given") else value


def _unit_m(document: CaptureFile, entry: MotionFile, stated_m: float | None) -> float:
    """Metres per unit of a file: as its own table, the file, or the general key says."""
    if not entry.unit and stated_m:
        return stated_m
    unit = entry.unit or document.unit
    if unit is None:
        raise _unstated(document, "unit", f'unit = "mm" (or {", ".join(UNITS)})')
    return UNITS[unit] if isinstance(unit, str) else unit


def _up(document: CaptureFile, entry: MotionFile, stated: str | None) -> str:
    """The upward axis of a file: as its own table, the file, or the general key says."""
    up = entry.up or stated or document.up
    if up is None:
        raise _unstated(document, "up", 'up = "z" (or "y")')
    return up


def _unstated(document: CaptureFile, key: str, example: str) -> FileError:
    remedy = f"State it at the top: {example}."
    return document.error("files", f"no file states its {key}.", remedy)


def _parents(entry: MotionFile, known: list[str]) -> dict[str, str]:
    for joint, parent in entry.parents.items():
        for name in (joint, parent):
            if name not in known:
                raise entry.unknown("body", name, known, f"parents.{joint}")
    return entry.parents


def _places(entry: MotionFile, known: list[str]) -> dict[str, str]:
    for name, place in entry.places.items():
        if name not in known:
            raise entry.unknown("body", name, known, f"places.{name}")
        if without_side(place) not in parts():
            raise entry.unknown("place on the body", place, sorted(parts()), f"places.{name}")
    return entry.places


def _pivots(document: CaptureFile, group: Declared) -> list[PivotContact]:
    out = []
    known = [*(each.name for each in group.sensors), *(each.name for each in group.objects)]
    for entry in document.pivot_contact:
        for key in ("first", "second"):
            if (name := getattr(entry, key)) not in known:
                raise entry.unknown("body", name, known, key)
        out.append(PivotContact(entry.first, entry.second, entry.distance_m))
    return out


def _gap_notices(sensors: tuple[Sensor, ...], objects: tuple[TagObject, ...]) -> list[Notice]:
    """Every stretch in which a body is lost for longer than is interpolated."""
    streams = {each.name: each.stream for each in sensors}
    streams |= {each.name: each.stream for each in objects}
    return [
        _gap_notice(name, stream, gap)
        for name, stream in streams.items()
        for gap in _long_gaps(stream)
    ]


def _long_gaps(stream: Stream) -> list[tuple[int, int]]:
    times, last = stream.times, len(stream.times) - 1
    return [
        (first, end)
        for first, end in runs(stream.lost)
        if times[min(end + 1, last)] - times[max(first - 1, 0)] > GAP_S
    ]


def _gap_notice(name: str, stream: Stream, gap: tuple[int, int]) -> Notice:
    if gap == (0, len(stream.times) - 1):
        return notice("long-gap", name)
    start, end = stream.times[gap[0]], stream.times[gap[1]]
    return notice("long-gap", name, start_s=float(start), end_s=float(end))
