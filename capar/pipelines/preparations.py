"""Performing what prepares an action, each stage checked by geometry before the next."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path

from capar.body.human import Human
from capar.model.capture import Capture
from capar.model.facts import Touching as Touch
from capar.model.observation import Observation
from capar.pipelines.instantiation import Instance
from capar.pipelines.observation import observe
from capar.pipelines.preparation_plans import Failed, Stage, shortest, unmet, why_unmet
from capar.pipelines.preparing import Condition, Touching, World, problem_of, told
from capar.pipelines.trials import trial_of
from capar.pipelines.ways import Way, asserted
from capar.regeneration.bindings import Kinds, ends_on
from capar.regeneration.captures import scene_after
from capar.regeneration.casting import captured_scene, cast, own_names, with_only
from capar.regeneration.contact_tables import (
    TOUCHES_M,
    Asserted,
    Contact,
    Measuring,
    contact_gate,
)
from capar.regeneration.errors import PlanError
from capar.regeneration.manner import EffortReport
from capar.regeneration.motions import Motion
from capar.regeneration.planning import is_possible
from capar.regeneration.quality import Quality
from capar.regeneration.regenerating import regenerate
from capar.regeneration.scenes import Scene
from capar.regeneration.sources import Source

MOST_TRIES = 10
"""So many stages are found impossible at most before the action is refused [1]."""


@dataclass(frozen=True, eq=False)
class Performed:
    """A motion, and how good it is."""

    motion: Motion
    quality: Quality
    names: dict[str, str]
    """The scene's names of the things by those that the motion has."""

    effort: EffortReport | None = field(default=None, kw_only=True)
    """With which manner it was performed, where one was asked for."""


@dataclass(frozen=True, eq=False)
class Done(Performed):
    """A stage of a plan as it was performed."""

    stage: Stage


@dataclass(frozen=True, eq=False)
class Prepared:
    """A world that has what an action needs."""

    wanted: tuple[Condition, ...]
    lacking: tuple[Condition, ...]
    """What it did not have at the start."""

    done: tuple[Done, ...]
    world: World
    tried: tuple[str, ...]
    """What was planned first and found impossible."""


class StageError(PlanError):
    """A stage of a plan that cannot be performed well.

    Attributes:
        failed: What is ruled out by that.
    """

    def __init__(self, stage: Stage, why: str) -> None:
        self.failed = stage.failed
        first, place = stage.steps[0], stage.goal
        where = f" to {place.support!r}" if place else ""
        super().__init__(
            f"{first.thing!r}{where} by the {first.hand} hand as in {first.recording!r}: {why}"
        )


def measured_world(source: Source) -> World:
    """The scene of a recording as it begins, with what its hands touch then.

    Args:
        source: The recording.
    """
    return _world(source.capture, source.observation, source.scene)


def captured_world(place: Capture | Path | str) -> World:
    """The scene of a capture as it begins, with what the hands touch then.

    Args:
        place: The capture, or where it is described.

    Raises:
        CaparError: It has a fault, no sensor of the head, or a thing without a shape.
    """
    trial = trial_of(place)
    return _world(trial, observe(trial), captured_scene(trial))


def _world(capture: Capture, observation: Observation, scene: Scene) -> World:
    sides = {s.name: s.side for s in capture.acting if s.end_effector == "hand"}
    facts = (fact for fact in observation.facts if isinstance(fact, Touch))
    pairs = ((sides.get(f.body, ""), f.other) for f in facts if f.first == 0)
    held = {(side, other) for side, other in pairs if side and other in scene.things}
    return World(scene, frozenset(held))


def prepare(
    instance: Instance, world: World, kinds: Kinds, ways: Callable[[], tuple[Way, ...]]
) -> Prepared:
    """Make true what an action needs, by the shortest plan that can be performed well.

    Args:
        instance: The action.
        world: As it is measured.
        kinds: The hierarchy of kinds.
        ways: Opens the recordings of which a plan can be made; asked only if one is needed.

    Raises:
        PlanError: No plan makes it true; the message says what does not hold and what would help.
    """
    problem = problem_of(instance, world, kinds)
    lacking = unmet(problem)
    if not lacking:
        return Prepared(problem.wanted, (), (), world, ())
    known, failed, tried = ways(), list[Failed](), list[str]()
    while len(tried) < MOST_TRIES:
        stages, left = shortest(problem, known, failed)
        if left:
            raise PlanError(_refusal(why_unmet(problem, left, known), tried))
        try:
            done, after = _performed(stages, world, instance.asked.human)
        except StageError as error:
            failed.append(error.failed)
            tried.append(str(error))
            continue
        still = unmet(problem_of(instance, after, kinds))
        if still:
            said = ", ".join(told(condition) for condition in still)
            raise PlanError(f"by the plan {said} holds, and not by geometry, after all its steps")
        return Prepared(problem.wanted, lacking, done, after, tuple(tried))
    raise PlanError(_refusal(why_unmet(problem, lacking, known), tried))


def _refusal(why: str, tried: Sequence[str]) -> str:
    return f"{why}; not possible were: {'; '.join(tried)}" if tried else why


def _performed(
    stages: Sequence[Stage], world: World, human: Human
) -> tuple[tuple[Done, ...], World]:
    """All stages in turn; each begins in the world that the one before leaves, as measured."""
    made: list[Done] = []
    for stage in stages:
        _check_before(stage, world)
        made.append(_stage(stage, world, human))
        world = _after(made[-1], world)
    return tuple(made), world


def _check_before(stage: Stage, world: World) -> None:
    """What the first step needs holds by geometry."""
    step = stage.steps[0]
    relations = stage.way.relations(step.number)
    touches = (step.hand, step.thing) in world.touching
    if relations["touch"][0] != str(int(touches)):
        verb = "does not touch" if not touches else "touches"
        raise StageError(stage, f"by geometry the {step.hand} hand {verb} {step.thing!r} before it")
    stands = bool(world.scene.support(step.thing))
    if "stand" in relations and relations["stand"][0] != str(int(stands)):
        verb = "stands on something" if stands else "stands on nothing"
        raise StageError(stage, f"by geometry {step.thing!r} {verb} before it")


def _stage(stage: Stage, world: World, human: Human) -> Done:
    first, goal, scene = stage.steps[0], stage.goal, world.scene
    try:
        source = stage.way.part_of(first.number, stage.steps[-1].number, first.hand)
        parts = _parts(stage, source, world)
        source = with_only(source, parts)
        spots = {first.thing: goal.place} if goal and goal.place else {}
        made, where = cast(source, replace(scene, spots=spots), parts)
        if not is_possible(made, where, human):
            raise StageError(stage, "out of reach")
        motion, quality = regenerate(made, human, where)
    except StageError:
        raise
    except PlanError as error:
        raise StageError(stage, str(error)) from error
    names = own_names(source, scene, parts)
    gate = contact_gate(motion, [*asserted(made), _planned(stage, made, names)])
    quality = Quality((*quality.gates, gate), quality.told)
    if not quality.passed:
        said = "; ".join(
            f"{one.name} {one.value:.1f} {one.unit} ({one.bodies})"
            for one in quality.gates
            if not one.passed
        )
        raise StageError(stage, f"it fails {said}")
    return Done(motion, quality, names, stage)


def _parts(stage: Stage, source: Source, world: World) -> dict[str, str]:
    """The thing, and what it stands on at both ends, in the parts of the recorded ones."""
    step, goal = stage.steps[0], stage.goal
    parts = {stage.way.part: step.thing}
    first, last = ends_on(source, stage.way.part)
    beneath = world.scene.support(step.thing)
    for role, support in ((last, goal.support if goal else beneath), (first, beneath)):
        if role and support and role not in parts and support not in parts.values():
            parts[role] = support
    return parts


def _planned(stage: Stage, source: Source, names: dict[str, str]) -> Asserted:
    """What the plan asserts at the end of a stage."""
    own = {name: role for role, name in names.items()}
    step, goal = stage.steps[0], stage.goal
    touches = (step.hand, step.thing) in stage.touching
    contacts: list[tuple[Contact, bool]] = [((step.hand, own[step.thing]), touches)]
    if goal:
        contacts.append(((own[step.thing], own[goal.support]), True))
    return Asserted("the plan's stage", len(source.times) - 1, tuple(contacts), "")


def _after(done: Done, world: World) -> World:
    """The world as geometry has it after a stage."""
    scene = scene_after(done.motion, done.names, world.scene)
    return World(scene, _touching(done.motion, done.names))


def _touching(motion: Motion, names: dict[str, str]) -> Touching:
    near = Measuring(motion).distances(len(motion.postures) - 1)
    return frozenset(
        (side, names[thing])
        for (side, thing), apart_m in near.items()
        if side in {"right", "left"} and thing in names and apart_m <= TOUCHES_M
    )
