"""Where a thing is held, how it is carried, and where it is put: overhead, tilted, in its place.

Wording only, from measured ways and postures; rules name segments.
"""

from collections.abc import Sequence
from dataclasses import replace

from capar.model.observation import ObservedObject
from kb.language.clause import Clause, in_time
from kb.language.contacts import Scene
from kb.language.lexicalisation import (
    BACK_UPRIGHT,
    DOWN,
    GOALS,
    GROUNDS,
    HELD_OVER,
    LOWER,
    RAISE,
    SLID,
    TURN,
    TURNED,
    UP_AND_DOWN,
    UPRIGHT,
    UPSIDE_DOWN,
)
from kb.language.thresholds import (
    FEW_STEPS,
    FURTHER_M,
    HELD_M,
    IN_PLACE_M,
    LEADS_M,
    LEANT_RAD,
    OVER_RAD,
    PLACE_M,
    QUARTER_RAD,
    REST_S,
    RISEN_M,
    SETTLING_S,
    TIPPED_RAD,
    UNSEEN_S,
)
from kb.language.turning import Turning

OVERHEAD = "hold {1} overhead"
HELD_THERE = "hold {1} there"
SWUNG = "turn {1} from side to side overhead"
IN_ITS_PLACE = "put {1} back in its place"
NEAR_ITS_PLACE = "put {1} down almost where it had been"
SLIDE = "slide {1}"
BRING = "bring {1} to {2}"
CARRY, RISES = "carry {1}", frozenset({"lift {1}", "raise {1}"})


def placed(
    steps: Sequence[Clause], objects: Sequence[ObservedObject], scene: Scene, turning: Turning
) -> tuple[Clause, ...]:
    """The clauses, with how things are held up and carried, and where they are put.

    Args:
        steps: What was done, in order of time.
        objects: The objects.
        scene: Measured contacts and places.
        turning: How things are turned.
    """
    grounds = {thing.name for thing in objects if thing.kind in GROUNDS}
    out: list[Clause] = []
    for at, step in enumerate(steps):
        if _puts(step) and grounds.intersection(step.objects[1:]):
            out.append(_on_the_ground(step, out, scene))
        elif step.pattern == CARRY:
            carried = _carried(step, scene, turning)
            up = carried.pattern == OVERHEAD and any(_brings_overhead(each, step) for each in out)
            out.append(_swung(replace(carried, pattern=HELD_THERE), turning) if up else carried)
        elif step.pattern == LOWER and scene.left_there(step.objects[0], step.end_s):
            out.append(replace(step, pattern=DOWN))
        elif out and _settles(step, out[-1], scene):
            out[-1] = replace(out[-1], end_s=step.end_s)
        elif step.pattern == TURN and step.possessed and not step.pauses:
            out.append(replace(step, pattern=turning.seen_to_turn(step) or TURN))
        elif out and _holds_on(step, out[-1]):
            above = scene.overhead(step.objects[0], step.ees, step.start_s, step.end_s)
            held = replace(step, pattern=OVERHEAD if above else HELD_THERE)
            out.append(_swung(held, turning) if above else held)
        elif step.pattern.startswith(SLIDE):
            out.append(_tipped(_drawn(step, scene), turning))
        elif step.pattern in RISES:
            own = (step.ees, step.grip)
            same = [each for each in out if each.changes and (each.ees, each.grip) == own]
            out.append(_raised(step, same[-1] if same else None, scene))
        else:
            brought = _brought(step, out)
            works = _works_there(step, steps[at + 1 :]) and not _has_it(step, out)
            out.append(_taken(brought, objects, scene) if works else brought)
    return tuple(out)


def while_moving(steps: Sequence[Clause], scene: Scene) -> tuple[Clause, ...]:
    """The clauses; of what is put somewhere until it stays there, of what is slid while it goes.

    A hand that stays at it before or afterwards for a moment that people do not notice is left out.

    Args:
        steps: What was done, in order of time.
        scene: Measured contacts and places.
    """
    out: list[Clause] = []
    for step in steps:
        slid = step.pattern.startswith(tuple(f"{name.lower()} {{1}}" for name in SLID))
        told = _puts(step) or slid or step.pattern == LOWER
        if not (told and step.possessed) or step.apart or step.pauses:
            out.append(step)
            continue
        goes_s, stays_s = scene.moves_s(step.objects[0], step.start_s, step.end_s)
        late = step.end_s - stays_s > UNSEEN_S
        early = slid and goes_s - step.start_s > UNSEEN_S
        start_s, end_s = goes_s if early else step.start_s, stays_s if late else step.end_s
        out.append(replace(step, start_s=start_s, end_s=end_s))
    return tuple(sorted(out, key=in_time))


def turned_on_the_way(steps: Sequence[Clause]) -> tuple[Clause, ...]:
    """The clauses; turning that outlasts what it began in, with the carrying or what takes longest.

    What begins before that is told where it begins; what goes on from lifting a thing until it is
    put down there, by itself.

    Args:
        steps: What was done, in order of time.
    """
    out = list(steps)
    for turning in steps:
        own = [step for step in out if _moves_it_beside(turning, step)]
        if turning.pattern not in TURNED or any(map(turning.within, own)):
            continue
        begins = [step for step in own if step.start_s - UNSEEN_S < turning.start_s < step.end_s]
        ends = [
            step for step in own if turning.start_s < step.start_s < turning.end_s <= step.end_s
        ]
        overlaps = [step for step in own if turning.overlap_s(step) > 0.0]
        in_place = all(step.pattern in RISES or _puts(step) for step in overlaps)
        if begins and ends and not in_place:
            start_s = max(turning.start_s, begins[0].start_s)
            told = max(overlaps, key=lambda step: (_carries(step), turning.overlap_s(step)))
            told = begins[0] if start_s < told.start_s else told
            out[out.index(told)] = replace(told, along=(replace(turning, start_s=start_s),))
            out.remove(turning)
    return tuple(out)


def _carries(step: Clause) -> bool:
    return step.pattern.startswith(CARRY)


def _moves_it_beside(turning: Clause, step: Clause) -> bool:
    """Whether the same hands move the same thing otherwise, in the same grip."""
    same = (step.ees, step.grip, step.objects[:1]) == (
        turning.ees,
        turning.grip,
        turning.objects[:1],
    )
    return same and step.changes and step.pattern not in TURNED


def _brings_overhead(before: Clause, step: Clause) -> bool:
    """Whether the same hands, in the same grip, have got the thing overhead until then."""
    same = (step.ees, step.grip, step.objects[:1]) == (before.ees, before.grip, before.objects[:1])
    until = abs(before.end_s - step.start_s) < REST_S
    return same and until and before.pattern in {f"{rises} overhead" for rises in RISES}


def _holds_on(step: Clause, before: Clause) -> bool:
    """Whether a thing is held as it was just turned."""
    same = (step.ees, step.grip, step.objects[:1]) == (before.ees, before.grip, before.objects[:1])
    return same and step.pattern == HELD_OVER and before.pattern == UPSIDE_DOWN


def _settles(step: Clause, before: Clause, scene: Scene) -> bool:
    """Whether a thing that was just put on the ground only stirs until it stands there."""
    same = (step.ees, step.grip, step.objects[:1]) == (before.ees, before.grip, before.objects[:1])
    put = before.pattern.startswith(DOWN) or before.pattern in {IN_ITS_PLACE, NEAR_ITS_PLACE}
    soon = step.start_s - before.end_s < REST_S
    if not (same and put and soon and step.name in SLID):
        return False
    gone_m = scene.way_m(step.objects[0], step.start_s, step.end_s)
    return gone_m is not None and gone_m < PLACE_M


def _drawn(step: Clause, scene: Scene) -> Clause:
    """What is slid as pulled by hands that are ahead of it, and as pushed by those behind it."""
    ahead_m = [scene.leads_m(ee, step.objects[0], step.start_s, step.end_s) for ee in step.ees]
    for name, leads in (("Pull", min(ahead_m) > LEADS_M), ("Push", max(ahead_m) < -LEADS_M)):
        if leads:
            verb = step.pattern.replace("slide", name.lower(), 1)
            return replace(step, pattern=verb, name=name, general=("Slide", *step.general))
    return step


def _tipped(step: Clause, turning: Turning) -> Clause:
    """What is slid while it leans: it goes on a part of what it stands on."""
    leant = turning.leans_rad(step.objects[0], step.start_s, step.end_s)
    return replace(step, pattern=f"{step.pattern} at a tilt") if leant > TIPPED_RAD else step


def _swung(step: Clause, turning: Turning) -> Clause:
    """What is held overhead, as turned from side to side where it is turned far meanwhile."""
    return replace(step, pattern=SWUNG) if turning.swings_rad(step) > QUARTER_RAD else step


def righted(steps: Sequence[Clause]) -> tuple[Clause, ...]:
    """The clauses; what is turned upright on its way down is put down after that.

    Args:
        steps: What was done, in order of time.
    """
    out: list[Clause] = []
    for step in steps:
        turns = [
            each.end_s
            for each in steps
            if each.pattern in {UPRIGHT, BACK_UPRIGHT}
            and each.within(step)
            and (each.ees, each.grip) == (step.ees, step.grip)
        ]
        down = _puts(step) and bool(turns)
        out.append(replace(step, start_s=max(turns)) if down else step)
    return tuple(sorted(out, key=in_time))


def _works_there(step: Clause, later: Sequence[Clause]) -> bool:
    """Whether the hand next works with the thing where it is brought: that tells where to."""
    following = next((other for other in later if set(other.ees) & set(step.ees)), None)
    same = following is not None and (following.grip, following.objects) == (
        step.grip,
        step.objects,
    )
    return same and following is not None and following.goes_on and step.pattern == BRING


def _has_it(step: Clause, before: Sequence[Clause]) -> bool:
    """Whether it was told that the hand had the thing."""
    grips = [(own.ees, own.grip, own.objects[:1]) for own in before if own.possessed]
    return (step.ees, step.grip, step.objects[:1]) in grips


def _taken(step: Clause, objects: Sequence[ObservedObject], scene: Scene) -> Clause:
    """What is brought from where it stood all the time before, as taken from there."""
    thing = step.objects[0]
    fixed = (place.name for place in objects if place.tag == "fixed")
    support = next((name for name in fixed if scene.stood_on(thing, name, step.start_s)), None)
    if support is None:
        return step
    return replace(step, pattern="take {1} from {2}", objects=(thing, support))


def _brought(step: Clause, before: list[Clause]) -> Clause:
    """What is put or brought to another thing, with the short lifting and carrying before it.

    So it is with what it is brought to on the way. Those are taken from what is told before.
    """
    if not step.pattern.startswith(GOALS):
        return step
    start_s = step.start_s
    while before and _leads_to(before[-1], step) and start_s - before[-1].end_s < REST_S:
        start_s = before.pop().start_s
    return replace(step, start_s=start_s)


def _leads_to(step: Clause, goal: Clause) -> bool:
    own = (step.ees, step.objects[:1]) == (goal.ees, goal.objects[:1])
    brief = step.pattern in {CARRY, *RISES} and step.end_s - step.start_s < SETTLING_S
    return own and (brief or step.pattern == BRING)


def _carried(step: Clause, scene: Scene, turning: Turning) -> Clause:
    """What is carried somewhere as carried, and how; what stays over its place as held up."""
    thing, span = step.objects[0], (step.start_s, step.end_s)
    gone_m, strays_m = scene.over_ground_m(thing, *span)
    if gone_m < HELD_M and strays_m < 2.0 * HELD_M:
        where = "overhead" if scene.overhead(thing, step.ees, *span) else "up"
        return replace(step, pattern=f"hold {{1}} {where}")
    if step.end_s - step.start_s < SETTLING_S:
        return step
    leant = turning.leant(thing, *span)
    if leant > OVER_RAD:
        return replace(step, pattern=f"{CARRY} upside down")
    if leant > LEANT_RAD:
        return replace(step, pattern=f"{CARRY} at a tilt")
    few = 1 < scene.steps(*span) <= FEW_STEPS
    return replace(step, pattern=f"{CARRY} a few steps") if few else step


def _raised(step: Clause, before: Clause | None, scene: Scene) -> Clause:
    """What is lifted, and how; what comes down meanwhile as moved up and down.

    Of what was not moved just before, since it rises.
    """
    thing = step.objects[0]
    if before is None or before.end_s < step.start_s:
        start_s = scene.rises_s(thing, step.start_s, step.end_s)
        step = replace(step, start_s=min(start_s, max(step.start_s, step.end_s - UNSEEN_S)))
    if scene.overhead(thing, step.ees, step.end_s, step.end_s):
        return replace(step, pattern=f"{step.pattern} overhead")
    if step.pattern == RAISE and scene.sinks_m(thing, step.start_s, step.end_s) > RISEN_M:
        return replace(step, pattern=UP_AND_DOWN)
    return step


def _on_the_ground(step: Clause, before: Sequence[Clause], scene: Scene) -> Clause:
    """What is put on the ground as put in its place, or where it was not before."""
    own = [each for each in before if each.objects[:1] == step.objects[:1] and each.changes]
    since = [each for at, each in enumerate(own) if not any(map(_puts, own[at:]))] or [step]
    taken_s = min(each.start_s for each in since)
    gone_m, _ = scene.over_ground_m(step.objects[0], taken_s, step.end_s)
    if gone_m < PLACE_M:
        there = gone_m < IN_PLACE_M
        return replace(step, pattern=IN_ITS_PLACE if there else NEAR_ITS_PLACE)
    carried = any(each.pattern.startswith(CARRY) for each in since)
    elsewhere = gone_m > FURTHER_M and not carried
    return replace(step, pattern=f"{DOWN} elsewhere" if elsewhere else DOWN)


def _puts(step: Clause) -> bool:
    """Whether a thing stands somewhere after it."""
    return step.pattern.startswith("put {1}")
