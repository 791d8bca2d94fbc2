"""What is put into an open box or carton, told by where it is left and not by all it touches there.

Wording only, from measured places; rules name segments.
"""

from collections.abc import Collection, Sequence
from dataclasses import replace

from capar.model.observation import ObservedObject
from kb.language.clause import Clause, in_time
from kb.language.contacts import Scene
from kb.language.lexicalisation import CONTAINERS, PUT_IN, SETTLING, STAYING, TRANSPORT
from kb.language.thresholds import REST_S

ON_THE_WAY = TRANSPORT | STAYING | SETTLING
"""Names of what is done with a thing on its way into a container, until it stays there."""

MEETINGS = frozenset({"Hit", "Wipe", "Stir", "Cut", "Pour", "Shake"})
"""Names of what a thing seems to do to others that it only brushes past on its way among them."""


def containers(objects: Sequence[ObservedObject]) -> tuple[ObservedObject, ...]:
    """The objects that are open above and stay where they are."""
    return tuple(thing for thing in objects if is_container(thing) and thing.tag == "fixed")


def is_container(thing: ObservedObject) -> bool:
    """Whether it is open above by its kind, or by its name where the kind is a mere box."""
    return not CONTAINERS.isdisjoint((thing.kind, thing.name))


def stowed(
    steps: Sequence[Clause], objects: Sequence[ObservedObject], scene: Scene
) -> tuple[Clause, ...]:
    """The clauses; where a hand leaves a thing in a container, its way there as one.

    What it meets on that way is no goal, and not struck. A thing that was there before is only
    moved.

    Args:
        steps: What was done, in order of time.
        objects: The objects.
        scene: Measured contacts and places.
    """
    around = containers(objects)
    if not around:
        return tuple(steps)
    steps = [_moved_within(step, {box.name for box in around}) for step in steps]
    grips: dict[tuple[object, ...], list[Clause]] = {}
    for step in steps:
        if step.possessed:
            grips.setdefault((step.ees, step.grip, step.objects[:1]), []).append(step)
    out = list(steps)
    for own in grips.values():
        way = _last_way(own, {box.name for box in around})
        goal = next((box for box in around if way and _gets_into(way, box, scene)), None)
        if goal is not None:
            out = [step for step in out if not any(step is part for part in way)]
            out.append(_as_one(way, goal.name))
    return tuple(sorted(out, key=in_time))


def _moved_within(step: Clause, goals: Collection[str]) -> Clause:
    """What is moved along a box as shifted inside it: in there, nobody goes along it."""
    _, _, place = step.pattern.partition(" {1} ")
    if place != "along {2}" or step.objects[1] not in goals:
        return step
    return replace(step, pattern="shift {1} inside {2}")


def _last_way(own: Sequence[Clause], goals: Collection[str]) -> list[Clause]:
    """The last clauses of a grip that only say how a thing gets where it stays."""
    way: list[Clause] = []
    for step in reversed(own):
        plain = step.known and not step.purpose and not step.helps
        meets = step.name in MEETINGS and set(step.objects).isdisjoint(goals)
        if not plain or not (meets or step.name in ON_THE_WAY):
            break
        way.insert(0, step)
    return way


def _gets_into(way: Sequence[Clause], container: ObservedObject, scene: Scene) -> bool:
    thing = way[0].objects[0]
    start_s, end_s = way[0].start_s, max(step.end_s for step in way)
    before = scene.inside(thing, container, start_s)
    after = scene.inside(thing, container, end_s + REST_S)
    return after and not before and any(step.changes for step in way)


def _as_one(way: Sequence[Clause], goal: str) -> Clause:
    """The whole way as putting the thing into the container."""
    return replace(
        way[-1],
        pattern=PUT_IN,
        objects=(way[0].objects[0], goal),
        start_s=way[0].start_s,
        end_s=max(step.end_s for step in way),
        changes=True,
        name="MoveObjTo",
        general=(),
        count=1,
        pauses=0,
        goes_on=False,
    )
