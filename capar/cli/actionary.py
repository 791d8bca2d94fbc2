"""Change the Actionary: agents, kinds of objects, corrections, forgotten observations."""

import csv
from collections.abc import Collection, Mapping, Sequence
from io import StringIO
from pathlib import Path
from typing import Annotated

import typer
from typer import Argument, Option

from capar.cli.options import (
    Json,
    Place,
    Wait,
    has_actionary,
    opened,
    require_actionary,
    rule_words,
)
from capar.cli.output import answer, check_writable, emit
from capar.model.errors import UnknownNameError

agent = typer.Typer(no_args_is_help=True, help="Who performs: declared, seen, and who is who.")
object_ = typer.Typer(no_args_is_help=True, help="What is known of objects, by their kinds.")

Agent = Annotated[str, Argument(help="An agent, as `capar agent list` prints it.")]
LABEL_COLUMNS = ("link", "start_s", "end_s", "label", "object")
"""Of a table of labels, as `capar evaluate` reads it."""


@agent.command("new")
def new_agent(
    name: Annotated[str, Argument(help="What the agent is called.")],
    kind: Annotated[str, Option(help="Its kind: man, woman, robot ...")] = "",
    can: Annotated[list[str] | None, Option(help="An ability; may be repeated.")] = None,
    wait: Wait = 0.0,
    actionary: Place = None,
    json: Json = False,
) -> None:
    """Declare an agent; it stays when observations are forgotten."""
    from kb import Actionary

    require_actionary(actionary, observed=True)
    with Actionary.open(actionary, wait_s=wait) as opened:
        opened.declare_agent(name, kind=kind, can=can or ())
    answer({"declared": name}, [f"declared {name}"], json=json)


@agent.command("can")
def agent_can(
    name: Agent,
    actions: Annotated[list[str], Argument(help="Actions that it is able to do.")],
    wait: Wait = 0.0,
    actionary: Place = None,
    json: Json = False,
) -> None:
    """Declare what a known agent is able to do, beside what was observed."""
    _declare(actions, agent=name, actionary=actionary, wait_s=wait, json=json)


@agent.command("list")
def list_agents(actionary: Place = None, json: Json = False) -> None:
    """List every agent; one without a name is called by its capture.

    Where no Actionary is named and none is here: the ready-made agents of `capar regenerate`.
    """
    from kb import Actionary

    place = opened(actionary)
    if not actionary and not has_actionary(place, named=place):
        from capar.body.anthropometry import READY_MADE

        typer.echo(f"{place} is no Actionary; agents that are ready-made:", err=True)
        answer(list(READY_MADE), READY_MADE, json=json)
        return
    with Actionary.open(actionary, read_only=True) as book:
        found = list(book.agents())
    answer(found, found, json=json)


@agent.command("show")
def show_agent(name: Agent, actionary: Place = None, json: Json = False) -> None:
    """Show what is known of an agent, field by field."""
    from kb import Actionary

    with Actionary.open(actionary, read_only=True) as opened:
        _print_fields(name, opened.agent_profile(name), json=json)


@agent.command("same")
def same_agent(
    name: Agent,
    other: Annotated[str, Argument(help="The agent that is the same one.")],
    wait: Wait = 0.0,
    actionary: Place = None,
    json: Json = False,
) -> None:
    """Make two agents one: what OTHER does is NAME's, also in future."""
    from kb import Actionary

    require_actionary(actionary, observed=True)
    with Actionary.open(actionary, wait_s=wait) as opened:
        opened.same_agent(name, other)
    answer({"agent": name, "joined": other}, [f"{other} is {name}"], json=json)


@object_.command("list")
def list_objects(actionary: Place = None, json: Json = False) -> None:
    """List every kind of object that was observed or declared."""
    from kb import Actionary

    with Actionary.open(actionary, read_only=True) as opened:
        found = list(opened.object_kinds())
    answer(found, found, json=json)


@object_.command("can")
def object_can(
    kind: Annotated[str, Argument(help="A kind of object, as `capar object list` has it.")],
    actions: Annotated[list[str], Argument(help="Actions that it can be used for.")],
    wait: Wait = 0.0,
    actionary: Place = None,
    json: Json = False,
) -> None:
    """Declare what a kind of object can be used for, beside what was observed."""
    _declare(actions, kind=kind, actionary=actionary, wait_s=wait, json=json)


@object_.command("show")
def show_object(
    name: Annotated[str, Argument(help="A kind of object, or the name of an object.")],
    actionary: Place = None,
    json: Json = False,
) -> None:
    """Show what is known of a kind of object, field by field."""
    from kb import Actionary

    with Actionary.open(actionary, read_only=True) as opened:
        _print_fields(name, opened.object_profile(name), json=json)


def _print_fields(title: str, fields: Mapping[str, Collection[str]], *, json: bool) -> None:
    """Fields with their values, a line each; a field without any is said to be empty."""
    lines = (
        f"  {name}: {', '.join(values) or '(empty: nothing is recorded)'}"
        for name, values in fields.items()
    )
    value = {"name": title, **{name: list(values) for name, values in fields.items()}}
    answer(value, [title, *lines], json=json)


def _declare(
    actions: Sequence[str],
    *,
    agent: str = "",
    kind: str = "",
    actionary: str | None,
    wait_s: float,
    json: bool,
) -> None:
    """Declare what an agent, or every object of a kind, can do or be used for."""
    from kb import Actionary

    require_actionary(actionary, observed=True)
    with Actionary.open(actionary, wait_s=wait_s) as opened:
        known = opened.agents() if agent else opened.object_kinds()
        if (agent or kind) not in known:
            raise UnknownNameError("agent" if agent else "kind of object", agent or kind, known)
        for action in actions:
            opened.add_ability(action, agent=agent, kind=kind)
    value = {"agent" if agent else "kind": agent or kind, "declared": actions}
    text = f"declared of {agent or f'every {kind}'}: {', '.join(actions)}"
    answer(value, [text], json=json)


def correct(
    segment: Annotated[str, Argument(help="CAPTURE/END_EFFECTOR/INDEX, or CAPTURE to print all.")],
    name: Annotated[str, Option(help="What was done in it.")] = "",
    start: Annotated[float | None, Option(metavar="SECONDS", help="When it began.")] = None,
    end: Annotated[float | None, Option(metavar="SECONDS", help="When it ended.")] = None,
    split: Annotated[
        float | None, Option(metavar="SECONDS", help="Where it is split in two.")
    ] = None,
    join: Annotated[bool, Option("--join", help="It is one with the next.")] = False,
    by: Annotated[str, Option(metavar="PERSON", help="Who says so.")] = "",
    labels: Annotated[Path | None, Option(help="Write labels to this CSV file.")] = None,
    json: Json = False,
    wait: Wait = 0.0,
    actionary: Place = None,
) -> None:
    """Keep a person's claim about a segment.

    Then what was done according to all claims is printed. The machine's segments stay as they are,
    and claims stay when the capture is observed again. Segments are counted as this command prints
    them. `capar query --corrected` asks what persons say; `capar query corrections` lists claims.
    """
    from dataclasses import replace

    from capar.model.observation import split_capture
    from kb import Actionary
    from kb.corrections import Correction, account
    from kb.corrections import correct as claim

    if labels is not None:
        check_writable(labels)
    require_actionary(actionary, observed=True)
    change = (name, start, end, split, join)
    asked = by or change != ("", None, None, None, False)
    capture, address = split_capture(segment) if asked else (segment, None)
    with Actionary.open(actionary, read_only=address is None, wait_s=wait) as opened:
        if address:
            address = replace(address, capture=capture)
            claim(opened.store, address, Correction(*change), by=by)
            _note_new_name(name, actionary)
        spans = account(opened.store, capture)
    if labels is not None:
        text = StringIO()
        table = csv.writer(text, lineterminator="\n")
        table.writerow(LABEL_COLUMNS)
        for span in spans:
            first = span.objects.split(" ")[0]
            table.writerow((span.ee, span.start_s, span.end_s, span.name, first))
        emit(text.getvalue(), labels)
    counts: dict[str, int] = {}
    lines = []
    for span in spans:
        at = counts[span.ee] = counts.get(span.ee, -1) + 1
        lines.append(
            f"{capture}/{span.ee}/{at}  {span.start_s:.3f} to {span.end_s:.3f} s  {span.name}"
            + (f"  says {span.by}" if span.by else "")
        )
    answer(list(spans), lines, json=json)


def _note_new_name(name: str, actionary: str | None) -> None:
    """Say that no rule gives the name, which may be meant so, and the nearest that one gives."""
    from difflib import get_close_matches

    from capar.model.par import UNKNOWN

    known = [words.name for words in rule_words(None, actionary)]
    if name and name not in {*known, UNKNOWN}:
        near = get_close_matches(name, known, n=1)
        hint = f"; did you mean {near[0]!r}?" if near else ""
        typer.echo(f"note: no rule gives the name {name!r}{hint}", err=True)


def forget(
    names: Annotated[list[str], Argument(help="The observations, by their captures' names.")],
    wait: Wait = 0.0,
    actionary: Place = None,
) -> None:
    """Remove observations, and everything that nothing else says."""
    from kb import Actionary

    with Actionary.open(actionary, wait_s=wait) as opened:
        for name in names:
            opened.forget(name)
            typer.echo(f"forgot {name}")
