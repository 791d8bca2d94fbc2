"""Ways and turns summed up from the first frame, continued where a window of a recording begins."""

from collections.abc import Mapping
from dataclasses import dataclass, field

import numpy as np
from jaxtyping import Float


@dataclass(frozen=True)
class Sums:
    """What was summed up to a frame of a window; by default its first one, and nothing."""

    anchor: int = 0
    """The frame of the window at which the sums are known."""

    ways: Mapping[str, tuple[float, float, float]] = field(default_factory=dict)
    """Path [m], rotation [rad] and turn about the vertical [rad], by body."""

    winds: Mapping[tuple[str, str], float] = field(default_factory=dict)
    """By how much a body has gone about another [rad]."""

    def way(self, name: str) -> tuple[float, float, float]:
        """Those of a body; none of one that was not there."""
        return self.ways.get(name, (0.0, 0.0, 0.0))

    def wind(self, name: str, other: str) -> float:
        """That of two bodies."""
        return self.winds.get((name, other), 0.0)


FROM_THE_BEGINNING = Sums()


def summed(
    steps: Float[np.ndarray, "steps"], anchor: int, known: float
) -> Float[np.ndarray, "frames"]:
    """Running sum of the steps between frames that is ``known`` at a frame, before it backwards.

    From that frame on they are added in the order in which a whole recording would add them, so
    that the sums are the same to the last bit.
    """
    after = np.cumsum(np.concatenate(([known], steps[anchor:])))
    before = known - np.cumsum(steps[:anchor][::-1])
    return np.concatenate((before[::-1], after))
