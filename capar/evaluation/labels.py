"""Labels: what people say was done, by whom and when, read from files of every form and checked."""

import contextlib
import csv
import io
import json
import math
import warnings
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any

import numpy as np
from jaxtyping import Float

from capar.evaluation import Contradictions, Kind
from capar.model.errors import FileError, UnknownNameError
from extractors.readers.file_access import read_bytes, read_text


@dataclass(frozen=True, slots=True, order=True)
class Label:
    """One mark from a start to an end."""

    link: str
    """Who acts: a link, or of a contact its first body; empty where a carry names none."""

    start: float
    """Seconds, or a frame's number."""

    end: float
    label: str
    object: str = ""
    """What it is done to: an object, or the other body of a contact or event."""

    sure: bool = True
    """Whether it counts; what is open is counted neither as right nor as wrong."""

    where: str = field(default="", compare=False)
    """File and line."""


@dataclass(frozen=True, slots=True)
class Labels:
    """The marks of one file, ordered by link and start."""

    path: Path
    marks: tuple[Label, ...]
    in_frames: bool
    """Whether starts and ends are numbers of frames, not seconds."""

    notices: tuple[str, ...] = ()
    """Marks that contradict themselves or each other, and what was made of them."""

    def of(self, link: str) -> tuple[Label, ...]:
        """The marks of one link."""
        return tuple(each for each in self.marks if each.link == link)

    @property
    def links(self) -> tuple[str, ...]:
        """Names of the links that have marks."""
        return tuple(sorted({each.link for each in self.marks}))

    @property
    def names(self) -> tuple[str, ...]:
        """The labels that occur."""
        return tuple(sorted({each.label for each in self.marks}))

    def renamed(self, names: dict[str, str]) -> "Labels":
        """The same marks with our names of links and bodies in the place of the file's."""
        marks = [
            replace(
                each,
                link=names.get(each.link, each.link),
                object=names.get(each.object, each.object),
            )
            for each in self.marks
        ]
        return replace(self, marks=tuple(sorted(marks)))


def check_known(labels: Labels, kind: str, known: Iterable[str], *, at: str) -> None:
    """Prove that every name in the marks exists.

    Raises:
        UnknownNameError: One does not exist; it says file and line, and lists those that do.
    """
    names = set(known)
    for mark in labels.marks:
        name = getattr(mark, at)
        if name and name not in names:
            raise UnknownNameError(kind, name, names, where=mark.where or str(labels.path))


def in_seconds(labels: Labels, times: Float[np.ndarray, "frames"]) -> Labels:
    """The same marks in seconds.

    Args:
        labels: Marks in frames or in seconds; the latter stay as they are.
        times: Time of each frame that the labels count [s].

    Raises:
        FileError: A mark is outside the recording; it says file and line.
    """
    if not labels.in_frames:
        return labels
    for mark in labels.marks:
        if mark.start < 0 or mark.end > len(times):
            raise FileError(
                mark.where or labels.path,
                f"frames from {mark.start:.0f} to {mark.end:.0f} are marked, but the recording "
                f"has frames 0 to {len(times) - 1}.",
                "Labels count the frames of the file that the capture is read from.",
            )
    frames = np.arange(len(times) + 1)
    clock = np.append(times, _after_last(times))
    marks = [
        replace(
            each,
            start=float(np.interp(each.start, frames, clock)),
            end=float(np.interp(each.end, frames, clock)),
        )
        for each in labels.marks
    ]
    return replace(labels, marks=tuple(marks), in_frames=False)


def check_span(labels: Labels, times: Float[np.ndarray, "frames"]) -> None:
    """Prove that no mark in seconds lies outside the capture by more than a frame.

    Raises:
        FileError: One does; it says file and line.
    """
    step = _after_last(times) - float(times[-1])
    for mark in labels.marks:
        if mark.start < float(times[0]) - 1.5 * step or mark.end > float(times[-1]) + 1.5 * step:
            raise FileError(
                mark.where or labels.path,
                f"{shown(mark, 'second')} is outside of the capture, which lasts from "
                f"{times[0]:.2f} to {times[-1]:.2f} s.",
                "Give times in seconds of the capture's own clock.",
            )


def agreed(
    path: Path,
    marks: Iterable[Label],
    *,
    in_frames: bool,
    kind: Kind = Kind.ACTIONS,
    contradictions: Contradictions = Contradictions.REFUSE,
) -> Labels:
    """The marks of a file, none of which contradicts itself or another.

    Raises:
        FileError: There are none, or one contradicts itself or another and is not to be left out.
    """
    every = sorted(marks)
    if not every:
        raise FileError(path, "marks nothing.", "A label file has at least one mark.")
    unit = "frame" if in_frames else "second"
    groups: dict[object, list[Label]] = {}
    for each in every:  # marks of a group exclude each other in time
        key = {
            Kind.ACTIONS: each.link,
            Kind.CONTACTS: (each.link, each.object),
            Kind.CARRIES: each.object,
            Kind.EVENTS: id(each),
        }[kind]
        groups.setdefault(key, []).append(each)
    out: list[Label] = []
    notices: list[str] = []
    strict = contradictions == Contradictions.REFUSE
    for group in groups.values():
        kept, said = _consistent(path, group, unit, strict=strict)
        out += kept
        notices += said
    return Labels(path, tuple(sorted(out)), in_frames, tuple(notices))


def shown(mark: Label, unit: str) -> str:
    """A mark in words, with its times in frames or seconds."""
    who = " and ".join(filter(None, (mark.link, mark.object if mark.label == "contact" else "")))
    about = who or mark.object
    return f"{mark.label} of {about} from {unit} {mark.start:g} to {mark.end:g}"


def _consistent(
    path: Path, marks: list[Label], unit: str, *, strict: bool
) -> tuple[list[Label], list[str]]:
    """The marks of one channel without what contradicts itself, which the notices name."""
    out: list[Label] = []
    notices: list[str] = []
    claim: Label | None = None

    def refuse(mark: Label, problem: str) -> None:
        if strict:
            remedy = "Correct it, or leave such marks out: --contradictions leave-out."
            raise FileError(mark.where or path, problem, remedy)

    for each in sorted(marks, key=lambda mark: (mark.start, mark.end)):
        if each.end < each.start:
            refuse(each, f"{shown(each, unit)} ends before it starts.")
            notices.append(f"{path}: left out {shown(each, unit)}: it ends before it starts")
            continue
        if claim is not None and each.start < claim.end:
            both = f"{shown(each, unit)} and {shown(claim, unit)} overlap"
            line = claim.where.rpartition(":")[2]
            refuse(each, f"{both} (the other in line {line})." if line.isdigit() else f"{both}.")
            notices.append(f"{path}: {both}; what both claim is not counted")
            out[-1] = replace(out[-1], end=min(out[-1].end, each.start))
            out.append(replace(each, start=min(claim.end, each.end)))
        else:
            out.append(each)
        claim = each if claim is None else max(claim, each, key=lambda mark: mark.end)
    return out, notices


def _after_last(times: Float[np.ndarray, "frames"]) -> float:
    """When the frame after the last would be taken [s]."""
    step = float(np.median(np.diff(times))) if len(times) > 1 else 0.0
    return float(times[-1]) + step


BOMS = ((b"\xff\xfe", "utf-16"), (b"\xfe\xff", "utf-16"), (b"\xef\xbb\xbf", "utf-8-sig"))
"""How a file begins that says its encoding; Praat writes UTF-16 where a text needs it."""

BIMACTS = (
    "idle", "approach", "retreat", "lift", "place", "hold", "pour", "cut", "hammer", "saw", "stir",
    "screw", "drink", "wipe",
)  # fmt: skip
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


Annotation = tuple[str, float, float, str, str]
"""Tier, start and end [s], text, and file and line (or tier and number) of an annotation."""


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
    in_frames = False
    if suffix in READERS:
        marks = _annotated(READERS[suffix](path), kind)
    else:
        text = read_text(path)
        opening = text.lstrip()[:1]
        if opening == "{" and kind is Kind.ACTIONS:
            marks, in_frames = _bimacts(path, text), True
        elif opening in {"[", "{"}:
            marks, in_frames = _rows(path, list(_json_rows(path, text)), kind)
        else:
            lines = enumerate(text.splitlines(), 1)
            kept = [(n, line) for n, line in lines if line.strip() and not line.startswith("#")]
            header = next(csv.reader([kept[0][1]]), []) if kept else []
            rows = [
                (n, dict(zip(header, next(csv.reader([line])), strict=False)))
                for n, line in kept[1:]
            ]
            marks, in_frames = _rows(path, rows, kind, header)
    return agreed(path, marks, in_frames=in_frames, kind=kind, contradictions=contradictions)


Row = tuple[int, Mapping[str, str]]
"""A line's number, and the values by column."""


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
    sure = (row.get("sure") or "").strip()
    if sure.lower() not in SURE | UNSURE:
        raise FileError(place, f"sure is {sure!r}.", "Write yes or no.")
    return Label(
        link=value(columns.link),
        start=_number(place, (row.get(times[0]) or "").strip()),
        end=_number(place, (row.get(times[1]) or "").strip()),
        label=columns.constant or value(columns.label),
        object="" if thing in UNNAMED else thing,
        sure=sure.lower() in SURE,
        where=place,
    )


def _number(place: str, text: str) -> float:
    try:
        value = float(text)
    except ValueError:
        value = math.nan
    if not math.isfinite(value):
        raise FileError(place, f"{text!r} is no number.")
    return value


def _annotated(found: Sequence[Annotation], kind: Kind) -> list[Label]:
    """Marks from tiers: a tier is who acts, a text what is done, touched or carried."""
    out = []
    for tier, start, end, words, where in found:
        text = words.strip()
        first, _, second = text.partition(" ")
        label, thing = {
            Kind.ACTIONS: (text, ""),
            Kind.CONTACTS: ("contact", text),
            Kind.CARRIES: ("carry", text),
            Kind.EVENTS: (first, second.strip()),
        }[kind]
        link = "" if kind is Kind.CARRIES else tier
        if text:
            out.append(Label(link, start, end, label, thing, where=where))
    return out


def _bimacts(path: Path, text: str) -> list[Label]:
    out = []
    try:
        content: dict[str, list[Any]] = json.loads(text)
        for link, marks in content.items():
            line = text.count("\n", 0, max(text.find(json.dumps(link)), 0)) + 1
            for start, action, end in zip(marks[:-1:2], marks[1::2], marks[2::2], strict=True):
                number, _, held = action
                if number is not None:
                    name, where = BIMACTS[number], f"{path}:{line}"
                    label = Label(link, float(start), float(end), name, str(held or ""))
                    out.append(replace(label, where=where))
    except (ValueError, TypeError, IndexError, AttributeError, RecursionError) as error:
        raise FileError(
            path,
            f"is no label file of the KIT Bimanual Actions Dataset: {error}.",
            'It reads {"right_hand": [0, [action, class, object], 98, ..., last frame]}.',
        ) from None
    return out


def read_elan(path: Path) -> list[Annotation]:
    """The time-aligned annotations of every tier of an ELAN file; tiers of references have none.

    Raises:
        FileError: It is no ELAN file, or an annotation has no time.
    """
    from defusedxml import DefusedXmlException
    from defusedxml.ElementTree import ParseError, fromstring
    from pympi import Eaf

    remedy = "Give an ELAN annotation file (.eaf), as ELAN saves it."
    text = read_bytes(path)
    try:
        root = fromstring(text)
    except ParseError as error:
        raise FileError(f"{path}:{error.position[0]}", f"is no XML: {error}.", remedy) from None
    except (DefusedXmlException, ValueError) as error:
        raise FileError(path, f"is refused: {error!r}.", remedy) from None
    if root.tag != "ANNOTATION_DOCUMENT":
        raise FileError(path, f"holds <{root.tag}>.", remedy)
    file = _quietly(path, lambda: Eaf(str(path), suppress_version_warning=True), remedy)
    out: list[Annotation] = []
    for tier, (aligned, *_) in file.tiers.items():
        for name, (first, last, words, _) in aligned.items():
            where = f"{path}: tier {tier!r}, {name}"
            times = [file.timeslots.get(each) for each in (first, last)]
            if None in times:
                raise FileError(
                    where, f"annotation {words!r} on tier {tier!r} has no time of its own.",
                    "Align its start and its end to the time line in ELAN.",
                )  # fmt: skip
            start, end = (float(each) / 1000.0 for each in times)
            out.append((tier, start, end, words, where))
    return out


def read_praat(path: Path) -> list[Annotation]:
    """The intervals with a text, of every interval tier of a TextGrid.

    Raises:
        FileError: It is no TextGrid.
    """
    from pympi import TextGrid

    content = read_bytes(path)
    codec = next((name for bom, name in BOMS if content.startswith(bom)), "utf-8")
    remedy = "Give a Praat TextGrid, as Praat saves it."
    file = _quietly(path, lambda: TextGrid(str(path), codec=codec), remedy)
    out: list[Annotation] = []
    for tier in file.get_tiers():
        if tier.tier_type == "IntervalTier":
            for index, (start, end, text) in enumerate(tier.get_intervals(), 1):
                if text.strip():
                    where = f"{path}: tier {tier.name!r}, interval {index}"
                    out.append((tier.name, start, end, text, where))
    return out


def _quietly(path: Path, read: Callable[[], Any], remedy: str) -> Any:
    """What pympi reads; it raises bare exceptions of many kinds and may write to the terminal."""
    try:
        with warnings.catch_warnings(), contextlib.redirect_stdout(io.StringIO()):
            warnings.simplefilter("ignore")
            return read()
    except Exception as error:  # pympi raises Exception itself, and whatever bytes make of it
        kind = type(error).__name__
        raise FileError(path, f"cannot be read to its end ({kind}: {error}).", remedy) from None


READERS: Mapping[str, Callable[[Path], list[Annotation]]] = {
    ".textgrid": read_praat,
    ".eaf": read_elan,
}
"""By suffix, in lower case."""
