"""Rows of a picture, put on one pair of axes: seconds to the right, inches downward."""

from collections.abc import Collection, Iterator, Sequence
from typing import TYPE_CHECKING, Any
from zlib import crc32

import numpy as np

from capar.model.par import UNKNOWN
from capar.views.lettering import Placed, Span, place
from capar.views.rows import Kind, Row

if TYPE_CHECKING:
    from matplotlib.axes import Axes

INK, QUIET, FAINT = "#1a1a1a", "#5c5c5c", "#d9d9d9"
CONTACT, MOTION, SPEED = "#4477AA", "#CCBB44", "#333333"
COLOURS = {
    "LookAt": "#FFAABB",
    "MoveObj": "#EE8866",
    "MoveObjTo": "#EEDD88",
    "PostureChange": "#C9A6DE",
    "Reach": "#77AADD",
    "Rest": "#DDDDDD",
    "ResumePosture": "#BBCC33",
    "Touch": "#44BB99",
}
"""The colour of each most general kind of action: light, under dark letters, and such that people
who are colour-blind can tell them apart (P. Tol)."""

OTHERS = ("#99DDFF", "#AAAA00", "#D9B99B", "#B7C9A6")
"""Colours of kinds that only a user's rules have, by their names."""

PALE = ("#BBCCEE", "#CCDDAA", "#FFCCCC", "#EEEEBB", "#CCEEFF", "#DDDDDD")
"""Paler ones, for what is looked at, by its place in the alphabet (P. Tol)."""

UNNAMED: dict[str, Any] = {"facecolor": "white", "edgecolor": QUIET, "linestyle": "--"}
"""How a segment looks that no rule names."""

HEIGHTS_IN = {
    Kind.HEADING: 0.34,
    Kind.SEGMENTS: 0.36,
    Kind.TICKS: 0.2,
    Kind.BARS: 0.2,
    Kind.MOTION: 0.2,
    Kind.NAMES: 0.24,
    Kind.CURVE: 0.8,
}
LOST: dict[str, Any] = {"facecolor": "none", "edgecolor": QUIET, "hatch": "/////", "linewidth": 0}
"""How frames look in which tracking had lost a body."""

LABEL_ROW_IN = 0.17
LINK_GAP_IN = 0.2
FOOT_IN = 0.06
"""Room between the last row and the time axis [inches]."""
POINTS = {Kind.SEGMENTS: 9.0, Kind.NAMES: 8.0}
ROWS_ABOVE = {Kind.SEGMENTS: 2, Kind.NAMES: 0}
THINNEST_IN = 0.02
"""A shorter bar is drawn this wide, so that it can be seen."""


class Painter:
    """The rows with their places and colours, ready to be painted.

    Attributes:
        width: Of the axes [inches].
        height: Of the axes [inches].
        legend: What each colour means, with its look; what is looked at where some of it found
            no room.
    """

    def __init__(self, rows: Sequence[Row], duration_s: float, width_in: float) -> None:
        self.width = width_in
        self.duration_s = duration_s
        self._rows = tuple(rows)
        self._seen = sorted(_labels(rows, Kind.NAMES))
        self._placed = {index: self._place(row) for index, row in enumerate(rows)}
        self._tops = self._stack()
        self.height = self._tops[-1] + FOOT_IN
        self.legend = self._legend()
        self._fastest = max((_peak(each) for each in rows), default=0.0)

    def look(self, span: Span, kind: Kind) -> dict[str, Any]:
        """The colours of a bar in a row of that kind; hatching means lost tracking alone."""
        if kind is Kind.NAMES:
            colour = PALE[self._seen.index(span.label) % len(PALE)]
        elif span.label == UNKNOWN:
            return {**UNNAMED, "linewidth": 0.8}
        else:
            colour = colour_of(span.kind or span.label)
        return {"facecolor": colour, "edgecolor": "white", "linewidth": 0.8}

    def paint(self, axes: "Axes") -> None:
        """Put everything on the axes."""
        axes.set_xlim(0.0, self.duration_s)
        axes.set_ylim(self.height, 0.0)
        self._frame(axes)
        for index, row in enumerate(self._rows):
            top, low = self._tops[index], self._tops[index + 1]
            self._borders(axes, row, top, low)
            {
                Kind.HEADING: self._heading,
                Kind.SEGMENTS: self._segments,
                Kind.TICKS: self._ticks,
                Kind.BARS: self._bars,
                Kind.MOTION: self._bars,
                Kind.NAMES: self._looks,
                Kind.CURVE: self._curve,
            }[row.kind](axes, index, low)

    def _legend(self) -> tuple[tuple[str, dict[str, Any]], ...]:
        kinds: dict[str, set[str]] = {}
        for span in _spans(self._rows, Kind.SEGMENTS):
            kinds.setdefault(span.kind or span.label, set()).add(span.label)
        ordered = sorted(kinds, key=lambda each: (each == UNKNOWN, each))
        out = [
            (_with_names(kind, kinds[kind] - {kind}), Span(0.0, 0.0, kind, kind), Kind.SEGMENTS)
            for kind in ordered
        ]
        if any(
            row.kind is Kind.NAMES and any(each.row < 0 for each in self._placed[index])
            for index, row in enumerate(self._rows)
        ):
            looked = (Span(0.0, 0.0, name) for name in self._seen)
            out += [(f"looks at {each.label}", each, Kind.NAMES) for each in looked]
        return tuple((text, self.look(span, kind)) for text, span, kind in out)

    @property
    def _seconds_per_inch(self) -> float:
        return self.duration_s / self.width

    def _place(self, row: Row) -> tuple[Placed, ...]:
        if row.kind not in POINTS:
            return ()
        return place(
            row.spans,
            seconds_per_inch=self._seconds_per_inch,
            range_s=(0.0, self.duration_s),
            points=POINTS[row.kind],
            rows_above=ROWS_ABOVE[row.kind],
        )

    def _stack(self) -> list[float]:
        """Upper edge of each row, and the lower edge of the last."""
        tops = [0.0]
        for index, row in enumerate(self._rows):
            above = max((each.row for each in self._placed[index]), default=0)
            gap = LINK_GAP_IN if row.kind is Kind.SEGMENTS and index else 0.0
            tops.append(tops[-1] + gap + HEIGHTS_IN[row.kind] + LABEL_ROW_IN * max(above, 0))
        return tops

    def _frame(self, axes: "Axes") -> None:
        for side in ("top", "left", "right"):
            axes.spines[side].set_visible(False)
        axes.spines["bottom"].set_color(QUIET)
        axes.set_yticks([])
        axes.tick_params(axis="x", colors=QUIET, labelsize=9, length=3)
        axes.set_xlabel("time [s]", fontsize=9, color=QUIET, labelpad=2)
        axes.grid(axis="x", color=FAINT, linewidth=0.5)
        axes.set_axisbelow(True)

    def _borders(self, axes: "Axes", row: Row, top: float, low: float) -> None:
        if row.kind is not Kind.SEGMENTS:
            axes.vlines(row.borders, top, low, colors="#a6a6a6", linewidth=0.6, zorder=0.9)

    def _name(self, axes: "Axes", text: str, y: float, **style: Any) -> None:
        axes.annotate(
            text,
            (0.0, y),
            xytext=(-8, 0),
            textcoords="offset points",
            ha="right",
            va="center",
            annotation_clip=False,
            **{"fontsize": 8.5, "color": QUIET, **style},
        )

    def _box(self, axes: "Axes", span: Span, y: float, tall: float, **look: Any) -> None:
        from matplotlib.patches import Rectangle

        wide = max(span.end_s - span.start_s, THINNEST_IN * self._seconds_per_inch)
        axes.add_patch(Rectangle((span.start_s, y), wide, tall, **look))

    def _heading(self, axes: "Axes", index: int, low: float) -> None:
        self._name(axes, self._rows[index].label, low - 0.1, fontsize=9.5, color=INK, weight="bold")

    def _segments(self, axes: "Axes", index: int, low: float) -> None:
        tall = HEIGHTS_IN[Kind.SEGMENTS] - 0.04
        bar = low - tall - 0.02
        self._name(
            axes, self._rows[index].label, bar + tall / 2, fontsize=9.5, color=INK, weight="bold"
        )
        for placed in self._placed[index]:
            look = self.look(placed.span, Kind.SEGMENTS)
            self._box(axes, placed.span, bar, tall, **look, zorder=2)
            self._letter(axes, placed, bar, tall, Kind.SEGMENTS)

    def _letter(self, axes: "Axes", each: Placed, bar: float, tall: float, kind: Kind) -> None:
        if each.row < 0:
            return
        y = bar + tall / 2 if each.row == 0 else bar - 0.09 - LABEL_ROW_IN * (each.row - 1)
        style: dict[str, Any] = {
            "fontsize": POINTS[kind],
            "color": INK,
            "ha": "center",
            "va": "center",
        }
        axes.text(each.centre_s, y, each.span.label, zorder=4, **style)
        if each.row > 1:
            axes.vlines(each.middle_s, y + 0.07, bar, colors=QUIET, linewidth=0.6, zorder=1)

    def _ticks(self, axes: "Axes", index: int, low: float) -> None:
        row = self._rows[index]
        self._name(axes, row.label, low - 0.1, fontsize=8)
        axes.vlines(row.ticks, low - 0.17, low - 0.05, colors=INK, linewidth=0.8, zorder=3)

    def _bars(self, axes: "Axes", index: int, low: float) -> None:
        row = self._rows[index]
        self._name(axes, row.label, low - 0.1)
        colour = MOTION if row.kind is Kind.MOTION else CONTACT
        for span in row.spans:
            self._box(axes, span, low - 0.16, 0.12, facecolor=colour, zorder=2)
        for span in row.lost:
            self._box(axes, span, low - 0.16, 0.12, **LOST, zorder=2.5)

    def _looks(self, axes: "Axes", index: int, low: float) -> None:
        self._name(axes, self._rows[index].label, low - 0.12)
        for placed in self._placed[index]:
            look = self.look(placed.span, Kind.NAMES)
            self._box(axes, placed.span, low - 0.21, 0.18, **look, zorder=2)
            self._letter(axes, placed, low - 0.21, 0.18, Kind.NAMES)

    def _curve(self, axes: "Axes", index: int, low: float) -> None:
        curve = self._rows[index].curve
        assert curve is not None, "a row of this kind is made with its curve"
        tall = HEIGHTS_IN[Kind.CURVE] - 0.12
        times, speeds = curve
        heights = low - 0.02 - np.asarray(speeds) / (self._fastest or 1.0) * tall
        axes.plot(times, heights, color=SPEED, linewidth=1.0, zorder=3)
        axes.hlines(low - 0.02, 0.0, self.duration_s, colors=FAINT, linewidth=0.6, zorder=1)
        self._name(axes, f"{self._fastest:.2g} m/s", low - 0.02 - tall, fontsize=7.5)
        self._name(axes, self._rows[index].label, low - 0.02 - tall / 2)
        self._name(axes, "0", low - 0.03, fontsize=7.5)


def colour_of(kind: str) -> str:
    """The colour of a kind of action: the same in every picture."""
    return COLOURS.get(kind) or OTHERS[crc32(kind.encode()) % len(OTHERS)]


def _with_names(kind: str, names: Collection[str]) -> str:
    """A kind of action, and what else of that kind there is: ``MoveObj (Carry, Drink)``."""
    return f"{kind} ({', '.join(sorted(names))})" if names else kind


def _spans(rows: Sequence[Row], kind: Kind) -> Iterator[Span]:
    return (each for row in rows if row.kind is kind for each in row.spans)


def _labels(rows: Sequence[Row], kind: Kind) -> set[str]:
    return {each.label for each in _spans(rows, kind)}


def _peak(row: Row) -> float:
    """The highest speed of a row [m/s]; zero where it has none."""
    if row.curve is None or not np.isfinite(row.curve[1]).any():
        return 0.0
    return float(np.nanmax(row.curve[1]))
