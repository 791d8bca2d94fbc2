"""A picture of what an explanation says: the segment in time, and each quantity below it."""

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from textwrap import wrap
from typing import TYPE_CHECKING

from capar.views.lettering import Span, shortened, width_in
from capar.views.measured_panel import SHADE, caption_lines, draw_caption, draw_panel, together
from capar.views.painter import CONTACT, FAINT, INK, QUIET, UNNAMED, colour_of
from capar.views.panels import Panel, Row
from capar.views.picture import save

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

WIDTH_IN = 10.0
LEFT_IN, RIGHT_IN, EDGE_IN = 0.75, 1.65, 0.25
"""Rooms left of panels, right of them, where limits are named, and at the edges [inches]."""

PANEL_IN, CAPTION_IN, STRIP_IN = 0.95, 0.34, 0.3
"""Heights of a panel, of a line of caption with its room, and of the strip of segments [inches]."""

CAPTION_WIDE_IN = WIDTH_IN - LEFT_IN - EDGE_IN
"""How wide a line of a caption may be [inches]."""

FOOT_IN = 0.55
ROW_IN, GAP_IN, TICKS_IN = 0.3, 0.15, 0.25
"""Heights of a row of bars, of the room before it, and of times below a panel [inches]."""

LINE_IN = 0.19
"""Height of a line of the summary [inches]."""


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
        for line in wrap(together(part), int((WIDTH_IN - 0.5) / letter))
    ]
    head = 0.55 + LINE_IN * len(lines) + 0.1
    captions = {
        id(panel): caption_lines(
            panel, picture.chosen, panel.span_s or picture.span_s, CAPTION_WIDE_IN
        )
        for panel in picture.panels
    }
    tall = {key: CAPTION_IN + LINE_IN * (len(lines) - 1) for key, lines in captions.items()}
    apart = sum(panel.span_s is not None for panel in picture.panels)
    height = head + STRIP_IN + sum(tall.values()) + len(picture.panels) * PANEL_IN + FOOT_IN
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
        last = _axes(figure, top + tall[id(panel)], PANEL_IN, own)
        draw_panel(last, panel, chosen, own)
        draw_caption(last, captions[id(panel)])
        top += tall[id(panel)] + PANEL_IN
        if panel.span_s is None:
            last.tick_params(axis="x", labelbottom=False)
        else:
            top += TICKS_IN
    if not stripped:
        top = _with_strip(figure, top, picture)
    if picture.rows:
        top += GAP_IN
        last = _axes(figure, top, ROW_IN * len(picture.rows), span_s)
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
    middle = (chosen.start_s + chosen.end_s) / 2.0
    half = 0.5 * width_in(chosen.label, points=10.0) / scale + 0.06 / scale
    lettered = min(chosen.start_s, middle - half), max(chosen.end_s, middle + half)
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
        if not own:  # the name of the chosen one may reach over its neighbours
            end = min(end, lettered[0]) if start < chosen.start_s else end
            start = max(start, lettered[1]) if start >= chosen.start_s else start
        label = shortened(
            segment.label, points=9.0, widest_in=max((end - start) * scale - 0.06, 0.0)
        )
        if len(label) > 2 or own:
            axes.text(
                middle if own else (start + end) / 2.0,
                0.5,
                segment.label if own else label,
                fontsize=9.0,
                color=INK if own else QUIET,
                weight="bold" if own else "normal",
                ha="center",
                va="center",
                zorder=3 if own else 2,
            )


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
