"""An observation as JSON, and back."""

import json
from collections.abc import Callable, Mapping
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
from capar.model.par import ComplexPar, Ipar, Upar

SCHEMA = 3  # the version that this program reads and writes, the field ``schema`` of an observation


#: What has a JSON form
Value: TypeAlias = Observation | ComplexPar | Upar | Ipar | Calibration
#: Each kind by the name of its schema
KINDS: dict[str, type[Value]] = {
    "observation": Observation,
    "complex_par": ComplexPar,
    "upar": Upar,
    "ipar": Ipar,
    "calibration": Calibration,
}
_Part = TypeVar("_Part", Fact, Notice)
_T = TypeVar("_T", Observation, ComplexPar, Upar, Ipar, Calibration)


def to_json(value: Value) -> str:
    """The value as JSON: keys in the order of the fields, facts as atoms; ParError for NaN."""
    return json.dumps(document(value), indent=2, ensure_ascii=False, allow_nan=False) + "\n"


def document(value: Value) -> dict[str, Any]:
    """The value as dictionaries, lists, strings and finite numbers; else ParError."""
    out: dict[str, Any] = _plain(value, type(value).__name__)
    return {"schema": SCHEMA, **out} if isinstance(value, Observation) else out


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


def from_json(text: str, *, where: str = "") -> Observation:
    """The observation that a JSON text states; ParError as for `value_from_json`."""
    return value_from_json(text, Observation, where=where)


def value_from_json(text: str, kind: type[_T], *, where: str = "") -> _T:
    """The observation, PAR or calibration of a given kind that a JSON text states.

    Raises:
        ParError: No JSON, or not of the schema; it says at which place and what was expected.
    """
    try:
        return _read(text, kind)
    except CaparError as error:
        raise ParError(f"{where}: {error}" if where else str(error)) from None


def _read(text: str, kind: type[_T]) -> _T:
    from pydantic import TypeAdapter, ValidationError

    try:
        content = json.loads(text)
    except (json.JSONDecodeError, RecursionError) as error:
        raise ParError(f"this is no JSON: {error}") from None
    if not isinstance(content, dict):
        raise ParError(f"expected an object in braces, found {_shown(content)}")
    if kind is Observation:
        found = content.pop("schema", 1)
        if found == 1 and "links" not in content:
            raise ParError("expected an observation, found none of its fields")
        if found != SCHEMA:
            raise ParError(
                f"this is an observation of schema {found}, this program reads {SCHEMA}; "
                "observe the capture again"
            )
    facts = _taken(content, "facts", read_fact, "atoms")
    notices = _taken(content, "notices", read_notice, "notices")
    try:
        value: _T = TypeAdapter(kind).validate_json(
            json.dumps(content), strict=True, extra="forbid"
        )
    except ValidationError as error:
        raise ParError(_complaint(error.errors())) from None
    return replace(value, facts=facts, notices=notices) if isinstance(value, Observation) else value


def _taken(
    content: dict[str, Any], key: str, read: Callable[[Any], _Part], what: str
) -> tuple[_Part, ...]:
    """Take a list out of the content and read each of its parts."""
    parts = content.get(key, [])
    if not isinstance(parts, list):
        raise ParError(f"{key}: expected a list of {what}, found {_shown(parts)}")
    if key in content:
        content[key] = []
    out = []
    for index, each in enumerate(parts):
        try:
            out.append(read(each))
        except CaparError as error:
            raise ParError(f"{key}.{index}: {error}") from None
    return tuple(out)


def _complaint(errors: list[Any]) -> str:
    """The first mistake with its place, and how many more there are."""
    first = errors[0]
    place = ".".join(str(each) for each in first["loc"]) or "document"
    more = f" ({len(errors) - 1} more such)" if len(errors) > 1 else ""
    expected = first["msg"].removeprefix("Input should be ")
    says = {
        "missing": "expected a value, found none",
        "unexpected_keyword_argument": "no such field",
        "value_error": str(first.get("ctx", {}).get("error", "")),
    }.get(first["type"], f"expected {expected}, found {_shown(first['input'])}")
    return f"{place}: {says}{more}"


def _shown(value: Any) -> str:
    text = json.dumps(value)
    return text if len(text) <= 60 else f"{text[:57]}..."


def schema_text(name: str) -> str:
    """The JSON schema (draft 2020-12) of the kind of that name, made from the values' types."""
    from pydantic import TypeAdapter

    out = TypeAdapter(KINDS[name]).json_schema(mode="serialization")
    for each in (out, *out.get("$defs", {}).values()):
        if each.get("type") == "object":
            each["additionalProperties"] = False
    if "Fact" in out.get("$defs", {}):
        out["$defs"] |= {"Fact": FACT_SCHEMA, "Notice": NOTICE_SCHEMA}
    if name == "observation":
        out["properties"] = {"schema": {"const": SCHEMA, "type": "integer"}, **out["properties"]}
        out["required"] = ["schema", *out["required"]]
    published = {"$schema": "https://json-schema.org/draft/2020-12/schema", **out}
    return json.dumps(published, indent=2, ensure_ascii=False) + "\n"


def published_schema(name: str) -> str:
    """The text of the published schema file of the kind of that name."""
    folder = resources.files("capar.model").joinpath("schema")
    return folder.joinpath(f"{name}.schema.json").read_text(encoding="utf-8")


FACT_SCHEMA = {
    "title": "Fact",
    "description": "A ground fact, as an atom: touching(right_hand,mug,118,335)",
    "type": "string",
    "pattern": r"^[a-z][A-Za-z0-9_]*(\(.+\))?$",
}
_VALUE = {"anyOf": [{"type": each} for each in ("string", "number", "boolean")]}
NOTICE_SCHEMA = {
    "title": "Notice",
    "description": "Something about a capture that is no error and that its user should know.",
    "type": "object",
    "properties": {
        "code": {"enum": list(NOTICE_KINDS)},
        "bodies": {"type": "array", "items": {"type": "string"}},
        "start_s": {"type": "number"},
        "end_s": {"type": "number"},
        "values": {"type": "object", "additionalProperties": _VALUE},
        "message": {"type": "string"},
    },
    "required": ["code", "bodies", "values", "message"],
    "additionalProperties": False,
}
