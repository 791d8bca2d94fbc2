"""Qualisys TSV: markers (3D) or rigid bodies (6D), in millimetres."""

from pathlib import Path
from typing import Any

import numpy as np
from jaxtyping import Float
from scipy.spatial.transform import Rotation

from capar.model import geometry
from capar.model.capture import Stream
from capar.model.errors import CaptureError, FileError, UnknownNameError
from extractors.readers.files import read_rows, read_text, source_of
from extractors.readers.recording import Recording, iso_time, track, uniform_clock

MILLIMETRE = 0.001
_SIXD = 16
"""Columns a 6D body: X Y Z, three angles, residual, nine elements of the matrix by columns."""


def recognises(path: Path, head: bytes) -> bool:
    """Whether the file opens with its number of frames."""
    return head.removeprefix(b"\xef\xbb\xbf").lstrip()[:12] == b"NO_OF_FRAMES"


def read(path: Path, options: Any) -> Recording:
    """The markers or bodies of a TSV; a point at 0 0 0 was not seen.

    Raises:
        FileError: The header lacks what the rows need, or rows are missing.
    """
    lines = read_text(path).splitlines()
    header, start = _header(lines)
    kind = "BODY_NAMES" if "BODY_NAMES" in header else "MARKER_NAMES"
    for key in (kind, "NO_OF_FRAMES", "FREQUENCY"):
        if key not in header:
            raise UnknownNameError("header line", key, header, where=str(path))
    names = [each.strip() for each in header[kind] if each.strip()]
    if len(set(names)) != len(names):
        raise FileError(path, f"names a body or marker twice: {names}.")
    width = _SIXD if kind == "BODY_NAMES" else 3
    rows = _rows(path, lines, start, width * len(names))
    if header["NO_OF_FRAMES"][0] != str(len(rows)):
        raise FileError(
            path,
            f"states {header['NO_OF_FRAMES'][0]} frames and holds {len(rows)}.",
            "It is cut short; export it again.",
        )
    times = uniform_clock(len(rows), float(header["FREQUENCY"][0]))
    table = rows[:, rows.shape[1] - width * len(names) :].reshape(len(rows), len(names), width)
    stamp = iso_time(header.get("TIME_STAMP", [""])[0])
    source = source_of(path, "qualisys", recorded_at=stamp)
    if kind == "BODY_NAMES":
        bodies = {n: _body(n, times, table[:, i]) for i, n in enumerate(names)}
        return Recording(source=source, bodies=bodies, unit_m=MILLIMETRE)
    missing = (table == 0.0).all(axis=2)
    points = np.where(missing[..., None], np.nan, table)
    markers = {name: np.array(points[:, index]) for index, name in enumerate(names)}
    return Recording(source=source, markers=markers, marker_times=times, unit_m=MILLIMETRE)


def _header(lines: list[str]) -> tuple[dict[str, list[str]], int]:
    """Header lines by their first word, and the index of the line after them."""
    header: dict[str, list[str]] = {}
    for index, line in enumerate(lines):
        key, *values = line.rstrip("\t").split("\t")
        if not (key.isupper() and key.replace("_", "").isalpha() and values):
            return header, index
        header[key] = values
    return header, len(lines)


def _rows(
    path: Path, lines: list[str], start: int, columns: int
) -> Float[np.ndarray, "frames columns"]:
    """The numbers, with or without a line of column names and leading Frame and Time."""
    if start < len(lines) and not _numeric(lines[start]):
        start += 1
    if start >= len(lines):
        raise FileError(path, "has a header and no rows of numbers.", "Export it again.")
    wide = len(lines[start].rstrip("\t").split("\t")) > columns
    return read_rows(
        lines[start:], path=path, first_line=start + 1, columns=columns + 2 * wide, delimiter="\t"
    )


def _numeric(line: str) -> bool:
    try:
        float(line.split("\t", maxsplit=1)[0])
    except ValueError:
        return False
    return True


def _body(
    name: str, times: Float[np.ndarray, "frames"], values: Float[np.ndarray, "frames 16"]
) -> Stream:
    matrices = values[:, 7:].reshape(-1, 3, 3).transpose(0, 2, 1)
    lost = (matrices == 0.0).all(axis=(1, 2)) | (values[:, 6] < 0.0)
    lost |= np.isnan(values).any(axis=1)
    orientations = np.full((len(values), 4), np.nan)
    orientations[~lost] = rotation_quaternions(name, matrices[~lost])
    positions = np.where(lost[:, None], np.nan, values[:, :3])
    return track(name, times, positions, orientations)


def rotation_quaternions(
    name: str, matrices: Float[np.ndarray, "frames 3 3"]
) -> Float[np.ndarray, "frames 4"]:
    """Unit quaternions (w x y z) of rotation matrices.

    Raises:
        CaptureError: A matrix is a reflection, or no rotation at all.
    """
    if not len(matrices):
        return np.empty((0, 4))
    determinants = np.linalg.det(matrices)
    product = matrices @ matrices.transpose(0, 2, 1)
    skew = np.abs(product - np.eye(3)).max(axis=(1, 2))
    bad = np.flatnonzero(~(skew < 0.02))
    if bad.size:
        raise CaptureError(f"body {name!r}: no rotation matrix at frame {bad[0]}")
    mirrored = np.flatnonzero(determinants < 0.0)
    if mirrored.size:
        raise CaptureError(
            f"body {name!r}: the matrix at frame {mirrored[0]} is a reflection (determinant "
            f"{determinants[mirrored[0]]:.3f}), in {mirrored.size} of {len(matrices)} frames; "
            "axes of the body and of the world are of different handedness"
        )
    return geometry.quaternions(Rotation.from_matrix(matrices))
