"""What a thing's own motion says of the force that set it going, and of what slows it."""

from dataclasses import dataclass

Vector = tuple[float, float, float]


@dataclass(frozen=True, slots=True)
class ForceStyle:
    """How an end-effector set a thing going that then moved on alone (thesis 3.4.3, Fig 4.13)."""

    object: str
    ee: str
    start_s: float
    """When it was struck or let go [s]."""

    end_s: float
    """Until when its motion was followed [s]."""

    struck: bool
    """Whether it was at rest before; else it was let go in motion."""

    position_m: Vector
    """Of its box's middle at the start [m]."""

    velocity_mps: Vector
    """Of the thing, just after the start [m/s]."""

    striker_mps: Vector
    """Of the end-effector, just before [m/s]."""

    follow_mps: Vector
    """Of the end-effector, just after [m/s]."""

    restitution: float | None
    """Between end-effector and thing, along the line of impact (eq. 3.5) [1]; None of a thing that
    was let go."""

    damping_per_s: tuple[float, float] | None
    """Deceleration over speed while it slid, along x and y [1/s]; None if it did not slide."""

    thesis_damping: tuple[float, float] | None
    """Slope of acceleration over velocity against time (eq. 3.9), the thesis's damping [1/s^2]."""

    bounce: float | None
    """Restitution between the thing and what it fell on [1]; None if it did not bounce."""

    impulse_ns: Vector | None
    """Momentum that it was given [N s]; None where its mass is not stated."""

    residual_m: float
    """Root mean square distance of its recorded places from the fitted motion [m]."""
