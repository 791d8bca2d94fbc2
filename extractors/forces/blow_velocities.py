"""Velocities beside a blow, and what they say: restitution, and the thesis's damping."""

import numpy as np
from jaxtyping import Float

VELOCITY_S = 0.2
"""Over so long the velocity of a hand is fitted beside a blow [s]."""

FEWEST = 6
"""A path needs so many places [1]."""

ALONG = 0.3
"""An axis with a smaller share of the speed takes the other's damping [1]."""

LATE_SHARE = 0.8
"""The thesis fits the first part of a slide: at its end, both quantities vanish [1]."""


def velocity_at(
    times: Float[np.ndarray, "frames"],
    places: Float[np.ndarray, "frames 3"],
    at_s: float,
    *,
    degree: int = 2,
) -> Float[np.ndarray, "3"]:
    """The velocity at a time by a polynomial fitted to places [m/s].

    Args:
        times: Of the places [s].
        places: Recorded ones; lost ones are NaN [m].
        at_s: When [s].
        degree: Of the polynomial [1].
    """
    known = ~np.isnan(places[:, 0])
    if known.sum() <= degree:
        return np.zeros(3)
    powers = np.stack([(times[known] - at_s) ** power for power in range(degree + 1)], axis=1)
    return np.asarray(np.linalg.lstsq(powers, places[known], rcond=None)[0][1])


def velocities_about(
    times: Float[np.ndarray, "frames"], places: Float[np.ndarray, "frames 3"], at_s: float
) -> tuple[Float[np.ndarray, "3"], Float[np.ndarray, "3"]]:
    """The velocities just before and just after a blow [m/s].

    Both ways are quadratic in time and meet in one place, which makes the fit less sensitive to
    noise than two fits would be.

    Args:
        times: Of places on both sides of the blow [s].
        places: Recorded ones; lost ones are NaN [m].
        at_s: When the blow is [s].
    """
    near = (np.abs(times - at_s) <= VELOCITY_S) & ~np.isnan(places[:, 0])
    past = times[near] - at_s
    early, late = np.minimum(past, 0.0), np.maximum(past, 0.0)
    powers = np.stack([np.ones_like(past), early, early**2, late, late**2], axis=1)
    found = np.linalg.lstsq(powers, places[near], rcond=None)[0]
    return np.asarray(found[1]), np.asarray(found[3])


def restitution(
    before: Float[np.ndarray, "3"], after: Float[np.ndarray, "3"], thing: Float[np.ndarray, "3"]
) -> float | None:
    """Coefficient of restitution of a blow at a thing at rest (thesis eq. 3.5).

    The line of impact is the way that the thing takes: without friction there is no other force.

    Args:
        before: The striker's velocity before the impact [m/s].
        after: The striker's velocity after it [m/s].
        thing: The thing's velocity after it [m/s].

    Returns:
        None where the striker does not go towards the thing.
    """
    line = thing / max(float(np.linalg.norm(thing)), 1e-9)
    closing = float(before @ line)
    return None if closing <= 0.0 else float((thing - after) @ line) / closing


def thesis_damping(
    times: Float[np.ndarray, "frames"], velocities: Float[np.ndarray, "frames 3"]
) -> tuple[float, float] | None:
    """The thesis's damping: the slope of acceleration over velocity against time (eq. 3.7-3.11).

    It is no physical coefficient, since it vanishes where the deceleration is proportional to the
    speed; ``Fit.damping`` is one. The end of the slide is left out, as the thesis does.

    Args:
        times: Of the slide [s].
        velocities: Then [m/s].

    Returns:
        Along x and y [1/s^2]; None where the slide is too short.
    """
    last = int(LATE_SHARE * len(times))
    if last < FEWEST:
        return None
    rates = np.gradient(velocities, times, axis=0)[:last]
    part, clock = velocities[:last], times[:last]
    out = []
    for axis in range(2):
        moves = np.abs(part[:, axis]) > ALONG * np.abs(part[:, axis]).max()
        flat = np.abs(part[:, axis]).max() < ALONG * np.hypot(*part[:, :2].T).max()
        if flat or moves.sum() < FEWEST:
            out.append(0.0)
            continue
        ratio = rates[moves, axis] / part[moves, axis]
        out.append(float(np.polyfit(clock[moves], ratio, 1)[0]))
    return out[0], out[1]
