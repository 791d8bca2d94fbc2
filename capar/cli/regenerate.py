"""The command that performs a capture's action, or what is asked for, on another body."""

from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from capar.cli._options import Assume, NewBundle, Place, Rules

if TYPE_CHECKING:
    from capar.cli._instantiation import Manner
    from capar.model.capture import Capture
    from capar.regeneration.manner import EffortReport
    from capar.regeneration.motions import Motion
    from capar.regeneration.quality import Quality
    from capar.regeneration.scenes import Scene

app = typer.Typer()


@app.command()
def regenerate(
    capture: Annotated[
        str | None,
        typer.Argument(
            metavar="[CAPTURE|ACTION]",
            help="A capture bundle's folder or capture.toml; FOLDER:TAKE for a take. Or an action "
            "that the Actionary holds, as a whole or as a step of a recording. With --say it may "
            "be left out: the Actionary's recordings are then looked through.",
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
        list[str] | None,
        typer.Option(
            help="Who performs: man, woman, child, or same for the one recorded, as is usual; for "
            "an ACTION or with --object also an agent of the Actionary whose kind is one of these. "
            "Of several performers once for all, once for each in their order, or NAME=child.",
            show_default=False,
        ),
    ] = None,
    things: Annotated[
        list[str] | None,
        typer.Option(
            "--object",
            metavar="PART=THING",
            help="The thing of the scene that takes the part of a recorded one; may be repeated. "
            "The other parts are taken by kind, or asked for where several things fit.",
            show_default=False,
        ),
    ] = None,
    scene: Annotated[
        Path | None,
        typer.Option(
            help="A TOML file that changes the scene: [stance] place, heading_deg, floor_m; "
            "[object.NAME] size, position, turn_deg, raise_m. Or the CAPTURE whose scene it is "
            "done in, as always with --say.",
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
    step: Annotated[
        bool | None,
        typer.Option(
            "--step/--no-step",
            help="Where it is out of reach from the given place, step to where it can be done; "
            "as usual for an ACTION or with --object, not as usual for a CAPTURE alone. Not with "
            "--say.",
            show_default=False,
        ),
    ] = None,
    recordings: Annotated[
        Path | None,
        typer.Option(
            metavar="FOLDER",
            help="With --say or an ACTION: the folder that holds the Actionary's captures; else "
            "this one.",
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
    An ACTION is performed as its recording has it, with the things that --object states.
    """
    from capar.cli._instantiation import Manner, is_action, is_capture, perform_instance
    from capar.cli._output import check_new_folder
    from capar.cli._several_performers import check_no_others, one_body, perform_jointly
    from capar.cli._spoken_requests import Where, perform_request
    from capar.model.errors import CaparError
    from capar.pipelines.trials import trial_of
    from capar.regeneration.forces.force_kinds import force_kind
    from capar.regeneration.manner import read_effort
    from capar.regeneration.style_kinds import style_kind

    if output:
        check_new_folder(output)
    kind, kept = style_kind(style), force_kind(force)
    agents = agent or ["same"]
    manner = read_effort(effort) if effort is not None else None
    if say is not None:
        if style_of or things or step:
            option = "--style-of" if style_of else "--object" if things else "--step"
            raise CaparError(f"{option} is of one recorded action; leave it out, or --say")
        perform_request(
            say, one_body(agents), Where(capture, recordings, actionary, rules), scene=scene,
            output=output, json=json,
            how={"kind": kind, "duration_s": duration, "hand": hand, "effort": manner},
        )  # fmt: skip
        return
    if capture is None:
        raise CaparError("name a CAPTURE, or what to do: --say 'touch the mug' --scene CAPTURE")
    how = Manner(kind, kept, style_of, duration, hand, manner)
    if things or is_action(capture) or (scene and is_capture(scene)):
        perform_instance(
            capture, one_body(agents), Where(None, recordings, actionary, rules),
            how, stated=things or [], scene=scene, output=output, assume=assume, json=json,
            step=step is not False,
        )  # fmt: skip
        return
    trial = trial_of(capture)
    if trial.others:
        check_no_others(
            {"--style-of": style_of, "--duration": duration, "--hand": hand, "--assume": assume,
             "--effort": effort, "--step": step, "--force": "" if force == "similar" else force}
        )  # fmt: skip
        perform_jointly(trial, agents, scene=scene, output=output, style=style, json=json)
        return
    _perform_alone(
        trial,
        one_body(agents),
        how,
        scene=scene,
        output=output,
        assume=assume,
        json=json,
        step=bool(step),
    )


def _perform_alone(
    trial: "Capture",
    who: str,
    how: "Manner",
    *,
    scene: Path | None,
    output: Path | None,
    assume: Path | None,
    json: bool,
    step: bool,
) -> None:
    """Perform what one performer was recorded to do."""
    from capar.cli._approaches import (
        approach_answer,
        performed_near,
        tell_approach,
        write_approach,
    )
    from capar.cli._gates import effort_answer, quality_answer, tell_quality
    from capar.cli._output import print_json
    from capar.pipelines.round_trips import body, by_hand, observed_source
    from capar.regeneration.captures import capture_of, write_motion
    from capar.regeneration.completing import read_completion
    from capar.regeneration.manner import regenerate_in_manner
    from capar.regeneration.scene_files import read_scene
    from capar.regeneration.styles import borrowed_style, own_style

    recorded = observed_source(trial, read_completion(assume) if assume else None)
    place = read_scene(scene, recorded.scene) if scene else recorded.scene
    source = by_hand(recorded, how.hand) if how.hand else recorded
    chosen = own_style(source, how.kind)
    if how.style_of:
        other = observed_source(how.style_of)
        chosen = borrowed_style(source, by_hand(other, how.hand) if how.hand else other, how.kind)
    chosen = replace(chosen, force=how.force)
    human = body(who, recorded)

    def act(where: "Scene") -> "tuple[Motion, Quality, EffortReport | None]":
        return regenerate_in_manner(
            source, human, where, chosen, effort=how.effort, duration_s=how.duration_s
        )

    stepped, (motion, quality, report) = performed_near(source, human, place, chosen, act, step)
    if output:
        name = who if who != "same" else source.capture.agent.name
        made = capture_of(motion, name=source.capture.name, agent=name)
        if stepped:
            write_approach(stepped, output / "1_steps", name)
        write_motion(motion, made, output / f"2_{source.capture.name}" if stepped else output)
    if json:
        answer = {**quality_answer(motion, quality), **effort_answer(report)}
        print_json({**answer, **approach_answer(stepped, answer["passed"])})
        return
    tell_approach(stepped)
    if stepped:
        typer.echo("the action itself:")
    tell_quality(motion, quality)
    if report:
        typer.echo(report)
    if output:
        typer.echo(f"wrote {output}", err=True)
