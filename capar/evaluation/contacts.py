"""Contacts that were observed, compared with labels of when two bodies touch."""

import zipfile
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from jaxtyping import Bool, Float

from capar.evaluation.labels import Label, Labels, check_known, check_span
from capar.evaluation.metrics import (
    Channel,
    Counts,
    Interval,
    Scored,
    errors_ms,
    inside,
    percent,
    summed,
)
from capar.evaluation.plan import ContactArrays, Pair, Plan
from capar.model.errors import FileError, UnknownNameError
from capar.model.facts import Fact, Touching
from capar.model.geometry import runs
from capar.pipelines.observation import facts_program
from capar_rules.engine.profiles import Profile
from extractors.readers.bundle.capture_toml import frame_times, read_capture
from extractors.readers.file_access import check_zip
from extractors.readers.names import constant_name
from extractors.readers.schema.entry import substituted

CONTACT = "contact"

Frames = Bool[np.ndarray, "frames"]


@dataclass(frozen=True)
class ContactCounts(Counts):
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

    def scores(self) -> dict[str, Any]:
        """Frame-wise precision, recall and F1 [%], and errors of onset and offset [ms]."""
        return {
            "frames": self.right + self.wrong + self.missed + self.apart,
            "contact_frames": self.right + self.missed,
            "precision": percent(self.right, self.right + self.wrong),
            "recall": percent(self.right, self.right + self.missed),
            "f1": percent(2 * self.right, 2 * self.right + self.wrong + self.missed),
            "onset_ms": errors_ms(self.onsets_s),
            "offset_ms": errors_ms(self.offsets_s),
        }


def score_contacts(pair: Pair, plan: Plan, base: Profile) -> Scored:
    """Measure a capture and compare its contacts with labels, frame by frame.

    Contacts are those that ``capar facts`` prints: what rules read and an Actionary keeps. Each
    body is scored on its own; the whole is whether *any* labelled body touches the object.
    """
    capture = read_capture(pair.capture)
    pairs: tuple[tuple[str, str], ...] = ()
    if plan.contacts is None:
        labels = plan.labels_of(pair)
    else:
        assert pair.labels is not None, "a plan without label files has other kinds"
        times = frame_times(pair.capture, file=plan.frames_of)
        labels, pairs = read_contact_arrays(pair.labels, plan.contacts, pair.words, times)
        labels = labels.renamed(dict(plan.names))
        pairs = tuple((plan.names.get(body, body), other) for body, other in pairs)
    for field in ("link", "object"):
        check_known(labels, "body", capture.bodies, at=field)
    check_span(labels, capture.times)
    measurements, _ = facts_program(capture, rules=base)
    return compare_contacts(pair.name, labels, measurements.facts, capture.times, pairs)


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
    after = np.append(times[1:], np.inf)

    def intervals(spans: Iterable[tuple[int, int]]) -> tuple[Interval, ...]:
        return tuple(Interval(float(times[a]), float(after[b]), CONTACT) for a, b in spans)

    channels, masks = [], {}
    parts: dict[str, ContactCounts] = {}
    for pair in labelled:
        own = [each for each in labels.marks if (each.link, each.object) == pair]
        true, open_ = (
            tuple(Interval(each.start, each.end, CONTACT) for each in own if each.sure is sure)
            for sure in (True, False)
        )
        found = intervals(
            (each.first, each.last) for each in touching if {each.body, each.other} == set(pair)
        )
        channels.append(Channel(" and ".join(pair), true, found, silent=True, open=open_))
        counts = ~inside(open_, times)
        masks[pair] = inside(true, times) & counts, inside(found, times) & counts, counts
        seen = _counts(*masks[pair], times)
        parts[pair[0]] = parts[pair[0]] + seen if pair[0] in parts else seen
    wholes = []
    for thing in dict.fromkeys(other for _, other in labelled):
        own_masks = zip(
            *(mask for (_, other), mask in masks.items() if other == thing), strict=True
        )
        any_true, any_found, any_counted = (np.logical_or.reduce(rows) for rows in own_masks)
        wholes.append(_counts(any_true, any_found, any_counted, times))
        channels.append(
            Channel(
                f"any body and {thing}", intervals(runs(any_true)), intervals(runs(any_found)),
                silent=True, open=intervals(runs(~any_counted)),
            )
        )  # fmt: skip
    shown = channels[-len(wholes) :] if pairs else channels
    return Scored(name, times, tuple(shown), parts, summed(wholes), notices=labels.notices)


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


def read_contact_arrays(
    path: Path,
    entry: ContactArrays,
    words: Mapping[str, str],
    times: Float[np.ndarray, "frames"],
) -> tuple[Labels, tuple[tuple[str, str], ...]]:
    """Labels of contact from an NPZ file, and every pair of bodies that they are about.

    Bodies bear the names that ``[[sensors_from]]`` gives them: ``L_Hip`` is ``l_hip``.

    Args:
        path: The NPZ file, with a value for each frame and body.
        entry: Which arrays, and what their values mean.
        words: The take's words.
        times: Time of each frame of the recording [s].

    Raises:
        FileError: It is no NPZ file, or the array has not a value for each frame and body.
        UnknownNameError: It has no such array.
    """
    check_zip(path)
    try:
        with np.load(path, allow_pickle=False) as content:
            for name in (entry.labels, entry.bodies):
                if name not in content:
                    raise UnknownNameError("array", name, content, where=str(path))
            values = content[entry.labels]
            names = [constant_name(str(each)) for each in content[entry.bodies]]
    except (OSError, ValueError, zipfile.BadZipFile) as error:
        raise FileError(path, f"is no NPZ file: {error}.") from None
    if values.shape != (len(times), len(names)):
        raise FileError(
            path,
            f"array {entry.labels!r} has the shape {values.shape}.",
            f"For {len(times)} frames and {len(names)} bodies it has "
            f"the shape {(len(times), len(names))}.",
        )
    other = str(substituted(entry.other, words))
    after = np.append(times[1:], times[-1] + float(np.median(np.diff(times))))
    marks = [
        Label(
            name, float(times[first]), float(after[last]), CONTACT, other, sure=sure,
            where=f"{path}: {entry.labels}[{first}:{last + 1}, {column}]",
        )
        for column, name in enumerate(names)
        for value, sure in ((entry.touching, True), (entry.open, False))
        if value is not None
        for first, last in runs(values[:, column] == value)
    ]  # fmt: skip
    labels = Labels(path, tuple(sorted(marks)), in_frames=False)
    return labels, tuple((name, other) for name in names)
