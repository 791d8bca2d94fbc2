"""The command that lets a virtual body perform an action, and records it."""

from pathlib import Path
from typing import Annotated

import typer

app = typer.Typer()


@app.command()
def perform(
    action: Annotated[
        str,
        typer.Argument(
            help="drink, sip, touch, touch_from_rest, slide, carry, carry_tray, carry_two, "
            "pick_up, turn, push, pour, door, drawer, wipe or toss; of two bodies hand_over."
        ),
    ],
    output: Annotated[Path, typer.Option("--output", "-o", help="A new folder for the capture.")],
    agent: Annotated[
        str,
        typer.Option(help="Who performs: man, woman or child; of two bodies such as man+woman."),
    ] = "man",
    rate: Annotated[float, typer.Option(help="Frames a second.", min=10.0, max=480.0)] = 60.0,
    noisy: Annotated[
        bool, typer.Option("--noisy", help="With the noise and the mounts of a magnetic tracker.")
    ] = False,
    seed: Annotated[int, typer.Option(help="The draw of the noise.", min=0)] = 3,
) -> None:
    """Let a virtual body perform ACTION at a table, and write what a tracker records of it.

    The capture bundle has sensors on hands and head, the things that are handled, and what
    is exactly so beside it (truth.toml): it serves to try every other command.
    """
    from capar.body.bundles import write_bundle
    from capar.body.joint_actions import JOINT_ACTIONS, joint_capture, performed_together
    from capar.body.joint_performances import truth_together
    from capar.body.recording import truth_of
    from capar.body.scripted_actions import action_capture, performed
    from capar.cli._output import check_new_folder

    check_new_folder(output)
    if action in JOINT_ACTIONS:
        pair = (*agent.split("+"), *agent.split("+"))[:2]
        made = performed_together(action, (pair[0], pair[1]), rate_hz=rate)
        both = joint_capture(action, (pair[0], pair[1]), rate_hz=rate, noisy=noisy, seed=seed)
        write_bundle(both, truth_together(made), output)
        typer.echo(
            f"wrote {output}: {action} by a {pair[0]} and a {pair[1]}, {both.times[-1]:.1f} s at "
            f"{rate:g} Hz",
            err=True,
        )
        return
    capture = action_capture(action, agent, rate_hz=rate, noisy=noisy, seed=seed)
    write_bundle(capture, truth_of(performed(action, agent, rate_hz=rate)), output)
    typer.echo(
        f"wrote {output}: {action} by a {agent}, {capture.times[-1]:.1f} s at {rate:g} Hz, "
        f"{len(capture.sensors)} sensors and {len(capture.objects)} objects",
        err=True,
    )
