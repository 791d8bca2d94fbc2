"""The command that tests captures: claims in words, checked against what was observed."""

from pathlib import Path
from typing import Annotated

import typer

from capar.cli._rules import Beside, Rules

app = typer.Typer()


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
    """Check claims about captures; exit with 1 if one does not hold.

    A file that names a folder of rules itself is judged with those.
    """
    from capar.motion_tests import SUFFIX, failures, read_motion_test, run_motion_test

    paths = [
        path
        for each in files
        for path in (sorted(each.rglob(f"*{SUFFIX}")) if each.is_dir() else [each])
    ]
    suites = []
    failed = 0
    for path in paths:
        claimed = read_motion_test(path)
        verdicts = list(run_motion_test(claimed, rules=rules, actionary=actionary))
        failed += len(failures(verdicts))
        suites.append((path, verdicts))
    if json:
        import json as codec

        rows = [
            {
                "name": str(path),
                "tests": len(verdicts),
                "failures": len(failures(verdicts)),
                "cases": [
                    {"name": each.claim, "capture": each.capture, "passed": each.holds,
                     "found": each.found}
                    for each in verdicts
                ],
            }
            for path, verdicts in suites
        ]  # fmt: skip
        typer.echo(codec.dumps(rows, indent=2))
    else:
        for path, verdicts in suites:
            for each in verdicts:
                mark = "holds" if each.holds else "FAILS"
                typer.echo(f"{mark}  {each.capture}: {each.claim}")
                if not each.holds:
                    typer.echo(f"       found {each.found}")
            typer.echo(f"{path}: {len(verdicts)} claims, {len(failures(verdicts))} fail")
    if failed:
        raise typer.Exit(1)
