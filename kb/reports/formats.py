"""The linguistic report as tables of rows, and the formats in which they are written."""

import csv
import io
import json
import textwrap
from collections.abc import Callable, Iterable, Mapping
from dataclasses import asdict
from html import escape
from importlib.resources import files
from string import Template
from typing import TypeAlias

from capar.model.errors import UnknownNameError
from kb.reports.linguistics import LinguisticReport

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
    """One page that loads nothing, with every table."""
    sections, links = [], []
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
}


def write(report: LinguisticReport, form: str) -> str:
    """The report in a format.

    Raises:
        UnknownNameError: There is no such format.
    """
    if form not in FORMATS:
        raise UnknownNameError("format", form, FORMATS)
    return FORMATS[form](report)
