"""Carries as segments are printed, held against when an object was taken and let go."""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np
from jaxtyping import Float

from capar.evaluation.carry_captures import carry_captures
from capar.evaluation.comparisons import Channel
from capar.evaluation.evaluations import Evaluation, Scored, summed
from capar.evaluation.labels import Kind, Label, Labels, check_known, check_span
from capar.evaluation.metrics import SAME_S, Interval, errors_ms, rounded
from capar.evaluation.plan import Pair, Plan, Progress
from capar.evaluation.plan_schema import CarryOptions
from capar.evaluation.scoring import read_case_labels
from capar.model.capture import Capture, Stream
from capar.model.observation import Observation, Segment
from capar.pipelines.observation import observe
from capar_rules.engine.profiles import Profile
from extractors.readers.bundle.capture_toml import read_capture

CARRY = "carry"


@dataclass(frozen=True, slots=True)
class CarryEnds:
    """One labelled carry, and how far the printed ends are from its own."""

    start_error_s: float
    """Printed start minus labelled start [s]; infinite where no carry was found."""

    end_error_s: float
    moved: bool
    """Whether the object moved by more than ``moves_m`` in it; else it is excluded."""

    moves_at_ends: bool
    """Whether its motion begins and ends within ``within_s`` of the labels."""


@dataclass(frozen=True)
class CarryCounts:
    """Labelled carries, and how many were found beside them."""

    within_s: float
    carries: tuple[CarryEnds, ...] = ()
    extra: int = 0
    """Printed carries of labelled objects that overlap no labelled one."""

    def __add__(self, other: "CarryCounts") -> "CarryCounts":
        """Both together."""
        return replace(self, carries=self.carries + other.carries, extra=self.extra + other.extra)

    def scores(self) -> dict[str, Any]:
        """Shares of carries whose printed start, end and both are near [%], and errors [ms]."""
        counted = [carry for carry in self.carries if carry.moved]
        sharp = [carry for carry in counted if carry.moves_at_ends]
        return {
            "carries": len(self.carries),
            "excluded": len(self.carries) - len(counted),
            "counted": len(counted),
            "within_s": self.within_s,
            **self._shares(counted),
            "start_ms": errors_ms([carry.start_error_s for carry in counted]),
            "end_ms": errors_ms([carry.end_error_s for carry in counted]),
            "extra": self.extra,
            "moving_at_both_ends": {"carries": len(sharp), **self._shares(sharp)},
        }

    def _shares(self, carries: Sequence[CarryEnds]) -> dict[str, Any]:
        errors_s = [(carry.start_error_s, carry.end_error_s) for carry in carries]
        near = np.abs(np.array(errors_s).reshape(-1, 2)) <= self.within_s + SAME_S
        shares = (near[:, 0], near[:, 1], near.all(axis=1))
        names = ("start", "end", "both")
        return {
            name: rounded(100.0 * float(np.mean(share))) if len(near) else None
            for name, share in zip(names, shares, strict=True)
        }


def score_carries(plan: Plan, base: Profile, progress: Progress) -> Evaluation:
    """Observe captures and compare printed carries with labelled ones.

    A printed carry of an object is a run of segments, one after the other, of which the object is
    the dominant one: from the first in which it is carried to the last.

    Raises:
        CaparError: A capture or a label file has a fault.
    """
    one = _recorded if plan.carries.presence_of else _labelled
    return Evaluation(
        Kind.CARRIES, tuple(one(pair, plan, base) for pair in progress(plan.pairs)), plan.groups
    )


def compare_carries(
    name: str, labels: Labels, observation: Observation, capture: Capture, options: CarryOptions
) -> Scored:
    """The carries of a capture beside their labels, which are in seconds."""
    parts, channels = {}, []
    for thing in dict.fromkeys(mark.object for mark in labels.marks):
        marks = [mark for mark in labels.marks if mark.object == thing and mark.sure]
        segments = _segments_of(observation, thing)
        found = printed_carries(segments, options.names)
        stream = capture.tag_object(thing).stream
        parts[thing] = _counts(marks, found, stream, options)
        true = tuple(Interval(mark.start, mark.end, CARRY) for mark in marks)
        channels.append(Channel(thing, true, found, silent=True, segments=segments))
    return Scored(
        name=name,
        times=capture.times,
        channels=tuple(channels),
        parts=parts,
        whole=summed(parts.values()),
        notices=labels.notices,
    )


def printed_carries(segments: Iterable[Segment], names: Sequence[str]) -> tuple[Interval, ...]:
    """Runs of segments of one object, from the first to the last in which it is carried.

    Args:
        segments: Those of which the object is the dominant one, in order of time.
        names: What they are called, or specialise, where they carry it.
    """
    runs: list[list[Segment]] = []
    for segment in segments:
        if not runs or (runs[-1][-1].ee, runs[-1][-1].index + 1) != (segment.ee, segment.index):
            runs.append([])
        runs[-1].append(segment)
    out = []
    for run in runs:
        carrying = [step for step in run if {step.name, *step.general} & set(names)]
        if carrying:
            out.append(Interval(carrying[0].start_s, carrying[-1].end_s, CARRY))
    return tuple(sorted(out))


def _labelled(pair: Pair, plan: Plan, base: Profile) -> Scored:
    labels = read_case_labels(pair, plan)
    capture = read_capture(pair.capture)
    check_known(labels, "object", [each.name for each in capture.objects], at="object")
    check_span(labels, capture.times)
    observation = observe(capture, rules=base)
    return compare_carries(pair.name, labels, observation, capture, plan.carries)


def _recorded(pair: Pair, plan: Plan, base: Profile) -> Scored:
    """Carries that the presence of objects in a recording tells, each in a capture of its own."""
    parts: dict[str, CarryCounts] = {}
    channels: list[Channel] = []
    last_s = 0.0
    for carry in carry_captures(pair.capture, plan.carries):
        mark = Label("", carry.start_s, carry.end_s, CARRY, carry.object)
        observation = observe(carry.capture, rules=base)
        labels = Labels(Path(pair.capture), (mark,), in_frames=False)
        scored = compare_carries(pair.name, labels, observation, carry.capture, plan.carries)
        parts |= scored.parts
        channels += scored.channels
        last_s = max(last_s, float(carry.capture.times[-1]))
    clock = np.arange(0.0, last_s + 0.02, 0.02)
    return Scored(pair.name, clock, tuple(channels), parts, summed(parts.values()))


def _segments_of(observation: Observation, thing: str) -> tuple[Segment, ...]:
    """The segments that are about an object, link by link in order of time."""
    return tuple(each for each in observation.segments if each.objects[:1] == (thing,))


def _counts(
    marks: Sequence[Label], found: Sequence[Interval], stream: Stream, options: CarryOptions
) -> CarryCounts:
    carries = []
    taken: set[Interval] = set()
    for mark in marks:
        own = [each for each in found if _nearest_mark(each, marks) == mark]
        taken |= set(own)
        start = min((each.start_s for each in own), default=float("inf"))
        end = max((each.end_s for each in own), default=float("inf"))
        carries.append(_ends(mark, start, end, stream, options))
    return CarryCounts(options.within_s, tuple(carries), extra=len(set(found) - taken))


def _nearest_mark(found: Interval, marks: Sequence[Label]) -> Label | None:
    """The labelled carry that it overlaps most."""

    def shared(mark: Label) -> float:
        return min(found.end_s, mark.end) - max(found.start_s, mark.start)

    best = max(marks, key=shared, default=None)
    return best if best is not None and shared(best) > 0.0 else None


def _ends(
    mark: Label, start_s: float, end_s: float, stream: Stream, options: CarryOptions
) -> CarryEnds:
    begins, ends = _motion(mark, stream, options.moves_m)
    late = max(begins - mark.start, mark.end - ends)
    return CarryEnds(
        start_error_s=start_s - mark.start,
        end_error_s=end_s - mark.end,
        moved=bool(np.isfinite(begins)),
        moves_at_ends=bool(late <= options.within_s),
    )


def _motion(mark: Label, stream: Stream, moves_m: float) -> tuple[float, float]:
    """When the object leaves its first place in the carry, and reaches its last one [s].

    Infinite where it never leaves it.
    """
    inside = (stream.times >= mark.start) & (stream.times <= mark.end) & ~stream.lost
    times, places = stream.times[inside], stream.positions[inside]
    if not len(times):
        return float("inf"), float("-inf")
    gone = _away(places, places[0]) > moves_m
    back = _away(places, places[-1]) > moves_m
    if not gone.any():
        return float("inf"), float("-inf")
    return float(times[gone][0]), float(times[back][-1])


def _away(
    places: Float[np.ndarray, "frames 3"], place: Float[np.ndarray, "3"]
) -> Float[np.ndarray, "frames"]:
    return np.asarray(np.linalg.norm(places - place, axis=1))
