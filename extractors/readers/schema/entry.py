"""TOML tables as validated values: typed keys, and every mistake with its file and line."""

import os
import re
import tomllib
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Annotated, Any, ClassVar, TypeVar, get_args, get_origin

from pydantic import (
    BaseModel,
    ConfigDict,
    Field,
    GetJsonSchemaHandler,
    PrivateAttr,
    Tag,
    ValidationError,
    model_validator,
)
from pydantic.fields import FieldInfo
from pydantic_core import CoreSchema, PydanticCustomError, PydanticUndefined

from capar.model.errors import CaparError, FileError, UnknownNameError
from extractors.readers.file_access import read_text
from extractors.readers.names import constant_name


@dataclass(frozen=True, slots=True)
class Location:
    """A table's place in a TOML file."""

    file: Path
    lines: Mapping[str, int]
    """Line of every table and key of the file, by dotted path."""

    path: str = ""
    """The table's dotted path; empty for the whole file."""

    def inside(self, key: str) -> "Location":
        """The location of a table inside this one."""
        return Location(self.file, self.lines, f"{self.path}.{key}".strip("."))

    def line(self, key: str = "") -> int:
        """The line of a key, or of the innermost enclosing table that has one."""
        path = f"{self.path}.{key}".strip(".")
        while path and path not in self.lines:
            path = path.rpartition(".")[0]
        return self.lines.get(path, 1)

    def where(self, key: str = "") -> str:
        """``file:line`` of a key, or of the table."""
        return f"{self.file}:{self.line(key)}" if self.lines else str(self.file)


class Entry(BaseModel):
    """A table whose keys are the fields; unknown keys are refused with the known ones."""

    model_config = ConfigDict(
        extra="forbid", strict=True, frozen=True, allow_inf_nan=False, defer_build=True
    )

    one_of: ClassVar[tuple[str, ...]] = ()
    """Keys of which at least one is given."""

    _location: Location = PrivateAttr(default=Location(Path(), {}))

    @property
    def location(self) -> Location:
        """Where the table is in its file."""
        return self._location

    @property
    def file_path(self) -> Path:
        """The TOML file."""
        return self._location.file

    def where(self, key: str = "") -> str:
        """``file:line`` of a key, or of the table."""
        return self._location.where(key)

    def error(self, key: str, problem: str, remedy: str = "") -> FileError:
        """An error about a key, with its line."""
        return FileError(self.where(key), problem, remedy)

    def unknown(self, kind: str, name: str, known: Iterable[str], key: str) -> UnknownNameError:
        """An error about a name given under a key, with its line and the names that exist."""
        return UnknownNameError(kind, name, known, where=self.where(key))

    def given(self, among: Iterable[str] | None = None) -> dict[str, Any]:
        """The keys that the file states, with their validated values."""
        names = [name for name in type(self).model_fields if name in self.model_fields_set]
        return {name: getattr(self, name) for name in names if among is None or name in among}

    @classmethod
    def __get_pydantic_json_schema__(
        cls, core_schema: CoreSchema, handler: GetJsonSchemaHandler
    ) -> dict[str, Any]:
        """The JSON schema, with the keys of which one must be given."""
        out = handler(core_schema)
        if cls.one_of:
            handler.resolve_ref_schema(out)["anyOf"] = [{"required": [k]} for k in cls.one_of]
        return out

    @model_validator(mode="before")
    @classmethod
    def _check_keys(cls, data: Any) -> Any:
        """Check that every key is known, and given with the keys that it belongs to."""
        if not isinstance(data, dict):
            return data
        for name in data:
            if name not in cls.model_fields:
                known = list(cls.model_fields)
                raise PydanticCustomError("unknown_key", "{key}", {"key": name, "known": known})
            beside = relation(cls.model_fields[name], "beside")
            if beside and not any(other in data for other in beside):
                raise PydanticCustomError("beside", "{key}", {"key": name, "others": beside})
            apart = [o for o in relation(cls.model_fields[name], "apart") if o in data]
            if apart:
                raise PydanticCustomError("apart", "{key}", {"key": name, "others": apart})
        if cls.one_of and not any(data.get(name) for name in cls.one_of):
            raise PydanticCustomError("one_of", "{names}", {"names": list(cls.one_of)})
        return data


def key(
    meaning: str,
    default: Any = PydanticUndefined,
    *,
    unit: str = "",
    beside: str = "",
    apart: str = "",
) -> Any:
    """The field of a key.

    Args:
        meaning: One or two sentences, with what holds where the key is not given.
        default: Its value then; without one it must be given.
        unit: The unit of its numbers.
        beside: Keys of which one must be given with it, parted by spaces.
        apart: Keys that cannot be given with it.
    """
    text = f"{meaning} [{unit}]" if unit else meaning
    extra: Any = {"beside": beside.split(), "apart": apart.split()}
    return Field(default, description=text, json_schema_extra=extra)


def relation(field: FieldInfo, name: str) -> list[str]:
    """The keys ``beside`` or ``apart`` from a field's key."""
    extra = field.json_schema_extra
    found = extra.get(name, []) if isinstance(extra, dict) else []
    return [str(other) for other in found] if isinstance(found, list) else []


_Table = TypeVar("_Table", bound=Entry)

_HEADER = re.compile(r"^\s*(\[\[?)\s*([^\[\]]+?)\s*\]\]?\s*(#.*)?$")
_KEY = re.compile(r"""^\s*([A-Za-z0-9_.\-]+|"[^"]*"|'[^']*')\s*=""")
_VARIABLE = re.compile(r"\$\{([A-Za-z_][A-Za-z0-9_]*)\}")


def read_toml(path: Path) -> tuple[dict[str, Any], Location]:
    """A TOML file's content, and the lines of its keys.

    Raises:
        FileError: It is not there, or is not valid TOML; the message has the line.
    """
    text = read_text(path)
    try:
        data = tomllib.loads(text)
    except (tomllib.TOMLDecodeError, RecursionError) as error:
        line = re.search(r" \(at line (\d+), column \d+\)$", str(error))
        reason = str(error).removesuffix(line[0]) if line else str(error)
        where = f"{path}:{line[1]}" if line else path
        raise FileError(where, f"is not valid TOML: {reason}.") from error
    return data, Location(path, line_numbers(text))


def validated(kind: type[_Table], data: Mapping[str, Any], location: Location) -> _Table:
    """A table of a schema, every value checked and every table with its location.

    Raises:
        CaparError: A key or value is not as the schema says; one message a mistake.
    """
    try:
        table = kind.model_validate(data)
    except ValidationError as error:
        mistakes = [_mistake(each, kind, data, location) for each in error.errors()]
        errors = [found for _, found in sorted(mistakes, key=lambda mistake: mistake[0])]
        if len(errors) == 1:
            raise errors[0] from None
        lines = "".join(f"\n  {each}" for each in errors)
        raise FileError(location.file, f"has {len(errors)} mistakes:{lines}") from None
    _locate(table, location)
    return table


def _locate(table: Entry, location: Location) -> None:
    """Give a table and the tables in it their locations."""
    table._location = location
    for name in table.model_fields_set:
        for path, entry in _tables(name, getattr(table, name), location):
            _locate(entry, location.inside(path))


def _tables(path: str, value: Any, location: Location) -> Iterator[tuple[str, Entry]]:
    """The tables in a value, with their paths."""
    if isinstance(value, dict):
        for name, item in value.items():
            yield from _tables(f"{path}.{name}", item, location)
    elif isinstance(value, list):
        for index, item in enumerate(value):
            numbered = f"{path}.{index}"  # the elements of an inline list have no lines
            known = location.inside(numbered).path in location.lines
            yield from _tables(numbered if known else path, item, location)
    elif isinstance(value, Entry):
        yield path, value


def line_numbers(text: str) -> dict[str, int]:
    """The line of every table and key, by dotted path; array tables have their index in it."""
    lines: dict[str, int] = {}
    counts: dict[str, int] = {}
    prefix = ""
    for number, line in enumerate(text.splitlines(), 1):
        if header := _HEADER.match(line):
            prefix, parts = "", [part.strip().strip("\"'") for part in header.group(2).split(".")]
            for depth, part in enumerate(parts):
                prefix = f"{prefix}.{part}".strip(".")
                if depth == len(parts) - 1 and header.group(1) == "[[":
                    counts[prefix] = counts.get(prefix, -1) + 1
                if prefix in counts:
                    prefix = f"{prefix}.{counts[prefix]}"
            lines.setdefault(prefix, number)
            lines.setdefault(header.group(2).strip("\"'"), number)
        elif key := _KEY.match(line):
            name = key.group(1).strip("\"'")
            lines.setdefault(f"{prefix}.{name}".strip("."), number)
    return lines


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


def expanded(table: Entry, key: str) -> Path:
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


WANTED = {
    "string_type": "a text in quotes",
    "float_type": "a number",
    "finite_number": "a finite number",
    "bool_type": "true or false",
    "list_type": "a list",
    "dict_type": "a table",
    "model_type": "a table",
    "model_attributes_type": "a table",
    "union_tag_not_found": "of a type that is possible here",
    "union_tag_invalid": "of a type that is possible here",
}
"""What a value must be, by the type of pydantic's error."""

LIMITS = {"greater_than": ("gt", "greater than"), "greater_than_equal": ("ge", "at least"),
          "less_than": ("lt", "less than"), "less_than_equal": ("le", "at most")}  # fmt: skip
"""Each limit's name in the error's context, and in words."""

OWN = {
    "missing": "{key!r} is missing.",
    "beside": "{key!r} is given without {others}.",
    "apart": "{key!r} cannot be given together with {others}.",
    "one_of": "one of these must be given: {names}.",
    "empty": "{key} is empty.",
    "name": "name {value}: names begin with a lower-case letter and hold letters, digits and _.",
    "quaternion": "{key} = {value} has a norm of {norm}; a quaternion w x y z has a norm of 1.",
    "shape": "a shape states exactly one of mesh, box, cylinder, sphere, capsule, capsules, parts, "
    "not {value}.",
    "take": "{value} has no key take.",
}
"""Messages of the checks that the schema makes itself."""


def _mistake(
    error: Any, kind: type[Entry], data: Mapping[str, Any], location: Location
) -> tuple[int, CaparError]:
    """The line and the message of one error of pydantic."""
    context = error.get("ctx", {})
    path = _path(error["loc"], data)
    if error["type"] == "missing":
        path.append(error["loc"][-1])
    elif error["type"] in {"unknown_key", "beside", "apart"}:
        path.append(context["key"])
    field = _field(kind, [*error["loc"], *path[-1:]])
    table, name = (path[:-1], path[-1]) if path else ([], "")
    key = str(name)
    if isinstance(name, int) and table:  # an element of a list
        key = f"{table.pop()}.{name}"
    if table:
        location = location.inside(".".join(map(str, table)))
    where, plain = location.where(key), key.split(".", maxsplit=1)[0]
    if error["type"] == "unknown_key":
        found: CaparError = UnknownNameError("key", key, context["known"], where=where)
    elif error["type"] == "literal_error":
        known = re.findall(r"'([^']*)'", context["expected"])
        found = UnknownNameError(plain, str(error["input"])[:80], known, where=where)
    else:
        remedy = f"{plain}: {field.description}" if field and field.description else ""
        found = FileError(where, *_words(error["type"], plain, error["input"], context, remedy))
    return location.line(key), found


def _path(loc: Iterable[int | str], data: Any) -> list[int | str]:
    """The keys and indices of an error's place that are in the data; tags of unions are not."""
    path: list[int | str] = []
    for part in loc:
        inside = isinstance(data, dict) and part in data
        inside |= isinstance(data, list) and isinstance(part, int) and part < len(data)
        if inside:
            data = data[part]
            path.append(part)
    return path


def _field(kind: type[Entry], parts: Iterable[int | str]) -> FieldInfo | None:
    """The innermost field of a schema on the path to a place."""
    found, kinds = None, [("", kind)]
    for part in parts:
        kinds = [each for each in kinds if each[0] == part] or kinds
        for _, model in kinds:
            if part in model.model_fields:
                found = model.model_fields[str(part)]
                kinds = list(_entries(found.annotation)) or kinds
                break
    return found


def _entries(annotation: Any, tag: str = "") -> Iterator[tuple[str, type[Entry]]]:
    """The tables that a type refers to, each with its tag in a union."""
    if isinstance(annotation, type) and issubclass(annotation, Entry):
        yield tag, annotation
    arguments = get_args(annotation)
    if get_origin(annotation) is Annotated:
        tag = next((each.tag for each in arguments if isinstance(each, Tag)), tag)
    for argument in arguments:
        yield from _entries(argument, tag)


def _words(
    kind: str, key: str, given: Any, context: Mapping[str, Any], remedy: str
) -> tuple[str, str]:
    """What is wrong, and what would be right."""
    value = repr(given)
    value = value if len(value) <= 80 else f"{value[:77]}..."
    if kind == "list_type" and isinstance(given, dict):
        return f"{key} is a single table.", f"Give each under [[{key}]]."
    if kind in WANTED:
        return f"{key} = {value} is not {WANTED[kind]}.", remedy
    if kind in LIMITS:
        name, words = LIMITS[kind]
        return f"{key} = {value}; it must be {words} {context[name]:g}.", remedy
    if kind in {"too_short", "too_long"}:
        words, limit = ("at least", "min") if kind == "too_short" else ("at most", "max")
        count = f"{context['actual_length']}; it takes {words} {context[f'{limit}_length']}"
        return f"{key} = {value}, of length {count}.", remedy
    texts = {
        **context,
        "key": key,
        "value": value,
        "others": " or ".join(map(repr, context.get("others", []))),
        "names": ", ".join(context.get("names", [])),
    }
    problem = OWN.get(kind, "{key} = {value} is not as it should be.").format(**texts)
    return problem, f"Like {constant_name(str(given))}." if kind == "name" else remedy
