"""The reference page and the JSON schema of capture.toml, made from its schema.

``python -m extractors.readers.schema.reference PATH`` writes the page.
"""

import json
import sys
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

from extractors.readers.schema.capture import (
    SHAPES,
    ArrayGroup,
    CaptureFile,
    Contact,
    ManyObjects,
    ManySensors,
    MotionFile,
    ObjectEntry,
    ObjectKind,
    Performer,
    Pivots,
    Pose,
    Purposes,
    SensorEntry,
)
from extractors.readers.schema.entry import Entry, relation

DRAFT = "https://json-schema.org/draft/2020-12/schema"

TABLES: dict[str, type[Entry]] = {
    "General keys": CaptureFile,
    "`[files]` and `[files.NAME]`": MotionFile,
    "`arrays = [{ ... }]` of a file": ArrayGroup,
    "`[agent]` or `[[agent]]`": Performer,
    "`[[sensor]]`": SensorEntry,
    "`[[object]]`": ObjectEntry,
    "`[[sensors_from]]`": ManySensors,
    "`[[objects_from]]`": ManyObjects,
    "`[objects_from.kinds]`": ObjectKind,
    "`offset = { ... }`": Pose,
    **{f"`shape = {{ {name} = ... }}`": kind for name, kind in SHAPES.items() if "_" not in name},
    '`shape = { box = "markers" }`': SHAPES["box_markers"],
    "`[[pivot_contact]]`": Pivots,
    "`[contact]`": Contact,
    "`[[purpose]]`": Purposes,
}
"""Every table of a capture.toml, in the order of the page."""

HEAD = """# capture.toml

A `capture.toml` describes a trial: which files hold the motion, and which body of them is what.
`capar new-capture FILES...` drafts one; `capar new-capture --schema` prints a JSON schema with
which editors complete and check it.

Lengths are in metres and times in seconds, except in the motion files, whose unit and upward axis
are stated by the file itself or by `unit` and `up`. What the `capture.toml` itself places (the
`position` of a fixed object) is in the world that files are brought to: metres, right-handed, and
the **z axis points up, even with `up = "y"`**. With `up = "y"` a point (x, y, z) of a file is
(x, -z, y) in the world; a left-handed file is first mirrored in x.

In texts, `{take}` stands for the name of the take and `${NAME}` in a path for an environment
variable. A key that does not exist, a value of another type and a name that nothing has are
reported with file, line and the nearest right name.
"""


def json_schema() -> dict[str, Any]:
    """The JSON schema (draft 2020-12) of a capture.toml."""
    schema = CaptureFile.model_json_schema()
    return {"$schema": DRAFT, **_plain(schema), "title": "capture.toml"}


def _plain(value: Any) -> Any:
    """A JSON schema without what TOML cannot say (null) and without our own annotations."""
    if isinstance(value, list):
        return [_plain(item) for item in value if item != {"type": "null"}]
    if not isinstance(value, dict):
        return value
    out = {
        key: _plain(item)
        for key, item in value.items()
        if key not in {"beside", "apart"} and not (key == "default" and item is None)
    }
    if len(out.get("anyOf", [])) == 1 and "required" not in out["anyOf"][0]:
        out |= out.pop("anyOf")[0]
    return out


def reference() -> str:
    """The reference page, in Markdown."""
    schema = json_schema()
    definitions = {"CaptureFile": schema, **schema["$defs"]}
    definitions["Pose"] = _plain(Pose.model_json_schema())
    sections = [
        "\n".join(_section(title, kind, definitions[kind.__name__]))
        for title, kind in TABLES.items()
    ]
    return "\n".join([HEAD, *sections])


def _section(title: str, kind: type[Entry], schema: Mapping[str, Any]) -> Iterator[str]:
    """A heading, what the table is, and a row for each key."""
    yield f"## {title}\n"
    yield f"{kind.__doc__}\n".replace("``", "`")
    if kind.one_of:
        yield f"At least one of {', '.join(f'`{name}`' for name in kind.one_of)} is given.\n"
    yield "| key | value | default | meaning |"
    yield "|---|---|---|---|"
    required = [name for name, field in kind.model_fields.items() if field.is_required()]
    for name in dict.fromkeys([*required, *kind.one_of, *kind.model_fields]):
        yield _row(name, kind, schema)
    yield ""


def _row(name: str, kind: type[Entry], schema: Mapping[str, Any]) -> str:
    key, field = schema["properties"][name], kind.model_fields[name]
    default = key.get("default", "")
    shown = "required" if field.is_required() else (f"`{_toml(default)}`" if default else "")
    meaning = str(field.description).replace("``", "`").replace("|", "\\|")
    for relative, words in (("beside", "Only with"), ("apart", "Not with")):
        if others := relation(field, relative):
            meaning += f" {words} {' or '.join(f'`{other}`' for other in others)}."
    return f"| `{name}` | {_value(key)} | {shown} | {meaning} |"


def _toml(value: Any) -> str:
    return json.dumps(value, ensure_ascii=False)


def _value(schema: Mapping[str, Any]) -> str:
    """What a value is, in words."""
    for group in ("anyOf", "oneOf"):
        if group in schema:
            return " or ".join(dict.fromkeys(_value(item) for item in schema[group]))
    if "const" in schema or "enum" in schema:
        return ", ".join(f"`{_toml(word)}`" for word in schema.get("enum", [schema.get("const")]))
    if schema.get("type") == "array":
        return _list(schema)
    if schema.get("type") == "object" and "additionalProperties" in schema:
        return f"table of names, each {_value(schema['additionalProperties'])}"
    words = {"number": "number", "string": "text", "boolean": "true or false"}
    return words.get(str(schema.get("type")), "table") + _limits(schema)


def _list(schema: Mapping[str, Any]) -> str:
    least, most = schema.get("minItems"), schema.get("maxItems")
    count = f"{least} " if least and least == most else f"{least} to {most} " if most else ""
    item = _value(schema.get("items", {}))
    word, _, limits = item.partition(" ") if item.startswith("number") else (item, "", "")
    plural = f"{word}s" if word.isalpha() else word
    return f"{count or 'list of '}{plural}" + (f", each {limits}" if limits else "")


def _limits(schema: Mapping[str, Any]) -> str:
    words = {"exclusiveMinimum": ">", "minimum": ">=", "exclusiveMaximum": "<", "maximum": "<="}
    found = [f"{sign} {schema[name]:g}" for name, sign in words.items() if name in schema]
    return f" {' and '.join(found)}" if found else ""


if __name__ == "__main__":
    Path(sys.argv[1]).write_text(reference(), encoding="utf-8")
