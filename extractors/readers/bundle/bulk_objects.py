"""Many objects declared at once: the bodies of a file that have a shape here."""

from collections.abc import Mapping
from dataclasses import dataclass
from fnmatch import fnmatchcase
from typing import Any

from capar.model.capture import Notice, PivotContact, notice
from capar.model.errors import UnknownNameError
from extractors.readers.bundle.toml_table import Table
from extractors.readers.bundle.world import WorldRecording

OWN = frozenset({"file", "bodies", "kinds", "touched_by", "touched_within_m"})
"""Keys of an ``[[objects_from]]``; all others are those of an ``[[object]]``."""


@dataclass(frozen=True)
class BulkObjects:
    """The objects that a table stands for, each as a table of its own."""

    tables: tuple[Table, ...]
    pivot_contacts: tuple[PivotContact, ...]
    notices: tuple[Notice, ...]


def bulk_objects(table: Table, files: Mapping[str, WorldRecording]) -> BulkObjects:
    """The objects of an ``[[objects_from]]``; bodies of no known kind are counted and left out.

    ``bodies`` is a pattern (``*`` stands for anything); ``kinds`` gives, by the beginning of a
    body's name, ``name`` and ``shape`` and what else differs from kind to kind; all else is as in
    an ``[[object]]`` and holds for each. Several bodies of one kind are numbered in the order of
    their names. ``touched_by`` names a sensor whose pivot touches each within
    ``touched_within_m``.

    Raises:
        UnknownNameError: A file that is not there, or a pattern that no body fits.
        FileError: A kind has no name.
    """
    file = table.choice("file", files)
    pattern = table.text("bodies", "*")
    known = files[file].bodies
    bodies = sorted(each for each in known if fnmatchcase(each, pattern))
    if not bodies:
        raise UnknownNameError("body", pattern, known, where=table.where("bodies"))
    kinds = table.table("kinds") or table.derived({}, "kinds")
    shared = {key: table.raw(key) for key in table.given() if key not in OWN}
    found: list[Table] = []
    counts: dict[str, int] = {}
    left_out: list[str] = []
    for body in bodies:
        start = next((each for each in kinds.given() if body.startswith(each)), None)
        if start is None:
            left_out.append(body)
            continue
        kind = kinds.table(start)
        assert kind is not None
        name = kind.text("name")
        counts[name] = counts.get(name, 0) + 1
        number = f"_{counts[name]}" if counts[name] > 1 else ""
        own: dict[str, Any] = {key: kind.raw(key) for key in kind.given()}
        values = {**shared, "kind": name, **own, "name": f"{name}{number}"}
        found.append(table.derived({**values, "file": file, "body": body}, f"kinds.{start}"))
    return BulkObjects(
        tables=tuple(found),
        pivot_contacts=_pivots(table, [each.text("name") for each in found]),
        notices=_left_out(left_out, len(bodies)),
    )


def _pivots(table: Table, names: list[str]) -> tuple[PivotContact, ...]:
    hand = table.text("touched_by", "")
    if not hand:
        return ()
    distance = table.number("touched_within_m")
    return tuple(PivotContact(hand, name, distance) for name in names)


def _left_out(names: list[str], bodies: int) -> tuple[Notice, ...]:
    return (notice("objects-left-out", *names, objects=bodies),) if names else ()
