"""Lengths, ways and angles as a report prints them."""

import math
from dataclasses import dataclass

LEAST_M = 0.01
"""Shorter ways are told as less than that [m]."""

TURNING_M = 0.002
"""A body that moves, and whose origin has a shorter path, turns [m]."""

LONGER, LONGER_M = 1.5, 0.05
"""By this factor and by so much [m] a path is longer than the straight way, to be told too."""

LEVEL_MM = 5
"""A smaller difference of height, or a smaller way aside, is none [mm]."""


@dataclass(frozen=True, slots=True)
class Way:
    """How a body moved between two frames."""

    straight_m: float
    """How far it ended from where it began [m]."""

    path_m: float
    """The length of its path [m]."""

    spread_m: float
    """How far it came at most from the middle of the places where it was [m]."""

    @property
    def winding(self) -> bool:
        """Whether the path is so much longer than the straight way that both are to be told."""
        return self.path_m > max(LONGER * self.straight_m, self.straight_m + LONGER_M)


def length(metres: float) -> str:
    """A length in the unit in which it has two or three digits."""
    if metres < LEAST_M:
        return f"{1000.0 * metres:.0f} mm"
    if metres < 1.0:
        return f"{100.0 * metres:.0f} cm"
    return f"{metres:.1f} m"


def way(moved: Way) -> str:
    """How far a body moved, to stand after ``moved``."""
    if moved.winding:
        return f"along a path of {length(moved.path_m)} and ended {_from_start(moved.straight_m)}"
    if moved.path_m < TURNING_M:
        return "by turning"
    return length(moved.straight_m)


def place(x_mm: float, y_mm: float, z_mm: float) -> str:
    """Where a body ended that was displaced so, to stand after ``ended``."""
    return _from_start(math.hypot(x_mm, y_mm, z_mm) / 1000.0)


def _from_start(metres: float) -> str:
    return "where it began" if metres < LEAST_M else f"{length(metres)} from where it began"


def spread(metres: float) -> str:
    """Within what a body stayed, to stand after ``within``."""
    return "1 mm" if metres < 0.0015 else length(metres)


def course(x_mm: int, y_mm: int, z_mm: int) -> str:
    """A displacement by its rise and its way aside, to stand after ``ended``."""
    aside = math.hypot(x_mm, y_mm)
    parts = []
    if abs(z_mm) < LEVEL_MM <= aside:
        parts.append("at the same height")
    elif abs(z_mm) >= LEVEL_MM:
        parts.append(f"{length(abs(z_mm) / 1000.0)} {'higher' if z_mm > 0 else 'lower'}")
    if aside >= LEVEL_MM:
        parts.append(f"{length(aside / 1000.0)} to the side")
    return " and ".join(parts) or "where it began"


def slope(x_mm: int, y_mm: int, z_mm: int) -> str:
    """Whether a displacement leads more up, down or aside, to stand after ``went``."""
    aside = math.hypot(x_mm, y_mm)
    if abs(z_mm) < LEVEL_MM:
        return "to the side, and neither up nor down"
    sense = "up" if z_mm > 0 else "down"
    if aside < LEVEL_MM:
        return f"straight {sense}"
    if abs(z_mm) >= aside:
        return f"{sense} more than to the side"
    return f"more to the side than {sense}"


def degrees(milliradians: int) -> str:
    """An angle in whole degrees."""
    return f"{math.degrees(abs(milliradians) / 1000.0):.0f}°"
