"""Explanations as a picture: the tree of sentences, and beside each when it holds."""

from collections.abc import Iterator, Sequence
from html import escape

from capar_rules.explaining import Explanation, Reason

ROW, INDENT, TEXT, STRIP = 20, 18, 760, 240
"""Height of a row, step of a level, width of the text and of the strip of time [px]."""


def reasons_svg(told: Sequence[Explanation]) -> str:
    """One SVG document with a tree for each explanation."""
    rows: list[str] = []
    y = ROW
    for each in told:
        title = f"{each.ee}/{each.index}  {each.start_s:.2f} to {each.end_s:.2f} s: {each.summary}"
        rows.append(f'<text x="8" y="{y}" font-weight="bold">{escape(title)}</text>')
        y += ROW
        tree = each.reason.told()
        span = _span(tree)
        for depth, reason in _rows(tree, 0):
            rows += _row(reason, depth, y, span)
            y += ROW
        y += ROW // 2
    width = 8 + TEXT + STRIP + 16
    return (
        f'<svg xmlns="http://www.w3.org/2000/svg" width="{width}" height="{y}" '
        'font-family="sans-serif" font-size="12">\n'
        f'<rect width="{width}" height="{y}" fill="white"/>\n' + "\n".join(rows) + "\n</svg>\n"
    )


def _row(reason: Reason, depth: int, y: int, span: tuple[int, int]) -> list[str]:
    x = 8 + depth * INDENT
    rule = f" <tspan fill='#777'>({escape(reason.rule)})</tspan>" if reason.rule else ""
    colour = "#000" if reason.because else "#135"
    lines = [f'<text x="{x}" y="{y}" fill="{colour}">{escape(reason.sentence)}{rule}</text>']
    if depth:
        lines.append(
            f'<path d="M{x - INDENT + 4} {y - ROW + 4}V{y - 4}H{x - 3}" fill="none" stroke="#bbb"/>'
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
    return lines


def _rows(reason: Reason, depth: int) -> Iterator[tuple[int, Reason]]:
    yield depth, reason
    for each in reason.because:
        yield from _rows(each, depth + 1)


def _span(tree: Reason) -> tuple[int, int]:
    frames = [frame for each in tree.walk() if each.frames for frame in each.frames]
    return (min(frames), max(frames)) if frames else (0, 1)
