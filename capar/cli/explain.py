"""The command that says why a segment has its name, and why not another."""

from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from capar.cli.options import Beside, Rules, Steady, rule_base
from capar.cli.output import print_json

if TYPE_CHECKING:
    from collections.abc import Sequence

    from capar.model.observation import Segment
    from capar.pipelines.explanation import Explained
    from capar_rules.explain.explanation import Explanation
    from capar_rules.explain.nearest_rules import NearRule
    from capar_rules.explain.why_not import Alternative


def explain(
    capture: Annotated[
        str,
        typer.Argument(help="A capture bundle's folder or capture.toml; FOLDER:TAKE for a take."),
    ],
    segment: Annotated[
        str | None,
        typer.Argument(
            help="END_EFFECTOR/INDEX, such as right_hand/3; END_EFFECTOR for all of its own; "
            "without it, every one."
        ),
    ] = None,
    why_not: Annotated[
        str | None,
        typer.Option(
            help="A name that it has not: the rule for it that comes nearest, with the conditions "
            "that it lacks; then the smallest change of what was measured; then other rules."
        ),
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
    plot: Annotated[
        Path | None,
        typer.Option(
            help="Draw what the summary of SEGMENT speaks of over time to this .png, .svg or .pdf: "
            "each distance, way, angle and speed with its threshold, and the numbers told."
        ),
    ] = None,
) -> None:
    """Say why SEGMENT of CAPTURE has its name: the rules and facts behind it, in sentences."""
    from capar.cli.output import check_writable
    from capar.pipelines.explanation import explained, segment_named
    from capar.pipelines.explanation_text import explanation_lines, notice_lines
    from extractors.readers.bundle.capture_toml import read_capture

    if svg:
        check_writable(svg, suffixes=(".svg",))
    if plot:
        from capar.views.picture import SUFFIXES

        check_writable(plot, suffixes=tuple(SUFFIXES))
    base = rule_base(profile, rules, actionary, steady=steady)
    seen = explained(read_capture(capture), rules=base)
    every_one = seen.observation.segments
    chosen = tuple(one for one in every_one if not segment or one.ee == segment)
    alone = bool(segment) and not chosen
    if segment and alone:
        chosen = (segment_named(seen.observation, segment),)
    if why_not:
        _why_not(why_not, chosen, seen, json=json, alone=alone, limit=100 if every else 1)
        return
    told = list(seen.explainer.explain_all(chosen))
    if svg:
        _draw(told, seen, svg)
    if plot:
        _plot(told, seen, plot)
    if json:
        print_json([_plain(each, seen) for each in told])
        return
    for line in explanation_lines(told, seen, tree=alone):
        typer.echo(line)
    for line in notice_lines(chosen, seen, told if alone else ()):
        typer.echo(line)


def _why_not(
    name: str,
    chosen: "Sequence[Segment]",
    seen: "Explained",
    *,
    json: bool,
    alone: bool,
    limit: int,
) -> None:
    """Print of each segment what it lacks for a name, as many smallest changes as asked for."""
    from capar.pipelines.explanation_text import header, notice_lines
    from capar_rules.explain.nearest_rules import nearest_rules
    from capar_rules.explain.why_not import why_not

    asked = [one for one in chosen if alone or one.name != name]
    rows = [
        (
            one,
            why_not(seen.explainer, one, name, limit=limit),
            () if name in one.general else nearest_rules(seen.explainer, one, name),
        )
        for one in asked
    ]
    if json:
        print_json(_rows(rows, seen))
        return
    for one, found, rules_near in rows:
        if not alone:
            typer.echo(f"{header(one)}  {one.name}")
        _print_why_not(name, found, rules_near, others=alone or limit > 1)
    for line in notice_lines(asked, seen):
        typer.echo(line)


def _print_why_not(
    name: str,
    found: "tuple[Alternative, ...]",
    near: "tuple[NearRule, ...]",
    *,
    others: bool,
) -> None:
    """The nearest rule, the smallest changes of what was measured, and then the other rules."""
    lacking = [rule for rule in near if rule.failing]
    if lacking:
        typer.echo(f"Nearest rule: {lacking[0].sentence}")
    for each in found:
        typer.echo(each.sentence)
    if not found:
        typer.echo(f"Nothing between these borders could have been {name}.")
    for rule in lacking[1:] if others else ():
        typer.echo(f"Further off: {rule.sentence}")


def _rows(
    rows: "Sequence[tuple[Segment, tuple[Alternative, ...], tuple[NearRule, ...]]]",
    seen: "Explained",
) -> list[dict[str, Any]]:
    from dataclasses import asdict

    from capar.pipelines.explanation_text import notices_about

    return [
        {"ee": each.ee, "index": each.index, "is": each.name, "sentence": told.sentence}
        | _placed(asdict(told), seen)
        | {"rules": [{**asdict(rule), "sentence": rule.sentence} for rule in near]}
        | {"notices": [notice.document() for notice in notices_about([each], seen)]}
        for each, found, near in rows
        for told in found
    ]


def _plain(told: "Explanation", seen: "Explained") -> dict[str, object]:
    from dataclasses import asdict, replace

    from capar.pipelines.explanation_text import definitions, notices_about

    segments = [e for e in seen.observation.segments if (e.ee, e.index) == (told.ee, told.index)]
    notices = [note.document() for note in notices_about(segments, seen, [told])]
    whole = replace(told, reason=told.reason.expanded_once())
    placed = _placed(asdict(whole), seen)
    return placed | {"definitions": definitions(told, seen), "notices": notices}


def _placed(node: dict[str, Any], seen: "Explained") -> dict[str, Any]:
    """A tree as JSON, and beside each atom the segments that it refers to by their ticks."""
    from capar.pipelines.explanation import segments_in

    placed: dict[str, Any] = {}
    for key, value in node.items():
        if isinstance(value, dict):
            placed[key] = _placed(value, seen)
        elif isinstance(value, list | tuple):
            whole = [_placed(each, seen) if isinstance(each, dict) else each for each in value]
            placed[key] = whole
        else:
            placed[key] = value
        if key == "atom":
            placed["segments"] = list(segments_in(seen, str(value)))
    return placed


def _draw(told: "list[Explanation]", seen: "Explained", path: Path) -> None:
    from capar.cli.output import written
    from capar.views.reasons import reasons_svg

    with written(path) as draft:
        draft.write_text(reasons_svg(told, seen.observation), encoding="utf-8")
    typer.echo(f"drew {path}", err=True)


def _plot(told: "list[Explanation]", seen: "Explained", path: Path) -> None:
    from capar.cli.output import written
    from capar.pipelines.explanation_text import staying
    from capar.pipelines.measured.claims import draw_claims

    if len(told) != 1:
        raise typer.BadParameter(
            "draws one segment: name one, such as right_hand/3.", param_hint="--plot"
        )
    (one,) = told
    with written(path) as draft:
        draw_claims(seen, one, draft, staying=staying(one))
    typer.echo(f"drew {path}", err=True)
