"""How `capar regenerate` and `capar roundtrip` treat recordings of several performers."""

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import typer

if TYPE_CHECKING:
    from capar.model.capture import Capture
    from capar.pipelines.joint_round_trips import JointTrip
    from capar.regeneration.joint_regenerating import JointMotion

HEADING = "agents       scene  same PAR  contacts  relations  gates  where not"


def check_no_others(options: dict[str, Any]) -> None:
    """Refuse options that are of one performer.

    Args:
        options: By name; those that were not given are empty.

    Raises:
        CaparError: One was given.
    """
    from capar.model.errors import CaparError

    given = [name for name, value in options.items() if value]
    if given:
        raise CaparError(
            f"{given[0]} is of one performer, and this capture has several; leave it out, or cut "
            "the capture to one agent's sensors"
        )


def one_body(agents: Sequence[str]) -> str:
    """The body that performs what one was recorded to do.

    Raises:
        CaparError: There are several.
    """
    from capar.model.errors import CaparError

    if len(agents) > 1:
        raise CaparError(
            f"{len(agents)} bodies, and one performer was recorded; name one with --agent"
        )
    return agents[0]


def perform_jointly(
    capture: "Capture",
    agents: Sequence[str],
    *,
    scene: Path | None,
    output: Path | None,
    style: str,
    json: bool,
) -> None:
    """Perform a capture of several performers with several bodies, and tell every gate.

    Args:
        capture: What was recorded.
        agents: Who performs.
        scene: A file that changes the scene.
        output: A new folder for the capture bundle.
        style: What of the recorded ways is kept.
        json: Whether JSON is printed.
    """
    from capar.cli._output import print_json
    from capar.pipelines.joint_round_trips import bodies, observed_joint_source
    from capar.regeneration.joint_captures import joint_capture_of, write_joint_motion
    from capar.regeneration.joint_regenerating import regenerate_together
    from capar.regeneration.scene_files import read_scenes
    from capar.regeneration.style_kinds import style_kind

    kind, source = style_kind(style), observed_joint_source(capture)
    scenes = {name: one.scene for name, one in source.sources.items()}
    humans = bodies(agents, source)
    where = read_scenes(scene, scenes) if scene else scenes
    made = regenerate_together(source, humans, where, kind)
    if output:
        again = joint_capture_of(made, name=source.capture.name)
        write_joint_motion(made, again, output)
    if json:
        print_json(joint_answer(made))
        return
    tell_joint_quality(made)
    if output:
        typer.echo(f"wrote {output}", err=True)


def joint_answer(made: "JointMotion") -> dict[str, Any]:
    """Gates and notes of several motions, for machines."""
    from capar.cli._gates import gate_rows, quality_answer

    performers = {
        name: quality_answer(motion, made.qualities[name]) for name, motion in made.motions.items()
    }
    return {"passed": made.passed, "performers": performers, "gates": gate_rows(made.gates)}


def tell_joint_quality(made: "JointMotion") -> None:
    """Print the gates of every body and between them, and the notes, each once."""
    from capar.cli._gates import tell_gates, tell_measures

    notes: dict[str, None] = {}
    for name, motion in made.motions.items():
        typer.echo(f"{name}:")
        tell_gates(made.qualities[name].gates, motion.plan.source.times)
        tell_measures(made.qualities[name])
        notes |= dict.fromkeys(
            note if note in notes or not note.startswith("the ") else f"{name}: {note}"
            for note in motion.plan.notes
        )
    typer.echo("together:")
    tell_gates(made.gates, motion.plan.source.times)
    for note in notes:
        typer.echo(f"note: {note}")


def tell_joint_trips(
    capture: "Capture", casts: Sequence[str], *, scenes: int, seed: int, json: bool
) -> None:
    """Observe, perform with every cast in every scene, observe again, and compare.

    Args:
        capture: What was recorded.
        casts: Bodies joined by plus signs.
        scenes: How many are drawn.
        seed: Of the scenes.
        json: Whether JSON is printed.
    """
    from capar.cli._round_trips import tell_trips
    from capar.pipelines.joint_round_trips import (
        bodies,
        joint_round_trips,
        observed_joint_source,
    )

    source = observed_joint_source(capture)
    for cast in casts:
        bodies(cast.split("+"), source)  # a misspelt one is refused before anything is computed
    trips = joint_round_trips(source, casts, scenes=scenes, seed=seed)
    tell_trips(trips, _row, heading=HEADING, json=json)


def _row(trip: "JointTrip") -> str:
    if trip.refused:
        return f"{trip.agents:12} {trip.scene:5}  not performed: {trip.refused}"
    cells = (trip.same_par, trip.same_contacts, trip.same_relations, not trip.failed)
    words = ["yes" if same else "NO" for same in cells]
    where = "; ".join([*trip.failed, *([trip.names] if trip.names else [])])
    return (
        f"{trip.agents:12} {trip.scene:5}  {words[0]:8}  {words[1]:8}  {words[2]:9}  "
        f"{words[3]:5}  {where}"
    ).rstrip()
