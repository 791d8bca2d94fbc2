"""TOML whose every key knows its line, so that a mistake in it can be pointed at."""

import os
import re
import tomllib
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from capar.model.errors import FileError, UnknownNameError
from extractors.readers.files import read_text

_HEADER = re.compile(r"^\s*(\[\[?)\s*([^\[\]]+?)\s*\]\]?\s*(#.*)?$")
_KEY = re.compile(r"""^\s*([A-Za-z0-9_.\-]+|"[^"]*"|'[^']*')\s*=""")
_VARIABLE = re.compile(r"\$\{([A-Za-z_][A-Za-z0-9_]*)\}")


class Table:
    """A TOML table that remembers which of its keys were asked for."""

    def __init__(
        self, data: Mapping[str, Any], file: Path, lines: Mapping[str, int], path: str = ""
    ) -> None:
        self.file = file
        self._data = data
        self._lines = lines
        self._path = path
        self._asked: set[str] = set()

    def where(self, key: str = "") -> str:
        """``file:line`` of a key, or of the table."""
        path = f"{self._path}.{key}".strip(".")
        while path and path not in self._lines:
            path = path.rpartition(".")[0]
        return f"{self.file}:{self._lines.get(path, 1)}"

    def __contains__(self, key: str) -> bool:
        self._asked.add(key)
        return key in self._data

    def error(self, key: str, problem: str, remedy: str = "") -> FileError:
        """An error about a key, with its line."""
        return FileError(self.where(key), problem, remedy)

    def raw(self, key: str, default: Any = None) -> Any:
        """The value as TOML has it."""
        self._asked.add(key)
        return self._data.get(key, default)

    def text(self, key: str, default: str | None = None) -> str:
        """A string.

        Raises:
            FileError: It is no string, or it is missing and has no default.
        """
        return str(self._typed(key, str, "a string in quotes", default))

    def number(self, key: str, default: float | None = None) -> float:
        """A finite number."""
        value = self._typed(key, (int, float), "a number", default)
        if isinstance(value, bool) or not abs(float(value)) < float("inf"):
            raise self.error(key, f"{key} = {value!r} is no number.")
        return float(value)

    def flag(self, key: str) -> bool:
        """True or false; false where it is not given."""
        return bool(self._typed(key, bool, "true or false", False))

    def texts(self, key: str) -> list[str]:
        """A list of strings, empty where it is not given."""
        values = self._typed(key, list, "a list of strings", [])
        if not all(isinstance(each, str) for each in values):
            raise self.error(key, f"{key} takes a list of strings, not {values!r}.")
        return list(values)

    def vector(self, key: str, size: int, default: tuple[float, ...] | None = None) -> list[float]:
        """A list of so many numbers."""
        values = self._typed(key, (list, tuple), f"a list of {size} numbers", default)
        numbers = [each for each in values if isinstance(each, int | float)]
        if len(values) != size or len(numbers) != size:
            raise self.error(key, f"{key} takes {size} numbers, not {values!r}.")
        return [float(each) for each in values]

    def choice(self, key: str, known: Mapping[str, Any], default: str | None = None) -> str:
        """One of several words."""
        value = self.text(key, default)
        if value not in known:
            raise UnknownNameError(key, value, known, where=self.where(key))
        return value

    def table(self, key: str) -> "Table | None":
        """A table inside this one, or None."""
        value = self._typed(key, dict, "a table", {})
        return Table(value, self.file, self._lines, self._inside(key)) if key in self else None

    def tables(self, key: str) -> list["Table"]:
        """An array of tables, empty where it is not given."""
        values = self._typed(key, list, f"tables, each under [[{key}]]", [])
        if not all(isinstance(each, dict) for each in values):
            raise self.error(key, f"{key} is given under [[{key}]], as tables.")
        return [
            Table(each, self.file, self._lines, self._inside(f"{key}.{index}"))
            for index, each in enumerate(values)
        ]

    def derived(self, data: Mapping[str, Any], key: str) -> "Table":
        """A table of other values that speaks of a place in this one."""
        return Table(data, self.file, self._lines, self._inside(key))

    def given(self) -> list[str]:
        """The keys that are given, in their order."""
        return list(self._data)

    def close(self) -> None:
        """Prove that every key given is one that was asked for.

        Raises:
            UnknownNameError: One was not; it lists those that are known.
        """
        for key in self._data:
            if key not in self._asked:
                raise UnknownNameError("key", key, self._asked, where=self.where(key))

    def _inside(self, key: str) -> str:
        return f"{self._path}.{key}".strip(".")

    def _typed(self, key: str, kind: Any, wanted: str, default: Any) -> Any:
        value = self.raw(key, default)
        if value is None:
            raise self.error("", f"{key!r} is missing.", f"Give {wanted}.")
        if not isinstance(value, kind):
            raise self.error(key, f"{key} = {value!r} is not {wanted}.")
        return value


def read_table(path: Path, replace: Mapping[str, str] | None = None) -> Table:
    """A TOML file as a table.

    Raises:
        FileError: It is not there, or no TOML; the message has the line.
    """
    text = read_text(path)
    try:
        data = tomllib.loads(text)
    except (tomllib.TOMLDecodeError, RecursionError) as error:
        raise FileError(path, f"is no TOML: {error}.") from error
    return Table(substituted(data, replace or {}), path, line_numbers(text))


def line_numbers(text: str) -> dict[str, int]:
    """The line of every table and key, by dotted path; array tables have their index in it."""
    lines: dict[str, int] = {}
    counts: dict[str, int] = {}
    prefix = ""
    for number, line in enumerate(text.splitlines(), 1):
        if header := _HEADER.match(line):
            prefix = _header_path(header, counts)
            lines.setdefault(prefix, number)
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
        return [substituted(each, replace) for each in value]
    if isinstance(value, dict):
        return {key: substituted(each, replace) for key, each in value.items()}
    return value


def expanded(table: Table, key: str, text: str) -> Path:
    """A path with its environment variables filled in, relative to the TOML file.

    Raises:
        FileError: A variable is not set.
    """

    def value(match: re.Match[str]) -> str:
        name = match.group(1)
        if not os.environ.get(name):
            raise table.error(
                key,
                f"{text!r} needs the environment variable {name}, which is not set.",
                f"Set it to the folder that holds the data: export {name}=FOLDER.",
            )
        return os.environ[name]

    return table.file.parent / _VARIABLE.sub(value, text)
