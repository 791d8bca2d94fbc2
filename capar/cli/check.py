"""Look whether the Actionary is whole and right."""

import json as json_module
from dataclasses import asdict
from typing import Annotated

import typer

from capar.cli._actionary import Place

app = typer.Typer()


@app.command()
def check(
    fast: Annotated[
        bool,
        typer.Option("--fast", help="Judge by our own reading of the shapes, without pySHACL."),
    ] = False,
    json: Annotated[bool, typer.Option("--json", help="Print the problems as JSON.")] = False,
    actionary: Place = None,
) -> None:
    """Check every observation: SHACL shapes, NLTs, and references to what is not there."""
    from kb import Actionary
    from kb.store_checks import check as checked

    with Actionary.open(actionary, read_only=True) as opened:
        problems = checked(opened.store, full=not fast)
        count = len(opened.observations())
    if json:
        typer.echo(json_module.dumps([asdict(each) for each in problems], indent=2))
    else:
        for each in problems:
            typer.echo(f"{each.observation}: {each.thing}: {each.message}")
        typer.echo(f"{count} observations, {len(problems)} problems")
    if problems:
        raise typer.Exit(2)
