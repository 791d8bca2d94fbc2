"""The command that shows the system at work on a capture that ships with it."""

from pathlib import Path
from typing import Annotated

import typer

app = typer.Typer()


@app.command()
def demo(
    plot: Annotated[
        Path, typer.Option(help="Where to draw the picture: a .png, .svg or .pdf file.")
    ] = Path("drink_from_mug.png"),
) -> None:
    """Observe the shipped capture of somebody who drinks from a mug, and draw it."""
    from importlib import resources

    from capar.cli.observe import observe

    with resources.as_file(resources.files("capar") / "demo" / "drink_from_mug") as bundle:
        observe(str(bundle), name="DrinkFromMug", plot=plot)
