"""The pauses of a telling: when nothing was done for so long that a reader is told of it."""

from collections.abc import Mapping, Sequence
from statistics import median

from kb.language.clause import Clause, in_time
from kb.language.thresholds import PAUSE_S, PAUSE_SHARE


def pauses(steps: Sequence[Clause]) -> Mapping[float, float]:
    """How long each noticed pause lasted [s], by when it ended [s].

    A pause is long, and long beside the others of the telling.

    Args:
        steps: What was done.
    """
    found: dict[float, float] = {}
    end_s: float | None = None
    for step in sorted(steps, key=in_time):
        if end_s is not None and step.start_s > end_s:
            found[step.start_s] = step.start_s - end_s
        end_s = step.end_s if end_s is None else max(end_s, step.end_s)
    usual_s = median(found.values()) if len(found) > 1 else 0.0
    return {
        time_s: lasted_s
        for time_s, lasted_s in found.items()
        if lasted_s >= max(PAUSE_S, PAUSE_SHARE * usual_s)
    }
