"""Perform a recorded action, or what is asked for, on another body, and round trips."""

from collections.abc import Callable, Iterable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import asdict, replace
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, NamedTuple, Protocol, TypeVar

import typer

from capar.cli.options import Assume, NewBundle, Place, Rules

if TYPE_CHECKING:
    import numpy as np

    from capar.body.human import Human
    from capar.pipelines.preparation import Approach
    from capar.pipelines.recordings import Recording
    from capar.pipelines.spoken_requests import Choice, Performance
    from capar.regeneration.efforts import EffortReport
    from capar.regeneration.motion import Motion
    from capar.regeneration.quality import Gate, Quality
    from capar.regeneration.scenes import Scene
    from capar.regeneration.sources import Source
    from capar.regeneration.styles import Style

    Act = Callable[[Scene], tuple[Motion, Quality, EffortReport | None]]
    from capar.model.capture import Capture
    from capar.pipelines.instantiation import Asked, Instance
    from capar.pipelines.preparation import Performed, Prepared, World
    from capar.pipelines.round_trips import JointTrip, Trip
    from capar.regeneration.efforts import Effort, EffortReport
    from capar.regeneration.forces import ForceKind
    from capar.regeneration.hand_overs import JointMotion
    from capar.regeneration.motion import Motion
    from capar.regeneration.quality import Quality
    from capar.regeneration.roles import Role
    from capar.regeneration.scenes import Scene
    from capar.regeneration.styles import Kind
    from kb import Actionary


def quality_answer(motion: "Motion", quality: "Quality") -> dict[str, Any]:
    """Gates and notes of a motion, for machines."""
    return {
        "passed": quality.passed,
        "gates": gate_rows(quality.gates),
        "told": quality.told,
        "notes": motion.plan.notes,
    }


def gate_rows(gates: "Sequence[Gate]") -> list[dict[str, Any]]:
    """Gates, for machines."""
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


def effort_answer(report: "EffortReport | None") -> dict[str, Any]:
    """The effort of a motion, for machines; nothing where none was asked for."""
    if report is None:
        return {}
    return {
        "effort": {
            "asked": report.asked.values,
            "performed": report.performed.values,
            "measured": report.measured.values,
            "why": report.why,
        }
    }


def tell_quality(motion: "Motion", quality: "Quality") -> None:
    """Print every gate with its limit and where it was worst, and the notes."""
    tell_gates(quality.gates, motion.plan.source.times)
    tell_measures(quality)
    for note in motion.plan.notes:
        typer.echo(f"note: {note}")


def tell_gates(gates: "Sequence[Gate]", times: "Sequence[float] | np.ndarray") -> None:
    """Print gates with their limits and where they were worst."""
    typer.echo("gate               value     limit   unit        passed  worst at")
    for gate in gates:
        sign = ">=" if gate.at_least else "<="
        at = f"{times[gate.frame]:.2f} s" if gate.frame >= 0 else ""
        typer.echo(
            f"{gate.name:16} {gate.value:8.3f}  {sign} {gate.limit:6.2f}  {gate.unit:10}  "
            f"{'yes' if gate.passed else 'NO':6}  {at} {gate.bodies}".rstrip()
        )


def tell_measures(quality: "Quality") -> None:
    """Print what is told and not demanded."""
    for measured in quality.told:
        value = f"{measured.value:.1f} {measured.unit}"
        typer.echo(f"{measured.name}: {value} ({measured.bodies}), not demanded")


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
    from capar.cli.output import print_json
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
    from capar.cli.options import rule_words
    from capar.model.errors import CaparError
    from capar.pipelines.language import vocabulary
    from capar.pipelines.spoken_requests import choices, observed_actions, read_requests
    from capar.pipelines.trials import trial_of
    from capar.regeneration.roles import captured_scene

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
    from capar.cli.options import opened, require_actionary
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

    answer = quality_answer(each.motion, each.quality)
    return {
        "recording": each.choice.recording.name,
        "asked": [" ".join((r.said, *r.objects)) for r in each.choice.requests],
        **answer,
        **effort_answer(each.effort),
        "notes": [*each.notes, *answer["notes"]],
    }


def _tell(each: "Performance") -> None:

    for note in each.notes:
        typer.echo(note)
    tell_quality(each.motion, each.quality)
    if each.effort:
        typer.echo(each.effort)


def performed_near(
    source: "Source", human: "Human", scene: "Scene", style: "Style", act: "Act", step: bool
) -> "tuple[Approach | None, tuple[Motion, Quality, EffortReport | None]]":
    """Perform an action from the given place, or, if steps may be taken, from where they lead.

    Raises:
        PlanError: It is out of reach, and no step helps.
    """
    from capar.pipelines.preparation import approached

    if not step:
        return None, act(scene)

    def both(where: "Scene") -> "tuple[tuple[Motion, EffortReport | None], Quality]":
        motion, quality, report = act(where)
        return (motion, report), quality

    stepped, (motion, report), quality = approached(source, human, scene, style, both)
    return stepped, (motion, quality, report)


def write_approach(stepped: "Approach", folder: Path, agent: str) -> None:
    """Write the capture of steps as a bundle.

    Args:
        stepped: The steps.
        folder: The new folder.
        agent: Name of the performer.
    """
    from capar.regeneration.captures import capture_of_steps, write_steps

    capture = capture_of_steps(stepped.steps, name="steps", agent=agent)
    write_steps(stepped.steps, capture, folder)


def approach_answer(stepped: "Approach | None", passed: bool) -> dict[str, Any]:
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
            "gates": gate_rows(stepped.quality.gates),
        },
    }


def tell_approach(stepped: "Approach | None") -> None:
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
    tell_gates(stepped.quality.gates, stepped.steps.times)


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
    from capar.cli.output import print_json
    from capar.pipelines.instantiation import Knowledge, instantiate
    from capar.pipelines.preparation import opened as open_recording
    from capar.pipelines.preparation import prepare, ways_of

    parts = dict(_part(text) for text in stated)
    with _words(where, needed=is_action(what)) as words:
        known = Knowledge(words.kinds_above, words.abilities)
        recordings = _recordings_instantiation(what, where, words)
        recording, source, notes = _recorded(what, recordings, list(parts), assume)
        if manner.hand:
            from capar.pipelines.round_trips import by_hand

            source = by_hand(source, manner.hand)
        asked, world = _asked_instantiation(what, agent, words, source, scene, parts, step=step)
        instance = instantiate(asked, recording, source, known, _asker())
        prepared = prepare(
            instance, world, known.kinds, lambda: ways_of(recordings, open_recording)
        )
    stepped, main = _performed(instance, prepared.world.scene, manner, step=step)
    stages = [(done.stage.way.recording.name, done) for done in prepared.done]
    made = [*stages, (recording.name, main)]
    if output:
        _write_instantiation(made, agent, output, stepped)
    told = (*notes, *instance.notes)
    if json:
        bound = [asdict(binding) for binding in instance.bindings]
        head = {"action": what, "recording": recording.name, "objects": bound}
        answer = _answer_instantiation(prepared, main, told)
        print_json({**head, **answer, **approach_answer(stepped, answer["passed"])})
        return
    for note in told:
        typer.echo(note)
    _tell_instantiation(prepared, main, stepped)
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
    from capar.cli.options import has_actionary, opened, require_actionary
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


def _recordings_instantiation(
    what: str, where: "Where", words: "Actionary"
) -> "tuple[Recording, ...]":
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
    from capar.pipelines.instantiation import find_action
    from capar.pipelines.recordings import observed_recording
    from capar.pipelines.round_trips import observed_source
    from capar.regeneration.captures import read_completion

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


def _asked_instantiation(
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
    from capar.pipelines.preparation import FARTHEST_M, captured_world, measured_world
    from capar.pipelines.round_trips import SAME, body
    from capar.regeneration.scenes import read_scene

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
    from capar.cli.options import can_ask

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
    from capar.pipelines.preparation import Performed, asserted
    from capar.pipelines.round_trips import by_hand, observed_source
    from capar.regeneration.efforts import regenerate_in_manner
    from capar.regeneration.quality import Quality, contact_gate
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


def _write_instantiation(
    made: "Sequence[tuple[str, Performed]]", agent: str, output: Path, stepped: "Approach | None"
) -> None:
    """One bundle, or one in a folder each, numbered, where something was prepared."""
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


def _answer_instantiation(
    prepared: "Prepared", main: "Performed", told: Sequence[str]
) -> dict[str, Any]:

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


def _tell_instantiation(
    prepared: "Prepared", main: "Performed", stepped: "Approach | None"
) -> None:
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


class Tried(Protocol):
    """A round trip that was made or refused."""

    @property
    def refused(self) -> str:
        """Why it was not performed; empty if it was."""

    @property
    def passed(self) -> bool:
        """Whether everything came out the same, with every gate."""


T = TypeVar("T", bound=Tried)


def tell_trips(trips: Iterable[T], row: Callable[[T], str], *, heading: str, json: bool) -> None:
    """Print each trip when it has been made, and how many passed; or all as JSON."""
    from capar.cli.output import print_json

    made = []
    if not json:
        typer.echo(heading)
    for trip in trips:
        made.append(trip)
        if not json:
            typer.echo(row(trip))
    if json:
        print_json(made)
        return
    done = [trip for trip in made if not trip.refused]
    passed = sum(trip.passed for trip in done)
    typer.echo(f"{len(made)} asked, {len(done)} in reach, {passed} passed")


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
    from capar.cli.output import print_json
    from capar.pipelines.round_trips import bodies, observed_joint_source
    from capar.regeneration.captures import joint_capture_of, write_joint_motion
    from capar.regeneration.hand_overs import regenerate_together
    from capar.regeneration.scenes import read_scenes
    from capar.regeneration.styles import style_kind

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
    performers = {
        name: quality_answer(motion, made.qualities[name]) for name, motion in made.motions.items()
    }
    return {"passed": made.passed, "performers": performers, "gates": gate_rows(made.gates)}


def tell_joint_quality(made: "JointMotion") -> None:
    """Print the gates of every body and between them, and the notes, each once."""
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
    from capar.pipelines.round_trips import (
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
    from capar.cli.output import check_new_folder
    from capar.model.errors import CaparError
    from capar.pipelines.trials import trial_of
    from capar.regeneration.efforts import read_effort
    from capar.regeneration.forces import force_kind
    from capar.regeneration.styles import style_kind

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
    from capar.cli.output import print_json
    from capar.pipelines.round_trips import body, by_hand, observed_source
    from capar.regeneration.captures import capture_of, read_completion, write_motion
    from capar.regeneration.efforts import regenerate_in_manner
    from capar.regeneration.scenes import read_scene
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


HEADING_ROUNDTRIP = "agent  scene  same PAR  contacts  relations  gates  where not"


def roundtrip(
    capture: Annotated[
        str,
        typer.Argument(help="A capture bundle's folder or capture.toml; FOLDER:TAKE for a take."),
    ],
    agents: Annotated[
        str,
        typer.Option(
            help="Who performs, parted by commas: man, woman, child, same. Of several performers "
            "man+child and so on, in their order; one alone is all of them."
        ),
    ] = "man,woman,child",
    scenes: Annotated[
        int, typer.Option(min=0, help="How many scenes to draw; 0 performs in the recorded one.")
    ] = 0,
    seed: Annotated[int, typer.Option(min=0, help="Of the drawn scenes.")] = 0,
    assume: Assume = None,
    json: Annotated[bool, typer.Option("--json", help="Print JSON for machines.")] = False,
) -> None:
    """Observe CAPTURE, perform it on other bodies, observe that, and compare."""
    from capar.pipelines.round_trips import body, observed_source, round_trips
    from capar.pipelines.trials import trial_of
    from capar.regeneration.captures import read_completion

    trial = trial_of(capture)
    if trial.others:
        check_no_others({"--assume": assume})
        casts = [cast.strip() for cast in agents.split(",")]
        tell_joint_trips(trial, casts, scenes=scenes, seed=seed, json=json)
        return
    source = observed_source(trial, read_completion(assume) if assume else None)
    names = tuple(each.strip() for each in agents.split(","))
    for name in names:
        body(name, source)  # a misspelt one is refused before anything is computed
    trips = round_trips(source, names, scenes=scenes, seed=seed)
    tell_trips(trips, _row_roundtrip, heading=HEADING_ROUNDTRIP, json=json)


def _row_roundtrip(trip: "Trip") -> str:
    if trip.refused:
        return f"{trip.agent:6} {trip.scene:5}  not performed: {trip.refused}"
    assert trip.quality is not None
    where = [
        f"{gate.name} {gate.value:.2f} {gate.unit} {gate.bodies}".strip()
        for gate in trip.quality.gates
        if not gate.passed
    ]
    where += [trip.names] if trip.names else []
    cells = (trip.same_par, trip.same_contacts, trip.same_relations, trip.quality.passed)
    words = ["yes" if each else "NO" for each in cells]
    return (
        f"{trip.agent:6} {trip.scene:5}  {words[0]:8}  {words[1]:8}  {words[2]:9}  {words[3]:5}  "
        f"{'; '.join(where)}"
    ).rstrip()
