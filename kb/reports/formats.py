"""The linguistic report as tables of rows, and the formats in which they are written."""

import csv
import io
import json
import textwrap
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import asdict
from html import escape
from importlib.resources import files
from string import Template
from typing import TypeAlias

from capar.model.errors import UnknownNameError
from kb.lexicon.links import ThesisStatus, above, levin_classes
from kb.reports.linguistics import ClassReport, How, LinguisticReport

PAGE = 970
LEFT, BOX, GUTTER = 200, 360, 30
LINE, PAD, GAP = 17, 8, 8
"""Measures of the page, its columns, and the lines in boxes [px]."""

TITLE_X, TITLE_CHARACTERS = 56, 21
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
            parts.append(text(0, y + 12, f"{top}  {levin_classes()[top].title}", class_="group"))
            parts.append(f'<line x1="0" y1="{y + 20}" x2="{PAGE}" y2="{y + 20}" class="rule"/>')
            y += 30
        y = _row(parts, levin, y)
    x = LEFT
    for style, words in STYLES.items():
        parts.append(rect(x, y + 20, 22, 14, radius=2, class_=style))
        parts.append(text(x + 30, y + 32, words, class_="title"))
        x += 60 + 11 * len(words) // 2
    return "\n".join(
        [
            f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="-1 -4 {PAGE + 2} {y + 52}" '
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
        parts.append(text(TITLE_X, y + 20 + index * 14, line, class_="title"))
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
    for piece in (*(f"{word}{between}" for word in words[:-1]), *words[-1:]):
        if lines and len(lines[-1] + piece.rstrip()) <= width:
            lines[-1] += piece
        else:
            lines.append(piece)
    return [line.rstrip() for line in lines]


TITLE = "Verbs that the system addresses"
WIDTH = 96
"""Characters of a line of text."""

Row: TypeAlias = tuple[str, ...]
Table: TypeAlias = tuple[str, Row, tuple[Row, ...]]
"""Title, heads of columns, rows."""

EVIDENCE = (
    "Observed: stored segments of captures bear a primitive's name; tested: a shipped test case "
    "does, and no stored segment; by rule only: a rule says so, and nothing shows it yet."
)
NOTES = {
    "Coverage": "Counts what rules address, whatever the evidence.",
    "Classes": f"Shown by: stored captures and shipped test cases. {EVIDENCE}",
    "Verbs": EVIDENCE,
    "Claims of the thesis": "What the thesis says, in its own words; no evidence of the system's.",
}
"""What stands below a table's title."""


def tables(report: LinguisticReport) -> tuple[Table, ...]:
    """Every table, in the order of the report."""
    doubts = "Doubts about what rule files state"
    every: tuple[Table, ...] = (
        ("Coverage", ("what", "how much"), coverage(report)),
        (
            "Classes",
            ("class", "title", "thesis", "system", "by", "why", "shown by", "segments"),
            tuple(
                (
                    *(each.number, each.title, ", ".join(each.thesis), each.status.words),
                    *(", ".join([*each.primitives, *each.files]), each.reason),
                    *(
                        _cut({f"{e.where} ({e.primitive})": 0 for e in each.proofs}),
                        str(each.segments),
                    ),
                )
                for each in report.classes
            ),
        ),
        (
            "Verbs",
            ("class", "verb", "system", "by", "what it lacks", "WordNet 3.1", "gloss"),
            tuple(
                (
                    *(each.number, verb.verb, verb.standing),
                    *(", ".join(verb.primitives), "; ".join(verb.lacks)),
                    " ".join(sense.ili or sense.offset for sense in verb.senses),
                    " / ".join(sense.definition for sense in verb.senses),
                )
                for each in report.classes
                for verb in each.verbs
            ),
        ),
        (
            "Senses",
            ("primitive", "verb", "1.6", "3.1", "sense key", "ILI", "gloss", "who", "remark"),
            tuple(
                (
                    *(row.link.primitive, row.link.verb, str(row.link.number_1_6 or "")),
                    *(str(row.number_3_1 or ""), row.link.key),
                    row.synset.ili if row.synset else "",
                    row.synset.definition if row.synset else "not in WordNet 3.1",
                    *(row.link.claimed_by.value, row.link.remark),
                )
                for row in report.senses
            ),
        ),
        (
            "Claims of the thesis",
            ("class", "verbs", "status", "why", "section", "sentence"),
            tuple(
                (
                    each.levin
                    + (f" (printed: {each.said})" if each.said not in {"", each.levin} else ""),
                    *(", ".join(each.verbs), each.status.value, each.reason),
                    *(each.section, each.quote),
                )
                for each in report.claims
            ),
        ),
        (
            "Remarks",
            ("class", "verb", "remark"),
            tuple((each.levin, each.verb, each.text) for each in report.remarks),
        ),
        (doubts, ("doubt",), tuple((each,) for each in report.doubts)),
    )
    return tuple(each for each in every if each[2] or each[0] != doubts)


def coverage(report: LinguisticReport) -> tuple[Row, ...]:
    """The figures of coverage as people read them."""
    total = report.coverage
    members = "with VerbNet's members" if report.verbnet else "named by the thesis or our rules"

    def share(part: int, whole: int) -> str:
        return f"{part} of {whole}" + (f" ({round(100 * part / whole)} %)" if whole else "")

    return (
        ("classes addressed", share(total.classes_addressed, total.classes)),
        ("classes addressed in part", share(total.classes_partly, total.classes)),
        (f"verbs addressed ({members})", share(total.verbs_addressed, total.verbs)),
        ("verbs not addressed, only what is more general", share(total.verbs_general, total.verbs)),
        ("verbs only as a purpose that the user states", share(total.verbs_purpose, total.verbs)),
        ("observed segments that a rule names", share(total.segments_named, total.segments)),
        ("observed segments in a class", share(total.segments_in_classes, total.segments)),
        ("classes of which the thesis says nothing", str(total.unstated)),
        ("observations", str(len(report.observations))),
    )


def _cut(places: Mapping[str, object]) -> str:
    """Places in a line, those after the fourth counted."""
    more = f" and {len(places) - 4} more" if len(places) > 4 else ""
    return ", ".join([*places][:4]) + more


# The formats


def as_text(report: LinguisticReport) -> str:
    """For a terminal: a paragraph a row, its cells after the heads of their columns."""
    lines = [TITLE, "=" * len(TITLE)]
    for title, heads, rows in tables(report):
        lines += ["", title, "-" * len(title), *textwrap.wrap(NOTES.get(title, ""), WIDTH)]
        for first, *cells in rows:
            pairs = zip(heads[1:], cells, strict=True)
            said = "; ".join(f"{head}: {cell}" for head, cell in pairs if cell)
            lines += textwrap.wrap(f"{first}. {said}", WIDTH, subsequent_indent="    ")
    return "\n".join(lines) + "\n"


def as_markdown(report: LinguisticReport) -> str:
    """Tables of Markdown under headings."""

    def line(cells: Iterable[str]) -> str:
        escaped = (c.replace("\\", "\\\\").replace("|", "\\|").replace("\n", " ") for c in cells)
        return f"| {' | '.join(escaped)} |"

    parts = [f"# {TITLE}\n"]
    for title, heads, rows in tables(report):
        note = f"{NOTES[title]}\n\n" if title in NOTES else ""
        body = "\n".join(map(line, (heads, ["---"] * len(heads), *rows)))
        parts.append(f"## {title}\n\n{note}{body}\n")
    return "\n".join(parts)


def as_csv(report: LinguisticReport) -> str:
    """The table of verbs with what the classes say, one line a verb."""
    found = {title: (heads, rows) for title, heads, rows in tables(report)}
    class_heads, classes = found["Classes"]
    heads, rows = found["Verbs"]
    of_class = {row[0]: row for row in classes}
    out = io.StringIO()
    writer = csv.writer(out, lineterminator="\n")
    writer.writerow([*heads, *(f"class: {each}" for each in class_heads[1:])])
    writer.writerows([*row, *of_class[row[0]][1:]] for row in rows)
    return out.getvalue()


def as_json(report: LinguisticReport) -> str:
    """Everything, by the names of the values."""
    value = asdict(report)
    for each, plain in zip(report.classes, value["classes"], strict=True):
        plain["reason"] = each.reason
        plain["thesis"] = list(each.thesis)
    return json.dumps(value, ensure_ascii=False, indent=2, sort_keys=True) + "\n"


def as_html(report: LinguisticReport) -> str:
    """One page that loads nothing: the drawing, then every table."""
    sections = [f'<section id="drawing">\n<figure>{draw(report)}</figure>\n</section>']
    links = ['<a href="#drawing">Drawing</a>']
    for title, heads, rows in tables(report):
        key = title.split()[0].lower()
        links.append(f'<a href="#{key}">{escape(title)}</a>')
        head = "".join(f"<th>{escape(each)}</th>" for each in heads)
        body = "".join(
            f"<tr>{''.join(f'<td>{escape(cell)}</td>' for cell in row)}</tr>\n" for row in rows
        )
        sections.append(
            f'<section id="{key}">\n<h2>{escape(title)}</h2>\n<p>{escape(NOTES.get(title, ""))}</p>'
            f'<div class="scroll"><table><thead><tr>{head}</tr></thead><tbody>{body}</tbody>'
            "</table></div>\n</section>"
        )
    top = f"<h1>{escape(TITLE)}</h1>\n<nav>{''.join(links)}</nav>"
    folder = files("kb") / "reports"
    template = Template((folder / "page.html").read_text(encoding="utf-8"))
    style = (folder / "page.css").read_text(encoding="utf-8")
    body = "\n".join([top, *sections])
    return template.substitute(title=escape(TITLE), style=style, body=body)


FORMATS: Mapping[str, Callable[[LinguisticReport], str]] = {
    "text": as_text,
    "md": as_markdown,
    "html": as_html,
    "csv": as_csv,
    "json": as_json,
    "svg": draw,
}


def write(report: LinguisticReport, form: str) -> str:
    """The report in a format.

    Raises:
        UnknownNameError: There is no such format.
    """
    if form not in FORMATS:
        raise UnknownNameError("format", form, FORMATS)
    return FORMATS[form](report)
