"""The command that performs a capture's action, or what is asked for, on another body."""

from dataclasses import replace
from pathlib import Path
from typing import Annotated

import typer

from capar.cli._options import Assume, NewBundle, Place, Rules

app = typer.Typer()


@app.command()
def regenerate(
    capture: Annotated[
        str | None,
        typer.Argument(
            help="A capture bundle's folder or capture.toml; FOLDER:TAKE for a take. With --say "
            "it may be left out: the Actionary's recordings are then looked through.",
            show_default=False,
        ),
    ] = None,
    say: Annotated[
        str | None,
        typer.Option(
            metavar="TEXT",
            help="What to do, such as 'pick up the mug and put it on the shelf'.",
            show_default=False,
        ),
    ] = None,
    agent: Annotated[
        str, typer.Option(help="Who performs: man, woman, child, or same for the one recorded.")
    ] = "same",
    scene: Annotated[
        Path | None,
        typer.Option(
            help="A TOML file that changes the scene: [stance] place, heading_deg, floor_m; "
            "[object.NAME] size, position, turn_deg, raise_m. With --say: the CAPTURE whose scene "
            "it is done in.",
            show_default=False,
        ),
    ] = None,
    output: NewBundle = None,
    style: Annotated[
        str,
        typer.Option(
            help="What of the recorded way is kept: path (shape and timing), frame (likewise, "
            "enlarged with the way), vel (timing), even (nothing: least jerk)."
        ),
    ] = "path",
    style_of: Annotated[
        str | None,
        typer.Option(help="Another capture of the same, whose style is taken.", show_default=False),
    ] = None,
    duration: Annotated[
        float | None, typer.Option(help="How long it takes [s].", show_default=False, min=0.1)
    ] = None,
    hand: Annotated[
        str | None,
        typer.Option(help="Which hand does it: right or left.", show_default=False),
    ] = None,
    effort: Annotated[
        str | None,
        typer.Option(
            metavar="NAME=VALUE,...",
            help="In which manner, from -1 to 1 each, 0 being as recorded: time (sustained to "
            "sudden), weight (light to strong), space (indirect to direct), flow (free to bound); "
            "or by pole, as in sudden=0.6,light=0.3.",
            show_default=False,
        ),
    ] = None,
    force: Annotated[
        str,
        typer.Option(
            help="What of a blow or a throw is kept: similar (the force, in proportion to arm and "
            "speed) or same (the thing's motion; the hand strikes as fast as that takes)."
        ),
    ] = "similar",
    recordings: Annotated[
        Path | None,
        typer.Option(
            metavar="FOLDER",
            help="With --say: the folder that holds the Actionary's captures; else this one.",
            show_default=False,
        ),
    ] = None,
    assume: Assume = None,
    actionary: Place = None,
    rules: Rules = None,
    json: Annotated[bool, typer.Option("--json", help="Print JSON for machines.")] = False,
) -> None:
    """Perform the action of CAPTURE on another body, verify every frame, and write a capture.

    With --say, what the words ask for is looked up among the recordings and performed in the scene.
    """
    from capar.cli._gates import effort_answer, quality_answer, tell_quality
    from capar.cli._output import check_new_folder, print_json
    from capar.model.errors import CaparError
    from capar.pipelines.round_trips import body, by_hand, observed_source
    from capar.regeneration.captures import capture_of, write_motion
    from capar.regeneration.completing import read_completion
    from capar.regeneration.forces.force_kinds import force_kind
    from capar.regeneration.manner import read_effort, regenerate_in_manner
    from capar.regeneration.scene_files import read_scene
    from capar.regeneration.style_kinds import style_kind
    from capar.regeneration.styles import borrowed_style, own_style

    if output:
        check_new_folder(output)
    kind, kept = style_kind(style), force_kind(force)
    manner = read_effort(effort) if effort is not None else None
    if say is not None:
        from capar.cli._spoken_requests import Where, perform_request

        if style_of:
            raise CaparError("--style-of is of one capture; leave it out, or --say")
        perform_request(
            say, agent, Where(capture, recordings, actionary, rules), scene=scene, output=output,
            how={"kind": kind, "duration_s": duration, "hand": hand, "effort": manner}, json=json,
        )  # fmt: skip
        return
    if capture is None:
        raise CaparError("name a CAPTURE, or what to do: --say 'touch the mug' --scene CAPTURE")
    recorded = observed_source(capture, read_completion(assume) if assume else None)
    human = body(agent, recorded)
    place = read_scene(scene, recorded.scene) if scene else recorded.scene
    source = by_hand(recorded, hand) if hand else recorded
    chosen = own_style(source, kind)
    if style_of:
        other = observed_source(style_of)
        chosen = borrowed_style(source, by_hand(other, hand) if hand else other, kind)
    chosen = replace(chosen, force=kept)
    motion, quality, report = regenerate_in_manner(
        source, human, place, chosen, effort=manner, duration_s=duration
    )
    if output:
        name = agent if agent != "same" else source.capture.agent.name
        made = capture_of(motion, name=source.capture.name, agent=name)
        write_motion(motion, made, output)
    if json:
        print_json({**quality_answer(motion, quality), **effort_answer(report)})
        return
    tell_quality(motion, quality)
    if report:
        typer.echo(report)
    if output:
        typer.echo(f"wrote {output}", err=True)
