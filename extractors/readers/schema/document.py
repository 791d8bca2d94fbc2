"""TOML files as validated tables; what is wrong in one is reported with its file and line."""

import os
import re
import tomllib
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any, TypeVar

from capar.model.errors import CaparError, FileError
from extractors.readers.files import read_text

if TYPE_CHECKING:
    from extractors.readers.schema.entry import Entry, Location

    _Table = TypeVar("_Table", bound=Entry)

_HEADER = re.compile(r"^\s*(\[\[?)\s*([^\[\]]+?)\s*\]\]?\s*(#.*)?$")
_KEY = re.compile(r"""^\s*([A-Za-z0-9_.\-]+|"[^"]*"|'[^']*')\s*=""")
_VARIABLE = re.compile(r"\$\{([A-Za-z_][A-Za-z0-9_]*)\}")


def read_toml(path: Path) -> tuple[dict[str, Any], "Location"]:
    """A TOML file's content, and the lines of its keys.

    Raises:
        FileError: It is not there, or is not valid TOML; the message has the line.
    """
    from extractors.readers.schema.entry import Location

    text = read_text(path)
    try:
        data = tomllib.loads(text)
    except (tomllib.TOMLDecodeError, RecursionError) as error:
        line = re.search(r" \(at line (\d+), column \d+\)$", str(error))
        reason = str(error).removesuffix(line[0]) if line else str(error)
        where = f"{path}:{line[1]}" if line else path
        raise FileError(where, f"is not valid TOML: {reason}.") from error
    return data, Location(path, line_numbers(text))


def validated(kind: "type[_Table]", data: Mapping[str, Any], location: "Location") -> "_Table":
    """A table of a schema, every value checked and every table with its location.

    Raises:
        CaparError: A key or value is not as the schema says; one message a mistake.
    """
    from pydantic import ValidationError

    from extractors.readers.schema.mistakes import mistakes

    try:
        table = kind.model_validate(data)
    except ValidationError as error:
        raise _one_of(mistakes(error, kind, data, location), location.file) from None
    _locate(table, location)
    return table


def _one_of(found: list[CaparError], file: Path) -> CaparError:
    """The error itself, or one that lists several."""
    if len(found) == 1:
        return found[0]
    lines = "".join(f"\n  {each}" for each in found)
    return FileError(file, f"has {len(found)} mistakes:{lines}")


def _locate(table: "Entry", location: "Location") -> None:
    """Give a table and the tables in it their locations."""
    table._location = location
    for name in table.model_fields_set:
        for path, entry in _tables(name, getattr(table, name), location):
            _locate(entry, location.inside(path))


def _tables(path: str, value: Any, location: "Location") -> Iterator[tuple[str, "Entry"]]:
    """The tables in a value, with their paths."""
    if isinstance(value, dict):
        for name, item in value.items():
            yield from _tables(f"{path}.{name}", item, location)
    elif isinstance(value, list):
        for index, item in enumerate(value):
            numbered = f"{path}.{index}"  # the elements of an inline list have no lines
            known = location.inside(numbered).path in location.lines
            yield from _tables(numbered if known else path, item, location)
    elif hasattr(value, "location"):
        yield path, value


def line_numbers(text: str) -> dict[str, int]:
    """The line of every table and key, by dotted path; array tables have their index in it."""
    lines: dict[str, int] = {}
    counts: dict[str, int] = {}
    prefix = ""
    for number, line in enumerate(text.splitlines(), 1):
        if header := _HEADER.match(line):
            prefix = _header_path(header, counts)
            lines.setdefault(prefix, number)
            lines.setdefault(header.group(2).strip("\"'"), number)
        elif key := _KEY.match(line):
            name = key.group(1).strip("\"'")
            lines.setdefault(f"{prefix}.{name}".strip("."), number)
    return lines


def _header_path(header: re.Match[str], counts: dict[str, int]) -> str:
    """A header's dotted path, with the index of each array of tables on the way."""
    path = ""
    parts = [part.strip().strip("\"'") for part in header.group(2).split(".")]
    for depth, part in enumerate(parts):
        path = f"{path}.{part}".strip(".")
        last = depth == len(parts) - 1
        if last and header.group(1) == "[[":
            counts[path] = counts.get(path, -1) + 1
        if path in counts:
            path = f"{path}.{counts[path]}"
    return path


def substituted(value: Any, replace: Mapping[str, str]) -> Any:
    """A TOML value with ``{name}`` replaced in every string."""
    if isinstance(value, str):
        for name, text in replace.items():
            value = re.sub(rf"(?<!\$)\{{{re.escape(name)}\}}", lambda _: text, value)  # noqa: B023
        return value
    if isinstance(value, list):
        return [substituted(item, replace) for item in value]
    if isinstance(value, dict):
        return {key: substituted(item, replace) for key, item in value.items()}
    return value


def expanded(table: "Entry", key: str) -> Path:
    """The path under a key with its environment variables filled in, relative to the TOML file.

    Raises:
        FileError: A variable is not set.
    """
    text = str(getattr(table, key))

    def value(match: re.Match[str]) -> str:
        name = match.group(1)
        if not os.environ.get(name):
            raise table.error(
                key,
                f"{text!r} needs the environment variable {name}, which is not set.",
                f"Set it to the folder that holds the data: export {name}=FOLDER.",
            )
        return os.environ[name]

    return table.file_path.parent / _VARIABLE.sub(value, text)
