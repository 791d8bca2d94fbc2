"""What recurs among clauses: how often it was done, with which pauses, in which blocks."""

from collections.abc import Iterable, Sequence
from dataclasses import replace
from itertools import groupby, pairwise

from kb.language.clauses import Clause
from kb.lexicon.english import times


def counted(told: Iterable[Clause]) -> tuple[Clause, ...]:
    """The clauses, with those that say the same on end as one that says how often."""
    runs = (list(same) for _, same in groupby(told, key=lambda each: each.signature))
    return tuple(whole(run, count=_times(run)) for run in runs)


def _times(run: Sequence[Clause]) -> int:
    """How often it was done: what goes on and changes nothing was done once."""
    goes_on = [
        not later.changes and later.start_s <= earlier.end_s for earlier, later in pairwise(run)
    ]
    return len(run) - sum(goes_on)


def whole(run: Sequence[Clause], *, count: int = 1, pattern: str = "") -> Clause:
    """One clause for all of a run, said as its first."""
    return replace(
        run[0],
        pattern=pattern or run[0].pattern,
        end_s=run[-1].end_s,
        changes=any(each.changes for each in run),
        count=count,
    )


def with_pauses(told: Sequence[Clause]) -> list[Clause]:
    """The clauses, with a deed that was only paused as one that says how often it was done."""
    out: list[Clause] = []
    at = 0
    while at < len(told):
        end = at
        while told[at].changes and _resumed(told[at], told[end + 1 : end + 3]):
            end += 2
        run = told[at : end + 1]
        count = sum(each.count for each in run[::2])
        pauses = "with a pause" if len(run) == 3 else "with pauses"
        paused = replace(whole(run), often=f"{times(count)} {pauses}")
        out.append(paused if len(run) > 1 else told[at])
        at = end + 1
    return out


def _resumed(deed: Clause, following: Sequence[Clause]) -> bool:
    """Whether what follows is a pause with the thing in the hand, and then the deed again."""
    if len(following) < 2:
        return False
    pause, resumed = following
    held = pause.pattern.startswith("hold ") and pause.objects[:1] == deed.objects[:1]
    return held and replace(resumed, count=1).signature == replace(deed, count=1).signature


def repetition(steps: Sequence[Clause], at: int, *, longest: int) -> tuple[int, int]:
    """The length of the block that is repeated from here, and how often it stands; else (1, 1)."""
    best = (1, 1)
    for size in range(1, longest + 1):
        block = _said(steps[at : at + size])
        count = 1
        while block == _said(steps[at + size * count : at + size * (count + 1)]):
            count += 1
        if count > 1 and size * count > best[0] * best[1]:
            best = (size, count)
    return best


def _said(steps: Sequence[Clause]) -> list[tuple[object, ...]]:
    return [(each.signature, each.ees) for each in steps]
