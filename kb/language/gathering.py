"""Many things that are brought to one place, one after the other, as one deed of a summary."""

from collections.abc import Sequence
from dataclasses import replace

from capar.model.observation import ObservedObject
from kb.language.clause import Clause
from kb.language.contacts import Scene
from kb.language.lexicalisation import ONE_BY_ONE
from kb.language.repeating import whole
from kb.language.stowing import is_container
from kb.language.thresholds import MOST_DEEDS
from kb.lexicon.english import joined


def gathered(
    steps: Sequence[Clause], objects: Sequence[ObservedObject], scene: Scene
) -> tuple[Clause, ...]:
    """The clauses of a summary; where one hand moves more things than can be told, that as one.

    Args:
        steps: What was done, in order of time.
        objects: The objects.
        scene: Measured contacts and places.
    """
    hands = {step.ees for step in steps}
    things = tuple(dict.fromkeys(step.objects[0] for step in steps if step.objects))
    alike = all(step.changes and step.possessed for step in steps)
    if len(hands) != 1 or len(things) <= MOST_DEEDS or not alike:
        return tuple(steps)
    goal = next((place for place in objects if _gathers(place, steps, things, scene)), None)
    places = joined([f"{{{number}}}" for number in range(1, len(things) + 1)])
    if goal is not None and is_container(goal):
        source = [place.name for place in objects if _bore(place, things, scene)][:1]
        there = (*source, goal.name)
        number = len(things) + len(source)
        origin = f" from {{{number}}}" if source else ""
        pattern = f"pack {places}{origin} into {{{number + 1}}}"
    else:
        there = (goal.name,) if goal is not None else ()
        to_there = f" to {{{len(things) + 1}}}" if goal is not None else ""
        pattern = f"move {places}{to_there} {{with}}{ONE_BY_ONE}"
    one = replace(
        whole(steps, pattern=pattern),
        objects=(*things, *there),
        name="MoveObjTo" if goal is not None else "MoveObj",
        general=(),
    )
    return (one,)


def _gathers(
    goal: ObservedObject, steps: Sequence[Clause], things: Sequence[str], scene: Scene
) -> bool:
    """Whether all things get to a place that stays where it is."""
    if goal.tag != "fixed":
        return False
    if scene.gathers(goal.name, things):
        return True
    return is_container(goal) and all(_left_in(thing, goal, steps, scene) for thing in things)


def _left_in(thing: str, container: ObservedObject, steps: Sequence[Clause], scene: Scene) -> bool:
    """Whether the last that is told of a thing leaves it at the container, or heaped in it."""
    own = [step for step in steps if step.objects[:1] == (thing,)]
    named = any(container.name in step.objects[1:] for step in own)
    return named or scene.inside(thing, container, own[-1].end_s, heaped=True)


def _bore(support: ObservedObject, things: Sequence[str], scene: Scene) -> bool:
    """Whether all things stood on it at some time."""
    fixed = support.tag == "fixed" and not is_container(support)
    return fixed and all(scene.rests_on(thing, support.name) for thing in things)
