"""Qualisys TSV: markers (3D) or rigid bodies (6D), in millimetres."""

from pathlib import Path
from typing import Any

import numpy as np

from capar.model.errors import FileError, UnknownNameError
from extractors.readers.file_access import number_of, opens_with, read_rows, read_text, source_of
from extractors.readers.recording import Recording, iso_time, track_of_matrices, uniform_clock

MILLIMETRE = 0.001
_SIXD = 16
"""Columns a 6D body: X Y Z, three angles, residual, nine elements of the matrix by columns."""


def recognises(path: Path, head: bytes) -> bool:
    """Whether the file opens with its number of frames."""
    return opens_with(head, b"NO_OF_FRAMES")


def read(path: Path, options: Any) -> Recording:
    """The markers or bodies of a TSV; a point at 0 0 0 was not seen.

    Raises:
        FileError: The header lacks what the rows need, or rows are missing.
    """
    lines = read_text(path).splitlines()
    header: dict[str, list[str]] = {}
    start = 0
    for line in lines:
        key, *values = line.rstrip("\t").split("\t")
        if not (key.isupper() and key.replace("_", "").isalpha() and values):
            break
        header[key] = values
        start += 1
    kind = "BODY_NAMES" if "BODY_NAMES" in header else "MARKER_NAMES"
    for key in (kind, "NO_OF_FRAMES", "FREQUENCY"):
        if key not in header:
            raise UnknownNameError("header line", key, header, where=str(path))
    names = [each.strip() for each in header[kind] if each.strip()]
    if len(set(names)) != len(names):
        raise FileError(path, f"names a body or marker twice: {names}.")
    width = _SIXD if kind == "BODY_NAMES" else 3
    columns = width * len(names)
    if start < len(lines) and number_of(lines[start].split("\t", maxsplit=1)[0]) is None:
        start += 1  # names of columns
    if start >= len(lines):
        raise FileError(path, "has a header and no rows of numbers.", "Export it again.")
    wide = len(lines[start].rstrip("\t").split("\t")) > columns  # Frame and Time come first
    rows = read_rows(
        lines[start:], path=path, first_line=start + 1, columns=columns + 2 * wide, delimiter="\t"
    )
    if header["NO_OF_FRAMES"][0] != str(len(rows)):
        raise FileError(
            path,
            f"states {header['NO_OF_FRAMES'][0]} frames and holds {len(rows)}.",
            "It is cut short; export it again.",
        )
    times = uniform_clock(len(rows), float(header["FREQUENCY"][0]))
    table = rows[:, 2 * wide :].reshape(len(rows), len(names), width)
    stamp = iso_time(header.get("TIME_STAMP", [""])[0])
    source = source_of(path, "qualisys", recorded_at=stamp)
    if kind == "MARKER_NAMES":
        points = np.where((table == 0.0).all(axis=2, keepdims=True), np.nan, table)
        markers = {name: np.array(points[:, index]) for index, name in enumerate(names)}
        return Recording(source=source, markers=markers, marker_times=times, unit_m=MILLIMETRE)
    bodies = {}
    for index, name in enumerate(names):
        own = table[:, index]
        matrices = own[:, 7:].reshape(-1, 3, 3).transpose(0, 2, 1)
        lost = (own[:, 6] < 0.0) | np.isnan(own).any(axis=1)
        bodies[name] = track_of_matrices(name, times, own[:, :3], matrices, lost)
    return Recording(source=source, bodies=bodies, unit_m=MILLIMETRE)
