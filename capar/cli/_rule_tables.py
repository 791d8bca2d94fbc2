"""What the commands about rules print: changes of names, audits, and JSON."""

from collections.abc import Iterator
from typing import TYPE_CHECKING

import typer

if TYPE_CHECKING:
    from capar.rulebook.changes import Renamed
    from capar_rules.lint.audit import Audit


def print_changes(changes: "tuple[Renamed, ...]", others: tuple[str, ...] = ()) -> None:
    """The segments that have another name now, and how many; who was left alone."""
    from capar.model.segment_address import SegmentAddress
    from capar.rulebook.changes import NOTHING

    for each in changes:
        what = f"{each.before} -> {each.after}"
        if NOTHING in (each.before, each.after):
            what = f"{each.before} vanishes" if each.after == NOTHING else f"{each.after} appears"
        address = SegmentAddress(each.ee, each.index, each.capture)
        typer.echo(f"{address}  {each.start_s:.2f} to {each.end_s:.2f} s: {what}")
    typer.echo("1 segment changes" if len(changes) == 1 else f"{len(changes)} segments change")
    print_others(others)


def print_others(others: tuple[str, ...]) -> None:
    """How many observations were left alone, as they were made with another profile."""
    if others:
        several = "s were" if len(others) > 1 else " was"
        typer.echo(
            f"{len(others)} observation{several} made with another profile: left alone", err=True
        )


def print_bearing(count: int, names: list[str]) -> None:
    """How many stored segments bear a name that no rule gives any longer."""
    if count:
        told = "1 stored segment still bears" if count == 1 else f"{count} segments still bear"
        typer.echo(
            f"{told} the name {' or '.join(names)}; observing again renames them, as would "
            "--reclassify have done",
            err=True,
        )


def print_audit(found: "Audit") -> None:
    """What an audit found, and whether the rules are clean."""
    without = len(found.uncovered)
    typer.echo(f"{found.possible} feature sets can be; {without} of them have no name:")
    for line in _uncovered(found):
        typer.echo(line)
    for clash in found.ambiguous:
        where = " ".join(part or "-" for part in clash.features[0])
        typer.echo(f"ambiguous: {clash.first} and {clash.second}, first at {where}")
    for name in found.shadowed:
        typer.echo(f"shadowed: {name}")
    for name in found.unreachable:
        typer.echo(f"never fits in the audit's world: {name}")
    typer.echo("the rules are clean" if found.clean else "the rules are not clean")


def _uncovered(found: "Audit") -> Iterator[str]:
    """Every feature set without a name, under its reason, a line for the relations at its ends.

    What follows each is change of location and force.
    """
    reasons = dict(found.excused)
    groups: dict[str, dict[str, list[str]]] = {}
    for start, end, change, force in found.uncovered:
        reason = reasons.get((start, end, change, force), "NO REASON IS GIVEN")
        ends = f"{start or '-'} > {end or '-'}"
        groups.setdefault(reason, {}).setdefault(ends, []).append(f"{change or '-'}/{force or '-'}")
    for reason, cases in groups.items():
        yield f"  {sum(map(len, cases.values()))}: {reason}"
        for ends, rest in cases.items():
            yield f"    {ends}  {' '.join(rest)}"


def print_json(content: object) -> None:
    """Plain values as JSON on standard output."""
    import json

    typer.echo(json.dumps(content, indent=2))
