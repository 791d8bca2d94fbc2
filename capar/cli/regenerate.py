"""The command that performs a capture's action on another body."""

from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

if TYPE_CHECKING:
    from capar.regeneration.motions import Motion
    from capar.regeneration.quality import Quality

app = typer.Typer()


@app.command()
def regenerate(
    capture: Annotated[
        str,
        typer.Argument(help="A capture bundle's folder or capture.toml; FOLDER:TAKE for a take."),
    ],
    agent: Annotated[
        str, typer.Option(help="Who performs: man, woman, child, or same for the one recorded.")
    ] = "same",
    scene: Annotated[
        Path | None,
        typer.Option(
            help="A TOML file that changes the scene: [stance] place, heading_deg, floor_m; "
            "[object.NAME] size, position, turn_deg, raise_m.",
            show_default=False,
        ),
    ] = None,
    output: Annotated[
        Path | None,
        typer.Option(help="A new folder for the capture bundle.", show_default=False),
    ] = None,
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
    json: Annotated[bool, typer.Option("--json", help="Print JSON for machines.")] = False,
) -> None:
    """Perform the action of CAPTURE on another body, verify every frame, and write a capture."""
    from capar.cli._output import check_new_folder, print_json
    from capar.pipelines.round_trips import body, by_hand, observed_source
    from capar.regeneration.captures import capture_of, write_motion
    from capar.regeneration.regenerating import regenerate as perform
    from capar.regeneration.scene_files import read_scene
    from capar.regeneration.style_kinds import style_kind
    from capar.regeneration.styles import borrowed_style, own_style, paced

    if output:
        check_new_folder(output)
    kind = style_kind(style)
    recorded = observed_source(capture)
    human = body(agent, recorded)
    place = read_scene(scene, recorded.scene) if scene else recorded.scene
    source = by_hand(recorded, hand) if hand else recorded
    chosen = own_style(source, kind)
    if style_of:
        other = observed_source(style_of)
        chosen = borrowed_style(source, by_hand(other, hand) if hand else other, kind)
    if duration:
        source = paced(source, duration)
    motion, quality = perform(source, human, place, chosen)
    if output:
        name = agent if agent != "same" else source.capture.agent.name
        made = capture_of(motion, name=source.capture.name, agent=name)
        write_motion(motion, made, output)
    if json:
        print_json(_answer(motion, quality))
        return
    _tell(motion, quality)
    if output:
        typer.echo(f"wrote {output}", err=True)


def _answer(motion: "Motion", quality: "Quality") -> dict[str, Any]:
    gates = [
        {
            "name": gate.name,
            "value": round(gate.value, 4),
            "limit": gate.limit,
            "unit": gate.unit,
            "passed": gate.passed,
            "frame": gate.frame,
            "bodies": gate.bodies,
        }
        for gate in quality.gates
    ]
    return {
        "passed": quality.passed,
        "gates": gates,
        "told": quality.told,
        "notes": motion.plan.notes,
    }


def _tell(motion: "Motion", quality: "Quality") -> None:
    typer.echo("gate               value     limit   unit        passed  worst at")
    times = motion.plan.source.times
    for gate in quality.gates:
        sign = ">=" if gate.at_least else "<="
        at = f"{times[gate.frame]:.2f} s" if gate.frame >= 0 else ""
        typer.echo(
            f"{gate.name:16} {gate.value:8.3f}  {sign} {gate.limit:6.2f}  {gate.unit:10}  "
            f"{'yes' if gate.passed else 'NO':6}  {at} {gate.bodies}".rstrip()
        )
    for each in quality.told:
        typer.echo(f"{each.name}: {each.value:.1f} {each.unit} ({each.bodies}), not demanded")
    for note in motion.plan.notes:
        typer.echo(f"note: {note}")
