"""Contact of two surfaces at many poses in turn, from questions at few of them.

A question at one pose tells of its neighbours as well. A point of one surface that is well within
the distance of the other stays so while it hardly moves: those poses touch. Surfaces that are
further apart than the distance by some room stay apart while no point moves by that room: those
do not touch. Only poses that neither tells of are asked about, so the answer is as exact as if
each had been.
"""

from dataclasses import dataclass, field

import fcl
import numpy as np
from jaxtyping import Bool, Float, Int

from extractors.shells import EXACTNESS_M
from extractors.surfaces import Surface

ROOMS_M = (0.002, 0.006, 0.018, 0.054, 0.162)
"""Rooms beyond the distance that are asked for [m], each by a shell of its own."""

ROOM_EXACTNESS = 0.05
"""How coarse the shell of a room may be, as a share of its distance [1]."""

LONGEST, SHORTEST = 8192, 32
"""Most and fewest poses that one answer is carried to [1]."""

PATIENCE = 4
"""Answers in turn that tell of no other pose before a distance is asked for, ten times dearer."""

_UNKNOWN, _APART, _TOUCHES = 0, 1, 2


def sweep(
    first: Surface,
    second: Surface,
    turns: Float[np.ndarray, "poses 3 3"],
    places: Float[np.ndarray, "poses 3"],
    *,
    distance_m: float,
) -> Bool[np.ndarray, "poses"]:
    """Whether the second surface comes within a distance of the first, at each pose.

    Args:
        first: The surface that stands, the simpler one for speed.
        second: The surface that moves.
        turns: Rotation matrices of ``T_first_second``.
        places: Its places [m].
        distance_m: Distance up to which they touch [m], kept to 0.04 mm.
    """
    if not len(places):
        return np.zeros(0, dtype=bool)
    return _Sweep(first, second, turns, places, distance_m).run()


@dataclass(eq=False)
class _Sweep:
    """One sweep under way."""

    first: Surface
    second: Surface
    turns: Float[np.ndarray, "poses 3 3"]
    places: Float[np.ndarray, "poses 3"]
    distance_m: float
    level: int = 0
    known: Int[np.ndarray, "poses"] = field(init=False)

    def __post_init__(self) -> None:
        self.known = np.zeros(len(self.places), dtype=np.int8)
        self.moved = fcl.CollisionObject(self.second.tree)
        self.ask = fcl.CollisionRequest(enable_contact=True)
        self.bare = fcl.CollisionObject(self.first.tree)
        self.idle, self.patience = 0, PATIENCE
        self.stand: dict[float, fcl.CollisionObject] = {0.0: self.bare}
        self.flat = self.turns.reshape(-1, 9)
        if self.first.radius < self.second.radius:
            back = np.swapaxes(self.turns, 1, 2)
            self.centres = (back @ (self.first.centre - self.places)[..., None])[..., 0]
        else:
            self.centres = self.turns @ self.second.centre + self.places
        # Half of a rotation's chord: the distance of matrices is sqrt(8) sin(angle / 2).
        self.arm = min(self.first.radius, self.second.radius) / np.sqrt(2.0)

    def run(self) -> Bool[np.ndarray, "poses"]:
        """Ask about each pose that no answer tells of."""
        index, reach, touched = 0, SHORTEST, False
        count = len(self.known)
        while index < count:
            self.moved.setTransform(fcl.Transform(self.turns[index], self.places[index]))
            point, slack = self._touch() if touched else self._room()
            touched = point is not None
            self.known[index] = _TOUCHES if touched else _APART
            end = min(index + 1 + reach, count)
            carried = slack > 0.0 and self._carry(index, end, point, slack)
            if not carried and self._patience():
                exact, slack = self._distance()
                carried = slack > 0.0 and self._carry(index, end, exact, slack)
                self.patience = PATIENCE if carried else 4 * self.patience
            self.idle = 0 if carried else self.idle + 1
            rest = np.flatnonzero(self.known[index + 1 : end] == _UNKNOWN)
            if rest.size:
                reach = max(SHORTEST, 2 * int(rest[0]))
                index += 1 + int(rest[0])
            else:
                reach, index = min(2 * reach, LONGEST), end
        return self.known == _TOUCHES

    def _touch(self) -> tuple[Float[np.ndarray, "3"] | None, float]:
        """A point of the second within the distance, and how far it may move [m]; deepest first."""
        for share in (0.0, 0.5, 1.0):
            point = self._meet(share * self.distance_m, EXACTNESS_M)
            if point is not None:
                return point, (1.0 - share) * self.distance_m - 2.0 * EXACTNESS_M
        return None, 0.0

    def _room(self) -> tuple[Float[np.ndarray, "3"] | None, float]:
        """How far all may move without touching [m], or else a point as ``_touch`` gives."""
        for level in range(self.level, -1, -1):
            distance = self.distance_m + ROOMS_M[level]
            exact = max(ROOM_EXACTNESS * distance, EXACTNESS_M)
            if self._meet(distance, exact) is None:
                self.level = min(level + 1, len(ROOMS_M) - 1)
                return None, ROOMS_M[level] - 2.0 * exact
        self.level = 0
        return self._touch()

    def _meet(self, distance_m: float, exactness_m: float) -> Float[np.ndarray, "3"] | None:
        """A point at which the second meets the first's shell [m], if it does."""
        if distance_m not in self.stand:
            shell = self.first.shell_tree(distance_m, exactness_m=exactness_m)
            self.stand[distance_m] = fcl.CollisionObject(shell)
        result = fcl.CollisionResult()
        if not fcl.collide(self.stand[distance_m], self.moved, self.ask, result):
            return None
        return np.asarray(result.contacts[0].pos)

    def _patience(self) -> bool:
        """Whether so many answers in turn told of no other pose that a distance is worth while."""
        return self.idle >= self.patience

    def _distance(self) -> tuple[Float[np.ndarray, "3"] | None, float]:
        """What ``_touch`` or ``_room`` would say with shells at every distance."""
        result = fcl.DistanceResult()
        request = fcl.DistanceRequest(enable_nearest_points=True)
        apart = fcl.distance(self.bare, self.moved, request, result)
        if apart > self.distance_m:
            return None, apart - self.distance_m - EXACTNESS_M
        point = np.asarray(result.nearest_points[1])
        return point, self.distance_m - max(apart, 0.0) - EXACTNESS_M

    def _carry(
        self, index: int, end: int, point: Float[np.ndarray, "3"] | None, slack_m: float
    ) -> bool:
        """Tell the poses up to an end what the answer at one of them means for them.

        Returns:
            Whether that told of any.
        """
        some = slice(index + 1, end)
        if point is None:
            moved = np.linalg.norm(self.centres[some] - self.centres[index], axis=1)
            moved += self.arm * np.linalg.norm(self.flat[some] - self.flat[index], axis=1)
            answer = _APART
        else:
            own = self.turns[index].T @ (point - self.places[index])
            moved = np.linalg.norm(self.turns[some] @ own + (self.places[some] - point), axis=1)
            answer = _TOUCHES
        told = moved < slack_m
        self.known[some][told] = answer
        return bool(told.any())
