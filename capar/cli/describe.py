"""A capture in; what happened out, in plain English."""

from enum import StrEnum
from pathlib import Path
from typing import Annotated

import typer

app = typer.Typer()


class Detail(StrEnum):
    """How much is told."""

    STEPS = "steps"
    SUMMARY = "summary"


@app.command()
def describe(
    capture: Annotated[
        str,
        typer.Argument(help="A capture bundle's folder or capture.toml; FOLDER:TAKE for a take."),
    ],
    detail: Annotated[
        Detail, typer.Option(help="Every step, or a summary of what changed.")
    ] = Detail.STEPS,
    timed: Annotated[bool, typer.Option("--timed", help="Say when each step was.")] = False,
    profile: Annotated[
        str, typer.Option(help="The rules to reason with: extended, or thesis to the letter.")
    ] = "extended",
    rules: Annotated[
        Path | None,
        typer.Option(help="Folder of your own rule files; else CAPAR_RULES, else ./rules."),
    ] = None,
    json: Annotated[bool, typer.Option("--json", help="Print JSON.")] = False,
) -> None:
    """Say in plain English what was done in CAPTURE."""
    from capar.cli._words import print_json, rule_words
    from capar.words import observed
    from kb.language.describe import describe as told

    observation = observed(capture, profile=profile, rules=rules)
    text = told(observation, detail=detail.value, timed=timed, words=rule_words(rules))
    if json:
        print_json({"capture": observation.capture, "description": text})
    else:
        typer.echo(text)
