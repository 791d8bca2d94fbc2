"""Agreement of two sequences of named segments, by the measures of temporal action segmentation.

Segmental F1 and the edit score follow Lea et al., *Temporal Convolutional Networks for Action
Segmentation and Detection* (CVPR 2017), as Abu Farha and Gall compute them (*MS-TCN*, CVPR 2019):
neighbours of one label count as one segment; each predicted segment, in order of time, is held
against the true segment of its label that it overlaps most; it is right if their intersection
over union reaches the threshold and no earlier one took that segment. Counts are pooled before
F1 is computed; edit scores are averaged over sequences. All scores are percentages.
"""

from collections import Counter
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from jaxtyping import Bool, Float

THRESHOLDS = (10, 25, 50)
"""Least intersection over union of a right segment [%]."""

MATCH_AT = THRESHOLDS[0]
"""The threshold at which segments count as matched for errors of onset and offset [%]."""

SAME_S = 1e-6
"""Times that differ by less are one [s]."""

NOTHING = "(nothing)"
"""The name of a time that no predicted segment covers."""


@dataclass(frozen=True, slots=True, order=True)
class Interval:
    """A named stretch of time, half-open: [start, end)."""

    start_s: float
    end_s: float
    label: str


@dataclass(frozen=True)
class Tally:
    """What is counted of one sequence, or of several together."""

    confusion: Counter[tuple[str, str]] = field(default_factory=Counter)
    """Frames by (true label, predicted label)."""

    hits: Counter[int] = field(default_factory=Counter)
    """Right segments by threshold [%]."""

    predicted: int = 0
    """Predicted segments."""

    true: int = 0
    """True segments."""

    edits: tuple[float, ...] = ()
    """Edit score of each sequence [%]."""

    onsets_s: tuple[float, ...] = ()
    """Predicted minus true start of each matched segment [s]."""

    offsets_s: tuple[float, ...] = ()
    """Predicted minus true end of each matched segment [s]."""

    missed: Counter[str] = field(default_factory=Counter)
    """True segments without a match, by label."""

    inserted: Counter[str] = field(default_factory=Counter)
    """Predicted segments without a match, by label."""

    def __add__(self, other: "Tally") -> "Tally":
        """Both together."""
        return pooled((self, other))

    def scores(self) -> dict[str, Any]:
        """The scores that follow from counts: percentages, and errors in milliseconds."""
        classes = frame_f1(self.confusion)
        macro = float(np.mean(list(classes.values()))) if classes else float("nan")
        return {
            "frames": self.confusion.total(),
            "segments": {"true": self.true, "predicted": self.predicted},
            "accuracy": rounded(accuracy(self.confusion)),
            "macro_f1": rounded(macro),
            "f1_by_class": {name: rounded(value) for name, value in classes.items()},
            **{f"f1@{each}": rounded(segment_f1(self, each)) for each in THRESHOLDS},
            "edit": rounded(float(np.mean(self.edits)) if self.edits else float("nan")),
            "onset_ms": errors_ms(self.onsets_s),
            "offset_ms": errors_ms(self.offsets_s),
            "missed": dict(sorted(self.missed.items())),
            "inserted": dict(sorted(self.inserted.items())),
            "confusion": [
                {"true": one, "predicted": other, "frames": frames}
                for (one, other), frames in sorted(
                    self.confusion.items(), key=lambda each: (-each[1], each[0])
                )
            ],
        }


def tally(
    true: Sequence[Interval], predicted: Sequence[Interval], times: Float[np.ndarray, "frames"]
) -> Tally:
    """Count one sequence against another.

    Args:
        true: The labels, not overlapping; frames that none covers are not counted.
        predicted: The segments to be judged, not overlapping.
        times: Time of each frame [s].
    """
    truth, guess = merged(true), merged(predicted)
    pairs = {each: matches(truth, guess, threshold=each / 100) for each in THRESHOLDS}
    matched = pairs[MATCH_AT]
    taken_true = {first for first, _ in matched}
    taken_guess = {second for _, second in matched}
    frames = zip(frame_labels(truth, times), frame_labels(guess, times), strict=True)
    return Tally(
        confusion=Counter((one, other or NOTHING) for one, other in frames if one),
        hits=Counter({each: len(found) for each, found in pairs.items()}),
        predicted=len(guess),
        true=len(truth),
        edits=(edit_score([e.label for e in truth], [e.label for e in guess]),),
        onsets_s=tuple(guess[g].start_s - truth[t].start_s for t, g in matched),
        offsets_s=tuple(guess[g].end_s - truth[t].end_s for t, g in matched),
        missed=Counter(e.label for i, e in enumerate(truth) if i not in taken_true),
        inserted=Counter(e.label for i, e in enumerate(guess) if i not in taken_guess),
    )


def pooled(tallies: Iterable[Tally]) -> Tally:
    """Several tallies as one."""
    every = list(tallies)
    return Tally(
        confusion=sum((each.confusion for each in every), Counter()),
        hits=sum((each.hits for each in every), Counter()),
        predicted=sum(each.predicted for each in every),
        true=sum(each.true for each in every),
        edits=tuple(score for each in every for score in each.edits),
        onsets_s=tuple(error for each in every for error in each.onsets_s),
        offsets_s=tuple(error for each in every for error in each.offsets_s),
        missed=sum((each.missed for each in every), Counter()),
        inserted=sum((each.inserted for each in every), Counter()),
    )


def merged(intervals: Iterable[Interval]) -> tuple[Interval, ...]:
    """Intervals in order of time, neighbours of one label as one, empty ones left out."""
    out: list[Interval] = []
    for interval in sorted(intervals):
        if interval.end_s <= interval.start_s:
            continue
        if out and out[-1].label == interval.label and interval.start_s <= out[-1].end_s:
            out[-1] = Interval(out[-1].start_s, max(out[-1].end_s, interval.end_s), interval.label)
        else:
            out.append(interval)
    return tuple(out)


def frame_labels(
    intervals: Sequence[Interval], times: Float[np.ndarray, "frames"]
) -> tuple[str, ...]:
    """The label at each time; empty where there is none. The last frame closes its interval."""
    names = np.full(len(times), "", dtype=object)
    for interval in intervals:
        names[within(interval, times)] = interval.label
    last = intervals[-1].end_s if intervals else float("nan")
    if len(times) and not names[-1] and abs(times[-1] - last) <= SAME_S:
        names[-1] = intervals[-1].label
    return tuple(names)


def within(interval: Interval, times: Float[np.ndarray, "frames"]) -> Bool[np.ndarray, "frames"]:
    """Whether each time is in an interval: [start, end), but for what rounding does to them."""
    return (times >= interval.start_s - SAME_S) & (times < interval.end_s - SAME_S)


def matches(
    true: Sequence[Interval], predicted: Sequence[Interval], *, threshold: float
) -> tuple[tuple[int, int], ...]:
    """Indices (true, predicted) of right segments.

    Args:
        true: The labels, in order.
        predicted: The segments to be judged, in order.
        threshold: Least intersection over union [1].
    """
    taken: dict[int, int] = {}
    for index, guess in enumerate(predicted):
        ratios = [(_overlap(each, guess), -place) for place, each in enumerate(true)]
        best, place = max(ratios, default=(0.0, 0))
        if best > 0.0 and best >= threshold and -place not in taken:
            taken[-place] = index
    return tuple(sorted(taken.items()))


def edit_score(true: Sequence[str], predicted: Sequence[str]) -> float:
    """One minus the Levenshtein distance over the longer length [%]; 100 if both are empty."""
    longest = max(len(true), len(predicted))
    if longest == 0:
        return 100.0
    row = list(range(len(predicted) + 1))
    for one in true:
        last, row[0] = row[0], row[0] + 1
        for column, other in enumerate(predicted, start=1):
            last, row[column] = (
                row[column],
                min(row[column] + 1, row[column - 1] + 1, last + (one != other)),
            )
    return 100.0 * (1.0 - row[-1] / longest)


def accuracy(confusion: Counter[tuple[str, str]]) -> float:
    """Frames with the right label [%]."""
    total = confusion.total()
    right = sum(count for (one, other), count in confusion.items() if one == other)
    return 100.0 * right / total if total else float("nan")


def frame_f1(confusion: Counter[tuple[str, str]]) -> dict[str, float]:
    """Frame-wise F1 of each class that is present, in the labels or the prediction [%]."""
    out = {}
    for label in sorted({each for pair in confusion for each in pair} - {NOTHING}):
        right = confusion[label, label]
        true = sum(count for (one, _), count in confusion.items() if one == label)
        guessed = sum(count for (_, other), count in confusion.items() if other == label)
        out[label] = 100.0 * 2 * right / (true + guessed)
    return out


def segment_f1(counts: Tally, threshold: int) -> float:
    """Segmental F1 at a threshold of ``THRESHOLDS`` [%]; NaN where there are no segments."""
    total = counts.true + counts.predicted
    return 100.0 * 2 * counts.hits[threshold] / total if total else float("nan")


def errors_ms(errors_s: Sequence[float]) -> dict[str, Any]:
    """Median and 95th percentile of the size of errors, and their median with its sign [ms].

    An infinite error is an edge that was not found; a median that is infinite is None.
    """
    if not errors_s:
        return {"matched": 0, "median": None, "p95": None, "bias": None}
    errors = 1000.0 * np.asarray(errors_s)
    order = np.percentile(np.abs(errors), [50, 95], method="linear" if np.isfinite(errors).all()
                          else "lower")  # fmt: skip
    known = errors[np.isfinite(errors)]
    return {
        "matched": len(known),
        "median": rounded(float(order[0])),
        "p95": rounded(float(order[1])),
        "bias": rounded(float(np.median(known)) if known.size else float("nan")),
    }


def rounded(value: float) -> float | None:
    """Two digits after the point; None where there is no number."""
    return round(value, 2) if np.isfinite(value) else None


def _overlap(one: Interval, other: Interval) -> float:
    """Intersection over union of two intervals of one label [1]; zero for two labels."""
    if one.label != other.label:
        return 0.0
    common = min(one.end_s, other.end_s) - max(one.start_s, other.start_s)
    whole = max(one.end_s, other.end_s) - min(one.start_s, other.start_s)
    return max(common, 0.0) / whole
