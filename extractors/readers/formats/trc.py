"""TRC: markers over time, with the unit in the header."""

from pathlib import Path
from typing import Any

import numpy as np

from capar.model.errors import FileError
from extractors.readers.files import read_text, source_of
from extractors.readers.formats.numbers import read_rows
from extractors.readers.recording import UNITS, Recording


def recognises(path: Path, head: bytes) -> bool:
    """Whether the file opens with the line of its file type."""
    return head.removeprefix(b"\xef\xbb\xbf").lstrip()[:12] == b"PathFileType"


def read(path: Path, options: Any) -> Recording:
    """The markers of a TRC file; empty cells and NaN are missing points.

    Raises:
        FileError: The header is incomplete, or rows are missing.
    """
    lines = read_text(path).splitlines()
    if len(lines) < 6:
        raise FileError(path, f"has {len(lines)} lines; a TRC has five of header, then rows.")
    header = dict(zip(lines[1].split(), lines[2].split(), strict=False))
    names = [each.strip() for each in lines[3].split("\t")[2:] if each.strip()]
    if "NumFrames" not in header or "Units" not in header or len(set(names)) != len(names):
        raise FileError(path, "lacks NumFrames or Units, or names a marker twice.")
    table = read_rows(
        lines[5:], path=path, first_line=6, columns=2 + 3 * len(names), delimiter="\t"
    )
    if header["NumFrames"] != str(len(table)):
        raise FileError(path, f"states {header['NumFrames']} frames and holds {len(table)}.")
    points = table[:, 2:].reshape(len(table), len(names), 3)
    return Recording(
        source=source_of(path, "trc"),
        markers={name: np.array(points[:, index]) for index, name in enumerate(names)},
        marker_times=table[:, 1],
        unit_m=UNITS.get(header["Units"].lower()),
    )
