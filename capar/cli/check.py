"""Look whether the Actionary is whole and right."""

from typing import Annotated

import typer

from capar.cli._options import Place
from capar.cli._output import print_json

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
        print_json(problems)
    else:
        for each in problems:
            typer.echo(f"{each.observation}: {each.thing}: {each.message}")
        typer.echo(f"{count} observations, {len(problems)} problems")
    if problems:
        raise typer.Exit(2)
