"""The command that says why a segment has its name, and why not another."""

from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer
from typer import Argument, Option

from capar.cli.options import Beside, Rules, Steady, rule_base
from capar.cli.output import print_json

if TYPE_CHECKING:
    from collections.abc import Sequence

    from capar.model.observation import Segment
    from capar.pipelines.explanation import Explained
    from capar_rules.explain.explanation import Explanation


def explain(
    capture: Annotated[
        str, Argument(help="A capture bundle's folder or capture.toml; FOLDER:TAKE for a take.")
    ],
    segment: Annotated[
        str | None,
        Argument(
            help="END_EFFECTOR/INDEX, such as right_hand/3; END_EFFECTOR for all of its own; "
            "without it, every one."
        ),
    ] = None,
    why_not: Annotated[
        str | None,
        Option(
            help="A name that it has not: the rule for it that comes nearest, with the conditions "
            "that it lacks; then the smallest change of what was measured."
        ),
    ] = None,
    every: Annotated[
        bool, Option("--all", help="With --why-not: every answer that is as small.")
    ] = False,
    profile: Annotated[str, Option(help="The rules: extended or thesis.")] = "extended",
    rules: Rules = None,
    actionary: Beside = None,
    steady: Steady = None,
    json: Annotated[bool, Option("--json", help="Print the whole tree as JSON.")] = False,
    svg: Annotated[Path | None, Option(help="Draw the tree to this file.")] = None,
    plot: Annotated[
        Path | None,
        Option(
            help="Draw the quantities of SEGMENT's conditions over time to this .png, .svg or "
            ".pdf, each with its limits and the intervals of the facts about it."
        ),
    ] = None,
) -> None:
    """Say why a segment has its name, and why not another one.

    Printed are its conditions with measured value and limit, and the rules behind it.
    """
    from capar.cli.output import check_writable
    from capar.pipelines.explanation import explained, segment_named
    from capar.views.explanation_text import explanation_lines, notices_about
    from capar.views.notices import reservation_lines
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
    told = seen.explain(chosen)
    if svg:
        _draw(told, seen, svg)
    if plot:
        _plot(told, seen, plot)
    if json:
        print_json([_plain(each, seen) for each in told])
        return
    for each in told:
        definitions = seen.definitions(each) if alone else None
        for line in explanation_lines(each, seen.observation, definitions):
            typer.echo(line)
    notices = notices_about(chosen, seen.observation, told if alone else ())
    for line in reservation_lines(notices, called=seen.explainer.names, unshaped=seen.unshaped):
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
    from dataclasses import asdict

    from capar.views.explanation_text import condition_table, header, notices_about
    from capar.views.notices import reservation_lines
    from capar_rules.explain.why_not import why_not

    rows = []
    asked = [one for one in chosen if alone or one.name != name]
    for one in asked:
        found = why_not(seen.explainer, one, name, limit=limit)
        near = () if name in one.general else seen.nearest_rules(one, name)
        if json:
            about = [notice.document() for notice in notices_about([one], seen.observation)]
            told = {"ee": one.ee, "index": one.index, "is": one.name, "notices": about}
            rules = [asdict(rule) | {"sentence": rule.sentence} for rule in near]
            rows += [
                told | {"sentence": each.sentence, "rules": rules} | _placed(asdict(each), seen)
                for each in found
            ]
            continue
        if not alone:
            typer.echo(f"{header(one)}  {one.name}")
        for rule in near:
            if rule.failing:
                typer.echo(f"Nearest rule: {rule.rule} lacks")
                for line in condition_table(rule.failing):
                    typer.echo(line)
        for each in found:
            typer.echo(each.sentence)
        if not found:
            typer.echo(f"Nothing between these borders could have been {name}.")
    if json:
        print_json(rows)
        return
    notices = notices_about(asked, seen.observation)
    for line in reservation_lines(notices, called=seen.explainer.names, unshaped=seen.unshaped):
        typer.echo(line)


def _plain(told: "Explanation", seen: "Explained") -> dict[str, object]:
    from dataclasses import asdict, replace

    from capar.views.explanation_text import notices_about

    observation = seen.observation
    segments = [e for e in observation.segments if (e.ee, e.index) == (told.ee, told.index)]
    notices = [note.document() for note in notices_about(segments, observation, [told])]
    whole = replace(told, reason=told.reason.expanded_once())
    placed = _placed(asdict(whole), seen)
    return placed | {"definitions": seen.definitions(told), "notices": notices}


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


def _draw(told: "Sequence[Explanation]", seen: "Explained", path: Path) -> None:
    from capar.cli.output import written
    from capar.views.explanation_svg import reasons_svg

    with written(path) as draft:
        draft.write_text(reasons_svg(told, seen.observation), encoding="utf-8")
    typer.echo(f"drew {path}", err=True)


def _plot(told: "Sequence[Explanation]", seen: "Explained", path: Path) -> None:
    from capar.cli.output import written
    from capar.pipelines.explanation import explanation_plot
    from capar.views.explanation_plot import draw_explanation

    if len(told) != 1:
        raise typer.BadParameter(
            "draws one segment: name one, such as right_hand/3.", param_hint="--plot"
        )
    with written(path) as draft:
        draw_explanation(explanation_plot(seen, told[0]), draft)
    typer.echo(f"drew {path}", err=True)
