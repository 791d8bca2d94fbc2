"""OptiTrack Motive CSV (format versions 1.2x): rigid bodies, bones and markers, y up."""

import csv
from contextlib import suppress
from datetime import datetime
from pathlib import Path
from typing import Any

import numpy as np
from jaxtyping import Float
from scipy.spatial.transform import Rotation

from capar.model import geometry
from capar.model.errors import FileError
from extractors.readers.file_access import number_of, opens_with, read_rows, read_text, source_of
from extractors.readers.names import parents_by_names
from extractors.readers.recording import Recording, track, unrounded

LENGTHS_M = {"meters": 1.0, "centimeters": 0.01, "millimeters": 0.001, "inches": 0.0254,
             "feet": 0.3048}  # fmt: skip
EXPECTED = (" Marker", " Bone Marker")
"""How types end that are markers where a solved body or bone expects them."""

PLACE = ("PositionX", "PositionY", "PositionZ")
TURN = ("RotationW", "RotationX", "RotationY", "RotationZ")


def recognises(path: Path, head: bytes) -> bool:
    """Whether the file opens with its format version."""
    return opens_with(head.replace(b'"', b""), b"FORMAT VERSION,")


def read(path: Path, options: Any) -> Recording:
    """The rigid bodies, bones and markers of an export; what has empty cells was not seen.

    Euler angles are degrees about axes that turn with the body, in the stated order. A marker that
    is there both as it was seen and as its body expects it is read as it was seen.

    Raises:
        FileError: The header lacks what the columns need, or bones are relative to their parents.
    """
    lines = read_text(path).splitlines()
    end = next((n for n, each in enumerate(lines) if each.lstrip('"').startswith("Frame")), 0)
    axes = _cells(lines[end])
    header = [_cells(each, len(axes)) for each in lines[1:end] if each.strip(" ,\t")]
    if len(header) < 3:
        raise FileError(
            path,
            "lacks the rows of types, names and kinds above its columns.",
            "Export it again, with header information.",
        )
    cells = _cells(lines[0])
    stated = dict(zip(cells[::2], cells[1::2], strict=False))
    table = read_rows(
        lines[end + 1 :], path=path, first_line=end + 2, columns=len(axes), delimiter=","
    )
    if (stated_frames := stated.get("Total Exported Frames")) not in {None, "", str(len(table))}:
        problem = f"states {stated_frames} exported frames and holds {len(table)}."
        raise FileError(path, problem, "It is cut short; export it again.")
    times = unrounded(table[:, 1], number_of(stated.get("Export Frame Rate", "")))
    groups = _groups(path, header, axes)
    if any(kind == "Bone" for kind, _ in groups) and stated.get("Coordinate Space") == "Local":
        raise FileError(
            path, "has bones relative to their parents.", "Export it with Coordinate Space Global."
        )
    bodies, markers = {}, {}
    for (kind, name), columns in groups.items():
        places = table[:, [columns[each] for each in PLACE]]
        if "RotationX" in columns:
            turns = _orientations(path, stated.get("Rotation Type", ""), table, columns)
            bodies[name] = track(name, times, places, turns)
        elif not (kind.endswith(EXPECTED) and ("Marker", name) in groups):
            markers[name] = places
    return Recording(
        source=source_of(path, "motive", recorded_at=_recorded_at(stated)),
        bodies=bodies,
        markers=markers,
        marker_times=times if markers else np.empty(0),
        unit_m=LENGTHS_M.get(stated.get("Length Units", "").lower()),
        up="y",
        parents=_parents(header, groups),
    )


def _cells(line: str, count: int = 0) -> list[str]:
    """The cells of a line, with empty ones after them up to so many."""
    cells = [each.strip() for each in next(csv.reader([line]), [])]
    return cells + [""] * (count - len(cells))


Groups = dict[tuple[str, str], dict[str, int]]
"""The number of each column, such as ``RotationW``, by the type and name of what has it."""


def _groups(path: Path, header: list[list[str]], axes: list[str]) -> Groups:
    """The columns of everything that has a position.

    Raises:
        FileError: Two columns are of one name, or a position is not whole.
    """
    out: Groups = {}
    for n, (kind, name, what, axis) in enumerate(
        zip(header[0], header[1], header[-1], axes, strict=False)
    ):
        if n > 1 and kind and what + axis in {*PLACE, *TURN}:
            own = out.setdefault((kind, name), {})
            if own.setdefault(what + axis, n) != n:
                raise FileError(path, f"has two {kind.lower()} columns {what + axis} of {name!r}.")
    for (_, name), own in out.items():
        if not {*PLACE} <= {*own}:
            raise FileError(
                path, f"lacks a column of the position of {name!r}.", "Export it again."
            )
    return out


def _orientations(
    path: Path, order: str, table: Float[np.ndarray, "rows columns"], columns: dict[str, int]
) -> Float[np.ndarray, "rows 4"]:
    """Unit quaternions w x y z of quaternions or angles; NaN where a cell is empty.

    Raises:
        FileError: There are three angles and no order of them.
    """
    if "RotationW" in columns:
        return geometry.unit(table[:, [columns[each] for each in TURN]])
    if sorted(order) != ["X", "Y", "Z"]:
        raise FileError(
            path, f"has three angles and Rotation Type {order!r}.", "It is XYZ, or such an order."
        )
    angles = table[:, [columns[f"Rotation{axis}"] for axis in order]]
    return geometry.quaternions(Rotation.from_euler(order, angles, degrees=True))


def _parents(header: list[list[str]], groups: Groups) -> dict[str, str]:
    """The parent of each bone, by the id that the file states or by what the names tell."""
    bones = {name: min(own.values()) for (kind, name), own in groups.items() if kind == "Bone"}
    rows = {row[1]: row for row in header[2:-1]}
    if not {"ID", "Parent"} <= {*rows}:
        return parents_by_names(bones)
    ids = {rows["ID"][column]: name for name, column in bones.items()}
    stated = {name: ids.get(rows["Parent"][column]) for name, column in bones.items()}
    return {name: parent for name, parent in stated.items() if parent}


def _recorded_at(stated: dict[str, str]) -> str:
    """The start of the take as ISO 8601; empty if it is not stated."""
    with suppress(ValueError):
        text = stated.get("Capture Start Time", "")
        return datetime.strptime(text, "%Y-%m-%d %I.%M.%S.%f %p").isoformat(timespec="milliseconds")
    return ""
