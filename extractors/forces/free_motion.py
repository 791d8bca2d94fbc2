"""How a thing moves on when nothing holds it: it slides, passes an edge, falls, bounces, rests.

The thing keeps its orientation (thesis 3.4.3.4: its torques are zero after the impact), so only its
lowest level and its footprint matter: a thing stays on a surface while any of it is above that.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from enum import StrEnum

import numpy as np
from jaxtyping import Float

from capar.model.geometry import Vector

GRAVITY_MPS2 = 9.81
"""Standard acceleration of free fall, rounded [m/s^2]."""

REST_MPS = 0.01
"""A sliding thing that is slower rests [m/s]."""

SETTLES_MPS = 0.05
"""A thing that would leave a surface more slowly stays on it [m/s]."""

TOLERANCE = 1e-7
"""Relative and absolute error of the integration [1]."""

MOST_PHASES = 60
"""More would be a fault: at each bounce the thing gets slower [1]."""


LEAVES = 1
"""Which of the ends of a slide is the edge."""


class Phase(StrEnum):
    """What a thing does that nothing holds."""

    SLIDES = "slides"
    FALLS = "falls"
    RESTS = "rests"


@dataclass(frozen=True)
class Surface:
    """A level rectangle that bears things."""

    top_m: float
    """Its height [m]."""

    low: tuple[float, float] = (-np.inf, -np.inf)
    high: tuple[float, float] = (np.inf, np.inf)
    """Its corners along x and y [m]; the ground has none."""


@dataclass(frozen=True)
class Resistance:
    """What takes speed from a thing that nothing holds."""

    damping: tuple[float, float]
    """Deceleration over speed while it slides, along x and along y [1/s]."""

    bounce: float
    """Coefficient of restitution on surfaces [1]."""


@dataclass(frozen=True, eq=False)
class FreeMotion:
    """A thing's way at some times, and what it did."""

    positions: Float[np.ndarray, "times 3"]
    """Of its middle [m]."""

    velocities: Float[np.ndarray, "times 3"]
    """[m/s]."""

    phases: tuple[tuple[float, Phase], ...]
    """When each began [s]."""


State = Float[np.ndarray, "6"]


def free_motion(
    place: Vector,
    velocity: Vector,
    times: Float[np.ndarray, "times"],
    *,
    half: Vector,
    surfaces: Sequence[Surface],
    resistance: Resistance,
) -> FreeMotion:
    """The way of a thing from a place and a velocity, by Runge-Kutta with events.

    ``place``: its middle at the first time [m]. ``velocity``: then [m/s]. ``half``: half of its
    lengths along the world's axes [m]. ``surfaces``: what may bear it. ``resistance``: what takes
    its speed.
    """
    from scipy.integrate import solve_ivp  # takes long to import, and few captures need it

    out = np.empty((len(times), 6))
    state = np.concatenate([place, velocity]).astype(float)
    now, end = float(times[0]), float(times[-1])
    phases: list[tuple[float, Phase]] = []
    passed: tuple[Surface, ...] = ()
    for _ in range(MOST_PHASES):
        reached = [surface for surface in surfaces if surface not in passed]
        for surface in reached:
            # It is there already, on its way down.
            if abs(state[2] - half[2] - surface.top_m) < 1e-6 and state[5] < 0.0:
                _land(state, half, surface, resistance)
        bearing = _bearing(state, half, reached)
        fast = np.hypot(state[3], state[4]) > REST_MPS
        phase = Phase.FALLS if bearing is None else Phase.SLIDES if fast else Phase.RESTS
        if not phases or phases[-1][1] is not phase:
            phases.append((now, phase))
        at = times >= now
        if phase is Phase.RESTS or now >= end:
            out[at] = np.concatenate([state[:3], np.zeros(3)]) if phase is Phase.RESTS else state
            break
        if phase is Phase.SLIDES:
            assert bearing is not None
            state[2], state[5] = bearing.top_m + half[2], 0.0
            slope, events = _sliding(resistance), _ends_of_slide(bearing, half)
            landings: list[Surface] = []
        else:
            landings = [s for s in reached if s.top_m < state[2] - half[2] + 1e-9]
            slope = _falling
            events = [_landing(surface, half) for surface in landings]
        solved = solve_ivp(
            slope, (now, end), state, events=events, rtol=TOLERANCE, atol=TOLERANCE,
            dense_output=True, method="RK45",
        )  # fmt: skip
        until = float(solved.t[-1])
        inside = at & (times <= until)
        if inside.any():
            out[inside] = solved.sol(times[inside]).T
        now, state = until, solved.y[:, -1].copy()
        if solved.status != 1:
            break
        number = next(n for n, at_s in enumerate(solved.t_events) if len(at_s))
        if bearing is None:
            passed = _land(state, half, landings[number], resistance)
        else:
            passed = (bearing,) if number == LEAVES else ()
            state[3:] *= number == LEAVES
    else:
        out[times >= now] = state
    return FreeMotion(out[:, :3], out[:, 3:], tuple(phases))


def _bearing(state: State, half: Vector, surfaces: Sequence[Surface]) -> Surface | None:
    """What the thing is on; None where it is in the air."""
    for surface in surfaces:
        on = abs(state[2] - half[2] - surface.top_m) < 1e-6 and abs(state[5]) < SETTLES_MPS
        if on and _above(state, half, surface):
            return surface
    return None


def _above(state: State, half: Vector, surface: Surface) -> bool:
    low, high = state[:2] - half[:2], state[:2] + half[:2]
    return bool((high > np.array(surface.low)).all() and (low < np.array(surface.high)).all())


Slope = Callable[[float, State], State]
Event = Callable[[float, State], float]


def _falling(_: float, state: State) -> State:
    return np.concatenate([state[3:], [0.0, 0.0, -GRAVITY_MPS2]])


def _sliding(resistance: Resistance) -> Slope:
    damping = np.array([*resistance.damping, 0.0])

    def slope(_: float, state: State) -> State:
        pace = np.array([state[3], state[4], 0.0])
        return np.concatenate([pace, -damping * pace])

    return slope


def _ends_of_slide(surface: Surface, half: Vector) -> list[Event]:
    """The thing rests, or (``LEAVES``) the last of it is over an edge."""
    low, high = np.array(surface.low) - half[:2], np.array(surface.high) + half[:2]

    def rests(_: float, state: State) -> float:
        return float(np.hypot(state[3], state[4]) - REST_MPS)

    def leaves(_: float, state: State) -> float:
        room = np.minimum(state[:2] - low, high - state[:2]).min()
        return float(min(room, 1e3))

    return [_terminal(rests), _terminal(leaves)]


def _landing(surface: Surface, half: Vector) -> Event:
    def lands(_: float, state: State) -> float:
        # A body that hops off the surface starts above it, whatever the rounding.
        return float(state[2] - half[2] - surface.top_m + 1e-9)

    return _terminal(lands)


def _terminal(event: Event) -> Event:
    event.terminal, event.direction = True, -1.0  # type: ignore[attr-defined]
    return event


def _land(
    state: State, half: Vector, surface: Surface, resistance: Resistance
) -> tuple[Surface, ...]:
    """Turn the speed of a thing that lands; what it passes beside is returned."""
    if not _above(state, half, surface):
        return (surface,)
    state[2] = surface.top_m + half[2]
    back = -resistance.bounce * state[5]
    state[5] = back if back > SETTLES_MPS else 0.0
    return ()
