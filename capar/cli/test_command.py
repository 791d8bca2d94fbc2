"""The command that tests captures: claims in words, checked against what was observed."""

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from capar.cli._options import Beside, Rules
from capar.cli._output import print_json
from capar.model.errors import CaparError

if TYPE_CHECKING:
    from capar.claims.motion_claims import Verdict

app = typer.Typer()


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


@app.command()
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
    from capar.claims.files import SUFFIX

    for file in files:
        yield from sorted(file.rglob(f"*{SUFFIX}")) if file.is_dir() else [file]


def _judged(path: Path, rules: Path | None, actionary: str | None) -> _Suite:
    from capar.claims.files import read_motion_test, run_motion_test

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
