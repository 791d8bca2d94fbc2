"""The caption of a panel: what it shows, and what its bars and its dashed curve are."""

import re
from collections.abc import Sequence
from textwrap import wrap
from typing import TYPE_CHECKING

import numpy as np

from capar.views.lettering import Span, width_in
from capar.views.panels import Panel
from capar.views.picture import INK

if TYPE_CHECKING:
    from matplotlib.axes import Axes

CAPTION_PT = 9.0
"""Size of its letters [points]."""

LEAST_SHARE = 0.5
"""A last line that is shorter, as a share of the room, takes words of the lines above [1]."""

_BEFORE_UNIT = re.compile(r"(?<=\d) (?=(?:mm|cm|m|s)\b|%)")


def together(text: str) -> str:
    """The same, with no line to begin between a number and its unit."""
    return _BEFORE_UNIT.sub("\u00a0", text)


def caption_lines(
    panel: Panel, chosen: Span, span_s: tuple[float, float], widest_in: float
) -> list[str]:
    """What the panel shows, and what its bars and its dashed curve are, in lines so wide.

    It is told in fewer words where that saves a line; else no line is much shorter than the others.

    Args:
        panel: The panel.
        chosen: The segment, of which all is shown.
        span_s: The first and the last time that are drawn [s].
        widest_in: Width of a line [inches].
    """
    told = [_told(panel, chosen, span_s, brief=brief) for brief in (False, True)]
    letters = [
        max(int(0.97 * len(text) * widest_in / max(width_in(text, points=CAPTION_PT), 1e-6)), 20)
        for text in told
    ]
    lines, fewer = (wrap(together(text), most) for text, most in zip(told, letters, strict=True))
    if len(fewer) < len(lines):
        return fewer
    short = len(lines) > 1 and len(lines[-1]) < LEAST_SHARE * letters[0]
    return _even(together(told[0]), letters[0]) if short else lines


def _even(text: str, most: int) -> list[str]:
    """Lines of at most so many letters, of about the same length."""
    lines = wrap(text, most)
    for letters in range(most, most // 2, -1):
        narrower = wrap(text, letters)
        if len(narrower) > len(lines):
            break
        lines = narrower
    return lines


def _told(panel: Panel, chosen: Span, span_s: tuple[float, float], *, brief: bool) -> str:
    """All that is said, in one line."""
    notes = [f"{curve.label}: dashed" for curve in panel.curves[1:] if curve.label]
    notes += [f"blue: {panel.bars_label}"] if panel.bars else []
    notes += [panel.unheld] if panel.unheld and not panel.bars else []
    lost = " and ".join(dict.fromkeys(gap.label for gap in panel.lost))
    notes += [f"hatched: {lost} not tracked"] if panel.lost else []
    if any(np.nanmax(curve.values, initial=-np.inf) > panel.highest for curve in panel.curves):
        notes.append("cut off" if brief else f"{panel.beyond} is cut off")
    elif panel.leaves(chosen.start_s, chosen.end_s, span_s):
        notes.append("cut off outside" if brief else "cut off outside of the segment")
    if panel.span_s is not None:
        first, last = panel.span_s
        notes.append(f"its own axis of time, from {first:.2f} to {last:.2f} s")
    return f"{panel.title} [{panel.unit}]" + f" ({'; '.join(notes)})" * bool(notes)


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
