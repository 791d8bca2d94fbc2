"""What every command that uses the Actionary takes and prints."""

from typing import Annotated

import typer

Place = Annotated[
    str | None,
    typer.Option(
        "--actionary",
        metavar="PATH|URL",
        help="The Actionary: a folder, or a SPARQL server's address. "
        "Else CAPAR_ACTIONARY, else ./actionary.",
        show_default=False,
    ),
]

Wait = Annotated[
    float, typer.Option(metavar="SECONDS", help="How long to wait for another writer.")
]
