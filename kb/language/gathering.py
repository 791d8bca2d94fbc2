"""Many things that are brought to one place, one after the other, as one deed of a summary."""

from collections.abc import Sequence
from dataclasses import replace

from capar.model.observation import ObservedObject
from kb.language.clause import Clause
from kb.language.contacts import Scene
from kb.language.lexicalisation import ONE_BY_ONE
from kb.language.repeating import whole
from kb.language.stowing import containers, is_container
from kb.language.thresholds import MOST_DEEDS
from kb.lexicon.english import joined, number

FEWEST_PACKED = 3
"""So many things that are put into one box are packed."""


def gathered(
    steps: Sequence[Clause], objects: Sequence[ObservedObject], scene: Scene
) -> tuple[Clause, ...]:
    """The clauses of a summary; where one hand packs things, or moves too many, that as one.

    What is only moved within the box is told beside that. Of more than can be named it is told how
    many there are, and whether those are all that there were.

    Args:
        steps: What was done, in order of time.
        objects: The objects.
        scene: Measured contacts and places.
    """
    boxes = containers(objects)
    within = [step for step in steps if _moved_within(step, boxes, scene)]
    packing = [step for step in steps if step not in within]
    one = _as_one(packing, objects, scene)
    if one is not None and one.pattern.startswith("pack"):
        return (one, *(step for step in within if step.objects[:1] not in _things(packing)))
    one = _as_one(steps, objects, scene) if within else one
    return tuple(steps) if one is None else (one,)


def _things(steps: Sequence[Clause]) -> set[tuple[str, ...]]:
    return {step.objects[:1] for step in steps}


def _moved_within(step: Clause, boxes: Sequence[ObservedObject], scene: Scene) -> bool:
    """Whether a thing is moved that was in a box before."""
    thing = step.objects[:1]
    return bool(thing) and any(scene.inside(thing[0], box, step.start_s) for box in boxes)


def _as_one(
    steps: Sequence[Clause], objects: Sequence[ObservedObject], scene: Scene
) -> Clause | None:
    """All clauses as packing, or as moving many things; None where they are told one by one."""
    hands = {step.ees for step in steps}
    things = tuple(dict.fromkeys(step.objects[0] for step in steps if step.objects))
    alike = all(step.changes and step.possessed for step in steps)
    if len(hands) != 1 or len(things) < FEWEST_PACKED or not alike:
        return None
    goal = next((place for place in objects if _gathers(place, steps, things, scene)), None)
    if len(things) <= MOST_DEEDS and not (goal is not None and is_container(goal)):
        return None
    source = [place.name for place in objects if _bore(place, things, scene)][:1]
    if goal is not None and is_container(goal) and len(things) > MOST_DEEDS:
        every = "all " if scene.are_all(things, goal) else ""
        told, things = f"{every}{number(len(things))} things", ()
    else:
        told = joined([f"{{{place}}}" for place in range(1, len(things) + 1)])
    if goal is not None and is_container(goal):
        there = (*source, goal.name)
        last = len(things) + len(source)
        origin = f" from {{{last}}}" if source else ""
        how = "" if things else " one by one"
        pattern = f"pack {told}{origin} into {{{last + 1}}}{how}"
    else:
        there = (goal.name,) if goal is not None else ()
        to_there = f" to {{{len(things) + 1}}}" if goal is not None else ""
        pattern = f"move {told}{to_there} {{with}}{ONE_BY_ONE}"
    return replace(
        whole(steps, pattern=pattern),
        objects=(*things, *there),
        name="MoveObjTo" if goal is not None else "MoveObj",
        general=(),
    )


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
    return named or scene.over(thing, container, own[-1].end_s)


def _bore(support: ObservedObject, things: Sequence[str], scene: Scene) -> bool:
    """Whether all things stood on it at some time."""
    fixed = support.tag == "fixed" and not is_container(support)
    return fixed and all(scene.rests_on(thing, support.name) for thing in things)
