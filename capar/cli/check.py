"""Look whether the Actionary is whole and right."""

from typing import Annotated

import typer

from capar.cli._options import Place
from capar.cli._output import print_json

app = typer.Typer()


@app.command()
def check(
    shacl: Annotated[
        bool,
        typer.Option("--shacl", help="Have pySHACL judge every observation as well; minutes."),
    ] = False,
    json: Annotated[bool, typer.Option("--json", help="Print the problems as JSON.")] = False,
    actionary: Place = None,
) -> None:
    """Check that every statement can be read, and every observation: shapes, NLTs, references."""
    from kb import Actionary
    from kb.store_checks import check as checked

    with Actionary.open(actionary, read_only=True) as opened:
        problems = checked(opened.store, full=shacl)
        count = len(opened.observations())
    if json:
        print_json(problems)
    else:
        for problem in problems:
            whose = f"{problem.observation}: " if problem.observation else ""
            typer.echo(f"{whose}{problem.thing}: {problem.message}")
        typer.echo(f"{count} observations, {len(problems)} problems")
    if problems:
        raise typer.Exit(2)
