"""The command that maps a recorded performance directly to another body."""

from typing import Annotated

import typer

from capar.cli._options import Assume, NewBundle

app = typer.Typer()


@app.command("map")
def map_command(
    capture: Annotated[
        str,
        typer.Argument(help="A capture bundle's folder or capture.toml; FOLDER:TAKE for a take."),
    ],
    agent: Annotated[
        str, typer.Option(help="Who performs: man, woman, child, or same for the one recorded.")
    ] = "same",
    output: NewBundle = None,
    cutoff: Annotated[
        float,
        typer.Option(
            help="Cutoff of the low-pass filter that takes noise from the recorded paths [Hz]; "
            "0 follows them as they are.",
            min=0.0,
        ),
    ] = 0.0,
    assume: Assume = None,
    json: Annotated[bool, typer.Option("--json", help="Print JSON for machines.")] = False,
) -> None:
    """Map CAPTURE directly to another body in the recorded scene: the baseline of `regenerate`.

    Hands and things go where they were recorded; what met the performer's head meets the new one's.
    Nothing is planned: no grip is fitted to the hand, and no obstacle is avoided. Every gate is
    printed, and how far hands and things are from their recorded ways.
    """
    from dataclasses import replace

    from capar.cli._gates import quality_answer, tell_quality
    from capar.cli._output import check_new_folder, print_json
    from capar.pipelines.round_trips import SAME, body, observed_source
    from capar.regeneration import map_directly
    from capar.regeneration.captures import capture_of, write_motion
    from capar.regeneration.completing import read_completion
    from capar.regeneration.departures import departures

    if output:
        check_new_folder(output)
    completion = read_completion(assume) if assume else None
    source = observed_source(capture, completion, cutoff_hz=cutoff or None)
    motion, quality = map_directly(source, body(agent, source))
    quality = replace(quality, told=(*quality.told, *departures(motion)))
    if output:
        name = agent if agent != SAME else source.capture.agent.name
        write_motion(motion, capture_of(motion, name=source.capture.name, agent=name), output)
    if json:
        print_json(quality_answer(motion, quality))
        return
    tell_quality(motion, quality)
    if output:
        typer.echo(f"wrote {output}", err=True)
