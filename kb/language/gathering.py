"""Many things that are brought to one place, one after the other, as one deed of a summary."""

from collections.abc import Sequence
from dataclasses import replace

from capar.model.observation import ObservedObject
from kb.language.clause import Clause
from kb.language.contacts import Scene
from kb.language.lexicalisation import ONE_BY_ONE
from kb.language.repeating import whole
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
    fixed = [thing.name for thing in objects if thing.tag == "fixed"]
    goal = next((name for name in fixed if scene.gathers(name, things)), "")
    places = joined([f"{{{number}}}" for number in range(1, len(things) + 1)])
    to_there = f" to {{{len(things) + 1}}}" if goal else ""
    one = replace(
        whole(steps, pattern=f"move {places}{to_there} {{with}}{ONE_BY_ONE}"),
        objects=(*things, goal) if goal else things,
        name="MoveObjTo" if goal else "MoveObj",
        general=(),
    )
    return (one,)
