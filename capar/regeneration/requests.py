"""What was asked for in words, as actions on things of a scene."""

from collections.abc import Iterable
from dataclasses import dataclass

from capar.body.scenes import Thing
from capar.regeneration.errors import PlanError
from capar.regeneration.scenes import Scene
from kb.language import Instruction, Plan, Question, parse
from kb.language.errors import SentenceError
from kb.language.vocabulary import Vocabulary

CONTAINING = frozenset({"in", "into", "inside"})
"""Prepositions of a goal that is a container."""

SIDES = {"to the left": 1.0, "to the right": -1.0}
"""Directions that are compared with the recorded one, positive to the performer's left."""

BOTH = "both_hands"


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
    """An action that is to be done, on things by their names in the scene."""

    action: str
    said: str
    """The verb as a message says it."""

    objects: tuple[str, ...]
    sides: frozenset[str] = frozenset()
    """Hands that were named; empty where any will do."""

    contained: bool = False
    """Whether the last object is to hold the first one in it."""

    aside: float = 0.0
    """One for to the left, minus one for to the right."""

    unheeded: tuple[str, ...] = ()
    """What was said and has no effect."""


def read_requests(
    text: str, vocabulary: Vocabulary, scene: Scene, observed: frozenset[str] = frozenset()
) -> tuple[Request, ...]:
    """What a text asks for, in order.

    Args:
        text: In words.
        vocabulary: The verbs that are known.
        scene: The things that there are.
        observed: The actions that can be performed; empty takes any.

    Raises:
        RequestError: The words cannot be read or ask a question, nobody was observed doing that,
            or a thing is not there.
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
    return tuple(request for step in steps for request in _requests(step, scene, observed))


def _requests(step: Instruction, scene: Scene, observed: frozenset[str]) -> Iterable[Request]:
    told = step.circumstances
    if told.negated or told.conditions:
        what = "what is not to be done" if told.negated else "a condition"
        raise RequestError("words", f"{what} cannot be performed; say only what to do")
    if step.said or not step.known or not step.call.action:
        verb = step.said or step.call.action
        raise _unknown(verb, observed)
    if observed and step.call.action not in observed:
        raise _unknown(step.call.action, observed)
    named = [name for _, name in told.places if name not in step.call.objects]
    objects = tuple(find_thing(each, scene).name for each in (*step.call.objects, *named) if each)
    contained = any(word in CONTAINING for word, _ in told.places)
    aside = sum(SIDES.get(each, 0.0) for each in told.manner)
    unheeded = tuple(each for each in told.manner if each not in SIDES)
    made = Request(
        step.call.action, step.call.action, objects[: len(step.call.objects)] or objects,
        _sides(step.ee), contained, aside, unheeded,
    )  # fmt: skip
    return [made] * max(told.count, 1)


def _unknown(verb: str, observed: frozenset[str]) -> RequestError:
    known = f"; observed are {', '.join(sorted(observed))}" if observed else ""
    return RequestError("verb", f"nobody was observed doing {verb!r}{known}")


def _sides(ee: str) -> frozenset[str]:
    if ee == BOTH:
        return frozenset({"left", "right"})
    side = ee.partition("_")[0]
    return frozenset({side}) if side in {"left", "right"} else frozenset()


def find_thing(word: str, scene: Scene) -> Thing:
    """The thing that a word means: its name, else its kind.

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
