"""The command that says why a segment has its name, and why not another."""

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from capar.cli._rules import Beside, Rules, Steady, rule_base

if TYPE_CHECKING:
    from capar_rules.explaining import Explanation, Reason
    from capar_rules.why_not import Alternative

app = typer.Typer()


@app.command()
def explain(
    capture: Annotated[
        str,
        typer.Argument(help="A capture bundle's folder or capture.toml; FOLDER:TAKE for a take."),
    ],
    segment: Annotated[
        str | None,
        typer.Argument(help="END_EFFECTOR/INDEX, such as right_hand/3; without it, every one."),
    ] = None,
    why_not: Annotated[
        str | None,
        typer.Option(help="A name that it has not: say what would have had to be otherwise."),
    ] = None,
    every: Annotated[
        bool, typer.Option("--all", help="With --why-not: every answer that is as small.")
    ] = False,
    profile: Annotated[str, typer.Option(help="The rules: extended or thesis.")] = "extended",
    rules: Rules = None,
    actionary: Beside = None,
    steady: Steady = None,
    json: Annotated[bool, typer.Option("--json", help="Print the whole tree as JSON.")] = False,
    svg: Annotated[Path | None, typer.Option(help="Draw the tree to this file.")] = None,
) -> None:
    """Say why SEGMENT of CAPTURE has its name: the rules and facts behind it, in sentences."""
    from capar.explanation import explained, segment_named
    from capar_rules.why_not import why_not as alternatives
    from extractors.readers.bundle import read_capture

    base = rule_base(profile, rules, actionary, steady=steady)
    seen = explained(read_capture(capture), rules=base)
    chosen = (segment_named(seen.observation, segment),) if segment else seen.observation.segments
    if why_not:
        for each in chosen:
            limit = 100 if every else 1
            _print_alternatives(
                why_not, alternatives(seen.explainer, each, why_not, limit=limit), json=json
            )
        return
    told = [seen.explainer.explain(each) for each in chosen]
    if svg:
        _draw(told, svg)
    _print(told, json=json, tree=segment is not None)


def _print(told: "list[Explanation]", *, json: bool, tree: bool) -> None:
    if json:
        import json as codec

        typer.echo(codec.dumps([_plain(each) for each in told], indent=2))
        return
    for each in told:
        typer.echo(f"{each.ee}/{each.index}  {each.start_s:.2f} to {each.end_s:.2f} s")
        typer.echo(each.summary)
        if tree:
            _branch(each.reason.told(), 0)


def _branch(reason: "Reason", depth: int) -> None:
    frames = f"  [frames {reason.frames[0]} to {reason.frames[1]}]" if reason.frames else ""
    rule = f"  ({reason.rule})" if reason.rule else ""
    typer.echo(f"{'  ' * depth}- {reason.sentence}{frames}{rule}")
    for each in reason.because:
        _branch(each, depth + 1)


def _print_alternatives(name: str, found: "tuple[Alternative, ...]", *, json: bool) -> None:
    from dataclasses import asdict

    if json:
        import json as codec

        rows = [{"sentence": each.sentence, **asdict(each)} for each in found]
        typer.echo(codec.dumps(rows, indent=2))
        return
    for each in found:
        typer.echo(each.sentence)
    if not found:
        typer.echo(f"Nothing between these borders could have been {name}.")


def _plain(told: "Explanation") -> dict[str, object]:
    from dataclasses import asdict

    return asdict(told)


def _draw(told: "list[Explanation]", path: Path) -> None:
    from capar.workbench.reasons import reasons_svg

    path.write_text(reasons_svg(told), encoding="utf-8")
    typer.echo(f"drew {path}", err=True)
