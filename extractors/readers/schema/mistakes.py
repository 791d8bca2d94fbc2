"""What pydantic reports about a table, as our own errors: file, line, key, and what is right."""

import re
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from typing import Any, get_args

from pydantic import ValidationError
from pydantic.fields import FieldInfo

from capar.model.errors import CaparError, FileError, UnknownNameError
from extractors.readers.schema.entry import Entry, Location
from extractors.readers.schema.names import constant_name
from extractors.readers.schema.shapes import SHAPES

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
"""What a value must be, by the type of the error."""

LIMITS = {"greater_than": ("gt", "greater than"), "greater_than_equal": ("ge", "at least"),
          "less_than": ("lt", "less than"), "less_than_equal": ("le", "at most")}  # fmt: skip
"""Each limit's name in the error's context, and in words."""


@dataclass(frozen=True)
class _Mistake:
    """One error of pydantic, and the key that it is about."""

    kind: str
    value: Any
    context: Mapping[str, Any]
    location: Location
    """Of the table that holds the key."""

    key: str
    """The key, or the table itself where it is empty."""

    meaning: str
    """What the schema says of the key."""


def mistakes(
    error: ValidationError, kind: type[Entry], data: Mapping[str, Any], location: Location
) -> list[CaparError]:
    """Every mistake in a table, in the order of their lines."""
    found = [_mistake(each, kind, data, location) for each in error.errors(include_url=False)]
    found.sort(key=lambda each: each.location.line(each.key))
    return [_error(each) for each in found]


def _mistake(
    error: Any, kind: type[Entry], data: Mapping[str, Any], location: Location
) -> _Mistake:
    path = _path(error["loc"], data)
    context = error.get("ctx", {})
    names = [*path, error["loc"][-1]] if error["type"] == "missing" else path
    if error["type"] in {"unknown_key", "beside", "apart"}:
        names = [*path, context["key"]]
    table, key = (names[:-1], names[-1]) if names else ([], "")
    if isinstance(key, int):  # an element of a list
        key = f"{table.pop()}.{key}" if table else str(key)
    field = _field(kind, [*error["loc"], *names[-1:]])
    return _Mistake(
        kind=error["type"],
        value=error["input"],
        context=context,
        location=location.inside(".".join(map(str, table))) if table else location,
        key=str(key),
        meaning=(field.description or "") if field else "",
    )


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
    """The innermost field of a schema on the way to a place."""
    found, kinds = None, [kind]
    for part in parts:
        if str(part).removesuffix(" shape") in SHAPES and str(part).endswith(" shape"):
            kinds = [SHAPES[str(part).removesuffix(" shape")]]
        for model in kinds:
            if part in model.model_fields:
                found = model.model_fields[str(part)]
                kinds = list(_entries(found.annotation)) or kinds
                break
    return found


def _entries(annotation: Any) -> Iterable[type[Entry]]:
    """The tables that a type refers to."""
    if isinstance(annotation, type) and issubclass(annotation, Entry):
        yield annotation
    for argument in get_args(annotation):
        yield from _entries(argument)


def _error(mistake: _Mistake) -> CaparError:
    """The message of one mistake."""
    where = mistake.location.where(mistake.key)
    if mistake.kind == "unknown_key":
        return UnknownNameError("key", mistake.key, mistake.context["known"], where=where)
    if mistake.kind == "literal_error":
        known = re.findall(r"'([^']*)'", mistake.context["expected"])
        return UnknownNameError(_name(mistake.key), str(mistake.value)[:80], known, where=where)
    problem, remedy = _words(mistake)
    return FileError(where, problem, remedy)


def _words(mistake: _Mistake) -> tuple[str, str]:
    """What is wrong, and what would be right."""
    key, value, context = _name(mistake.key), _shown(mistake.value), mistake.context
    remedy = f"{key}: {mistake.meaning}" if mistake.meaning else ""
    if mistake.kind == "list_type" and isinstance(mistake.value, dict):
        return f"{key} is a single table.", f"Give each under [[{key}]]."
    if mistake.kind in WANTED:
        return f"{key} = {value} is not {WANTED[mistake.kind]}.", remedy
    if mistake.kind in LIMITS:
        name, words = LIMITS[mistake.kind]
        return f"{key} = {value}; it must be {words} {context[name]:g}.", remedy
    if mistake.kind in {"too_short", "too_long"}:
        words, limit = ("at least", "min") if mistake.kind == "too_short" else ("at most", "max")
        count = f"{context['actual_length']}; it takes {words} {context[f'{limit}_length']}"
        return f"{key} = {value}, of length {count}.", remedy
    problem = _OWN.get(mistake.kind, "{key} = {value} is not as it should be.")
    others = " or ".join(map(repr, context.get("others", [])))
    names = ", ".join(context.get("names", []))
    texts = {**context, "key": key, "value": value, "others": others, "names": names}
    if mistake.kind == "name":
        remedy = f"Like {constant_name(str(mistake.value))}."
    return problem.format(**texts), remedy


_OWN = {
    "missing": "{key!r} is missing.",
    "beside": "{key!r} is given without {others}.",
    "apart": "{key!r} cannot be given together with {others}.",
    "one_of": "one of these must be given: {names}.",
    "empty": "{key} is empty.",
    "name": "name {value}: names begin with a lower-case letter and hold letters, digits and _.",
    "quaternion": "{key} = {value} has a norm of {norm}; a quaternion w x y z has a norm of 1.",
    "shape": f"a shape states exactly one of {', '.join(k for k in SHAPES if '_' not in k)}, "
    "not {value}.",
    "take": "{value} has no key take.",
}
"""Messages of the checks that the schema makes itself."""


def _name(key: str) -> str:
    """A key without the index of a list's element."""
    return key.split(".", maxsplit=1)[0]


def _shown(value: Any) -> str:
    """A value as a message quotes it."""
    text = repr(value)
    return text if len(text) <= 80 else f"{text[:77]}..."
