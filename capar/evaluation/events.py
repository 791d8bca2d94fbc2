"""Events that were found, compared with the times at which somebody saw them happen."""

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import Any

from capar.evaluation.labels import Label, Labels, check_known, check_span
from capar.evaluation.metrics import (
    Channel,
    Counts,
    Interval,
    Scored,
    errors_ms,
    percent,
    summed,
)
from capar.evaluation.plan import Pair, Plan, known_names
from capar.model.capture import Capture
from capar.model.facts import Fact, Lies, Moving, Touching
from capar.model.observation import Observation
from capar.pipelines.observation import facts_program, observe_measured
from capar_rules.borders.ticks import Tick
from capar_rules.engine.profiles import Profile
from capar_rules.engine.solver import rule_file, solve
from extractors.measure import SHIFTS, Measurements
from extractors.readers.bundle.capture_toml import read_capture

SLACK_S = 0.3
"""What somebody sees in pictures or a film may be so much earlier or later [s]."""

PASS, OVER_TABLE, REGRASP = "pass", "over_table", "regrasp"
KINDS = (PASS, OVER_TABLE, REGRASP)
"""Changes of the hands on an object."""


@dataclass(frozen=True, slots=True, order=True)
class Event:
    """Something that a hand did."""

    start_s: float
    end_s: float
    event: str
    """A segment's name, or one of ``KINDS``."""

    hand: str
    others: tuple[str, ...] = ()
    """The objects that it was done to, or the other hand."""


@dataclass(frozen=True)
class EventCounts(Counts):
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

    def scores(self) -> dict[str, Any]:
        """Counts, precision, recall and F1 [%], and how far what was found is away [ms]."""
        return {
            "seen": self.seen,
            "found": self.found,
            "missed": self.seen - self.found,
            "open": self.open,
            "extra": self.extra,
            "precision": percent(self.found, self.found + self.extra),
            "recall": percent(self.found, self.seen),
            "f1": percent(2 * self.found, self.seen + self.found + self.extra),
            "away_ms": errors_ms(self.offs_s),
        }


def score_events(pair: Pair, plan: Plan, base: Profile) -> Scored:
    """Observe a capture and look for what was seen among segments and changes of hands."""
    labels, capture = plan.labels_of(pair), read_capture(pair.capture)
    check_known(labels, "sensor", [each.name for each in capture.acting], at="link")
    check_known(labels, "body", capture.bodies, at="object")
    check_known(labels, "event", known_names([], base) | set(KINDS), at="label")
    check_span(labels, capture.times)
    measurements, borders = facts_program(capture, rules=base)
    observation = observe_measured(capture, measurements, rules=base)
    wanted = {*labels.names, *plan.events}
    found = [
        Event(each.start_s, each.end_s, name, each.ee, each.objects)
        for each in observation.segments
        for name in sorted(wanted & {each.name, *each.general})
    ]
    if wanted & set(KINDS):
        every = changes(observation, capture, measurements, borders, base)
        found += [each for each in every if each.event in wanted]
    return compare_events(
        pair.name, labels, found, capture, watched=plan.events, observation=observation
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
        pairs = _paired(marks, own)
        sure = [each for each in marks if each.sure]
        hits = [(mark, own[pairs[mark]]) for mark in sure if mark in pairs]
        parts[event] = EventCounts(
            seen=len(sure),
            found=len(hits),
            open=len(pairs) - len(hits),
            extra=len(own) - len(pairs),
            offs_s=tuple(_off(mark, one) for mark, one in hits),
        )
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


def _paired(marks: Sequence[Label], found: Sequence[Event]) -> dict[Label, int]:
    """The index of the event that is found for each mark."""
    fitting = sorted(
        (abs(mark.start + mark.end - event.start_s - event.end_s) / 2.0, mark, index)
        for mark in marks
        for index, event in enumerate(found)
        if mark.start - SLACK_S <= event.end_s
        and event.start_s <= mark.end + SLACK_S
        and (not mark.object or mark.object in event.others)
        and mark.link == event.hand
    )
    pairs: dict[Label, int] = {}
    for _, mark, index in fitting:
        if mark not in pairs and index not in pairs.values():
            pairs[mark] = index
    return pairs


def _off(mark: Label, event: Event) -> float:
    """How far the middle of what was seen is from the event; zero inside it [s]."""
    middle = (mark.start + mark.end) / 2.0
    return min(max(middle, event.start_s), event.end_s) - middle


def _channel(
    event: str,
    hand: str,
    marks: Sequence[Label],
    found: Sequence[Event],
    observation: Observation | None,
) -> Channel:
    """What was seen and found of one hand; of a pair the found times, as only the rest differs."""
    own = [each for each in marks if each.link == hand]
    mine = [Interval(each.start_s, each.end_s, event) for each in found if each.hand == hand]
    pairs = _paired(own, [each for each in found if each.hand == hand])
    shown = {
        each: mine[pairs[each]] if each in pairs else Interval(each.start, each.end, event)
        for each in own
    }
    links = observation.links if observation else ()
    return Channel(
        f"{event} of {hand}",
        true=tuple(shown[each] for each in own if each.sure),
        found=tuple(mine),
        silent=True,
        open=tuple(shown[each] for each in own if not each.sure),
        segments=tuple(each for link in links if link.ee == hand for each in link.segments),
    )


def changes(
    observation: Observation,
    capture: Capture,
    measurements: Measurements,
    borders: Sequence[Fact],
    base: Profile,
) -> tuple[Event, ...]:
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
    derived = set()
    for segment, thing in answer.of("regrasps"):
        assert isinstance(segment, tuple)
        derived.add((str(segment[1]), frames[str(segment[1]), int(str(segment[2]))], str(thing)))
    times = [float(each) for each in capture.times]
    hands = {each.ee for each in observation.links}
    contacts = (each for each in observation.facts if isinstance(each, Touching))
    touches = sorted(
        (each for each in contacts if each.body in hands), key=lambda each: (each.first, each.body)
    )
    found = (
        *_passes(observation, touches, times),
        *_over(observation, touches, times),
        *_regrasps(observation, times, derived),
    )
    return tuple(sorted(found))


def _passes(
    observation: Observation, touches: Sequence[Touching], times: Sequence[float]
) -> Iterator[Event]:
    """Each segment named Give, from when the other hand touched the object."""
    for segment in observation.segments:
        if "Give" not in (segment.name, *segment.general):
            continue
        for touch in touches:
            taken = touch.other in segment.objects and touch.body != segment.ee
            if taken and touch.first <= segment.first <= touch.last:
                start_s = times[touch.first]
                yield Event(start_s, segment.start_s, PASS, segment.ee, (touch.body,))


def _over(
    observation: Observation, touches: Sequence[Touching], times: Sequence[float]
) -> Iterator[Event]:
    """Each time that one hand lets go of what stands, and another is the next to touch it."""
    moves = [each for each in observation.facts if isinstance(each, Moving)]
    for thing in sorted({each.other for each in touches}):
        for one, two in pairwise(each for each in touches if each.other == thing):
            moved = any(
                each.object == thing and each.first < two.first and each.last > one.last
                for each in moves
            )
            if one.body != two.body and one.last < two.first and not moved:
                yield Event(times[one.last], times[two.first], OVER_TABLE, one.body, (two.body,))


def _regrasps(
    observation: Observation, times: Sequence[float], derived: set[tuple[str, int, str]]
) -> Iterator[Event]:
    """What the rules derive, at the time of the shift that begins in the segment, if one does."""
    shifts = [each for each in observation.facts if isinstance(each, Lies) and each.how == SHIFTS]
    for segment in observation.segments:
        for thing in segment.objects:
            if (segment.ee, segment.first, thing) not in derived:
                continue
            inside = [
                (times[each.first], times[each.last])
                for each in shifts
                if (each.body, each.other) == (segment.ee, thing)
                and segment.first <= each.first < segment.last
            ]
            for start_s, end_s in inside or [(segment.start_s, segment.end_s)]:
                yield Event(start_s, end_s, REGRASP, segment.ee, (thing,))
