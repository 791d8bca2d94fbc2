"""One quantity over time, drawn: its curves, its limits, and the numbers that are told of it."""

import re
from collections.abc import Sequence
from textwrap import wrap
from typing import TYPE_CHECKING

import numpy as np

from capar.views.lettering import POINTS_PER_INCH, Span, width_in
from capar.views.painter import CONTACT, FAINT, INK, QUIET, SPEED
from capar.views.panels import Mark, Panel

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.patheffects import AbstractPathEffect

SHADE = "#FFF3C4"
LIMIT, MARK = "#AA3377", "#CC3311"
"""Colours of limits and of numbers, which people who are colour-blind can tell apart (P. Tol)."""

BAR_SHARE = 0.07
"""How high a bar is at the foot of a panel, as a share of it [1]."""

CAPTION_PT, LIMIT_PT, MARK_PT = 9.0, 7.5, 8.5
"""Sizes of the letters of captions, of the names of limits, and of numbers [points]."""

BESIDE_PT = 5.0
"""How far the number of a mark is beside it [points]."""

LIMIT_LETTERS = 23
"""So many letters of a limit's name stand in one line beside the panel."""

LIMIT_LINE = 0.135
"""How high such a line is, as a share of the panel [1]."""

_BEFORE_UNIT = re.compile(r"(?<=\d) (?=(?:mm|cm|m|s)\b|%)")


Box = tuple[float, float, float, float]
"""Left, right, bottom and top [inches]."""


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
    marks = sorted(dict.fromkeys(panel.marks), key=lambda mark: (mark.time, mark.value))
    for mark, (left, upper) in zip(marks, _sides(axes, marks), strict=True):
        axes.plot([mark.time], [mark.value], "o", color=MARK, markersize=5, zorder=4, clip_on=False)
        _mark(axes, mark, left=left, upper=upper)
    _bars(axes, panel, low, high)


def together(text: str) -> str:
    """The same, with no line to begin between a number and its unit."""
    return _BEFORE_UNIT.sub("\u00a0", text)


def caption_lines(
    panel: Panel, chosen: Span, span_s: tuple[float, float], widest_in: float
) -> list[str]:
    """What the panel shows, and what its bars and its dashed curve are, in lines so wide.

    Args:
        panel: The panel.
        chosen: The segment, of which all is shown.
        span_s: The first and the last time that are drawn [s].
        widest_in: Width of a line [inches].
    """
    notes = [f"{curve.label}: dashed" for curve in panel.curves[1:] if curve.label]
    notes += [f"blue: {panel.bars_label}"] if panel.bars else []
    notes += ["hatched: not tracked"] if panel.lost else []
    if any(np.nanmax(curve.values, initial=-np.inf) > panel.highest for curve in panel.curves):
        notes.append(f"{panel.beyond} is cut off")
    elif panel.leaves(chosen.start_s, chosen.end_s, span_s):
        notes.append("cut off outside of the segment")
    if panel.span_s is not None:
        first, last = panel.span_s
        notes.append(f"its own axis of time, from {first:.2f} to {last:.2f} s")
    text = f"{panel.title} [{panel.unit}]" + f" ({'; '.join(notes)})" * bool(notes)
    letters = len(text) * widest_in / max(width_in(text, points=CAPTION_PT), 1e-6)
    return wrap(together(text), max(int(0.97 * letters), 20))


def draw_caption(axes: "Axes", lines: Sequence[str]) -> None:
    """Write the lines of a caption above a panel."""
    axes.annotate(
        "\n".join(lines),
        (0.0, 1.0),
        xycoords="axes fraction",
        xytext=(0, 4),
        textcoords="offset points",
        fontsize=CAPTION_PT,
        color=INK,
        va="bottom",
    )


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
            arrowprops={"arrowstyle": "-", "color": LIMIT, "linewidth": 0.6, "shrinkA": 0.0},
            annotation_clip=False,
        )


def _spread(at: Sequence[float], texts: Sequence[Sequence[str]]) -> list[float]:
    """Heights of the names of limits, from the lowest, so that none stands on another one."""
    half = [0.5 * LIMIT_LINE * len(lines) for lines in texts]
    out: list[float] = []
    for index, wanted in enumerate(at):
        least = out[-1] + half[index - 1] + half[index] if out else -np.inf
        out.append(max(wanted, least))
    over = max(out[-1] + half[-1] - 1.03, 0.0) if out else 0.0
    return [height - min(over, 0.5) for height in out]


def _mark(axes: "Axes", mark: Mark, *, left: bool, upper: bool) -> None:
    """The number of a mark, left or right of it, above or below."""
    axes.annotate(
        mark.label,
        (mark.time, mark.value),
        xytext=(-BESIDE_PT if left else BESIDE_PT, 3 if upper else -3),
        textcoords="offset points",
        fontsize=MARK_PT,
        weight="bold",
        color=MARK,
        ha="right" if left else "left",
        va="bottom" if upper else "top",
        path_effects=_halo(),
        zorder=6,
    )


def _sides(axes: "Axes", marks: Sequence[Mark]) -> list[tuple[bool, bool]]:
    """For each mark whether its number stands left of it, and whether above it.

    A number stands at the right, where it is on no other number and no other mark, and inside the
    panel; at the other sides where that is better.
    """
    dots = [_inches(axes, mark) for mark in marks]
    size = axes.bbox.width / axes.figure.dpi, axes.bbox.height / axes.figure.dpi
    taken: list[Box] = []
    out: list[tuple[bool, bool]] = []
    for mark, dot in zip(marks, dots, strict=True):
        above = dot[1] < 0.75 * size[1]
        boxes = {
            (left, upper): _box(mark, dot, left=left, upper=upper)
            for upper in (above, not above)
            for left in (False, True)
        }
        others = [*taken, *((x, x, y, y) for x, y in dots if (x, y) != dot)]
        faults = {side: _faults(box, others, size) for side, box in boxes.items()}
        best = min(faults, key=lambda side: faults[side])
        taken.append(boxes[best])
        out.append(best)
    return out


def _faults(box: Box, others: Sequence[Box], size: tuple[float, float]) -> int:
    """How many others a number would stand on, twice, and once that it goes over the top.

    It is never to go over the edge at a side.
    """
    aside = box[0] < 0.0 or box[1] > size[0]
    beyond = box[2] < 0.0 or box[3] > size[1]
    return 2 * sum(_meet(box, other) for other in others) + 99 * aside + beyond


def _inches(axes: "Axes", mark: Mark) -> tuple[float, float]:
    """Where a mark stands, from the lower left corner of the panel [inches]."""
    x, y = axes.transData.transform((mark.time, mark.value))
    return (x - axes.bbox.x0) / axes.figure.dpi, (y - axes.bbox.y0) / axes.figure.dpi


def _box(mark: Mark, dot: tuple[float, float], *, left: bool, upper: bool) -> Box:
    """What the number of a mark covers there [inches]."""
    beside = BESIDE_PT / POINTS_PER_INCH
    wide = 1.2 * width_in(mark.label, points=MARK_PT)
    tall = 1.2 * MARK_PT / POINTS_PER_INCH
    x = dot[0] - beside - wide if left else dot[0] + beside
    y = dot[1] + 0.04 if upper else dot[1] - 0.04 - tall
    return x, x + wide, y, y + tall


def _meet(one: Box, other: Box) -> bool:
    return one[0] <= other[1] and other[0] <= one[1] and one[2] <= other[3] and other[2] <= one[3]


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
