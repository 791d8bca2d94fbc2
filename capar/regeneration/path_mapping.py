"""A recorded path led from another start to another goal, with its shape and its timing."""

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float
from scipy.spatial.transform import RigidTransform, Rotation

from capar.regeneration.replayed_reaches import CoordinateError, frame_between, replayed
from capar.regeneration.style_kinds import Kind

SHORT_M = 0.05
"""A shorter way from start to goal has no direction of its own [m]."""

SMALLEST_M = 1e-6
"""Added to the way of every frame, so that time is a function of the way [m]."""


NOWHERE = (np.zeros(3), np.zeros(3))
"""No direction off anything, at either end."""

PEAK = 256.0 / 27.0
"""Makes the largest value of s (1 - s)^3 one [1]."""


@dataclass(frozen=True)
class Detour:
    """What is added to a path between its ends so that it clears the scene."""

    lift_m: float = 0.0
    """How far it is lifted half-way [m]."""

    back_m: float = 0.0
    """How far it is drawn back, towards the performer, half-way [m]."""

    off_m: float = 0.0
    """How far a hand draws off what it leaves, and keeps off what it comes to, at most [m]."""

    @property
    def size(self) -> float:
        """How far it leads away from the path [m]."""
        return self.lift_m + self.back_m + self.off_m

    def offset(
        self,
        shares: Float[np.ndarray, "frames"],
        heading: float,
        away: tuple[Float[np.ndarray, "3"], Float[np.ndarray, "3"]] = NOWHERE,
    ) -> Float[np.ndarray, "frames 3"]:
        """The added displacement at shares of the way [m].

        Args:
            shares: Of the way [1].
            heading: Which way the performer faces [rad].
            away: Directions off what is left at the start and off what is reached at the goal.
        """
        back = self.back_m * np.array([-np.cos(heading), -np.sin(heading), 0.0])
        bump = 4.0 * shares * (1.0 - shares)
        out = np.outer(bump, back + np.array([0.0, 0.0, self.lift_m]))
        left, right = PEAK * shares * (1.0 - shares) ** 3, PEAK * shares**3 * (1.0 - shares)
        return np.asarray(out + self.off_m * (np.outer(left, away[0]) + np.outer(right, away[1])))


STRAIGHT = Detour()


def way(positions: Float[np.ndarray, "frames 3"]) -> Float[np.ndarray, "frames"]:
    """Length of the path up to each frame [m], strictly increasing."""
    steps = np.linalg.norm(np.diff(positions, axis=0), axis=1) + SMALLEST_M
    return np.concatenate([[0.0], np.cumsum(steps)])


def arc_shares(positions: Float[np.ndarray, "frames 3"]) -> Float[np.ndarray, "frames"]:
    """Share of the way covered at each frame: VelStyle of the path (thesis eq. 4.1) [1]."""
    covered = way(positions)
    return np.asarray(covered / covered[-1])


def mapped(
    path: RigidTransform,
    start: RigidTransform,
    goal: RigidTransform,
    *,
    turn: float = 0.0,
    detour: Detour = STRAIGHT,
    heading: float = 0.0,
    away: tuple[Float[np.ndarray, "3"], Float[np.ndarray, "3"]] = NOWHERE,
    kind: Kind = Kind.PATH,
) -> RigidTransform:
    """A path with other ends.

    What deviates from the straight way is kept in metres and turned with the way; the share of
    the path's length that is covered at each frame stays the same.

    Args:
        path: As it was recorded; the last frame is the goal's.
        start: Where the new one begins.
        goal: Where it ends.
        turn: How far the deviations are turned about z where the way has no direction [rad].
        detour: What is added between the ends.
        heading: Which way the performer faces [rad].
        away: Directions in which a detour draws off, at the start and at the goal.
        kind: What of the path is kept.
    """
    old = path.translation
    shares = arc_shares(old) if kind is not Kind.EVEN else minimum_jerk(len(path))
    straight = kind in {Kind.VEL, Kind.EVEN}
    along = shares if straight else _along(old, shares)
    chord, new = old[-1] - old[0], goal.translation - start.translation
    angle = _turn(chord, new, turn)
    about = Rotation.from_euler("z", angle)
    aside = about.apply(old - old[0] - np.outer(along, chord))
    if straight:
        aside = np.zeros_like(old)
    elif kind is Kind.FRAME:
        aside = _in_frames(old, start.translation, goal.translation, along, new, aside)
    spots = start.translation + np.outer(along, new) + aside
    spots = spots + detour.offset(shares, heading, away)
    spots = retimed(spots, shares)
    return RigidTransform.from_components(
        spots, _turns(path.rotation, start.rotation, goal.rotation, shares, about)
    )


def minimum_jerk(frames: int) -> Float[np.ndarray, "frames"]:
    """Shares of the way with the least jerk (Flash & Hogan 1985) [1]."""
    s = np.linspace(0.0, 1.0, frames)
    return np.asarray(s**3 * (10.0 - 15.0 * s + 6.0 * s * s))


def _in_frames(
    old: Float[np.ndarray, "frames 3"],
    start: Float[np.ndarray, "3"],
    goal: Float[np.ndarray, "3"],
    along: Float[np.ndarray, "frames"],
    new: Float[np.ndarray, "3"],
    usual: Float[np.ndarray, "frames 3"],
) -> Float[np.ndarray, "frames 3"]:
    """What deviates from the straight way in the frame of object and hand; as usual without one."""
    try:
        before, after = frame_between(old[-1], old[0]), frame_between(goal, start)
    except CoordinateError:
        return usual
    return np.asarray(replayed(old, before, after) - start - np.outer(along, new))


def _along(
    old: Float[np.ndarray, "frames 3"], shares: Float[np.ndarray, "frames"]
) -> Float[np.ndarray, "frames"]:
    """How far along the straight way each frame is; by the path's length where that is short."""
    chord = old[-1] - old[0]
    length = float(np.linalg.norm(chord))
    return np.asarray((old - old[0]) @ chord / length**2) if length > SHORT_M else shares


def _turn(old: Float[np.ndarray, "3"], new: Float[np.ndarray, "3"], usual: float) -> float:
    """How far the way has turned about z [rad]."""
    if min(np.hypot(*old[:2]), np.hypot(*new[:2])) < SHORT_M:
        return usual
    return float(np.arctan2(new[1], new[0]) - np.arctan2(old[1], old[0]))


def retimed(
    spots: Float[np.ndarray, "frames 3"], shares: Float[np.ndarray, "frames"]
) -> Float[np.ndarray, "frames 3"]:
    """The same path with a given share of its length covered at each frame.

    Args:
        spots: Of the path [m].
        shares: Of its length [1], from 0 to 1.
    """
    covered = arc_shares(spots)
    return np.stack([np.interp(shares, covered, column) for column in spots.T], axis=1)


def _turns(
    old: Rotation,
    first: Rotation,
    last: Rotation,
    shares: Float[np.ndarray, "frames"],
    about: Rotation,
) -> Rotation:
    """The old deviations from an even turn, on the even turn between the new ends."""
    deviation = old * _even(old[0], old[-1], shares).inv()
    return about * deviation * about.inv() * _even(first, last, shares)


def _even(first: Rotation, last: Rotation, shares: Float[np.ndarray, "frames"]) -> Rotation:
    axis = (last * first.inv()).as_rotvec()
    return Rotation.from_rotvec(np.outer(shares, axis)) * first
