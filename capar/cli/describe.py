"""A capture in; what happened out, in plain English."""

from enum import StrEnum
from typing import TYPE_CHECKING, Annotated

import typer

from capar.cli._options import Beside, Rules, rule_base

if TYPE_CHECKING:
    from capar.model.observation import Observation

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
    corrected: Annotated[
        bool,
        typer.Option(
            "--corrected", help="Say what persons claim of segments (`capar correct`) instead."
        ),
    ] = False,
    rules: Rules = None,
    actionary: Beside = None,
    json: Annotated[bool, typer.Option("--json", help="Print JSON.")] = False,
) -> None:
    """Say in plain English what was done in CAPTURE."""
    from capar.cli._options import rule_words
    from capar.cli._output import print_json
    from capar.pipelines.observation import observe
    from capar.views.notices import reservation_lines, reservations_on_told
    from kb.language.describe import describe as told
    from kb.language.realisation import nouns

    observation = observe(capture, rules=rule_base(profile, rules, actionary))
    if corrected:
        observation = _corrected(observation, actionary)
    words = rule_words(rules, actionary)
    text = told(observation, detail=detail.value, timed=timed, words=words)
    notices = reservations_on_told(observation)
    if json:
        told_of = {"capture": observation.capture, "description": text}
        print_json(told_of | {"notices": [each.document() for each in notices]}, sort_keys=True)
    else:
        typer.echo(
            "\n".join((text, *reservation_lines(notices, called=nouns(observation.objects))))
        )


def _corrected(observation: "Observation", actionary: str | None) -> "Observation":
    """The same with the segments that persons claim in an Actionary."""
    from dataclasses import replace

    from kb import Actionary
    from kb.corrected_links import corrected_links
    from kb.corrections import claims

    with Actionary.open(actionary, read_only=True) as opened:
        said = claims(opened.store, observation.capture)
    return replace(observation, links=corrected_links(observation.links, said))
