"""An action that the Actionary holds, or a capture's, on things that are stated or asked for."""

from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import asdict, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

import typer

if TYPE_CHECKING:
    from capar.cli._spoken_requests import Where
    from capar.pipelines.instantiation import Asked, Instance
    from capar.pipelines.preparations import Performed, Prepared
    from capar.pipelines.preparing import World
    from capar.pipelines.recordings import Recording
    from capar.pipelines.stances import Approach
    from capar.regeneration.bindings import Role
    from capar.regeneration.forces.force_kinds import ForceKind
    from capar.regeneration.manner import Effort, EffortReport
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
    effort: "Effort | None"


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
    step: bool = True,
) -> None:
    """Perform an action or a capture's on things of a scene, and tell how good it is.

    Raises:
        CaparError: Something does not exist, or the action cannot be done.
    """
    from capar.cli._approaches import approach_answer
    from capar.cli._output import print_json
    from capar.pipelines.instantiation import Knowledge, instantiate
    from capar.pipelines.preparations import prepare
    from capar.pipelines.ways import opened as open_recording
    from capar.pipelines.ways import ways_of

    parts = dict(_part(text) for text in stated)
    with _words(where, needed=is_action(what)) as words:
        known = Knowledge(words.kinds_above, words.abilities)
        recordings = _recordings(what, where, words)
        recording, source, notes = _recorded(what, recordings, list(parts), assume)
        if manner.hand:
            from capar.pipelines.round_trips import by_hand

            source = by_hand(source, manner.hand)
        asked, world = _asked(what, agent, words, source, scene, parts, step=step)
        instance = instantiate(asked, recording, source, known, _asker())
        prepared = prepare(
            instance, world, known.kinds, lambda: ways_of(recordings, open_recording)
        )
    stepped, main = _performed(instance, prepared.world.scene, manner, step=step)
    stages = [(done.stage.way.recording.name, done) for done in prepared.done]
    made = [*stages, (recording.name, main)]
    if output:
        _write(made, agent, output, stepped)
    told = (*notes, *instance.notes)
    if json:
        bound = [asdict(binding) for binding in instance.bindings]
        head = {"action": what, "recording": recording.name, "objects": bound}
        answer = _answer(prepared, main, told)
        print_json({**head, **answer, **approach_answer(stepped, answer["passed"])})
        return
    for note in told:
        typer.echo(note)
    _tell(prepared, main, stepped)
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


def _recordings(what: str, where: "Where", words: "Actionary") -> "tuple[Recording, ...]":
    """What can be performed: the Actionary's recordings whose captures are there."""
    from capar.pipelines.recordings import stored_recordings

    known, lost = stored_recordings(words, where.recordings or Path())
    for name in lost if is_action(what) or where.recordings else ():
        typer.echo(f"capar: the capture of {name!r} is not in the folder of recordings", err=True)
    return known


def _recorded(
    what: str, known: "Sequence[Recording]", parts: Sequence[str], assume: Path | None
) -> "tuple[Recording, Source, tuple[str, ...]]":
    """The recording that is performed, and what is to be told of its choice."""
    from capar.pipelines.known_actions import find_action
    from capar.pipelines.recordings import observed_recording
    from capar.pipelines.round_trips import observed_source
    from capar.regeneration.completing import read_completion

    completion = read_completion(assume) if assume else None
    if not is_action(what):
        source = observed_source(what, completion)
        return observed_recording(source.observation, Path(what)), source, ()
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
    *,
    step: bool,
) -> "tuple[Asked, World]":
    """What is asked for, and the world in which it is, as measured."""
    from capar.pipelines.instantiation import Asked
    from capar.pipelines.preparations import captured_world, measured_world
    from capar.pipelines.round_trips import SAME, body
    from capar.pipelines.stances import FARTHEST_M
    from capar.regeneration.scene_files import read_scene

    who = source.capture.agent.name if agent == SAME else agent
    kinds = words.agent_profile(who)["kind"] if who in words.agents() else ()
    shape = next(iter(kinds), agent) if agent != SAME else agent
    own = scene is None or not is_capture(scene)
    world = measured_world(source) if own or scene is None else captured_world(scene)
    if scene is not None and own:
        world = replace(world, scene=read_scene(scene, source.scene))
    named = tuple(dict.fromkeys((who, *kinds)))
    steps_m = FARTHEST_M if step else 0.0
    return Asked(what, named, body(shape, source), parts, world.scene, own, steps_m), world


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


def _performed(
    instance: "Instance", scene: "Scene", manner: Manner, *, step: bool
) -> "tuple[Approach | None, Performed]":
    """The action itself, after steps to where it can be done if these are allowed and needed.

    That contacts are as its PARs assert is a gate.
    """
    from capar.cli._approaches import performed_near
    from capar.pipelines.preparations import Performed
    from capar.pipelines.round_trips import by_hand, observed_source
    from capar.pipelines.ways import asserted
    from capar.regeneration.contact_tables import contact_gate
    from capar.regeneration.manner import regenerate_in_manner
    from capar.regeneration.quality import Quality
    from capar.regeneration.styles import borrowed_style, own_style

    source, where, names = instance.placed(scene)
    style = own_style(source, manner.kind)
    if manner.style_of:
        other = observed_source(manner.style_of)
        other = by_hand(other, manner.hand) if manner.hand else other
        style = borrowed_style(source, other, manner.kind)
    style = replace(style, force=manner.force)
    human, assertions = instance.asked.human, asserted(source)

    def act(there: "Scene") -> "tuple[Motion, Quality, EffortReport | None]":
        motion, quality, report = regenerate_in_manner(
            source, human, there, style, effort=manner.effort, duration_s=manner.duration_s
        )
        gate = contact_gate(motion, assertions)
        return motion, Quality((*quality.gates, gate), quality.told), report

    stepped, (motion, quality, report) = performed_near(source, human, where, style, act, step)
    return stepped, Performed(motion, quality, names, effort=report)


def _write(
    made: "Sequence[tuple[str, Performed]]", agent: str, output: Path, stepped: "Approach | None"
) -> None:
    """One bundle, or one in a folder each, numbered, where something was prepared."""
    from capar.cli._approaches import write_approach
    from capar.regeneration.captures import capture_of, renamed, write_motion

    for number, (name, done) in enumerate(made, start=1):
        source = done.motion.plan.source
        who = agent if agent != "same" else source.capture.agent.name
        bundle = renamed(capture_of(done.motion, name=name, agent=who), done.names)
        alone = len(made) == 1 and stepped is None
        last = stepped is not None and number == len(made)
        if stepped is not None and last:
            write_approach(stepped, output / f"{number}_steps", who)
        folder = output if alone else output / f"{number + last}_{name}"
        write_motion(done.motion, bundle, folder)


def _answer(prepared: "Prepared", main: "Performed", told: Sequence[str]) -> dict[str, Any]:
    from capar.cli._gates import effort_answer, quality_answer

    answer = {**quality_answer(main.motion, main.quality), **effort_answer(main.effort)}
    stages = [
        {
            "recording": done.stage.way.recording.name,
            "steps": [asdict(step) for step in done.stage.steps],
            **quality_answer(done.motion, done.quality),
        }
        for done in prepared.done
    ]
    plan = {
        "needed": prepared.wanted,
        "lacking": prepared.lacking,
        "impossible": prepared.tried,
        "stages": stages,
    }
    passed = answer["passed"] and all(done.quality.passed for done in prepared.done)
    return {**answer, "passed": passed, "plan": plan, "notes": [*told, *answer["notes"]]}


def _tell(prepared: "Prepared", main: "Performed", stepped: "Approach | None") -> None:
    from capar.cli._approaches import tell_approach
    from capar.cli._gates import tell_quality
    from capar.pipelines.preparing import told

    if not prepared.done and stepped is None:
        typer.echo("plan: nothing has to be prepared")
    for condition in prepared.lacking:
        typer.echo(f"plan: {told(condition)} does not hold yet")
    for why in prepared.tried:
        typer.echo(f"plan: not possible is {why}")
    steps = [(done, step) for done in prepared.done for step in done.stage.steps]
    for number, (done, step) in enumerate(steps, start=1):
        where = ""
        if step.place:
            x, y, _ = step.place
            where = f" to ({x:.2f}, {y:.2f}) m on {step.support!r}"
        name = done.stage.way.recording.name
        typer.echo(
            f"{number:3}. {step.hand} hand: {step.action} {step.thing}{where} (as in {name})"
        )
    for done in prepared.done:
        part, thing = done.stage.way.part, done.stage.steps[0].thing
        as_part = f", {thing!r} in the part of {part!r}" if part != thing else ""
        typer.echo(f"prepared as in {done.stage.way.recording.name}{as_part}:")
        tell_quality(done.motion, done.quality)
    tell_approach(stepped)
    if prepared.done or stepped:
        typer.echo("the action itself:")
    tell_quality(main.motion, main.quality)
    if main.effort:
        typer.echo(main.effort)
