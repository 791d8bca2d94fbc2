"""Words to performances: requests read from a sentence, and the recordings that do them."""

from collections.abc import Collection, Sequence
from dataclasses import dataclass

import numpy as np

from capar.body.human import Human
from capar.body.virtual_scenes import Thing
from capar.model.capture import TagType
from capar.model.par import Step
from capar.pipelines.recordings import Performed, Recording
from capar.pipelines.round_trips import by_hand, observed_source
from capar.regeneration import efforts
from capar.regeneration.captures import scene_after
from capar.regeneration.roles import Cast, cast, check_movable, own_names
from capar.regeneration.scenes import PlanError, Scene
from capar.regeneration.sources import Source
from capar.regeneration.styles import Kind, own_style
from kb.language import Instruction, Plan, Question, parse
from kb.language.reader import SentenceError
from kb.language.vocabulary import Vocabulary

CONTAINING = frozenset({"in", "into", "inside"})
"""Prepositions of a goal that is a container."""

DIRECTIONS = {"to the left": 1.0, "to the right": -1.0}
"""Directions that are compared with the recorded one, positive to the performer's left."""

SIDES = {"left": ("left",), "right": ("right",), "both": ("left", "right")}
"""Sides of an end-effector, by the first part of its name."""


class RequestError(PlanError):
    """A request that cannot be performed.

    Attributes:
        why: ``words``, ``object`` or ``verb``.
    """

    def __init__(self, why: str, message: str) -> None:
        self.why = why
        super().__init__(message)


@dataclass(frozen=True, slots=True)
class Request:
    """An action that is to be done, on objects by their names in the scene."""

    action: str
    objects: tuple[str, ...]
    sides: frozenset[str] = frozenset()
    """Hands that were named; empty where any will do."""

    contained: bool = False
    """Whether the last object is to hold the first one in it."""

    aside: float = 0.0
    """One for to the left, minus one for to the right."""

    unheeded: tuple[str, ...] = ()
    """Adverbs that say neither a place nor a direction."""

    def __str__(self) -> str:
        """The action and its objects."""
        return " ".join((self.action, *self.objects))


def read_requests(
    text: str, vocabulary: Vocabulary, scene: Scene, observed: Collection[str] = ()
) -> tuple[Request, ...]:
    """What a text asks for, in order.

    Raises:
        RequestError: The words cannot be read or ask a question, nobody was observed doing that,
            or an object is not there.
    """
    try:
        value = parse(text, vocabulary)
    except SentenceError as error:
        problem = " ".join(str(error).splitlines()[0].split())
        raise RequestError("words", f"cannot read {text!r}: {problem}") from error
    if isinstance(value, Question):
        raise RequestError(
            "words", f"{text!r} is a question; ask for an action, as in 'touch the mug'"
        )
    steps = value.steps if isinstance(value, Plan) else (value,)
    if isinstance(value, Plan) and any(len(part) > 1 for part in value.parts):
        raise RequestError("words", "actions at the same time cannot be asked for; say 'then'")
    return tuple(
        request
        for step in steps
        for request in [_request(step, scene, observed)] * max(step.circumstances.count, 1)
    )


def _request(step: Instruction, scene: Scene, observed: Collection[str]) -> Request:
    said, action = step.circumstances, step.call.action
    if said.negated or said.conditions:
        what = "what is not to be done" if said.negated else "a condition"
        raise RequestError("words", f"{what} cannot be performed; say only what to do")
    done = {name.lower() for name in observed}
    if step.said or not step.known or not action or (done and action.lower() not in done):
        known = f"; observed are {', '.join(sorted(observed))}" if observed else ""
        raise RequestError("verb", f"nobody was observed doing {step.said or action!r}{known}")
    named = [name for _, name in said.places if name not in step.call.objects]
    objects = tuple(find_thing(each, scene).name for each in (*step.call.objects, *named) if each)
    side = step.ee.partition("_")[0]
    return Request(
        action,
        objects[: len(step.call.objects)] or objects,
        frozenset(SIDES.get(side, ())),
        any(word in CONTAINING for word, _ in said.places),
        sum(DIRECTIONS.get(each, 0.0) for each in said.manner),
        tuple(each for each in said.manner if each not in DIRECTIONS),
    )


def find_thing(word: str, scene: Scene) -> Thing:
    """The object that a word means: its name, else its kind.

    Raises:
        RequestError: There is none, or there are several.
    """
    things = list(scene.things.values())
    found = [each for each in things if each.name == word] or [
        each for each in things if each.kind == word
    ]
    there = ", ".join(sorted(scene.things))
    if not found:
        raise RequestError("object", f"there is no {word!r} in the scene; there are {there}")
    if len(found) > 1:
        several = ", ".join(sorted(each.name for each in found))
        raise RequestError("object", f"{word!r} may be {several}; say which")
    return found[0]


@dataclass(frozen=True, eq=False)
class Choice:
    """A recording that does what some consecutive requests ask for."""

    requests: tuple[Request, ...]
    recording: Recording
    steps: tuple[Step, ...]
    """The step that does each of them."""

    others: tuple[str, ...]
    """Other recordings that would do as well, by name."""


@dataclass(frozen=True, eq=False)
class Performance(Performed):
    """What was performed for a choice."""

    choice: Choice
    notes: tuple[str, ...]


def choices(requests: Sequence[Request], recordings: Sequence[Recording]) -> tuple[Choice, ...]:
    """A recording for every request, in order; one for several where it does them in that order.

    Of several recordings the one with the fewest steps of all hands is chosen, then the one that
    handles objects of the same names, then the first by name.

    Raises:
        RequestError: No recording does what is asked for.
    """
    found: list[Choice] = []
    at = 0
    while at < len(requests):
        for size in range(len(requests) - at, 0, -1):
            part = tuple(requests[at : at + size])
            does = ((one, _steps_for(part, one)) for one in recordings)
            fitting = []
            for one, steps in does:
                pairs = _parts(part, steps).items() if steps else ()
                foreign = sum(name not in {own, *one.kinds.get(own, ())} for own, name in pairs)
                if steps:
                    fitting.append((len(one.steps), foreign, one.name, one, steps))
            if fitting:
                (*_, recording, steps), *others = sorted(fitting, key=lambda each: each[:3])
                found.append(Choice(part, recording, steps, tuple(o[2] for o in others)))
                at += size
                break
        else:
            raise _unobserved(requests[at], recordings)
    return tuple(found)


def _steps_for(requests: Sequence[Request], recording: Recording) -> tuple[Step, ...]:
    """The steps that do the requests one after the other; none if it does not."""
    first, links = requests[0], recording.par.links
    acting = len(
        {link.ee.partition("_")[0] for link in links if any(s.objects for s in link.steps)}
    )
    if any(request.sides and len(request.sides) != acting for request in requests):
        return ()
    called = first.objects and recording.par.name.lower() == first.action.lower()
    if len(requests) == 1 and called:  # the whole recording, as its user named it
        return tuple(s for s in recording.steps if len(s.objects) >= len(first.objects))[:1]
    for link in links:
        rest, found = iter(link.steps), list[Step]()
        for request in requests:
            found += next(
                (
                    [step]
                    for step in rest
                    if recording.fits(step, request.action)
                    and len(step.objects) >= len(request.objects) > 0
                ),
                [],
            )
        if len(found) == len(requests):
            pairs = {(s.objects[0], r.objects[0]) for r, s in zip(requests, found, strict=True)}
            if len(dict(pairs)) == len(pairs):  # each handled object stands for one throughout
                return tuple(found)
    return ()


def _parts(requests: Sequence[Request], steps: Sequence[Step]) -> dict[str, str]:
    """The scene's object for each recorded one that is handled."""
    return {s.objects[0]: r.objects[0] for r, s in zip(requests, steps, strict=True)}


def _unobserved(request: Request, recordings: Sequence[Recording]) -> RequestError:
    known = sorted({step.action for each in recordings for step in each.steps})
    hands = " with both hands" if len(request.sides) > 1 else ""
    what = f"{request.action!r}{hands}"
    what += " with another thing" if len(request.objects) > 1 else ""
    return RequestError(
        "verb", f"nobody was observed doing {what}; observed are {', '.join(known) or 'no actions'}"
    )


def perform(
    choice: Choice,
    scene: Scene,
    human: Human,
    *,
    kind: Kind = Kind.PATH,
    duration_s: float | None = None,
    hand: str | None = None,
    effort: efforts.Effort | None = None,
) -> Performance:
    """Perform a recording in a scene.

    Raises:
        PlanError: It is impossible, or out of reach; the message says what would help.
    """
    recorded = observed_source(choice.recording.capture)
    seen = (p for each in recorded.observation.segments for p in each.prepositions)
    contained = any(word == "in" and moved in recorded.paths for word, moved, _ in seen)
    if not contained and any(request.contained for request in choice.requests):
        raise RequestError(
            "verb",
            "nobody was observed putting something in another thing; say 'on' for what "
            f"{recorded.capture.name!r} does",
        )
    sides = {next(iter(each.sides)) for each in choice.requests if len(each.sides) == 1}
    side = hand or (sides.pop() if len(sides) == 1 else None)
    source = by_hand(recorded, side) if side else recorded
    parts, goals = _cast(choice, source, scene)
    source, where = cast(source, scene, parts, goals)
    for request, step in zip(choice.requests, choice.steps, strict=True):
        _check_side(request, step, source)
    words = dict.fromkeys(word for each in choice.requests for word in each.unheeded)
    asked = effort or efforts.effort_of_words(words)
    motion, quality, report = efforts.regenerate_in_manner(
        source, human, where, own_style(source, kind), effort=asked, duration_s=duration_s
    )
    names = own_names(recorded, scene, parts)
    notes = (*_notes(choice, parts), *efforts.told_of_words(words, stated=effort is not None))
    return Performance(motion, quality, names, report, choice, notes)


def after(performance: Performance, scene: Scene) -> Scene:
    """The scene as a performance leaves it."""
    return scene_after(performance.motion, performance.names, scene)


def _cast(choice: Choice, source: Source, scene: Scene) -> tuple[Cast, dict[str, str]]:
    """Who takes which part: what is named, then what bears the name, then by tag and in order."""
    parts = _parts(choice.requests, choice.steps)
    check_movable(source, scene, parts)
    goals: dict[str, str] = {}
    for request, step in zip(choice.requests, choice.steps, strict=True):
        if len(request.objects) > 1 and len(step.objects) > 1:
            thing, goal = step.objects[0], request.objects[1]
            if scene.support(parts[thing]) != goal:
                goals[thing] = goal
    for name, part in source.scene.things.items():
        if name in parts:
            continue
        beneath = scene.support(next(iter(parts.values()), ""))
        free = [each for each in scene.things.values() if each.name not in parts.values()]
        same = [each.name for each in free if each.tag is part.tag]
        order = [each for each in (beneath, name) if each in same] + sorted(same)
        if not order:
            what = "fixed" if part.tag is TagType.FIXED else "that can be moved"
            raise PlanError(
                f"the recording {choice.recording.name!r} needs something {what} for {name!r}; "
                f"the scene has {', '.join(sorted(scene.things))}"
            )
        parts[name] = order[0]
    return parts, goals


def _check_side(request: Request, step: Step, source: Source) -> None:
    """Left and right as they were recorded: another direction was not observed."""
    if not request.aside or step.objects[0] not in source.paths:
        return
    path = source.paths[step.objects[0]].translation
    turn = source.scene.heading
    aside = float((path[-1] - path[0]) @ [-np.sin(turn), np.cos(turn), 0.0])
    if aside * request.aside <= 0.0:
        way = "left" if aside > 0.0 else "right" if aside < 0.0 else "neither side"
        raise RequestError(
            "verb",
            f"in {source.capture.name!r} {step.objects[0]!r} goes to the {way}; the other hand "
            "does it the other way round (--hand left)",
        )


def _notes(choice: Choice, parts: Cast) -> list[str]:
    asked = ", then ".join(map(str, choice.requests))
    told = [f"{asked}: performed as in recording {choice.recording.name!r}"]
    if choice.others:
        told.append(
            f"{', '.join(choice.others)} would do as well; the one with the fewest steps is "
            "taken, then the one whose things bear the names, then the first by name"
        )
    told += [f"{name!r} has the part of {part!r}" for part, name in parts.items() if part != name]
    return told
