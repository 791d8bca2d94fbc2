"""``capar evaluate``: how well what is observed agrees with labels that people gave."""

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from capar.cli._options import Beside, Rules, Steady, rule_base
from capar.cli._output import check_writable, console, print_json, progress, written
from capar.evaluation.kinds import Contradictions, Kind
from capar.model.errors import CaparError

if TYPE_CHECKING:
    from capar.evaluation.evaluations import Evaluation
    from capar.evaluation.plan import Plan

app = typer.Typer()


@app.command()
def evaluate(
    places: Annotated[
        list[str],
        typer.Argument(
            metavar="EVALUATION|CAPTURE LABELS...",
            help="An evaluation file; or captures, each followed by its label file. "
            "BUNDLE:PATTERN is every take whose name fits, {take} its name in the label file's.",
        ),
    ],
    mapping: Annotated[
        Path | None,
        typer.Option(
            "--mapping",
            "-m",
            help="Actions: TOML file from our names to the labels.",
            show_default=False,
        ),
    ] = None,
    kind: Annotated[Kind, typer.Option(help="What the labels are about.")] = Kind.ACTIONS,
    takes: Annotated[
        list[str] | None,
        typer.Option(
            help="Of an evaluation file, only takes that fit this pattern; may be repeated.",
            show_default=False,
        ),
    ] = None,
    profile: Annotated[str, typer.Option(help="Rules: thesis or extended.")] = "extended",
    frames_of: Annotated[
        str, typer.Option(help="File of the capture whose frames the labels count.")
    ] = "",
    contradictions: Annotated[
        Contradictions,
        typer.Option(help="What to do about labels that overlap or end before they start."),
    ] = Contradictions.REFUSE,
    rules: Rules = None,
    actionary: Beside = None,
    steady: Steady = None,
    plot: Annotated[
        Path | None,
        typer.Option(
            help="Draw the labels beside the segments, to a .png, .svg or .pdf file; {capture} in "
            "its name stands for the capture's.",
            show_default=False,
        ),
    ] = None,
    as_json: Annotated[bool, typer.Option("--json", help="Print JSON.")] = False,
) -> None:
    """Observe captures and compare what is printed or stored with labels, by take and pooled.

    Label files are CSV, JSON, ELAN (.eaf), Praat (.TextGrid), or the JSON of the KIT Bimanual
    Actions Dataset. Their columns: link,start_s,end_s,label (actions); body,other,start_s,end_s
    (contacts); object,start_s,end_s (carries); hand,event,start_s,end_s (events). In ELAN and
    Praat a tier is a link or body, a text its label, the other body or the object. Labels of one
    hand are enough: what bears no labels is not counted.

    Without --mapping, labels of actions are our own names, as `capar correct --labels` writes them.

    Actions: frame-wise accuracy and macro F1, segmental F1 at 10, 25 and 50 % overlap, edit
    score, and errors of onset and offset of the segments matched at 10 %. Contacts: frame-wise
    precision, recall and F1. Carries: printed starts and ends near the labels. Events: what was
    seen and found.
    """
    from capar.evaluation.plan import Plan, read_pairs, read_plan

    base = rule_base(profile, rules, actionary, steady=steady)
    if len(places) == 1 and Path(places[0]).suffix == ".toml":
        _prove_alone(mapping, kind, frames_of, contradictions)
        plan = read_plan(Path(places[0]), takes=takes or ())
    else:
        if takes:
            raise CaparError("--takes belongs to an evaluation file; name takes as BUNDLE:PATTERN")
        from capar.evaluation.mapping import read_mapping

        pairs = read_pairs(places)
        chosen = read_mapping(mapping) if mapping else None
        plan = Plan(kind, pairs, chosen, frames_of=frames_of, contradictions=contradictions)
    if plot:
        _prove_pictures(plan, plot)
    from capar.cli._evaluation_tables import print_evaluation
    from capar.evaluation.evaluations import report
    from capar.evaluation.running import evaluate as carry_out

    found = carry_out(plan, rules=base, progress=progress("observing"))
    drawn = _draw(found, plot) if plot else []
    result = report(found)
    if as_json:
        print_json(result)
    else:
        print_evaluation(console(), result)
    for line in drawn:
        typer.echo(line, err=True)


def _prove_alone(
    mapping: Path | None, kind: Kind, frames_of: str, contradictions: Contradictions
) -> None:
    """An evaluation file says itself what the other options would."""
    given = {
        "--mapping": mapping is not None,
        "--kind": kind is not Kind.ACTIONS,
        "--frames-of": bool(frames_of),
        "--contradictions": contradictions is not Contradictions.REFUSE,
    }
    names = [name for name, stated in given.items() if stated]
    if names:
        raise CaparError(f"an evaluation file says itself what {' and '.join(names)} would say")


def _prove_pictures(plan: "Plan", plot: Path) -> None:
    """The pictures can be written; told before anything is computed."""
    from capar.evaluation.pictures import picture_paths
    from capar.views.picture import SUFFIXES

    for path in picture_paths(plot, [each.name for each in plan.pairs]).values():
        check_writable(path, suffixes=SUFFIXES)


def _draw(evaluation: "Evaluation", plot: Path) -> list[str]:
    from capar.evaluation.pictures import draw_evaluation, picture_paths

    paths = picture_paths(plot, evaluation.cases)
    for capture in evaluation.captures:
        with written(paths[capture.name]) as draft:
            draw_evaluation(evaluation, capture, path=draft)
    return [f"drew {each}" for each in dict.fromkeys(paths.values())]
