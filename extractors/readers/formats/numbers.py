"""Rows of numbers in text, with the line named where a cell is no number."""

import io
from collections.abc import Sequence
from pathlib import Path

import numpy as np
from jaxtyping import Float

from capar.model.errors import FileError

_MISSING = {"", "nan", "na", "null", "none"}


def read_rows(
    lines: Sequence[str], *, path: Path, first_line: int, columns: int, delimiter: str | None
) -> Float[np.ndarray, "rows columns"]:
    """A table of numbers; empty cells are NaN, blank lines are skipped.

    Args:
        lines: The rows as text.
        path: The file, for messages.
        first_line: The number of the first of these lines in the file, from one.
        columns: How many cells each row has; a row may have empty ones after them.
        delimiter: What parts cells; None for any white space.

    Raises:
        FileError: A row is too short, too long, or a cell is no number.
    """
    if columns <= 0:
        raise FileError(path, "names no columns.")
    rows = [each for each in lines if each.strip()]
    if not rows:
        raise FileError(path, "has a header and no rows of numbers.", "Export it again.")
    try:
        table = np.loadtxt(io.StringIO("\n".join(rows)), delimiter=delimiter, ndmin=2)
    except ValueError:
        table = np.empty((0, 0))
    if table.shape == (len(rows), columns):
        return table
    numbered = [(n, each) for n, each in enumerate(lines, first_line) if each.strip()]
    return np.array([_row(path, n, each, columns, delimiter) for n, each in numbered])


def _row(path: Path, line: int, text: str, columns: int, delimiter: str | None) -> list[float]:
    cells = text.rstrip("\r\n").split(delimiter)
    while len(cells) > columns and not cells[-1].strip():
        cells.pop()
    if len(cells) != columns:
        raise FileError(
            f"{path}:{line}",
            f"{len(cells)} cells where the header names {columns}.",
            "The file is cut short or damaged; export it again.",
        )
    return [_number(path, line, cell.strip()) for cell in cells]


def _number(path: Path, line: int, cell: str) -> float:
    if cell.lower() in _MISSING:
        return np.nan
    try:
        return float(cell)
    except ValueError:
        raise FileError(f"{path}:{line}", f"{cell[:40]!r} is no number.") from None
