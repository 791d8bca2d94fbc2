"""Contact of two surfaces at many poses in turn, from questions at few of them.

A query at one pose also decides neighbouring poses. A point of one surface that is well within
the distance of the other stays so while it hardly moves: those poses touch. Surfaces that are
further apart than the distance by some room stay apart while no point moves by that room: those
do not touch. Only poses that neither decides are queried. Offset surfaces decide what is clear by
more than they may be off, and distances the rest, so that the answer at a pose is the same
whichever other poses are asked about: a window of a recording is told as the whole is.
"""

from dataclasses import dataclass, field

import fcl
import numpy as np
from jaxtyping import Bool, Float, Int

from extractors.contact.offset_surfaces import EXACTNESS_M
from extractors.contact.surfaces import Surface
from extractors.contact.triangle_intersection import meeting_point

CLEARANCES_M = (0.002, 0.006, 0.018, 0.054, 0.162)
"""Clearances beyond the distance that are tested [m], each by an offset surface of its own."""

CLEARANCE_EXACTNESS = 0.05
"""How coarse the offset surface of a clearance may be, as a share of its distance [1]."""

MOST_POSES, FEWEST_POSES = 8192, 32
"""Most and fewest poses that one answer is carried to [1]."""

FRUITLESS_QUERIES = 4
"""Queries in a row that decide no other pose before a distance is computed, ten times slower."""

FEW = 1000
"""Poses up to which distances cost less than the making of offset surfaces [1]."""

DEPTHS = (0.0, 0.4, 0.75)
"""Offset surfaces on which a point of contact is sought, as shares of the distance [1]; deepest
first. What only a shallower one would meet is measured."""

RESTART_EVERY = 4
"""One in so many such searches begins at the deepest, the others where the last one ended [1]."""

_Meeting = tuple[Float[np.ndarray, "3 3"], Float[np.ndarray, "3 3"]]
"""A triangle of the first's offset surface in its frame, and one of the second in its own [m]."""

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
        distance_m: Distance up to which they touch [m].
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
        self.asked, self.depth = 0, 0
        self.stand: dict[float, tuple[fcl.CollisionObject, np.ndarray]] = {}
        self.index = 0
        corners = self.second.shape.vertices
        self.tips = corners[[*corners.argmin(axis=0), *corners.argmax(axis=0)]]
        self.flat = self.turns.reshape(-1, 9)
        if self.first.radius < self.second.radius:
            back = np.swapaxes(self.turns, 1, 2)
            self.centres = (back @ (self.first.centre - self.places)[..., None])[..., 0]
        else:
            self.centres = self.turns @ self.second.centre + self.places
        # Half of a rotation's chord: the distance of matrices is sqrt(8) sin(angle / 2).
        self.arm = min(self.first.radius, self.second.radius) / np.sqrt(2.0)

    def run(self) -> Bool[np.ndarray, "poses"]:
        """Query each pose that is not decided yet."""
        index, touched, idle, patience = 0, False, 0, FRUITLESS_QUERIES
        few = len(self.known) <= FEW
        while index < len(self.known):
            self.index = index
            self.moved.setTransform(fcl.Transform(self.turns[index], self.places[index]))
            if few:
                point, slack = self._distance()
            else:
                point, slack = self._touch() if touched else self._clearance()
            touched = point is not None
            self.known[index] = _TOUCHES if touched else _APART
            told, index = self._propagate(index, point, slack)
            idle = 0 if told else idle + 1
            if idle >= patience and not few:
                told, index = self._propagate(self.index, *self._distance())
                idle, patience = 0, FRUITLESS_QUERIES if told else 2 * patience
        return self.known == _TOUCHES

    def _touch(self) -> tuple[Float[np.ndarray, "3"] | None, float]:
        """A point of the second within the distance, and how far it may move [m]; deepest first.

        Where nothing is so deep, what ``_distance`` says.
        """
        self.asked += 1
        for depth in range(0 if self.asked % RESTART_EVERY == 0 else self.depth, len(DEPTHS)):
            meeting = self._meet(DEPTHS[depth] * self.distance_m, EXACTNESS_M)
            if meeting is not None:
                self.depth = depth
                within_m = (1.0 - DEPTHS[depth]) * self.distance_m
                return self._point(meeting), within_m - 2.0 * EXACTNESS_M
        return self._distance()

    def _clearance(self) -> tuple[Float[np.ndarray, "3"] | None, float]:
        """How far all may move without touching [m], or else a point as ``_touch`` gives."""
        for level in range(self.level, -1, -1):
            distance = self.distance_m + CLEARANCES_M[level]
            exact = max(CLEARANCE_EXACTNESS * distance, EXACTNESS_M)
            if self._meet(distance, exact) is None:
                if not self._sticks_out(distance):
                    return self._distance()
                self.level = min(level + 1, len(CLEARANCES_M) - 1)
                return None, CLEARANCES_M[level] - 2.0 * exact
        # What has just come near is shallow.
        self.level, self.depth, self.asked = 0, len(DEPTHS) - 1, 0
        return self._touch()

    def _sticks_out(self, distance_m: float) -> bool:
        """Whether some point of the second is beyond the first's offset surface for certain.

        What lies wholly between the offset surface and the first does not cut it either.
        """
        turn, place = self.turns[self.index], self.places[self.index]
        apart = np.linalg.norm(self.tips @ turn.T + place - self.first.centre, axis=1)
        return bool(apart.max() > self.first.radius + distance_m)

    def _meet(self, distance_m: float, exactness_m: float) -> _Meeting | None:
        """Which triangle of the second meets the first's offset surface, if one does."""
        if distance_m not in self.stand:
            offset = self.first.offset(distance_m, exactness_m=exactness_m)
            self.stand[distance_m] = fcl.CollisionObject(offset.tree), offset.triangles
        stands, triangles = self.stand[distance_m]
        result = fcl.CollisionResult()
        if not fcl.collide(stands, self.moved, self.ask, result):
            return None
        found = result.contacts[0]
        return triangles[found.b1], self.second.triangles[found.b2]

    def _point(self, meeting: _Meeting) -> Float[np.ndarray, "3"]:
        """A point at which two triangles meet [m]; NaN where they only lie on each other.

        The library's own point need not lie on both.
        """
        standing, own = meeting
        moved = own @ self.turns[self.index].T + self.places[self.index]
        point = meeting_point(standing.tolist(), moved.tolist())
        return np.full(3, np.nan) if point is None else np.array(point)

    def _distance(self) -> tuple[Float[np.ndarray, "3"] | None, float]:
        """What ``_touch`` or ``_clearance`` would say with offset surfaces at every distance."""
        # Surfaces that cut each other share points, which tell more poses than a distance of zero.
        meeting = self._meet(0.0, EXACTNESS_M)
        if meeting is not None:
            return self._point(meeting), self.distance_m - 2.0 * EXACTNESS_M
        result = fcl.DistanceResult()
        request = fcl.DistanceRequest(enable_nearest_points=True)
        apart = fcl.distance(self.bare, self.moved, request, result)
        if apart > self.distance_m:
            return None, apart - self.distance_m - EXACTNESS_M
        # Nearest points of surfaces that cut each other mean nothing, so they carry nowhere.
        slack = self.distance_m - apart - EXACTNESS_M if apart > 0.0 else 0.0
        return np.asarray(result.nearest_points[1]), slack

    def _propagate(
        self, index: int, point: Float[np.ndarray, "3"] | None, slack_m: float
    ) -> tuple[int, int]:
        """Decide later poses from the answer at one pose, as far as it reaches.

        Returns:
            How many it told of, and the first pose that is still unknown.
        """
        begin, length, told = index + 1, FEWEST_POSES, 0
        own = None if point is None else self.turns[index].T @ (point - self.places[index])
        while begin < len(self.known):
            part = slice(begin, begin + length)
            unknown = self.known[part] == _UNKNOWN
            if slack_m > 0.0:
                hit = self._moved(part, index, own, point) < slack_m
                self.known[part][hit] = _APART if point is None else _TOUCHES
                told += int(np.count_nonzero(hit))
                unknown &= ~hit
            first = int(unknown.argmax())
            if unknown[first]:
                return told, begin + first
            begin, length = begin + length, min(2 * length, MOST_POSES)
        return told, len(self.known)

    def _moved(
        self,
        part: slice,
        index: int,
        own: Float[np.ndarray, "3"] | None,
        point: Float[np.ndarray, "3"] | None,
    ) -> Float[np.ndarray, "part"]:
        """How far a point of the second, or else any point, has moved since a pose [m]."""
        if own is None or point is None:
            away = np.linalg.norm(self.centres[part] - self.centres[index], axis=1)
            turned = np.linalg.norm(self.flat[part] - self.flat[index], axis=1)
            return np.asarray(away + self.arm * turned)
        return np.linalg.norm(self.turns[part] @ own + (self.places[part] - point), axis=1)
