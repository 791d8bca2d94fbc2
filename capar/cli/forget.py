"""Take observations back."""

from typing import Annotated

import typer

from capar.cli._options import Place, Wait

app = typer.Typer()


@app.command()
def forget(
    names: Annotated[list[str], typer.Argument(help="The observations, by their captures' names.")],
    wait: Wait = 0.0,
    actionary: Place = None,
) -> None:
    """Take observations back, and everything that nothing else says."""
    from kb import Actionary

    with Actionary.open(actionary, wait_s=wait) as opened:
        for name in names:
            opened.forget(name)
            typer.echo(f"forgot {name}")
