"""Check what is observed: against labels, and against claims in words."""

from collections.abc import Iterator, Mapping, Sequence
from itertools import chain
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer
from typer import Argument, Option

from capar.cli.options import Beside, Json, ProfileName, Rules, Steady, rule_base
from capar.cli.output import check_picture, print_json, print_table, progress, written
from capar.evaluation import Contradictions, Kind
from capar.model.errors import CaparError

if TYPE_CHECKING:
    from capar.claims.claims import Verdict

SHOWN = 12
"""Rows of confusions and of the longest differences that are printed; JSON has all."""

MOST_PARTS = 20
"""Up to so many links, bodies, objects or events have a row each; JSON has all."""

Scores = Mapping[str, Any]


def evaluate(
    places: Annotated[
        list[str],
        Argument(
            metavar="EVALUATION|CAPTURE LABELS...",
            help="An evaluation file; or captures, each with a label file; {take} in its name "
            "stands for each take of BUNDLE:PATTERN.",
        ),
    ],
    mapping: Annotated[
        Path | None, Option("--mapping", "-m", help="A TOML file from our names to labels.")
    ] = None,
    kind: Annotated[Kind, Option(help="What the labels are about.")] = Kind.ACTIONS,
    takes: Annotated[
        list[str] | None, Option(help="Of an evaluation file only these takes; may be repeated.")
    ] = None,
    profile: ProfileName = "extended",
    frames_of: Annotated[str, Option(help="The file whose frames labels count.")] = "",
    contradictions: Annotated[
        Contradictions, Option(help="Labels that overlap or end before they start.")
    ] = Contradictions.REFUSE,
    rules: Rules = None,
    actionary: Beside = None,
    steady: Steady = None,
    plot: Annotated[
        Path | None,
        Option(
            help="Draw labels and segments to a .png, .svg or .pdf file; {capture} is the name."
        ),
    ] = None,
    json: Json = False,
) -> None:
    """Compare what is observed with labels, by take and pooled.

    Label files are CSV, JSON, ELAN (.eaf), Praat (.TextGrid), or the JSON of the KIT Bimanual
    Actions Dataset. Their columns: link,start_s,end_s,label (actions); body,other,start_s,end_s
    (contacts); object,start_s,end_s (carries); hand,event,start_s,end_s (events). In ELAN and
    Praat a tier is a link or body. Without --mapping, labels of actions are our own names.

    Actions: frame-wise accuracy and macro F1, segmental F1 at 10, 25 and 50 % overlap, edit
    score, and errors of onset and offset. Contacts: frame-wise precision, recall and F1.
    Carries: printed starts and ends near the labels. Events: what was seen and found.
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
    for path in picture_paths(plot, [each.name for each in plan.pairs]).values() if plot else ():
        check_picture(path)
    found = carry_out(plan, rules=base, progress=progress("observing"))
    paths = picture_paths(plot, [each.name for each in found.captures]) if plot else {}
    for capture in found.captures if plot else ():
        with written(paths[capture.name]) as draft:
            draw_evaluation(found, capture, path=draft)
    if json:
        print_json(report(found))
    else:
        _print_evaluation(report(found))
    for path in dict.fromkeys(paths.values()):
        typer.echo(f"drew {path}", err=True)


def _print_evaluation(result: Scores) -> None:
    """Scores, then confusions and the longest differences, then remarks."""
    kind, everything = str(result["kind"]), result["all"]
    part, caption, columns = TABLES[kind]
    rows, sections = list[tuple[str, ...]](), list[int]()
    for group in _score_rows(part, result):
        rows += [(name, *(_cell(own[key]) for key in columns.values())) for name, own in group]
        sections.append(len(rows) - 1)
    captures = len(result["captures"])
    print_table(
        (part, *columns), rows, right=range(1, len(columns) + 1), sections=sections[:-1],
        title=f"{captures} capture{'s' * (captures != 1)}", caption=caption,
    )  # fmt: skip
    lines = []
    if kind == "actions":
        _print_confusions(everything)
        for name in ("missed", "inserted"):
            counts = ", ".join(f"{each} {n}" for each, n in everything[name].items())
            lines.append(f"segments {name}: {counts or 'none'}")
    if result["worst"]:
        keys = ("capture", "channel", "start_s", "end_s", "true", "found", "segments")
        spans = [
            [f"{each[k]:.2f}" if k.endswith("_s") else str(each[k]) for k in keys]
            for each in result["worst"][:SHOWN]
        ]
        heading = ("capture", "of", "from", "to", "labelled", "found", "segments")
        print_table(heading, spans, right={2, 3}, title="longest intervals that differ [s]")
    if kind == "carries":
        sharp = everything["moving_at_both_ends"]
        start, end, both = (_cell(sharp[key]) for key in ("start", "end", "both"))
        lines += [
            f"{everything['excluded']} of {everything['carries']} carries are excluded, as nothing "
            f"moves in them; a carry counts as found within {everything['within_s']:g} s",
            f"of {sharp['carries']} whose object moves at both labelled ends: start {start}, "
            f"end {end}, both {both} %",
        ]
    lines += result["notices"]
    if result[f"unlabelled_{part}"]:
        names = ", ".join(result[f"unlabelled_{part}"])
        lines.append(f"not counted, because they bear no labels: {names}")
    for line in lines:
        typer.echo(line)


def _score_rows(part: str, result: Scores) -> Iterator[list[tuple[str, Scores]]]:
    """Parts and whole; then each group's, then each capture's whole."""
    shown = list(result[part].items())
    yield [*(shown if len(shown) <= MOST_PARTS else ()), ("all", result["all"])]
    for name, group in result["groups"].items():
        own = [(f"{name}: {each}", scores) for each, scores in group[part].items()]
        yield [*(own if len(own) <= MOST_PARTS else ()), (f"{name}: all", group["all"])]
    if len(result["by_capture"]) > 1:
        yield [(name, scores["all"]) for name, scores in result["by_capture"].items()]


def _print_confusions(scored: Scores) -> None:
    wrong = [each for each in scored["confusion"] if each["true"] != each["predicted"]]
    rows = [
        (each["true"], each["predicted"], str(each["frames"]),
         f"{100 * each['frames'] / scored['frames']:.1f} %")
        for each in wrong[:SHOWN]
    ]  # fmt: skip
    if len(wrong) > SHOWN:
        rows.append(("...", "...", str(sum(each["frames"] for each in wrong[SHOWN:])), ""))
    columns = ("true", "predicted", "frames", "share")
    print_table(columns, rows, right={2, 3}, title="frames under another label")


def _cell(value: Any) -> str:
    """A count, a score, or median and 95th percentile of an error."""
    if isinstance(value, Mapping):
        return " / ".join(f"{v:.0f}" if (v := value[k]) is not None else "-" for k in PERCENTILES)
    return "-" if value is None else str(value) if isinstance(value, int) else f"{value:.1f}"


PERCENTILES = ("median", "p95")
ONSETS = {"onset": "onset_ms", "offset": "offset_ms"}
TABLES: dict[str, tuple[str, str, dict[str, str]]] = {
    "actions": (
        "links",
        "onset, offset: median / 95th percentile of the size of the error [ms]",
        {"accuracy": "accuracy", "F1": "macro_f1", "F1@10": "f1@10", "@25": "f1@25",
         "@50": "f1@50", "edit": "edit", **ONSETS},
    ),
    "contacts": (
        "bodies",
        "all: whether any body touches; frame by frame [%]\n"
        "onset, offset: median / 95th percentile of the distance to the nearest found one [ms]",
        {"frames": "frames", "precision": "precision", "recall": "recall", "F1": "f1", **ONSETS},
    ),
    "carries": (
        "objects",
        "start, end, both: carries whose printed ends are near the labelled ones [%]\n"
        "off: median / 95th percentile of the size of the error [ms]",
        {"carries": "counted", "start": "start", "end": "end", "both": "both",
         "start off": "start_ms", "end off": "end_ms", "extra": "extra"},
    ),
    "events": (
        "events",
        "away: median / 95th percentile of the distance from what was seen to what was found [ms]",
        {"seen": "seen", "found": "found", "missed": "missed", "open": "open", "extra": "extra",
         "F1": "f1", "away": "away_ms"},
    ),
    "containers": (
        "containers",
        "went in: the middle lies in the container at the end and did not before",
        {"objects": "objects", "right": "right", "went in": "went_in", "told": "told",
         "told wrongly": "told_wrongly", "untold": "untold"},
    ),
}  # fmt: skip
"""For each kind of labels: its parts, the caption, and the key of each column's scores."""


def test(
    files: Annotated[list[Path], Argument(help="*.motion.toml files or folders.")],
    rules: Rules = None,
    actionary: Beside = None,
    json: Json = False,
) -> None:
    """Check claims about captures.

    Exits with 1 if a claim does not hold, with 2 if one cannot be judged. A *.motion.toml names
    captures from its own folder on, and what is expected of each; a rules folder and a profile may
    be stated.

    \b
        captures = ["drink_*", "cups:take3", "mugs:*"]
        [[expect]]
        that = "right_hand MoveObjTo(mug, head)"

    A claim is one of these:

    \b
        EVENT; no EVENT          right_hand MoveObjTo(mug, head); no mug touches head
        EVENT before EVENT       or after, while, begins before, ends before
        EVENT lasts A to B s     right_hand MoveObj(mug) lasts 0.1 to 2 s
        END_EFFECTOR: STEPS      right_hand: Reach(mug), ..., ResumePosture

    and an event one of these; _ is any object, and a general name fits what specialises it:

    \b
        END_EFFECTOR STEP        right_hand MoveObjTo(_, head)
        several of them do STEP  both hands do Lift(box); left_hand and right_hand do Lift(box)
        BODY touches BODY        or lets go of: right_hand lets go of mug
        OBJECT moves             mug moves
        SENSOR looks at OBJECT   or looks away from: head looks at mug

    What no rule, object or sensor is called is a mistake, also after "no". Under pytest each
    claim of each capture is a test of its own.
    """  # noqa: D301 (\b is for typer: lines that stay as they are)
    from capar.claims.claims import SUFFIX, read_motion_test, run_motion_test

    rows: list[dict[str, Any]] = []
    mistakes: list[CaparError] = []
    folders = (sorted(each.rglob(f"*{SUFFIX}")) if each.is_dir() else [each] for each in files)
    for path in chain.from_iterable(folders):
        verdicts: Sequence[Verdict] = ()
        mistake = ""
        try:
            claimed = read_motion_test(path)
            verdicts = list(run_motion_test(claimed, rules=rules, actionary=actionary))
        except CaparError as error:
            mistake = str(error)
            mistakes.append(error)
        cases = [
            {"name": one.claim, "capture": one.capture, "passed": one.holds,
             "found": one.found, "error": one.mistake}
            for one in verdicts
        ]  # fmt: skip
        failures = sum(not each.holds for each in verdicts)
        head = {"name": str(path), "tests": len(verdicts), "failures": failures}
        rows.append({**head, "error": mistake, "cases": cases})
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
