"""TRC: markers over time, with the unit in the header."""

from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

import numpy as np
from jaxtyping import Float

from capar.model.capture import Notice, notice
from capar.model.errors import FileError, UnknownNameError
from extractors.readers.files import read_rows, read_text, source_of
from extractors.readers.recording import UNITS, Recording, contradicted_rate, unrounded


def recognises(path: Path, head: bytes) -> bool:
    """Whether the file opens with the line of its file type."""
    return head.removeprefix(b"\xef\xbb\xbf").lstrip()[:12] == b"PathFileType"


def read(path: Path, options: Any) -> Recording:
    """The markers of a TRC file; empty cells and NaN are missing points.

    Cells are separated by tabs or by commas; between tabs, numbers may have decimal commas.

    Raises:
        FileError: The header is incomplete or names a marker twice, or rows are missing.
    """
    lines = read_text(path).splitlines()
    if len(lines) < 6:
        raise FileError(path, f"has {len(lines)} lines; a TRC has five of header, then rows.")
    delimiter = "\t" if "\t" in lines[3] else ","
    if delimiter == "\t" and not any("." in line for line in lines[5:8]):
        lines[2:3] = [lines[2].replace(",", ".")]
        lines[5:] = [line.replace(",", ".") for line in lines[5:]]
    lines[5:] = [line if line.strip(" \t,") else "" for line in lines[5:]]
    header = _header(path, lines, delimiter)
    names = _markers(path, lines[3], delimiter)
    table = read_rows(
        lines[5:], path=path, first_line=6, columns=2 + 3 * len(names), delimiter=delimiter
    )
    points = table[:, 2:].reshape(len(table), len(names), 3)
    times = unrounded(table[:, 1], _rate_hz(header))
    return Recording(
        source=source_of(path, "trc"),
        markers={name: np.array(points[:, index]) for index, name in enumerate(names)},
        marker_times=times,
        unit_m=UNITS.get(header["Units"].lower()),
        notices=tuple(_contradictions(header, times)),
    )


def _header(path: Path, lines: list[str], delimiter: str) -> dict[str, str]:
    """The values of the header's third line by the names in its second."""
    rows = [[cell.strip() for cell in line.split(delimiter)] for line in lines[1:3]]
    header = {name: value for name, value in zip(*rows, strict=False) if name}
    for key in ("NumFrames", "Units"):
        if key not in header:
            raise UnknownNameError("header cell", key, header, where=f"{path}:2")
    return header


def _markers(path: Path, line: str, delimiter: str) -> list[str]:
    """The names of the markers in the header's fourth line."""
    names = [cell.strip() for cell in line.split(delimiter)[2:] if cell.strip()]
    twice = sorted({name for name in names if names.count(name) > 1})
    if twice:
        raise FileError(f"{path}:4", f"names a marker twice: {', '.join(twice)}.", "Rename one.")
    return names


def _contradictions(
    header: Mapping[str, str], times: Float[np.ndarray, "frames"]
) -> Iterator[Notice]:
    """Notices of a number of frames or a rate in the header that the rows contradict."""
    if header["NumFrames"] != str(len(times)):
        yield notice("frames-missing", stated=header["NumFrames"], frames=len(times))
    stated_hz = _rate_hz(header)
    rate_hz = None if stated_hz is None else contradicted_rate(times, stated_hz)
    if stated_hz is not None and rate_hz is not None:
        yield notice("rate-contradicted", stated_hz=stated_hz, rate_hz=rate_hz)


def _rate_hz(header: Mapping[str, str]) -> float | None:
    """The rate that the header states [Hz]."""
    try:
        return float(header.get("DataRate", ""))
    except ValueError:
        return None
