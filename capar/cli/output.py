"""How commands print JSON and tables, write files whole or not at all, and report failures."""

import dataclasses
import errno
import os
import signal
import sys
from collections.abc import Callable, Collection, Iterable, Iterator, Mapping, Sequence
from contextlib import contextmanager, suppress
from itertools import count
from pathlib import Path
from shutil import copymode
from typing import TYPE_CHECKING, Any

import typer

from capar.model.errors import FileError, NoAnswerError
from capar.model.figures import figure

if TYPE_CHECKING:
    from rich.console import Console
    from rich.table import Table


PERMISSION = "Get permission to read or write it, or name another path."
SPACE = "Free some space, or name a path on another disk."
REMEDIES = {
    errno.EACCES: PERMISSION,
    errno.EPERM: PERMISSION,
    errno.EROFS: "Name a path on a writable file system.",
    errno.ENOENT: "Name an existing path; a new file needs an existing folder.",
    errno.ENOTDIR: "The part before the last / must be a folder.",
    errno.EISDIR: "Name a file, not a folder.",
    errno.EEXIST: "Name another path.",
    errno.ENOSPC: SPACE,
    errno.EDQUOT: SPACE,
    errno.ENAMETOOLONG: "Choose a shorter name.",
    errno.ELOOP: "The symbolic links there form a loop; name their target directly.",
}
"""The remedy for each error number."""


PIPE_COLUMNS = 10_000
"""Width of a table in a pipe [columns]: wide enough that nothing is cut."""


def error_message(error: OSError) -> str:
    """What went wrong, where, and what would have been right."""
    files = (error.filename, error.filename2)
    names = [os.fsdecode(each) for each in files if isinstance(each, str | bytes | os.PathLike)]
    where = f"{' -> '.join(names)}: " if names else ""
    what = error.strerror or str(error) or type(error).__name__
    remedy = REMEDIES.get(error.errno or 0, "Name another file or folder.")
    return f"{where}cannot be used: {what}. {remedy}"


def print_json(value: Any, *, sort_keys: bool = False) -> None:
    """A value as JSON on standard output: dataclasses by their fields, the unknown as text."""
    import json

    text = json.dumps(value, ensure_ascii=False, indent=2, sort_keys=sort_keys, default=_plain)
    typer.echo(text)


def _plain(value: Any) -> Any:
    if dataclasses.is_dataclass(value) and not isinstance(value, type):
        return {each.name: getattr(value, each.name) for each in dataclasses.fields(value)}
    return str(value)


def answer(
    value: Any, lines: Iterable[object] | None = None, *, json: bool, sort_keys: bool = False
) -> None:
    """A value as JSON, or lines of text for people: by default its keys, lists and tables."""
    if json:
        print_json(value, sort_keys=sort_keys)
        return
    for line in _value_lines(value, "") if lines is None else lines:
        typer.echo(line)


def _value_lines(value: Mapping[str, Any], indent: str) -> Iterator[str]:
    """Keys with what they have: a text, nested keys, a line each, or a table of equal rows."""
    from capar.views.tables import aligned

    for key, item in value.items():
        rows = list(item) if isinstance(item, list | tuple) else []
        if isinstance(item, Mapping) and item:
            rows = [{key: name, **row} for name, row in item.items() if isinstance(row, Mapping)]
            if not _are_flat(rows) or len(rows) < len(item):
                yield f"{indent}{key}:"
                yield from _value_lines(item, f"{indent}  ")
                continue
        if rows and isinstance(rows[0], Mapping):
            yield f"{indent}{key}:"
            if _are_flat(rows):
                cells = [[_text(cell) for cell in row.values()] for row in rows]
                yield from (indent + line for line in aligned([list(rows[0]), *cells]))
            else:
                for row in rows:
                    yield from _value_lines(row, f"{indent}  ")
        elif rows:
            yield from (f"{indent}{key}: {_text(row)}" for row in rows)
        elif item not in (None, "", (), [], {}):
            yield f"{indent}{key}: {_text(item)}"


def _are_flat(rows: Iterable[Mapping[str, Any]]) -> bool:
    """Whether rows have texts, numbers and lists of these alone."""
    cells = (cell for row in rows for cell in row.values())
    parts = (part for cell in cells for part in (cell if isinstance(cell, list) else [cell]))
    return not any(isinstance(part, Mapping | list) for part in parts)


def _text(cell: Any) -> str:
    if isinstance(cell, bool):
        return "yes" if cell else "NO"
    if isinstance(cell, list | tuple):
        return ", ".join(map(_text, cell))
    return "" if cell is None else figure(cell) if isinstance(cell, float) else str(cell)


def console() -> "Console":
    """Where tables go: as wide as the terminal, and in a pipe as wide as they have to be."""
    from rich.console import Console

    return Console(width=None if sys.stdout.isatty() else PIPE_COLUMNS)


def print_table(
    columns: Sequence[str],
    rows: Sequence[Sequence[str]],
    *,
    right: Collection[int] = frozenset(),
    names: Collection[int] = frozenset(),
    title: str = "",
    caption: str = "",
    sections: Collection[int] = (),
) -> None:
    """A table on standard output."""
    from rich.box import SIMPLE_HEAD
    from rich.markup import escape

    from capar.views.tables import terminal_table

    table = terminal_table(columns, rows, right=right, names=names, title=title)
    table.box, table.collapse_padding, table.pad_edge = SIMPLE_HEAD, True, False
    table.caption = escape(caption) or None
    for index in sections:
        table.rows[index].end_section = True
    print_whole(table)


def print_whole(*tables: "Table") -> None:
    """Tables on standard output, never so narrow that a word is broken: ids can be copied.

    Those for which the terminal is too narrow have no lines between their columns.
    """
    from rich.box import SIMPLE_HEAD
    from rich.measure import Measurement

    own = console()
    wide = own.options.update(width=PIPE_COLUMNS)
    for table in tables:
        if Measurement.get(own, wide, table).minimum > own.width:
            table.box, table.collapse_padding, table.pad_edge = SIMPLE_HEAD, True, False
    least = (Measurement.get(own, wide, table).minimum for table in tables)
    own.width = max(own.width, *least)
    own.print(*tables)


def emit(text: str, output: Path | None) -> None:
    """Write text to a file, or to standard output where none is named."""
    if output is None:
        typer.echo(text, nl=False)
    else:
        with written(output) as draft:
            draft.write_text(text, encoding="utf-8")


def save(path: Path, content: "str | bytes | Callable[[Path], object]", did: str = "wrote") -> None:
    """Write a file whole or not at all, by its content or by what writes it, and report it."""
    with written(path) as draft:
        if callable(content):
            content(draft)
        else:
            draft.write_bytes(content if isinstance(content, bytes) else content.encode())
    typer.echo(f"{did} {path}", err=True)


def save_contradiction(error: NoAnswerError) -> None:
    """Report rules without an answer, and write the fewest facts that show it, to be sent."""
    from capar import __version__
    from capar.model.facts import program
    from capar_rules.engine.solver import least_contradiction

    files, facts = least_contradiction(error)
    named = ", ".join(map(str, files))
    typer.echo(f"capar: {error}: {named}", err=True)
    if not facts:
        return
    paths = (Path(f"no_answer_{files[0].stem}_{number}.lp") for number in count(1))
    about = f"{len(facts)} of {len(error.measured)} measured facts, without an answer: {named}"
    try:
        path = next(path for path in paths if not path.exists())
        save(path, f"% capar {__version__}: {about}.\n{program(facts)}", "please send us")
    except OSError as fault:
        typer.echo(f"capar: {error_message(fault)}", err=True)


def check_picture(path: Path | None) -> None:
    """Check that a picture could be drawn there, before anything is computed for it.

    Raises:
        FileError: It has no format of pictures.
        OSError: It cannot be written.
    """
    if path is not None:
        from capar.views.picture import SUFFIXES

        check_writable(path, suffixes=SUFFIXES)


def check_new_folder(folder: Path) -> None:
    """Check that a folder can be filled: it is not there yet, or it is empty.

    Raises:
        FileError: Something is there.
    """
    if folder.exists() and (not folder.is_dir() or any(folder.iterdir())):
        raise FileError(folder, "exists and is not an empty folder.", "Name a new folder.")


def progress(doing: str) -> "Callable[[Sequence[Any]], Iterable[Any]]":
    """Goes through a sequence with a bar on standard error, if that is a terminal."""
    from rich.console import Console
    from rich.progress import track

    def tracked(steps: "Sequence[Any]") -> "Iterable[Any]":
        if len(steps) < 2 or not sys.stderr.isatty():
            return steps
        return track(steps, description=doing, console=Console(stderr=True), transient=True)

    return tracked


STAGE_S = 1.0
"""What takes longer than this is said while it runs [s]."""


@contextmanager
def stage(doing: str, *, quiet: bool = False) -> Iterator[None]:
    """Says on standard error what is done, if that is a terminal and it takes over a second."""
    if quiet or not sys.stderr.isatty():
        yield
        return

    def say(*_: object) -> None:
        typer.echo(f"{doing} ...", err=True, nl=False)

    before = signal.signal(signal.SIGALRM, say)  # not a thread: measuring may fork
    signal.setitimer(signal.ITIMER_REAL, STAGE_S)
    try:
        yield
    finally:
        signal.setitimer(signal.ITIMER_REAL, 0.0)
        signal.signal(signal.SIGALRM, before)
        typer.echo("\r\x1b[K", err=True, nl=False)


def check_writable(path: Path, *, suffixes: Collection[str] = ()) -> None:
    """Check that a file could be written, before anything is computed for it.

    Raises:
        FileError: Its name ends otherwise.
        OSError: It cannot be written; the error bears its name.
    """
    from tempfile import TemporaryFile

    with _naming(path):
        if path.is_dir():
            raise IsADirectoryError(errno.EISDIR, os.strerror(errno.EISDIR))
        if path.is_file():
            path.open("ab").close()
        if not _is_device(path):
            TemporaryFile(dir=path.parent).close()
    if suffixes and path.suffix.lower() not in suffixes:
        known = ", ".join(suffixes)
        raise FileError(path, f"no picture format {path.suffix!r};", f"there are: {known}.")


@contextmanager
def written(path: Path) -> Iterator[Path]:
    """A draft to write beside a file, whose place it takes once it is whole.

    Whatever goes wrong before leaves the file as it was. A pipe or device is written itself.

    Raises:
        OSError: It cannot be written; the error bears the file's name, not the draft's.
    """
    check_writable(path)
    target = Path(os.path.realpath(path))
    draft = target.with_name(f".{os.getpid()}.draft{path.suffix}")
    with _naming(path):
        if _is_device(path):
            yield path
            return
        try:
            yield draft
            if target.exists():
                copymode(target, draft)
            draft.replace(target)
        finally:
            with suppress(OSError):
                draft.unlink()


def _is_device(path: Path) -> bool:
    return path.exists() and not path.is_file()


@contextmanager
def _naming(path: Path) -> Iterator[None]:
    """Errors that name a file's draft, or no file, name the file."""
    try:
        yield
    except OSError as error:
        error.filename, error.filename2 = str(path), None
        raise
    except FileError as error:
        raise FileError(path, error.problem, error.remedy) from None
