"""Answer questions over HTTP."""

from typing import Annotated

import typer

from capar.cli._options import Place

app = typer.Typer()


@app.command()
def serve(
    host: Annotated[str, typer.Option(help="Where to listen; by default on this computer.")] = (
        "127.0.0.1"
    ),
    port: Annotated[int, typer.Option(min=0, max=65535, help="0 takes any free one.")] = 7879,
    token: Annotated[
        str,
        typer.Option(envvar="CAPAR_TOKEN", help="Let clients that bear this token add statements."),
    ] = "",
    time_limit: Annotated[float, typer.Option(help="For a query, in seconds.")] = 30.0,
    actionary: Place = None,
) -> None:
    """Answer SPARQL and named questions over HTTP, until Ctrl-C; / lists what can be asked."""
    from kb import Actionary
    from kb.serving.http_server import ActionaryServer
    from kb.serving.service import Service
    from kb.store.stores import place

    where = place(actionary)
    with Actionary.open(where, read_only=True) as opened:
        count = len(opened.observations())
    with ActionaryServer(Service(where, token, time_limit), host=host, port=port) as server:
        if not server.loopback:
            typer.echo(f"capar: {host} can be reached from other computers", err=True)
        typer.echo(f"{where} ({count} observations) is at {server.url}", err=True)
        server.serve_forever()
