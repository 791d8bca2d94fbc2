"""The command that says why a segment has its name, and why not another."""

from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer
from typer import Argument, Option

from capar.cli.options import Beside, Capture, Json, ProfileName, Rules, Steady, rule_base
from capar.cli.output import check_picture, print_json, save

if TYPE_CHECKING:
    from collections.abc import Sequence

    from capar.model.observation import Segment
    from capar.pipelines.explanation import Explained
    from capar_rules.explain.explanation import Explanation


def explain(
    capture: Capture,
    segment: Annotated[
        str | None,
        Argument(help="END_EFFECTOR/INDEX, such as right_hand/3; END_EFFECTOR for all of its own."),
    ] = None,
    why_not: Annotated[
        str | None,
        Option(help="Another name: its nearest rule, and the conditions that fail."),
    ] = None,
    profile: ProfileName = "extended",
    rules: Rules = None,
    actionary: Beside = None,
    steady: Steady = None,
    json: Json = False,
    plot: Annotated[
        Path | None,
        Option(help="Draw what SEGMENT's conditions measure to a .png, .svg or .pdf file."),
    ] = None,
) -> None:
    """Say why a segment has its name, and why not another one.

    Printed are its conditions with measured value and limit, and the rules behind it.
    """
    from capar.pipelines.explanation import chosen, explained, explanation_plot
    from capar.views.explanation_plot import draw_explanation
    from capar.views.explanation_text import explanation_lines
    from extractors.readers.bundle.capture_toml import read_capture

    check_picture(plot)
    base = rule_base(profile, rules, actionary, steady=steady)
    seen = explained(read_capture(capture), rules=base)
    observation = seen.observation
    segment = (segment or "").removeprefix(f"{capture.rstrip('/')}/")  # as the capture was typed
    asked = chosen(observation, segment)
    alone = "/" in segment
    if why_not:
        _why_not(why_not, asked, seen, json=json, alone=alone)
        return
    told = seen.explain(asked)
    if plot:
        if len(told) != 1:
            raise typer.BadParameter(
                "draws one segment: name one, such as right_hand/3.", param_hint="--plot"
            )
        save(plot, lambda draft: draw_explanation(explanation_plot(seen, told[0]), draft), "drew")
    if json:
        print_json([_plain(each, seen) for each in told])
        return
    for each in told:
        definitions = seen.definitions(each) if alone else None
        for line in explanation_lines(each, observation, definitions):
            typer.echo(line)
    _print_notices(asked, seen, told if alone else ())


def _print_notices(
    segments: "Sequence[Segment]", seen: "Explained", told: "Sequence[Explanation]" = ()
) -> None:
    from capar.views.explanation_text import notices_about
    from capar.views.notices import reservation_lines

    notices = notices_about(segments, seen.observation, told)
    for line in reservation_lines(notices, called=seen.explainer.names, unshaped=seen.unshaped):
        typer.echo(line)


def _why_not(
    name: str,
    chosen: "Sequence[Segment]",
    seen: "Explained",
    *,
    json: bool,
    alone: bool,
) -> None:
    """Print of each segment what the nearest rule for a name lacks."""
    from dataclasses import asdict

    from capar.views.explanation_text import condition_table, header, notices_about

    rows = []
    asked = [one for one in chosen if alone or one.name != name]
    for one in asked:
        near = seen.why_not(one, name)
        if json:
            about = [notice.document() for notice in notices_about([one], seen.observation)]
            rules = [asdict(rule) | {"sentence": rule.sentence} for rule in near]
            told = {"ee": one.ee, "index": one.index, "is": one.name, "notices": about}
            rows.append(_placed(told | {"name": name, "rules": rules}, seen))
            continue
        if not alone:
            typer.echo(f"{header(one)}  {one.name}")
        for rule in near:
            lines = "\n".join(condition_table(rule.failing))
            typer.echo(f"Nearest rule: {rule.rule} lacks\n{lines}" if lines else rule.sentence)
        if not near:
            typer.echo(f"No rule for {name} comes near: each lacks several conditions.")
    if json:
        print_json(rows)
    else:
        _print_notices(asked, seen)


def _plain(told: "Explanation", seen: "Explained") -> dict[str, object]:
    from dataclasses import asdict, replace

    from capar.views.explanation_text import notices_about

    observation = seen.observation
    segments = [e for e in observation.segments if (e.ee, e.index) == (told.ee, told.index)]
    notices = [note.document() for note in notices_about(segments, observation, [told])]
    placed = _placed(asdict(replace(told, reason=told.reason.expanded_once())), seen)
    return placed | {"definitions": seen.definitions(told), "notices": notices}


def _placed(node: Any, seen: "Explained") -> Any:
    """A tree as JSON, and beside each atom the segments that it refers to by their ticks."""
    from capar.pipelines.explanation import segments_in

    if isinstance(node, list | tuple):
        return [_placed(each, seen) for each in node]
    if not isinstance(node, dict):
        return node
    placed = {key: _placed(value, seen) for key, value in node.items()}
    if "atom" in node:
        placed["segments"] = list(segments_in(seen, str(node["atom"])))
    return placed
