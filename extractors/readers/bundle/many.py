"""Many sensors or objects declared at once: one for each of many bodies of a file."""

from collections.abc import Mapping
from fnmatch import fnmatchcase
from typing import TYPE_CHECKING, Any

from capar.model.capture import Notice, PivotContact, notice
from extractors.readers.bundle.world import WorldRecording
from extractors.readers.schema.document import validated
from extractors.readers.schema.names import constant_name

if TYPE_CHECKING:
    from extractors.readers.schema.bodies import ManyObjects, ManySensors, ObjectEntry, SensorEntry


def many_sensors(entry: "ManySensors", files: Mapping[str, WorldRecording]) -> "list[SensorEntry]":
    """A ``[[sensor]]`` for each body that a ``[[sensors_from]]`` stands for.

    Raises:
        UnknownNameError: A file or body that is not there.
    """
    from extractors.readers.schema.bodies import SensorEntry

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
    entry: "ManySensors | ManyObjects", files: Mapping[str, WorldRecording]
) -> Mapping[str, Any]:
    if entry.file not in files:
        raise entry.unknown("file", entry.file, files, "file")
    return files[entry.file].bodies


def many_objects(
    entry: "ManyObjects", files: Mapping[str, WorldRecording]
) -> "tuple[list[ObjectEntry], list[Notice]]":
    """An ``[[object]]`` for each body that an ``[[objects_from]]`` stands for.

    Several bodies of one kind are numbered in the order of their names. Bodies of no stated kind
    are left out; a notice counts them.

    Raises:
        UnknownNameError: A file that is not there, or a pattern that no body fits.
        FileError: A kind lacks a key that an object needs.
    """
    from extractors.readers.schema.bodies import ObjectEntry, ObjectTraits

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


def pivots(entry: "ManyObjects", objects: "list[ObjectEntry]") -> list[PivotContact]:
    """The contacts by distance of the sensor in ``touched_by`` with every object."""
    if entry.touched_within_m is None:
        return []
    return [PivotContact(entry.touched_by, each.name, entry.touched_within_m) for each in objects]


def _left_out(names: list[str], bodies: int) -> list[Notice]:
    if not names:
        return []
    return [notice("objects-left-out", *names, objects=bodies)]
