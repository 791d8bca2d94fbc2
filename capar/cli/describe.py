"""A capture in; what happened out, in plain English."""

from enum import StrEnum
from typing import Annotated

import typer

from capar.cli._options import Beside, Rules, rule_base

app = typer.Typer()


class Detail(StrEnum):
    """How much is described."""

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
    rules: Rules = None,
    actionary: Beside = None,
    json: Annotated[bool, typer.Option("--json", help="Print JSON.")] = False,
) -> None:
    """Say in plain English what was done in CAPTURE."""
    from capar.cli._options import rule_words
    from capar.cli._output import print_json
    from capar.pipelines.observation import observe
    from capar.views.notices import reservation_lines, reservations
    from kb.language.describe import describe as told

    observation = observe(capture, rules=rule_base(profile, rules, actionary))
    words = rule_words(rules, actionary)
    text = told(observation, detail=detail.value, timed=timed, words=words)
    notices = reservations(observation.notices)
    if json:
        told_of = {"capture": observation.capture, "description": text}
        print_json(told_of | {"notices": [each.document() for each in notices]}, sort_keys=True)
    else:
        typer.echo("\n".join((text, *reservation_lines(notices))))
