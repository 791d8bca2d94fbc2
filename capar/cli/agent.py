"""Declare agents, show what is known of them, and join two that are one person."""

from typing import Annotated

import typer

from capar.cli._abilities import declare_abilities
from capar.cli._options import Place, Wait, require_actionary
from capar.cli._output import print_fields, print_json, print_names

app = typer.Typer(no_args_is_help=True)

Name = Annotated[str, typer.Argument(help="An agent, as `capar agent list` prints it.")]
Json = Annotated[bool, typer.Option("--json", help="Print JSON.")]


@app.callback()
def _root() -> None:
    """Say who performs: declared agents, those that were seen, and who is who."""


@app.command()
def new(
    name: Annotated[str, typer.Argument(help="What the agent is called.")],
    kind: Annotated[str, typer.Option(help="Its kind: man, woman, robot ...")] = "",
    can: Annotated[
        list[str] | None, typer.Option(help="An action that it is able to do; may be repeated.")
    ] = None,
    wait: Wait = 0.0,
    actionary: Place = None,
    json: Json = False,
) -> None:
    """Declare an agent; it stays when observations are forgotten."""
    from kb import Actionary

    require_actionary(actionary, observed=True)
    with Actionary.open(actionary, wait_s=wait) as opened:
        opened.declare_agent(name, kind=kind, can=can or ())
    if json:
        print_json({"declared": name})
    else:
        typer.echo(f"declared {name}")


@app.command()
def can(
    name: Name,
    actions: Annotated[list[str], typer.Argument(help="Actions that it is able to do.")],
    wait: Wait = 0.0,
    actionary: Place = None,
    json: Json = False,
) -> None:
    """Declare what an agent that is known is able to do, beside what was observed."""
    declare_abilities(actions, agent=name, actionary=actionary, wait_s=wait, json=json)


@app.command("list")
def list_agents(actionary: Place = None, json: Json = False) -> None:
    """List every agent; one without a name is called by the capture that it is of."""
    from kb import Actionary

    with Actionary.open(actionary, read_only=True) as opened:
        found = opened.agents()
    print_names(found, json=json)


@app.command()
def show(name: Name, actionary: Place = None, json: Json = False) -> None:
    """Show what is known of an agent, field by field, and of which fields nothing is recorded."""
    from kb import Actionary

    with Actionary.open(actionary, read_only=True) as opened:
        print_fields(name, opened.agent_profile(name), json=json)


@app.command()
def same(
    name: Name,
    other: Annotated[str, typer.Argument(help="The agent that is the same one.")],
    wait: Wait = 0.0,
    actionary: Place = None,
    json: Json = False,
) -> None:
    """Make two agents one: what OTHER did, and will be observed to do, is NAME's."""
    from kb import Actionary

    require_actionary(actionary, observed=True)
    with Actionary.open(actionary, wait_s=wait) as opened:
        opened.same_agent(name, other)
    if json:
        print_json({"agent": name, "joined": other})
    else:
        typer.echo(f"{other} is {name}")
