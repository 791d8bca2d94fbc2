"""Of which distance explanations speak where two bodies touch."""

import math
from dataclasses import dataclass
from enum import StrEnum

from capar_rules.explain.quantities import upward

NEAR_MM = 5
"""Bodies that count as touching while they are further apart are told to be near [mm]."""


class Between(StrEnum):
    """What of two bodies a distance is between, as a sentence says it."""

    SURFACES = "between their surfaces"
    POINT = "from the surface of the one to the origin of the other"
    ORIGINS = "between their origins"
    POINTS = "between an estimated point of each body"


@dataclass(frozen=True, slots=True)
class Reach:
    """Up to which distance two bodies are counted as touching."""

    distance_m: float
    between: Between = Between.SURFACES
    begin_m: float = math.inf
    """Up to which distance contact begins, where it lasts up to a greater one."""

    unshaped: tuple[str, ...] = ()
    """Which of the two have no known shape."""

    outlying: tuple[tuple[str, str, float], ...] = ()
    """Bodies whose origin the distance is of, where that lies, and how far from there [m].

    Those alone whose origin lies outside of their shape or off its middle.
    """

    offsets: tuple[tuple[str, float], ...] = ()
    """Bodies of which the distance is of a point: how far that is from their origin [m]."""

    settles: bool = False
    """Whether contact lasts but from when the end-effector has arrived until it sets off."""

    @property
    def told_mm(self) -> float:
        """The distance in tenths of millimetres, as it is told: rounded up, so that it bounds."""
        return upward(1000.0 * self.distance_m, 1)

    @property
    def told(self) -> str:
        """Within what contact is counted, and up to what it lasts where that is more."""
        begin = upward(1000.0 * min(self.begin_m, self.distance_m), 1)
        lasts = f" until beyond {self.told_mm:g} mm" * (begin < self.told_mm)
        return f"{'from' if lasts else 'within'} {begin:g} mm{' on' * bool(lasts)}{lasts}"

    @property
    def is_touch(self) -> bool:
        """Whether bodies so near may be told to touch: surfaces, and hardly a gap."""
        return self.between is Between.SURFACES and self.told_mm <= NEAR_MM
