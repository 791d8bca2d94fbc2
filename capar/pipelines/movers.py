"""What moves nothing that is recorded, as notices: which object, when, and how much of its way."""

from collections import defaultdict
from collections.abc import Iterable, Iterator

import numpy as np
from jaxtyping import Float

from capar.model.facts import Displaced, Fact, MovedBy
from capar.model.notices import Notice, notice

UNKNOWN = "unknown"


def unmoved_notices(facts: Iterable[Fact], times: Float[np.ndarray, "frames"]) -> Iterator[Notice]:
    """A notice for each object in whose motion there are frames without a mover.

    Args:
        facts: Measurements and movers.
        times: Clock of the capture [s].
    """
    moved: dict[str, int] = defaultdict(int)
    lacking: dict[str, list[MovedBy]] = defaultdict(list)
    for fact in facts:
        if isinstance(fact, Displaced):
            moved[fact.object] += fact.last - fact.first + 1
        elif isinstance(fact, MovedBy) and fact.how == UNKNOWN:
            lacking[fact.object].append(fact)
    for thing, parts in sorted(lacking.items()):
        worst = max(parts, key=lambda part: part.last - part.first)
        frames = sum(part.last - part.first + 1 for part in parts)
        yield notice(
            "no-mover",
            thing,
            start_s=float(times[worst.first]),
            end_s=float(times[worst.last]),
            share=frames / max(moved[thing], 1),
            times=len(parts),
            why=worst.mover,
        )
