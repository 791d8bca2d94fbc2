"""Labels: what people say was done, by whom and when, checked against themselves and the clock."""

from collections.abc import Iterable
from dataclasses import dataclass, field, replace
from pathlib import Path

import numpy as np
from jaxtyping import Float

from capar.evaluation.kinds import Contradictions as Contradictions
from capar.evaluation.kinds import Kind as Kind
from capar.model.errors import FileError, UnknownNameError


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

    Args:
        labels: The marks.
        kind: What is named, for the message.
        known: The names that exist.
        at: The field of the marks that holds the name; an empty name is not looked at.

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
    out: list[Label] = []
    notices: list[str] = []
    for group in _channels(every, kind):
        kept, said = _consistent(path, group, unit, strict=contradictions == Contradictions.REFUSE)
        out += kept
        notices += said
    return Labels(path, tuple(sorted(out)), in_frames, tuple(notices))


def shown(mark: Label, unit: str) -> str:
    """A mark in words, with its times in frames or seconds."""
    who = " and ".join(filter(None, (mark.link, mark.object if mark.label == "contact" else "")))
    about = who or mark.object
    return f"{mark.label} of {about} from {unit} {mark.start:g} to {mark.end:g}"


def _channels(marks: list[Label], kind: Kind) -> list[list[Label]]:
    """Marks that exclude each other in time, together; events exclude none."""
    key = {
        Kind.ACTIONS: lambda mark: mark.link,
        Kind.CONTACTS: lambda mark: (mark.link, mark.object),
        Kind.CARRIES: lambda mark: mark.object,
        Kind.EVENTS: id,
    }[kind]
    groups: dict[object, list[Label]] = {}
    for each in marks:
        groups.setdefault(key(each), []).append(each)
    return list(groups.values())


def _consistent(
    path: Path, marks: list[Label], unit: str, *, strict: bool
) -> tuple[list[Label], list[str]]:
    """The marks of one channel without what contradicts itself, which the notices name."""
    out: list[Label] = []
    notices: list[str] = []
    claim: Label | None = None
    for each in sorted(marks, key=lambda mark: (mark.start, mark.end)):
        if each.end < each.start:
            _refuse(each, f"{shown(each, unit)} ends before it starts.", path, strict=strict)
            notices.append(f"{path}: left out {shown(each, unit)}: it ends before it starts")
            continue
        if claim is not None and each.start < claim.end:
            both = f"{shown(each, unit)} and {shown(claim, unit)} overlap"
            _refuse(each, f"{both}{_line(claim)}.", path, strict=strict)
            notices.append(f"{path}: {both}; what both claim is not counted")
            out[-1] = replace(out[-1], end=min(out[-1].end, each.start))
            out.append(replace(each, start=min(claim.end, each.end)))
        else:
            out.append(each)
        claim = each if claim is None else max(claim, each, key=lambda mark: mark.end)
    return out, notices


def _refuse(mark: Label, problem: str, path: Path, *, strict: bool) -> None:
    if strict:
        remedy = "Correct it, or leave such marks out: --contradictions leave-out."
        raise FileError(mark.where or path, problem, remedy)


def _line(mark: Label) -> str:
    """The line of the other mark."""
    _, _, line = mark.where.rpartition(":")
    return f" (the other in line {line})" if line.isdigit() else ""


def _after_last(times: Float[np.ndarray, "frames"]) -> float:
    """When the frame after the last would be taken [s]."""
    step = float(np.median(np.diff(times))) if len(times) > 1 else 0.0
    return float(times[-1]) + step
