"""What the commands about rules print: changes of names, audits, and JSON."""

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
    """What an audit found, a line each, and whether the rules are clean."""
    reasons = dict(found.excused)
    typer.echo(f"{found.possible} feature sets can be; {len(found.uncovered)} have no name")
    for each in found.uncovered:
        shown = " ".join(part or "-" for part in each)
        typer.echo(f"  {shown}: {reasons.get(each, 'NO REASON GIVEN')}")
    for clash in found.ambiguous:
        where = " ".join(part or "-" for part in clash.features[0])
        typer.echo(f"ambiguous: {clash.first} and {clash.second}, first at {where}")
    for name in found.shadowed:
        typer.echo(f"shadowed: {name}")
    for name in found.unreachable:
        typer.echo(f"never fits in the audit's world: {name}")
    typer.echo("the rules are clean" if found.clean else "the rules are not clean")


def print_json(content: object) -> None:
    """Plain values as JSON on standard output."""
    import json

    typer.echo(json.dumps(content, indent=2))
