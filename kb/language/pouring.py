"""How long is poured: while the vessel is tipped, though the hand rests or moves it on.

Wording only, from measured postures; rules name segments.
"""

from collections.abc import Sequence
from dataclasses import replace

from kb.language.clause import Clause
from kb.language.lexicalisation import TIPPED
from kb.language.turning import Turning


def poured(steps: Sequence[Clause], turning: Turning) -> tuple[Clause, ...]:
    """The clauses, with pouring until the vessel is tipped no more, and what follows since then.

    Args:
        steps: What was done, in order of time.
        turning: How things are turned.
    """
    out = list(steps)
    for pour in steps:
        if pour.pattern not in TIPPED or not pour.possessed:
            continue
        own = [step for step in out if _in_the_grip(step, pour)]
        last_s = max(step.end_s for step in own)
        until_s = turning.tipped_s(pour.objects[0], pour.end_s, last_s)
        for step in own:
            at = out.index(step)
            if step.start_s == pour.start_s:
                out[at] = replace(step, end_s=max(step.end_s, until_s))
            elif step.start_s >= pour.end_s and step.start_s < until_s < step.end_s:
                out[at] = replace(step, start_s=until_s)
    return tuple(out)


def _in_the_grip(step: Clause, pour: Clause) -> bool:
    """Whether it tells of the same thing in the same hand, from the pouring on."""
    same = (step.ees, step.grip, step.objects[:1]) == (pour.ees, pour.grip, pour.objects[:1])
    return same and step.start_s >= pour.start_s
