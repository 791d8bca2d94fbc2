"""The command that prints what was measured, as a logic program."""

from typing import Annotated

import typer

from capar.cli._options import Beside, Rules, Steady, rule_base

app = typer.Typer()


@app.command()
def facts(
    capture: Annotated[
        str,
        typer.Argument(help="A capture bundle's folder or capture.toml; FOLDER:TAKE for a take."),
    ],
    profile: Annotated[
        str, typer.Option(help="For which rules to number the borders.")
    ] = "extended",
    ranked: Annotated[
        bool,
        typer.Option(help="Number the borders too, so that the rule files can read the program."),
    ] = True,
    derive: Annotated[
        bool,
        typer.Option(
            "--derive",
            help="Add contact(Body, Other, Frame), moved(Object, Segment) and "
            "regrasps(Segment, Object) by the rules.",
        ),
    ] = False,
    rules: Rules = None,
    actionary: Beside = None,
    steady: Steady = None,
) -> None:
    """Print the ground facts of CAPTURE as an ASP program, for clingo with the rule files."""
    from capar.model.facts import program
    from capar.pipelines.observation import facts_program
    from capar_rules.engine.solver import rule_file, solve, text_of
    from extractors.readers.bundle.capture_toml import read_capture

    base = rule_base(profile, rules, actionary, steady=steady)
    trial = read_capture(capture)
    measurements, borders = facts_program(trial, rules=base)
    typer.echo(f"% {trial.name}: what was measured.\n{program(measurements.facts)}", nl=False)
    if ranked:
        typer.echo(
            f"% Borders, numbered for the profile {base.name}.\n{program(borders)}", nl=False
        )
        typer.echo(f"% Rules: {' '.join(map(str, base.files))}")
    if derive:
        answer = solve(
            (*base.files, rule_file("explain/derived.lp")), (*measurements.facts, *borders)
        )
        lines = "".join(
            f"{text_of((name, *arguments))}.\n"
            for name in ("contact", "moved", "regrasps")
            for arguments in answer.of(name)
        )
        typer.echo(f"% Derived.\n{lines}", nl=False)
