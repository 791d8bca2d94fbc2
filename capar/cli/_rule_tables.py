"""What the commands about rules print: changes of names, audits, and JSON."""

from collections.abc import Iterator
from typing import TYPE_CHECKING

import typer

if TYPE_CHECKING:
    from capar.rule_changes import Renamed
    from capar_rules.auditing import Audit


def print_changes(changes: "tuple[Renamed, ...]") -> None:
    """The segments that have another name now, and how many."""
    for each in changes:
        typer.echo(
            f"{each.capture}  {each.ee}/{each.index}  {each.start_s:.2f} to {each.end_s:.2f} s: "
            f"{each.before} -> {each.after}"
        )
    typer.echo("1 segment changes" if len(changes) == 1 else f"{len(changes)} segments change")


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
