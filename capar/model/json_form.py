"""An observation as JSON, and back."""

import json
from collections.abc import Callable, Iterable, Mapping
from dataclasses import fields, is_dataclass, replace
from enum import Enum
from importlib import resources
from math import isfinite
from typing import Any, TypeAlias, TypeVar

from capar.model.calibration import Calibration
from capar.model.errors import CaparError, ParError
from capar.model.facts import Fact, read_fact
from capar.model.notices import KINDS as NOTICE_KINDS
from capar.model.notices import Notice, read_notice
from capar.model.observation import Observation
from capar.model.par import ComplexPar, FeatureSet, Ipar, Upar

SCHEMA = 3
"""The version that this program reads and writes, the field ``schema`` of an observation."""


def _take_schema(content: dict[str, Any], where: str) -> None:
    """Take the version out of an observation's document; raise ParError if it is another one."""
    if "schema" not in content and "links" not in content:
        raise ParError(f"{_place(where)}expected an observation, found none of its fields")
    found = content.pop("schema", 1)
    if type(found) is not int or found < 1:
        raise ParError(f"{_place(where)}schema: expected a whole number from 1, found {found!r}")
    if found != SCHEMA:
        raise ParError(
            f"{_place(where)}this is an observation of schema {found}, this program reads "
            f"{SCHEMA}; observe the capture again"
        )


def _place(where: str) -> str:
    return f"{where}: " if where else ""


Value: TypeAlias = Observation | ComplexPar | Upar | Ipar | Calibration
"""What has a JSON form."""

KINDS: dict[str, type[Value]] = {
    "observation": Observation,
    "complex_par": ComplexPar,
    "upar": Upar,
    "ipar": Ipar,
    "calibration": Calibration,
}
"""Each kind by the name of its schema."""

DRAFT = "https://json-schema.org/draft/2020-12/schema"
FACT_PATTERN = r"^[a-z][A-Za-z0-9_]*(\(.+\))?$"
_Part = TypeVar("_Part", Fact, Notice)
_T = TypeVar("_T", Observation, ComplexPar, Upar, Ipar, Calibration)


def to_json(value: Value) -> str:
    """The value as JSON: keys in the order of the fields, facts as atoms, a final newline.

    Raises:
        ParError: A number is not finite; JSON has no such numbers.
    """
    return json.dumps(document(value), indent=2, ensure_ascii=False, allow_nan=False) + "\n"


def document(value: Value) -> dict[str, Any]:
    """The value as dictionaries, lists, strings and numbers.

    Raises:
        ParError: A number is not finite.
    """
    out: dict[str, Any] = _plain(value, type(value).__name__)
    return {"schema": SCHEMA, **out} if isinstance(value, Observation) else out


def from_json(text: str, *, where: str = "") -> Observation:
    """The observation that a JSON text states.

    Raises:
        ParError: No JSON, or not of the schema; it says at which place and what was expected.
    """
    return value_from_json(text, Observation, where=where)


def value_from_json(text: str, kind: type[_T], *, where: str = "") -> _T:
    """The observation, PAR or calibration of a given kind that a JSON text states.

    Raises:
        ParError: No JSON, or not of the schema; it says at which place and what was expected.
    """
    from pydantic import TypeAdapter, ValidationError

    content = _parsed(text, where)
    facts: tuple[Fact, ...] = ()
    notices: tuple[Notice, ...] = ()
    if kind is Observation:
        _take_schema(content, where)
        facts = _taken(content, "facts", read_fact, "atoms", where)
        notices = _taken(content, "notices", _notice, "notices", where)
    try:
        value: _T = TypeAdapter(kind).validate_json(
            json.dumps(content), strict=True, extra="forbid"
        )
    except ValidationError as error:
        raise ParError(_complaint(error.errors(), where)) from None
    except CaparError as error:
        raise ParError(f"{_place(where)}{_features_place(content)}{error}") from None
    if isinstance(value, Observation):
        return replace(value, facts=facts, notices=notices)
    return value


def schema(name: str) -> dict[str, Any]:
    """The JSON schema (draft 2020-12) of the kind of that name, made from the values' types."""
    from pydantic import TypeAdapter

    out = TypeAdapter(KINDS[name]).json_schema(mode="serialization")
    for each in (out, *out.get("$defs", {}).values()):
        if each.get("type") == "object":
            each["additionalProperties"] = False
    if "Fact" in out.get("$defs", {}):
        out["$defs"]["Fact"] = {
            "title": "Fact",
            "description": "A ground fact, as an atom: touching(right_hand,mug,118,335)",
            "type": "string",
            "pattern": FACT_PATTERN,
        }
        out["$defs"]["Notice"] = _notice_schema()
    if name == "observation":
        out["properties"] = {"schema": {"const": SCHEMA, "type": "integer"}, **out["properties"]}
        out["required"] = ["schema", *out["required"]]
    return {"$schema": DRAFT, **out}


def schema_text(name: str) -> str:
    """That schema as it is published, beside this module."""
    return json.dumps(schema(name), indent=2, ensure_ascii=False) + "\n"


def published_schema(name: str) -> str:
    """The text of the published schema file of the kind of that name."""
    folder = resources.files("capar.model").joinpath("schema")
    return folder.joinpath(f"{name}.schema.json").read_text(encoding="utf-8")


def _plain(value: Any, place: str) -> Any:
    if isinstance(value, Fact):
        return str(value)
    if is_dataclass(value):
        own = {each.name: getattr(value, each.name) for each in fields(value)}
        parts = value.document() if isinstance(value, Notice) else own
        return {name: _plain(each, f"{place}.{name}") for name, each in parts.items()}
    if isinstance(value, Mapping):
        return {key: _plain(value[key], f"{place}.{key}") for key in sorted(value)}
    if isinstance(value, tuple | list):
        return [_plain(each, f"{place}.{index}") for index, each in enumerate(value)]
    if isinstance(value, float):
        if not isfinite(value):
            raise ParError(f"{place}: {value} is no finite number; JSON cannot hold it")
        return float(value)
    return value.value if isinstance(value, Enum) else value


def _parsed(text: str, where: str) -> dict[str, Any]:
    try:
        content = json.loads(text)
    except (json.JSONDecodeError, RecursionError) as error:
        raise ParError(f"{_place(where)}this is no JSON: {error}") from None
    if not isinstance(content, dict):
        raise ParError(f"{_place(where)}expected an object in braces, found {_shown(content)}")
    return content


def _notice_schema() -> dict[str, Any]:
    seconds = {"type": "number"}
    value = {"anyOf": [{"type": each} for each in ("string", "number", "boolean")]}
    return {
        "title": "Notice",
        "description": "Something about a capture that is no error and that its user should know.",
        "type": "object",
        "properties": {
            "code": {"enum": list(NOTICE_KINDS)},
            "bodies": {"type": "array", "items": {"type": "string"}},
            "start_s": seconds,
            "end_s": seconds,
            "values": {"type": "object", "additionalProperties": value},
            "message": {"type": "string"},
        },
        "required": ["code", "bodies", "values", "message"],
        "additionalProperties": False,
    }


def _notice(document: Any) -> Notice:
    if not isinstance(document, dict):
        raise ParError(f"expected an object in braces, found {_shown(document)}")
    return read_notice(document)


def _taken(
    content: dict[str, Any], key: str, read: Callable[[Any], _Part], what: str, where: str
) -> tuple[_Part, ...]:
    """Take a list out of the content and read each of its parts."""
    parts = content.get(key, [])
    if not isinstance(parts, list):
        raise ParError(f"{_place(where)}{key}: expected a list of {what}, found {_shown(parts)}")
    if key in content:
        content[key] = []
    out = []
    for index, each in enumerate(parts):
        try:
            out.append(read(each))
        except CaparError as error:
            raise ParError(f"{_place(where)}{key}.{index}: {error}") from None
    return tuple(out)


def _complaint(errors: list[Any], where: str) -> str:
    """The first mistake with its place, and how many more there are."""
    first = errors[0]
    place = ".".join(str(each) for each in first["loc"]) or "document"
    more = f" ({len(errors) - 1} more such)" if len(errors) > 1 else ""
    if first["type"] == "missing":
        return f"{_place(where)}{place}: expected a value, found none{more}"
    if first["type"] == "unexpected_keyword_argument":
        return f"{_place(where)}{place}: no such field{more}"
    message = first["msg"].removeprefix("Input should be ")
    return f"{_place(where)}{place}: expected {message}, found {_shown(first['input'])}{more}"


def _features_place(value: Any, place: str = "") -> str:
    """Where in a document the first feature set stands that contradicts itself."""
    names = {each.name for each in fields(FeatureSet)}
    if (
        isinstance(value, dict)
        and names == set(value)
        and all(isinstance(each, str) for each in value.values())
    ):
        try:
            FeatureSet(**value)
        except CaparError:
            return f"{place}: "
    items: Iterable[tuple[Any, Any]] = ()
    if isinstance(value, dict | list):
        items = value.items() if isinstance(value, dict) else enumerate(value)
    found = (_features_place(each, f"{place}.{key}" if place else str(key)) for key, each in items)
    return next(filter(None, found), "")


def _shown(value: Any) -> str:
    text = json.dumps(value)
    return text if len(text) <= 60 else f"{text[:57]}..."
