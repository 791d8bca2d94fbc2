"""Which segments of a link were announced, and which are settled and are never told again."""

from collections import deque
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from types import MappingProxyType

from capar.model.observation import ObservedLink, Segment
from capar.pipelines.live.events import SegmentEvent, Status
from capar_rules.pars.inference import Conditions, Inference


@dataclass(frozen=True, slots=True)
class SettledSegment:
    """A segment as it was settled, with what the rules derived for its PAR."""

    segment: Segment
    conditions: Conditions
    no_step: bool


@dataclass
class Contradictions:
    """How often a later answer differed from what was settled; the settled one stays."""

    names: int = 0
    borders: int = 0


@dataclass
class _Link:
    count: int = 0
    end: int = 0
    """The last frame of the last settled segment."""

    recent: deque[SettledSegment] = field(default_factory=deque)
    announced: dict[int, Segment] = field(default_factory=dict)
    due: tuple[int, ...] = ()
    """The frontiers at which the segments that were found to have ended are settled at the latest,
    so that those which end one soon after the other are settled at once."""


class SegmentLedger:
    """Takes one answer of the rules after the other, and tells what is new.

    Args:
        kept: How many settled segments of a link are remembered.
        later: By how many frames later than others a segment is settled that ends with such a kind
            of event.
    """

    def __init__(self, kept: int, later: Mapping[str, int] = MappingProxyType({})) -> None:
        self._kept = kept
        self._later = later
        self._links: dict[str, _Link] = {}
        self.contradictions = Contradictions()

    def recent(self, ee: str) -> Sequence[SettledSegment]:
        """The last settled segments of a link, in time."""
        return self._links[ee].recent if ee in self._links else ()

    def ends(self) -> list[int]:
        """The last frame of the last settled segment of each link: the next one begins there."""
        return sorted({link.end for link in self._links.values()})

    def first_needed(self, now: int) -> int:
        """The frame from which rules have to see, so that every link's last segments are told."""
        starts = [
            link.recent[0].segment.first if link.recent else 0 for link in self._links.values()
        ]
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
    ) -> tuple[list[SegmentEvent], list[SettledSegment]]:
        """What an answer says that was not said before, and which segments it settles.

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
        done: list[SettledSegment] = []
        for link in inference.links:
            own = self._links.setdefault(link.ee, _Link())
            found = list(self._unsettled(own, link, rate_hz))
            settled = 0
            if found and own.recent and self._due(found[0][1]) <= frontier:
                amended = self._with_purpose(own, link)
                if amended is not None:
                    events.append(SegmentEvent(Status.PURPOSE, amended.segment, time_s))
                    done.append(amended)
            for local, segment in found:
                if segment.last >= undecided.get(link.ee, now + 1):
                    break
                if self._due(segment) > frontier and frontier < now:
                    break
                settled += 1
                key = (link.ee, local)
                each = SettledSegment(segment, inference.conditions[key], key in inference.no_steps)
                events.append(SegmentEvent(Status.SETTLED, segment, time_s))
                done.append(each)
                self._settle(own, each)
            latest = max(self._later.values(), default=0)
            own.due = tuple(each.last + latest for _, each in found[settled:] if each.last < now)
            upto = min(ended, unseen.get(link.ee, now + 1) - 1)
            told = {each.index: each for _, each in found[settled:] if each.last <= upto}
            events += _announced(own, told, time_s)
        return events, done

    def _due(self, segment: Segment) -> int:
        """The frontier at which a segment is settled."""
        return segment.last + max(self._later.get(border.kind, 0) for border in segment.ends)

    def _with_purpose(self, own: _Link, link: ObservedLink) -> SettledSegment | None:
        """The last settled segment with what it was for, where that was not known before."""
        known = own.recent[-1]
        for latest in link.segments:
            if _same(latest, known.segment) and latest.purpose != known.segment.purpose:
                amended = replace(known, segment=replace(known.segment, purpose=latest.purpose))
                own.recent[-1] = amended
                return amended
        return None

    def _settle(self, own: _Link, each: SettledSegment) -> None:
        own.announced.pop(each.segment.index, None)
        own.count, own.end = each.segment.index + 1, each.segment.last
        own.recent.append(each)
        if len(own.recent) > self._kept:
            own.recent.popleft()

    def _unsettled(
        self, own: _Link, link: ObservedLink, rate_hz: float
    ) -> Iterator[tuple[int, Segment]]:
        """The segments after the last settled one, numbered on from it, by their own number."""
        index, begin = own.count, own.end
        for local, segment in enumerate(link.segments):
            if segment.last <= own.end or (segment.first < own.end and _mostly(segment, own.end)):
                self._compare(own, segment)
                continue
            borders = segment.begins
            if own.recent and segment.first != begin:
                borders = own.recent[-1].segment.ends
            start_s = begin / rate_hz
            yield (
                local,
                replace(segment, index=index, first=begin, start_s=start_s, begins=borders),
            )
            index, begin = index + 1, segment.last

    def _compare(self, own: _Link, segment: Segment) -> None:
        """Count where a later answer tells of one of the last two settled segments otherwise.

        Of what is farther back, rules are told too little to say anything.
        """
        for settled in list(own.recent)[-2:]:
            known = settled.segment
            if known.first <= (segment.first + segment.last) // 2 <= known.last:
                self.contradictions.names += int(known.name != segment.name)
                self.contradictions.borders += int(known.last != segment.last)
                return


def _same(one: Segment, other: Segment) -> bool:
    return (one.name, one.objects, one.last) == (other.name, other.objects, other.last)


def _mostly(segment: Segment, end: int) -> bool:
    """Whether more of a segment lies before a frame than after it."""
    return end - segment.first > segment.last - end


def _announced(own: _Link, ended: dict[int, Segment], time_s: float) -> Iterator[SegmentEvent]:
    for index, segment in ended.items():
        before = own.announced.get(index)
        if before is None:
            yield SegmentEvent(Status.PROVISIONAL, segment, time_s)
        elif _told(before) != _told(segment):
            yield SegmentEvent(Status.REVISED, segment, time_s)
    for index, segment in own.announced.items():
        if index not in ended and index >= own.count:
            yield SegmentEvent(Status.WITHDRAWN, segment, time_s)
    own.announced = dict(ended)


def _told(segment: Segment) -> tuple[object, ...]:
    return segment.name, segment.objects, segment.first, segment.last
