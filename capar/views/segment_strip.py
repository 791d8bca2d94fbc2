"""The strip of segments above what was measured: the explained one among its neighbours."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

from capar.views.lettering import Placed, Span, place, shortened
from capar.views.picture import INK, QUIET, UNNAMED, colour_of

if TYPE_CHECKING:
    from matplotlib.axes import Axes

STRIP_IN, NAME_IN = 0.3, 0.18
"""Heights of the bars, and of a row of names above them [inches]."""

NAME_PT, BOLD_PT = 9.0, 10.5
"""Size of names, and of letters that are as wide as bold ones of that size [points]."""

LEAST_LETTERS = 4
"""A name that is cut to fewer letters is left out."""


@dataclass(frozen=True)
class Strip:
    """Segments within a span of time, with the place of each name."""

    names: tuple[Placed, ...]
    """The explained one first."""

    scale: float
    """Width of a second [inches]."""

    @property
    def rows(self) -> int:
        """How many rows of names stand above the bars."""
        return max((name.row for name in self.names), default=0) if self.names else 0

    @property
    def height(self) -> float:
        """Of all of it [inches]."""
        return STRIP_IN + NAME_IN * max(self.rows, 0)


def strip(
    segments: Sequence[Span], chosen: Span, span_s: tuple[float, float], *, width_in: float
) -> Strip:
    """Place names inside their bars, else above, where it is plain whose they are.

    Args:
        segments: The segments, of which some may lie outside of the span.
        chosen: The explained one, whose name is placed first.
        span_s: The first and the last time that are shown [s].
        width_in: How wide the strip is [inches].
    """
    scale = width_in / (span_s[1] - span_s[0])
    shown = [
        replace(one, start_s=max(one.start_s, span_s[0]), end_s=min(one.end_s, span_s[1]))
        for one in sorted(segments, key=lambda one: not _same(one, chosen))
        if max(one.start_s, span_s[0]) < min(one.end_s, span_s[1])
    ]
    places = place(
        shown, seconds_per_inch=1.0 / scale, range_s=span_s, points=BOLD_PT, rows_above=2
    )
    return Strip(places, scale)


def draw_strip(axes: "Axes", shown: Strip) -> None:
    """Draw the bars, and their names where they were placed."""
    from matplotlib.patches import Rectangle

    axes.set_ylim(0.0, shown.height)
    axes.axis("off")
    for index, name in enumerate(shown.names):
        span, own = name.span, index == 0
        known = {"facecolor": colour_of(span.kind or span.label), "edgecolor": "white"}
        look = UNNAMED if span.kind == "Unknown" else known
        size = span.end_s - span.start_s, STRIP_IN
        alpha = 1.0 if own else 0.45
        axes.add_patch(Rectangle((span.start_s, 0.0), *size, **look, linewidth=0.8, alpha=alpha))
        _name(axes, name, shown.scale, own=own)


def _name(axes: "Axes", name: Placed, scale: float, *, own: bool) -> None:
    """A name inside its bar, or above it with a line to it, or as much of it as its bar holds."""
    label, x, y = name.span.label, name.centre_s, STRIP_IN / 2.0
    if name.row < 0:
        room = max((name.span.end_s - name.span.start_s) * scale - 0.06, 0.0)
        label = shortened(label, points=NAME_PT, widest_in=room)
        if len(label) < LEAST_LETTERS:
            return
        x = name.middle_s
    elif name.row > 0:
        y = STRIP_IN + (name.row - 0.4) * NAME_IN
        foot = STRIP_IN + (name.row - 1) * NAME_IN + 0.03
        colour = INK if own else QUIET
        axes.plot([name.middle_s] * 2, [STRIP_IN, foot], color=colour, linewidth=0.7, clip_on=False)
    axes.text(
        x,
        y,
        label,
        fontsize=NAME_PT,
        color=INK if own else QUIET,
        weight="bold" if own else "normal",
        ha="center",
        va="center",
    )


def _same(one: Span, other: Span) -> bool:
    return (one.start_s, one.end_s) == (other.start_s, other.end_s)
