"""What a hand does alike to one thing after another, told as one list: each with its own time."""

from collections.abc import Sequence
from dataclasses import replace

from kb.language.clause import Clause
from kb.language.repeating import whole
from kb.language.thresholds import MOST_DEEDS
from kb.lexicon.english import joined

FEWEST = 2
"""So many things at least make a list."""


def listed(steps: Sequence[Clause]) -> tuple[Clause, ...]:
    """The clauses; where a hand puts several things on end in or on one other, those as one.

    Args:
        steps: What was done, in order of time.
    """
    out: list[list[Clause]] = []
    for step in steps:
        run = out[-1] if out else []
        if run and len(run) < MOST_DEEDS and _goes_on(run, step):
            run.append(step)
        else:
            out.append([step])
    return tuple(step for run in out for step in (_as_list(run) if len(run) >= FEWEST else run))


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
