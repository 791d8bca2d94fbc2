"""Single keys of a capture.toml changed in its text, so that comments and order stay."""

import json
import re
import tomllib
from typing import Any

_HEAD = re.compile(r"^\s*\[(\[?)\s*([\w.-]+)\s*\]?\]")


def table(text: str, name: str, number: int) -> dict[str, Any]:
    """The keys of the table of a name and number; those at the top for no name."""
    data = tomllib.loads(text)
    if not name:
        return {key: value for key, value in data.items() if not isinstance(value, dict | list)}
    found = data.get(name, [])
    tables = found if isinstance(found, list) else [found]
    return dict(tables[number]) if number < len(tables) else {}


def count(text: str, name: str) -> int:
    """How many tables of a name there are."""
    found = tomllib.loads(text).get(name, [])
    return len(found) if isinstance(found, list) else 1


def written(value: Any) -> str:
    """A value in TOML, on one line."""
    if isinstance(value, dict):
        return "{ " + ", ".join(f"{key} = {written(each)}" for key, each in value.items()) + " }"
    if isinstance(value, list):
        return "[" + ", ".join(map(written, value)) + "]"
    return json.dumps(value, ensure_ascii=False)


def with_key(text: str, name: str, number: int, key: str, value: Any) -> str:
    """The text with a key of a table set, or taken out for None."""
    lines = text.splitlines()
    first, last = _extent(lines, name, number)
    own = re.compile(rf"^\s*{re.escape(key)}\s*=")
    at = next((n for n in range(first, last) if own.match(lines[n])), None)
    if at is not None:
        end = _end_of_value(lines, at)
        comment = _comment(lines[at]) if end == at + 1 else ""
        del lines[at:end]
    else:
        comment = ""
        at = last
        while at > first and not lines[at - 1].strip():
            at -= 1
    if value is not None:
        lines.insert(at, f"{key} = {written(value)}{comment}")
    return "\n".join(lines) + "\n"


def without_table(text: str, name: str, number: int) -> str:
    """The text without a table, and without the comments just before it."""
    lines = text.splitlines()
    first, last = _extent(lines, name, number)
    begin = first - 1
    while begin > 0 and lines[begin - 1].lstrip().startswith("#"):
        begin -= 1
    while last > first and lines[last - 1].lstrip().startswith("#"):
        last -= 1  # comments of the table that follows
    del lines[begin:last]
    return "\n".join(lines) + "\n"


def with_table(text: str, name: str, keys: dict[str, Any]) -> str:
    """The text with one more table at its end."""
    lines = [f"[[{name}]]", *(f"{key} = {written(value)}" for key, value in keys.items())]
    return text.rstrip("\n") + "\n\n" + "\n".join(lines) + "\n"


def _extent(lines: list[str], name: str, number: int) -> tuple[int, int]:
    """The lines of a table after its head, with those of its own sub-tables left out."""
    heads = [(at, found[2]) for at, line in enumerate(lines) if (found := _HEAD.match(line))]
    if not name:
        return 0, heads[0][0] if heads else len(lines)
    own = [at for at, head in heads if head == name]
    if number >= len(own):
        raise IndexError(f"{name} {number}")
    following = [at for at, _ in heads if at > own[number]]
    return own[number] + 1, following[0] if following else len(lines)


def _end_of_value(lines: list[str], at: int) -> int:
    """The line after a value that may go over several."""
    for end in range(at + 1, len(lines) + 1):
        try:
            tomllib.loads("\n".join(lines[at:end]))
        except tomllib.TOMLDecodeError:
            continue
        return end
    return at + 1


def _comment(line: str) -> str:
    """The comment at the end of a line, with the room before it; that to be edited is done."""
    for place in re.finditer(r"\s*#", line):
        try:
            tomllib.loads(line[: place.start()])
        except tomllib.TOMLDecodeError:
            continue
        found = line[place.start() :]
        return "" if "EDIT:" in found else found
    return ""
