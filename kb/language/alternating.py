"""What hands do in turn to one thing: with the right hand, then with the left, then with both."""

from collections.abc import Iterable, Sequence
from dataclasses import replace
from itertools import groupby

from kb.language.clause import Clause, in_time
from kb.language.lexicalisation import BY_TURNS, DOWN, JOINT, THIS_WAY, TURN
from kb.language.repeating import whole
from kb.language.thresholds import MOSTLY

FEWEST_TURNS = 3
"""So many times one hand after another has the thing, where the turns are told as one deed."""

MOST_TURNS = 3
"""Of more turns, it is not told which hand had which."""


def in_turns(steps: Sequence[Clause]) -> tuple[Clause, ...]:
    """The clauses of a summary; where hands mostly turn one thing about in turn, that as one.

    What is done before the first turn and after the last stays, but for putting the thing down; so
    does all where other things are handled, too. Of many turns, and of those after something else,
    it is told that there were some, and not which.

    Args:
        steps: What was done, in order of time.
    """
    turning = [
        step
        for step in steps
        if step.pattern in {TURN, THIS_WAY} and step.changes and not _helps(step, steps)
    ]
    turns = [list(part) for _, part in groupby(turning, key=lambda step: step.ees)]
    things = {step.objects[:1] for step in steps if step.objects}
    if (
        len(turns) < FEWEST_TURNS
        or len(things) != 1
        or _lasts_s(turning) < MOSTLY * _lasts_s(steps)
    ):
        return tuple(steps)
    first, last = turning[0], max(turning, key=lambda step: step.end_s)
    rises = sum(any(map(_rises, _beside(part, steps))) for part in turns)
    lifted = rises >= len(turns) - 1
    verbs = f"lift{JOINT}turn {{1}} about" if lifted else THIS_WAY
    main = whole(turning, pattern=verbs)
    before = [
        step
        for step in steps
        if step.end_s <= first.start_s
        and not (lifted and _rises(step))
        and not (step.pattern in {TURN, THIS_WAY} and _helps(step, steps))
    ]
    if before or len(turns) > MOST_TURNS:
        hands = {ee for part in turns for ee in part[0].ees}
        main = replace(main, ees=tuple(sorted(hands)), often=BY_TURNS)
    else:
        main = replace(main, ees=first.ees, in_turn=tuple(part[0].ees for part in turns[1:]))
    after = [step for step in steps if step.start_s >= last.end_s and step.pattern != DOWN]
    return tuple(sorted((*before, main, *after), key=in_time))


def _helps(step: Clause, steps: Sequence[Clause]) -> bool:
    """Whether another hand has the thing in its grip before, meanwhile and afterwards."""
    return any(
        set(other[0].ees).isdisjoint(step.ees)
        and other[0].start_s < step.start_s
        and step.end_s < max(own.end_s for own in other)
        for other in _grips(steps)
        if other[0].objects[:1] == step.objects[:1]
    )


def _grips(steps: Sequence[Clause]) -> Iterable[Sequence[Clause]]:
    """What each hand does each time that it has a thing and moves it."""
    grips: dict[tuple[object, ...], list[Clause]] = {}
    for step in steps:
        if step.possessed and step.changes:
            grips.setdefault((step.ees, step.grip, step.objects[:1]), []).append(step)
    return grips.values()


def _beside(turn: Sequence[Clause], steps: Sequence[Clause]) -> list[Clause]:
    """What the same hands do while they have the thing that they turn."""
    grips = {step.grip for step in turn}
    return [step for step in steps if step.ees == turn[0].ees and step.grip in grips]


def _rises(step: Clause) -> bool:
    return not {"Lift", "Raise"}.isdisjoint((step.name, *step.general))


def _lasts_s(steps: Sequence[Clause]) -> float:
    return sum(step.end_s - step.start_s for step in steps)
