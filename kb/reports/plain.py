"""The linguistic report as text, Markdown, CSV, LaTeX and JSON."""

import csv
import io
import json
import re
import textwrap
from collections.abc import Sequence
from dataclasses import asdict

from kb.reports.linguistics import ClassReport, LinguisticReport, named
from kb.reports.tables import DOUBTS, EVIDENCE, NOTES, Table, coverage, shown_by, tables

TITLE = "Verbs that the system addresses"
WIDTH = 96


def as_text(report: LinguisticReport) -> str:
    """For a terminal: figures, then a paragraph for each class, then senses and remarks."""
    lines = [TITLE, "=" * len(TITLE), ""]
    lines += [f"{what}: {much}" for what, much in coverage(report)]
    lines += ["", *textwrap.wrap(EVIDENCE, WIDTH)]
    for levin in report.classes:
        lines += ["", *_class_text(levin)]
    lines += ["", "Senses", "------"]
    for row in report.senses:
        old = f", sense {row.link.number_1_6} in 1.6" if row.link.number_1_6 else ""
        gloss = row.synset.definition if row.synset else "not in WordNet 3.1"
        lines += _wrapped(
            f"{row.link.primitive}: {row.link.verb} {row.number_3_1} ({row.link.key}{old}), by the "
            f"{row.link.claimed_by.value}: {gloss}. {row.link.remark}"
        )
    lines += ["", "Remarks", "-------"]
    for remark in report.remarks:
        lines += _wrapped(f"{remark.levin} {remark.verb}: {remark.text}")
    if report.doubts:
        lines += ["", DOUBTS, "-" * len(DOUBTS)]
        lines += [line for doubt in report.doubts for line in _wrapped(f"{doubt}.")]
    return "\n".join(line.rstrip() for line in lines) + "\n"


def _class_text(each: ClassReport) -> list[str]:
    head = f"{each.number} {each.title}: {each.status.words} (thesis: {', '.join(each.thesis)})"
    lines = [head, *_wrapped(each.reason)]
    lines += _wrapped(f"Primitives: {named(each.primitives)}. Rules: {named(each.files)}.")
    if each.proofs:
        lines += _wrapped(f"Shown by {shown_by(each)}; {each.segments} segments in all.")
    for claim in each.claims:
        lines += _wrapped(
            f"Thesis {claim.section}, {', '.join(claim.verbs)}: {claim.status}. “{claim.quote}”"
        )
    for remark in each.remarks:
        lines += _wrapped(f"Remark: {remark.text}")
    return lines


def _wrapped(text: str) -> list[str]:
    return textwrap.wrap(text, WIDTH, initial_indent="  ", subsequent_indent="    ")


def as_markdown(report: LinguisticReport) -> str:
    """Tables of Markdown under headings."""
    parts = [f"# {TITLE}\n"]
    for title, heads, rows in tables(report):
        lines = [_md_row(heads), _md_row(["---"] * len(heads)), *map(_md_row, rows)]
        note = f"{NOTES[title]}\n\n" if title in NOTES else ""
        parts.append(f"## {title}\n\n{note}" + "\n".join(lines) + "\n")
    return "\n".join(parts)


def _md_row(cells: Sequence[str]) -> str:
    escaped = (cell.replace("\\", "\\\\").replace("|", "\\|").replace("\n", " ") for cell in cells)
    return f"| {' | '.join(escaped)} |"


def as_csv(report: LinguisticReport) -> str:
    """The table of verbs with what the classes say, one line a verb."""
    found = {title: (heads, rows) for title, heads, rows in tables(report)}
    class_heads, classes = found["Classes"]
    heads, rows = found["Verbs"]
    of_class = {row[0]: row for row in classes}
    out = io.StringIO()
    writer = csv.writer(out, lineterminator="\n")
    writer.writerow([*heads, *(f"class: {each}" for each in class_heads[1:])])
    for row in rows:
        writer.writerow([*row, *of_class[row[0]][1:]])
    return out.getvalue()


_PREAMBLE = r"""\documentclass[a4paper]{article}
\usepackage[T1]{fontenc}
\usepackage[utf8]{inputenc}
\usepackage[landscape,margin=15mm]{geometry}
\usepackage{array,booktabs,longtable}
\begin{document}
\setlength{\LTcapwidth}{\linewidth}
\footnotesize
"""

LONGEST_MEAN = 30
"""A column's mean length counts up to so many characters, so that long texts wrap."""


def as_latex(report: LinguisticReport) -> str:
    """A document of its tables, for any LaTeX with array, booktabs, geometry and longtable."""
    found = [_latex_table(each) for each in tables(report)]
    return "\n".join([_PREAMBLE, *found, r"\end{document}", ""])


def _latex_table(table: Table) -> str:
    title, heads, rows = table
    caption = f"{title}. {NOTES[title]}" if title in NOTES else title
    columns = "".join(
        rf">{{\raggedright\arraybackslash}}p{{\dimexpr{share:.3f}\linewidth-2\tabcolsep}}"
        for share in _shares(heads, rows)
    )
    head = [r"\toprule", " & ".join(map(_latex, heads)) + r" \\", r"\midrule"]
    return "\n".join(
        [
            rf"\begin{{longtable}}{{{columns}}}",
            rf"\caption{{{_latex(caption)}}}\\",
            *head,
            r"\endfirsthead",
            *head,
            r"\endhead",
            *(" & ".join(map(_latex, row)) + r" \\" for row in rows),
            r"\bottomrule",
            r"\end{longtable}",
            "",
        ]
    )


def _shares(heads: Sequence[str], rows: Sequence[Sequence[str]]) -> list[float]:
    """The width of each column as a share of the line: by its longest word and its mean length."""
    widths = []
    for head, *cells in zip(heads, *rows, strict=True):
        words = [word for cell in (head, *cells) for word in _BREAK.sub(r"\1 ", cell).split()]
        mean = sum(map(len, cells)) / max(len(cells), 1)
        widths.append(max(*map(len, words), min(mean, LONGEST_MEAN)) + 2)
    return [int(1000 * width / sum(widths)) / 1000 for width in widths]


_BREAK = re.compile(r"([/_]|[a-z](?=[A-Z][a-z]))")
"""After these a line may end: in paths, and between the words of a name."""

_LATEX = str.maketrans(
    {
        "\\": r"\textbackslash{}",
        "&": r"\&",
        "%": r"\%",
        "$": r"\$",
        "#": r"\#",
        "_": r"\_",
        "{": r"\{",
        "}": r"\}",
        "~": r"\textasciitilde{}",
        "^": r"\textasciicircum{}",
        "“": "``",
        "”": "''",
        "–": "--",
    }
)


def _latex(text: str) -> str:
    """The text with what LaTeX reads as its own escaped, and with places where a line may end."""
    parts = [part.translate(_LATEX) for part in _BREAK.sub("\\1\0", text).split("\0")]
    return r"\allowbreak{}".join(parts)


def as_json(report: LinguisticReport) -> str:
    """Everything, by the names of the values."""
    value = asdict(report)
    for each, plain in zip(report.classes, value["classes"], strict=True):
        plain["reason"] = each.reason
        plain["thesis"] = list(each.thesis)
    return json.dumps(value, ensure_ascii=False, indent=2, sort_keys=True) + "\n"
