"""Contacts that were observed, compared with labels of when two bodies touch."""

import zipfile
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from jaxtyping import Bool, Float

from capar.evaluation.labels import Kind, Label, Labels, check_known, check_span
from capar.evaluation.metrics import (
    Channel,
    Evaluation,
    Interval,
    Scored,
    errors_ms,
    inside,
    rounded,
    summed,
)
from capar.evaluation.plan import ContactArrays, Pair, Plan, Progress
from capar.evaluation.scoring import read_case_labels
from capar.model.capture import Capture
from capar.model.errors import FileError, UnknownNameError
from capar.model.facts import Fact, Touching
from capar.model.geometry import runs
from capar.pipelines.observation import facts_program
from capar_rules.engine.profiles import Profile
from extractors.readers.bundle.capture_toml import frame_times, read_capture
from extractors.readers.files import check_zip
from extractors.readers.names import constant_name
from extractors.readers.schema.entry import substituted


def read_contact_arrays(
    path: Path,
    entry: ContactArrays,
    words: Mapping[str, str],
    times: Float[np.ndarray, "frames"],
) -> tuple[Labels, tuple[tuple[str, str], ...]]:
    """Labels of contact from an NPZ file, and every pair of bodies that they are about.

    Bodies bear the names that ``[[sensors_from]]`` gives them: ``L_Hip`` is ``l_hip``.

    Args:
        path: The NPZ file.
        entry: Which arrays, and what their values mean.
        words: The take's words.
        times: Time of each frame of the recording [s].

    Raises:
        FileError: It is no NPZ file, or the array has not a value for each frame and body.
        UnknownNameError: It has no such array.
    """
    values, names = _arrays(path, entry)
    if values.shape != (len(times), len(names)):
        raise FileError(
            path,
            f"array {entry.labels!r} has the shape {values.shape}.",
            f"For {len(times)} frames and {len(names)} bodies it has "
            f"the shape {(len(times), len(names))}.",
        )
    other = str(substituted(entry.other, words))
    step = float(np.median(np.diff(times)))
    after = np.append(times[1:], times[-1] + step)
    marks = []
    for column, name in enumerate(names):
        for value, sure in ((entry.touching, True), (entry.open, False)):
            for first, last in runs(values[:, column] == value) if value is not None else ():
                marks.append(
                    Label(
                        name, float(times[first]), float(after[last]), "contact", other, sure=sure,
                        where=f"{path}: {entry.labels}[{first}:{last + 1}, {column}]",
                    )
                )  # fmt: skip
    labels = Labels(path, tuple(sorted(marks)), in_frames=False)
    return labels, tuple((name, other) for name in names)


def _arrays(path: Path, entry: ContactArrays) -> tuple[np.ndarray, list[str]]:
    check_zip(path)
    try:
        with np.load(path, allow_pickle=False) as content:
            for name in (entry.labels, entry.bodies):
                if name not in content:
                    raise UnknownNameError("array", name, content, where=str(path))
            return content[entry.labels], [constant_name(str(each)) for each in
                                           content[entry.bodies]]  # fmt: skip
    except (OSError, ValueError, zipfile.BadZipFile) as error:
        raise FileError(path, f"is no NPZ file: {error}.") from None


CONTACT = "contact"

Frames = Bool[np.ndarray, "frames"]


@dataclass(frozen=True)
class ContactCounts:
    """Frames of contact, and how far the ends of contacts are apart."""

    right: int = 0
    """Frames in which a contact is labelled and found."""

    wrong: int = 0
    """Frames in which one is found and not labelled."""

    missed: int = 0
    """Frames in which one is labelled and not found."""

    apart: int = 0
    """Frames in which neither is."""

    onsets_s: tuple[float, ...] = ()
    """From each labelled onset to the nearest found one [s]; infinite where there is none."""

    offsets_s: tuple[float, ...] = ()

    def __add__(self, other: "ContactCounts") -> "ContactCounts":
        """Both together."""
        return ContactCounts(
            self.right + other.right,
            self.wrong + other.wrong,
            self.missed + other.missed,
            self.apart + other.apart,
            self.onsets_s + other.onsets_s,
            self.offsets_s + other.offsets_s,
        )

    def scores(self) -> dict[str, Any]:
        """Frame-wise precision, recall and F1 [%], and errors of onset and offset [ms]."""
        return {
            "frames": self.right + self.wrong + self.missed + self.apart,
            "contact_frames": self.right + self.missed,
            "precision": _percent(self.right, self.right + self.wrong),
            "recall": _percent(self.right, self.right + self.missed),
            "f1": _percent(2 * self.right, 2 * self.right + self.wrong + self.missed),
            "onset_ms": errors_ms(self.onsets_s),
            "offset_ms": errors_ms(self.offsets_s),
        }


def score_contacts(plan: Plan, base: Profile, progress: Progress) -> Evaluation:
    """Measure captures and compare their contacts with labels, frame by frame.

    Contacts are those that ``capar facts`` prints: what rules read and an Actionary keeps. Each
    body is scored on its own; the whole is whether *any* labelled body touches the object.

    Raises:
        CaparError: A capture or a label file has a fault.
    """
    return Evaluation(
        Kind.CONTACTS,
        tuple(_scored(pair, plan, base) for pair in progress(plan.pairs)),
        plan.groups,
    )


def compare_contacts(
    name: str, labels: Labels, facts: Iterable[Fact], times: Float[np.ndarray, "frames"],
    pairs: Sequence[tuple[str, str]] = (),
) -> Scored:  # fmt: skip
    """The contacts of a capture beside their labels.

    Args:
        name: The capture.
        labels: Marks in seconds, by our names of bodies.
        facts: What was measured.
        times: Time of each frame [s].
        pairs: Pairs that are labelled although no mark is about them: they never touch.
    """
    touching = [each for each in facts if isinstance(each, Touching)]
    labelled = dict.fromkeys([*((each.link, each.object) for each in labels.marks), *pairs])
    channels = [_channel(pair, labels, touching, times) for pair in labelled]
    masks = [_masks(each, times) for each in channels]
    parts: dict[str, ContactCounts] = {}
    for (body, _), (true, found, counted) in zip(labelled, masks, strict=True):
        counts = _counts(true & counted, found & counted, counted, times)
        parts[body] = parts[body] + counts if body in parts else counts
    wholes = []
    for thing in dict.fromkeys(other for _, other in labelled):
        own = [mask for (_, other), mask in zip(labelled, masks, strict=True) if other == thing]
        true, found, counted = _any(own)
        wholes.append(_counts(true, found, counted, times))
        channels.append(_together(thing, true, found, counted, times))
    return Scored(
        name=name,
        times=times,
        channels=tuple(channels[-len(wholes) :] if pairs else channels),
        parts=parts,
        whole=summed(wholes),
        notices=labels.notices,
    )


def _scored(pair: Pair, plan: Plan, base: Profile) -> Scored:
    capture = read_capture(pair.capture)
    pairs: tuple[tuple[str, str], ...] = ()
    if plan.contacts is None:
        labels = read_case_labels(pair, plan)
    else:
        assert pair.labels is not None, "a plan without label files has other kinds"
        times = frame_times(pair.capture, file=plan.frames_of)
        labels, pairs = read_contact_arrays(pair.labels, plan.contacts, pair.words, times)
        labels = labels.renamed(dict(plan.names))
        pairs = tuple((plan.names.get(body, body), other) for body, other in pairs)
    _check_bodies(labels, capture)
    check_span(labels, capture.times)
    measurements, _ = facts_program(capture, rules=base)
    return compare_contacts(pair.name, labels, measurements.facts, capture.times, pairs)


def _check_bodies(labels: Labels, capture: Capture) -> None:
    check_known(labels, "body", capture.bodies, at="link")
    check_known(labels, "body", capture.bodies, at="object")


def _channel(
    pair: tuple[str, str], labels: Labels, touching: Sequence[Touching],
    times: Float[np.ndarray, "frames"],
) -> Channel:  # fmt: skip
    own = [each for each in labels.marks if (each.link, each.object) == pair]
    found = [each for each in touching if {each.body, each.other} == set(pair)]
    after = np.append(times[1:], np.inf)
    return Channel(
        name=" and ".join(pair),
        true=tuple(Interval(each.start, each.end, CONTACT) for each in own if each.sure),
        found=tuple(
            Interval(float(times[each.first]), float(after[each.last]), CONTACT) for each in found
        ),
        silent=True,
        open=tuple(Interval(each.start, each.end, CONTACT) for each in own if not each.sure),
    )


def _masks(channel: Channel, times: Float[np.ndarray, "frames"]) -> tuple[Frames, Frames, Frames]:
    """Whether each frame is labelled, found, and counted."""
    return (
        inside(channel.true, times),
        inside(channel.found, times),
        ~inside(channel.open, times),
    )


def _any(masks: Sequence[tuple[Frames, Frames, Frames]]) -> tuple[Frames, Frames, Frames]:
    """Whether any body is labelled or found to touch, and any counts."""
    counted = np.logical_or.reduce([each for _, _, each in masks])
    true = np.logical_or.reduce([one & each for one, _, each in masks])
    found = np.logical_or.reduce([other & each for _, other, each in masks])
    return true, found, counted


def _together(
    thing: str, true: Frames, found: Frames, counted: Frames, times: Float[np.ndarray, "frames"]
) -> Channel:
    def intervals(mask: Frames) -> tuple[Interval, ...]:
        after = np.append(times[1:], np.inf)
        return tuple(
            Interval(float(times[first]), float(after[last]), CONTACT) for first, last in runs(mask)
        )

    return Channel(
        f"any body and {thing}", intervals(true), intervals(found), silent=True,
        open=intervals(~counted),
    )  # fmt: skip


def _counts(
    true: Frames, found: Frames, counted: Frames, times: Float[np.ndarray, "frames"]
) -> ContactCounts:
    return ContactCounts(
        right=int((true & found).sum()),
        wrong=int((found & ~true & counted).sum()),
        missed=int((true & ~found).sum()),
        apart=int((~true & ~found & counted).sum()),
        onsets_s=_nearest(_edges(true, 1, times), _edges(found, 1, times)),
        offsets_s=_nearest(_edges(true, -1, times), _edges(found, -1, times)),
    )


def _edges(mask: Frames, step: int, times: Float[np.ndarray, "frames"]) -> list[float]:
    """Times at which contact begins (1) or ends (-1) inside the capture [s]."""
    return [float(times[each + 1]) for each in np.flatnonzero(np.diff(mask.astype(int)) == step)]


def _nearest(wanted: Sequence[float], found: Sequence[float]) -> tuple[float, ...]:
    """From each wanted time to the nearest found one, the earlier of two, with its sign [s]."""

    def rank(off_s: float) -> tuple[float, float]:
        return round(abs(off_s), 6), off_s

    return tuple(
        min((each - want for each in found), key=rank, default=float("inf")) for want in wanted
    )


def _percent(part: int, whole: int) -> float | None:
    return rounded(100.0 * part / whole) if whole else None
