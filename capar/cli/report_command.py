"""Reports over the rule base and an Actionary."""

from enum import StrEnum
from pathlib import Path
from typing import Annotated

import typer

from capar.cli._options import Rules, opened, rule_base

app = typer.Typer(no_args_is_help=True, help="Reports over the rule base and an Actionary.")


@app.callback()
def _reports() -> None:
    """Reports over the rule base and an Actionary."""


class Format(StrEnum):
    """How a report is written."""

    TEXT = "text"
    MD = "md"
    HTML = "html"
    CSV = "csv"
    JSON = "json"
    LATEX = "latex"
    SVG = "svg"


@app.command()
def linguistics(
    actionary: Annotated[
        str | None, typer.Option(help="Folder or address; else CAPAR_ACTIONARY, else ./actionary.")
    ] = None,
    form: Annotated[
        Format, typer.Option("--format", help="How to write it; svg is the drawing alone.")
    ] = Format.TEXT,
    rules: Rules = None,
    out: Annotated[Path | None, typer.Option(help="A file, instead of standard output.")] = None,
    cases: Annotated[
        Path | None, typer.Option(help="Folder of rule cases that count as proof, as tests/rules.")
    ] = None,
    corrected: Annotated[
        bool,
        typer.Option("--corrected", help="Count what persons say of segments (`capar correct`)."),
    ] = False,
    json: Annotated[bool, typer.Option("--json", help="The same as --format json.")] = False,
) -> None:
    """Which verbs and classes of verbs the system addresses, with what proves it."""
    from capar.cli._options import open_words
    from capar.cli._output import check_writable, written
    from capar.pipelines.linguistic_report import cases_of, primitive_files
    from capar.pipelines.linguistic_report import linguistics as report_of
    from kb.reports.writing import write

    if out is not None:
        check_writable(out)
    files = primitive_files(rule_base("extended", rules, opened(actionary)).added)
    with open_words(actionary) as opened_store:
        store = opened_store
        if corrected and store is not None:
            from kb.corrected_view import corrected as corrected_copy

            store = corrected_copy(store)
        report = report_of(files, store=store, cases=cases_of(files, cases))
    text = write(report, Format.JSON.value if json else form.value)
    if out is None:
        typer.echo(text, nl=False)
        return
    with written(out) as draft:
        draft.write_text(text, encoding="utf-8")
