"""The capture bundle: a capture.toml that says what is what in the files it names."""

from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path

import numpy as np
from jaxtyping import Float

from capar.model.capture import (
    NAME,
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
from capar.model.errors import CaptureError, UnknownNameError
from capar.model.geometry import gaps
from extractors.readers.bundle.clock import GAP_S
from extractors.readers.bundle.declared import Declared, declared
from extractors.readers.bundle.names import constant_name
from extractors.readers.bundle.place import Place, find_place, open_bundle, takes
from extractors.readers.bundle.shapes import HANDS
from extractors.readers.bundle.toml_table import Table, expanded
from extractors.readers.bundle.world import UP, WorldRecording, to_world
from extractors.readers.files import source_of
from extractors.readers.formats.trc import UNITS
from extractors.readers.registry import read_recording

__all__ = ["Place", "find_place", "frame_times", "read_capture", "takes"]


def read_capture(place: str | Path) -> Capture:
    """The capture that a bundle describes.

    Args:
        place: A folder with a capture.toml, or that file, or a motion file beside it; then
            ``:take`` where the bundle has several.

    Raises:
        CaparError: A file, body or value is not as the capture.toml says; it names the line.
    """
    table, take = open_bundle(place)
    _prove_names(table)
    files = read_files(table)
    group = _declared(table, files)
    notices = [*(each for file in files.values() for each in file.notices), *group.notices]
    sources = [source_of(table.file, "capture.toml"), *(f.source for f in files.values())]
    sources[0] = replace(sources[0], path=table.file.name)
    agent, *others = _agents(table)
    _prove_agents(table, (agent, *others))
    contact = _contact(table)
    try:
        capture = Capture(
            name=_name(table, take),
            sensors=group.sensors,
            objects=group.objects,
            agent=agent,
            contact_tolerance_m=contact.get("tolerance_m"),
            contact_dropout_s=contact.get("dropout_s"),
            contact_minimum_s=contact.get("minimum_s"),
            pivot_contacts=_pivots(table, group),
            purposes=_purposes(table),
            force_transfer=table.flag("force_transfer"),
            sources=(*sources, *_once(group.sources)),
            notices=(*notices, *_gap_notices(group.sensors, group.objects)),
            others=tuple(others),
        )
    except CaptureError as error:
        raise CaptureError(f"{table.file}: {error}") from None
    table.close()
    return capture


def _once(sources: tuple[Source, ...]) -> list[Source]:
    return list(dict.fromkeys(sources))


def frame_times(place: str | Path, *, file: str = "") -> Float[np.ndarray, "frames"]:
    """When each frame of a source file was taken, in seconds of the capture's clock [s].

    With it the frame numbers of labels become times, whatever rate the capture has.
    """
    table, _ = open_bundle(place)
    files = read_files(table)
    if file and file not in files:
        raise UnknownNameError("file", file, files, where=table.where("files"))
    recording = files[file or next(iter(files))]
    return clock_of(recording) - _declared(table, files).start_s


def clock_of(recording: WorldRecording) -> Float[np.ndarray, "frames"]:
    """The clock of a file's frames [s]."""
    if recording.markers:
        return recording.marker_times
    return next(iter(recording.bodies.values())).times


def _name(table: Table, take: str) -> str:
    folder = table.file.parent
    name = _filled(table, "name", folder.name.strip(".") or folder.resolve().name)
    return f"{name}_{take}" if take and take not in name else name


def _filled(table: Table, key: str, default: str) -> str:
    """A text that is not empty."""
    text = table.text(key, default)
    if not text.strip():
        raise table.error(key, f"{key} is empty.", "Name it, or leave the line out.")
    return text


def _prove_names(table: Table) -> None:
    """Every sensor and object has a name of its own that rules can bear."""
    for kind in ("sensor", "object"):
        lines: dict[str, str] = {}
        for each in table.tables(kind):
            _filled(each, "kind", "thing")
            name, where = each.text("name"), each.where("name")
            if not NAME.fullmatch(name):
                rule = "names begin with a lower-case letter and hold letters, digits and _."
                raise each.error("name", f"{kind} {name!r}: {rule}", f"Like {constant_name(name)}.")
            if name in lines:
                raise each.error("name", f"two {kind}s are called {name!r}; also {lines[name]}.")
            lines[name] = where


def read_files(table: Table) -> dict[str, WorldRecording]:
    """Every file under ``[files]``, in the world.

    Raises:
        CaparError: One cannot be read, or its unit or axes are stated nowhere.
    """
    group = table.table("files")
    if group is None or not group.given():
        raise table.error("", "names no files.", 'Under [files]: motion = "recording.c3d".')
    return {name: _read_file(table, group, name) for name in group.given()}


def _read_file(table: Table, group: Table, name: str) -> WorldRecording:
    own = group.table(name) if isinstance(group.raw(name), dict) else None
    at, key = (own, "path") if own else (group, name)
    text = at.text(key)
    general = {"path", "unit", "up", "handedness", "parents"}
    options = {key: own.raw(key) for key in own.given() if key not in general} if own else {}
    recording = read_recording(expanded(at, key, text), options=options)
    recording = replace(recording, source=replace(recording.source, path=text))
    if own and "parents" in own:
        recording = replace(recording, parents=_parents(own, recording.names))
    word = own.choice("unit", UNITS, "") if own and "unit" in own else ""
    unit = word or ("" if recording.unit_m else table.choice("unit", UNITS, _ask(table, "unit")))
    up = own.choice("up", UP) if own and "up" in own else recording.up
    up = up or table.choice("up", UP, _ask(table, "up"))
    hand = own.choice("handedness", HANDS) if own and "handedness" in own else ""
    hand = hand or table.choice("handedness", HANDS, "right")
    _note_defaults(table)
    return to_world(
        recording,
        unit_m=UNITS[unit] if unit else float(recording.unit_m or 1.0),
        up=up,
        left_handed=HANDS[hand],
    )


def _note_defaults(table: Table) -> None:
    """A general unit or axis is no unknown key, even if every file states its own."""
    for key in ("unit", "up", "handedness"):
        table.raw(key)


def _ask(table: Table, key: str) -> str | None:
    if key in table:
        return None
    remedy = {"unit": f'unit = "mm" (or {", ".join(UNITS)})', "up": 'up = "z" (or "y")'}[key]
    raise table.error("files", f"no file states its {key}.", f"State it at the top: {remedy}.")


def _parents(table: Table, known: list[str]) -> dict[str, str]:
    parents = table.table("parents")
    if parents is None:
        return {}
    for joint in parents.given():
        for name in (joint, parents.text(joint)):
            if name not in known:
                raise UnknownNameError("body", name, known, where=parents.where(joint))
    return {joint: parents.text(joint) for joint in parents.given()}


def _declared(table: Table, files: Mapping[str, WorldRecording]) -> Declared:
    """Every sensor and object on one clock."""
    rate = table.number("rate_hz") if "rate_hz" in table else None
    if rate is not None and rate <= 0.0:
        raise table.error("rate_hz", f"rate_hz = {rate:g}; it is positive.")
    ends = [table.number(key) if key in table else None for key in ("from_s", "to_s")]
    return declared(table, files, rate_hz=rate, span_s=(ends[0], ends[1]))


def _agents(table: Table) -> tuple[Agent, ...]:
    """Who performs: one under ``[agent]``, several each under ``[[agent]]``."""
    if isinstance(table.raw("agent"), list):
        return tuple(map(_agent, table.tables("agent"))) or (Agent(),)
    one = table.table("agent")
    return (_agent(one) if one is not None else Agent(),)


def _agent(agent: Table) -> Agent:
    measures = agent.table("measures")
    values = {key: measures.number(key) for key in measures.given()} if measures else {}
    out = Agent(_filled(agent, "name", "agent"), _filled(agent, "kind", "person"), values)
    agent.close()
    return out


def _prove_agents(table: Table, agents: tuple[Agent, ...]) -> None:
    """Whom a sensor or an object names is there; a mistake is told with its line."""
    known = [each.name for each in agents]
    for each in (*table.tables("sensor"), *table.tables("object")):
        if each.text("agent", "") not in ("", *known):
            raise UnknownNameError("agent", each.text("agent"), known, where=each.where("agent"))


def _contact(table: Table) -> dict[str, float]:
    """When bodies count as touching, as far as the capture says."""
    contact = table.table("contact")
    if contact is None:
        return {}
    found = {key: contact.number(key) for key in _CONTACT if key in contact}
    contact.close()
    for key, value in found.items():
        if not 0.0 <= value < 1.0:
            raise contact.error(key, f"{key} = {value:g}; it lies in [0, 1).")
    return found


_CONTACT = ("tolerance_m", "dropout_s", "minimum_s")
"""What may stand under ``[contact]``."""


def _pivots(table: Table, group: Declared) -> tuple[PivotContact, ...]:
    out = []
    known = [*(each.name for each in group.sensors), *(each.name for each in group.objects)]
    for each in table.tables("pivot_contact"):
        for key in ("first", "second"):
            if each.text(key) not in known:
                raise UnknownNameError("body", each.text(key), known, where=each.where(key))
        pair = PivotContact(each.text("first"), each.text("second"), each.number("distance_m"))
        each.close()
        out.append(pair)
    return (*out, *group.pivot_contacts)


def _purposes(table: Table) -> tuple[Purpose, ...]:
    out = []
    for each in table.tables("purpose"):
        keys = ("action", "object", "goal")
        out.append(Purpose(each.text("purpose"), *(each.text(key, "") for key in keys)))
        each.close()
    return tuple(out)


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
        for first, end in gaps(stream.lost)
        if times[min(end + 1, last)] - times[max(first - 1, 0)] > GAP_S
    ]


def _gap_notice(name: str, stream: Stream, gap: tuple[int, int]) -> Notice:
    if gap == (0, len(stream.times) - 1):
        return notice("long-gap", name)
    start, end = stream.times[gap[0]], stream.times[gap[1]]
    return notice("long-gap", name, start_s=float(start), end_s=float(end))
