"""Label files of every form: CSV, JSON, ELAN, Praat, and the JSON of the Bimanual Actions."""

import csv
import json
import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from io import StringIO
from pathlib import Path
from typing import Any

from capar.evaluation.annotation_files import Annotation, read_elan, read_praat
from capar.evaluation.labels import Contradictions, Kind, Label, Labels, agreed
from capar.model.errors import FileError
from extractors.readers.files import read_text

BIMACTS = (
    "idle",
    "approach",
    "retreat",
    "lift",
    "place",
    "hold",
    "pour",
    "cut",
    "hammer",
    "saw",
    "stir",
    "screw",
    "drink",
    "wipe",
)
"""Names of the action numbers of the KIT Bimanual Actions Dataset."""

UNNAMED = {"", "None", "none", "null"}
UNSURE = {"no", "false", "0"}
SURE = {"", "yes", "true", "1"}


@dataclass(frozen=True)
class Columns:
    """The columns of a label table: for each field of a mark, the names that it may have."""

    link: tuple[str, ...] = ()
    label: tuple[str, ...] = ()
    object: tuple[str, ...] = ()
    needed: tuple[str, ...] = ()
    """Which of the three must be there."""

    constant: str = ""
    """The label of every mark, where there is no column of labels."""


COLUMNS = {
    Kind.ACTIONS: Columns(("link", "hand"), ("label", "action"), ("object",), ("link", "label")),
    Kind.CONTACTS: Columns(
        ("body", "link", "hand"), (), ("other", "object"), ("link", "object"), constant="contact"
    ),
    Kind.CARRIES: Columns(("link", "hand"), (), ("object",), ("object",), constant="carry"),
    Kind.EVENTS: Columns(
        ("hand", "link"), ("event", "label"), ("other", "object"), ("link", "label")
    ),
}
TIMES = (("start_s", "end_s"), ("start_frame", "end_frame"))
"""The columns of times, in seconds or in frames."""


def read_labels(
    path: Path,
    kind: Kind = Kind.ACTIONS,
    *,
    contradictions: Contradictions = Contradictions.REFUSE,
) -> Labels:
    """Read a label file, whichever of the known forms it has.

    Tables are CSV, or a JSON list of objects with the same keys: ``link,start_s,end_s,label`` for
    actions, ``body,other,start_s,end_s`` for contacts, ``object,start_s,end_s`` for carries and
    ``hand,event,start_s,end_s`` for events; ``start_frame,end_frame`` count frames. In ELAN and
    Praat files a tier is who acts, and a text what is done (actions), what is touched (contacts)
    or carried (carries), or both, event first (events).

    Raises:
        FileError: It is none of these forms, marks nothing, or a mark contradicts itself or
            another; the message has the line.
    """
    suffix = path.suffix.lower()
    if suffix == ".textgrid":
        marks, in_frames = _annotated(path, read_praat(path), kind), False
    elif suffix == ".eaf":
        marks, in_frames = _annotated(path, read_elan(path), kind), False
    else:
        marks, in_frames = _text(path, read_text(path), kind)
    return agreed(path, marks, in_frames=in_frames, kind=kind, contradictions=contradictions)


def _text(path: Path, text: str, kind: Kind) -> tuple[list[Label], bool]:
    opening = text.lstrip()[:1]
    if opening == "{" and kind is Kind.ACTIONS:
        return _bimacts(path, text), True
    if opening in {"[", "{"}:
        return _rows(path, list(_json_rows(path, text)), kind)
    return _rows(path, list(_csv_rows(text)), kind, _header(text))


Row = tuple[int, Mapping[str, str]]
"""A line's number, and the values by column."""


def _header(text: str) -> Sequence[str]:
    lines = [line for line in text.splitlines() if not line.startswith("#")]
    return next(csv.reader(lines), [])


def _csv_rows(text: str) -> Iterator[Row]:
    """The rows of a CSV; lines that begin with # are left out, and counted."""
    header: list[str] | None = None
    for number, line in enumerate(text.splitlines(), 1):
        if line.startswith("#") or not line.strip():
            continue
        values = next(csv.reader(StringIO(line)))
        if header is None:
            header = values
            continue
        yield number, dict(zip(header, values, strict=False))


def _json_rows(path: Path, text: str) -> Iterator[Row]:
    """The objects of a JSON list, each with the line that it begins in."""
    remedy = 'Such a file reads [{"link": "right_hand", "start_s": 0.0, ...}, ...].'
    decoder = json.JSONDecoder()
    place = text.find("[") + 1 if text.lstrip().startswith("[") else -1
    if not place:
        raise FileError(f"{path}:1", "is no JSON list.", remedy)
    while True:
        while place < len(text) and text[place] in " \t\r\n,":
            place += 1
        line = text.count("\n", 0, place) + 1
        if text[place : place + 1] == "]":
            return
        try:
            row, place = decoder.raw_decode(text, place)
        except (ValueError, RecursionError) as error:
            raise FileError(f"{path}:{line}", f"is no JSON: {error}.", remedy) from None
        if not isinstance(row, dict):
            raise FileError(f"{path}:{line}", "is no JSON object.", remedy)
        yield line, {key: "" if value is None else str(value) for key, value in row.items()}


def _rows(
    path: Path, rows: Sequence[Row], kind: Kind, header: Sequence[str] | None = None
) -> tuple[list[Label], bool]:
    names = list(header if header is not None else (rows[0][1] if rows else ()))
    columns, times = COLUMNS[kind], [each for each in TIMES if set(each) <= set(names)]
    missing = [each for each in columns.needed if not _column(getattr(columns, each), names)]
    if (missing or not times) and (rows or header is not None):
        place = f"{path}:{rows[0][0]}" if header is None else path
        raise FileError(place, f"its columns are {', '.join(names) or 'none'}.", _wanted(kind))
    marks = [_mark(f"{path}:{line}", row, columns, times[0]) for line, row in rows]
    kept = [each for each in marks if each.label not in UNNAMED]
    return kept, bool(times) and times[0] == TIMES[1]


def _wanted(kind: Kind) -> str:
    columns = COLUMNS[kind]
    own = ",".join(getattr(columns, each)[0] for each in columns.needed)
    optional = [getattr(columns, each)[0] for each in ("link", "object")
                if each not in columns.needed and getattr(columns, each)]  # fmt: skip
    more = "".join(f"[,{each}]" for each in [*optional, "sure"])
    return (
        f"A table of {kind} has the columns {own},start_s,end_s{more}, or with "
        "start_frame,end_frame in the place of seconds."
    )


def _column(accepted: Sequence[str], names: Sequence[str]) -> str:
    return next((each for each in accepted if each in names), "")


def _mark(place: str, row: Mapping[str, str], columns: Columns, times: tuple[str, str]) -> Label:
    def value(accepted: Sequence[str]) -> str:
        return (row.get(_column(accepted, list(row)), "") or "").strip()

    thing = value(columns.object)
    for needed in columns.needed:
        if needed != "label" and value(getattr(columns, needed)) in UNNAMED:
            raise FileError(place, f"has no {getattr(columns, needed)[0]}.")
    return Label(
        link=value(columns.link),
        start=_number(place, (row.get(times[0]) or "").strip()),
        end=_number(place, (row.get(times[1]) or "").strip()),
        label=columns.constant or value(columns.label),
        object="" if thing in UNNAMED else thing,
        sure=_sure(place, (row.get("sure") or "").strip()),
        where=place,
    )


def _sure(place: str, text: str) -> bool:
    if text.lower() not in SURE | UNSURE:
        raise FileError(place, f"sure is {text!r}.", "Write yes or no.")
    return text.lower() in SURE


def _number(place: str, text: str) -> float:
    try:
        value = float(text)
    except ValueError:
        value = math.nan
    if not math.isfinite(value):
        raise FileError(place, f"{text!r} is no number.")
    return value


def _annotated(path: Path, found: Sequence[Annotation], kind: Kind) -> list[Label]:
    """Marks from tiers: a tier is who acts, a text what is done, touched or carried."""
    out = []
    for annotation in found:
        if not annotation.text.strip():
            continue
        first, _, second = annotation.text.strip().partition(" ")
        label, thing = {
            Kind.ACTIONS: (annotation.text.strip(), ""),
            Kind.CONTACTS: ("contact", annotation.text.strip()),
            Kind.CARRIES: ("carry", annotation.text.strip()),
            Kind.EVENTS: (first, second.strip()),
        }[kind]
        link = "" if kind is Kind.CARRIES else annotation.tier
        out.append(
            Label(link, annotation.start_s, annotation.end_s, label, thing, where=annotation.where)
        )
    return out


def _bimacts(path: Path, text: str) -> list[Label]:
    try:
        content: dict[str, list[Any]] = json.loads(text)
        return [
            each
            for link, marks in content.items()
            for each in _alternating(link, marks, f"{path}:{_line_of(text, link)}")
        ]
    except (ValueError, TypeError, IndexError, AttributeError, RecursionError) as error:
        raise FileError(
            path,
            f"is no label file of the KIT Bimanual Actions Dataset: {error}.",
            'It reads {"right_hand": [0, [action, class, object], 98, ..., last frame]}.',
        ) from None


def _line_of(text: str, link: str) -> int:
    return text.count("\n", 0, max(text.find(json.dumps(link)), 0)) + 1


def _alternating(link: str, marks: list[Any], where: str) -> list[Label]:
    """Marks from a list that alternates frames and actions."""
    out = []
    for start, action, end in zip(marks[:-1:2], marks[1::2], marks[2::2], strict=True):
        number, _, thing = action
        if number is not None:
            label = BIMACTS[number]
            out.append(Label(link, float(start), float(end), label, str(thing or ""), where=where))
    return out
