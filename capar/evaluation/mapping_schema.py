"""The schema of a mapping file: which label a segment has, by its name and neighbours."""

# ruff: noqa: RUF012  (pydantic copies the defaults of fields)

from typing import Annotated, Literal

from extractors.readers.schema.entry import Entry, key


class MappingRule(Entry):
    """A label, and the segments that have it."""

    name: Annotated[str, key("The segment's name, or one that it specialises; * fits all.")]
    label: Annotated[str, key("The label.")]
    object: Annotated[str, key("Among the segment's objects.")] = ""
    dominant: Annotated[str, key("The segment's dominant object.")] = ""
    position: Annotated[
        Literal["before first", "after last", ""], key("Relative to the link's contacts.")
    ] = ""
    previous: Annotated[
        str | None, key("Name of the segment before; empty if there must be none.")
    ] = None
    next: Annotated[str | None, key("Name of the segment after; empty if there must be none.")] = (
        None
    )


class MappingFile(Entry):
    """Rules in order, and names of links."""

    links: Annotated[dict[str, str], key("Our link = the label file's, where they differ.")] = {}
    rule: Annotated[list[MappingRule], key("Rules; the first that fits counts.")] = []
    others: Annotated[
        list[str], key("Labels that no rule gives and that may occur: those segments are missed.")
    ] = []
