"""Read statements into the Actionary."""

import sys
from pathlib import Path
from typing import Annotated

import typer

from capar.cli._options import New, Place, Wait, confirm_new

app = typer.Typer()


@app.command()
def import_(
    file: Annotated[str, typer.Argument(help="The file, or - for standard input.")],
    format_: Annotated[
        str | None,
        typer.Option("--format", help="turtle, trig, nquads or jsonld; else by the file's name."),
    ] = None,
    wait: Wait = 0.0,
    new: New = False,
    actionary: Place = None,
) -> None:
    """Take in Turtle, TriG, N-Quads or JSON-LD, all of it or none, checked by the shapes.

    An observation in FILE replaces the one of its name.
    """
    from kb import Actionary
    from kb.exchange import bring_in, format_of, read

    chosen = format_of(file, format_)
    confirm_new(actionary, new=new)
    quads = read(_bytes(file), chosen, path=file)
    with Actionary.open(actionary, wait_s=wait) as opened:
        statements, observations = bring_in(opened.store, quads, source=file)
    typer.echo(f"{statements} statements, {observations} observations")


def _bytes(file: str) -> bytes:
    from capar.model.errors import FileError

    if file == "-":
        return sys.stdin.buffer.read()
    try:
        return Path(file).read_bytes()
    except OSError as error:
        raise FileError(file, f"cannot be read ({error.strerror})") from None
