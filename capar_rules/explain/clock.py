"""When the ticks and segments of an answer are, for sentences."""

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from functools import cached_property

from capar.model.body_names import is_plural
from capar_rules.explain.measured import Measured

_SEGMENT = re.compile(r"seg\((\w+),(\d+)\)")


@dataclass(frozen=True)
class Clock:
    """Times of ticks and segments for sentences."""

    rate_hz: float
    frames: Mapping[str, Sequence[int]]
    """Frames of the ticks, by end-effector."""

    ends: Mapping[tuple[str, int], int] = field(default_factory=dict)
    """The tick where the segment ends that begins at a tick."""

    measured: Measured = field(default_factory=Measured)
    objects: Mapping[str, str] = field(default_factory=dict)
    """The object that each segment is about, by the segment's term."""

    listed: Mapping[str, Sequence[str]] = field(default_factory=dict)
    """The objects of each segment in the order of its features, by the segment's term."""

    met: Mapping[tuple[str, str, str], Sequence[str]] = field(default_factory=dict)
    """What a body touches at a side of a segment, by segment, side and body."""

    strokes: Mapping[str, Sequence[int]] = field(default_factory=dict)
    """At which halts of the hand what a segment moves turned back, by the segment's term."""

    own: str = ""
    """The term of the segment that is explained."""

    @cached_property
    def several(self) -> tuple[str, ...]:
        """What the bodies that places are known of are called, if it is a plural."""
        bodies = {name for name, _ in self.measured.places} | {*self.measured.moving}
        return tuple(each for name in sorted(bodies) if is_plural(each := self.called(name)))

    def called(self, name: str) -> str:
        """A body as sentences call it."""
        return self.measured.names.get(name, name.replace("_", " "))

    def it(self, name: str, *, object_: bool = False) -> str:
        """The pronoun of a body, as a subject or as an object."""
        if self.called(name) in self.several:
            return "them" if object_ else "they"
        return "it"

    def at(self, frame: int) -> str:
        """A frame as a time."""
        return f"{frame / self.rate_hz:.2f} s"

    def border(self, segment: str, side: str) -> str:
        """When a segment starts or ends."""
        span = self.span(segment)
        return f"its {side}" if span is None else self.at(span[side == "end"])

    def about(self, segment: str) -> str:
        """The object that a segment is about."""
        return self.called(self.objects.get(segment, "object"))

    def motion(self, name: str, span: tuple[int, int]) -> tuple[int, int]:
        """From when to when an object was measured to move within a span; the span if never."""
        return _within(self.measured.moving.get(name, ()), span)

    @property
    def closed_gaps(self) -> str:
        """Up to how long bodies may be too far apart within a contact, after how far they were."""
        return f": gaps of {self.measured.gap_frames} end no contact"

    def displacement(self, name: str, span: tuple[int, int]) -> tuple[int, int]:
        """The same from when it truly left its place until it truly reached another."""
        found = self.measured.displaced.get(name) or self.measured.moving.get(name, ())
        return _within(found, span)

    def span(self, segment: str) -> tuple[int, int] | None:
        """First and last frame of the segment that a term names."""
        found = _SEGMENT.fullmatch(segment)
        if found is None:
            return None
        ee, first = found[1], int(found[2])
        last = self.ends.get((ee, first))
        return None if last is None else (self.frames[ee][first], self.frames[ee][last])

    def side(self, ee: str, tick: int) -> str:
        """Whether a tick is the start or the end of the explained segment, or before its start."""
        found = _SEGMENT.fullmatch(self.own)
        if found is None or found[1] != ee:
            return ""
        if int(found[2]) == tick:
            return "start"
        if tick < int(found[2]):
            return "before"
        return "end" if self.ends.get((ee, int(found[2]))) == tick else ""


def _within(spans: Sequence[tuple[int, int]], span: tuple[int, int]) -> tuple[int, int]:
    """From the first to the last frame of what lies within a span; the span if nothing does."""
    parts = [(max(first, span[0]), min(last, span[1])) for first, last in spans]
    parts = [part for part in parts if part[0] < part[1]]
    return (min(parts)[0], max(last for _, last in parts)) if parts else span
