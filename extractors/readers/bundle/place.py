"""Where a capture is described, and which of its takes is meant."""

from dataclasses import dataclass
from pathlib import Path

from capar.model.errors import FileError, UnknownNameError
from extractors.readers.bundle.toml_table import Table, read_table

FILE = "capture.toml"


@dataclass(frozen=True)
class Place:
    """Where a capture is described, and which take of it is meant."""

    file: Path
    take: str = ""


def find_place(place: str | Path) -> Place:
    """The capture.toml of a folder, a file, or a motion file beside it, and a ``:take``.

    Raises:
        FileError: There is none.
    """
    text = str(place)
    path, take = Path(text), ""
    if not path.exists() and ":" in text:
        stem, _, take = text.rpartition(":")
        path = Path(stem)
    if path.is_dir():
        path = path / FILE
    elif path.is_file() and path.suffix != ".toml":
        path = path.parent / FILE
    if not path.is_file():
        raise FileError(
            text,
            f"no capture here: there is no file {path}.",
            f"Write one with: capar new-capture FILES... -o {_wanted(path)}",
        )
    return Place(path, take)


def _wanted(path: Path) -> Path:
    """Where a capture.toml ought to be, by a path that leads nowhere: a file or a folder."""
    if path.suffix == ".toml":
        return path
    return (path.parent if path.suffix else path) / FILE


def takes(place: str | Path) -> list[str]:
    """The names of a bundle's takes; empty where it has one only."""
    return list(_takes(read_table(find_place(place).file)))


def open_bundle(place: str | Path) -> tuple[Table, str]:
    """The table of a capture.toml with the take's names filled in, and the take.

    Raises:
        FileError: The bundle has several takes and none was named, or it is no TOML.
        UnknownNameError: It has no such take.
    """
    where = find_place(place)
    table = read_table(where.file)
    known = _takes(table)
    if not known:
        if where.take:
            raise UnknownNameError("take", where.take, [], where=str(where.file))
        table.raw("takes")
        return table, ""
    if where.take not in known:
        if where.take:
            raise UnknownNameError("take", where.take, known, where=table.where("takes"))
        raise table.error(
            "takes", "has several takes.", f"Name one of them: {place}:{next(iter(known))}"
        )
    table = read_table(where.file, known[where.take])
    table.raw("takes")
    return table, where.take


def _takes(table: Table) -> dict[str, dict[str, str]]:
    """Each take's name and what ``{...}`` stands for in it."""
    out: dict[str, dict[str, str]] = {}
    for each in table.raw("takes", []):
        values = {"take": each} if isinstance(each, str) else dict(each)
        if "take" not in values or not all(isinstance(v, str) for v in values.values()):
            raise table.error("takes", f"{each!r} is no take.", 'Like "take0" or { take = "..." }.')
        out[values["take"]] = values
    return out
