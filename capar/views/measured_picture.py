"""A picture of what an explanation says: the segment in time, and each quantity below it."""

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from textwrap import wrap
from typing import TYPE_CHECKING

from capar.views.captions import caption_lines, draw_caption, together
from capar.views.lettering import Span, width_in
from capar.views.measured_panel import SHADE, draw_panel
from capar.views.panels import Panel, Row
from capar.views.picture import CONTACT, FAINT, INK, QUIET, save
from capar.views.segment_strip import Strip, draw_strip, strip

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

WIDTH_IN = 10.0
LEFT_IN, RIGHT_IN, EDGE_IN = 0.75, 1.65, 0.25
"""Rooms left of panels, right of them, where limits are named, and at the edges [inches]."""

PANEL_IN, CAPTION_IN = 0.95, 0.34
"""Heights of a panel, and of a line of caption with its room [inches]."""

CAPTION_WIDE_IN = WIDTH_IN - LEFT_IN - EDGE_IN
"""How wide a line of a caption may be [inches]."""

FOOT_IN = 0.55
ROW_IN, GAP_IN, TICKS_IN = 0.3, 0.15, 0.25
"""Heights of a row of bars, of the room before it, and of times below a panel [inches]."""

NAMED = 0.66
"""Which share of a row, from its top, is for its name: the segment is shaded below [1]."""

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
    shown = strip(
        picture.segments,
        picture.chosen,
        picture.span_s,
        width_in=WIDTH_IN - LEFT_IN - RIGHT_IN,
    )
    height = head + shown.height + sum(tall.values()) + len(picture.panels) * PANEL_IN + FOOT_IN
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
            top, stripped = _with_strip(figure, top, picture, shown), True
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
        top = _with_strip(figure, top, picture, shown)
    if picture.rows:
        top += GAP_IN
        last = _axes(figure, top, ROW_IN * len(picture.rows), span_s)
        _rows(last, picture.rows, chosen)
    if last is not None:
        last.tick_params(axis="x", labelbottom=True)
        last.set_xlabel("time [s]", fontsize=9, color=QUIET, labelpad=2)
    return figure


def _with_strip(figure: "Figure", top_in: float, picture: MeasuredPicture, shown: Strip) -> float:
    """Draw the strip of segments above the panels of its own times; where it ends [inches]."""
    draw_strip(_axes(figure, top_in, shown.height, picture.span_s), shown)
    return top_in + shown.height


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


def _rows(axes: "Axes", rows: Sequence[Row], chosen: Span) -> None:
    """Each row's name, and below it bars where it holds."""
    from matplotlib.patches import Rectangle

    axes.set_ylim(len(rows), 0.0)
    axes.set_yticks([])
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
        for each, low, tall, colour in (
            (chosen, NAMED, 1.0 - NAMED, SHADE),
            *((bar, 0.72, 0.24, CONTACT) for bar in row.bars),
        ):
            size = each.end_s - each.start_s, tall
            place = each.start_s, number + low
            axes.add_patch(Rectangle(place, *size, facecolor=colour, zorder=1.0 + (tall < 0.3)))
