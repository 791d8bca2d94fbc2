"""Answers as text: rows of a table, CSV, JSON and Turtle."""

import csv
import io
import json

from pyoxigraph import Literal, RdfFormat, serialize

from kb.queries.questions import questions
from kb.store.answers import Answer, exact, plain, turtle
from kb.store.answers import Found as Term

RESULT_SET = "http://www.w3.org/2001/sw/DataAccess/tests/result-set#"


def header(answer: Answer) -> tuple[str, ...]:
    """The columns of an answer."""
    if answer.boolean is not None:
        return ("answer",)
    return ("subject", "predicate", "object") if answer.triples is not None else answer.variables


def cells(answer: Answer) -> list[tuple[str, ...]]:
    """The rows of an answer as texts for people: numbers short, IRIs with their prefixes."""
    if answer.boolean is not None:
        return [("yes" if answer.boolean else "no",)]
    return [tuple(map(_cell, row)) for row in _rows(answer)]


def _rows(answer: Answer) -> list[tuple[Term, ...]]:
    if answer.triples is not None:
        return [(t.subject, t.predicate, t.object) for t in answer.triples]
    return list(answer.rows)


def _cell(term: Term) -> str:
    value = plain(term)
    if value is None:
        return ""
    return f"{value:.6g}" if isinstance(value, float) else str(value)


def as_csv(answer: Answer) -> str:
    """Comma-separated values with a header, numbers exact, IRIs in full."""
    out = io.StringIO()
    writer = csv.writer(out, lineterminator="\n")
    writer.writerow(header(answer))
    if answer.boolean is not None:
        writer.writerow([str(answer.boolean).lower()])
    else:
        writer.writerows([_exact(each) for each in row] for row in _rows(answer))
    return out.getvalue()


def _exact(term: Term) -> str:
    value = exact(term)
    if isinstance(value, bool):
        return str(value).lower()
    return "" if value is None else str(value)


def as_json(answer: Answer) -> str:
    """A list of objects, IRIs in full, or a truth; statements as JSON-LD."""
    if answer.triples is not None:
        return (serialize(answer.triples, format=RdfFormat.JSON_LD) or b"").decode() + "\n"
    rows = [dict(zip(answer.variables, map(exact, row), strict=True)) for row in answer.rows]
    value = rows if answer.boolean is None else answer.boolean
    return json.dumps(value, indent=2, ensure_ascii=False) + "\n"


def as_turtle(answer: Answer) -> str:
    """Statements; rows and truths in the W3C's vocabulary of result sets."""
    if answer.triples is not None:
        return turtle(answer.triples, form=RdfFormat.TURTLE)
    lines = [f"@prefix rs: <{RESULT_SET}> .", "", "[] a rs:ResultSet"]
    if answer.boolean is not None:
        lines.append(f"    ; rs:boolean {str(answer.boolean).lower()}")
    lines += [f'    ; rs:resultVariable "{name}"' for name in answer.variables]
    for row in answer.rows:
        bindings = ", ".join(
            f'[ rs:variable "{name}" ; rs:value {term} ]'
            for name, term in zip(answer.variables, row, strict=True)
            if term is not None
        )
        lines.append(f"    ; rs:solution [ rs:binding {bindings} ]" if bindings else "")
    return "\n".join([*filter(None, lines[:1]), "", *filter(None, lines[2:])]) + " .\n"


def as_table(answer: Answer) -> str:
    """Aligned columns for anything that is no terminal."""
    rows = [header(answer), *cells(answer)]
    widths = [max(map(len, column)) for column in zip(*rows, strict=True)]
    lines = [
        "  ".join(cell.ljust(width) for cell, width in zip(row, widths, strict=True)).rstrip()
        for row in rows
    ]
    return "\n".join(lines) + "\n"


def listing() -> Answer:
    """The named questions with their parameters, those in brackets not needed."""
    rows = []
    for question in questions().values():
        names = (p.name if p.required else f"[{p.name}]" for p in question.parameters)
        rows.append(tuple(map(Literal, (question.name, " ".join(names), question.text))))
    return Answer(("name", "parameters", "question"), tuple(rows))


FORMATS = {"table": as_table, "csv": as_csv, "json": as_json, "turtle": as_turtle}
"""How an answer may be printed."""
