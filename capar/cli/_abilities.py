"""What ``capar agent can`` and ``capar object can`` share: declaring abilities of what is known."""

from collections.abc import Sequence

import typer

from capar.cli._options import require_actionary
from capar.cli._output import print_json
from capar.model.errors import UnknownNameError


def declare_abilities(
    actions: Sequence[str],
    *,
    agent: str = "",
    kind: str = "",
    actionary: str | None,
    wait_s: float,
    json: bool,
) -> None:
    """Declare what an agent is able to do, or what a kind of object can be used for, and say so.

    Args:
        actions: The names of the actions.
        agent: The agent; empty where it is a kind of object.
        kind: The kind of object; empty where it is an agent.
        actionary: The Actionary; None for the usual one.
        wait_s: How long to wait for another writer [s].
        json: Whether to print JSON.

    Raises:
        UnknownNameError: There is no such agent or kind of object.
    """
    from kb import Actionary

    require_actionary(actionary, observed=True)
    with Actionary.open(actionary, wait_s=wait_s) as opened:
        known = opened.agents() if agent else opened.object_kinds()
        if (agent or kind) not in known:
            raise UnknownNameError("agent" if agent else "kind of object", agent or kind, known)
        for action in actions:
            opened.add_ability(action, agent=agent, kind=kind)
    if json:
        print_json({"agent" if agent else "kind": agent or kind, "declared": actions})
    else:
        typer.echo(f"declared of {agent or f'every {kind}'}: {', '.join(actions)}")
