"""What was announced and what is settled: segments, facts, and what rules are told again."""

from bisect import bisect_left
from collections import defaultdict, deque
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, fields, replace
from enum import StrEnum
from functools import cache
from types import MappingProxyType
from typing import Any, cast

from capar.model.facts import (
    DrawsBack,
    Fact,
    Moving,
    Observed,
    Phase,
    Place,
    ReleaseSpeed,
    Resting,
    Reverses,
    Rides,
    Span,
    Touching,
    TrunkPlace,
)
from capar.model.observation import ObservedLink, Segment
from capar_rules.pars.inference import Inference


class Status(StrEnum):
    """How sure an announcement is.

    A segment is ``provisional`` when it has ended and later frames may still change it, ``revised``
    when it is announced otherwise than before, ``withdrawn`` when what was announced goes on or is
    part of another segment, and ``settled`` when name, objects, begin and end are final. A
    ``purpose`` is what a settled segment was for: where nobody states one, the action that follows.
    """

    PROVISIONAL = "provisional"
    REVISED = "revised"
    WITHDRAWN = "withdrawn"
    SETTLED = "settled"
    PURPOSE = "purpose"


@dataclass(frozen=True, slots=True)
class SegmentEvent:
    """One announcement about one segment."""

    status: Status
    segment: Segment
    """With its number in the link and its times since the first frame."""

    time_s: float
    """Time of the newest frame when it was announced [s]."""

    sentence: str = ""
    """What was done, in plain English; empty where nothing was touched."""

    @property
    def late_s(self) -> float:
        """How long after the end of the segment it was announced [s]."""
        return self.time_s - self.segment.end_s

    def row(self) -> dict[str, Any]:
        """The announcement as one JSON object; times in seconds since the first frame."""
        segment = self.segment
        return {
            "event": self.status.value,
            "segment": f"{segment.ee}/{segment.index}",
            "name": segment.name,
            "objects": list(segment.objects),
            "purpose": segment.purpose,
            "start_s": round(segment.start_s, 6),
            "end_s": round(segment.end_s, 6),
            "time_s": round(self.time_s, 6),
            "late_s": round(self.late_s, 6),
            "sentence": self.sentence,
        }

    def __str__(self) -> str:
        """A line for people."""
        segment = self.segment
        what = self.sentence or f"{segment.name}({', '.join(segment.objects)})"
        if self.status is Status.PURPOSE:
            what = f"{segment.name}: for {segment.purpose}"
        address = f"{segment.ee}/{segment.index}"
        return (
            f"{self.time_s:7.2f}  {self.status.value:12} {address}".ljust(38)
            + f"{segment.start_s:6.2f}-{segment.end_s:<6.2f}   {what}"
        )


Key = tuple[object, ...]  # What an interval is of: its kind and its bodies, whenever it is.
AT_THE_END = (ReleaseSpeed, Rides)
"""Kinds that name a contact by its first frame and are measured up to its end."""

OF_A_MOTION = (Reverses, DrawsBack, Phase)
"""Kinds that are sought within a motion as a whole: that a thing has come down tells where it was
highest. They are settled with the motion."""


@dataclass(frozen=True, slots=True)
class _Open:
    """An interval that goes on beyond the frontier."""

    first: int
    named: tuple[Observed, ...]
    """Facts that name it, as they were measured when its beginning was in the window."""


class FactLedger:
    """What is settled up to a frame, the frontier, and the intervals that go on there.

    A later window may begin within an interval: it is then continued by its true beginning.
    """

    def __init__(self) -> None:
        self.frontier = -1
        self._open: dict[Key, _Open] = {}
        self._told: set[tuple[Key, int]] = set()
        """The instants that were settled since the earliest motion began that goes on."""

    def begin_of(self, kinds: tuple[type[Observed], ...]) -> int | None:
        """The first frame of the intervals of some kinds that go on; None without any."""
        return min((own.first for key, own in self._open.items() if key[0] in kinds), default=None)

    def stitched(self, facts: Iterable[Fact], begin: int) -> list[Observed]:
        """Facts of a window in frames of the recording, with intervals from their beginning.

        Facts that are settled are left out, and so are those that hold always.
        """
        observed = [fact for fact in facts if isinstance(fact, Observed)]
        of_motions = (_moved(fact, begin) for fact in observed if isinstance(fact, OF_A_MOTION))
        late = {fact.ends()[0] for fact in of_motions if self._is_late(fact)}
        # Most facts are of single frames, and most of them are settled.
        seen = [
            _moved(fact, begin)
            for fact in observed
            if fact.declaration.span is not Span.INSTANT
            or (at := fact.ends()[0] + begin) > self.frontier
            or (at in late and (_key(fact), at) not in self._told)
        ]
        firsts: dict[tuple[Key, int], int] = {}
        ended: set[tuple[Key, int]] = set()
        for fact in seen:
            if fact.declaration.span is Span.INTERVAL:
                place, known = (_key(fact), fact.ends()[0]), self._continued(fact)
                if known is not None:
                    firsts[place] = known.first
                elif fact.ends()[-1] <= self.frontier:
                    ended.add(place)
        continued = {place for place, first in firsts.items() if first != place[1]}
        out: list[Observed] = []
        for fact in seen:
            span = fact.declaration.span
            if span is Span.INSTANT:
                out.append(fact)
                continue
            if span is Span.INTERVAL:
                place = (_key(fact), fact.ends()[0])
                skipped = place in ended and not self._is_late(fact)
            elif not isinstance(span, Span):
                place = (_key_of_named(fact), fact.ends()[0])
                named_later = place in continued and not isinstance(fact, AT_THE_END)
                skipped = place in ended or named_later
            else:
                continue
            if not skipped:
                first = firsts.get(place)
                begun = fact if first is None else replace(cast(Any, fact), first=first)
                out.append(cast(Observed, begun))
        for key, _ in continued:
            out += [each for each in self._open[key].named if not isinstance(each, AT_THE_END)]
        return list(dict.fromkeys(out))

    def settle(self, stitched: Sequence[Observed], frontier: int) -> list[Observed]:
        """Move the frontier; what ends no later is settled, and returned."""
        done: list[Observed] = []
        going: dict[Key, _Open] = {}
        ended: set[tuple[Key, int]] = set()
        named: dict[tuple[Key, int], list[Observed]] = {}
        for fact in stitched:
            if not isinstance(fact.declaration.span, Span):
                named.setdefault((_key_of_named(fact), fact.ends()[0]), []).append(fact)
        moves = {
            fact.object: fact.first
            for fact in stitched
            if isinstance(fact, Moving) and fact.first <= frontier < fact.last
        }
        for fact in stitched:
            span, ends = fact.declaration.span, fact.ends()
            if isinstance(fact, OF_A_MOTION) and ends[0] >= moves.get(fact.object, frontier + 1):
                continue
            if span is Span.INSTANT and ends[0] <= frontier:
                done.append(fact)
                self._told.add((_key(fact), ends[0]))
            elif span is Span.INTERVAL:
                place = (_key(fact), ends[0])
                if ends[-1] <= frontier:
                    done.append(fact)
                    done += named.get(place, ())
                    ended.add(place)
                elif ends[0] <= frontier:
                    going[place[0]] = _Open(ends[0], tuple(named.get(place, ())))
        self._open, self.frontier = going, frontier
        oldest = min(moves.values(), default=frontier + 1)
        self._told = {told for told in self._told if told[1] >= oldest}
        return done

    def _continued(self, fact: Observed) -> _Open | None:
        """The interval that went on at the frontier and of which a fact is; None without one.

        Its end may be measured a frame sooner than before, and so be at the frontier or before it.
        """
        if fact.ends()[0] > self.frontier:
            return None
        known = self._open.get(_key(fact))
        return known if known is not None and fact.ends()[-1] >= known.first else None

    def _is_late(self, fact: Observed) -> bool:
        """Whether it is of a motion that goes on, and is not settled though its frames are."""
        if not isinstance(fact, OF_A_MOTION) or fact.ends()[-1] > self.frontier:
            return False
        motion = self._open.get((Moving, fact.object))
        return motion is not None and fact.ends()[0] >= motion.first


def _key(fact: Observed) -> Key:
    """The kind of an interval and its bodies: what it measures besides is no part of it."""
    bodies, _ = _layout(cast(Any, type(fact)))
    return type(fact), *(getattr(fact, name) for name in bodies)


@cache
def _layout(kind: type[Observed]) -> tuple[tuple[str, ...], tuple[str, ...]]:
    """The fields of a kind of fact that hold text, and those that hold frames."""
    known = {each.name: each.type for each in fields(cast(Any, kind))}
    frames = () if kind.declaration.span is Span.ALWAYS else ("frame", "first", "last")
    texts = tuple(name for name, of in known.items() if of is str)
    return texts, tuple(name for name in known if name in frames)


def _key_of_named(fact: Observed) -> Key:
    """The key of the interval that a fact names."""
    kind, *values = fact.name(cast(Any, fact.declaration.span))
    return kind, *(each for each in values if isinstance(each, str))


def _moved(fact: Observed, by: int) -> Observed:
    _, frames = _layout(cast(Any, type(fact)))
    if not by or not frames:
        return fact
    changed = {name: getattr(fact, name) + by for name in frames}
    return cast(Observed, replace(cast(Any, fact), **changed))


@dataclass
class _Link:
    recent: deque[Segment]
    """The last settled segments, in time."""

    count: int = 0
    end: int = 0
    """The last frame of the last settled segment."""

    announced: dict[int, Segment] = field(default_factory=dict)
    due: tuple[int, ...] = ()
    """The frontiers at which the segments that were found to have ended are settled at the latest,
    so that those which end one soon after the other are settled at once."""


class SegmentLedger:
    """Takes one answer of the rules after the other, and reports what is new."""

    def __init__(self, kept: int, later: Mapping[str, int] = MappingProxyType({})) -> None:
        self._kept = kept
        self._later = later
        self._links: dict[str, _Link] = {}

    def ends(self) -> list[int]:
        """The last frame of the last settled segment of each link: the next one begins there."""
        return sorted({link.end for link in self._links.values()})

    def first_needed(self, now: int) -> int:
        """The frame from which rules have to see, so that each link's last segments are found."""
        starts = [link.recent[0].first if link.recent else 0 for link in self._links.values()]
        return min(starts, default=now if self._links else 0)

    def next_due(self, after: int) -> int | None:
        """The first frontier later than one at which a segment has to be settled that was found."""
        due = (frontier for link in self._links.values() for frontier in link.due)
        return min((frontier for frontier in due if frontier > after), default=None)

    def take(
        self,
        inference: Inference,
        *,
        now: int,
        ended: int,
        frontier: int,
        rate_hz: float,
        time_s: float,
        undecided: Mapping[str, int] = MappingProxyType({}),
        unseen: Mapping[str, int] = MappingProxyType({}),
    ) -> list[SegmentEvent]:
        """What an answer says that was not said before.

        Args:
            inference: Segments in frames of the recording.
            now: The newest frame: segments that end there go on.
            ended: Segments that end no later are announced, if they are not settled.
            frontier: Segments that end no later are settled, but for those that wait ``later``; at
                the recording's end, ``now``, all are.
            rate_hz: Frames a second [Hz].
            time_s: Time of the newest frame [s].
            undecided: Of a link, the frame from which on no segment ends that may be settled yet.
            unseen: Of a link, the frame from which on none ends that may be announced.
        """
        events: list[SegmentEvent] = []
        for link in inference.links:
            own = self._links.setdefault(link.ee, _Link(deque(maxlen=self._kept)))
            found = list(_unsettled(own, link, rate_hz))
            if found and own.recent and self._due(found[0]) <= frontier:
                known = own.recent[-1]
                did = (known.name, known.objects, known.last)
                same = (s for s in link.segments if (s.name, s.objects, s.last) == did)
                purpose = next((s.purpose for s in same if s.purpose != known.purpose), None)
                if purpose is not None:
                    own.recent[-1] = replace(known, purpose=purpose)
                    events.append(SegmentEvent(Status.PURPOSE, own.recent[-1], time_s))
            settled = 0
            for segment in found:
                if segment.last >= undecided.get(link.ee, now + 1):
                    break
                if self._due(segment) > frontier and frontier < now:
                    break
                settled += 1
                events.append(SegmentEvent(Status.SETTLED, segment, time_s))
                own.announced.pop(segment.index, None)
                own.count, own.end = segment.index + 1, segment.last
                own.recent.append(segment)
            latest = max(self._later.values(), default=0)
            own.due = tuple(each.last + latest for each in found[settled:] if each.last < now)
            upto = min(ended, unseen.get(link.ee, now + 1) - 1)
            over = {each.index: each for each in found[settled:] if each.last <= upto}
            events += _announced(own, over, time_s)
        return events

    def _due(self, segment: Segment) -> int:
        """The frontier at which a segment is settled."""
        return segment.last + max(self._later.get(border.kind, 0) for border in segment.ends)


def _unsettled(own: _Link, link: ObservedLink, rate_hz: float) -> Iterator[Segment]:
    """The segments after the last settled one, numbered on from it."""
    index, begin = own.count, own.end
    for segment in link.segments:
        over = own.end - segment.first > segment.last - own.end  # more of it is settled than not
        if segment.last <= own.end or (segment.first < own.end and over):
            continue
        borders = segment.begins
        if own.recent and segment.first != begin:
            borders = own.recent[-1].ends
        start_s = begin / rate_hz
        yield replace(segment, index=index, first=begin, start_s=start_s, begins=borders)
        index, begin = index + 1, segment.last


def _announced(own: _Link, ended: dict[int, Segment], time_s: float) -> Iterator[SegmentEvent]:
    for index, segment in ended.items():
        before = own.announced.get(index)
        if before is None:
            yield SegmentEvent(Status.PROVISIONAL, segment, time_s)
        elif any(getattr(before, name) != getattr(segment, name) for name in CONTENT):
            yield SegmentEvent(Status.REVISED, segment, time_s)
    for index, segment in own.announced.items():
        if index not in ended and index >= own.count:
            yield SegmentEvent(Status.WITHDRAWN, segment, time_s)
    own.announced = dict(ended)


CONTENT = ("name", "objects", "first", "last")
"""What of a segment is announced again where it differs."""

SAME_PLACE_MM = 10  # Postures at rest nearer to each other than this along every axis are one [mm].


class RuleMemory:
    """Facts of the last few segments, and of the places where an end-effector rested before.

    Rules ask whether a hand is back where it was before it acted, however long ago: the first
    frame, and rests at other places than those that are known, stay.
    """

    def __init__(self) -> None:
        self._facts: list[Observed] = []
        self._postures: dict[tuple[object, ...], tuple[Observed, ...]] = {}

    def __iter__(self) -> Iterator[Observed]:
        """The facts, each once."""
        remembered = (each for facts in self._postures.values() for each in facts)
        return iter(dict.fromkeys((*remembered, *self._facts)))

    def add(self, facts: Iterable[Observed]) -> None:
        """Take facts that were settled."""
        self._facts += facts

    def forget(self, begin: int, borders: Sequence[int], margin: int) -> None:
        """Drop what rules do not need again."""
        at, kept, gone = sorted(borders), list[Observed](), list[Observed]()
        for fact in self._facts:
            ends = fact.ends()
            # The first border that is not more than the margin before each end.
            after = ((end, bisect_left(at, end - margin)) for end in ends)
            near = any(index < len(at) and at[index] <= end + margin for end, index in after)
            (kept if near or ends[-1] >= begin - margin else gone).append(fact)
        self._facts = kept
        if gone:
            self._remember(gone)

    def _remember(self, gone: Sequence[Observed]) -> None:
        """Keep the places of an end-effector at rest, with what it touched meanwhile."""
        places = {(fact.body, fact.frame): fact for fact in gone if isinstance(fact, Place)}
        by_trunk = {(fact.body, fact.frame): fact for fact in gone if isinstance(fact, TrunkPlace)}
        touching: dict[str, list[Touching]] = defaultdict(list)
        for fact in gone:
            if isinstance(fact, Touching):
                touching[fact.body].append(fact)
        postures = {
            at: (place, *((by_trunk[at],) if at in by_trunk else ()))
            for at, place in places.items()
        }
        for (body, frame), posture in postures.items():
            if frame == 0:
                self._postures.setdefault((body, "first"), posture)
        for fact in gone:
            if isinstance(fact, Resting) and (fact.ee, fact.last) in postures:
                posture = postures[fact.ee, fact.last]
                met = (
                    touch
                    for touch in touching[fact.ee]
                    if touch.first <= fact.last and fact.first <= touch.last
                )
                axes = (axis for place in posture for axis in (place.x, place.y, place.z))
                cell = tuple(round(axis / SAME_PLACE_MM) for axis in axes)
                self._postures.setdefault((fact.ee, *cell), (fact, *posture, *met))
