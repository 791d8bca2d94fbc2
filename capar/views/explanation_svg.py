"""Explanations as a picture: the tree of sentences, and beside each when it holds."""

from collections.abc import Iterator, Sequence
from html import escape
from textwrap import wrap

from capar.model.observation import Observation, SegmentAddress
from capar.views.explanation_text import note, reason_tree
from capar_rules.explain.explanation import Explanation, Reason

ROW, LINE, INDENT, TEXT, STRIP = 20, 15, 18, 760, 240
"""Heights of a row and of each further line, step of a level, widths of text and of time [px]."""

LETTER, BOLD = 6.4, 7.2
"""How wide a letter is at most, on an average [px]."""


def reasons_svg(told: Sequence[Explanation], seen: Observation) -> str:
    """One SVG document with a tree for each explanation."""
    rows: list[str] = []
    y = ROW
    for explained in told:
        address = SegmentAddress(explained.ee, explained.index)
        title = (
            f"{address}  {explained.start_s:.2f} to {explained.end_s:.2f} s: {explained.summary}"
        )
        lines = _lines(title, TEXT + STRIP, BOLD)
        rows.append(f'<text x="8" y="{y}" font-weight="bold">{_set(lines, 8)}</text>')
        y += ROW + (len(lines) - 1) * LINE
        tree = reason_tree(explained, seen)
        span, above = _span(tree), y
        for depth, reason in _rows(tree, 0):
            drawn, height = _row(reason, depth, y, span, above=above)
            rows, above, y = [*rows, *drawn], y, y + height
        y += ROW // 2
    width = 8 + TEXT + STRIP + 16
    return (
        f'<svg xmlns="http://www.w3.org/2000/svg" width="{width}" height="{y}" '
        'font-family="sans-serif" font-size="12">\n'
        f'<rect width="{width}" height="{y}" fill="white"/>\n' + "\n".join(rows) + "\n</svg>\n"
    )


def _row(
    reason: Reason, depth: int, y: int, span: tuple[int, int], *, above: int
) -> tuple[list[str], int]:
    """What one sentence is drawn with, and how high it is."""
    x = 8 + depth * INDENT
    rule = f" ({noted})" if (noted := note(reason)) else ""
    told = _lines(f"{reason.sentence}{rule}", TEXT - x, LETTER)
    colour = "#000" if reason.because else "#135"
    lines = [f'<text x="{x}" y="{y}" fill="{colour}">{_set(told, x)}</text>']
    if depth:
        lines.append(
            f'<path d="M{x - INDENT + 4} {above + 4}V{y - 4}H{x - 3}" fill="none" stroke="#bbb"/>'
        )
    if reason.frames:
        first, last = reason.frames
        scale = STRIP / max(span[1] - span[0], 1)
        begin = 8 + TEXT + (first - span[0]) * scale
        width = max((last - first) * scale, 2.0)
        lines.append(
            f'<rect x="{begin:.1f}" y="{y - 10}" width="{width:.1f}" height="11" fill="#7ab">'
            f"<title>frames {first} to {last}</title></rect>"
        )
    return lines, ROW + (len(told) - 1) * LINE


def _lines(text: str, width_px: float, letter_px: float) -> list[str]:
    """A text in lines that the width holds."""
    return wrap(text, max(int(width_px / letter_px), 20), break_long_words=False)


def _set(lines: Sequence[str], x: int) -> str:
    """Lines below each other, in one text."""
    return "".join(
        f'<tspan x="{x}" dy="{LINE if number else 0}">{escape(line)}</tspan>'
        for number, line in enumerate(lines)
    )


def _rows(reason: Reason, depth: int) -> Iterator[tuple[int, Reason]]:
    yield depth, reason
    for deeper in reason.because:
        yield from _rows(deeper, depth + 1)


def _span(tree: Reason) -> tuple[int, int]:
    frames = [frame for each in tree.walk() if each.frames for frame in each.frames]
    return (min(frames), max(frames)) if frames else (0, 1)
