"""How commands tell round trips."""

from collections.abc import Callable, Iterable
from typing import Protocol, TypeVar

import typer


class Tried(Protocol):
    """A round trip that was made or refused."""

    @property
    def refused(self) -> str:
        """Why it was not performed; empty if it was."""

    @property
    def passed(self) -> bool:
        """Whether everything came out the same, with every gate."""


T = TypeVar("T", bound=Tried)


def tell_trips(trips: Iterable[T], row: Callable[[T], str], *, heading: str, json: bool) -> None:
    """Print each trip when it has been made, and how many passed; or all as JSON."""
    from capar.cli._output import print_json

    made = []
    if not json:
        typer.echo(heading)
    for trip in trips:
        made.append(trip)
        if not json:
            typer.echo(row(trip))
    if json:
        print_json(made)
        return
    done = [trip for trip in made if not trip.refused]
    passed = sum(trip.passed for trip in done)
    typer.echo(f"{len(made)} asked, {len(done)} in reach, {passed} passed")
