"""What goes without saying: that a hand comes to what it handles, and leaves it afterwards."""

from collections.abc import Sequence
from dataclasses import replace

from kb.language.clause import Clause
from kb.language.contacts import Scene
from kb.language.lexicalisation import (
    DOWN,
    LET_GO,
    LOWER,
    MOMENTARY,
    QUIET,
    REACH,
    THIS_WAY,
    TILT,
    TURN,
)
from kb.language.thresholds import REST_S, UNSEEN_S

UP = ("lift {1}", "raise {1}", "carry {1}", "hold {1} up", "hold {1} overhead")
"""How patterns begin of a thing that is off what it stood on then."""


def without_coming(steps: Sequence[Clause], scene: Scene) -> tuple[Clause, ...]:
    """The clauses, without reaching for what is handled next, and leaving what was handled.

    Nor is it said that a hand stays at what it has put somewhere, and does nothing more with it. A
    thing that was taken up and is let go where it stays was put down there.

    Args:
        steps: What was done, in order of time.
        scene: Measured contacts and places.
    """
    out: list[Clause] = []
    for at, step in enumerate(steps):
        if not _goes_without_saying(steps, at):
            out.append(step)
        elif step.pattern == LET_GO and _is_up(steps[:at], step):
            out.append(_left(step, steps[:at], scene))
    return tuple(out)


def set_down(steps: Sequence[Clause], scene: Scene) -> tuple[Clause, ...]:
    """The clauses, with taking a thing up and putting it down where that is part of turning it.

    Args:
        steps: What was done, in order of time.
        scene: Measured contacts and places.
    """
    out: list[Clause] = []
    for step in steps:
        turns = step.pattern in {THIS_WAY, TURN, TILT} and step.possessed and step.changes
        beside = any(each is not step and step.within(each) for each in steps)
        span = (step.start_s, step.end_s)
        taken_up = turns and not step.pauses and scene.is_up_between(step.objects[0], *span)
        if not turns or beside or not (taken_up or scene.sets_down(step.objects[0], *span)):
            out.append(step)
            continue
        turned_s = step.start_s
        if taken_up:
            turned_s = scene.goes_up_s(step.objects[0], *span)
            since_s, _ = scene.moves_s(step.objects[0], *span)
            out.append(
                replace(step, pattern="lift {1}", name="Lift", start_s=since_s, end_s=turned_s)
            )
        begin_s = scene.comes_down_s(step.objects[0], *span)
        if begin_s - turned_s > UNSEEN_S:
            out.append(replace(step, start_s=turned_s, end_s=begin_s))
        _, stays_s = scene.moves_s(step.objects[0], begin_s, step.end_s)
        end_s = stays_s if step.end_s - stays_s > UNSEEN_S else step.end_s
        down = replace(step, pattern=DOWN, name="PutDown", start_s=begin_s, end_s=end_s)
        out.append(replace(down, pauses=0, rests=()))
    return tuple(out)


def _goes_without_saying(steps: Sequence[Clause], at: int) -> bool:
    step = steps[at]
    if step.holds and step.pattern.startswith("hold {1}"):
        own = _own(steps, step)
        before = own[: own.index(step)]
        return bool(before) and before[-1].pattern.startswith("put") and own[-1] is step
    if step.pattern not in QUIET:
        return False
    beside = steps[at + 1 :] if step.pattern == REACH else steps[:at][::-1]
    handled = [_next_of(ee, beside) for ee in step.ees]
    return all(
        each is not None and each.pattern not in QUIET and each.objects[:1] == step.objects[:1]
        for each in handled
    )


def _next_of(ee: str, steps: Sequence[Clause]) -> Clause | None:
    return next((step for step in steps if ee in step.ees and step.objects), None)


def _own(before: Sequence[Clause], step: Clause) -> list[Clause]:
    """What the hands did to a thing since they had it, before they let it go."""
    same = [each for each in before if each.objects[:1] == step.objects[:1]]
    mine = [each for each in same if set(each.ees) & set(step.ees) and each.grip == step.grip]
    return [each for each in mine if each.pattern not in QUIET]


def _is_up(before: Sequence[Clause], step: Clause) -> bool:
    """Whether the thing was taken up, and nothing is told of its way down."""
    said = [each.pattern for each in _own(before, step)]
    up = [at for at, pattern in enumerate(said) if pattern.startswith(UP)]
    down = [at for at, pattern in enumerate(said) if _ends_it(pattern)]
    return bool(up) and max(down, default=-1) < up[-1]


def _ends_it(pattern: str) -> bool:
    return pattern == LOWER or "{2}" in pattern or pattern in MOMENTARY or pattern[:3] == "put"


def _left(step: Clause, before: Sequence[Clause], scene: Scene) -> Clause:
    """Letting go of a thing that is up, as putting it down where it stays then."""
    if not scene.stays(step.objects[0], step.end_s, step.end_s + REST_S):
        return step
    since_s = max(each.end_s for each in _own(before, step))
    return replace(
        step,
        pattern=DOWN,
        start_s=min(since_s, step.start_s),
        changes=True,
        possessed=True,
        name="PutDown",
    )
