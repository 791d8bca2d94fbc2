"""The quantities of an explanation over time: a panel each, with limits and intervals of facts."""

from dataclasses import dataclass
from pathlib import Path
from textwrap import wrap
from typing import TYPE_CHECKING

import numpy as np
from jaxtyping import Float

from capar.views.picture import INK, QUIET, save

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

WIDTH_IN, PANEL_IN, HEAD_IN, LINE_IN = 11.0, 1.7, 0.9, 0.17
"""Width of the picture, heights of a panel, of the segments above, and of a line of text [in]."""

LETTERS = 130
"""So many letters of the summary stand in a line [1]."""

CURVE, LIMIT, HELD, SHADE = "#1f5a7a", "#a33", "#7ab", "#f4efe2"
"""Colours of curves, limits, intervals, and of the time of the segment."""


@dataclass(frozen=True, eq=False)
class Panel:
    """A quantity over time."""

    title: str
    times: Float[np.ndarray, "samples"]
    """Seconds since the first frame."""

    values: Float[np.ndarray, "samples"]
    """NaN where a body was lost."""

    unit: str
    limits: tuple[tuple[float, str], ...] = ()
    """Values with which it is compared, and how."""

    marks: tuple[tuple[float, float, str], ...] = ()
    """Times and values that conditions state, and how they are written."""

    bars: tuple[tuple[float, float], ...] = ()
    """From when to when something holds [s]."""

    held: str = ""
    """What holds there."""


@dataclass(frozen=True, eq=False)
class Plot:
    """All that is drawn of an explanation."""

    title: str
    summary: str
    span: tuple[float, float]
    """The first and the last time that are shown [s]."""

    segment: tuple[float, float]
    """The start and the end of the explained segment [s]."""

    segments: tuple[tuple[float, float, str], ...]
    """Those of its end-effector: start, end and name."""

    panels: tuple[Panel, ...]


def draw_explanation(plot: Plot, path: Path) -> None:
    """Draw quantities to a PNG, SVG or PDF file; the same plot gives the same bytes.

    Raises:
        FileError: The suffix is another one, or the file cannot be written.
    """
    save(lambda: _figure(plot), path)


def _figure(plot: Plot) -> "Figure":
    import matplotlib as mpl
    from matplotlib.figure import Figure

    mpl.rcParams["font.size"] = 9  # within the settings of the picture
    lines = wrap(plot.summary, LETTERS)
    head = HEAD_IN + LINE_IN * (len(lines) + 1)
    height = head + PANEL_IN * len(plot.panels) + 0.4
    figure = Figure(figsize=(WIDTH_IN, height))
    figure.text(0.06, 1.0 - 0.22 / height, plot.title, weight="bold", size=11)
    figure.text(0.06, 1.0 - 0.32 / height, "\n".join(lines), va="top", color=INK)
    ratios = [0.35 / PANEL_IN, *[1.0] * len(plot.panels)]
    axes = figure.subplots(
        len(ratios), 1, sharex=True, squeeze=False, gridspec_kw={"height_ratios": ratios}
    )[:, 0]
    top = 1.0 - (head - 0.3) / height
    figure.subplots_adjust(left=0.06, right=0.97, top=top, bottom=0.4 / height, hspace=0.55)
    _draw_segments(axes[0], plot)
    for panel, at in zip(plot.panels, axes[1:], strict=True):
        _draw_panel(at, panel, plot)
    axes[-1].set_xlim(*plot.span)
    axes[-1].set_xlabel("time [s]")
    return figure


def _draw_segments(at: "Axes", plot: Plot) -> None:
    at.set_ylim(0.0, 1.0)
    at.axis("off")
    for start, end, name in plot.segments:
        own = (start, end) == plot.segment
        at.axvspan(start, end, facecolor=SHADE if own else "white", edgecolor=QUIET)
        first, last = max(start, plot.span[0]), min(end, plot.span[1])
        room = LETTERS * (last - first) / (plot.span[1] - plot.span[0])
        if len(name) < room:  # a name that would run into the next one is left out
            weight = "bold" if own else "normal"
            at.text(0.5 * (first + last), 0.5, name, ha="center", va="center", weight=weight)


def _draw_panel(at: "Axes", panel: Panel, plot: Plot) -> None:
    at.axvspan(*plot.segment, facecolor=SHADE)
    at.plot(panel.times, panel.values, color=CURVE, linewidth=1.2)
    for number, (start, end) in enumerate(panel.bars):
        label = panel.held if not number else None
        at.axvspan(start, end, ymax=0.07, facecolor=HELD, label=label)
    for value, label in panel.limits:
        at.axhline(value, color=LIMIT, linestyle="--", linewidth=0.9, label=label)
    for time, value, label in panel.marks:
        at.plot([time], [value], "o", color=INK, markersize=4)
        at.annotate(label, (time, value), xytext=(4, 4), textcoords="offset points")
    at.set_title(panel.title, loc="left", size=9, pad=3)
    at.set_ylabel(panel.unit)
    at.margins(y=0.2)
    if panel.limits or panel.bars:
        at.legend(loc="best", fontsize=7, framealpha=0.7)
