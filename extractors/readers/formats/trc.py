"""TRC: markers over time, with the unit in the header."""

from pathlib import Path
from typing import Any

import numpy as np

from capar.model.capture import notice
from capar.model.errors import FileError, UnknownNameError
from extractors.readers.file_access import number_of, opens_with, read_rows, read_text, source_of
from extractors.readers.recording import UNITS, Recording, contradicted_rate, unrounded


def recognises(path: Path, head: bytes) -> bool:
    """Whether the file opens with the line of its file type."""
    return opens_with(head, b"PATHFILETYPE")


def read(path: Path, options: Any) -> Recording:
    """The markers of a TRC file; empty cells and NaN are missing points.

    Cells are separated by tabs, by commas or by runs of spaces; between tabs, numbers may have
    decimal commas. A number of frames or a rate in the header that the rows contradict gives a
    notice.

    Raises:
        FileError: The header is incomplete or names a marker twice, or rows are missing.
    """
    lines = read_text(path).splitlines()
    if len(lines) < 6:
        raise FileError(path, f"has {len(lines)} lines; a TRC has five of header, then rows.")
    delimiter = next((each for each in "\t," if each in lines[3]), None)
    if delimiter == "\t" and not any("." in line for line in lines[5:8]):
        lines[2:3] = [lines[2].replace(",", ".")]
        lines[5:] = [line.replace(",", ".") for line in lines[5:]]
    lines[5:] = [line if line.strip(" \t,") else "" for line in lines[5:]]
    rows = [[cell.strip() for cell in line.split(delimiter)] for line in lines[1:4]]
    header = {name: value for name, value in zip(*rows[:2], strict=False) if name}
    for key in ("NumFrames", "Units"):
        if key not in header:
            raise UnknownNameError("header cell", key, header, where=f"{path}:2")
    names = [cell for cell in rows[2][2:] if cell]
    twice = sorted({name for name in names if names.count(name) > 1})
    if twice:
        raise FileError(f"{path}:4", f"names a marker twice: {', '.join(twice)}.", "Rename one.")
    table = read_rows(
        lines[5:], path=path, first_line=6, columns=2 + 3 * len(names), delimiter=delimiter
    )
    points = table[:, 2:].reshape(len(table), len(names), 3)
    stated_hz = number_of(header.get("DataRate", ""))
    times = unrounded(table[:, 1], stated_hz)
    notices = []
    if header["NumFrames"] != str(len(times)):
        notices.append(notice("frames-missing", stated=header["NumFrames"], frames=len(times)))
    if stated_hz is not None and (rate_hz := contradicted_rate(times, stated_hz)) is not None:
        notices.append(notice("rate-contradicted", stated_hz=stated_hz, rate_hz=rate_hz))
    return Recording(
        source=source_of(path, "trc"),
        markers={name: np.array(points[:, index]) for index, name in enumerate(names)},
        marker_times=times,
        unit_m=UNITS.get(header["Units"].lower()),
        notices=tuple(notices),
    )
