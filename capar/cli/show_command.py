"""Draw a complex action as the Actionary knows it."""

from typing import Annotated

import typer

from capar.cli._options import Place

app = typer.Typer()


@app.command()
def show(
    name: Annotated[str, typer.Argument(help="The complex action, or an observation of it.")],
    format_: Annotated[str, typer.Option("--format", help="text, svg or turtle.")] = "text",
    actionary: Place = None,
) -> None:
    """Draw the complex action NAME: its steps, their shares of time, and who was seen to do it."""
    from capar.model.errors import UnknownNameError
    from kb import Actionary
    from kb.reports.complex_action_drawing import FORMATS

    if format_ not in FORMATS:
        raise UnknownNameError("format", format_, FORMATS)
    with Actionary.open(actionary, read_only=True) as opened:
        typer.echo(FORMATS[format_](opened.store, name), nl=False)
