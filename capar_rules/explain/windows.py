"""The facts around one segment, so that explaining it costs the same in any capture."""

from bisect import bisect_left, bisect_right
from collections import defaultdict
from collections.abc import Iterator, Sequence
from dataclasses import replace

from capar.model.facts import Fact, FactIntervals, Observed, RateMhz
from capar_rules.borders.numbering import LastTick, MovesDuring, Tick, Within
from capar_rules.borders.ticks import Shares, in_frames, times

BUCKET = 256
"""Number of frames, or ticks, for each entry of the index."""

Span = tuple[int, int]


class Windows:
    """The facts of a capture, indexed by when they hold."""

    def __init__(self, facts: Sequence[Fact], numbered: Sequence[Fact]) -> None:
        self.rate = next(each.rate for each in facts if isinstance(each, RateMhz)) / 1000.0
        self.frames: dict[str, list[int]] = defaultdict(list)
        for each in sorted(each for each in numbered if isinstance(each, Tick)):
            self.frames[each.ee].append(each.frame)
        self.always: list[Fact] = []
        self.timed = _Index()
        self.numbered: dict[str, _Index] = defaultdict(_Index)
        intervals = FactIntervals(facts)
        for fact in facts:
            span = intervals.of(fact)
            if span is None and isinstance(fact, Observed) and fact.ends():
                span = fact.ends()[0], fact.ends()[0]  # no other fact states its interval
            if span is None:
                self.always.append(fact)
            else:
                self.timed.add(span, fact)
        for fact in numbered:
            ee = str(getattr(fact, "ee"))  # noqa: B009 (every numbered fact has one)
            first, last = getattr(fact, "first", None), getattr(fact, "last", None)
            if isinstance(fact, LastTick):
                continue
            if first is not None and last is not None:
                self.numbered[ee].add((first, last), fact)
            elif hasattr(fact, "tick"):
                self.numbered[ee].add((fact.tick, fact.tick), fact)
            elif isinstance(fact, MovesDuring | Shares):
                self.numbered[ee].during[fact.object, fact.since].append(fact)
            else:
                self.always.append(fact)

    def around(self, ee: str, first: int, last: int, *, widen: int = 0) -> tuple[Fact, ...]:
        """The facts that can affect the segment of a link between two ticks.

        Args:
            ee: The link's end-effector.
            first: The tick where the segment begins.
            last: The tick where it ends.
            widen: By how many further gaps between ticks to widen the window.
        """
        spans = {ee: self._settled(ee, first, last, widen)}
        begin, end = (self.frames[ee][tick] for tick in spans[ee])
        for other in self.frames:
            if other != ee:
                low = max(bisect_right(self.frames[other], begin) - 1, 0)
                high = min(bisect_left(self.frames[other], end), len(self.frames[other]) - 1)
                spans[other] = self._settled(other, low, high, widen)
                begin = min(begin, self.frames[other][spans[other][0]])
                end = max(end, self.frames[other][spans[other][1]])
        found = {*self.always, *self.timed.within((begin, end))}
        for other, span in spans.items():
            found |= set(self._cut(other, span))
        return tuple(sorted(found, key=lambda each: (type(each).predicate, each)))

    def whole(self) -> tuple[Fact, ...]:
        """All facts, if no window suffices."""
        facts = {*self.always, *(one[2] for some in self.timed.buckets.values() for one in some)}
        for ee, frames in self.frames.items():
            facts |= set(self._cut(ee, (0, len(frames) - 1)))
        return tuple(sorted(facts, key=lambda each: (type(each).predicate, each)))

    def _settled(self, ee: str, first: int, last: int, widen: int) -> Span:
        """The ticks around a segment that could merge with its own, and one beyond on each side."""
        frames, gap = self.frames[ee], in_frames(times().settled_ms, self.rate)
        for _ in range(widen + 1):
            while first > 0 and frames[first] - frames[first - 1] < gap:
                first -= 1
            first = max(first - 1, 0)
            while last < len(frames) - 1 and frames[last + 1] - frames[last] < gap:
                last += 1
            last = min(last + 1, len(frames) - 1)
        return first, last

    def _cut(self, ee: str, span: Span) -> Iterator[Fact]:
        first, last = span
        index = self.numbered[ee]
        yield LastTick(ee, last)
        for fact in index.within(span):
            if isinstance(fact, Within):
                yield replace(fact, first=max(fact.first, first), last=min(fact.last, last))
                yield from index.during.get((fact.other, fact.since), ())
            elif isinstance(fact, Tick) or getattr(fact, "tick", first) < last:
                yield fact


class _Index:
    """Facts by the interval in which they hold."""

    def __init__(self) -> None:
        self.buckets: dict[int, list[tuple[int, int, Fact]]] = defaultdict(list)
        self.during: dict[tuple[str, int], list[Fact]] = defaultdict(list)

    def add(self, span: Span, fact: Fact) -> None:
        for bucket in range(span[0] // BUCKET, span[1] // BUCKET + 1):
            self.buckets[bucket].append((*span, fact))

    def within(self, span: Span) -> Iterator[Fact]:
        """Facts that share a frame with the span; some more than once."""
        for bucket in range(span[0] // BUCKET, span[1] // BUCKET + 1):
            for first, last, fact in self.buckets.get(bucket, ()):
                if first <= span[1] and last >= span[0]:
                    yield fact
