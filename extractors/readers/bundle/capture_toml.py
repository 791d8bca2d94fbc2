"""The capture bundle: a capture.toml that says what is what in the files it names."""

from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from jaxtyping import Float

from capar.model.capture import (
    Agent,
    Capture,
    Notice,
    PivotContact,
    Purpose,
    Sensor,
    Source,
    Stream,
    TagObject,
    notice,
)
from capar.model.errors import CaptureError, FileError
from capar.model.geometry import runs
from extractors.contact.contacts import with_meeting_hands
from extractors.readers.body_names.body_names import parts, without_side
from extractors.readers.bundle.declared import Declared, declared
from extractors.readers.bundle.grouping import grouped
from extractors.readers.bundle.location import find_place, open_bundle, takes
from extractors.readers.bundle.resampling import GAP_S
from extractors.readers.bundle.world import WorldRecording, to_world
from extractors.readers.files import source_of
from extractors.readers.recording import UNITS
from extractors.readers.registry import READER_OPTIONS, read_recording, reader_for
from extractors.readers.schema.document import expanded, validated

if TYPE_CHECKING:
    from extractors.readers.schema.capture import CaptureFile, MotionFile

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
            name=_name(document, take),
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
    document: "CaptureFile", files: Mapping[str, WorldRecording], group: Declared
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


def _name(document: "CaptureFile", take: str) -> str:
    folder = document.file_path.parent
    name = document.name or folder.name.strip(".") or folder.resolve().name
    return f"{name}_{take}" if take and take not in name else name


def _check_names(document: "CaptureFile") -> None:
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


def read_files(document: "CaptureFile") -> dict[str, WorldRecording]:
    """Every file under ``[files]``, in the world.

    Raises:
        CaparError: One cannot be read, or its unit or axes are stated nowhere.
    """
    return {name: _read_file(document, name) for name in document.files}


def _read_file(document: "CaptureFile", name: str) -> WorldRecording:
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


def _entry(document: "CaptureFile", name: str) -> "MotionFile":
    """The table of a motion file, of which a path alone may be given."""
    from extractors.readers.schema.capture import MotionFile

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


def _unit_m(document: "CaptureFile", entry: "MotionFile", stated_m: float | None) -> float:
    """Metres per unit of a file: as its own table, the file, or the general key says."""
    if not entry.unit and stated_m:
        return stated_m
    unit = entry.unit or document.unit
    if unit is None:
        raise _unstated(document, "unit", f'unit = "mm" (or {", ".join(UNITS)})')
    return UNITS[unit] if isinstance(unit, str) else unit


def _up(document: "CaptureFile", entry: "MotionFile", stated: str | None) -> str:
    """The upward axis of a file: as its own table, the file, or the general key says."""
    up = entry.up or stated or document.up
    if up is None:
        raise _unstated(document, "up", 'up = "z" (or "y")')
    return up


def _unstated(document: "CaptureFile", key: str, example: str) -> FileError:
    remedy = f"State it at the top: {example}."
    return document.error("files", f"no file states its {key}.", remedy)


def _parents(entry: "MotionFile", known: list[str]) -> dict[str, str]:
    for joint, parent in entry.parents.items():
        for name in (joint, parent):
            if name not in known:
                raise entry.unknown("body", name, known, f"parents.{joint}")
    return entry.parents


def _places(entry: "MotionFile", known: list[str]) -> dict[str, str]:
    for name, place in entry.places.items():
        if name not in known:
            raise entry.unknown("body", name, known, f"places.{name}")
        if without_side(place) not in parts():
            raise entry.unknown("place on the body", place, sorted(parts()), f"places.{name}")
    return entry.places


def _pivots(document: "CaptureFile", group: Declared) -> list[PivotContact]:
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
