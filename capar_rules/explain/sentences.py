"""Sentences for atoms, from the templates that rule files carry in comments ``%! name/2: text``."""

import re
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, field

from capar_rules.engine.syntax import Statement

_TEMPLATE = re.compile(r"%!(!?)\s*(?:(had not|had|not|mended) )?(\w+)/(\d+)(?: (\w+))?:\s*(.+)")
_SEGMENT = re.compile(r"seg\((\w+),(\d+)\)")


@dataclass(frozen=True, slots=True)
class Template:
    """The sentence of one predicate."""

    text: str
    leading: bool
    """Whether it belongs in the summary of an explanation."""


Key = tuple[str, str, int, str]
"""Mood, predicate, arity and an argument.

Moods: "" (it holds), "not", "had" and "had not" (counterfactual), "mended" (taken to hold though
some frames are doubted).
"""

Distances = Callable[[str, int, int], tuple[float, float]]
"""How far an object moved between two frames [m]: straight, and along its path."""

LEAST_M = 0.01
"""Shorter distances are left out of sentences [m]: the body ended where it began."""

DRIFT_M = 0.005
"""Of a body that stays, shorter distances are left out of sentences [m]."""

LONGER, LONGER_M = 1.5, 0.05
"""By this factor and by so much [m] a path is longer than the straight way, to be told instead."""


@dataclass(frozen=True)
class Clock:
    """Times of ticks and segments for sentences."""

    rate_hz: float
    frames: Mapping[str, Sequence[int]]
    """Frames of the ticks, by end-effector."""

    ends: Mapping[tuple[str, int], int] = field(default_factory=dict)
    """The tick where the segment ends that begins at a tick."""

    distances_m: Distances | None = None
    """How far objects moved, where that was measured."""

    moving: Mapping[str, Sequence[tuple[int, int]]] = field(default_factory=dict)
    """First and last frames of the measured motions, by object."""

    objects: Mapping[str, str] = field(default_factory=dict)
    """The object that each segment is about, by the segment's term."""

    def at(self, frame: int) -> str:
        """A frame as a time."""
        return f"{frame / self.rate_hz:.2f} s"

    def border(self, segment: str, side: str) -> str:
        """When a segment starts or ends."""
        span = self.span(segment)
        return f"its {side}" if span is None else self.at(span[side == "end"])

    def about(self, segment: str) -> str:
        """The object that a segment is about."""
        return self.objects.get(segment, "object").replace("_", " ")

    def motion(self, name: str, span: tuple[int, int]) -> tuple[int, int]:
        """From when to when an object was measured to move within a span; the span if never."""
        parts = [
            (max(first, span[0]), min(last, span[1])) for first, last in self.moving.get(name, ())
        ]
        parts = [each for each in parts if each[0] < each[1]]
        return (min(parts)[0], max(last for _, last in parts)) if parts else span

    def span(self, segment: str) -> tuple[int, int] | None:
        """First and last frame of the segment that a term names."""
        found = _SEGMENT.fullmatch(segment)
        if found is None:
            return None
        ee, first = found[1], int(found[2])
        last = self.ends.get((ee, first))
        return None if last is None else (self.frames[ee][first], self.frames[ee][last])


class Sentences:
    """The templates of a rule base."""

    def __init__(self, statements: Iterable[Statement]) -> None:
        self.templates: dict[Key, Template] = {}
        for each in statements:
            for line in each.text.splitlines() if each.kind == "comment" else ():
                found = _TEMPLATE.match(line.strip())
                if found:
                    leading, mood, name, arity, kind, text = found.groups()
                    key = mood or "", name, int(arity), kind or ""
                    self.templates[key] = Template(text, bool(leading))

    def template(
        self, predicate: str, arguments: Sequence[str], *, mood: str = ""
    ) -> Template | None:
        """The template for an atom; one for a certain argument precedes the general one.

        Without a template of its own, the mood ``mended`` uses the plain template.
        """
        if mood == "mended" and (mood, predicate, len(arguments), "") not in self.templates:
            mood = ""
        key = mood, predicate, len(arguments)
        for each in arguments:
            if (*key, each) in self.templates:
                return self.templates[*key, each]
        return self.templates.get((*key, ""))

    def tell(
        self, predicate: str, arguments: Sequence[str], clock: Clock, *, mood: str = ""
    ) -> str:
        """The sentence for an atom; empty if it has no template."""
        template = self.template(predicate, arguments, mood=mood)
        if template is None:
            return ""
        values = [_Value(each, arguments, clock) for each in arguments]
        return template.text.format(*values)


SPANS = ("segment", "motion", "distance", "ended", "drift")
"""Formats that tell of the time in which a segment lies."""


class _Value:
    """An argument, formatted as a name, a time or a distance."""

    def __init__(self, text: str, beside: Sequence[str], clock: Clock) -> None:
        self.text, self.beside, self.clock = text, beside, clock

    def __format__(self, form: str) -> str:
        if form == "frame":
            return self.clock.at(int(self.text))
        if form == "milli":
            return f"{int(self.text) / 1000.0:.2f}"
        if form == "tick":
            return self.clock.at(self.clock.frames[self.beside[0]][int(self.text)])
        told = self._of_segment(form)
        return self.text.replace("_", " ") if told is None else told

    def _of_segment(self, form: str) -> str | None:
        """The text for the segment that this argument, or else the first one, names."""
        if form in ("start", "end"):
            return self.clock.border(self.text, form)
        if form == "border":
            return self.clock.border(self.beside[0], self.text)
        if form == "object":
            return self.clock.about(self.text)
        if form == "hand":
            return self.text.removeprefix("seg(").split(",")[0].replace("_", " ")
        return self._of_span(form) if form in SPANS else None

    def _of_span(self, form: str) -> str:
        span = self.clock.span(self.text)
        if span is None:
            return "its start and its end" * (form in ("segment", "motion"))
        if form in ("motion", "distance", "ended"):
            span = self.clock.motion(self.beside[0], span)
        if form in ("segment", "motion"):
            return f"{self.clock.at(span[0])} and {self.clock.at(span[1])}"
        return self._distance(form, span)

    def _distance(self, form: str, span: tuple[int, int]) -> str:
        if self.clock.distances_m is None:
            return ""
        straight, path = self.clock.distances_m(self.beside[0], *span)
        if form == "drift":
            drift = f", but for {1e3 * straight:.0f} mm that do not count as motion,"
            return drift if straight >= DRIFT_M else ""
        if path > LONGER * straight and path > straight + LONGER_M:
            if form == "distance":
                return f" along {path:.2f} m of path"
            return f", and ended {straight:.2f} m from where it began"
        return f" {straight:.2f} m" if form == "distance" and straight >= LEAST_M else ""
