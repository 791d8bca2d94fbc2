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
    out: list[Clause] = []
    for at, step in enumerate(steps):
        pour = next((each for each in out[::-1] if _goes_on_after(step, each)), None)
        if pour is not None and step.start_s < pour.end_s < step.end_s:
            out.append(replace(step, start_s=pour.end_s))
        elif pour is not None and step.holds and step.end_s <= pour.end_s:
            continue
        elif step.pattern in TIPPED and step.possessed:
            later = (each.end_s for each in steps[at:] if _same_grip(each, step))
            until_s = turning.tipped_s(step.objects[0], step.end_s, max(later))
            out.append(replace(step, end_s=max(step.end_s, until_s)))
        else:
            out.append(step)
    return tuple(out)


def _goes_on_after(step: Clause, pour: Clause) -> bool:
    """Whether it tells of the same thing in the same hand since that was poured from."""
    poured = pour.pattern in TIPPED and step.pattern not in TIPPED
    return poured and _same_grip(step, pour) and step.start_s > pour.start_s


def _same_grip(one: Clause, other: Clause) -> bool:
    return (one.ees, one.grip, one.objects[:1]) == (other.ees, other.grip, other.objects[:1])
