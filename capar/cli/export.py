"""Write the Actionary to a file that others can read."""

import sys
from pathlib import Path
from typing import Annotated

import typer

from capar.cli._options import Place

app = typer.Typer()


@app.command()
def export(
    file: Annotated[
        Path | None, typer.Argument(help="Where to; standard output if left out.")
    ] = None,
    format_: Annotated[
        str | None,
        typer.Option(
            "--format", help="turtle, trig, nquads, jsonld or rdfxml; else by the file's name."
        ),
    ] = None,
    observation: Annotated[
        str | None, typer.Option(help="Only this observation, with all that it mentions.")
    ] = None,
    soma: Annotated[
        bool,
        typer.Option(
            "--soma", help="Write the observation as an episode in terms of SOMA and DUL alone."
        ),
    ] = False,
    actionary: Place = None,
) -> None:
    """Write everything, or one observation, as Turtle, TriG, N-Quads, JSON-LD or RDF/XML."""
    from capar.cli._output import check_writable, written
    from capar.model.errors import CaparError
    from kb import Actionary
    from kb.exchange import export as exported
    from kb.exchange import format_of, misplaced
    from kb.soma_episode import export_episode

    if soma and observation is None:
        raise CaparError("--soma writes one episode; name it by --observation")
    chosen = format_of(file or "", format_ or (None if file else "trig"))
    if file is not None:
        check_writable(file)
    with Actionary.open(actionary, read_only=True) as opened:
        if soma and observation is not None:
            data = export_episode(opened.store, chosen, observation)
        else:
            data = exported(opened.store, chosen, observation=observation)
        lost = (
            misplaced(opened.store) if chosen in {"turtle", "rdfxml"} and observation is None else 0
        )
    if lost:
        typer.echo(
            f"capar: {chosen} has no graphs; {lost} statements would come back in another one. "
            "TriG and N-Quads keep them.",
            err=True,
        )
    if file is None:
        sys.stdout.buffer.write(data)
        return
    with written(file) as draft:
        draft.write_bytes(data)
    what = f"observation {observation}" if observation else "everything"
    typer.echo(f"wrote {what} to {file}: {len(data):,} bytes of {chosen}", err=True)
