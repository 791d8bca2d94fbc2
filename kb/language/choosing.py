"""What a summary tells: the few deeds that matter, each once, in the order in which they began."""

from collections.abc import Callable, Sequence
from dataclasses import replace

from kb.language.clause import Clause
from kb.language.lexicalisation import MOVING, PICKED_UP, SUSTAINED, THIS_WAY, TRANSPORT
from kb.language.thresholds import MINOR_SHARE, MOST_DEEDS

FETCHED = ("take {1} from", "put {1} back")
"""How patterns begin of a thing that is fetched for some work, or put back after it."""


def chosen(steps: Sequence[Clause]) -> tuple[Clause, ...]:
    """At most ``MOST_DEEDS`` of what was done, without what is only said again.

    Where a hand does the same for longer the next time, that is told, too; alone if it takes so
    much longer that the first was but its beginning.

    That a hand takes what it works with, and puts it back, goes without saying.

    Where more was done, what only leads to the next deed is left out first (to bring a whisk to the
    bowl in which it stirs), then help, then motions without a goal, the shortest first, and of each
    time that a hand had a thing one deed stays; and then whatever took least time.

    Args:
        steps: What was done, in order of time.
    """
    steps = [_at_work(each, steps) for each in steps if not _clears(each, steps)]
    told: list[Clause] = []
    repeated: list[Clause] = []
    longest_s: dict[Clause, float] = {}
    for step in steps:
        said = next((each for each in told[::-1] if _says_the_same(each, step)), None)
        if said is None:
            told.append(step)
        elif (said.ees, said.grip) == (step.ees, step.grip):
            longest_s[said] = max(longest_s[said], _lasts_s(step))
        elif _lasts_s(step) <= longest_s[said]:
            repeated.append(step)
        else:
            if longest_s[said] < MINOR_SHARE * _lasts_s(step):
                told.remove(said)
            told.append(step)
        longest_s.setdefault(step, _lasts_s(step))
    if len(steps) > MOST_DEEDS:
        told = [each for each in told if not _beside_what_recurs(each, repeated, told)]
    if len(told) > MOST_DEEDS:
        told = [each for at, each in enumerate(told) if not _leads_on(each, told[at + 1 :])]
        told = [each for at, each in enumerate(told) if not _on_the_way(each, told[at + 1 :])]
    told = _without_shortest(told, lambda step: step.helps)
    told = _without_shortest(told, lambda step: _minor(step) and not _alone(step, told))
    return tuple(_without_shortest(told, lambda step: True))


def mattering(told: Sequence[Clause]) -> tuple[Clause, ...]:
    """What one hand changed, or helped to change, and what no rule names."""
    return tuple(each for each in told if each.changes or not each.known or each.helps)


def longest(steps: Sequence[Clause]) -> tuple[str, ...]:
    """The end-effectors of what took longest: a summary begins with it where it can."""
    return max(steps, key=_lasts_s).ees if steps else ()


def _clears(step: Clause, steps: Sequence[Clause]) -> bool:
    """Whether a hand only fetches what it works with then, or puts it back afterwards."""
    own = (step.ees, step.grip, step.objects[:1])
    return step.pattern.startswith(FETCHED) and any(
        each.name in SUSTAINED
        and len(each.objects) > 1
        and (each.ees, each.grip, each.objects[:1]) == own
        for each in steps
    )


def _at_work(step: Clause, steps: Sequence[Clause]) -> Clause:
    """Help as given since another hand works in the thing."""
    if not step.helps:
        return step
    begins = [
        each.start_s
        for each in steps
        if each.ees != step.ees and each.objects[1:] == step.objects and each.overlaps(step)
    ]
    return replace(step, start_s=max(step.start_s, min(begins, default=step.start_s)))


def _without_shortest(told: list[Clause], minor: Callable[[Clause], bool]) -> list[Clause]:
    """The clauses, without as many of the minor ones as are too many."""
    while len(told) > MOST_DEEDS and any(minor(step) for step in told):
        told.remove(min(filter(minor, told), key=_lasts_s))
    return told


def _lasts_s(step: Clause) -> float:
    return step.end_s - step.start_s


def _says_the_same(one: Clause, other: Clause) -> bool:
    same = (one.pattern, one.objects, one.purpose) == (other.pattern, other.objects, other.purpose)
    return same and set(other.ees) <= set(one.ees)


def _beside_what_recurs(step: Clause, repeated: Sequence[Clause], told: Sequence[Clause]) -> bool:
    """Whether a hand that had a thing mainly did what it had done before, and this beside it."""
    same = [each for each in repeated if (each.ees, each.grip) == (step.ees, step.grip)]
    beside = [each for each in told if (each.ees, each.grip) == (step.ees, step.grip)]
    main_s = max((_lasts_s(each) for each in same), default=0.0)
    minor = len(step.objects) == 1 and not step.frees
    return minor and main_s > max(map(_lasts_s, beside))


def _leads_on(step: Clause, later: Sequence[Clause]) -> bool:
    """Whether the hand works next with the same things at the place to which it brings one."""
    after = [each for each in later if each.ees == step.ees and each.grip == step.grip]
    worked = bool(after) and after[0].objects[:2] == step.objects[:2] and after[0].goes_on
    return worked and len(step.objects) > 1


def _on_the_way(step: Clause, later: Sequence[Clause]) -> bool:
    """Whether a thing is lifted or carried that the hand puts somewhere later."""
    after = [each for each in later if each.ees == step.ees and each.grip == step.grip]
    ends = any(not (_without_goal(each) or each.frees) for each in after)
    return ends and step.name in TRANSPORT


def _without_goal(step: Clause) -> bool:
    """Whether a thing is moved, and nothing is said of where to."""
    moved = not MOVING.isdisjoint((step.name, *step.general))
    return moved and (step.pattern == THIS_WAY or step.pattern.partition(" ")[2] == "{1}")


def _minor(step: Clause) -> bool:
    """Whether a thing is moved to no goal by a hand that had it before: it is not picked up."""
    return _without_goal(step) and step.name != PICKED_UP


def _alone(step: Clause, told: Sequence[Clause]) -> bool:
    """Whether it is all that is told of a time in which a hand had a thing."""
    return sum((each.ees, each.grip) == (step.ees, step.grip) for each in told) == 1
