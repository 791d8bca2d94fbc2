"""Events that were found, compared with the times at which somebody saw them happen."""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import Any

import numpy as np
from jaxtyping import Float

from capar.evaluation.labels import Kind, Label, Labels, check_known, check_span
from capar.evaluation.metrics import (
    Channel,
    Evaluation,
    Interval,
    Scored,
    errors_ms,
    rounded,
    summed,
)
from capar.evaluation.plan import Pair, Plan, Progress
from capar.evaluation.scoring import known_names, read_case_labels
from capar.model.capture import Capture
from capar.model.facts import Fact, Lies, Moving, Touching
from capar.model.observation import Observation
from capar.pipelines.observation import facts_program, observe_measured
from capar_rules.borders.ticks import Tick
from capar_rules.engine.profiles import Profile
from capar_rules.engine.solver import rule_file, solve
from extractors.measure import SHIFTS, Measurements
from extractors.readers.bundle.capture_toml import read_capture

PASS, OVER_TABLE, REGRASP = "pass", "over_table", "regrasp"
KINDS = (PASS, OVER_TABLE, REGRASP)

Times = Float[np.ndarray, "frames"]


@dataclass(frozen=True, slots=True, order=True)
class Change:
    """A change of the hands on an object."""

    start_s: float
    end_s: float
    kind: str
    ee: str
    object: str = ""
    other: str = ""


def changes(
    observation: Observation,
    capture: Capture,
    measurements: Measurements,
    borders: Sequence[Fact],
    base: Profile,
) -> tuple[Change, ...]:
    """Every pass, change of hands over a support, and regrasp in a capture, in order of time.

    Passes are segments named Give, changes over a support follow from stored contacts, and
    regrasps are those that ``capar facts --derive`` prints.

    Args:
        observation: What was observed.
        capture: For its clock.
        measurements: What was measured, with its flicker resolved.
        borders: Numbered borders, as ``facts_program`` returns them.
        base: The rules.
    """
    answer = solve((*base.files, rule_file("explain/derived.lp")), (*measurements.facts, *borders))
    frames = {(each.ee, each.tick): each.frame for each in borders if isinstance(each, Tick)}
    told = set()
    for segment, thing in answer.of("regrasps"):
        assert isinstance(segment, tuple)
        told.add((str(segment[1]), frames[str(segment[1]), int(str(segment[2]))], str(thing)))
    times = capture.times
    found = (
        *_passes(observation, times),
        *_over(observation, times),
        *_regrasps(observation, times, told),
    )
    return tuple(sorted(found))


def _passes(observation: Observation, times: Times) -> Iterable[Change]:
    """Each segment named Give, from when the other hand touched the object."""
    touches = _touches(observation)
    for segment in observation.segments:
        if "Give" not in (segment.name, *segment.general):
            continue
        for touch in touches:
            taken = touch.other in segment.objects and touch.body != segment.ee
            if taken and touch.first <= segment.first <= touch.last:
                start = times[touch.first]
                yield Change(
                    float(start), segment.start_s, PASS, segment.ee, touch.other, touch.body
                )


def _over(observation: Observation, times: Times) -> Iterable[Change]:
    """Each time that one hand lets go of what stands, and another is the next to touch it."""
    moves = [each for each in observation.facts if isinstance(each, Moving)]
    touches = _touches(observation)
    for thing in sorted({each.other for each in touches}):
        own = [each for each in touches if each.other == thing]
        for one, two in pairwise(own):
            between = [
                each
                for each in moves
                if each.object == thing and each.first < two.first and each.last > one.last
            ]
            if one.body != two.body and one.last < two.first and not between:
                start, end = times[one.last], times[two.first]
                yield Change(float(start), float(end), OVER_TABLE, one.body, thing, two.body)


def _regrasps(
    observation: Observation, times: Times, told: set[tuple[str, int, str]]
) -> Iterable[Change]:
    """What the rules tell, at the time of the shift that begins in the segment, if one does."""
    shifts = [each for each in observation.facts if isinstance(each, Lies) and each.how == SHIFTS]
    for segment in observation.segments:
        for thing in segment.objects:
            if (segment.ee, segment.first, thing) not in told:
                continue
            inside = [
                (float(times[each.first]), float(times[each.last]))
                for each in shifts
                if (each.body, each.other) == (segment.ee, thing)
                and segment.first <= each.first < segment.last
            ]
            for start, end in inside or [(segment.start_s, segment.end_s)]:
                yield Change(start, end, REGRASP, segment.ee, thing)


def _touches(observation: Observation) -> list[Touching]:
    """Contacts of end-effectors, in order of time."""
    hands = {each.ee for each in observation.links}
    found = [
        each for each in observation.facts if isinstance(each, Touching) and each.body in hands
    ]
    return sorted(found, key=lambda each: (each.first, each.body))


SLACK_S = 0.3
"""What somebody sees in pictures or a film may be so much earlier or later [s]."""


@dataclass(frozen=True, slots=True, order=True)
class Event:
    """Something that a hand did."""

    start_s: float
    end_s: float
    event: str
    """A segment's name, or a change of the hands on an object (``grasps.KINDS``)."""

    hand: str
    others: tuple[str, ...] = ()
    """The objects that it was done to, or the other hand."""


@dataclass(frozen=True)
class EventCounts:
    """How many events were seen and found."""

    seen: int = 0
    found: int = 0
    """Of those seen for sure."""

    open: int = 0
    """Found where it is open whether there was one."""

    extra: int = 0
    """Found and not seen."""

    offs_s: tuple[float, ...] = ()
    """From the middle of what was seen to the nearest time of what was found [s]."""

    def __add__(self, other: "EventCounts") -> "EventCounts":
        """Both together."""
        return EventCounts(
            self.seen + other.seen,
            self.found + other.found,
            self.open + other.open,
            self.extra + other.extra,
            self.offs_s + other.offs_s,
        )

    def scores(self) -> dict[str, Any]:
        """Counts, precision, recall and F1 [%], and how far what was found is away [ms]."""
        total = self.seen + self.found + self.extra
        return {
            "seen": self.seen,
            "found": self.found,
            "missed": self.seen - self.found,
            "open": self.open,
            "extra": self.extra,
            "precision": _percent(self.found, self.found + self.extra),
            "recall": _percent(self.found, self.seen),
            "f1": _percent(2 * self.found, total),
            "away_ms": errors_ms(self.offs_s),
        }


def score_events(plan: Plan, base: Profile, progress: Progress) -> Evaluation:
    """Observe captures and look for what was seen among segments and changes of hands.

    Raises:
        CaparError: A capture or a label file has a fault, or an event is none that can be found.
    """
    return Evaluation(
        Kind.EVENTS, tuple(_scored(pair, plan, base) for pair in progress(plan.pairs)), plan.groups
    )


def compare_events(
    name: str,
    labels: Labels,
    found: Iterable[Event],
    capture: Capture,
    *,
    watched: Sequence[str] = (),
    observation: Observation | None = None,
) -> Scored:
    """Pair what was seen with what was found: of one event and hand, at the same time.

    Each is paired once, those nearest in time first.

    Args:
        name: The capture.
        labels: What was seen, in seconds.
        found: What was found, of any event.
        capture: For its clock.
        watched: Events of which one that was not seen counts as extra; those seen, if empty.
        observation: For the segments at each place.
    """
    events = list(dict.fromkeys([*(each.label for each in labels.marks), *watched]))
    parts, channels = {}, []
    for event in events:
        marks = [each for each in labels.marks if each.label == event]
        own = sorted(each for each in found if each.event == event)
        parts[event] = _counts(marks, own)
        for hand in dict.fromkeys([*(each.link for each in marks), *(each.hand for each in own)]):
            channels.append(_channel(event, hand, marks, own, observation))
    return Scored(
        name=name,
        times=capture.times,
        channels=tuple(channels),
        parts=parts,
        whole=summed(parts.values()),
        notices=labels.notices,
    )


def named_segments(observation: Observation, names: Iterable[str]) -> tuple[Event, ...]:
    """The segments that bear one of the names, or specialise it."""
    wanted = set(names)
    return tuple(
        Event(each.start_s, each.end_s, name, each.ee, each.objects)
        for each in observation.segments
        for name in sorted(wanted & {each.name, *each.general})
    )


def _scored(pair: Pair, plan: Plan, base: Profile) -> Scored:
    labels = read_case_labels(pair, plan)
    capture = read_capture(pair.capture)
    check_known(labels, "sensor", [each.name for each in capture.acting], at="link")
    check_known(labels, "body", capture.bodies, at="object")
    check_known(labels, "event", known_names([], base) | set(KINDS), at="label")
    check_span(labels, capture.times)
    measurements, borders = facts_program(capture, rules=base)
    observation = observe_measured(capture, measurements, rules=base)
    wanted = {*labels.names, *plan.events}
    found = [*named_segments(observation, wanted)]
    if wanted & set(KINDS):
        found += [
            Event(each.start_s, each.end_s, each.kind, each.ee, (each.other or each.object,))
            for each in changes(observation, capture, measurements, borders, base)
            if each.kind in wanted
        ]
    return compare_events(
        pair.name, labels, found, capture, watched=plan.events, observation=observation
    )


def _counts(marks: Sequence[Label], found: Sequence[Event]) -> EventCounts:
    pairs = _paired(marks, found)
    sure = [each for each in marks if each.sure]
    hits = [(mark, pairs[mark]) for mark in sure if mark in pairs]
    return EventCounts(
        seen=len(sure),
        found=len(hits),
        open=len(pairs) - len(hits),
        extra=len(found) - len(pairs),
        offs_s=tuple(_off(mark, found[index]) for mark, index in hits),
    )


def _paired(marks: Sequence[Label], found: Sequence[Event]) -> dict[Label, int]:
    """The index of the event that is found for each mark."""
    fitting = sorted(
        (abs(_middle(mark.start, mark.end) - _middle(event.start_s, event.end_s)), mark, index)
        for mark in marks
        for index, event in enumerate(found)
        if _fits(mark, event)
    )
    pairs: dict[Label, int] = {}
    for _, mark, index in fitting:
        if mark not in pairs and index not in pairs.values():
            pairs[mark] = index
    return pairs


def _fits(mark: Label, event: Event) -> bool:
    meet = mark.start - SLACK_S <= event.end_s and event.start_s <= mark.end + SLACK_S
    about = not mark.object or mark.object in event.others
    return meet and about and mark.link == event.hand


def _off(mark: Label, event: Event) -> float:
    """How far the middle of what was seen is from the event; zero inside it [s]."""
    middle = _middle(mark.start, mark.end)
    return min(max(middle, event.start_s), event.end_s) - middle


def _middle(start_s: float, end_s: float) -> float:
    return (start_s + end_s) / 2.0


def _channel(
    event: str,
    hand: str,
    marks: Sequence[Label],
    found: Sequence[Event],
    observation: Observation | None,
) -> Channel:
    """What was seen and found of one hand; of a pair the found times, as only the rest differs."""
    own = [each for each in marks if each.link == hand]
    mine = [each for each in found if each.hand == hand]
    pairs = _paired(own, mine)
    shown = {each: _shown(each, event, mine[pairs[each]] if each in pairs else None)
             for each in own}  # fmt: skip
    links = observation.links if observation else ()
    return Channel(
        f"{event} of {hand}",
        true=tuple(shown[each] for each in own if each.sure),
        found=tuple(Interval(each.start_s, each.end_s, event) for each in mine),
        silent=True,
        open=tuple(shown[each] for each in own if not each.sure),
        segments=tuple(each for link in links if link.ee == hand for each in link.segments),
    )


def _shown(mark: Label, event: str, found: Event | None) -> Interval:
    times = (mark.start, mark.end) if found is None else (found.start_s, found.end_s)
    return Interval(*times, event)


def _percent(part: int, whole: int) -> float | None:
    return rounded(100.0 * part / whole) if whole else None
