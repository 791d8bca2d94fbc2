"""An action that the Actionary holds, or a capture's, on things that are stated or asked for."""

from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import asdict, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

import typer

if TYPE_CHECKING:
    from capar.cli._spoken_requests import Where
    from capar.pipelines.instantiation import Instance
    from capar.pipelines.recordings import Recording
    from capar.regeneration.bindings import Role
    from capar.regeneration.forces.force_kinds import ForceKind
    from capar.regeneration.motions import Motion
    from capar.regeneration.quality import Quality
    from capar.regeneration.scenes import Scene
    from capar.regeneration.sources import Source
    from capar.regeneration.style_kinds import Kind
    from kb import Actionary


class Manner(NamedTuple):
    """How it is done."""

    kind: "Kind"
    force: "ForceKind"
    style_of: str | None
    duration_s: float | None
    hand: str | None


def is_capture(place: str | Path) -> bool:
    """Whether a place is one of a capture, and none of a file that changes a scene."""
    from capar.pipelines.recordings import BUNDLE

    path = Path(place)
    return path.name == BUNDLE or path.suffix != ".toml"


def is_action(name: str) -> bool:
    """Whether a word names an action rather than a place in which a capture is."""
    path = Path(name.partition(":")[0])
    return path.name == name and not path.suffix and not path.exists()


def perform_instance(
    what: str,
    agent: str,
    where: "Where",
    manner: Manner,
    *,
    stated: Sequence[str],
    scene: Path | None,
    output: Path | None,
    assume: Path | None,
    json: bool,
) -> None:
    """Perform an action or a capture's on things of a scene, and tell how good it is.

    Raises:
        CaparError: Something does not exist, or the action cannot be done.
    """
    from capar.cli._gates import quality_answer, tell_quality
    from capar.cli._output import print_json
    from capar.pipelines.instantiation import Knowledge, instantiate

    parts = dict(_part(text) for text in stated)
    with _words(where, needed=is_action(what)) as words:
        known = Knowledge(words.kinds_above, words.abilities)
        recording, source, notes = _recorded(what, where, words, list(parts), assume)
        if manner.hand:
            from capar.pipelines.round_trips import by_hand

            source = by_hand(source, manner.hand)
        asked = _asked(what, agent, words, source, scene, parts)
        instance = instantiate(asked, recording, source, known, _asker())
    motion, quality = _performed(instance, manner)
    if output:
        _write(instance, motion, agent, output)
    told = (*notes, *instance.notes)
    if json:
        answer = quality_answer(motion, quality)
        bound = [asdict(binding) for binding in instance.bindings]
        head = {"action": what, "recording": recording.name, "objects": bound}
        print_json({**head, **answer, "notes": [*told, *answer["notes"]]})
        return
    for note in told:
        typer.echo(note)
    tell_quality(motion, quality)
    if output:
        typer.echo(f"wrote {output}", err=True)


def _part(text: str) -> tuple[str, str]:
    from capar.model.errors import CaparError

    part, sign, thing = text.partition("=")
    if not (part and sign and thing):
        raise CaparError(f"--object takes PART=THING, such as mug=red_mug; found {text!r}")
    return part, thing


@contextmanager
def _words(where: "Where", *, needed: bool) -> "Iterator[Actionary]":
    """The Actionary; where none is there and none is needed, one that knows only the ontology."""
    from capar.cli._options import has_actionary, opened, require_actionary
    from kb import Actionary

    if needed:
        require_actionary(where.actionary, observed=True)
    place = opened(where.actionary)
    if needed or has_actionary(place, named=where.actionary):
        with Actionary.open(place, read_only=True) as words:
            yield words
    else:
        with Actionary.in_memory() as words:
            yield words


def _recorded(
    what: str, where: "Where", words: "Actionary", parts: Sequence[str], assume: Path | None
) -> "tuple[Recording, Source, tuple[str, ...]]":
    """The recording that is performed, and what is to be told of its choice."""
    from capar.pipelines.known_actions import find_action
    from capar.pipelines.recordings import observed_recording, stored_recordings
    from capar.pipelines.round_trips import observed_source
    from capar.regeneration.completing import read_completion

    completion = read_completion(assume) if assume else None
    if not is_action(what):
        source = observed_source(what, completion)
        return observed_recording(source.observation, Path(what)), source, ()
    known, lost = stored_recordings(words, where.recordings or Path())
    for name in lost:
        typer.echo(f"capar: the capture of {name!r} is not in the folder of recordings", err=True)
    found = find_action(what, known, parts)
    notes = [f"{what}: performed as in recording {found.recording.name!r}"]
    if found.others:
        notes.append(
            f"{', '.join(found.others)} would do as well; the one with the stated parts is taken, "
            "then the one with the fewest steps, then the first by name"
        )
    return found.recording, observed_source(found.recording.capture, completion), tuple(notes)


def _asked(
    what: str,
    agent: str,
    words: "Actionary",
    source: "Source",
    scene: Path | None,
    parts: dict[str, str],
) -> Any:
    from capar.pipelines.instantiation import Asked
    from capar.pipelines.round_trips import SAME, body
    from capar.pipelines.trials import trial_of
    from capar.regeneration.casting import captured_scene
    from capar.regeneration.scene_files import read_scene

    who = source.capture.agent.name if agent == SAME else agent
    kinds = words.agent_profile(who)["kind"] if who in words.agents() else ()
    shape = next(iter(kinds), agent) if agent != SAME else agent
    place: Scene = source.scene
    own = scene is None or not is_capture(scene)
    if scene is not None:
        place = read_scene(scene, place) if own else captured_scene(trial_of(scene))
    named = tuple(dict.fromkeys((who, *kinds)))
    return Asked(what, named, body(shape, source), parts, place, own)


def _asker() -> Any:
    """Asks on a terminal which thing takes a part; None where nobody can answer."""
    from capar.cli._options import can_ask

    def ask(role: "Role", fitting: tuple[str, ...]) -> str:
        listed = ", ".join(fitting)
        while True:
            question = f"Which takes the part of {role.name!r} ({role.kind}): {listed}?"
            answer = str(typer.prompt(question, err=True)).strip()
            if answer in fitting:
                return answer
            typer.echo(f"{answer!r} does not fit; name one of {listed}.", err=True)

    return ask if can_ask() else None


def _performed(instance: "Instance", manner: Manner) -> "tuple[Motion, Quality]":
    from capar.pipelines.round_trips import by_hand, observed_source
    from capar.regeneration.regenerating import regenerate
    from capar.regeneration.styles import borrowed_style, own_style, paced

    source, style = instance.source, own_style(instance.source, manner.kind)
    if manner.style_of:
        other = observed_source(manner.style_of)
        other = by_hand(other, manner.hand) if manner.hand else other
        style = borrowed_style(source, other, manner.kind)
    style = replace(style, force=manner.force)
    if manner.duration_s:
        source = paced(source, manner.duration_s)
    return regenerate(source, instance.asked.human, instance.scene, style)


def _write(instance: "Instance", motion: "Motion", agent: str, output: Path) -> None:
    from capar.regeneration.captures import capture_of, renamed, write_motion

    source = instance.source
    name = agent if agent != "same" else source.capture.agent.name
    made = capture_of(motion, name=source.capture.name, agent=name)
    write_motion(motion, renamed(made, instance.names), output)
