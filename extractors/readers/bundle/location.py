"""Where a capture is described, and which of its takes is meant."""

from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

from capar.model.errors import FileError, UnknownNameError
from extractors.readers.schema.document import read_toml, substituted, validated

if TYPE_CHECKING:
    from extractors.readers.schema.capture import CaptureFile
    from extractors.readers.schema.entry import Location

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
        beside = path.parent / FILE
        if not beside.is_file():
            raise FileError(
                text,
                f"is no {FILE}, and there is none beside it.",
                f"If it is a recording, write one with: capar new-capture {path} -o {beside}",
            )
        path = beside
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
    data, location = read_toml(find_place(place).file)
    return list(_takes(data, location))


def take_words(place: str | Path) -> dict[str, dict[str, str]]:
    """What ``{...}`` stands for in each take of a bundle; empty where it has one take only."""
    data, location = read_toml(find_place(place).file)
    return _takes(data, location)


def open_bundle(place: str | Path) -> "tuple[CaptureFile, str]":
    """A capture.toml with the take's names filled in, validated, and the take.

    Raises:
        FileError: The bundle has several takes and none was named, or it is not valid TOML.
        UnknownNameError: It has no such take.
        CaparError: A key or value is not as the schema says.
    """
    from extractors.readers.schema.capture import CaptureFile

    where = find_place(place)
    data, location = read_toml(where.file)
    known = _takes(data, location)
    if where.take not in known and (where.take or known):
        if where.take:
            raise UnknownNameError("take", where.take, known, where=location.where("takes"))
        raise FileError(
            location.where("takes"),
            "has several takes.",
            f"Name one of them: {place}:{next(iter(known))}",
        )
    words = known.get(where.take, {})
    return validated(CaptureFile, substituted(data, words), location), where.take


def _takes(data: dict[str, Any], location: "Location") -> dict[str, dict[str, str]]:
    """Each take's name and what ``{...}`` stands for in it."""
    from extractors.readers.schema.capture import Takes

    if "takes" not in data:
        return {}
    found = validated(Takes, {"takes": data["takes"]}, location).takes
    words = [{"take": take} if isinstance(take, str) else take for take in found]
    return {take["take"]: take for take in words}
