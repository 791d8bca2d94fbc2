"""Perform a recorded action, or what is asked for, on another body, and round trips."""

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import asdict, replace
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, NamedTuple

import typer

from capar.cli.options import (
    Assume,
    Capture,
    Json,
    NewBundle,
    Place,
    Rules,
    can_ask,
    has_actionary,
    opened,
    require_actionary,
    rule_words,
)
from capar.cli.output import check_new_folder, print_json
from capar.model.errors import CaparError

if TYPE_CHECKING:
    import numpy as np

    from capar.body.human import Human
    from capar.model.capture import Capture as CaptureData
    from capar.pipelines.instantiation import Asked
    from capar.pipelines.preparation import Performed, Prepared, World
    from capar.pipelines.recordings import Recording
    from capar.pipelines.round_trips import JointTrip, Trip
    from capar.pipelines.spoken_requests import Performance
    from capar.regeneration.efforts import Effort, EffortReport
    from capar.regeneration.forces import ForceKind
    from capar.regeneration.hand_overs import JointMotion
    from capar.regeneration.motion import Motion
    from capar.regeneration.quality import Gate, Quality
    from capar.regeneration.roles import Role
    from capar.regeneration.scenes import Scene
    from capar.regeneration.sources import Source
    from capar.regeneration.stepping import Approach
    from capar.regeneration.styles import Kind
    from kb import Actionary

SAME = "same"
TRIP_COLUMNS = "scene  same PAR  contacts  relations  gates  where not"


class _Manner(NamedTuple):
    """How an action is performed."""

    kind: "Kind"
    force: "ForceKind"
    style_of: str | None
    duration_s: float | None
    hand: str | None
    effort: "Effort | None"


class _Where(NamedTuple):
    """Where recordings and words are: one capture, or an Actionary and captures; and the rules."""

    capture: str | None
    recordings: Path | None
    actionary: str | None
    rules: Path | None


class _Output(NamedTuple):
    """Where the performance goes: a new folder, and JSON rather than text."""

    folder: Path | None
    json: bool

    def finish(self, answer: Callable[[], Any], tell: Callable[[], None]) -> None:
        """Print the answer for machines, or text for people and where the files are."""
        if self.json:
            print_json(answer())
            return
        tell()
        if self.folder:
            typer.echo(f"wrote {self.folder}", err=True)


def regenerate(
    capture: Annotated[
        str | None,
        typer.Argument(
            metavar="[CAPTURE|ACTION]",
            help="A capture's folder or capture.toml; FOLDER:TAKE for one of its takes. Or an "
            "action that the Actionary holds, as a whole or as a step of a recording. With --say "
            "it may be left out: the Actionary's recordings are then searched.",
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
            help="Who performs: man, woman, child, or same (the one recorded, the default); for "
            "an ACTION or with --object also an agent of the Actionary whose kind is one of these. "
            "With several performers once for all, once for each in their order, or NAME=child.",
            show_default=False,
        ),
    ] = None,
    things: Annotated[
        list[str] | None,
        typer.Option(
            "--object",
            metavar="PART=THING",
            help="The object of the scene that takes the part of a recorded one; may be repeated. "
            "The other parts are taken by kind, or asked for where several objects fit.",
            show_default=False,
        ),
    ] = None,
    scene: Annotated[
        Path | None,
        typer.Option(
            help="A TOML file that changes the scene: [stance] place, heading_deg, floor_m; "
            "[object.NAME] size, position, turn_deg, raise_m. Or a CAPTURE whose scene it is "
            "done in, as always with --say.",
            show_default=False,
        ),
    ] = None,
    output: NewBundle = None,
    style: Annotated[
        str,
        typer.Option(
            help="What of the recorded motion is kept: path (shape and timing), frame (likewise, "
            "scaled with the path), vel (timing), even (nothing: least jerk)."
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
            "speed) or same (the object's motion; the hand strikes as fast as that takes)."
        ),
    ] = "similar",
    step: Annotated[
        bool | None,
        typer.Option(
            "--step/--no-step",
            help="Where it is out of reach, step to where it can be done; the default for an "
            "ACTION or with --object. Not with --say.",
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
    json: Json = False,
) -> None:
    """Perform a recorded action on another body, and verify it.

    Every frame is verified, and a capture is written with --output. With --say, what the words ask
    for is looked up among the recordings and performed in the scene. An ACTION is performed as its
    recording has it, with the objects that --object states.
    """
    from capar.pipelines.trials import trial_of
    from capar.regeneration.efforts import read_effort
    from capar.regeneration.forces import force_kind
    from capar.regeneration.styles import style_kind

    if output:
        check_new_folder(output)
    agents, out = agent or [SAME], _Output(output, json)
    how = _Manner(
        style_kind(style), force_kind(force), style_of, duration, hand,
        read_effort(effort) if effort is not None else None,
    )  # fmt: skip
    if say is not None:
        for option, given in (("--style-of", style_of), ("--object", things), ("--step", step)):
            if given:
                raise CaparError(f"{option} is of one recorded action; leave it out, or --say")
        where = _Where(capture, recordings, actionary, rules)
        _perform_request(say, _one_body(agents), where, how, scene, out)
        return
    if capture is None:
        raise CaparError("name a CAPTURE, or what to do: --say 'touch the mug' --scene CAPTURE")
    if things or _is_action(capture) or (scene and _is_capture(scene)):
        where = _Where(None, recordings, actionary, rules)
        parts = dict(map(_part, things or []))
        _perform_instance(
            capture, _one_body(agents), where, how, parts, scene, assume, out,
            step=step is not False,
        )  # fmt: skip
        return
    trial = trial_of(capture)
    if trial.others:
        _refuse_for_several(
            {"--style-of": style_of, "--duration": duration, "--hand": hand, "--assume": assume,
             "--effort": effort, "--step": step, "--force": "" if force == "similar" else force}
        )  # fmt: skip
        _perform_jointly(trial, agents, scene, style, out)
        return
    _perform_alone(trial, _one_body(agents), how, scene, assume, out, step=bool(step))


def _refuse_for_several(options: Mapping[str, Any]) -> None:
    """Refuse options that only one performer can have."""
    given = [name for name, value in options.items() if value]
    if given:
        raise CaparError(
            f"{given[0]} is of one performer, and this capture has several; leave it out, or cut "
            "the capture to one agent's sensors"
        )


def _one_body(agents: Sequence[str]) -> str:
    """The body that performs what one was recorded to do."""
    if len(agents) > 1:
        raise CaparError(
            f"{len(agents)} bodies, and one performer was recorded; name one with --agent"
        )
    return agents[0]


def _is_capture(place: str | Path) -> bool:
    """Whether a place is one of a capture, rather than of a file that changes a scene."""
    from capar.pipelines.recordings import BUNDLE

    path = Path(place)
    return path.name == BUNDLE or path.suffix != ".toml"


def _is_action(name: str) -> bool:
    """Whether a word names an action rather than a place in which a capture is."""
    path = Path(name.partition(":")[0])
    return path.name == name and not path.suffix and not path.exists()


def _part(text: str) -> tuple[str, str]:
    part, sign, thing = text.partition("=")
    if not (part and sign and thing):
        raise CaparError(f"--object takes PART=THING, such as mug=red_mug; found {text!r}")
    return part, thing


def _perform_alone(
    trial: "CaptureData",
    who: str,
    how: _Manner,
    scene: Path | None,
    assume: Path | None,
    out: _Output,
    *,
    step: bool,
) -> None:
    """Perform what one performer was recorded to do."""
    from capar.pipelines.round_trips import body, observed_source
    from capar.regeneration.captures import capture_of, read_completion, write_motion
    from capar.regeneration.scenes import read_scene

    source = observed_source(trial, read_completion(assume) if assume else None)
    where = read_scene(scene, source.scene) if scene else source.scene
    stepped, motion, quality, report = _act(source, body(who, source), where, how, step=step)
    if out.folder:
        name = who if who != SAME else source.capture.agent.name
        made = capture_of(motion, name=source.capture.name, agent=name)
        if stepped:
            _write_steps(stepped, out.folder / "1_steps", name)
        last = out.folder / f"2_{source.capture.name}" if stepped else out.folder
        write_motion(motion, made, last)

    def answer() -> dict[str, Any]:
        own = {**quality_answer(motion, quality), **_effort_answer(report)}
        return {**own, **_steps_answer(stepped, own["passed"])}

    def tell() -> None:
        _print_steps(stepped)
        if stepped:
            typer.echo("the action itself:")
        print_quality(motion, quality)
        if report:
            typer.echo(report)

    out.finish(answer, tell)


def _act(
    source: "Source",
    human: "Human",
    where: "Scene",
    how: _Manner,
    *,
    step: bool,
    contacts: bool = False,
) -> "tuple[Approach | None, Motion, Quality, EffortReport | None]":
    """Perform an action from the given place, or, if steps may be taken, from where they lead.

    Args:
        source: What was recorded.
        human: Who performs.
        where: The scene.
        how: The manner.
        step: Whether steps may be taken.
        contacts: Whether contacts as the PARs assert them are a gate.

    Raises:
        PlanError: It is out of reach, and no step helps.
    """
    from capar.pipelines.preparation import asserted
    from capar.pipelines.round_trips import by_hand, observed_source
    from capar.regeneration.efforts import regenerate_in_manner
    from capar.regeneration.quality import Quality, contact_gate
    from capar.regeneration.stepping import approached
    from capar.regeneration.styles import borrowed_style, own_style

    assertions = asserted(source) if contacts else None
    source = by_hand(source, how.hand) if how.hand and not contacts else source
    style = own_style(source, how.kind)
    if how.style_of:
        other = observed_source(how.style_of)
        style = borrowed_style(source, by_hand(other, how.hand) if how.hand else other, how.kind)
    style = replace(style, force=how.force)

    def act(there: "Scene") -> "tuple[tuple[Motion, EffortReport | None], Quality]":
        motion, quality, report = regenerate_in_manner(
            source, human, there, style, effort=how.effort, duration_s=how.duration_s
        )
        if assertions is not None:
            gate = contact_gate(motion, assertions)
            quality = Quality((*quality.gates, gate), quality.told)
        return (motion, report), quality

    if step:
        stepped, (motion, report), quality = approached(source, human, where, style, act)
        return stepped, motion, quality, report
    (motion, report), quality = act(where)
    return None, motion, quality, report


def _write_steps(stepped: "Approach", folder: Path, agent: str) -> None:
    """Write the capture of steps as a bundle."""
    from capar.regeneration.captures import capture_of_steps, write_steps

    capture = capture_of_steps(stepped.steps, name="steps", agent=agent)
    write_steps(stepped.steps, capture, folder)


def _perform_instance(
    what: str,
    agent: str,
    where: _Where,
    how: _Manner,
    parts: dict[str, str],
    scene: Path | None,
    assume: Path | None,
    out: _Output,
    *,
    step: bool,
) -> None:
    """Perform an action or a capture's on objects of a scene, and tell how good it is."""
    from capar.pipelines.instantiation import Knowledge, instantiate
    from capar.pipelines.preparation import Performed, prepare, procedures_of
    from capar.pipelines.preparation import opened as open_recording
    from capar.pipelines.round_trips import by_hand

    with _words(where, needed=_is_action(what)) as words:
        known = Knowledge(words.kinds_above, words.abilities)
        recordings = _stored(what, where, words)
        recording, source, notes = _recorded(what, recordings, list(parts), assume)
        source = by_hand(source, how.hand) if how.hand else source
        asked, world = _asked(what, agent, words, source, scene, parts, step=step)
        instance = instantiate(asked, recording, source, known, _asker())
        prepared = prepare(
            instance, world, known.kinds, lambda: procedures_of(recordings, open_recording)
        )
    source, place, names = instance.placed(prepared.world.scene)
    human = instance.asked.human
    stepped, motion, quality, report = _act(source, human, place, how, step=step, contacts=True)
    main = Performed(motion, quality, names, effort=report)
    stages = [(done.stage.way.recording.name, done) for done in prepared.done]
    if out.folder:
        _write_stages([*stages, (recording.name, main)], agent, out.folder, stepped)
    told = (*notes, *instance.notes)

    def answer() -> dict[str, Any]:
        bound = [asdict(binding) for binding in instance.bindings]
        head = {"action": what, "recording": recording.name, "objects": bound}
        own = _instance_answer(prepared, main, told)
        return {**head, **own, **_steps_answer(stepped, own["passed"])}

    def tell() -> None:
        for note in told:
            typer.echo(note)
        _print_instance(prepared, main, stepped)

    out.finish(answer, tell)


@contextmanager
def _words(where: _Where, *, needed: bool) -> "Iterator[Actionary]":
    """The Actionary; where none is there and none is needed, one that knows only the ontology."""
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


def _stored(what: str, where: _Where, words: "Actionary") -> "tuple[Recording, ...]":
    """What can be performed: the Actionary's recordings whose captures are there."""
    from capar.pipelines.recordings import stored_recordings

    known, lost = stored_recordings(words, where.recordings or Path())
    for name in lost if _is_action(what) or where.recordings else ():
        typer.echo(f"capar: the capture of {name!r} is not in the folder of recordings", err=True)
    return known


def _recorded(
    what: str, known: "Sequence[Recording]", parts: Sequence[str], assume: Path | None
) -> "tuple[Recording, Source, tuple[str, ...]]":
    """The recording that is performed, and notes on its choice."""
    from capar.pipelines.instantiation import find_action
    from capar.pipelines.recordings import observed_recording
    from capar.pipelines.round_trips import observed_source
    from capar.regeneration.captures import read_completion

    completion = read_completion(assume) if assume else None
    if not _is_action(what):
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
    from capar.pipelines.preparation import captured_world, measured_world
    from capar.pipelines.round_trips import body
    from capar.regeneration.scenes import read_scene
    from capar.regeneration.stepping import FARTHEST_M

    who = source.capture.agent.name if agent == SAME else agent
    kinds = words.agent_profile(who)["kind"] if who in words.agents() else ()
    shape = next(iter(kinds), agent) if agent != SAME else agent
    own = scene is None or not _is_capture(scene)
    world = measured_world(source) if own or scene is None else captured_world(scene)
    if scene is not None and own:
        world = replace(world, scene=read_scene(scene, source.scene))
    named = tuple(dict.fromkeys((who, *kinds)))
    steps_m = FARTHEST_M if step else 0.0
    return Asked(what, named, body(shape, source), parts, world.scene, own, steps_m), world


def _asker() -> "Callable[[Role, tuple[str, ...]], str] | None":
    """Asks on a terminal which object takes a part; None where nobody can answer."""

    def ask(role: "Role", fitting: tuple[str, ...]) -> str:
        listed = ", ".join(fitting)
        while True:
            question = f"Which takes the part of {role.name!r} ({role.kind}): {listed}?"
            answer = str(typer.prompt(question, err=True)).strip()
            if answer in fitting:
                return answer
            typer.echo(f"{answer!r} does not fit; name one of {listed}.", err=True)

    return ask if can_ask() else None


def _write_stages(
    made: "Sequence[tuple[str, Performed]]", agent: str, output: Path, stepped: "Approach | None"
) -> None:
    """One bundle, or one in a numbered folder each, where something was prepared."""
    from capar.regeneration.captures import capture_of, renamed, write_motion

    for number, (name, done) in enumerate(made, start=1):
        source = done.motion.plan.source
        who = agent if agent != SAME else source.capture.agent.name
        bundle = renamed(capture_of(done.motion, name=name, agent=who), done.names)
        alone = len(made) == 1 and stepped is None
        last = stepped is not None and number == len(made)
        if stepped is not None and last:
            _write_steps(stepped, output / f"{number}_steps", who)
        write_motion(done.motion, bundle, output if alone else output / f"{number + last}_{name}")


def _instance_answer(
    prepared: "Prepared", main: "Performed", told: Sequence[str]
) -> dict[str, Any]:
    answer = {**quality_answer(main.motion, main.quality), **_effort_answer(main.effort)}
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


def _print_instance(prepared: "Prepared", main: "Performed", stepped: "Approach | None") -> None:
    from capar.pipelines.preparation import told

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
            where = f" to ({step.place[0]:.2f}, {step.place[1]:.2f}) m on {step.support!r}"
        name = done.stage.way.recording.name
        typer.echo(
            f"{number:3}. {step.hand} hand: {step.action} {step.thing}{where} (as in {name})"
        )
    for done in prepared.done:
        part, thing = done.stage.way.part, done.stage.steps[0].thing
        as_part = f", {thing!r} in the part of {part!r}" if part != thing else ""
        typer.echo(f"prepared as in {done.stage.way.recording.name}{as_part}:")
        print_quality(done.motion, done.quality)
    _print_steps(stepped)
    if prepared.done or stepped:
        typer.echo("the action itself:")
    print_quality(main.motion, main.quality)
    if main.effort:
        typer.echo(main.effort)


def _perform_request(
    text: str, agent: str, where: _Where, how: _Manner, scene: Path | None, out: _Output
) -> None:
    """Perform what a text asks for, one action after the other, and tell how good each is."""
    from capar.body.anthropometry import measures_of, ready_made
    from capar.body.human import Human
    from capar.pipelines.language import vocabulary
    from capar.pipelines.spoken_requests import (
        after,
        choices,
        observed_actions,
        perform,
        read_requests,
    )
    from capar.pipelines.trials import trial_of
    from capar.regeneration.roles import captured_scene

    stage = str(scene) if scene else where.capture
    if stage is None:
        raise CaparError("name the scene that it is done in: --scene CAPTURE")
    trial = trial_of(stage)
    place = captured_scene(trial)
    human = Human.of(measures_of(trial.agent) if agent == SAME else ready_made(agent))
    words = vocabulary(rule_words(where.rules, where.actionary))
    known = _recordings(where)
    requests = read_requests(text, words, place, observed_actions(known))
    made: list[Performance] = []
    for choice in choices(requests, known):
        made.append(
            perform(
                choice, place, human, kind=how.kind, duration_s=how.duration_s, hand=how.hand,
                effort=how.effort,
            )
        )  # fmt: skip
        place = after(made[-1], place)
    if out.folder:
        _write_performances(made, agent, out.folder)

    def tell() -> None:
        for each in made:
            for note in each.notes:
                typer.echo(note)
            print_quality(each.motion, each.quality)
            if each.effort:
                typer.echo(each.effort)

    out.finish(lambda: {"performed": list(map(_performance_answer, made))}, tell)


def _recordings(where: _Where) -> "tuple[Recording, ...]":
    """The capture that is named, or the Actionary's recordings whose captures are there."""
    from capar.pipelines.observation import observe
    from capar.pipelines.recordings import observed_recording, stored_recordings
    from kb import Actionary

    if where.capture is not None:
        return (observed_recording(observe(where.capture), Path(where.capture)),)
    require_actionary(where.actionary, observed=True)
    with Actionary.open(opened(where.actionary), read_only=True) as words:
        known, lost = stored_recordings(words, where.recordings or Path())
    for name in lost:
        typer.echo(f"capar: the capture of {name!r} is not in the folder of recordings", err=True)
    return known


def _write_performances(made: "list[Performance]", agent: str, output: Path) -> None:
    """One bundle, or for several actions one in a numbered folder each."""
    from capar.regeneration.captures import capture_of, renamed, write_motion

    for number, each in enumerate(made, start=1):
        source = each.motion.plan.source
        name = agent if agent != SAME else source.capture.agent.name
        made_of = capture_of(each.motion, name=each.choice.recording.name, agent=name)
        folder = output if len(made) == 1 else output / f"{number}_{each.choice.recording.name}"
        write_motion(each.motion, renamed(made_of, each.names), folder)


def _performance_answer(each: "Performance") -> dict[str, Any]:
    answer = quality_answer(each.motion, each.quality)
    return {
        "recording": each.choice.recording.name,
        "asked": [" ".join((r.said, *r.objects)) for r in each.choice.requests],
        **answer,
        **_effort_answer(each.effort),
        "notes": [*each.notes, *answer["notes"]],
    }


def _perform_jointly(
    capture: "CaptureData", agents: Sequence[str], scene: Path | None, style: str, out: _Output
) -> None:
    """Perform a capture of several performers with several bodies, and tell every gate."""
    from capar.pipelines.round_trips import bodies, observed_joint_source
    from capar.regeneration.captures import joint_capture_of, write_joint_motion
    from capar.regeneration.hand_overs import regenerate_together
    from capar.regeneration.scenes import read_scenes
    from capar.regeneration.styles import style_kind

    source = observed_joint_source(capture)
    scenes = {name: one.scene for name, one in source.sources.items()}
    humans = bodies(agents, source)
    where = read_scenes(scene, scenes) if scene else scenes
    made = regenerate_together(source, humans, where, style_kind(style))
    if out.folder:
        again = joint_capture_of(made, name=source.capture.name)
        write_joint_motion(made, again, out.folder)

    def answer() -> dict[str, Any]:
        performers = {
            name: quality_answer(motion, made.qualities[name])
            for name, motion in made.motions.items()
        }
        return {"passed": made.passed, "performers": performers, "gates": _gate_rows(made.gates)}

    out.finish(answer, lambda: _print_joint_quality(made))


def _print_joint_quality(made: "JointMotion") -> None:
    """Print the gates of every body and between them, and the notes, each once."""
    notes: dict[str, None] = {}
    for name, motion in made.motions.items():
        typer.echo(f"{name}:")
        _print_gates(made.qualities[name].gates, motion.plan.source.times)
        _print_measures(made.qualities[name])
        notes |= dict.fromkeys(
            note if note in notes or not note.startswith("the ") else f"{name}: {note}"
            for note in motion.plan.notes
        )
    typer.echo("together:")
    _print_gates(made.gates, motion.plan.source.times)
    for note in notes:
        typer.echo(f"note: {note}")


def quality_answer(motion: "Motion", quality: "Quality") -> dict[str, Any]:
    """Gates and notes of a motion, for machines."""
    return {
        "passed": quality.passed,
        "gates": _gate_rows(quality.gates),
        "told": quality.told,
        "notes": motion.plan.notes,
    }


def _gate_rows(gates: "Sequence[Gate]") -> list[dict[str, Any]]:
    return [
        {
            "name": gate.name,
            "value": round(gate.value, 4),
            "limit": gate.limit,
            "unit": gate.unit,
            "passed": bool(gate.passed),
            "frame": gate.frame,
            "bodies": gate.bodies,
        }
        for gate in gates
    ]


def _effort_answer(report: "EffortReport | None") -> dict[str, Any]:
    """The effort of a motion, for machines; nothing where none was asked for."""
    if report is None:
        return {}
    return {
        "effort": {
            "asked": report.asked.values,
            "performed": report.performed.values,
            "why": report.why,
        }
    }


def _steps_answer(stepped: "Approach | None", passed: bool) -> dict[str, Any]:
    """Steps for machines; nothing where none were needed."""
    if stepped is None:
        return {}
    return {
        "passed": passed and stepped.quality.passed,
        "steps": {
            "why": stepped.why,
            "ahead_m": stepped.ahead_m,
            "left_m": stepped.aside_m,
            "strides": [{"foot": s.side, "by_m": s.by} for s in stepped.steps.strides],
            "impossible": stepped.tried,
            "gates": _gate_rows(stepped.quality.gates),
        },
    }


def print_quality(motion: "Motion", quality: "Quality") -> None:
    """Print every gate with its limit and where it was worst, and the notes."""
    _print_gates(quality.gates, motion.plan.source.times)
    _print_measures(quality)
    for note in motion.plan.notes:
        typer.echo(f"note: {note}")


def _print_gates(gates: "Sequence[Gate]", times: "Sequence[float] | np.ndarray") -> None:
    typer.echo("gate               value     limit   unit        passed  worst at")
    for gate in gates:
        sign = ">=" if gate.at_least else "<="
        at = f"{times[gate.frame]:.2f} s" if gate.frame >= 0 else ""
        typer.echo(
            f"{gate.name:16} {gate.value:8.3f}  {sign} {gate.limit:6.2f}  {gate.unit:10}  "
            f"{'yes' if gate.passed else 'NO':6}  {at} {gate.bodies}".rstrip()
        )


def _print_measures(quality: "Quality") -> None:
    for measured in quality.told:
        value = f"{measured.value:.1f} {measured.unit}"
        typer.echo(f"{measured.name}: {value} ({measured.bodies}), not demanded")


def _print_steps(stepped: "Approach | None") -> None:
    """Print the steps that were needed, if any, and their gates."""
    if stepped is None:
        return
    typer.echo(f"plan: from the given place {stepped.why}")
    for why in stepped.tried:
        typer.echo(f"plan: not possible is {why}")
    for number, stride in enumerate(stepped.steps.strides, start=1):
        x, y = stride.by
        typer.echo(f"{number:3}. {stride.side} foot: Step by ({x:+.2f}, {y:+.2f}) m")
    typer.echo("the steps:")
    _print_gates(stepped.quality.gates, stepped.steps.times)


def roundtrip(
    capture: Capture,
    agents: Annotated[
        str,
        typer.Option(
            "--agents",
            "--agent",
            help="Who performs, separated by commas: man, woman, child, same. With several "
            "performers man+child and so on, in their order; one alone is all of them.",
        ),
    ] = "man,woman,child",
    scenes: Annotated[
        int, typer.Option(min=0, help="How many scenes to draw; 0 performs in the recorded one.")
    ] = 0,
    seed: Annotated[int, typer.Option(min=0, help="Of the drawn scenes.")] = 0,
    assume: Assume = None,
    json: Json = False,
) -> None:
    """Observe, perform on other bodies, observe that, and compare."""
    from capar.pipelines.round_trips import (
        bodies,
        body,
        joint_round_trips,
        observed_joint_source,
        observed_source,
        round_trips,
    )
    from capar.pipelines.trials import trial_of
    from capar.regeneration.captures import read_completion

    trial = trial_of(capture)
    names = tuple(each.strip() for each in agents.split(","))
    trips: Iterable[Trip | JointTrip]
    if trial.others:
        _refuse_for_several({"--assume": assume})
        joint = observed_joint_source(trial)
        for cast in names:
            bodies(cast.split("+"), joint)  # a misspelt one is refused before anything is computed
        trips, width = joint_round_trips(joint, names, scenes=scenes, seed=seed), 12
    else:
        source = observed_source(trial, read_completion(assume) if assume else None)
        for name in names:
            body(name, source)
        trips, width = round_trips(source, names, scenes=scenes, seed=seed), 6
    made = []
    if not json:
        typer.echo(f"{'agents' if trial.others else 'agent':{width}} {TRIP_COLUMNS}")
    for trip in trips:
        made.append(trip)
        if not json:
            typer.echo(_trip_row(trip, width))
    if json:
        print_json(made)
        return
    done = [trip for trip in made if not trip.refused]
    passed = sum(trip.passed for trip in done)
    typer.echo(f"{len(made)} asked, {len(done)} in reach, {passed} passed")


def _trip_row(trip: "Trip | JointTrip", width: int) -> str:
    from capar.pipelines.round_trips import JointTrip

    who = trip.agents if isinstance(trip, JointTrip) else trip.agent
    if trip.refused:
        return f"{who:{width}} {trip.scene:5}  not performed: {trip.refused}"
    if isinstance(trip, JointTrip):
        failed = list(trip.failed)
    else:
        assert trip.quality is not None
        failed = [
            f"{gate.name} {gate.value:.2f} {gate.unit} {gate.bodies}".strip()
            for gate in trip.quality.gates
            if not gate.passed
        ]
    cells = (trip.same_par, trip.same_contacts, trip.same_relations, not failed)
    words = ["yes" if each else "NO" for each in cells]
    where = "; ".join([*failed, *([trip.names] if trip.names else [])])
    return (
        f"{who:{width}} {trip.scene:5}  {words[0]:8}  {words[1]:8}  {words[2]:9}  {words[3]:5}  "
        f"{where}"
    ).rstrip()
