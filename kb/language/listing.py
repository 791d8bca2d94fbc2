"""What a hand does alike to one thing after another, told as one list: each with its own time."""

from collections.abc import Mapping, Sequence
from dataclasses import replace
from itertools import pairwise

from kb.language.clause import Clause
from kb.language.repeating import whole
from kb.language.thresholds import MOST_LISTED
from kb.lexicon.english import joined


def listed(steps: Sequence[Clause], paused: Mapping[float, float]) -> tuple[Clause, ...]:
    """The clauses; where a hand puts several things on end in or on one other, those as one.

    Args:
        steps: What was done, in order of time.
        paused: How long each noticed pause lasted [s], by when it ended [s].
    """
    runs: list[list[Clause]] = []
    for step in steps:
        if runs and step.start_s not in paused and _goes_on(runs[-1], step):
            runs[-1].append(step)
        else:
            runs.append([step])
    parts = [part for run in runs for part in _parts(run)]
    return tuple(step for part in parts for step in (_as_list(part) if len(part) > 1 else part))


def _parts(run: Sequence[Clause]) -> list[Sequence[Clause]]:
    """A run, parted where it waits longest until no part is too long for a list."""
    if len(run) <= MOST_LISTED:
        return [run]
    waits_s = [after.start_s - before.end_s for before, after in pairwise(run)]
    cut = waits_s.index(max(waits_s)) + 1
    return [*_parts(run[:cut]), *_parts(run[cut:])]


def _goes_on(run: Sequence[Clause], step: Clause) -> bool:
    """Whether the same is done to a further thing, by the same hand and at the same place."""
    same = (step.ees, step.pattern, step.objects[1:]) == (
        run[0].ees,
        run[0].pattern,
        run[0].objects[1:],
    )
    plain = step.count == 1 and not (step.purpose or step.often or step.pauses)
    further = step.objects[:1] not in [other.objects[:1] for other in run]
    after = step.start_s >= run[-1].end_s
    return same and plain and further and after and _lists(step)


def _lists(step: Clause) -> bool:
    """Whether it says of one thing that it was put in or on another."""
    verb, _, rest = step.pattern.partition(" {1} ")
    return verb == "put" and rest.endswith("{2}") and len(step.objects) > 1


def _as_list(run: Sequence[Clause]) -> tuple[Clause]:
    things = tuple(step.objects[0] for step in run)
    places = joined([f"{{{number}}}" for number in range(1, len(things) + 1)])
    first = run[0]
    pattern = first.pattern.replace("{2}", f"{{{len(things) + 1}}}").replace("{1}", places)
    one = replace(
        whole(run, pattern=pattern),
        objects=(*things, first.objects[1]),
        apart=tuple((step.start_s, step.end_s) for step in run),
    )
    return (one,)
