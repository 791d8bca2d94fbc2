"""Perform a recorded action, or what is asked for, on another body, and round trips."""

from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import asdict, replace
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, NamedTuple

import typer
from typer import Argument, Option

from capar.cli import options
from capar.cli.output import answer, check_new_folder, print_json
from capar.model.errors import CaparError

if TYPE_CHECKING:
    from capar.body.human import Human
    from capar.model.capture import Capture as CaptureData
    from capar.pipelines.action_binding import Asked
    from capar.pipelines.preparation import World
    from capar.pipelines.recordings import Performed, Recording
    from capar.pipelines.round_trips import Trip
    from capar.regeneration.efforts import Effort
    from capar.regeneration.forces import ForceKind
    from capar.regeneration.motion import Motion
    from capar.regeneration.quality import Gate, Quality
    from capar.regeneration.roles import Role
    from capar.regeneration.scenes import Scene
    from capar.regeneration.sources import Source
    from capar.regeneration.stepping import Approach
    from capar.regeneration.styles import Kind
    from kb import Actionary

SAME = "same"
GATES_FAILED = 3  # The exit code of a performance that was written although a gate failed.
TRIP_COLUMNS = "scene  same PAR  contacts  relations  gates  where not"


class _Task(NamedTuple):
    """What the options of `capar regenerate` say."""

    what: str | None
    """The capture or action."""

    agents: Sequence[str]
    parts: Mapping[str, str]
    scene: Path | None
    folder: Path | None
    kind: "Kind"
    style_of: str | None
    duration_s: float | None
    hand: str | None
    effort: "Effort | None"
    force: "ForceKind"
    step: bool
    recordings: Path | None
    assume: Path | None
    actionary: str | None
    rules: Path | None
    json: bool

    @property
    def agent(self) -> str:
        """The body that performs what one was recorded to do."""
        if len(self.agents) > 1:
            raise CaparError(
                f"{len(self.agents)} bodies, and one performer was recorded; name one with --agent"
            )
        return self.agents[0]

    def finish(self, value: dict[str, Any]) -> None:
        """Print the answer for machines, or as text and where the files are.

        Raises:
            Exit: A gate failed.
        """
        answer(value, json=self.json)
        if self.folder and not self.json:
            typer.echo(f"wrote {self.folder}", err=True)
        if not all(each["passed"] for each in value.get("performed", [value])):
            raise typer.Exit(GATES_FAILED)


def regenerate(
    capture: Annotated[
        str | None,
        Argument(
            metavar="[CAPTURE|ACTION]",
            help="A capture, or an action that the Actionary holds as a whole or as a step. With "
            "--say it may be left out: the Actionary's recordings are then searched.",
        ),
    ] = None,
    say: Annotated[str | None, Option(metavar="TEXT", help="What to do, in words.")] = None,
    agent: Annotated[
        list[str] | None,
        Option(
            help="man, woman, child, or same (as recorded, the default); for an ACTION or with "
            "--object also an agent of the Actionary. For several performers, once for all, "
            "once for each, or NAME=child."
        ),
    ] = None,
    things: Annotated[
        list[str] | None,
        Option(
            "--object",
            metavar="PART=THING",
            help="The scene's object in the part of a recorded one; may be repeated. The other "
            "parts are taken by kind, or asked for.",
        ),
    ] = None,
    scene: Annotated[
        Path | None,
        Option(
            help="A TOML file: [stance] place, heading_deg, floor_m; [object.NAME] size, position, "
            "turn_deg, raise_m. Or a CAPTURE in whose scene it is done, as always with --say."
        ),
    ] = None,
    output: options.NewBundle = None,
    style: Annotated[
        str,
        Option(
            help="What is kept: path (shape, timing), frame (scaled too), vel (timing) or even."
        ),
    ] = "path",
    style_of: Annotated[str | None, Option(help="A capture whose style is taken.")] = None,
    duration: Annotated[float | None, Option(help="How long it takes [s].", min=0.1)] = None,
    hand: Annotated[str | None, Option(help="Which hand does it: right or left.")] = None,
    effort: Annotated[
        str | None,
        Option(
            metavar="NAME=VALUE,...",
            help="The manner, from -1 to 1: time (sustained to sudden), weight (light to strong), "
            "space (indirect to direct), flow (free to bound); or by pole: sudden=0.6,light=0.3.",
        ),
    ] = None,
    force: Annotated[
        str,
        Option(help="Of a blow or throw: similar (in proportion) or same (the object's motion)."),
    ] = "similar",
    step: Annotated[
        bool | None,
        Option(
            "--step/--no-step",
            help="Step to what is out of reach: the default for an ACTION or with --object.",
        ),
    ] = None,
    recordings: Annotated[
        Path | None, Option(metavar="FOLDER", help="Where the Actionary's captures are; else here.")
    ] = None,
    assume: options.Assume = None,
    actionary: options.Place = None,
    rules: options.Rules = None,
    json: options.Json = False,
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
    in_scene = bool(scene and _is_capture(scene))
    instance = bool(things) or in_scene or (capture is not None and _is_action(capture))
    task = _Task(
        capture, agent or [SAME], dict(map(_part, things or [])), scene, output, style_kind(style),
        style_of, duration, hand, read_effort(effort) if effort is not None else None,
        force_kind(force), instance if step is None else step, recordings, assume, actionary,
        rules, json,
    )  # fmt: skip
    if say is not None:
        for option, given in (("--style-of", style_of), ("--object", things), ("--step", step)):
            if given:
                raise CaparError(f"{option} is of one recorded action; leave it out, or --say")
        _perform_request(task, say)
    elif capture is None:
        raise CaparError("name a CAPTURE, or what to do: --say 'touch the mug' --scene CAPTURE")
    elif instance:
        _perform_instance(task, capture)
    elif (trial := trial_of(capture)).others:
        _refuse_for_several(
            {"--style-of": style_of, "--duration": duration, "--hand": hand, "--assume": assume,
             "--effort": effort, "--step": step, "--force": "" if force == "similar" else force}
        )  # fmt: skip
        _perform_jointly(task, trial)
    else:
        _perform_alone(task, trial)


def _refuse_for_several(options: Mapping[str, Any]) -> None:
    """Refuse options that only one performer can have."""
    given = [name for name, value in options.items() if value]
    if given:
        raise CaparError(
            f"{given[0]} is of one performer, and this capture has several; leave it out, or cut "
            "the capture to one agent's sensors"
        )


def _is_capture(place: str | Path) -> bool:
    """Whether a place is one of a capture, rather than of a file that changes a scene."""
    from capar.pipelines.recordings import BUNDLE

    path = Path(place)
    return path.name == BUNDLE or path.suffix != ".toml"


def _is_action(name: str) -> bool:
    """Whether a word names an action rather than a place in which a capture is."""
    path = Path(name.rpartition(":")[0] or name)
    return "/" not in str(path) and not path.suffix and not path.exists()


def _part(text: str) -> tuple[str, str]:
    part, sign, thing = text.partition("=")
    if not (part and sign and thing):
        raise CaparError(f"--object takes PART=THING, such as mug=red_mug; found {text!r}")
    return part, thing


def _perform_alone(task: _Task, trial: "CaptureData") -> None:
    """Perform what one performer was recorded to do."""
    from capar.pipelines.round_trips import body, observed_source
    from capar.regeneration.scenes import read_scene

    source = observed_source(trial, task.assume)
    where = read_scene(task.scene, source.scene) if task.scene else source.scene
    stepped, done = _act(task, source, body(task.agent, source), where)
    _write(task, [(source.capture.name, done)], stepped)
    task.finish(_value(done) | _steps_value(stepped, passed=done.quality.passed))


def _act(
    task: _Task,
    source: "Source",
    human: "Human",
    where: "Scene",
    names: Mapping[str, str] | None = None,
) -> "tuple[Approach | None, Performed]":
    """Perform an action as the options say.

    Raises:
        PlanError: It is out of reach, and no step helps.
    """
    from capar.pipelines.performance import Manner, perform_recorded

    manner = Manner(
        task.kind, task.style_of or "", task.duration_s, task.hand or "", task.effort, task.force,
        task.step,
    )  # fmt: skip
    return perform_recorded(source, human, where, manner, names)


def _perform_instance(task: _Task, what: str) -> None:
    """Perform an action or a capture's on objects of a scene, and say how good it is."""
    from capar.pipelines.action_binding import instantiate
    from capar.pipelines.preparation import prepare, procedures_of
    from capar.pipelines.round_trips import by_hand

    with _words(task, needed=_is_action(what)) as words:
        recordings = _stored(words, task, needed=_is_action(what))
        recording, source, notes = _recorded(task, what, recordings)
        source = by_hand(source, task.hand) if task.hand else source
        asked, world = _asked(task, what, words, source)
        instance = instantiate(
            asked, recording, source, words.kinds_above, words.abilities, _asker()
        )
        prepared = prepare(instance, world, words.kinds_above, lambda: procedures_of(recordings))
    source, place, names = instance.placed(prepared.world.scene)
    stepped, main = _act(task, source, instance.asked.human, place, names)
    stages = [(done.stage.way.recording.name, done) for done in prepared.done]
    _write(task, [*stages, (recording.name, main)], stepped)
    passed = main.quality.passed and all(done.quality.passed for done in prepared.done)
    value = {
        "action": what,
        "recording": recording.name,
        "objects": [asdict(binding) for binding in instance.bindings],
        "plan": {
            "needed": prepared.wanted,
            "lacking": prepared.lacking,
            "impossible": prepared.tried,
            "stages": [
                {
                    "recording": done.stage.way.recording.name,
                    "steps": [asdict(step) for step in done.stage.steps],
                    **quality_value(done.motion, done.quality),
                }
                for done in prepared.done
            ],
        },
        **_value(main, (*notes, *instance.notes)),
        "passed": passed,
        **_steps_value(stepped, passed=passed),
    }
    task.finish(value)


@contextmanager
def _words(task: _Task, *, needed: bool) -> "Iterator[Actionary]":
    """The Actionary; where none is there and none is needed, one that knows only the ontology."""
    from kb import Actionary

    if needed:
        options.require_actionary(task.actionary, observed=True)
    place = options.opened(task.actionary)
    there = needed or options.has_actionary(place, named=task.actionary)
    with Actionary.open(place, read_only=True) if there else Actionary.in_memory() as words:
        yield words


def _stored(words: "Actionary", task: _Task, *, needed: bool) -> "tuple[Recording, ...]":
    """What can be performed: the Actionary's recordings whose captures are there."""
    from capar.pipelines.recordings import stored_recordings

    known, lost = stored_recordings(words, task.recordings or Path())
    for name in lost if needed or task.recordings else ():
        typer.echo(f"capar: the capture of {name!r} is not in the folder of recordings", err=True)
    return known


def _recorded(
    task: _Task, what: str, known: "Sequence[Recording]"
) -> "tuple[Recording, Source, tuple[str, ...]]":
    """The recording that is performed, and notes on its choice."""
    from capar.pipelines.action_binding import find_action
    from capar.pipelines.recordings import observed_recording
    from capar.pipelines.round_trips import observed_source

    if not _is_action(what):
        source = observed_source(what, task.assume)
        return observed_recording(source.observation, Path(what)), source, ()
    found, others = find_action(what, known, task.parts)
    notes = [f"{what}: performed as in recording {found.name!r}"]
    if others:
        notes.append(
            f"{', '.join(others)} would do as well; the one with the stated parts is taken, "
            "then the one with the fewest steps, then the first by name"
        )
    return found, observed_source(found.capture, task.assume), tuple(notes)


def _asked(task: _Task, what: str, words: "Actionary", source: "Source") -> "tuple[Asked, World]":
    """What is asked for, and the world in which it is, as measured."""
    from capar.pipelines.action_binding import Asked
    from capar.pipelines.preparation import captured_world, measured_world
    from capar.pipelines.round_trips import body
    from capar.regeneration.scenes import read_scene
    from capar.regeneration.stepping import FARTHEST_M

    agent, scene = task.agent, task.scene
    who = source.capture.agent.name if agent == SAME else agent
    kinds = words.agent_profile(who)["kind"] if who in words.agents() else ()
    shape = next(iter(kinds), agent) if agent != SAME else agent
    own = scene is None or not _is_capture(scene)
    world = measured_world(source) if own or scene is None else captured_world(scene)
    if scene is not None and own:
        world = replace(world, scene=read_scene(scene, source.scene))
    named = tuple(dict.fromkeys((who, *kinds)))
    steps_m, human = FARTHEST_M if task.step else 0.0, body(shape, source)
    return Asked(what, named, human, task.parts, world.scene, own, steps_m), world


def _asker() -> "Callable[[Role, tuple[str, ...]], str] | None":
    """Asks on a terminal which object takes a part; None where nobody can answer."""

    def ask(role: "Role", fitting: tuple[str, ...]) -> str:
        listed = ", ".join(fitting)
        while True:
            question = f"Which takes the part of {role.name!r} ({role.kind}): {listed}?"
            given = str(typer.prompt(question, err=True)).strip()
            if given in fitting:
                return given
            typer.echo(f"{given!r} does not fit; name one of {listed}.", err=True)

    return ask if options.can_ask() else None


def _write(
    task: _Task, made: "Sequence[tuple[str, Performed]]", stepped: "Approach | None" = None
) -> None:
    """One bundle; where several were performed, one in a numbered folder each."""
    from capar.regeneration.captures import (
        capture_of,
        capture_of_steps,
        renamed,
        write_motion,
        write_steps,
    )

    folder, agent = task.folder, task.agent
    for number, (name, done) in enumerate(made, start=1):
        if folder is None:
            break
        who = agent if agent != SAME else done.motion.plan.source.capture.agent.name
        bundle = renamed(capture_of(done.motion, name=name, agent=who), done.names)
        last = stepped is not None and number == len(made)
        if stepped is not None and last:
            walked = capture_of_steps(stepped.steps, name="steps", agent=who)
            write_steps(stepped.steps, walked, folder / f"{number}_steps")
        alone = len(made) == 1 and stepped is None
        numbered = f"{number + last}_{name.replace(':', '_')}"
        write_motion(done.motion, bundle, folder if alone else folder / numbered)


def _perform_request(task: _Task, text: str) -> None:
    """Perform what a text asks for, one action after the other, and say how good each is."""
    from capar.body.anthropometry import measures_of, ready_made
    from capar.body.human import Human
    from capar.pipelines.language import vocabulary
    from capar.pipelines.recordings import observed_actions
    from capar.pipelines.spoken_requests import Performance, after, choices, perform, read_requests
    from capar.pipelines.trials import trial_of
    from capar.regeneration.sources import captured_scene

    stage = task.scene or task.what
    if stage is None:
        raise CaparError("name the scene that it is done in: --scene CAPTURE")
    trial = trial_of(stage)
    place = captured_scene(trial)
    human = Human.of(measures_of(trial.agent) if task.agent == SAME else ready_made(task.agent))
    words = vocabulary(options.rule_words(task.rules, task.actionary))
    known = _recordings(task)
    requests = read_requests(text, words, place, observed_actions(known))
    made: list[Performance] = []
    for choice in choices(requests, known):
        made.append(
            perform(
                choice, place, human, kind=task.kind, duration_s=task.duration_s, hand=task.hand,
                effort=task.effort,
            )
        )  # fmt: skip
        place = after(made[-1], place)
    _write(task, [(each.choice.recording.name, each) for each in made])
    values = [
        {
            "recording": each.choice.recording.name,
            "asked": [str(request) for request in each.choice.requests],
            **_value(each, each.notes),
        }
        for each in made
    ]
    task.finish({"performed": values})


def _recordings(task: _Task) -> "tuple[Recording, ...]":
    """The capture that is named, or the Actionary's recordings whose captures are there."""
    from capar.pipelines.observation import observe
    from capar.pipelines.recordings import observed_recording

    if task.what is not None:
        return (observed_recording(observe(task.what), Path(task.what)),)
    with _words(task, needed=True) as words:
        return _stored(words, task, needed=True)


def _perform_jointly(task: _Task, capture: "CaptureData") -> None:
    """Perform a capture of several performers with several bodies, with every gate."""
    from capar.pipelines.round_trips import bodies, observed_joint_source
    from capar.regeneration.captures import joint_capture_of, write_joint_motion
    from capar.regeneration.hand_overs import regenerate_together
    from capar.regeneration.scenes import read_scenes

    source = observed_joint_source(capture)
    scenes = {name: one.scene for name, one in source.sources.items()}
    humans = bodies(task.agents, source)
    where = read_scenes(task.scene, scenes) if task.scene else scenes
    made = regenerate_together(source, humans, where, task.kind)
    if task.folder:
        again = joint_capture_of(made, name=source.capture.name)
        write_joint_motion(made, again, task.folder)
    performers = {
        name: quality_value(motion, made.qualities[name]) for name, motion in made.motions.items()
    }
    gates = _gates_value(made.gates, next(iter(made.motions.values())).plan.source.times)
    value = {"passed": made.passed, "performers": performers, "gates": gates}
    task.finish(value)


def quality_value(motion: "Motion", quality: "Quality") -> dict[str, Any]:
    """Gates, what else was measured, and notes of a motion."""
    return {
        "passed": quality.passed,
        "gates": _gates_value(quality.gates, motion.plan.source.times),
        "told": [asdict(measured) for measured in quality.told],
        "notes": motion.plan.notes,
    }


def _gates_value(gates: "Sequence[Gate]", times: Any) -> list[dict[str, Any]]:
    """Gates, each with where it was worst."""
    return [
        {
            "name": gate.name,
            "value": round(gate.value, 4),
            "demanded": ">=" if gate.at_least else "<=",
            "limit": gate.limit,
            "unit": gate.unit,
            "passed": bool(gate.passed),
            "at_s": round(float(times[gate.frame]), 3) if gate.frame >= 0 else None,
            "frame": gate.frame,
            "bodies": gate.bodies,
        }
        for gate in gates
    ]


def _value(done: "Performed", notes: Sequence[str] = ()) -> dict[str, Any]:
    """A performance for machines, with its effort where one was asked for."""
    value, effort = quality_value(done.motion, done.quality), done.effort
    if effort is not None:
        levels = {"asked": effort.asked.values, "performed": effort.performed.values}
        value["effort"] = {**levels, "why": effort.why}
    return {**value, "notes": [*notes, *value["notes"]]}


def _steps_value(stepped: "Approach | None", *, passed: bool) -> dict[str, Any]:
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
            "gates": _gates_value(stepped.quality.gates, stepped.steps.times),
        },
    }


def roundtrip(
    capture: options.Capture,
    agents: Annotated[
        str,
        Option(
            "--agents",
            "--agent",
            help="man, woman, child, same; of several performers man+child, in their order.",
        ),
    ] = "man,woman,child",
    scenes: Annotated[int, Option(min=0, help="Scenes to draw; 0 for the recorded one.")] = 0,
    seed: Annotated[int, Option(min=0, help="Of the drawn scenes.")] = 0,
    assume: options.Assume = None,
    json: options.Json = False,
) -> None:
    """Observe, perform on other bodies, observe that, and compare."""
    from capar.pipelines.round_trips import (
        joint_round_trips,
        observed_joint_source,
        observed_source,
        round_trips,
    )
    from capar.pipelines.trials import trial_of

    trial = trial_of(capture)
    names = tuple(each.strip() for each in agents.split(","))
    if trial.others:
        _refuse_for_several({"--assume": assume})
        joint = observed_joint_source(trial)
        trips, width = joint_round_trips(joint, names, scenes=scenes, seed=seed), 12
    else:
        source = observed_source(trial, assume)
        trips, width = round_trips(source, names, scenes=scenes, seed=seed), 6
    made: list[Trip] = []
    if not json:
        typer.echo(f"{'agents' if trial.others else 'agent':{width}} {TRIP_COLUMNS}")
    for trip in trips:
        made.append(trip)
        if not json:
            typer.echo(_trip_row(trip, width))
    if json:
        print_json([each.row() for each in made])
        return
    done = [trip for trip in made if not trip.refused]
    passed = sum(trip.passed for trip in done)
    typer.echo(f"{len(made)} asked, {len(done)} in reach, {passed} passed")


def _trip_row(trip: "Trip", width: int) -> str:
    if trip.refused:
        return f"{trip.agent:{width}} {trip.scene:5}  not performed: {trip.refused}"
    cells = (trip.same_par, trip.same_contacts, trip.same_relations, not trip.failed)
    words = ["yes" if each else "NO" for each in cells]
    where = "; ".join([*trip.failed, *([trip.names] if trip.names else [])])
    return (
        f"{trip.agent:{width}} {trip.scene:5}  {words[0]:8}  {words[1]:8}  {words[2]:9}  "
        f"{words[3]:5}  {where}"
    ).rstrip()
