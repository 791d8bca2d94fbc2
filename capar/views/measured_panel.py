"""One quantity over time, drawn: its curves, its limits, and the numbers that are told of it."""

from collections.abc import Sequence
from textwrap import wrap
from typing import TYPE_CHECKING

import numpy as np

from capar.views.captions import together
from capar.views.lettering import POINTS_PER_INCH, Span, width_in
from capar.views.number_places import Box, Drawn, is_led, place_numbers
from capar.views.panels import Mark, Panel
from capar.views.picture import CONTACT, FAINT, QUIET, SPEED

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.patheffects import AbstractPathEffect

SHADE = "#FFF3C4"
LIMIT, MARK = "#AA3377", "#CC3311"
"""Colours of limits and of numbers, which people who are colour-blind can tell apart (P. Tol)."""

BAR_SHARE = 0.07
"""How high a bar is at the foot of a panel, as a share of it [1]."""

LIMIT_PT, MARK_PT = 7.5, 8.5
"""Sizes of the letters of the names of limits, and of numbers [points]."""

LIMIT_LETTERS = 23
"""So many letters of a limit's name stand in one line beside the panel."""

LIMIT_LINE = 0.135
"""How high such a line is, as a share of the panel [1]."""


def draw_panel(axes: "Axes", panel: Panel, chosen: Span, span_s: tuple[float, float]) -> None:
    """Draw a quantity over some time, in which a segment lies."""
    low, high = panel.range(chosen.start_s, chosen.end_s)
    if panel.bars:
        low -= 2.0 * BAR_SHARE * (high - low)
    axes.set_ylim(low, high)
    axes.axvspan(chosen.start_s, chosen.end_s, color=SHADE, zorder=0)
    for gap in panel.lost:
        axes.axvspan(
            gap.start_s, gap.end_s, facecolor="none", edgecolor=QUIET, hatch="////", alpha=0.5
        )
    for side in ("top", "right"):
        axes.spines[side].set_visible(False)
    for side in ("left", "bottom"):
        axes.spines[side].set_color(QUIET)
    axes.tick_params(colors=QUIET, labelsize=8, length=3)
    axes.locator_params(axis="y", nbins=4)
    axes.grid(color=FAINT, linewidth=0.5)
    axes.set_axisbelow(True)
    for number, curve in enumerate(panel.curves):
        axes.plot(
            curve.times,
            curve.values,
            color=SPEED,
            linewidth=1.2,
            linestyle="--" if number else "-",
            zorder=3,
        )
    for limit in panel.limits:
        axes.axhline(limit.value, color=LIMIT, linewidth=0.9, linestyle=(0, (4, 2)), zorder=2.5)
    _limits(axes, panel, low, high)
    axes.set_xlim(*span_s)
    _numbers(axes, panel, low, high)
    _bars(axes, panel, low, high)


def _limits(axes: "Axes", panel: Panel, low: float, high: float) -> None:
    """The name of each limit right of the panel, beside its line, and clear of the others."""
    named = sorted(panel.limits, key=lambda limit: limit.value)
    texts = [wrap(together(limit.label), LIMIT_LETTERS) for limit in named]
    at = [(limit.value - low) / (high - low) for limit in named]
    for limit, lines, middle in zip(named, texts, _spread(at, texts), strict=True):
        axes.annotate(
            "\n".join(lines),
            (1.0, limit.value),
            xycoords=("axes fraction", "data"),
            xytext=(1.02, middle),
            textcoords="axes fraction",
            fontsize=LIMIT_PT,
            color=LIMIT,
            ha="left",
            va="center",
            arrowprops={
                "arrowstyle": "-",
                "color": LIMIT,
                "linewidth": 0.6,
                "shrinkA": 0.0,
                "shrinkB": 0.0,
                "relpos": (0.0, 0.5),  # to the middle of its left side
            },
            annotation_clip=False,
        )


def _spread(at: Sequence[float], texts: Sequence[Sequence[str]]) -> list[float]:
    """Heights of the names of limits, from the lowest, so that none stands on another one."""
    half = [0.5 * LIMIT_LINE * len(lines) for lines in texts]
    out: list[float] = []
    for index, wanted in enumerate(at):
        least = out[-1] + half[index - 1] + half[index] if out else -np.inf
        out.append(max(wanted, least))
    if not out:
        return []
    over = max(out[-1] + half[-1] - 1.03, 0.0)
    room = max(out[0] - half[0] + 0.03, 0.0)
    pushed = float(np.mean(out) - np.mean(at))
    down = max(min(over, 0.5), min(pushed, room))
    return [height - down for height in out]


def _numbers(axes: "Axes", panel: Panel, low: float, high: float) -> None:
    """Each mark with its number, where that hides nothing; far from its mark with a line to it."""
    marks = sorted(dict.fromkeys(panel.marks), key=lambda mark: (mark.time, mark.value))
    dots = [_inches(axes, mark.time, mark.value) for mark in marks]
    sizes = [_size(mark) for mark in marks]
    places = place_numbers(dots, sizes, _drawn(axes, panel, low, high))
    for mark, dot, box in zip(marks, dots, places, strict=True):
        axes.plot([mark.time], [mark.value], "o", color=MARK, markersize=5, zorder=4, clip_on=False)
        led = {"arrowstyle": "-", "color": MARK, "linewidth": 0.6, "shrinkA": 0.0, "shrinkB": 2.0}
        axes.annotate(
            mark.label,
            (mark.time, mark.value),
            xytext=(POINTS_PER_INCH * box[0], POINTS_PER_INCH * box[2]),
            textcoords="axes points",
            fontsize=MARK_PT,
            weight="bold",
            color=MARK,
            ha="left",
            va="bottom",
            arrowprops=led if mark.label and is_led(box, dot) else None,
            path_effects=_halo(),
            zorder=6,
        )


def _size(mark: Mark) -> tuple[float, float]:
    """Width and height of the number of a mark [inches]."""
    return 1.18 * width_in(mark.label, points=MARK_PT), 1.2 * MARK_PT / POINTS_PER_INCH


def _inches(axes: "Axes", time: float, value: float) -> tuple[float, float]:
    """Where that is, from the lower left corner of the panel [inches]."""
    x, y = axes.transData.transform((time, value))
    return (x - axes.bbox.x0) / axes.figure.dpi, (y - axes.bbox.y0) / axes.figure.dpi


def _drawn(axes: "Axes", panel: Panel, low: float, high: float) -> Drawn:
    """Lines, bars and gaps of a panel, as places in it."""
    corner, dpi = np.array([axes.bbox.x0, axes.bbox.y0]), axes.figure.dpi

    def box(span: Span, bottom: float, top: float) -> Box:
        (left, under), (right, over) = (
            _inches(axes, span.start_s, bottom),
            _inches(axes, span.end_s, top),
        )
        return left, right, under, over

    tall = BAR_SHARE * (high - low)
    return Drawn(
        (axes.bbox.width / dpi, axes.bbox.height / dpi),
        tuple(
            (axes.transData.transform(np.column_stack([curve.times, curve.values])) - corner) / dpi
            for curve in panel.curves
        ),
        tuple(_inches(axes, 0.0, limit.value)[1] for limit in panel.limits),
        tuple(box(bar, low + 0.3 * tall, low + 1.3 * tall) for bar in panel.bars),
        tuple(box(gap, low, high) for gap in panel.lost),
    )


def _halo() -> "list[AbstractPathEffect]":
    """A white edge of letters, so that they can be read over curves."""
    from matplotlib.patheffects import withStroke

    return [withStroke(linewidth=2.5, foreground="white")]


def _bars(axes: "Axes", panel: Panel, low: float, high: float) -> None:
    from matplotlib.patches import Rectangle

    tall = BAR_SHARE * (high - low)
    for bar in panel.bars:
        axes.add_patch(
            Rectangle(
                (bar.start_s, low + 0.3 * tall),
                bar.end_s - bar.start_s,
                tall,
                facecolor=CONTACT,
                zorder=2,
            )
        )
