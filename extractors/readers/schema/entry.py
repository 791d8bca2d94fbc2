"""A table of a capture.toml as a value: typed keys, and the file and line it was read from."""

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any, ClassVar

from pydantic import (
    BaseModel,
    ConfigDict,
    Field,
    GetJsonSchemaHandler,
    PrivateAttr,
    model_validator,
)
from pydantic.fields import FieldInfo
from pydantic_core import CoreSchema, PydanticCustomError

from capar.model.errors import FileError, UnknownNameError


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
        return f"{self.file}:{self.line(key)}"


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
        if isinstance(data, dict):
            for name in data:
                cls._check_key(name, data)
            if cls.one_of and not any(data.get(each) for each in cls.one_of):
                raise PydanticCustomError("one_of", "{names}", {"names": list(cls.one_of)})
        return data

    @classmethod
    def _check_key(cls, name: str, data: Mapping[str, Any]) -> None:
        if name not in cls.model_fields:
            known = list(cls.model_fields)
            raise PydanticCustomError("unknown_key", "{key}", {"key": name, "known": known})
        beside = relation(cls.model_fields[name], "beside")
        if beside and not any(each in data for each in beside):
            raise PydanticCustomError("beside", "{key}", {"key": name, "others": beside})
        apart = [each for each in relation(cls.model_fields[name], "apart") if each in data]
        if apart:
            raise PydanticCustomError("apart", "{key}", {"key": name, "others": apart})


def key(
    meaning: str,
    *,
    unit: str = "",
    beside: tuple[str, ...] = (),
    apart: tuple[str, ...] = (),
    **constraints: Any,
) -> Any:
    """What a key means: the description of its field.

    Args:
        meaning: One or two sentences, with what holds where the key is not given.
        unit: The unit of its numbers.
        beside: Keys of which one must be given with it.
        apart: Keys that cannot be given with it.
        constraints: Limits, as in ``pydantic.Field``.
    """
    text = f"{meaning} [{unit}]" if unit else meaning
    extra: Any = {"beside": list(beside), "apart": list(apart)}
    return Field(description=text, json_schema_extra=extra, **constraints)


def relation(field: FieldInfo, name: str) -> list[str]:
    """The keys ``beside`` or ``apart`` from a field's key."""
    extra = field.json_schema_extra
    found = extra.get(name, []) if isinstance(extra, dict) else []
    return [str(each) for each in found] if isinstance(found, list) else []
