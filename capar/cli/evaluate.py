"""Check what is observed: against labels, and against claims in words."""

from collections.abc import Callable, Iterator, Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer
from typer import Argument, Option

from capar.cli.options import Beside, Json, ProfileName, Rules, Steady, rule_base
from capar.cli.output import check_writable, console, print_json, progress, written
from capar.evaluation import Contradictions, Kind
from capar.model.errors import CaparError

if TYPE_CHECKING:
    from rich.console import Console
    from rich.table import Table

    from capar.claims.claims import Verdict

SHOWN = 12
"""Rows of confusions and of the longest differences that are printed; JSON has all."""

MOST_PARTS = 20
"""Up to so many links, bodies, objects or events have a row each; JSON has all."""

Scores = Mapping[str, Any]
Cell = Callable[[Scores], str]


def evaluate(
    places: Annotated[
        list[str],
        Argument(
            metavar="EVALUATION|CAPTURE LABELS...",
            help="An evaluation file; or captures, each followed by its label file. "
            "BUNDLE:PATTERN is every take whose name fits, {take} its name in the label file's.",
        ),
    ],
    mapping: Annotated[
        Path | None,
        Option("--mapping", "-m", help="Actions: TOML file from our names to the labels."),
    ] = None,
    kind: Annotated[Kind, Option(help="What the labels are about.")] = Kind.ACTIONS,
    takes: Annotated[
        list[str] | None,
        Option(help="Of an evaluation file, only takes that fit this pattern; may be repeated."),
    ] = None,
    profile: ProfileName = "extended",
    frames_of: Annotated[
        str, Option(help="File of the capture whose frames the labels count.")
    ] = "",
    contradictions: Annotated[
        Contradictions,
        Option(help="What to do about labels that overlap or end before they start."),
    ] = Contradictions.REFUSE,
    rules: Rules = None,
    actionary: Beside = None,
    steady: Steady = None,
    plot: Annotated[
        Path | None,
        Option(
            help="Draw the labels beside the segments, to a .png, .svg or .pdf file; {capture} in "
            "its name stands for the capture's."
        ),
    ] = None,
    json: Json = False,
) -> None:
    """Compare what is observed with labels, by take and pooled.

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
    from capar.evaluation.metrics import report
    from capar.evaluation.plan import Plan, read_mapping, read_pairs, read_plan
    from capar.evaluation.scoring import draw_evaluation, picture_paths
    from capar.evaluation.scoring import evaluate as carry_out

    base = rule_base(profile, rules, actionary, steady=steady)
    if len(places) == 1 and Path(places[0]).suffix == ".toml":
        stated = {
            "--mapping": mapping is not None,
            "--kind": kind is not Kind.ACTIONS,
            "--frames-of": bool(frames_of),
            "--contradictions": contradictions is not Contradictions.REFUSE,
        }
        if given := [name for name, said in stated.items() if said]:
            raise CaparError(f"an evaluation file says itself what {' and '.join(given)} would say")
        plan = read_plan(Path(places[0]), takes=takes or ())
    else:
        if takes:
            raise CaparError("--takes belongs to an evaluation file; name takes as BUNDLE:PATTERN")
        pairs = read_pairs(places)
        chosen = read_mapping(mapping) if mapping else None
        plan = Plan(kind, pairs, chosen, frames_of=frames_of, contradictions=contradictions)
    if plot:
        from capar.views.picture import SUFFIXES

        for path in picture_paths(plot, [each.name for each in plan.pairs]).values():
            check_writable(path, suffixes=SUFFIXES)
    found = carry_out(plan, rules=base, progress=progress("observing"))
    paths = picture_paths(plot, [each.name for each in found.captures]) if plot else {}
    for capture in found.captures if plot else ():
        with written(paths[capture.name]) as draft:
            draw_evaluation(found, capture, path=draft)
    if json:
        print_json(report(found))
    else:
        _print_evaluation(console(), report(found))
    for path in dict.fromkeys(paths.values()):
        typer.echo(f"drew {path}", err=True)


def _print_evaluation(out: "Console", result: Scores) -> None:
    """Scores, then confusions and the longest differences, then remarks."""
    kind, everything = str(result["kind"]), result["all"]
    part, caption, columns = TABLES[kind]
    out.print(_scores(result, part, caption, columns))
    if kind == "actions":
        out.print(_confusions(everything))
        for name in ("missed", "inserted"):
            counts = ", ".join(f"{each} {n}" for each, n in everything[name].items())
            out.print(f"segments {name}: {counts or 'none'}", markup=False)
    if result["worst"]:
        out.print(_worst(result["worst"][:SHOWN]))
    lines = [*result["notices"]]
    if kind == "carries":
        sharp = everything["moving_at_both_ends"]
        lines[:0] = [
            f"{everything['excluded']} of {everything['carries']} carries are excluded, as nothing "
            f"moves in them; a carry counts as found within {everything['within_s']:g} s",
            f"of {sharp['carries']} whose object moves at both labelled ends: start "
            f"{_number(sharp['start'])}, end {_number(sharp['end'])}, both "
            f"{_number(sharp['both'])} %",
        ]
    if result[f"unlabelled_{part}"]:
        names = ", ".join(result[f"unlabelled_{part}"])
        lines.append(f"not counted, because they bear no labels: {names}")
    for line in lines:
        out.print(line, markup=False, soft_wrap=True)


def _scores(result: Scores, part: str, caption: str, columns: Mapping[str, Cell]) -> "Table":
    from rich.markup import escape

    captures = len(result["captures"])
    table = _table(f"{captures} capture{'s' * (captures != 1)}", caption)
    for index, column in enumerate((part, *columns)):
        table.add_column(
            column, justify="right" if index else "left", no_wrap=bool(index), overflow="fold"
        )
    for name, scores in _score_rows(part, result):
        if scores is None:
            table.add_section()
        else:
            table.add_row(escape(name), *(cell(scores) for cell in columns.values()))
    return table


def _score_rows(part: str, result: Scores) -> Iterator[tuple[str, Scores | None]]:
    """Parts and whole; then each group's, then each capture's whole; None is a line between."""
    shown = list(result[part].items())
    yield from shown if len(shown) <= MOST_PARTS else ()
    yield "all", result["all"]
    for name, group in result["groups"].items():
        yield "", None
        own = list(group[part].items())
        if len(own) <= MOST_PARTS:
            yield from ((f"{name}: {each}", scores) for each, scores in own)
        yield f"{name}: all", group["all"]
    if len(result["by_capture"]) > 1:
        yield "", None
        yield from ((name, scores["all"]) for name, scores in result["by_capture"].items())


def _confusions(scored: Scores) -> "Table":
    wrong = [each for each in scored["confusion"] if each["true"] != each["predicted"]]
    table = _table("frames under another label")
    for column in ("true", "predicted", "frames", "share"):
        table.add_column(
            column, overflow="fold", justify="right" if column in {"frames", "share"} else "left"
        )
    for each in wrong[:SHOWN]:
        share = f"{100 * each['frames'] / scored['frames']:.1f} %"
        table.add_row(each["true"], each["predicted"], str(each["frames"]), share)
    if len(wrong) > SHOWN:
        table.add_row("...", "...", str(sum(each["frames"] for each in wrong[SHOWN:])), "")
    return table


def _worst(found: Sequence[Scores]) -> "Table":
    from rich.markup import escape

    table = _table("longest intervals that differ [s]")
    for column in ("capture", "of", "from", "to", "labelled", "found", "segments"):
        table.add_column(
            column, overflow="fold", justify="right" if column in {"from", "to"} else "left"
        )
    for span in found:
        texts = [escape(span[key]) for key in ("capture", "channel", "true", "found", "segments")]
        times = (f"{span['start_s']:.2f}", f"{span['end_s']:.2f}")
        table.add_row(*texts[:2], *times, *texts[2:])
    return table


def _table(title: str, caption: str = "") -> "Table":
    from rich.box import SIMPLE_HEAD
    from rich.markup import escape
    from rich.table import Table

    return Table(
        title=escape(title),
        caption=escape(caption) or None,
        title_justify="left",
        caption_justify="left",
        box=SIMPLE_HEAD,
        collapse_padding=True,
        pad_edge=False,
    )


def _score(key: str) -> Cell:
    return lambda scores: _number(scores[key])


def _count(key: str) -> Cell:
    return lambda scores: str(scores[key])


def _error(key: str) -> Cell:
    """Median and 95th percentile."""
    return lambda scores: " / ".join(
        "-" if scores[key][each] is None else f"{scores[key][each]:.0f}"
        for each in ("median", "p95")
    )


def _number(value: float | None) -> str:
    return "-" if value is None else f"{value:.1f}"


_ONSETS = {"onset": _error("onset_ms"), "offset": _error("offset_ms")}
TABLES: dict[str, tuple[str, str, dict[str, Cell]]] = {
    "actions": (
        "links",
        "onset, offset: median / 95th percentile of the size of the error [ms]",
        {
            "accuracy": _score("accuracy"),
            "F1": _score("macro_f1"),
            "F1@10": _score("f1@10"),
            "@25": _score("f1@25"),
            "@50": _score("f1@50"),
            "edit": _score("edit"),
            **_ONSETS,
        },
    ),
    "contacts": (
        "bodies",
        "all: whether any body touches; frame by frame [%]\n"
        "onset, offset: median / 95th percentile of the distance to the nearest found one [ms]",
        {
            "frames": _count("frames"),
            "precision": _score("precision"),
            "recall": _score("recall"),
            "F1": _score("f1"),
            **_ONSETS,
        },
    ),
    "carries": (
        "objects",
        "start, end, both: carries whose printed ends are near the labelled ones [%]\n"
        "off: median / 95th percentile of the size of the error [ms]",
        {
            "carries": _count("counted"),
            "start": _score("start"),
            "end": _score("end"),
            "both": _score("both"),
            "start off": _error("start_ms"),
            "end off": _error("end_ms"),
            "extra": _count("extra"),
        },
    ),
    "events": (
        "events",
        "away: median / 95th percentile of the distance from what was seen to what was found [ms]",
        {
            **{key: _count(key) for key in ("seen", "found", "missed", "open", "extra")},
            "F1": _score("f1"),
            "away": _error("away_ms"),
        },
    ),
    "containers": (
        "containers",
        "went in: the middle lies in the container at the end and did not before",
        {
            "objects": _count("objects"),
            "right": _count("right"),
            "went in": _count("went_in"),
            "told": _count("told"),
            "told wrongly": _count("told_wrongly"),
            "untold": _count("untold"),
        },
    ),
}
"""For each kind of labels: its parts, the caption, and the columns with their scores."""


def test(
    files: Annotated[
        list[Path], Argument(help="Files of claims, *.motion.toml, or folders of them.")
    ],
    rules: Rules = None,
    actionary: Beside = None,
    json: Json = False,
) -> None:
    """Check claims about captures.

    Exits with 1 if a claim does not hold, with 2 if one cannot be judged. A file
    drink.motion.toml names captures, from its own folder on, and what is expected of each:

    \b
        captures = ["drink_*", "cups:take3", "mugs:*"]
        profile = "thesis"    # if not extended
        rules = "mine"        # a folder of rules, if not the usual
    \b
        [[expect]]
        that = "right_hand MoveObjTo(mug, head)"

    A capture is a folder, FOLDER:TAKE, or with FOLDER:* each of its takes.
    Each claim has one of these forms:

    \b
        EVENT                    right_hand MoveObjTo(mug, head)
        no EVENT                 no mug touches head
        EVENT before EVENT       right_hand Reach before right_hand touches mug
          (or: after, while, begins before, ends before)
        EVENT lasts A to B s     right_hand MoveObj(mug) lasts 0.1 to 2 s
        END_EFFECTOR: STEPS      right_hand: Reach(mug), ..., ResumePosture

    and each event one of these; _ is any object, and a general name fits what specialises it:

    \b
        END_EFFECTOR STEP        right_hand MoveObjTo(_, head)
        several of them do STEP  both hands do Lift(box)
                                 left_hand and right_hand do Lift(box)
        BODY touches BODY        mug touches head
        BODY lets go of BODY     right_hand lets go of mug
        OBJECT moves             mug moves
        SENSOR looks at OBJECT   head looks at mug
        ... away from OBJECT     head looks away from mug

    What no rule, object or sensor is called is a mistake, also after "no". Under pytest each
    claim of each capture is a test of its own.
    """  # noqa: D301 (\b is for typer: lines that stay as they are)
    from capar.claims.claims import SUFFIX, read_motion_test, run_motion_test

    rows: list[dict[str, Any]] = []
    mistakes: list[CaparError] = []
    for path in [
        each
        for file in files
        for each in (sorted(file.rglob(f"*{SUFFIX}")) if file.is_dir() else [file])
    ]:
        verdicts: Sequence[Verdict] = ()
        mistake: CaparError | None = None
        try:
            claimed = read_motion_test(path)
            verdicts = list(run_motion_test(claimed, rules=rules, actionary=actionary))
        except CaparError as error:
            mistake = error
            mistakes.append(error)
        rows.append(
            {
                "name": str(path),
                "tests": len(verdicts),
                "failures": sum(not each.holds for each in verdicts),
                "error": str(mistake or ""),
                "cases": [
                    {"name": one.claim, "capture": one.capture, "passed": one.holds,
                     "found": one.found, "error": one.mistake}
                    for one in verdicts
                ],
            }
        )  # fmt: skip
        if not json:
            _print_suite(rows[-1])
    if json:
        print_json(rows)
    unread = sum(bool(case["error"]) for row in rows for case in row["cases"])
    if len(mistakes) == 1 and not unread:
        raise mistakes[0]
    if mistakes or unread:
        several = "1 claim" if unread == 1 else f"{unread} claims"
        told = [f"{several} could not be judged; see above"] if unread else []
        raise CaparError("\n".join([*map(str, mistakes), *told]))
    if any(row["failures"] for row in rows):
        raise typer.Exit(1)


def _print_suite(row: Mapping[str, Any]) -> None:
    for case in row["cases"]:
        mark = "holds" if case["passed"] else "ERROR" if case["error"] else "FAILS"
        typer.echo(f"{mark}  {case['capture']}: {case['name']}")
        if not case["passed"]:
            typer.echo(f"       {case['error'] or 'found ' + str(case['found'])}")
    if row["error"]:
        typer.echo(f"ERROR  {row['name']} was not judged")
    else:
        typer.echo(f"{row['name']}: {row['tests']} claims, {row['failures']} fail")
