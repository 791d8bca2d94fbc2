"""Files as bytes, text and rows of numbers, through gzip and xz, with a limit on expansion."""

import gzip
import hashlib
import lzma
import zipfile
import zlib
from collections.abc import Sequence
from difflib import get_close_matches
from importlib import import_module
from pathlib import Path
from typing import Any

import numpy as np
from jaxtyping import Float

from capar.model.capture import Source
from capar.model.errors import CaparError, FileError

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
            raise FileError(path, "no such file.", neighbours(path))
        if not path.is_file():
            raise FileError(path, "is a folder or a device, not a file.", "Name a file in it.")
        if path.stat().st_size == 0:
            raise FileError(path, "is empty.", "Copy or export it again.")
    except (OSError, ValueError) as error:
        raise FileError(str(path), f"cannot be opened: {error}.") from error


def neighbours(path: Path) -> str:
    """What the nearest folder of a missing file holds, and which of that may be meant."""
    while path.parent != path and not path.parent.is_dir():
        path = path.parent
    names = sorted(entry.name for entry in path.parent.glob("[!.]*"))
    holds = f"{', '.join(names[:12]) or 'nothing'}{', ...' * (len(names) > 12)}"
    meant = "".join(f" Did you mean {name!r}?" for name in get_close_matches(path.name, names, n=1))
    return f"The folder {path.parent} holds: {holds}.{meant}"


def read_bytes(path: Path, limit: int | None = None) -> bytes:
    """A file's content, or so many first bytes of it, expanded if it is compressed.

    Raises:
        FileError: It is missing, empty, cut short, or expands beyond ``EXPANDED_LIMIT``.
    """
    check_file(path)
    wanted = EXPANDED_LIMIT + 1 if limit is None else limit
    try:
        with path.open("rb") as raw:
            magic = raw.peek(6)[:6]
            if magic.startswith(b"\x1f\x8b"):
                data = gzip.GzipFile(fileobj=raw).read(wanted)
            else:
                is_xz = magic.startswith(b"\xfd7zXZ\x00")
                data = (lzma.LZMAFile(raw) if is_xz else raw).read(wanted)  # noqa: SIM115
    except PermissionError as error:
        what = f"cannot be read: {error.strerror}."
        raise FileError(path, what, "Grant yourself read permission.") from error
    except _DAMAGE as error:
        hint = "Copy it again." if limit is None else "It seems compressed, and damaged."
        raise FileError(path, f"cannot be read to its end: {error}.", hint) from error
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
    with path.open("rb") as file:
        return Source(str(path), form, hashlib.file_digest(file, "sha256").hexdigest(), recorded_at)


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


def arrow() -> Any:
    """The module pyarrow.

    Raises:
        CaparError: It is not installed.
    """
    try:
        return import_module("pyarrow")
    except ModuleNotFoundError:
        raise CaparError(
            "Parquet needs pyarrow, which is not installed; it comes with the extra 'labels': "
            "pip install 'capar[labels]'"
        ) from None


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
        table = np.loadtxt(rows, delimiter=delimiter, ndmin=2)
    except ValueError:
        table = np.empty((0, 0))
    if table.shape == (len(rows), columns):
        return table
    out = []
    for number, line in enumerate(lines, first_line):
        cells = line.rstrip("\r\n").split(delimiter)
        while len(cells) > columns and not cells[-1].strip():
            cells.pop()
        if line.strip() and len(cells) != columns:
            raise FileError(
                f"{path}:{number}",
                f"{len(cells)} cells where the header names {columns}.",
                "The file is cut short or damaged; export it again.",
            )
        values = [np.nan if c.strip().lower() in _MISSING else number_of(c) for c in cells]
        if line.strip() and None in values:
            cell = cells[values.index(None)].strip()
            raise FileError(f"{path}:{number}", f"{cell[:40]!r} is no number.")
        out += [values] if line.strip() else []
    return np.array(out, dtype=float)


def number_of(text: str) -> float | None:
    """The number that a text is; None if it is none."""
    try:
        return float(text)
    except ValueError:
        return None


def opens_with(head: bytes, word: bytes) -> bool:
    """Whether a text file opens with a word, in whatever case."""
    return head.removeprefix(b"\xef\xbb\xbf").lstrip()[: len(word)].upper() == word
