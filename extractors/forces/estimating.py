"""Velocity, damping and restitution of a thing that moves on alone, fitted to its recorded path."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import partial

import numpy as np
from jaxtyping import Float

from extractors.forces.blow_velocities import ALONG, FEWEST, velocity_at
from extractors.forces.free_motion import (
    GRAVITY_MPS2,
    FreeMotion,
    Phase,
    Resistance,
    Surface,
    free_motion,
)

MOST = 160
"""Of a longer path so many places are fitted [1]."""

SLIDES_S = 0.1
"""A slide that is shorter says nothing of damping [s]."""

NEAR_M = 0.015
"""A thing that is so near a surface slides on it or lands [m]."""

LANDS_MPS = 0.15
"""A landing at less than this is none [m/s]."""

EARLY_S = 0.04
"""How far from the frame of contact a blow may be in truth [s]."""

BEGINNINGS = (0.0, -0.5, 0.5)
"""Where the search for the time of a blow begins, as shares of how far that may be off [1]."""

DAMPING, BOUNCE = 2.0, 0.4
"""Where the fit begins [1/s], [1]."""

LATE_DAMPING = 40.0
"""The largest that is tried [1/s]."""

GRID = 11
"""Values that are tried before the best is refined [1]."""


@dataclass(frozen=True, eq=False)
class Fit:
    """What a path says of a thing that moves on alone."""

    start_s: float
    position: Float[np.ndarray, "3"]
    velocity: Float[np.ndarray, "3"]
    damping: tuple[float, float] | None
    bounce: float | None
    residual_m: float
    motion: FreeMotion
    """At the fitted times."""


def fit_free_motion(
    times: Float[np.ndarray, "frames"],
    places: Float[np.ndarray, "frames 3"],
    *,
    rested: Float[np.ndarray, "3"] | None,
    half: Float[np.ndarray, "3"],
    surfaces: Sequence[Surface],
) -> Fit | None:
    """The motion from rest or from the hand that fits a path best, by least squares.

    What is closed form is fitted first: the slide, or the flight to the first landing. How it
    bounces, and its damping where it slides only later, are fitted over the integrated motion.

    Args:
        times: From the frame of contact on [s].
        places: Of the thing's middle, as recorded [m].
        rested: Where its middle rested until about the first time [m]; None of a thing that was
            let go in motion.
        half: Half of its lengths along the world's axes [m].
        surfaces: What may bear it.

    Returns:
        None where the path is too short.
    """
    known = ~np.isnan(places[:, 0])
    if known.sum() < FEWEST:
        return None
    clock, path = _thinned(times[known], places[known])
    level = _level(clock, path, rested, half, surfaces)
    if level is None:
        begin, damping = _flight(clock, path, half, surfaces), None
    else:
        begin, damping = _slide(clock, path, rested, level)
    if begin is None:
        return None
    course = _Course(clock, path, begin, half, surfaces)
    late, bounce = course.resistance(damping)
    motion = course.motion(late, bounce)
    off = np.linalg.norm(motion.positions - path, axis=1)
    return Fit(
        start_s=float(begin.start_s),
        position=begin.place,
        velocity=begin.velocity,
        damping=late if _slid_s(motion, clock) >= SLIDES_S else None,
        bounce=bounce if _lands(motion) else None,
        residual_m=float(np.sqrt(np.mean(off**2))),
        motion=motion,
    )


@dataclass(frozen=True, eq=False)
class _Begin:
    """Where and how fast a thing is when it begins to move alone."""

    start_s: float
    place: Float[np.ndarray, "3"]
    velocity: Float[np.ndarray, "3"]


@dataclass(frozen=True, eq=False)
class _Course:
    """A recorded path and where it begins."""

    times: Float[np.ndarray, "frames"]
    places: Float[np.ndarray, "frames 3"]
    begin: _Begin
    half: Float[np.ndarray, "3"]
    surfaces: Sequence[Surface]

    def motion(self, damping: tuple[float, float], bounce: float) -> FreeMotion:
        """The integrated motion at the recorded times."""
        begin = self.begin
        after = self.times > begin.start_s
        found = free_motion(
            begin.place,
            begin.velocity,
            np.concatenate([[begin.start_s], self.times[after]]),
            half=self.half,
            surfaces=self.surfaces,
            resistance=Resistance(damping, bounce),
        )
        before = np.tile(begin.place, (int((~after).sum()), 1))
        return FreeMotion(
            np.concatenate([before, found.positions[1:]]),
            np.concatenate([np.zeros_like(before), found.velocities[1:]]),
            found.phases,
        )

    def resistance(self, damping: tuple[float, float] | None) -> tuple[tuple[float, float], float]:
        """Damping, if that is not known, and bounce, each with the other as it was found."""
        late, bounce = damping or (DAMPING, DAMPING), BOUNCE
        for _ in range(1 if damping else 2):
            motion = self.motion(late, bounce)
            if _lands(motion):
                bounce = _least(partial(self._miss_of_bounce, late), 0.0, 1.0)
            if damping is None and _slid_s(motion, self.times) >= SLIDES_S:
                value = _least(partial(self._miss_of_damping, bounce), 0.0, LATE_DAMPING)
                late = value, value
        return late, bounce

    def _miss_of_bounce(self, damping: tuple[float, float], bounce: float) -> float:
        """Mean square distance of heights, which damping does not change [m^2]."""
        off = self.motion(damping, bounce).positions[:, 2] - self.places[:, 2]
        return float(np.mean(off**2))

    def _miss_of_damping(self, bounce: float, damping: float) -> float:
        """Mean square distance on the level [m^2]."""
        off = self.motion((damping, damping), bounce).positions[:, :2] - self.places[:, :2]
        return float(np.mean(off**2))


def _level(
    times: Float[np.ndarray, "frames"],
    places: Float[np.ndarray, "frames 3"],
    rested: Float[np.ndarray, "3"] | None,
    half: Float[np.ndarray, "3"],
    surfaces: Sequence[Surface],
) -> float | None:
    """The height of the middle of a thing that begins on a surface and stays on it [m]."""
    early = times <= times[0] + SLIDES_S
    now = float(np.median(places[early, 2]))
    height = now if rested is None else float(rested[2])
    for surface in surfaces:
        middle = surface.top_m + float(half[2])
        if max(abs(height - middle), abs(now - middle)) < NEAR_M:
            return middle
    return None


def _slide(
    times: Float[np.ndarray, "frames"],
    places: Float[np.ndarray, "frames 3"],
    rested: Float[np.ndarray, "3"] | None,
    level: float,
) -> tuple[_Begin | None, tuple[float, float] | None]:
    """Start, velocity and damping of a slide: x = x0 + v (1 - exp(-k t)) / k along each axis."""
    from scipy.optimize import least_squares

    off = np.flatnonzero(np.abs(places[:, 2] - level) > NEAR_M)
    last = int(off[0]) if len(off) else len(times)
    if last < FEWEST:
        return None, None
    clock, path = times[:last], places[:last, :2]
    early = clock <= clock[0] + 2.0 * EARLY_S
    early[:FEWEST] = True
    pace = velocity_at(clock[early], places[:last][early], float(clock[0]), degree=1)[:2]
    apart = bool(np.abs(pace).min() >= ALONG * np.linalg.norm(pace))
    origin = path[0] if rested is None else rested[:2]

    def values(units: Float[np.ndarray, "7"]) -> tuple[float, np.ndarray, np.ndarray, np.ndarray]:
        start, place, speed = 0.0, origin, pace + units[1:3]
        if rested is None:
            place = origin + 0.01 * units[5:7]
        else:
            start = 0.01 * units[0]
        damping = np.maximum(np.array([units[3], units[4] if apart else units[3]]), 1e-6)
        return start, place, speed, damping

    def residuals(units: Float[np.ndarray, "7"]) -> Float[np.ndarray, "rows"]:
        start, place, speed, damping = values(units)
        past = np.maximum(clock - clock[0] - start, 0.0)[:, None]
        return np.asarray((place + speed * -np.expm1(-damping * past) / damping - path).ravel())

    reach = EARLY_S / 0.01
    low = np.array([-reach, -3.0, -3.0, 1e-6, 1e-6, -5.0, -5.0])
    high = np.array([reach, 3.0, 3.0, LATE_DAMPING, LATE_DAMPING, 5.0, 5.0])
    # Before the blow nothing depends on its time, so that a search can stop short of the best one.
    guesses = [
        np.array([share * reach, 0.0, 0.0, DAMPING, DAMPING, 0.0, 0.0]) for share in BEGINNINGS
    ]
    scale = np.maximum(guesses[0], 0.1)
    fits = [least_squares(residuals, guess, bounds=(low, high), x_scale=scale) for guess in guesses]
    start, place, speed, damping = values(min(fits, key=lambda fit: float(fit.cost)).x)
    begin = _Begin(float(clock[0]) + start, np.array([*place, level]), np.array([*speed, 0.0]))
    long = clock[-1] - begin.start_s >= SLIDES_S
    return begin, (float(damping[0]), float(damping[1])) if long else None


def _flight(
    times: Float[np.ndarray, "frames"],
    places: Float[np.ndarray, "frames 3"],
    half: Float[np.ndarray, "3"],
    surfaces: Sequence[Surface],
) -> _Begin | None:
    """Place and velocity of a thing in the air, by the flight to its first landing."""
    last = len(times)
    for surface in surfaces:
        low = places[:, 2] - half[2] - surface.top_m
        near, far = places[:, :2] - half[:2], places[:, :2] + half[:2]
        inside = (far > surface.low) & (near < surface.high)
        lands = np.flatnonzero((np.abs(low) < NEAR_M) & inside.all(axis=1))
        last = min(last, int(lands[0])) if len(lands) else last
    if last < FEWEST:
        return None
    past = times[:last] - times[0]
    fallen = places[:last] + np.outer(0.5 * GRAVITY_MPS2 * past**2, [0.0, 0.0, 1.0])
    powers = np.stack([np.ones_like(past), past], axis=1)
    place, pace = np.linalg.lstsq(powers, fallen, rcond=None)[0]
    return _Begin(float(times[0]), np.asarray(place), np.asarray(pace))


def _least(miss: Callable[[float], float], low: float, high: float) -> float:
    """Where a function of one number is least: the best of a grid, refined."""
    from scipy.optimize import minimize_scalar

    grid = np.linspace(low, high, GRID)
    best = int(np.argmin([miss(float(value)) for value in grid]))
    step = grid[1] - grid[0]
    around = max(low, grid[best] - step), min(high, grid[best] + step)
    return float(minimize_scalar(miss, bounds=around, method="bounded", options={"xatol": 1e-4}).x)


def _lands(motion: FreeMotion) -> bool:
    """Whether it fell on something while it was followed."""
    down = motion.velocities[:, 2] < -LANDS_MPS
    return bool((down[:-1] & (motion.velocities[1:, 2] >= 0.0)).any())


def _slid_s(motion: FreeMotion, times: Float[np.ndarray, "frames"]) -> float:
    """How long it slid [s]."""
    starts = [*(at for at, _ in motion.phases), float(times[-1])]
    spans = ((phase, starts[n + 1] - at) for n, (at, phase) in enumerate(motion.phases))
    return sum(span for phase, span in spans if phase is Phase.SLIDES)


def _thinned(
    times: Float[np.ndarray, "frames"], places: Float[np.ndarray, "frames 3"]
) -> tuple[Float[np.ndarray, "some"], Float[np.ndarray, "some 3"]]:
    step = max(1, -(-len(times) // MOST))
    return times[::step], places[::step]
