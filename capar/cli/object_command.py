"""Show what is known of the kinds of objects."""

from typing import Annotated

import typer

from capar.cli._abilities import declare_abilities
from capar.cli._options import Place, Wait
from capar.cli._output import print_fields, print_names

app = typer.Typer(no_args_is_help=True)

Json = Annotated[bool, typer.Option("--json", help="Print JSON.")]


@app.callback()
def _root() -> None:
    """Say what is known of objects, which is kept by their kinds."""


@app.command("list")
def list_objects(actionary: Place = None, json: Json = False) -> None:
    """List every kind of object that was observed or declared."""
    from kb import Actionary

    with Actionary.open(actionary, read_only=True) as opened:
        found = opened.object_kinds()
    print_names(found, json=json)


@app.command()
def can(
    kind: Annotated[str, typer.Argument(help="A kind of object, as `capar object list` has it.")],
    actions: Annotated[list[str], typer.Argument(help="Actions that it lends itself to.")],
    wait: Wait = 0.0,
    actionary: Place = None,
    json: Json = False,
) -> None:
    """Declare what a kind of object can be used for, beside what was observed."""
    declare_abilities(actions, kind=kind, actionary=actionary, wait_s=wait, json=json)


@app.command()
def show(
    name: Annotated[str, typer.Argument(help="A kind of object, or the name of an object.")],
    actionary: Place = None,
    json: Json = False,
) -> None:
    """Show what is known of a kind of object, field by field, and which fields are empty."""
    from kb import Actionary

    with Actionary.open(actionary, read_only=True) as opened:
        print_fields(name, opened.object_profile(name), json=json)
