"""A drawing of verb classes as boxes by status, ours beside the thesis's (thesis Fig 6.1)."""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass

from kb.lexicon.links import ThesisStatus, above, levin_class
from kb.reports.linguistics import ClassReport, How, LinguisticReport
from kb.reports.svg import rect, text
from kb.reports.tables import EVIDENCE

WIDTH = 970
LEFT, BOX, GUTTER = 200, 360, 30
LINE, PAD, GAP = 17, 8, 8
TITLE = 56
"""Where titles begin, after numbers of up to six characters (``13.5.1``)."""

TITLE_CHARACTERS = 21
"""Letters of a title's size that fit between there and the first boxes."""

CHARACTERS = 50
"""Letters of the drawing's size that a line of a box holds."""

STYLES = ("direct", "extension", "not")
"""Classes of boxes: shaded; outlined; dotted, as in the figure."""

_OF_HOW = {
    How.ADDRESSED: "direct",
    How.GENERAL: "extension",
    How.PURPOSE: "extension",
    How.MISSING: "not",
}


@dataclass(frozen=True, slots=True)
class Box:
    """Verbs of one status."""

    style: str
    lines: tuple[str, ...]

    @property
    def height(self) -> int:
        """In units of the drawing."""
        return LINE * len(self.lines) + 2 * PAD


def draw(report: LinguisticReport) -> str:
    """The drawing as SVG; its colours and fonts stand in it."""
    parts: list[str] = []
    y = 56
    group = ""
    for levin in report.classes:
        top = _top(levin.number)
        if top != group:
            group = top
            y += 14
            parts.append(text(0, y + 12, _heading(top), class_="group"))
            parts.append(f'<line x1="0" y1="{y + 20}" x2="{WIDTH}" y2="{y + 20}" class="rule"/>')
            y += 30
        y = _row(parts, levin, y)
    return _page(parts, y + 52 + NOTE_LINE * len(_note()))


def _top(number: str) -> str:
    return [number, *above(number)][-1]


def _heading(number: str) -> str:
    return f"{number}  {levin_class(number).title}"


def _row(parts: list[str], each: ClassReport, y: int) -> int:
    thesis, ours = _thesis_boxes(each), _own_boxes(each)
    parts.append(text(0, y + 20, each.number, class_="number"))
    title = _wrapped(each.title.split(), TITLE_CHARACTERS, " ")
    for index, line in enumerate(title):
        parts.append(text(TITLE, y + 20 + index * 14, line, class_="title"))
    bottoms = [
        _column(parts, thesis, LEFT, y) if thesis else _nothing(parts, LEFT, y),
        _column(parts, ours, LEFT + BOX + GUTTER, y),
        y + 20 + 14 * len(title),
    ]
    return max(bottoms) + GAP


def _nothing(parts: list[str], x: int, y: int) -> int:
    parts.append(text(x + PAD, y + 20, "not mentioned", class_="none"))
    return y + LINE + 2 * PAD


def _column(parts: list[str], boxes: Sequence[Box], x: int, y: int) -> int:
    for box in boxes:
        parts.append(rect(x, y, BOX, box.height, radius=3, class_=box.style))
        for index, line in enumerate(box.lines):
            parts.append(text(x + PAD + 2, y + PAD + 12 + index * LINE, line, class_="verbs"))
        y += box.height + 4
    return y


def _thesis_boxes(each: ClassReport) -> list[Box]:
    verbs: dict[ThesisStatus, list[str]] = {}
    for claim in each.claims:
        verbs.setdefault(claim.status, []).extend(claim.verbs)
    order = (ThesisStatus.DIRECT, ThesisStatus.EXTENSION, ThesisStatus.NOT)
    return [
        Box(status.value, _lines(dict.fromkeys(verbs[status])))
        for status in order
        if status in verbs
    ]


def _own_boxes(each: ClassReport) -> list[Box]:
    found: dict[str, list[str]] = {}
    for verb in each.judged:
        shown = f"; {verb.evidence.value}" if verb.evidence else ""
        by = f" ({', '.join(verb.primitives)}{shown})" if verb.primitives else ""
        found.setdefault(_OF_HOW[verb.how], []).append(f"{verb.verb}{by}")
    return [Box(style, _lines(found[style])) for style in STYLES if style in found]


def _lines(words: Iterable[str]) -> tuple[str, ...]:
    return tuple(_wrapped(list(words), CHARACTERS, ", "))


def _wrapped(words: Sequence[str], width: int, between: str) -> list[str]:
    """Words in lines; what stands between them stays at the end of a line."""
    lines: list[str] = []
    for index, word in enumerate(words):
        piece = word + (between if index < len(words) - 1 else "")
        if lines and len(lines[-1] + piece.rstrip()) <= width:
            lines[-1] += piece
        else:
            lines.append(piece)
    return [line.rstrip() for line in lines]


NOTE_LINE, NOTE_CHARACTERS = 15, 120
"""Height and letters of a line below the legend."""


def _note() -> list[str]:
    """What the words in the boxes say of evidence."""
    return _wrapped(EVIDENCE.split(), NOTE_CHARACTERS, " ")


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


def _page(parts: Sequence[str], height: int) -> str:
    legend = (
        ("direct", "addressed"),
        ("extension", "with an extension; ours: only what is more general"),
        ("not", "not addressed"),
    )
    marks: list[str] = []
    x, legend_y = LEFT, height - 20 - NOTE_LINE * len(_note())
    for style, words in legend:
        marks.append(rect(x, legend_y - 12, 22, 14, radius=2, class_=style))
        marks.append(text(x + 30, legend_y, words, class_="title"))
        x += 60 + 11 * len(words) // 2
    for index, line in enumerate(_note(), start=1):
        marks.append(text(LEFT, legend_y + 4 + NOTE_LINE * index, line, class_="title"))
    heads = [
        text(LEFT, 22, "The thesis (section 6.1)", class_="column"),
        text(LEFT + BOX + GUTTER, 22, "This system, by its rules", class_="column"),
    ]
    return "\n".join(
        [
            f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="-1 -4 {WIDTH + 2} {height}" '
            'role="img" aria-label="Levin classes of verbs by status">',
            f"<style>{_STYLE}</style>",
            *heads,
            *parts,
            *marks,
            "</svg>\n",
        ]
    )
