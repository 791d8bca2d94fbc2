"""Pieces of HTML: messages, tables, conditions, derivations; all that is put in stays text."""

from collections.abc import Iterable, Iterator, Sequence
from html import escape

from capar_rules.explain.conditions import Condition, Reason

DIM = "color:var(--mantine-color-dimmed)"
FAINT = "border-bottom:1px solid var(--mantine-color-default-border)"
CELL = f"padding:2px 8px 2px 0;text-align:left;vertical-align:top;{FAINT}"
GOOD, BAD = "light-dark(#1b7f3b,#63d48a)", "light-dark(#b3261e,#ff8a80)"
MOST_ROWS = 300
"""A longer table is cut, and says so."""


def block(inside: str, style: str = "") -> str:
    """A paragraph of the panel, of HTML."""
    return f'<div style="font-size:13px;line-height:1.45;padding:0 10px 6px;{style}">{inside}</div>'


def text(words: str, style: str = "") -> str:
    """A paragraph of plain text; its line breaks are kept."""
    return block(escape(words), f"white-space:pre-wrap;overflow-wrap:anywhere;{style}")


def note(words: str) -> str:
    """A paragraph of less weight."""
    return text(words, DIM)


def message(words: str, *, good: bool = False) -> str:
    """What went wrong, or well, beside the field that it is about; nothing for no words."""
    if not words:
        return ""
    role, colour = ("status", GOOD) if good else ("alert", BAD)
    inside = f'<span role="{role}" style="color:{colour}">{escape(words)}</span>'
    return block(inside, "white-space:pre-wrap;overflow-wrap:anywhere")


def code(words: str) -> str:
    """Text of a program, as it is written."""
    style = "font:12px/1.4 monospace;white-space:pre-wrap;overflow-wrap:anywhere;margin:0"
    return block(f'<pre style="{style}">{escape(words)}</pre>')


def table(rows: Sequence[Sequence[str]], header: Sequence[str] = ()) -> str:
    """Rows of text under a header."""
    head = "".join(f'<th style="{CELL}">{escape(each)}</th>' for each in header)
    body = "".join(
        "<tr>" + "".join(f'<td style="{CELL}">{escape(str(each))}</td>' for each in row) + "</tr>"
        for row in rows[:MOST_ROWS]
    )
    left = len(rows) - MOST_ROWS
    more = note(f"and {left} more") if left > 0 else ""
    style = "border-collapse:collapse;font-size:12px;width:100%"
    return block(f'<table style="{style}"><tr>{head}</tr>{body}</table>', "overflow-x:auto") + more


def conditions(found: Iterable[Condition]) -> str:
    """Conditions, and below each what it compares: measured value and limit."""
    rows = []
    for condition in found:
        rows.append(f'<tr><td colspan="3" style="{CELL}">{escape(condition.sentence)}</td></tr>')
        for one in condition.measures:
            colour = GOOD if one.holds else BAD
            cells = (one.label, one.value_text, one.limit_text)
            narrow = "white-space:nowrap"
            styles = f"{DIM};padding-left:14px", f"color:{colour};{narrow}", f"{DIM};{narrow}"
            rows.append(
                "<tr>"
                + "".join(
                    f'<td style="{CELL};{style}">{escape(each)}</td>'
                    for each, style in zip(cells, styles, strict=True)
                )
                + "</tr>"
            )
    style = "border-collapse:collapse;font-size:12px;width:100%"
    return block(f'<table style="{style}">{"".join(rows)}</table>')


def tree(reason: Reason) -> str:
    """A derivation as nested sentences; the first two levels are open."""
    return block("".join(_branch(reason, 0)), "font-size:12px")


def _branch(reason: Reason, depth: int) -> Iterator[str]:
    where = f" [frames {reason.frames[0]} to {reason.frames[1]}]" if reason.frames else ""
    rule = f"{reason.rule}{'; see above' if reason.repeated else ''}".strip("; ")
    said = f'{escape(reason.sentence)}<span style="{DIM}">{escape(where)} {escape(rule)}</span>'
    if not reason.because:
        yield f'<div style="padding-left:16px">{said}</div>'
        return
    is_open = " open" if depth < 2 else ""
    yield f'<details style="padding-left:4px"{is_open}><summary>{said}</summary>'
    yield '<div style="padding-left:12px">'
    for below in reason.because:
        yield from _branch(below, depth + 1)
    yield "</div></details>"
