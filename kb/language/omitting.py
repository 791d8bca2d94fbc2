"""What goes without saying: that a hand comes to what it handles, and leaves it afterwards."""

from collections.abc import Sequence

from kb.language.clause import Clause
from kb.language.lexicalisation import QUIET, REACH


def without_coming(steps: Sequence[Clause]) -> tuple[Clause, ...]:
    """The clauses, without reaching for what is handled next, and leaving what was handled.

    Args:
        steps: What was done, in order of time.
    """
    return tuple(step for at, step in enumerate(steps) if not _goes_without_saying(steps, at))


def _goes_without_saying(steps: Sequence[Clause], at: int) -> bool:
    step = steps[at]
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
