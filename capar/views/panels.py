"""What was measured for an explanation, as panels over time, before any of it is drawn."""

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from capar.views.lettering import Span

EDGE = 0.05
"""Which part of the room above is left where curves go on beyond what is shown [1]."""

PADDING = 0.15
"""Room above and below what a panel shows, as a share of it [1]."""


@dataclass(frozen=True)
class Curve:
    """A quantity over time."""

    times: Float[np.ndarray, "samples"]
    """Seconds since the first frame, increasing."""

    values: Float[np.ndarray, "samples"]
    """In the panel's unit; NaN where a body was lost."""

    label: str = ""
    """What it is, where a panel has several."""


@dataclass(frozen=True)
class Limit:
    """A value from which on, or up to which, something counts."""

    value: float
    """In the panel's unit."""

    label: str


@dataclass(frozen=True)
class Mark:
    """A number that a sentence tells, where it was measured."""

    time: float
    """Seconds since the first frame."""

    value: float
    """In the panel's unit."""

    label: str = ""
    """The number as the sentence tells it."""


Held = tuple[str, ...]
"""What holds where a bar is: the predicate of facts, and the bodies that they are about, sorted."""


@dataclass(frozen=True)
class Row:
    """When something held, without a number."""

    label: str
    bars: tuple[Span, ...]
    held: Held = ()


@dataclass(frozen=True)
class Panel:
    """One quantity of one body, or of two, over time."""

    title: str
    unit: str
    curves: tuple[Curve, ...]
    limits: tuple[Limit, ...] = ()
    marks: tuple[Mark, ...] = ()
    bars: tuple[Span, ...] = ()
    """When something counts as holding, such as contact, as the rules read it."""

    bars_label: str = ""
    """What holds then."""

    held: Held = ()
    """The same as facts have it: a row of bars that says no more is left out."""

    unheld: str = ""
    """What is said of bars where there are none; else nothing is."""

    highest: float = np.inf
    """What is greater is not shown, in the panel's unit."""

    beyond: str = "what is further"
    """What is greater than that, in words."""

    lost: tuple[Span, ...] = ()
    """When a body of it was not tracked, by its name."""

    span_s: tuple[float, float] | None = None
    """The first and the last time of it [s], where it shows others than the picture."""

    @property
    def shows(self) -> frozenset[Held]:
        """What its bars and its hatching show, at all times of the picture."""
        if self.span_s is not None:
            return frozenset()
        bars = [self.held] if self.held and (self.bars or self.unheld) else []
        return frozenset([*bars, *(("lost", gap.label) for gap in self.lost)])

    def range(self, start_s: float, end_s: float) -> tuple[float, float]:
        """The lowest and highest value that are drawn: of the curves in a span, and all else."""
        shown = [
            values
            for curve in self.curves
            for values in curve.values[(curve.times >= start_s) & (curve.times <= end_s)]
        ]
        limits, marks = (limit.value for limit in self.limits), (mark.value for mark in self.marks)
        values = [*shown, *limits, *marks]
        known = [min(value, self.highest) for value in values if np.isfinite(value)]
        low, high = min(known, default=0.0), max(known, default=1.0)
        room = PADDING * ((high - low) or abs(high) or 1.0)
        cut_off = high == self.highest
        return low - room, high + room * (EDGE if cut_off else 1.0)

    def leaves(self, start_s: float, end_s: float, span_s: tuple[float, float]) -> bool:
        """Whether a curve goes beyond what is drawn for a segment, at any time that is drawn."""
        low, high = self.range(start_s, end_s)
        return any(
            bool(((shown < low) | (shown > high)).any())
            for curve in self.curves
            for shown in [curve.values[(curve.times >= span_s[0]) & (curve.times <= span_s[1])]]
        )
