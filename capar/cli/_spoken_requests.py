"""What is asked for in words: the recordings, the scene, the performances, and what is told."""

from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

import typer

if TYPE_CHECKING:
    from capar.body.human import Human
    from capar.pipelines.recordings import Recording
    from capar.pipelines.spoken_requests import Choice, Performance
    from capar.regeneration.scenes import Scene


class Where(NamedTuple):
    """Where recordings and words are: one capture, or an Actionary and captures; and the rules."""

    capture: str | None
    recordings: Path | None
    actionary: str | None
    rules: Path | None


def perform_request(
    text: str,
    agent: str,
    where: Where,
    *,
    scene: Path | None,
    output: Path | None,
    how: dict[str, Any],
    json: bool,
) -> None:
    """Perform what a text asks for, one action after the other, and tell how good each is.

    Raises:
        CaparError: The text cannot be read, or what it asks for cannot be done.
    """
    from capar.cli._output import print_json
    from capar.pipelines.spoken_requests import after, perform

    place, human, chosen = _asked(text, agent, where, scene)
    made: list[Performance] = []
    for choice in chosen:
        made.append(perform(choice, place, human, **how))
        place = after(made[-1], place)
    if output:
        _write(made, agent, output)
    if json:
        print_json({"performed": [_answer(performance) for performance in made]})
        return
    for performance in made:
        _tell(performance)
    if output:
        typer.echo(f"wrote {output}", err=True)


def _asked(
    text: str, agent: str, where: Where, scene: Path | None
) -> "tuple[Scene, Human, tuple[Choice, ...]]":
    """The scene, who performs, and the recordings that do what is asked for."""
    from capar.body.anthropometry import measures_of, ready_made
    from capar.body.human import Human
    from capar.cli._options import rule_words
    from capar.model.errors import CaparError
    from capar.pipelines.language import vocabulary
    from capar.pipelines.spoken_requests import choices, observed_actions
    from capar.pipelines.trials import trial_of
    from capar.regeneration.casting import captured_scene
    from capar.regeneration.requests import read_requests

    stage = str(scene) if scene else where.capture
    if stage is None:
        raise CaparError("name the scene that it is done in: --scene CAPTURE")
    trial = trial_of(stage)
    place = captured_scene(trial)
    human = Human.of(measures_of(trial.agent) if agent == "same" else ready_made(agent))
    words = vocabulary(rule_words(where.rules, where.actionary))
    known, lost = _recordings(where)
    for name in lost:
        typer.echo(f"capar: the capture of {name!r} is not in the folder of recordings", err=True)
    requests = read_requests(text, words, place, observed_actions(known))
    return place, human, choices(requests, known)


def _recordings(where: Where) -> "tuple[tuple[Recording, ...], tuple[str, ...]]":
    from capar.cli._options import opened, require_actionary
    from capar.pipelines.observation import observe
    from capar.pipelines.recordings import observed_recording, stored_recordings
    from kb import Actionary

    if where.capture is not None:
        return (observed_recording(observe(where.capture), Path(where.capture)),), ()
    require_actionary(where.actionary, observed=True)
    with Actionary.open(opened(where.actionary), read_only=True) as words:
        return stored_recordings(words, where.recordings or Path())


def _write(made: "list[Performance]", agent: str, output: Path) -> None:
    """One bundle, or for several actions one in a folder each, numbered."""
    from capar.regeneration.captures import capture_of, renamed, write_motion

    for number, each in enumerate(made, start=1):
        source = each.motion.plan.source
        name = agent if agent != "same" else source.capture.agent.name
        made_of = capture_of(each.motion, name=each.choice.recording.name, agent=name)
        folder = output if len(made) == 1 else output / f"{number}_{each.choice.recording.name}"
        write_motion(each.motion, renamed(made_of, each.names), folder)


def _answer(each: "Performance") -> dict[str, Any]:
    from capar.cli._gates import effort_answer, quality_answer

    answer = quality_answer(each.motion, each.quality)
    return {
        "recording": each.choice.recording.name,
        "asked": [" ".join((r.said, *r.objects)) for r in each.choice.requests],
        **answer,
        **effort_answer(each.effort),
        "notes": [*each.notes, *answer["notes"]],
    }


def _tell(each: "Performance") -> None:
    from capar.cli._gates import tell_quality

    for note in each.notes:
        typer.echo(note)
    tell_quality(each.motion, each.quality)
    if each.effort:
        typer.echo(each.effort)
