"""Label files: who did what from when to when, as people marked it."""

import csv
import json
import math
from collections.abc import Mapping
from dataclasses import dataclass, replace
from io import StringIO
from pathlib import Path
from typing import Any

import numpy as np
from jaxtyping import Float

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

SECONDS = ("link", "start_s", "end_s", "label")
FRAMES = ("hand", "start_frame", "end_frame", "action")
UNNAMED = {"", "None", "none", "null"}


@dataclass(frozen=True, slots=True, order=True)
class Label:
    """One mark: an action of a link from a start to an end."""

    link: str
    start: float
    """Seconds, or a frame's number."""

    end: float
    label: str
    object: str = ""


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


def read_labels(path: Path) -> Labels:
    """Read a label file, whichever of the known forms it has.

    The forms are CSV in seconds (``link,start_s,end_s,label[,object]``), CSV in frames
    (``hand,start_frame,end_frame,...,action,...,object``) and the JSON of the KIT Bimanual
    Actions Dataset.

    A mark that ends before it starts is left out, and what two marks claim belongs to neither;
    notices say so.

    Raises:
        FileError: It is none of these forms, or it marks nothing.
    """
    text = read_text(path)
    if text.lstrip().startswith("{"):
        marks, in_frames = _bimacts(path, text), True
    else:
        marks, in_frames = _table(path, text)
    return _agreed(path, marks, "frame" if in_frames else "second")


def in_seconds(labels: Labels, times: Float[np.ndarray, "frames"]) -> Labels:
    """The same marks in seconds.

    Args:
        labels: Marks in frames or in seconds; the latter stay as they are.
        times: Time of each frame that the labels count [s].

    Raises:
        FileError: The marks name frames that there are not.
    """
    if not labels.in_frames:
        return labels
    last = max(each.end for each in labels.marks)
    first = min(each.start for each in labels.marks)
    if first < 0 or last > len(times):
        raise FileError(
            labels.path,
            f"frames from {first:.0f} to {last:.0f} are marked, but the recording has frames "
            f"0 to {len(times) - 1}.",
            "Labels count the frames of the file that the capture is read from.",
        )
    frames = np.arange(len(times))
    marks = [
        replace(
            each,
            start=float(np.interp(each.start, frames, times)),
            end=float(np.interp(each.end, frames, times)),
        )
        for each in labels.marks
    ]
    return Labels(labels.path, tuple(marks), False, labels.notices)


def _table(path: Path, text: str) -> tuple[list[Label], bool]:
    lines = csv.DictReader(StringIO(text))
    header = tuple(lines.fieldnames or ())
    for columns, in_frames in ((SECONDS, False), (FRAMES, True)):
        if set(columns) <= set(header):
            rows = [_row(path, lines.line_num, row, columns) for row in lines]
            return [each for each in rows if each.label not in UNNAMED], in_frames
    raise FileError(
        path,
        f"its columns are {', '.join(header) or 'none'}.",
        f"A label table has the columns {','.join(SECONDS)}[,object], or {','.join(FRAMES)}; "
        "or give the JSON of the KIT Bimanual Actions Dataset.",
    )


def _row(path: Path, line: int, row: Mapping[str, str | None], columns: tuple[str, ...]) -> Label:
    link, start, end, label = ((row[column] or "").strip() for column in columns)
    thing = (row.get("object") or "").strip()
    place = f"{path}:{line}"
    return Label(
        link, _number(place, start), _number(place, end), label, "" if thing in UNNAMED else thing
    )


def _number(place: str, text: str) -> float:
    try:
        value = float(text)
    except ValueError:
        value = math.nan
    if not math.isfinite(value):
        raise FileError(place, f"{text!r} is no number.")
    return value


def _bimacts(path: Path, text: str) -> list[Label]:
    try:
        content: dict[str, list[Any]] = json.loads(text)
        return [each for link, marks in content.items() for each in _alternating(link, marks)]
    except (ValueError, TypeError, IndexError, AttributeError) as error:
        raise FileError(
            path,
            f"is no label file of the KIT Bimanual Actions Dataset: {error}.",
            'It reads {"right_hand": [0, [action, class, object], 98, ..., last frame]}.',
        ) from None


def _alternating(link: str, marks: list[Any]) -> list[Label]:
    """Marks from a list that alternates frames and actions."""
    out = []
    for start, action, end in zip(marks[:-1:2], marks[1::2], marks[2::2], strict=True):
        number, _, thing = action
        if number is not None:
            label = BIMACTS[number]
            out.append(Label(link, float(start), float(end), label, str(thing or "")))
    return out


def _agreed(path: Path, marks: list[Label], unit: str) -> Labels:
    """The marks without what contradicts itself, which the notices name."""
    if not marks:
        raise FileError(path, "marks nothing.", "A label file has at least one mark.")
    out: list[Label] = []
    notices = []
    claims: dict[str, Label] = {}
    for each in sorted(marks):
        if each.end < each.start:
            notices.append(f"{path}: left out {_shown(each, unit)}: it ends before it starts")
            continue
        claim = claims.get(each.link, each)
        if each.start < claim.end and claim is not each:
            notices.append(
                f"{path}: {_shown(each, unit)} and {_shown(claim, unit)} overlap; "
                "what both claim is not counted"
            )
            out[-1] = replace(out[-1], end=min(out[-1].end, each.start))
            out.append(replace(each, start=min(claim.end, each.end)))
        else:
            out.append(each)
        claims[each.link] = max(claim, each, key=lambda mark: mark.end)
    return Labels(path, tuple(out), unit == "frame", tuple(notices))


def _shown(mark: Label, unit: str) -> str:
    return f"{mark.label} of {mark.link} from {unit} {mark.start:g} to {mark.end:g}"
