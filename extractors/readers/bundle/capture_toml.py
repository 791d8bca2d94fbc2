"""The capture bundle: a capture.toml that says what is what in the files it names."""

import tomllib
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from difflib import get_close_matches
from fnmatch import fnmatchcase
from pathlib import Path
from typing import Any

import numpy as np
from jaxtyping import Float

from capar.model import geometry
from capar.model.capture import (
    UNITS,
    Agent,
    Capture,
    Notice,
    PivotContact,
    Purpose,
    Role,
    Sensor,
    Shape,
    ShapeSource,
    Stream,
    TagObject,
    TagType,
    notice,
)
from capar.model.errors import CaptureError, FileError, UnknownNameError
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
from extractors.readers.bundle.shapes import Frame, WorldPose, build_shape, under_object
from extractors.readers.file_access import check_file, neighbours, source_of
from extractors.readers.names import (
    WHOLES,
    constant_name,
    part_of,
    parts,
    without_side,
    words_of,
)
from extractors.readers.registry import (
    READER_OPTIONS,
    own_bundle,
    read_recording,
    reader_for,
    says_itself,
    trials,
)
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

FILE = "capture.toml"
Files = Mapping[str, WorldRecording]
Times = Float[np.ndarray, "frames"]

LINKS = {"hand": "arm", "foot": "leg", "head": "neck", "eyes": "neck"}
"""The kinematic chain that an end-effector ends, where nobody says so, by those that rules know."""


def find_place(place: str | Path) -> tuple[Path, str]:
    """The capture.toml of a folder, a file, or a motion file beside it, and a ``:take``.

    A motion file that says itself what is what stands for its own.

    Raises:
        FileError: There is none.
    """
    text = str(place)
    path, take = Path(text), ""
    if not path.exists() and ":" in text:
        stem, _, take = text.rpartition(":")
        path = Path(stem)
    path = path / FILE if path.is_dir() else path
    beside = path.parent / FILE
    if path.is_file() and path.suffix != ".toml" and not says_itself(path):
        if not beside.is_file():
            raise FileError(
                text,
                f"is no {FILE}, and there is none beside it.",
                f"If it is a recording, write one with: capar new-capture {path} -o {beside}",
            )
        path = beside
    if not path.is_file():
        if path.name == FILE and trials(path.parent):
            read_recording(path.parent)  # which says what it holds, and what to write
        wanted = {".toml": path, "": path / FILE}.get(path.suffix, beside)
        raise FileError(
            text,
            f"no capture here: there is no file {path}.",
            f"{neighbours(path)} Write one with: capar new-capture FILES... -o {wanted}",
        )
    return path, take


def takes(place: str | Path) -> list[str]:
    """The names of a bundle's takes; empty where it has one only."""
    return list(take_words(place))


def place_of(file: Path, name: str) -> str:
    """Where the capture of a name is: in a file, or in the take of it that the name contains."""
    own = [each for each in takes(file) if each in name]
    likely = max(own, key=lambda take: (name.endswith(take), len(take)), default="")
    return f"{file}:{likely}" if own else str(file)


def take_words(place: str | Path) -> dict[str, dict[str, str]]:
    """What ``{...}`` stands for in each take of a bundle; empty where it has one take only."""
    return _takes(*_document(find_place(place)[0]))


def _document(path: Path, trial: str = "") -> tuple[dict[str, Any], Location]:
    """The content of a capture.toml, or of that which a motion file itself amounts to."""
    if path.suffix != ".toml" and says_itself(path):
        return tomllib.loads(own_bundle(path, path.name, trial)), Location(path, {})
    data, location = read_toml(path)
    return _with_episodes(data, location), location


def _with_episodes(data: dict[str, Any], location: Location) -> dict[str, Any]:
    """The content with each episode of a data set as a take, where it states neither."""
    files = data.get("files")
    if "takes" in data or not isinstance(files, dict):
        return data
    for name, stated in files.items():
        table = stated if isinstance(stated, dict) else {"path": stated}
        if "episode" in table or not isinstance(table.get("path"), str):
            continue
        where = location.inside("files").inside(name)
        try:
            folder = expanded(validated(MotionFile, {"path": table["path"]}, where), "path")
        except FileError:  # a variable that is not set is reported where the file is read
            continue
        if "arrays" in table and not folder.suffix and not folder.exists():
            check_file(folder)  # a data set that is missing has no takes to name
        if own := trials(folder):
            return data | {"files": files | {name: table | {"episode": "{take}"}}, "takes": own}
    return data


def _takes(data: dict[str, Any], location: Location) -> dict[str, dict[str, str]]:
    found = validated(Takes, {"takes": data.get("takes", [])}, location).takes
    words = [{"take": take} if isinstance(take, str) else take for take in found]
    return {take["take"]: take for take in words}


def open_bundle(place: str | Path) -> tuple[CaptureFile, str]:
    """A capture.toml with the take's names filled in, validated, and the take.

    Raises:
        FileError: The bundle has several takes and none was named, or it is not valid TOML.
        UnknownNameError: It has no such take.
        CaparError: A key or value is not as the schema says.
    """
    file, take = find_place(place)
    data, location = _document(file)
    known = _takes(data, location)
    if take and take not in known:
        raise UnknownNameError("take", take, known, where=location.where("takes"))
    if known and not take:
        remedy = f"Name one of them: {place}:{next(iter(known))}"
        raise FileError(location.where("takes"), "has several takes.", remedy)
    if take:
        data, _ = _document(file, take)
    return validated(CaptureFile, substituted(data, known.get(take, {})), location), take


@dataclass(frozen=True)
class _Bundle:
    """A capture.toml with what its files hold of its sensors and objects."""

    document: CaptureFile
    take: str
    files: Files
    sensors: Sequence[SensorEntry]
    objects: Sequence[ObjectEntry]
    bodies: Mapping[str, Body]
    """By the name of the sensor or object."""

    times: Times
    """The capture's clock [s]."""

    start_s: float
    """The files' time that is its zero [s]."""

    pivots: tuple[PivotContact, ...]
    """Those that many objects declared at once share."""

    notices: tuple[Notice, ...]


def _read_bundle(place: str | Path) -> _Bundle:
    document, take = open_bundle(place)
    _check_names(document)
    files = read_files(document)
    many = [(entry, *many_objects(entry, files)) for entry in document.objects_from]
    sensors = [*document.sensor]
    sensors += [each for entry in document.sensors_from for each in _many_sensors(entry, files)]
    objects = [*document.object, *(each for _, found, _ in many for each in found)]
    entries: list[SensorEntry | ObjectEntry] = [*sensors, *objects]
    bodies = {each.name: find_body(each, files) for each in entries if each.body or each.markers}
    streams = [body.stream for body in bodies.values()]
    span_s = document.from_s, document.to_s
    times, start_s = shared_clock(
        streams, rate_hz=document.rate_hz, span_s=span_s, where=document.where()
    )
    pivots = tuple(
        PivotContact(entry.touched_by, each.name, entry.touched_within_m)
        for entry, found, _ in many
        if entry.touched_within_m is not None
        for each in found
    )
    notices = (
        *(notice for body in bodies.values() for notice in body.notices),
        *(notice for _, _, left_out in many for notice in left_out),
        *rate_notices(streams, document.rate_hz),
    )
    return _Bundle(document, take, files, sensors, objects, bodies, times, start_s, pivots, notices)


def read_capture(place: str | Path) -> Capture:
    """The capture that a bundle describes.

    Args:
        place: A folder with a capture.toml, or that file, or a motion file beside it; then
            ``:take`` where the bundle has several.

    Raises:
        CaparError: A file, body or value is not as the capture.toml says; it names the line.
    """
    bundle = _read_bundle(place)
    document, files, bodies = bundle.document, bundle.files, bundle.bodies
    agents = [Agent(each.name, each.kind, each.measures) for each in document.performers]
    contact, file = document.contact, document.location.file
    name = document.name or file.parent.name.strip(".") or file.parent.resolve().name
    own = []
    if file.suffix == ".toml":
        stated = source_of(file, "capture.toml", recorded_at=document.recorded or "")
        own.append(replace(stated, path=file.name))
    frames, shapes = [], {}
    entries: list[SensorEntry | ObjectEntry] = [*bundle.sensors, *bundle.objects]
    for entry in entries:
        frame = bodies[entry.name].frame if entry.name in bodies else Frame()
        frame.owner = entry.name
        frames.append(frame)
        shapes[entry.name] = build_shape(entry.shape, frame) if entry.shape else frame.recorded
    sensors = [_sensor(each, _stream(each, bundle), shapes[each.name]) for each in bundle.sensors]
    objects = _objects(bundle, shapes)
    streams = {each.name: each.stream for each in sensors}
    streams |= {each.name: each.stream for each in objects}
    for pivot in document.pivot_contact:
        for key, body in (("first", pivot.first), ("second", pivot.second)):
            if body not in streams:
                raise pivot.unknown("body", body, streams, key)
    pivots = (PivotContact(p.first, p.second, p.distance_m) for p in document.pivot_contact)
    meshes = dict.fromkeys(source for frame in frames for source in frame.sources)
    try:
        trial = Capture(
            name=f"{name}:{bundle.take}" if bundle.take not in {"", name} else name,
            sensors=tuple(sensors),
            objects=tuple(objects),
            agent=agents[0],
            contact_tolerance_m=contact.tolerance_m if contact else None,
            contact_dropout_s=contact.dropout_s if contact else None,
            contact_minimum_s=contact.minimum_s if contact else None,
            pivot_contacts=(*pivots, *bundle.pivots),
            purposes=tuple(
                Purpose(p.purpose, p.action, p.object, p.goal) for p in document.purpose
            ),
            force_transfer=document.force_transfer,
            sources=(
                *own,
                *(each.source for each in files.values()),
                *meshes,
            ),
            notices=(
                *(notice for each in files.values() for notice in each.notices),
                *bundle.notices,
                *(notice for frame in frames for notice in frame.notices),
                *_doubts(document.sensor, streams),
            ),
            others=tuple(agents[1:]),
            conventions={name: body.conventions for name, body in bodies.items()},
        )
        return with_meeting_hands(trial if document.parts == "apart" else grouped(trial))
    except CaptureError as error:
        raise CaptureError(f"{file}: {error}") from None


def frame_times(place: str | Path, *, file: str = "") -> Times:
    """When each frame of a source file was taken, in seconds of the capture's clock [s].

    With it the frame numbers of labels become times, whatever rate the capture has.
    """
    bundle = _read_bundle(place)
    if file and file not in bundle.files:
        raise bundle.document.unknown("file", file, bundle.files, "files")
    return bundle.files[file or next(iter(bundle.files))].times - bundle.start_s


def files_of(place: str | Path) -> tuple[Files, float]:
    """Everything in a capture's files in the world, and when in their time it begins [s].

    Raises:
        CaparError: As of ``read_capture``.
    """
    bundle = _read_bundle(place)
    return bundle.files, bundle.start_s


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
    entry = document.files[name]
    if not isinstance(entry, MotionFile):
        location = document.location.inside("files").inside(name)
        entry = validated(MotionFile, {"path": entry}, location)
    path = expanded(entry, "path")
    options = entry.given(READER_OPTIONS)
    for key in sorted(set(options) - (allowed := reader_for(path).options)):
        raise entry.unknown(f"{reader_for(path).format} option", key, allowed, key)
    if "arrays" in options:
        options["arrays"] = [group.given() for group in options["arrays"]]
    recording = read_recording(path, options=options)
    recording = replace(recording, source=replace(recording.source, path=entry.path))
    for joint, parent in entry.parents.items():
        for each in (joint, parent):
            if each not in recording.names:
                raise entry.unknown("body", each, recording.names, f"parents.{joint}")
    if entry.parents:
        recording = replace(recording, parents=entry.parents)
    unit = entry.unit or recording.unit_m or document.unit
    up = entry.up or recording.up or document.up
    for key, stated, example in (
        ("unit", unit, f'unit = "mm" (or {", ".join(UNITS)})'),
        ("up", up, 'up = "z" (or "y")'),
    ):
        if stated is None:
            remedy = f"State it at the top: {example}."
            raise document.error("files", f"no file states its {key}.", remedy)
    world = to_world(
        recording,
        unit_m=UNITS[unit] if isinstance(unit, str) else float(unit or 0.0),
        up=str(up),
        left_handed=(entry.handedness or document.handedness) == "left",
    )
    for body, place in entry.places.items():
        if body not in recording.names:
            raise entry.unknown("body", body, recording.names, f"places.{body}")
        if without_side(place) not in parts():
            raise entry.unknown("place on the body", place, sorted(parts()), f"places.{body}")
    return replace(world, places=entry.places)


def _stream(entry: SensorEntry | ObjectEntry, bundle: _Bundle) -> Stream:
    """A recorded body's poses on the capture's clock."""
    own = bundle.bodies[entry.name].stream
    shifted = Stream(own.times - bundle.start_s, own.positions, own.orientations)
    return resampled(shifted, bundle.times, extend=entry.extend)


def _sensor(entry: SensorEntry, stream: Stream, shape: Shape | None) -> Sensor:
    if not any(entry.gaze):
        raise entry.error("gaze", "gaze of no length.", "It is a direction in the sensor's frame.")
    kind = entry.end_effector
    chain = LINKS.get(kind, kind)
    return Sensor(
        name=entry.name,
        end_effector=kind,
        side=entry.side,
        link=entry.link or (chain if entry.side == "none" else f"{entry.side}_{chain}"),
        stream=stream,
        role=Role(entry.role or ("attends" if kind in {"head", "eyes"} else "acts")),
        gaze=(entry.gaze[0], entry.gaze[1], entry.gaze[2]),
        eye=(entry.eye[0], entry.eye[1], entry.eye[2]),
        shape=shape,
        agent=entry.agent,
        part_of=entry.part_of,
    )


def _objects(bundle: _Bundle, shapes: Mapping[str, Shape | None]) -> list[TagObject]:
    """The objects in their order; supports are placed under those that are not placed so."""
    built: dict[str, TagObject] = {}
    for entry in sorted(bundle.objects, key=lambda each: bool(each.top_at_bottom_of)):
        shape, derivation = shapes[entry.name], ""
        if entry.name in bundle.bodies:
            stream = _stream(entry, bundle)
        else:
            if entry.top_at_bottom_of:
                pose, derivation = under_object(entry, shape, list(built.values()))
            else:
                pose = _fixed_pose(entry)
            stream = Stream(bundle.times, *(np.tile(each, (len(bundle.times), 1)) for each in pose))
        assumed = "; ".join(filter(None, (entry.assumed, derivation)))
        if shape and assumed:
            shape = replace(shape, source=ShapeSource.ASSUMED)
        names = [each.name for each in bundle.objects if each.name != entry.name]
        if entry.part_of and entry.part_of not in names:
            raise entry.unknown("object", entry.part_of, names, "part_of")
        bases, base = {each.name: each.part_of for each in bundle.objects}, entry.part_of
        for _ in names:
            base = bases.get(base, "") if base != entry.name else base
        if base == entry.name:
            raise entry.error(
                "part_of",
                f"{entry.name!r} would be a part of itself.",
                "It names the base, which is no part of the object.",
            )
        built[entry.name] = TagObject(
            name=entry.name,
            tag=TagType(entry.tag),
            stream=stream,
            shape=shape,
            kind=entry.kind or entry.name,
            assumed=assumed,
            deformable=entry.deformable,
            motion_floor_m=entry.motion_floor_m,
            mass_kg=entry.mass_kg,
            part_of=entry.part_of,
            closed_deg=entry.closed_deg,
            closed_m=entry.closed_m,
            agent=entry.agent,
        )
    return [built[entry.name] for entry in bundle.objects]


def _fixed_pose(entry: ObjectEntry) -> WorldPose:
    """The stated pose of an object in the world, whose z axis points up."""
    position = entry.position or []
    if len(position) != 3:
        raise entry.error(
            "position",
            f"position = {position}; without top_at_bottom_of it takes x, y and z.",
            "They are in the world, whose z axis points up whatever `up` says of the files.",
        )
    turn = geometry.rotations(geometry.unit(np.array([entry.orientation or (1.0, 0.0, 0.0, 0.0)])))
    return np.array(position), turn.as_quat(scalar_first=True)[0]


def _doubts(sensors: Sequence[SensorEntry], streams: Mapping[str, Stream]) -> Iterator[Notice]:
    """Notices of end-effectors that are almost known ones, and of gaps too long to interpolate."""
    for entry in sensors:
        stated, known = entry.end_effector, ", ".join(LINKS)
        near = get_close_matches(stated.lower(), LINKS, n=1)
        if near and stated not in LINKS:
            code = "end-effector-unknown"
            yield notice(code, entry.name, stated=stated, known=known, near=near[0])
    for name, stream in streams.items():
        times, last = stream.times, len(stream.times) - 1
        for first, end in geometry.runs(stream.lost):
            if times[min(end + 1, last)] - times[max(first - 1, 0)] > GAP_S:
                span = {"start_s": float(times[first]), "end_s": float(times[end])}
                yield notice("long-gap", name, **({} if (first, end) == (0, last) else span))


def _bodies(entry: ManySensors | ManyObjects, files: Files) -> Mapping[str, Any]:
    if entry.file not in files:
        raise entry.unknown("file", entry.file, files, "file")
    return files[entry.file].bodies


def _many_sensors(entry: ManySensors, files: Files) -> list[SensorEntry]:
    """A ``[[sensor]]`` for each body that a ``[[sensors_from]]`` stands for."""
    known = _bodies(entry, files)
    names = list(known) if entry.bodies == "*" else entry.bodies
    names = [names] if isinstance(names, str) else names
    for name in [*names, *entry.names, *entry.end_effectors, *entry.attends]:
        if name not in known:
            raise entry.unknown("body", name, known, "bodies")
    out = []
    for name in names:
        called = entry.names.get(name, name)
        starts = ((side, s) for side, s in sorted(entry.sides.items()) if called.startswith(s))
        side, start = next(starts, ("none", ""))
        values = {
            "name": constant_name(called),
            "end_effector": entry.end_effectors.get(
                name, constant_name(called.removeprefix(start))
            ),
            "side": side,
            "link": constant_name(called),
            "role": "attends" if name in entry.attends else "acts",
            "file": entry.file,
            "body": name,
            **entry.given({"shape", "extend"}),
        }
        out.append(validated(SensorEntry, values, entry.location))
    return out


def many_objects(entry: ManyObjects, files: Files) -> tuple[list[ObjectEntry], list[Notice]]:
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
    return out, [notice("objects-left-out", *left_out, objects=len(bodies))] if left_out else []


def grouped(capture: Capture) -> Capture:
    """The capture with one end-effector for each hand and foot that several sensors ride on.

    Sensors are parts of one end-effector if they are of one agent and one side, act, and what they
    are (``end_effector``) names a part of a hand or of a foot: a palm and its fingers, a heel and
    its toes. The one that stands for the whole, as a palm does, acts for all; if it is named after
    a part it is called after the whole, such as ``right_hand``. What a part touches the
    end-effector touches; only its own motion, and that of what acts for it, are reported.
    """
    groups: dict[tuple[str, str, str], list[tuple[int, Sensor]]] = {}
    for sensor in capture.sensors:
        found = part_of(sensor.end_effector)
        if found and sensor.side != "none" and sensor.role is Role.ACTS and not sensor.part_of:
            limb, rank = found
            _, named = part_of(sensor.name) or (limb, rank)
            key = (capture.agent_of(sensor), sensor.side, limb)
            groups.setdefault(key, []).append((max(rank, named), sensor))
    for (_, _, limb), group in groups.items():
        if len(group) > 1:
            _, leader = min(group, key=lambda each: each[0])
            others = [sensor for _, sensor in group if sensor is not leader]
            capture = _joined(capture, limb, leader, others)
    return capture


def _joined(capture: Capture, limb: str, leader: Sensor, others: Sequence[Sensor]) -> Capture:
    name = f"{leader.side}_{limb}"
    if leader.agent and capture.others:
        name = f"{leader.agent}_{name}"
    if name in capture.bodies or set(words_of(leader.name)) & set(WHOLES[limb]):
        name = leader.name
    link = leader.link
    if leader.end_effector != limb:
        link = f"{leader.side}_{LINKS.get(limb, limb)}"
    changed = {each.name: replace(each, part_of=name, link=link) for each in others}
    changed[leader.name] = replace(leader, name=name, end_effector=limb, link=link)
    renamed = {leader.name: name}
    pivots = [
        replace(each, first=renamed.get(each.first, each.first),
                second=renamed.get(each.second, each.second))
        for each in capture.pivot_contacts
    ]  # fmt: skip
    sensors = ", ".join(each.name for each in (leader, *others))
    return replace(
        capture,
        sensors=tuple(changed.get(each.name, each) for each in capture.sensors),
        pivot_contacts=tuple(pivots),
        notices=(*capture.notices, notice("sensors-grouped", name, sensors=sensors)),
    )
