"""Check what is observed: against labels, and against claims in words."""

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from capar.cli.options import Beside, Rules, Steady, rule_base
from capar.cli.output import check_writable, console, print_json, progress, written
from capar.evaluation.labels import Contradictions, Kind
from capar.model.errors import CaparError

if TYPE_CHECKING:
    from rich.console import Console
    from rich.table import Table

    from capar.claims.claims import Verdict
    from capar.evaluation.metrics import Evaluation
    from capar.evaluation.plan import Plan


SHOWN = 12
"""Rows of confusions and of the worst stretches that are printed; JSON has more."""

MOST_PARTS = 20
"""So many links, bodies, objects or events have a row each; JSON has all."""

Scores = Mapping[str, Any]
Cell = Callable[[Scores], str]


def print_evaluation(out: "Console", result: Mapping[str, Any]) -> None:
    """Print a report as tables."""
    kind = str(result["kind"])
    out.print(_scores(kind, result))
    if kind == "actions":
        out.print(_confusions(result["all"]))
        for name in ("missed", "inserted"):
            counts = ", ".join(f"{each} {n}" for each, n in result["all"][name].items())
            out.print(f"segments {name}: {counts or 'none'}", markup=False)
    if result["worst"]:
        out.print(_worst(result["worst"][:SHOWN]))
    for line in _remarks(kind, result):
        out.print(line, markup=False, soft_wrap=True)


def _remarks(kind: str, result: Mapping[str, Any]) -> Iterator[str]:
    everything = result["all"]
    if kind == "carries":
        sharp = everything["moving_at_both_ends"]
        yield (
            f"{everything['excluded']} of {everything['carries']} carries are excluded, as nothing "
            f"moves in them; a carry counts as found within {everything['within_s']:g} s"
        )
        yield (
            f"of {sharp['carries']} whose object moves at both labelled ends: start "
            f"{_number(sharp['start'])}, end {_number(sharp['end'])}, both "
            f"{_number(sharp['both'])} %"
        )
    yield from result["notices"]
    part = PARTS[kind]
    if result[f"unlabelled_{part}"]:
        names = ", ".join(result[f"unlabelled_{part}"])
        yield f"not counted, because they bear no labels: {names}"


def _scores(kind: str, result: Mapping[str, Any]) -> "Table":
    from rich.markup import escape

    columns = COLUMNS[kind]
    part = PARTS[kind]
    captures = len(result["captures"])
    table = _table(f"{captures} capture{'s' * (captures != 1)}", CAPTIONS[kind])
    for index, column in enumerate((part, *columns)):
        table.add_column(
            column, justify="right" if index else "left", no_wrap=bool(index), overflow="fold"
        )
    for name, scores in _rows(part, result):
        if scores is None:
            table.add_section()
            continue
        table.add_row(escape(name), *(cell(scores) for cell in columns.values()))
    return table


def _rows(part: str, result: Mapping[str, Any]) -> Iterator[tuple[str, Scores | None]]:
    """Parts and whole; then each group's, then each capture's whole."""
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


def _confusions(scored: Mapping[str, Any]) -> "Table":
    wrong = [each for each in scored["confusion"] if each["true"] != each["predicted"]]
    table = _table("frames under another label")
    for column in ("true", "predicted"):
        table.add_column(column, overflow="fold")
    table.add_column("frames", justify="right")
    table.add_column("share", justify="right")
    for confusion in wrong[:SHOWN]:
        share = f"{100 * confusion['frames'] / scored['frames']:.1f} %"
        table.add_row(confusion["true"], confusion["predicted"], str(confusion["frames"]), share)
    if len(wrong) > SHOWN:
        table.add_row("...", "...", str(sum(each["frames"] for each in wrong[SHOWN:])), "")
    return table


def _worst(found: Sequence[Mapping[str, Any]]) -> "Table":
    table = _table("longest stretches that differ [s]")
    for column in ("capture", "of", "from", "to", "labelled", "found", "segments"):
        table.add_column(
            column, overflow="fold", justify="right" if column in {"from", "to"} else "left"
        )
    from rich.markup import escape

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
    return lambda scores: f"{_whole(scores[key]['median'])} / {_whole(scores[key]['p95'])}"


def _number(value: float | None) -> str:
    return "-" if value is None else f"{value:.1f}"


def _whole(value: float | None) -> str:
    return "-" if value is None else f"{value:.0f}"


PARTS = {
    "actions": "links",
    "contacts": "bodies",
    "carries": "objects",
    "events": "events",
    "containers": "containers",
}

COLUMNS: dict[str, dict[str, Cell]] = {
    "actions": {
        "accuracy": _score("accuracy"),
        "F1": _score("macro_f1"),
        "F1@10": _score("f1@10"),
        "@25": _score("f1@25"),
        "@50": _score("f1@50"),
        "edit": _score("edit"),
        "onset": _error("onset_ms"),
        "offset": _error("offset_ms"),
    },
    "contacts": {
        "frames": _count("frames"),
        "precision": _score("precision"),
        "recall": _score("recall"),
        "F1": _score("f1"),
        "onset": _error("onset_ms"),
        "offset": _error("offset_ms"),
    },
    "carries": {
        "carries": _count("counted"),
        "start": _score("start"),
        "end": _score("end"),
        "both": _score("both"),
        "start off": _error("start_ms"),
        "end off": _error("end_ms"),
        "extra": _count("extra"),
    },
    "events": {
        "seen": _count("seen"),
        "found": _count("found"),
        "missed": _count("missed"),
        "open": _count("open"),
        "extra": _count("extra"),
        "F1": _score("f1"),
        "away": _error("away_ms"),
    },
    "containers": {
        "objects": _count("objects"),
        "right": _count("right"),
        "went in": _count("went_in"),
        "told": _count("told"),
        "told wrongly": _count("told_wrongly"),
        "untold": _count("untold"),
    },
}
"""What is printed of each kind of labels, and from which scores."""

CAPTIONS = {
    "actions": "onset, offset: median / 95th percentile of the size of the error [ms]",
    "contacts": "all: whether any body touches; frame by frame [%]\n"
    "onset, offset: median / 95th percentile of the way to the nearest found one [ms]",
    "carries": "start, end, both: carries whose printed ends are near the labelled ones [%]\n"
    "off: median / 95th percentile of the size of the error [ms]",
    "containers": "went in: the middle lies in the container at the end and did not before",
    "events": "away: median / 95th percentile of the way from what was seen to what was found [ms]",
}


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
        from capar.evaluation.plan import read_mapping

        pairs = read_pairs(places)
        chosen = read_mapping(mapping) if mapping else None
        plan = Plan(kind, pairs, chosen, frames_of=frames_of, contradictions=contradictions)
    if plot:
        _prove_pictures(plan, plot)
    from capar.evaluation.metrics import report
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


@dataclass(frozen=True)
class _Suite:
    """A file of claims, judged, or why it could not be."""

    path: Path
    verdicts: Sequence["Verdict"] = ()
    mistake: CaparError | None = None

    @property
    def failures(self) -> int:
        """How many claims do not hold; those that cannot be judged are among them."""
        return sum(not each.holds for each in self.verdicts)


def test(
    files: Annotated[
        list[Path], typer.Argument(help="Files of claims, *.motion.toml, or folders of them.")
    ],
    rules: Rules = None,
    actionary: Beside = None,
    json: Annotated[
        bool, typer.Option("--json", help="Print suites, cases and failures as JSON.")
    ] = False,
) -> None:
    """Check claims about captures; exit with 1 if one does not hold, with 2 if one says nothing.

    A file drink.motion.toml names captures, from its own folder on, and what is expected of each:

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
    suites = [_judged(path, rules, actionary) for path in _paths(files)]
    if json:
        _print_json(suites)
    else:
        for suite in suites:
            _print(suite)
    _end(suites)


def _paths(files: Iterable[Path]) -> Iterator[Path]:
    from capar.claims.claims import SUFFIX

    for file in files:
        yield from sorted(file.rglob(f"*{SUFFIX}")) if file.is_dir() else [file]


def _judged(path: Path, rules: Path | None, actionary: str | None) -> _Suite:
    from capar.claims.claims import read_motion_test, run_motion_test

    try:
        claimed = read_motion_test(path)
        return _Suite(path, list(run_motion_test(claimed, rules=rules, actionary=actionary)))
    except CaparError as error:
        return _Suite(path, mistake=error)


def _print(suite: _Suite) -> None:
    for verdict in suite.verdicts:
        mark = "holds" if verdict.holds else "ERROR" if verdict.mistake else "FAILS"
        typer.echo(f"{mark}  {verdict.capture}: {verdict.claim}")
        if not verdict.holds:
            typer.echo(f"       {verdict.mistake or f'found {verdict.found}'}")
    if suite.mistake:
        typer.echo(f"ERROR  {suite.path} was not judged")
    else:
        typer.echo(f"{suite.path}: {len(suite.verdicts)} claims, {suite.failures} fail")


def _print_json(suites: Iterable[_Suite]) -> None:
    rows = [
        {
            "name": str(each.path),
            "tests": len(each.verdicts),
            "failures": each.failures,
            "error": str(each.mistake or ""),
            "cases": [
                {"name": one.claim, "capture": one.capture, "passed": one.holds,
                 "found": one.found, "error": one.mistake}
                for one in each.verdicts
            ],
        }
        for each in suites
    ]  # fmt: skip
    print_json(rows)


def _end(suites: Sequence[_Suite]) -> None:
    """End as the worst of what was found has it: a mistake, a claim that fails, or neither."""
    mistakes = [each.mistake for each in suites if each.mistake]
    unread = sum(bool(one.mistake) for each in suites for one in each.verdicts)
    if len(mistakes) == 1 and not unread:
        raise mistakes[0]
    if mistakes or unread:
        several = "1 claim" if unread == 1 else f"{unread} claims"
        told = [f"{several} could not be judged; see above"] if unread else []
        raise CaparError("\n".join([*map(str, mistakes), *told]))
    if any(each.failures for each in suites):
        raise typer.Exit(1)
