"""Reaches in the frames of object and hand, or of object and shoulder, replayed for new goals.

Ben Amor, Weber, Heumer & Jung 2007, *Coordinate System Transformations for Imitation of
Goal-Directed Trajectories in Virtual Humans*, eq. 1.
"""

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from capar.regeneration.errors import PlanError

SHORTEST_M = 0.02
"""Object and hand or shoulder that are nearer have no direction between them [m]."""

UPRIGHT = 0.02
"""Sine of the angle to the vertical below which x has no direction [1]."""


class CoordinateError(PlanError):
    """Two points that do not span a frame."""


@dataclass(frozen=True, eq=False)
class SpanFrame:
    """A frame from an object to a hand or shoulder, with the distance as its unit."""

    origin: Float[np.ndarray, "3"]
    """The object [m]."""

    axes: Float[np.ndarray, "3 3"]
    """Columns x, y and z in the world; z leads from the object to the hand or shoulder.

    Left-handed, as the paper's equation has it; from one frame into another nothing is mirrored.
    """

    length_m: float
    """Between the two [m]."""


def frame_between(
    goal: Float[np.ndarray, "3"],
    base: Float[np.ndarray, "3"],
    *,
    aside: Float[np.ndarray, "3"] | None = None,
) -> SpanFrame:
    """The frame of an object and a hand or shoulder: z = base - goal, x = z x up, y = x x z.

    Args:
        goal: The object [m].
        base: The hand at the start, or the shoulder [m].
        aside: Takes the place of x where z is vertical.

    Raises:
        CoordinateError: The points are too near, or above each other without an ``aside``.
    """
    way = np.asarray(base) - np.asarray(goal)
    length = float(np.linalg.norm(way))
    if length < SHORTEST_M:
        raise CoordinateError(f"object and hand are {1e3 * length:.0f} mm apart: no direction")
    z = way / length
    x = np.cross(z, [0.0, 0.0, 1.0])
    if np.linalg.norm(x) < UPRIGHT:
        if aside is None:
            raise CoordinateError("one is above the other, so that x has no direction; say which")
        x = aside - (aside @ z) * z
    x = x / np.linalg.norm(x)
    return SpanFrame(np.asarray(goal), np.stack([x, np.cross(x, z), z], axis=1), length)


def replayed(
    path: Float[np.ndarray, "frames 3"], before: SpanFrame, after: SpanFrame
) -> Float[np.ndarray, "frames 3"]:
    """A path turned and enlarged from one frame into another [m]."""
    local = (path - before.origin) @ before.axes / before.length_m
    return np.asarray(after.origin + after.length_m * local @ after.axes.T)


@dataclass(frozen=True, eq=False)
class Replay:
    """One reach replayed for one goal in both frames."""

    goal: Float[np.ndarray, "3"]
    by_hand: Float[np.ndarray, "frames 3"]
    by_shoulder: Float[np.ndarray, "frames 3"]

    def gaps(self, hand: Float[np.ndarray, "3"]) -> tuple[float, float]:
        """How far each replay begins from where the hand is [m]."""
        ways = self.by_hand, self.by_shoulder
        first, second = (np.linalg.norm(way[0] - hand) for way in ways)
        return float(first), float(second)

    @property
    def misses(self) -> tuple[float, float]:
        """How far each ends from where the recorded hand was beside its object [m]."""
        ways = self.by_hand, self.by_shoulder
        first, second = (np.linalg.norm(way[-1] - self.goal) for way in ways)
        return float(first), float(second)


def replays(
    path: Float[np.ndarray, "frames 3"],
    shoulder: Float[np.ndarray, "3"],
    goals: Float[np.ndarray, "goals 3"],
    *,
    hand: Float[np.ndarray, "3"] | None = None,
) -> list[Replay]:
    """A reach for new goals, as Fig. 2 of the paper plots it.

    Args:
        path: Of the hand, ending at the object [m].
        shoulder: Where the shoulder is [m].
        goals: Where the object is instead [m].
        hand: Where the hand starts instead; as recorded unless stated [m].

    Raises:
        CoordinateError: Two points do not span a frame.
    """
    start = path[0] if hand is None else hand
    by_hand, by_shoulder = frame_between(path[-1], path[0]), frame_between(path[-1], shoulder)
    return [
        Replay(
            goal,
            replayed(path, by_hand, frame_between(goal, start)),
            replayed(path, by_shoulder, frame_between(goal, shoulder)),
        )
        for goal in goals
    ]
