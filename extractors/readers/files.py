"""Files as bytes, text and rows of numbers, through gzip and xz, with a limit on expansion."""

import gzip
import hashlib
import io
import lzma
import zipfile
import zlib
from collections.abc import Sequence
from pathlib import Path
from typing import BinaryIO, cast

import numpy as np
from jaxtyping import Float

from capar.model.capture import Source
from capar.model.errors import FileError

EXPANDED_LIMIT = 1 << 30  # Bytes that a compressed file may expand to [B].
HEAD = 4096  # Bytes by which a format is recognised [B].
_DAMAGE = (EOFError, OSError, lzma.LZMAError, zlib.error, ValueError)


def check_file(path: Path) -> None:
    """Check that a path is a file with something in it.

    Raises:
        FileError: It is not there, is a folder, or is empty.
    """
    try:
        if not path.exists():
            raise FileError(path, "no such file.", _neighbours(path))
        if not path.is_file():
            raise FileError(path, "is a folder or a device, not a file.", "Name a file in it.")
        if path.stat().st_size == 0:
            raise FileError(path, "is empty.", "Copy or export it again.")
    except (OSError, ValueError) as error:
        raise FileError(str(path), f"cannot be opened: {error}.") from error


def _neighbours(path: Path) -> str:
    if not path.parent.is_dir():
        return f"There is no folder {path.parent} either."
    names = sorted(each.name for each in path.parent.iterdir())
    return f"The folder holds: {', '.join(names[:12]) or 'nothing'}{', ...' * (len(names) > 12)}."


def head_of(path: Path) -> bytes:
    """The first bytes of a file, expanded if it is compressed."""
    check_file(path)
    return _read(path, HEAD, whole=False)


def read_bytes(path: Path) -> bytes:
    """A file's content, expanded if it is compressed.

    Raises:
        FileError: It is missing, empty, cut short, or expands beyond ``EXPANDED_LIMIT``.
    """
    check_file(path)
    data = _read(path, EXPANDED_LIMIT + 1, whole=True)
    if len(data) > EXPANDED_LIMIT:
        raise FileError(path, f"expands to more than {EXPANDED_LIMIT >> 20} MiB.", "Split it.")
    return data


def read_text(path: Path) -> str:
    """A text file's content; bytes that are no UTF-8 are read as Latin-1."""
    data = read_bytes(path)
    try:
        return data.decode("utf-8-sig")
    except UnicodeDecodeError:
        return data.decode("latin-1")


def source_of(path: Path, form: str, *, recorded_at: str = "") -> Source:
    """The file's provenance: its path, format and SHA-256 as it lies on disk.

    Args:
        path: The file.
        form: The name of its format.
        recorded_at: When it says that it was recorded (ISO 8601); empty if it does not.
    """
    digest = hashlib.sha256()
    with path.open("rb") as file:
        while block := file.read(1 << 20):
            digest.update(block)
    return Source(str(path), form, digest.hexdigest(), recorded_at)


def check_zip(path: Path, limit: int = EXPANDED_LIMIT) -> list[str]:
    """The names in a zip archive, after a look at what it would expand to.

    Raises:
        FileError: It is damaged, or its members together expand beyond the limit.
    """
    try:
        with zipfile.ZipFile(path) as archive:
            members = archive.infolist()
    except (zipfile.BadZipFile, *_DAMAGE) as error:
        raise FileError(path, f"is a damaged zip archive: {error}.", "Copy it again.") from error
    expanded = sum(each.file_size for each in members)
    if expanded > limit:
        raise FileError(
            path,
            f"would expand to {expanded / (1 << 20):.0f} MiB; the limit is {limit >> 20} MiB.",
            "A motion or mesh file of that size is refused before it is expanded.",
        )
    return [each.filename for each in members]


def _read(path: Path, limit: int, *, whole: bool) -> bytes:
    try:
        with path.open("rb") as raw, _expanding(raw) as file:
            return file.read(limit)
    except PermissionError as error:
        what = f"cannot be read: {error.strerror}."
        raise FileError(path, what, "Grant yourself read permission.") from error
    except _DAMAGE as error:
        hint = "Copy it again." if whole else "It seems compressed, and damaged."
        raise FileError(path, f"cannot be read to its end: {error}.", hint) from error


def _expanding(raw: io.BufferedReader) -> BinaryIO:
    magic = raw.peek(6)[:6]
    if magic.startswith(b"\x1f\x8b"):
        return cast(BinaryIO, gzip.GzipFile(fileobj=raw))
    if magic.startswith(b"\xfd7zXZ\x00"):
        return cast(BinaryIO, lzma.LZMAFile(raw))
    return cast(BinaryIO, raw)


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
