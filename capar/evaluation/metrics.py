"""Agreement of two sequences of named segments, by the measures of temporal action segmentation.

Segmental F1 and the edit score follow Lea et al., *Temporal Convolutional Networks for Action
Segmentation and Detection* (CVPR 2017), as Abu Farha and Gall compute them (*MS-TCN*, CVPR 2019):
neighbours of one label count as one segment; each predicted segment, in order of time, is held
against the true segment of its label that it overlaps most; it is right if their intersection
over union reaches the threshold and no earlier one took that segment. Counts are pooled before
F1 is computed; edit scores are averaged over sequences. All scores are percentages.
"""

from collections import Counter
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import asdict, dataclass, field, fields
from functools import reduce
from operator import add
from typing import Any, Self

import numpy as np
from jaxtyping import Bool, Float

from capar.evaluation import Kind
from capar.model.geometry import runs
from capar.model.observation import Segment

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
    """A named interval of time, half-open: [start, end)."""

    start_s: float
    end_s: float
    label: str


@dataclass(frozen=True)
class Counts:
    """What is counted of one part of a capture; counts of several add up before they are scored."""

    def __add__(self, other: Self) -> Self:
        """Both together, field by field."""
        pairs = ((getattr(self, f.name), getattr(other, f.name)) for f in fields(self))
        return type(self)(*(one + two for one, two in pairs))

    def scores(self) -> dict[str, Any]:
        """The scores that follow, as plain values."""
        raise NotImplementedError


@dataclass(frozen=True)
class Tally(Counts):
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


def percent(part: int, whole: int) -> float | None:
    """A share [%]; None of nothing."""
    return rounded(100.0 * part / whole) if whole else None


@dataclass(frozen=True)
class Channel:
    """What one link does, one pair of bodies, or one object's carries: at most one at a time."""

    name: str
    true: tuple[Interval, ...]
    found: tuple[Interval, ...]
    silent: bool = False
    """Whether a time without a label says that there was nothing; else it is not counted."""

    open: tuple[Interval, ...] = ()
    """When it is not counted, whatever was found."""

    segments: tuple[Segment, ...] = ()
    """The segments that it was found in, as they are printed."""


@dataclass(frozen=True, slots=True)
class Difference:
    """An interval in which something else was found than is labelled."""

    capture: str
    channel: str
    start_s: float
    end_s: float
    true: str
    found: str
    segments: str
    """The segments there, as they are printed: number and name."""


def differences(
    capture: str, channels: Iterable[Channel], times: Float[np.ndarray, "frames"]
) -> tuple[Difference, ...]:
    """Every interval of a capture in which a channel differs from its labels, in order of time."""
    out: list[Difference] = []
    for channel in channels:
        true, found = (
            np.array([each or NOTHING for each in frame_labels(marks, times)], dtype=object)
            for marks in (channel.true, channel.found)
        )
        counted = channel.silent | (true != NOTHING)
        wrong = (true != found) & counted & ~inside(channel.open, times)
        for one, other in sorted(set(zip(true[wrong], found[wrong], strict=True))):
            for first, last in runs(wrong & (true == one) & (found == other)):
                start_s, end_s = float(times[first]), float(times[min(last + 1, len(times) - 1)])
                there = ", ".join(
                    f"{each.index} {each.name}"
                    for each in channel.segments
                    if each.start_s < end_s - SAME_S and each.end_s > start_s + SAME_S
                )
                out.append(Difference(capture, channel.name, start_s, end_s, one, other, there))
    return tuple(sorted(out, key=lambda each: (each.start_s, each.channel)))


def inside(
    intervals: Sequence[Interval], times: Float[np.ndarray, "frames"]
) -> Bool[np.ndarray, "frames"]:
    """Whether each frame lies in one of the intervals: [start, end)."""
    out = np.zeros(len(times), dtype=bool)
    for interval in intervals:
        out |= within(interval, times)
    return out


PARTS = {
    Kind.ACTIONS: "links",
    Kind.CONTACTS: "bodies",
    Kind.CARRIES: "objects",
    Kind.EVENTS: "events",
    Kind.CONTAINERS: "containers",
}
"""What is scored on its own beside the whole."""

WORST = 20
"""So many differences are listed."""


@dataclass(frozen=True)
class Scored:
    """One capture compared with its labels."""

    name: str
    times: Float[np.ndarray, "frames"]
    """Time of each frame [s]."""

    channels: tuple[Channel, ...]
    parts: Mapping[str, Any]
    """Counts of each part."""

    whole: Any
    """Counts of the capture."""

    unlabelled: tuple[str, ...] = ()
    """Parts that were observed and have no labels."""

    notices: tuple[str, ...] = ()


@dataclass(frozen=True)
class Evaluation:
    """Captures compared with their labels."""

    kind: Kind
    captures: tuple[Scored, ...]
    groups: Mapping[str, tuple[str, ...]] = field(default_factory=dict)
    """Names of captures that are also scored on their own."""

    notices: tuple[str, ...] = ()
    """What is odd about labels and mapping."""

    @property
    def parts(self) -> dict[str, Any]:
        """Counts of each part, pooled over captures."""
        return _parts(self.captures)

    @property
    def unlabelled(self) -> tuple[str, ...]:
        """Parts that were observed and bear no labels in any of the files: not counted."""
        found = {name for each in self.captures for name in each.unlabelled}
        return tuple(sorted(found - set(self.parts)))


def report(evaluation: Evaluation) -> dict[str, Any]:
    """An evaluation as plain values, for JSON."""
    part, captures = PARTS[evaluation.kind], evaluation.captures
    wrong = [one for each in captures for one in differences(each.name, each.channels, each.times)]
    wrong.sort(key=lambda one: (one.start_s - one.end_s, one.capture, one.channel, one.start_s))
    groups = {
        name: [each for each in captures if each.name in members]
        for name, members in evaluation.groups.items()
    }
    return {
        "kind": str(evaluation.kind),
        "captures": [each.name for each in captures],
        "matched_at_percent": MATCH_AT,
        **_scores(part, captures),
        "groups": {
            name: {"captures": list(evaluation.groups[name]), **_scores(part, own)}
            for name, own in groups.items()
        },
        "by_capture": {each.name: _scores(part, [each]) for each in captures},
        "worst": [
            {**asdict(one), "start_s": round(one.start_s, 3), "end_s": round(one.end_s, 3)}
            for one in wrong[:WORST]
        ],
        f"unlabelled_{part}": list(evaluation.unlabelled),
        "notices": [*evaluation.notices, *(n for c in captures for n in c.notices)],
    }


def summed(counts: Iterable[Any]) -> Any:
    """Counts of several together."""
    return reduce(add, counts)


def _scores(part: str, captures: Sequence[Scored]) -> dict[str, Any]:
    return {
        part: {name: counts.scores() for name, counts in _parts(captures).items()},
        "all": summed(each.whole for each in captures).scores(),
    }


def _parts(captures: Sequence[Scored]) -> dict[str, Any]:
    names = sorted({name for each in captures for name in each.parts})
    return {
        name: summed(each.parts[name] for each in captures if name in each.parts) for name in names
    }
