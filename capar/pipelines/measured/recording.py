"""A recording as its measured picture shows it: which frames, and what held in them."""

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
from jaxtyping import Float, Int

from capar.model.facts import Observed, Resting
from capar.pipelines.explanation import Explained
from capar.views.lettering import Span
from capar.views.panels import Curve, Held, Limit
from capar_rules.borders.ticks import in_frames, times
from capar_rules.explain.quantities import length
from extractors.bodies.bodies import BodyGeometry

MILLI, CENTI = 1000.0, 100.0

MOST_DIGITS = 3
"""With at most so many decimals a number is told that is near its limit."""


def held(kind: type[Observed], *about: str) -> Held:
    """What bars of facts of a kind about certain bodies show."""
    return (kind.predicate, *sorted(about))


def told_beside(
    value: float, limits: Sequence[Limit], form: Callable[[float], str], unit: str
) -> str:
    """A number as a form has it; with decimals where it would read as a limit that it is not.

    Args:
        value: In the panel's unit, as the limits.
        limits: What it is compared with.
        form: How such a number is told.
        unit: How the panel's unit is told behind a number.
    """
    told = form(value)
    others = [abs(limit.value) for limit in limits if abs(abs(limit.value) - value) > 1e-6]
    near = [other for other in others if form(other) == told]
    for digits in range(1, MOST_DIGITS + 1) if near else ():
        told = f"{value:.{digits}f}{unit}"
        if all(told != f"{other:.{digits}f}{unit}" for other in near):
            break
    return told


@dataclass(frozen=True)
class Recording:
    """What was measured, and which of its frames are shown."""

    seen: Explained
    span: tuple[int, int]
    """First and last frame."""

    @property
    def frames(self) -> Int[np.ndarray, "shown"]:
        """The numbers of the shown frames."""
        return np.arange(self.span[0], self.span[1] + 1)

    @property
    def times(self) -> Float[np.ndarray, "shown"]:
        """Their times [s]."""
        return self.frames / self.rate

    @property
    def rate(self) -> float:
        """Frames a second [Hz]."""
        return self.seen.explainer.windows.rate

    @property
    def merged(self) -> float:
        """How many frames apart events are one."""
        return in_frames(times().merge_ms, self.rate)

    def at(self, frame: int) -> float:
        """The time of a frame [s]."""
        return frame / self.rate

    def body(self, name: str) -> BodyGeometry:
        """The object of a name, or else the sensor."""
        return self.seen.measurements.bodies.named(name)

    def called(self, name: str) -> str:
        """A body as sentences call it."""
        return self.seen.explainer.measured.names.get(name, name.replace("_", " "))

    def curve(self, values: Float[np.ndarray, "frames"], label: str = "") -> Curve:
        """The shown part of what is known at every frame."""
        return Curve(self.times, values[self.span[0] : self.span[1] + 1], label)

    def bars(self, kind: type[Observed], *, least: int = 0, **about: str) -> tuple[Span, ...]:
        """When facts of a kind about certain bodies hold, within what is shown.

        Args:
            kind: The kind.
            least: So many frames from first to last it holds at least, shown or not.
            about: The bodies, by the names of the fact's fields.
        """
        first, last = self.span
        ends = (
            (fact.ends()[0], fact.ends()[-1])
            for fact in self.seen.observation.facts
            if isinstance(fact, kind)
            and all(getattr(fact, name) == value for name, value in about.items())
        )
        return tuple(
            Span(self.at(max(begin, first)), self.at(min(end, last)), "")
            for begin, end in ends
            if begin <= last and end >= first and end - begin >= least
        )

    @property
    def least_rest(self) -> int:
        """How many frames from its first to its last one a rest has that counts."""
        return math.ceil(in_frames(times().rest_ms, self.rate) - 1e-9)

    def rests(self, name: str) -> tuple[Span, ...]:
        """When an end-effector is at rest for so long that it counts, within what is shown."""
        return self.bars(Resting, least=self.least_rest, ee=name)

    def lost(self, *names: str) -> tuple[Span, ...]:
        """When a body of those was not tracked, within what is shown."""
        first, last = self.span
        gaps = self.seen.explainer.measured.lost
        return tuple(
            Span(self.at(max(begin, first)), self.at(min(end, last)), self.called(name))
            for name in names
            for begin, end in gaps.get(name, ())
            if begin <= last and end >= first
        )

    def inside(self, frame: int) -> bool:
        """Whether a frame is shown."""
        return self.span[0] <= frame <= self.span[1]

    def is_object(self, name: str) -> bool:
        """Whether it is a thing, whose motion counts, and no end-effector."""
        return name in self.seen.measurements.bodies.objects

    def floor(self, body: str) -> Limit:
        """From where on a thing counts as moved, and up to where an end-effector rests."""
        floor_m = self.seen.measurements.calibration.body(body).motion_floor_m
        return Limit(CENTI * floor_m, self._of_rest(body).format(length(floor_m)))

    def turn_floor(self, body: str) -> Limit:
        """The same of the angle by which it is turned."""
        degrees_ = math.degrees(self.seen.measurements.calibration.body(body).motion_floor_rad)
        return Limit(degrees_, self._of_rest(body).format(f"{degrees_:.0f}°"))

    def _of_rest(self, body: str) -> str:
        return "counts as moved from {}" if self.is_object(body) else "a rest is within {}"
