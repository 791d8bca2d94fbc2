"""``capar evaluate``: how well what is observed agrees with labels that people gave."""

from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from capar.cli._options import Beside, Rules, Steady, rule_base
from capar.cli._output import console, print_json
from capar.model.errors import CaparError

if TYPE_CHECKING:
    from rich.console import Console
    from rich.table import Table

app = typer.Typer()

COLUMNS = ("link", "accuracy", "F1", "F1@10", "@25", "@50", "edit", "onset", "offset")
SHOWN = 12
"""Confusions that are printed for people; JSON has all."""


@app.command()
def evaluate(
    pairs: Annotated[
        list[str], typer.Argument(metavar="CAPTURE LABELS...", help="Captures and label files.")
    ],
    mapping: Annotated[
        Path, typer.Option("--mapping", "-m", help="TOML file from our names to the labels.")
    ],
    profile: Annotated[str, typer.Option(help="Rules: thesis or extended.")] = "extended",
    frames_of: Annotated[
        str, typer.Option(help="File of the capture whose frames the labels count.")
    ] = "",
    rules: Rules = None,
    actionary: Beside = None,
    steady: Steady = None,
    as_json: Annotated[bool, typer.Option("--json", help="Print JSON.")] = False,
) -> None:
    """Observe each CAPTURE and compare its segments with the LABELS file after it, pooled.

    Labels are CSV (link,start_s,end_s,label or hand,start_frame,end_frame,...,action) or the
    JSON of the KIT Bimanual Actions Dataset. Frames without a label are not counted. Scores:
    frame-wise accuracy and macro F1, segmental F1 at 10, 25 and 50 % overlap, edit score,
    and errors of onset and offset of the segments matched at 10 %.
    """
    if len(pairs) % 2:
        raise CaparError(
            f"{len(pairs)} arguments: each capture is followed by its label file, as in: "
            "capar evaluate TAKE0 LABELS0 TAKE1 LABELS1 --mapping MAPPING"
        )
    from capar.evaluation.mapping import read_mapping
    from capar.evaluation.scoring import evaluate as evaluate_pairs
    from capar.evaluation.scoring import report

    cases = [(place, Path(labels)) for place, labels in zip(pairs[::2], pairs[1::2], strict=True)]
    base = rule_base(profile, rules, actionary, steady=steady)
    found = evaluate_pairs(cases, read_mapping(mapping), rules=base, frames_of=frames_of)
    result = report(found)
    if as_json:
        print_json(result)
        return
    _print(console(), result)


def _print(out: "Console", result: dict[str, Any]) -> None:
    out.print(_scores(result))
    out.print(_confusions(result["all"]))
    for kind in ("missed", "inserted"):
        counts = ", ".join(f"{name} {count}" for name, count in result["all"][kind].items())
        out.print(f"segments {kind}: {counts or 'none'}", markup=False)
    for notice in result["notices"]:
        out.print(notice, markup=False, soft_wrap=True)
    if result["unlabelled_links"]:
        names = ", ".join(result["unlabelled_links"])
        out.print(f"not counted, because they bear no labels: {names}", markup=False)


def _scores(result: dict[str, Any]) -> "Table":
    from rich.box import SIMPLE_HEAD
    from rich.table import Table

    captures = len(result["captures"])
    table = Table(
        title=f"{captures} capture{'s' * (captures != 1)}",
        caption="onset, offset: median / 95th percentile of the size of the error [ms]",
        title_justify="left",
        caption_justify="left",
        box=SIMPLE_HEAD,
        collapse_padding=True,
        pad_edge=False,
    )
    for index, column in enumerate(COLUMNS):
        table.add_column(
            column, justify="right" if index else "left", no_wrap=bool(index), overflow="fold"
        )
    for name, each in [*result["links"].items(), ("all", result["all"])]:
        keys = ("accuracy", "macro_f1", "f1@10", "f1@25", "f1@50", "edit")
        errors = (each["onset_ms"], each["offset_ms"])
        table.add_row(
            name,
            *(_number(each[key]) for key in keys),
            *(f"{_whole(error['median'])} / {_whole(error['p95'])}" for error in errors),
        )
    return table


def _confusions(scored: dict[str, Any]) -> "Table":
    from rich.box import SIMPLE_HEAD
    from rich.table import Table

    wrong = [each for each in scored["confusion"] if each["true"] != each["predicted"]]
    table = Table(title="frames under another label", title_justify="left", box=SIMPLE_HEAD)
    for column in ("true", "predicted"):
        table.add_column(column, overflow="fold")
    table.add_column("frames", justify="right")
    table.add_column("share", justify="right")
    for each in wrong[:SHOWN]:
        share = f"{100 * each['frames'] / scored['frames']:.1f} %"
        table.add_row(each["true"], each["predicted"], str(each["frames"]), share)
    if len(wrong) > SHOWN:
        table.add_row("...", "...", str(sum(each["frames"] for each in wrong[SHOWN:])), "")
    return table


def _number(value: float | None) -> str:
    return "-" if value is None else f"{value:.1f}"


def _whole(value: float | None) -> str:
    return "-" if value is None else f"{value:.0f}"
