"""A picture of what an explanation says: the segment in time, and each quantity below it."""

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from textwrap import wrap
from typing import TYPE_CHECKING

import numpy as np

from capar.views.lettering import Span, shortened, width_in
from capar.views.painter import CONTACT, FAINT, INK, QUIET, SPEED, UNNAMED, colour_of
from capar.views.panels import Mark, Panel, Row
from capar.views.picture import save

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure
    from matplotlib.patheffects import AbstractPathEffect

WIDTH_IN = 10.0
LEFT_IN, RIGHT_IN, EDGE_IN = 0.75, 0.3, 0.25
PANEL_IN, CAPTION_IN, STRIP_IN = 0.95, 0.34, 0.3
"""Heights of a panel, of the caption above it, and of the strip of segments [inches]."""

CAPTION_WIDE_IN = WIDTH_IN - LEFT_IN - RIGHT_IN
"""How wide a caption in letters of the usual size may be [inches]; longer ones get smaller."""

FOOT_IN = 0.55
ROW_IN, GAP_IN, TICKS_IN = 0.3, 0.15, 0.2
"""Heights of a row of bars, of the room before it, and of times below a panel [inches]."""

LINE_IN = 0.19
"""Height of a line of the summary [inches]."""

SHADE = "#FFF3C4"
LIMIT, MARK = "#AA3377", "#CC3311"
"""Colours of limits and of numbers, which people who are colour-blind can tell apart (P. Tol)."""

BAR_SHARE = 0.07
"""How high a bar is at the foot of a panel, as a share of it [1]."""


@dataclass(frozen=True, slots=True)
class MeasuredPicture:
    """What a text says of a segment, over time."""

    title: str
    text: str
    """The summary of the explanation."""

    segments: Sequence[Span]
    """The segments of the same end-effector, by their names."""

    chosen: Span
    """The one that is explained."""

    panels: Sequence[Panel]
    """Each quantity that the text speaks of."""

    span_s: tuple[float, float]
    """First and last time that are shown [s]."""

    rows: Sequence[Row] = ()
    """What held when."""


def draw_measured(picture: MeasuredPicture, path: Path) -> None:
    """Draw a picture to a PNG, SVG or PDF file, which is overwritten, as its suffix says."""
    save(lambda: _figure(picture), path, path.suffix.lower())


def _figure(picture: MeasuredPicture) -> "Figure":
    from matplotlib.figure import Figure

    letter = 0.86 * width_in("n" * 20, points=9.5) / 20.0
    lines = [
        line
        for part in picture.text.splitlines()
        for line in wrap(part, int((WIDTH_IN - 0.5) / letter))
    ]
    head = 0.55 + LINE_IN * len(lines) + 0.1
    apart = sum(panel.span_s is not None for panel in picture.panels)
    height = head + STRIP_IN + len(picture.panels) * (CAPTION_IN + PANEL_IN) + FOOT_IN
    height += apart * TICKS_IN + ROW_IN * len(picture.rows) + GAP_IN * bool(picture.rows)
    figure = Figure(figsize=(WIDTH_IN, height), facecolor="white")
    figure.text(
        EDGE_IN / WIDTH_IN,
        1 - 0.2 / height,
        picture.title,
        fontsize=13,
        weight="bold",
        color=INK,
        va="top",
    )
    for number, line in enumerate(lines):
        y = 1 - (0.55 + LINE_IN * number) / height
        figure.text(EDGE_IN / WIDTH_IN, y, line, fontsize=9.5, color=INK, va="top")
    top = head
    span_s, chosen = picture.span_s, picture.chosen
    last, stripped = None, False
    for panel in sorted(picture.panels, key=lambda panel: panel.span_s is None):
        if panel.span_s is None and not stripped:
            top, stripped = _with_strip(figure, top, picture), True
        own = panel.span_s or span_s
        last = _axes(figure, top + CAPTION_IN, PANEL_IN, own)
        _panel(last, panel, chosen, own)
        top += CAPTION_IN + PANEL_IN
        if panel.span_s is None:
            last.tick_params(axis="x", labelbottom=False)
        else:
            top += TICKS_IN
    if not stripped:
        top = _with_strip(figure, top, picture)
    if picture.rows:
        top += GAP_IN
        tall = ROW_IN * len(picture.rows)
        last = _axes(figure, top, tall, span_s)
        _rows(last, picture.rows, chosen)
    if last is not None:
        last.tick_params(axis="x", labelbottom=True)
        last.set_xlabel("time [s]", fontsize=9, color=QUIET, labelpad=2)
    return figure


def _with_strip(figure: "Figure", top_in: float, picture: MeasuredPicture) -> float:
    """Draw the strip of segments above the panels of its own times; where it ends [inches]."""
    axes = _axes(figure, top_in, STRIP_IN, picture.span_s)
    _strip(axes, picture.segments, picture.chosen, picture.span_s)
    return top_in + STRIP_IN


def _axes(figure: "Figure", top_in: float, tall_in: float, span_s: tuple[float, float]) -> "Axes":
    width, height = figure.get_size_inches()
    axes = figure.add_axes(
        (
            LEFT_IN / width,
            1 - (top_in + tall_in) / height,
            (width - LEFT_IN - RIGHT_IN) / width,
            tall_in / height,
        )
    )
    axes.set_xlim(*span_s)
    return axes


def _strip(
    axes: "Axes", segments: Sequence[Span], chosen: Span, span_s: tuple[float, float]
) -> None:
    """The segment among its neighbours, each with its name where it has room."""
    from matplotlib.patches import Rectangle

    axes.set_ylim(0.0, 1.0)
    axes.axis("off")
    scale = (WIDTH_IN - LEFT_IN - RIGHT_IN) / (span_s[1] - span_s[0])
    for segment in segments:
        start, end = max(segment.start_s, span_s[0]), min(segment.end_s, span_s[1])
        if start >= end:
            continue
        own = (segment.start_s, segment.end_s) == (chosen.start_s, chosen.end_s)
        known = {"facecolor": colour_of(segment.kind or segment.label), "edgecolor": "white"}
        look = UNNAMED if segment.kind == "Unknown" else known
        axes.add_patch(
            Rectangle(
                (start, 0.0), end - start, 1.0, **look, linewidth=0.8, alpha=1.0 if own else 0.45
            )
        )
        label = shortened(
            segment.label, points=9.0, widest_in=max((end - start) * scale - 0.06, 0.0)
        )
        if len(label) > 2 or own:
            axes.text(
                (start + end) / 2.0,
                0.5,
                segment.label if own else label,
                fontsize=9.0,
                color=INK if own else QUIET,
                weight="bold" if own else "normal",
                ha="center",
                va="center",
            )


def _panel(axes: "Axes", panel: Panel, chosen: Span, span_s: tuple[float, float]) -> None:
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
    for mark in panel.marks:
        axes.plot([mark.time], [mark.value], "o", color=MARK, markersize=5, zorder=4, clip_on=False)
        beside = [other.value for other in panel.marks if other.time == mark.time]
        lowest = len(beside) > 1 and mark.value == min(beside) and mark.value < max(beside)
        _mark(axes, mark, span_s, (low, high), below=lowest)
    _bars(axes, panel, low, high)
    _caption(axes, panel)


def _rows(axes: "Axes", rows: Sequence[Row], chosen: Span) -> None:
    """Each row's name, and below it bars where it holds."""
    from matplotlib.patches import Rectangle

    axes.set_ylim(len(rows), 0.0)
    axes.set_yticks([])
    axes.axvspan(chosen.start_s, chosen.end_s, color=SHADE, zorder=0)
    for side in ("top", "right", "left"):
        axes.spines[side].set_visible(False)
    axes.spines["bottom"].set_color(QUIET)
    axes.tick_params(colors=QUIET, labelsize=8, length=3)
    axes.grid(axis="x", color=FAINT, linewidth=0.5)
    axes.set_axisbelow(True)
    for number, row in enumerate(rows):
        axes.annotate(
            row.label,
            (0.0, number + 0.12),
            xycoords=("axes fraction", "data"),
            xytext=(2, 0),
            textcoords="offset points",
            fontsize=8.5,
            color=INK,
            va="top",
            zorder=5,
        )
        axes.axhline(number + 0.84, color=FAINT, linewidth=0.5, zorder=1)
        for bar in row.bars:
            axes.add_patch(
                Rectangle(
                    (bar.start_s, number + 0.72),
                    bar.end_s - bar.start_s,
                    0.24,
                    facecolor=CONTACT,
                    zorder=2,
                )
            )


def _caption(axes: "Axes", panel: Panel) -> None:
    """What the panel shows, and what its bars and its dashed curve are."""
    notes = [f"{curve.label}: dashed" for curve in panel.curves[1:] if curve.label]
    notes += [f"blue: {panel.bars_label}"] if panel.bars else []
    notes += ["hatched: not tracked"] if panel.lost else []
    if any(np.nanmax(curve.values, initial=-np.inf) > panel.highest for curve in panel.curves):
        notes.append("what is further is cut off")
    text = f"{panel.title} [{panel.unit}]" + f" ({'; '.join(notes)})" * bool(notes)
    axes.annotate(
        text,
        (0.0, 1.0),
        xycoords="axes fraction",
        xytext=(0, 4),
        textcoords="offset points",
        fontsize=9 * min(1.0, CAPTION_WIDE_IN / max(width_in(text, points=9.0), 1.0)),
        color=INK,
        va="bottom",
    )


def _limits(axes: "Axes", panel: Panel, low: float, high: float) -> None:
    """The name of each limit at the right, above its line, or below where the panel ends."""
    for limit in panel.limits:
        above = limit.value < high - 0.25 * (high - low)
        axes.annotate(
            limit.label,
            (1.0, limit.value),
            xycoords=("axes fraction", "data"),
            xytext=(-2, 2 if above else -2),
            textcoords="offset points",
            fontsize=7.5,
            color=LIMIT,
            ha="right",
            va="bottom" if above else "top",
            path_effects=_halo(),
            zorder=5,
        )


def _mark(
    axes: "Axes",
    mark: Mark,
    span_s: tuple[float, float],
    range_: tuple[float, float],
    *,
    below: bool,
) -> None:
    """The number of a mark beside it; below the mark where another one is above."""
    low, high = range_
    right = mark.time > span_s[0] + 0.85 * (span_s[1] - span_s[0])
    upper = mark.value < low + 0.75 * (high - low) and not below
    axes.annotate(
        mark.label,
        (mark.time, mark.value),
        xytext=(-5 if right else 5, 3 if upper else -3),
        textcoords="offset points",
        fontsize=8.5,
        weight="bold",
        color=MARK,
        ha="right" if right else "left",
        va="bottom" if upper else "top",
        path_effects=_halo(),
        zorder=6,
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
