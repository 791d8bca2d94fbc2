"""How a thing is thrown, flies and is caught: swings of a hand, and free fall."""

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

Vector = tuple[float, float, float]

GRAVITY_MPS2 = np.array([0.0, 0.0, -9.81])
"""Standard gravity, rounded [m/s^2]."""


@dataclass(frozen=True)
class Toss:
    """What moves a thing in a phase in which it is thrown, flies or is caught."""

    start: Vector = (0.0, 0.0, 0.0)
    """Velocity with which it begins [m/s]."""

    end: Vector = (0.0, 0.0, 0.0)
    """Velocity with which it ends; ignored where it falls [m/s]."""

    falls: bool = False
    """Whether nothing but gravity moves it."""


def tossed(toss: Toss, by: Vector, seconds: float, share: float) -> Float[np.ndarray, "3"]:
    """Displacement of a thing since its phase began [m], in the world's axes.

    In a hand along a cubic Hermite curve that has both velocities, else along the parabola of
    gravity.

    Args:
        toss: How it moves.
        by: Where a hand brings it, from where it was [m]; ignored where it falls.
        seconds: Length of the phase [s].
        share: Of the phase that has passed [1].
    """
    start, end, goal = np.array(toss.start), np.array(toss.end), np.array(by)
    if toss.falls:
        past = share * seconds
        return np.asarray(start * past + 0.5 * GRAVITY_MPS2 * past**2)
    leaving, arriving = share - 2.0 * share**2 + share**3, share**3 - share**2
    led = goal * (3.0 * share**2 - 2.0 * share**3)
    return np.asarray(led + seconds * (leaving * start + arriving * end))


def slowed(velocity: Vector, past_s: float, stops_s: float) -> Float[np.ndarray, "3"]:
    """How far something goes that decelerates evenly to rest [m].

    Args:
        velocity: With which it begins [m/s].
        past_s: Since then [s].
        stops_s: How long it takes to stop [s].
    """
    past = min(past_s, stops_s)
    return np.asarray(np.array(velocity) * (past - 0.5 * past**2 / stops_s))
