"""What a whole body does: feet that walk, parts of the arm beside the hand that does the work."""

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import replace

from capar.model.observation import ObservedLink, ObservedObject
from kb.language.clause import Clause, in_time
from kb.language.contacts import Scene
from kb.language.lexicalisation import (
    ON_FOOT,
    REACH,
    STEP,
    STEP_AWAY,
    STEP_BACK,
    STEP_UP,
    TWO_STEPS,
    WALK,
    WALK_AWAY,
    WALK_HALFWAY,
    WALK_PARTLY,
    WALK_UP,
)
from kb.language.thresholds import (
    AROUND_RAD,
    ASIDE_SHARE,
    FEWEST_STEPS,
    QUARTER_RAD,
    STEP_M,
    STRIDE_S,
)

Told = tuple[Clause, ...]

HAND, FOOT = "hand", "foot"
ARM = frozenset({"wrist", "forearm", "elbow", "shoulder", "thorax"})
"""Kinds of links between the trunk and a hand."""


def as_one_body(
    links: Sequence[ObservedLink],
    told: Sequence[Told],
    objects: Sequence[ObservedObject],
    scene: Scene,
) -> list[Told]:
    """What each link did, where other links of the body say it better.

    Where hands do something, feet that stand on the ground or step on the spot are not told, and
    walking is by `with_walks`. What a hand moves is not told of elbow and shoulder, too; where the
    contacts of a hand that touches it were missed, what the arm's other parts did stands for it.
    """
    if not any(link.kind == HAND and part for link, part in zip(links, told, strict=True)):
        return _on_foot(links, told, objects, scene)
    out = [list(part) for part in told]
    for place, link in enumerate(links):
        if link.kind == HAND:
            arm = [at for at, each in enumerate(links) if _of_arm(each, link)]
            out[place] = _with_arm(out[place], [told[at] for at in arm])
    moved = {
        step.objects[0]
        for link, part in zip(links, out, strict=True)
        for step in part
        if link.kind == HAND and step.changes and step.objects
    }
    ground = _ground(links, told, objects)
    for place, link in enumerate(links):
        if link.kind == FOOT:
            out[place] = [step for step in out[place] if _told_of_foot(step, ground)]
        elif link.kind != HAND:
            out[place] = [step for step in out[place] if not moved.intersection(step.objects[:1])]
    return [tuple(part) for part in out]


def _on_foot(
    links: Sequence[ObservedLink],
    told: Sequence[Told],
    objects: Sequence[ObservedObject],
    scene: Scene,
) -> list[Told]:
    """What feet did that only walk about on one ground, as walking."""
    feet = [place for place, link in enumerate(links) if link.kind == FOOT]
    ground = _ground(links, told, objects)
    walks = tuple(_walks((step for place in feet for step in told[place]), scene))
    if not walks or not ground:
        return list(told)
    out = list(told)
    for place in feet:
        out[place] = tuple(step for step in told[place] if step.objects[:1] != ground)
    out[feet[0]] = tuple(sorted((*walks, *out[feet[0]]), key=in_time))
    return out


def _of_arm(link: ObservedLink, hand: ObservedLink) -> bool:
    return link.kind in ARM and link.side == hand.side


def _with_arm(own: list[Clause], others: Sequence[Told]) -> list[Clause]:
    """What a hand did, with what its arm did to a thing that it touches and has lost sight of."""
    for thing in {step.objects[:1] for part in others for step in part if step.changes}:
        mine = [step for step in own if step.objects[:1] == thing]
        best = max(others, key=lambda part: _moving_s(part, thing))
        if mine and _moving_s(best, thing) > _moving_s(mine, thing):
            theirs = [replace(step, ees=mine[0].ees) for step in best if step.objects[:1] == thing]
            own = [step for step in own if step.objects[:1] != thing] + theirs
    return sorted(own, key=in_time)


def _moving_s(part: Sequence[Clause], thing: tuple[str, ...]) -> float:
    """For how long a link is seen to move a thing [s]."""
    own = (step for step in part if step.changes and step.objects[:1] == thing and not step.unseen)
    return sum(step.end_s - step.start_s for step in own)


def _ground(
    links: Sequence[ObservedLink], told: Sequence[Told], objects: Sequence[ObservedObject]
) -> tuple[str, ...]:
    """The one fixed thing on which all feet stand and step; empty where there is none."""
    grounds = {
        step.objects[:1]
        for link, part in zip(links, told, strict=True)
        for step in part
        if link.kind == FOOT and step.name in ON_FOOT
    }
    fixed = {(thing.name,) for thing in objects if thing.tag == "fixed"}
    return grounds.pop() if len(grounds) == 1 and grounds <= fixed else ()


def _told_of_foot(step: Clause, ground: tuple[str, ...]) -> bool:
    """Whether it is no mere standing, stepping or touching on the ground."""
    idle = step.name in ON_FOOT or not step.changes
    return not (ground and idle)


def with_walks(
    steps: Sequence[Clause],
    links: Sequence[ObservedLink],
    told: Sequence[Told],
    objects: Sequence[ObservedObject],
    scene: Scene,
) -> tuple[Clause, ...]:
    """What was done, with walking before the first thing is taken, and after the last.

    Args:
        steps: What was done, in order of time.
        links: The links.
        told: What each of them did, feet as they were; empty where walking is told as it is.
        objects: The objects.
        scene: Measured contacts and places.
    """
    manual = [step for step in steps if step.objects]
    if not (manual and told):
        return tuple(steps)
    feet = [step for link in links if link.kind == FOOT for step in _strides(link, scene)]
    if not feet and _ground(links, told, objects):
        feet = [
            step
            for link, part in zip(links, told, strict=True)
            for step in part
            if link.kind == FOOT
        ]
    acts = [step for step in manual if step.changes] or manual
    begin_s, end_s = min(step.start_s for step in acts), max(step.end_s for step in acts)
    out = list(steps)
    for walk in _walks((step for step in feet if step.end_s <= begin_s), scene):
        out = [_after(walk, step) for step in out if not _within(step, walk)]
        first = min((step for step in out if step.objects), key=in_time)
        thing = first.objects[0]
        up_to = any(
            scene.nears_m(foot, thing, walk.start_s, walk.end_s) > STEP_M for foot in walk.ees
        )
        walked = replace(walk, ees=first.ees)
        about_rad = min(
            abs(scene.goes_about_rad(foot, thing, walk.start_s, walk.end_s)) for foot in walk.ees
        )
        if walk.pattern != STEP and about_rad > QUARTER_RAD:
            pattern = WALK_HALFWAY if about_rad > AROUND_RAD else WALK_PARTLY
            walked = replace(walked, pattern=pattern, objects=(thing,))
        elif up_to:
            pattern = WALK_UP if walk.pattern == WALK else STEP_UP
            walked = replace(walked, pattern=pattern, objects=(thing,))
        out.append(walked)
    for walk in _walks((step for step in feet if step.start_s >= end_s), scene):
        out += _away(walk, max(manual, key=_end_s), scene)
    return tuple(sorted(out, key=in_time))


def _strides(link: ObservedLink, scene: Scene) -> Iterator[Clause]:
    """The steps of a foot whose way was measured."""
    for start_s, end_s in scene.strides(link.ee):
        yield Clause(STEP, (), (link.ee,), start_s, end_s, changes=False, name="Step")


def _away(walk: Clause, last: Clause, scene: Scene) -> Iterator[Clause]:
    """A walk after the last deed, as one away from the thing where it is that.

    Who goes backwards steps back, however often. A step or two that do not lead away are not told:
    where to is not known.
    """
    thing, own, span = last.objects[0], replace(walk, ees=last.ees), (walk.start_s, walk.end_s)
    nears_m = [scene.nears_m(foot, thing, *span) for foot in walk.ees]
    ways_m = [scene.way_m(foot, *span) or STEP_M for foot in walk.ees]
    away = all(
        near_m < -max(ASIDE_SHARE * way_m, STEP_M if walk.pattern == WALK else 0.0)
        for near_m, way_m in zip(nears_m, ways_m, strict=True)
    )
    if away and all(scene.goes_back(foot, *span) for foot in walk.ees):
        yield replace(own, pattern=STEP_BACK)
    elif walk.pattern == WALK:
        yield replace(own, pattern=WALK_AWAY) if away else own
    elif away:
        yield replace(own, pattern=STEP_AWAY)


def _end_s(step: Clause) -> float:
    return step.end_s


def _after(walk: Clause, step: Clause) -> Clause:
    """A reach that went on after the walk, as the part of it that the body did not do."""
    cut = step.pattern == REACH and step.start_s < walk.end_s < step.end_s
    return replace(step, start_s=walk.end_s) if cut else step


def _within(step: Clause, walk: Clause) -> bool:
    return step.pattern == REACH and step.end_s <= walk.end_s


def _walks(steps: Iterable[Clause], scene: Scene) -> Iterable[Clause]:
    """Steps that lead somewhere, those that follow each other soon as one walk."""
    going: list[Clause] = []
    for step in sorted(steps, key=in_time):
        way = scene.way_m(step.ees[0], step.start_s, step.end_s)
        if step.name not in ("Step", "Walk") or way is None or way < STEP_M:
            continue
        if going and step.start_s - max(each.end_s for each in going) > STRIDE_S:
            yield _walk(going)
            going = []
        going.append(step)
    if going:
        yield _walk(going)


def _walk(going: Sequence[Clause]) -> Clause:
    few = len(going) < FEWEST_STEPS and all(each.name == "Step" for each in going)
    return replace(
        going[0],
        pattern=(STEP if len(going) == 1 else TWO_STEPS) if few else WALK,
        objects=(),
        ees=tuple(sorted({ee for each in going for ee in each.ees})),
        start_s=min(each.start_s for each in going),
        end_s=max(each.end_s for each in going),
        changes=False,
        count=1,
    )
