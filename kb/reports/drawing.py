"""Drawings in SVG: their elements, and verb classes as boxes by status (thesis Fig 6.1)."""

from collections.abc import Iterable, Sequence
from html import escape

from kb.lexicon.links import ThesisStatus, above, levin_class
from kb.reports.linguistics import ClassReport, How, LinguisticReport

WIDTH = 970
LEFT, BOX, GUTTER = 200, 360, 30
LINE, PAD, GAP = 17, 8, 8
"""Measures of the page, its columns, and the lines in boxes [px]."""

TITLE, TITLE_CHARACTERS = 56, 21
"""Where titles begin, after numbers such as ``13.5.1``, and how many letters fit in a line."""

CHARACTERS = 50
"""How many letters a line of a box holds."""

STYLES = {
    "direct": "addressed",
    "extension": "with an extension; ours: only what is more general",
    "not": "not addressed",
}
"""Classes of boxes, with their words in the legend: shaded; outlined; dotted."""

_OF_HOW = {
    How.ADDRESSED: "direct",
    How.GENERAL: "extension",
    How.PURPOSE: "extension",
    How.MISSING: "not",
}

_STYLE = """
svg { font-family: Charter, "Bitstream Charter", "Iowan Old Style", Palatino, Georgia, serif; }
text { fill: #1d1b18; font-size: 13px; }
.column { font-size: 15px; font-weight: 600; }
.group { font-size: 13px; font-variant: small-caps; letter-spacing: 0.04em; fill: #6b4f2a; }
.number { font-size: 14px; font-weight: 600; }
.title { font-size: 11.5px; fill: #575048; }
.none { font-style: italic; fill: #8a8278; }
.rule { stroke: #d9d2c5; stroke-width: 1; }
rect { stroke: #3b362f; stroke-width: 1; fill: none; }
rect.direct { fill: #dfe7dc; }
rect.extension { fill: #ffffff; }
rect.not { fill: #ffffff; stroke-dasharray: 2 3; stroke: #857d72; }
"""


def text(x: object, y: object, content: str, **attributes: object) -> str:
    """A line of text that begins at a point; ``class_`` and ``font_size`` name attributes."""
    return f'<text x="{x}" y="{y}"{_stated(attributes)}>{escape(content)}</text>'


def rect(
    x: object, y: object, width: object, height: object, *, radius: int, **attributes: object
) -> str:
    """A rectangle with round corners, from its upper left one."""
    place = f'x="{x}" y="{y}" width="{width}" height="{height}" rx="{radius}"'
    return f"<rect {place}{_stated(attributes)}/>"


def _stated(attributes: dict[str, object]) -> str:
    return "".join(
        f' {name.rstrip("_").replace("_", "-")}="{escape(str(value))}"'
        for name, value in attributes.items()
    )


def draw(report: LinguisticReport) -> str:
    """The classes of a report: the thesis's boxes, and ours beside them."""
    parts = [
        text(LEFT, 22, "The thesis (section 6.1)", class_="column"),
        text(LEFT + BOX + GUTTER, 22, "This system, by its rules", class_="column"),
    ]
    y, group = 56, ""
    for levin in report.classes:
        top = [levin.number, *above(levin.number)][-1]
        if top != group:
            group = top
            y += 14
            parts.append(text(0, y + 12, f"{top}  {levin_class(top).title}", class_="group"))
            parts.append(f'<line x1="0" y1="{y + 20}" x2="{WIDTH}" y2="{y + 20}" class="rule"/>')
            y += 30
        y = _row(parts, levin, y)
    x = LEFT
    for style, words in STYLES.items():
        parts.append(rect(x, y + 20, 22, 14, radius=2, class_=style))
        parts.append(text(x + 30, y + 32, words, class_="title"))
        x += 60 + 11 * len(words) // 2
    return "\n".join(
        [
            f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="-1 -4 {WIDTH + 2} {y + 52}" '
            'role="img" aria-label="Levin classes of verbs by status">',
            f"<style>{_STYLE}</style>",
            *parts,
            "</svg>\n",
        ]
    )


def _row(parts: list[str], each: ClassReport, y: int) -> int:
    """A class's row from a height on; where the next one may begin."""
    parts.append(text(0, y + 20, each.number, class_="number"))
    title = _wrapped(each.title.split(), TITLE_CHARACTERS, " ")
    for index, line in enumerate(title):
        parts.append(text(TITLE, y + 20 + index * 14, line, class_="title"))
    thesis: dict[str, list[str]] = {}
    for claim in each.claims:
        if claim.status is not ThesisStatus.UNSTATED:
            thesis.setdefault(claim.status.value, []).extend(claim.verbs)
    ours: dict[str, list[str]] = {}
    for verb in each.judged:
        shown = f"; {verb.evidence.value}" if verb.evidence else ""
        by = f" ({', '.join(verb.primitives)}{shown})" if verb.primitives else ""
        ours.setdefault(_OF_HOW[verb.how], []).append(f"{verb.verb}{by}")
    if not thesis:
        parts.append(text(LEFT + PAD, y + 20, "not mentioned", class_="none"))
    bottoms = (
        max(_column(parts, thesis, LEFT, y), y + LINE + 2 * PAD),
        _column(parts, ours, LEFT + BOX + GUTTER, y),
        y + 20 + 14 * len(title),
    )
    return max(bottoms) + GAP


def _column(parts: list[str], verbs: dict[str, list[str]], x: int, y: int) -> int:
    for style in STYLES:
        if style in verbs:
            lines = _wrapped(list(dict.fromkeys(verbs[style])), CHARACTERS, ", ")
            height = LINE * len(lines) + 2 * PAD
            parts.append(rect(x, y, BOX, height, radius=3, class_=style))
            for index, line in enumerate(lines):
                parts.append(text(x + PAD + 2, y + PAD + 12 + index * LINE, line, class_="verbs"))
            y += height + 4
    return y


def _wrapped(words: Sequence[str], width: int, between: str) -> list[str]:
    """Words in lines; what stands between them stays at the end of a line."""
    lines: list[str] = []
    for piece in _pieces(words, between):
        if lines and len(lines[-1] + piece.rstrip()) <= width:
            lines[-1] += piece
        else:
            lines.append(piece)
    return [line.rstrip() for line in lines]


def _pieces(words: Sequence[str], between: str) -> Iterable[str]:
    yield from (f"{word}{between}" for word in words[:-1])
    yield from words[-1:]
