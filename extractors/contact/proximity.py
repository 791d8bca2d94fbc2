"""How near two bodies are at every frame: exact contact by a sweep over surfaces."""

from collections import defaultdict
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass

import fcl
import numpy as np
from jaxtyping import Bool, Float, Int

from capar.model import geometry
from capar.model.capture import Stream
from capar.model.geometry import Holds, Places, Turns, Vector
from extractors.bodies.bodies import blocks
from extractors.bodies.poses import rotation_matrices
from extractors.contact.surfaces import Surface, meeting_points
from extractors.signals.intervals import Interval

EXACTNESS_M = 0.00004
"""By so much less than its slack an answer is carried to later poses [m]."""

POSES, MOST_POSES = 64, 8192
"""Poses that are decided together, and the most that one answer is carried on to at once [1]."""

KEPT_ANSWERS = 128
"""How many of the latest answers are carried to later poses [1]."""

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

    One query decides other poses, too: bodies that are apart stay so where no point may have moved
    as far (conservative advancement), and touch where their nearest points are near enough. Poses
    return, as those of a grasp do and those of a hand that waits, so that earlier answers are asked
    before the surfaces are.

    ``turns``: rotation matrices of ``T_first_second``. ``places``: its places [m]. ``distance_m``:
    distance up to which they touch [m].
    """
    answers = _Answers(first, second, turns, places, distance_m)
    known, index = answers.known, 0
    while index < len(known):
        window = slice(index, min(index + POSES, len(known)))
        answers.carry(window, slice(min(answers.count, KEPT_ANSWERS)))
        while (unknown := np.flatnonzero(known[window] == _UNKNOWN)).size:
            # The middle one: its answer holds before it and after it.
            answers.ask(index + int(unknown[len(unknown) // 2]))
            answers.carry(window, answers.latest)
        index, length = window.stop, POSES
        while index < len(known):
            part = slice(index, min(index + length, len(known)))
            answers.carry(part, answers.latest)
            unknown = known[part] == _UNKNOWN
            if unknown.any():
                index += int(unknown.argmax())
                break
            index, length = part.stop, min(2 * length, MOST_POSES)
    return np.asarray(known == _TOUCHES)


class _Answers:
    """What is known of two surfaces at each pose, and the latest answers of which."""

    def __init__(
        self,
        first: Surface,
        second: Surface,
        turns: Float[np.ndarray, "poses 3 3"],
        places: Float[np.ndarray, "poses 3"],
        distance_m: float,
    ) -> None:
        """Nothing is known yet."""
        self.first, self.second = first, second
        self.turns, self.places, self.distance_m = turns, places, distance_m
        self.known, self.count = np.zeros(len(places), dtype=np.int8), 0
        if first.radius < second.radius:
            back = np.swapaxes(turns, 1, 2)
            self.centres = (back @ (first.centre - places)[..., None])[..., 0]
        else:
            self.centres = turns @ second.centre + places
        # Half of a rotation's chord: the distance of matrices is sqrt(8) sin(angle / 2).
        self.arm = min(first.radius, second.radius) / np.sqrt(2.0)
        self.poses = np.zeros(KEPT_ANSWERS, dtype=int)
        self.slack_m = np.zeros(KEPT_ANSWERS)
        self.nearest = np.full((2, KEPT_ANSWERS, 3), np.nan)

    @property
    def latest(self) -> slice:
        """The place of the latest answer among those that are kept."""
        place = (self.count - 1) % KEPT_ANSWERS
        return slice(place, place + 1)

    def ask(self, pose: int) -> None:
        """Ask the surfaces at a pose."""
        apart, *nearest = _touch(self.first, self.second, self.turns[pose], self.places[pose])
        self.count += 1
        self.poses[self.latest] = pose
        self.slack_m[self.latest] = apart - self.distance_m - EXACTNESS_M
        self.nearest[:, self.latest.start] = nearest
        self.known[pose] = _APART if apart > self.distance_m else _TOUCHES

    def carry(self, part: slice, some: slice) -> None:
        """Decide poses of a part, as far as some of the answers do."""
        poses = part.start + np.flatnonzero(self.known[part] == _UNKNOWN)
        if not poses.size:
            return
        on_first, on_second = self.nearest[:, some]
        between = self.turns[poses] @ on_second.T + self.places[poses][:, :, None] - on_first.T
        meets = np.sqrt(np.einsum("pik,pik->pk", between, between))
        meets = (meets <= self.distance_m - EXACTNESS_M).any(axis=1)
        self.known[poses[meets]] = _TOUCHES
        asked, slack_m = self.poses[some], self.slack_m[some]
        far = slack_m > 0.0
        asked, slack_m = asked[far], slack_m[far]
        offset = self.centres[poses][:, None] - self.centres[asked]
        moved = np.sqrt(np.einsum("pki,pki->pk", offset, offset))
        flat = self.turns.reshape(-1, 9)
        then, there = flat[poses], flat[asked]
        squares = (then**2).sum(axis=1)[:, None] + (there**2).sum(axis=1)
        moved += self.arm * np.sqrt(np.maximum(squares - 2.0 * then @ there.T, 0.0))
        self.known[poses[(moved < slack_m).any(axis=1)]] = _APART


def _touch(
    first: Surface, second: Surface, turn: Float[np.ndarray, "3 3"], place: Vector
) -> tuple[float, Vector, Vector]:
    """Distance of two surfaces [m], and a point of each that is as near, in its own frame [m].

    Where they cut each other the distance is zero and the points are one; NaN where none is known.
    """
    one, two = fcl.CollisionObject(first.tree), fcl.CollisionObject(second.tree)
    two.setTransform(fcl.Transform(turn, place))
    result = fcl.CollisionResult()
    # Surfaces that cut each other share points, which decide more than a distance of zero.
    if fcl.collide(one, two, fcl.CollisionRequest(enable_contact=True), result):
        found = result.contacts[0]
        moved = second.triangles[[found.b2]] @ turn.T + place
        point = meeting_points(first.triangles[[found.b1]], moved)[0]
        return 0.0, point, turn.T @ (point - place)
    apart, on_first, on_second = _apart(first, second, turn, place)
    if apart <= 0.0:
        return 0.0, on_first, np.full(3, np.nan)
    return apart, on_first, turn.T @ (on_second - place)


@dataclass(frozen=True, eq=False)
class Body:
    """A surface and its pose at every frame, ready for questions."""

    surface: Surface
    positions: Places
    """World positions [m]; NaN where lost."""

    orientations: Turns
    """Unit quaternions w x y z."""

    centres: Places
    """Middle of the body's box in the world [m]."""

    rests: bool
    """Whether it stands in one pose throughout."""

    @property
    def turns(self) -> Float[np.ndarray, "frames 3 3"]:
        """Rotation matrices that take the body's axes to the world's; made again, being large."""
        return rotation_matrices(self.orientations)

    def turns_at(self, frames: Int[np.ndarray, "some"]) -> Float[np.ndarray, "some 3 3"]:
        """Those matrices at some frames."""
        return rotation_matrices(self.orientations[frames])


def body(surface: Surface, stream: Stream, *, rests: bool) -> Body:
    """A surface that follows a stream."""
    frames = len(stream.positions)
    centres = np.empty((1 if rests else frames, 3))
    for block in blocks(len(centres)):
        turns = rotation_matrices(stream.orientations[block])
        centres[block] = stream.positions[block] + turns @ surface.centre
    everywhere = np.broadcast_to(centres, (frames, 3))
    return Body(surface, stream.positions, stream.orientations, everywhere, rests)


def at_frame(surface: Surface, stream: Stream, frame: int) -> Body:
    """A surface at one frame of a stream, which is frame 0 of the body."""
    place = stream.positions[frame][None]
    turn = stream.orientations[frame][None]
    centre = place + rotation_matrices(turn) @ surface.centre
    return Body(surface, place, turn, centre, rests=True)


def near(first: Body, second: Body, *, distance_m: float) -> Holds:
    """At which frames two bodies are within a distance [m]: their surfaces, or one in the other.

    Exact to 0.05 mm. Where a body is lost the answer is no. Bodies that are not closed have no
    inside. The answer does not depend on which body is named first.
    """
    frames = len(first.positions)
    if first.rests and second.rests:
        frames = 1
    simple, other = sorted((first, second), key=_simplicity)
    out = np.zeros(len(first.positions), dtype=bool)
    found = _candidates(simple, other, distance_m, frames)
    if found.size:
        turns, places = _relative(simple, other, found)
        inside = _nested(simple.surface, other.surface, turns, places)
        if inside.any():
            turns, places = turns[~inside], places[~inside]
        inside[~inside] = sweep(simple.surface, other.surface, turns, places, distance_m=distance_m)
        out[found] = inside
    if frames == 1:
        out[:] = out[0]
    return out


def nearest(first: Body, second: Body, frame: int) -> tuple[float, Vector, Vector]:
    """Distance [m] of two bodies at a frame and the nearest points, each in its body's frame [m].

    Where the surfaces cut each other the distance is zero and both points are the middle of the
    cut, in either frame.
    """
    turns, places = _relative(first, second, np.array([frame]))
    point = _cut(first.surface, second.surface, turns[0], places[0])
    if point is not None:
        return 0.0, point, turns[0].T @ (point - places[0])
    distance, on_first, on_second = _apart(first.surface, second.surface, turns[0], places[0])
    return distance, on_first, turns[0].T @ (on_second - places[0])


def distance(first: Body, second: Body, frame: int) -> float:
    """Distance [m] of two bodies' surfaces at a frame; zero where they cut each other."""
    turns, places = _relative(first, second, np.array([frame]))
    one = fcl.CollisionObject(first.surface.tree)
    two = fcl.CollisionObject(second.surface.tree, fcl.Transform(turns[0], places[0]))
    if fcl.collide(one, two, fcl.CollisionRequest(), fcl.CollisionResult()):
        return 0.0
    return _apart(first.surface, second.surface, turns[0], places[0])[0]


def separation(
    first: Body, second: Body, frames: Int[np.ndarray, "some"]
) -> Float[np.ndarray, "some"]:
    """Distances [m] of two bodies' surfaces at some frames: zero where they cut or are nested.

    NaN where a body is lost.
    """
    known = geometry.is_known(first.positions[frames] + second.positions[frames])
    turns, places = _relative(first, second, frames[known])
    inside = _nested(first.surface, second.surface, turns, places)
    out = np.full(len(frames), np.nan)
    apart = [distance(first, second, int(frame)) for frame in frames[known]]
    out[known] = np.where(inside, 0.0, apart)
    return out


def _apart(
    first: Surface, second: Surface, turn: Float[np.ndarray, "3 3"], place: Vector
) -> tuple[float, Vector, Vector]:
    """Distance [m] of surfaces that do not cut, and nearest points, in the first's frame [m]."""
    result = fcl.DistanceResult()
    request = fcl.DistanceRequest(enable_nearest_points=True)
    one = fcl.CollisionObject(first.tree)
    two = fcl.CollisionObject(second.tree, fcl.Transform(turn, place))
    apart = fcl.distance(one, two, request, result)
    on_first, on_second = (np.asarray(each) for each in result.nearest_points)
    return float(apart), on_first, on_second


def _simplicity(each: Body) -> tuple[int, float, bytes]:
    surface = each.surface
    return surface.faces, surface.radius, surface.shape.vertices.tobytes()[:64]


def _relative(
    first: Body, second: Body, frames: Int[np.ndarray, "some"]
) -> tuple[Float[np.ndarray, "some 3 3"], Float[np.ndarray, "some 3"]]:
    """``T_first_second`` at some frames: rotation matrices and places [m]."""
    turns, places = np.empty((len(frames), 3, 3)), np.empty((len(frames), 3))
    for block in blocks(len(frames)):
        some = frames[block]
        back = np.swapaxes(first.turns_at(some), 1, 2)
        offset = second.positions[some] - first.positions[some]
        turns[block] = back @ second.turns_at(some)
        places[block] = (back @ offset[..., None])[..., 0]
    return turns, places


def _candidates(
    first: Body, second: Body, distance_m: float, frames: int
) -> Int[np.ndarray, "some"]:
    """Frames at which balls about the bodies, then a ball and a box each way, come so near."""
    reach = first.surface.radius + second.surface.radius + distance_m
    offset = second.centres[:frames] - first.centres[:frames]
    found = np.flatnonzero(np.einsum("ij,ij->i", offset, offset) <= reach * reach)
    for box, ball, sign in ((first, second, 1.0), (second, first, -1.0)):
        limit = ball.surface.radius + distance_m
        meets = np.zeros(len(found), dtype=bool)
        for block in blocks(len(found)):
            outside = _outside(box, found[block], sign * offset[found[block]])
            meets[block] = np.einsum("ij,ij->i", outside, outside) <= limit * limit
        found = found[meets]
    return found


def _outside(
    box: Body, frames: Int[np.ndarray, "some"], offset: Float[np.ndarray, "some 3"]
) -> Float[np.ndarray, "some 3"]:
    """How far places, given from the middle of a body's box, lie outside it along its axes [m]."""
    back = np.swapaxes(box.turns_at(frames), 1, 2)
    local = (back @ offset[..., None])[..., 0]
    return np.asarray(np.maximum(np.abs(local) - 0.5 * box.surface.shape.size, 0.0))


def _nested(
    first: Surface,
    second: Surface,
    turns: Float[np.ndarray, "some 3 3"],
    places: Float[np.ndarray, "some 3"],
) -> Bool[np.ndarray, "some"]:
    """Whether one body lies inside the other, by one corner: enough where surfaces do not cut."""
    corner = np.asarray(second.shape.vertices[0])
    inside = first.contains(turns @ corner + places)
    back = np.swapaxes(turns, 1, 2)
    corner = np.asarray(first.shape.vertices[0])
    inside |= second.contains((back @ (corner - places)[..., None])[..., 0])
    return inside


def _cut(
    first: Surface, second: Surface, turn: Float[np.ndarray, "3 3"], place: Vector
) -> Vector | None:
    """Middle of the places where two surfaces cut each other [m], in the first's frame, if any."""
    request = fcl.CollisionRequest(num_max_contacts=1000, enable_contact=True)
    result = fcl.CollisionResult()
    one = fcl.CollisionObject(first.tree)
    two = fcl.CollisionObject(second.tree, fcl.Transform(turn, place))
    if not fcl.collide(one, two, request, result):
        return None
    ones = first.triangles[[each.b1 for each in result.contacts]]
    twos = second.triangles[[each.b2 for each in result.contacts]] @ turn.T + place
    points = meeting_points(ones, twos)
    known = points[~np.isnan(points[:, 0])]
    # Triangles that lie on each other share no line: their corners stand for it.
    return np.mean(known if len(known) else twos.reshape(-1, 3), axis=0)


ASKED_FRAMES = 5
"""At how many frames it is asked whether a body is in between [1]; most of them decide."""


Meeting = tuple[str, str, Interval]
"""The names of two bodies that touch, and the frames in which they do."""


def screened(
    meetings: Sequence[Meeting],
    bodies: Mapping[str, Body],
    screens: Iterable[str],
    *,
    reach_m: float,
) -> Iterator[tuple[Interval, ...]]:
    """For each meeting the intervals in which a third body is between the two.

    It touches both, and the line that joins their nearest points, made longer at both ends, goes
    through it; it is no further from either than they are from each other.

    ``meetings``: contacts. ``screens``: names of bodies that may be in between. ``reach_m``: by how
    much the line is made longer at either end [m].
    """
    touches: dict[str, dict[str, list[Interval]]] = defaultdict(lambda: defaultdict(list))
    for one, two, span in meetings:
        touches[one][two].append(span)
        touches[two][one].append(span)
    for one, two, span in meetings:
        common = set(touches[one]) & set(touches[two]) & set(screens) & set(bodies)
        yield tuple(
            sorted(
                part
                for third in common
                if one in bodies and two in bodies
                for part in _common(span, touches[one][third], touches[two][third])
                if _parted((bodies[one], bodies[two], bodies[third]), part, reach_m)
            )
        )


def _common(
    span: Interval, ones: Iterable[Interval], twos: Iterable[Interval]
) -> Iterator[Interval]:
    """The frames of an interval that lie in one of either kind as well."""
    then = [two for two in twos if two[0] <= span[1] and two[1] >= span[0]]
    for one in ones:
        for two in then if one[0] <= span[1] and one[1] >= span[0] else ():
            first, last = max(span[0], one[0], two[0]), min(span[1], one[1], two[1])
            if first <= last:
                yield first, last


def _parted(meeting: tuple[Body, Body, Body], span: Interval, reach_m: float) -> bool:
    """Whether the third of three bodies is between the others, at most of some frames."""
    frames = np.unique(np.linspace(*span, ASKED_FRAMES).round().astype(int))
    most, asked = len(frames) // 2 + 1, iter(frames)
    needed, spare = most, len(frames) - most
    while needed > 0 and spare >= 0:
        if _between(*meeting, int(next(asked)), reach_m):
            needed -= 1
        else:
            spare -= 1
    return needed == 0


def _between(one: Body, two: Body, third: Body, frame: int, reach_m: float) -> bool:
    """Whether the line that joins two bodies' nearest points goes through a third at a frame."""
    if any(np.isnan(each.positions[frame]).any() for each in (one, two, third)):
        return False
    apart_m, on_one, on_two = nearest(one, two, frame)
    if apart_m <= 0.0 or any(distance(each, third, frame) > apart_m for each in (one, two)):
        return False
    begin, end = _local(third, one, on_one, frame), _local(third, two, on_two, frame)
    middle = 0.5 * (begin + end)
    if third.surface.contains(middle[None])[0]:
        return True
    beyond = reach_m / apart_m * (end - begin)
    begin, end = begin - beyond, end + beyond
    way = (end - begin)[None]
    places, _ = third.surface.hits(begin[None], way)
    along = (places - begin) @ way[0] / float(way[0] @ way[0])
    return bool(((along >= 0.0) & (along <= 1.0)).any())


def _local(base: Body, other: Body, point: np.ndarray, frame: int) -> np.ndarray:
    """A point of the other's frame [m] in the base's."""
    turn = rotation_matrices(other.orientations[frame][None])[0]
    back = rotation_matrices(base.orientations[frame][None])[0].T
    world = turn @ point + other.positions[frame]
    return np.asarray(back @ (world - base.positions[frame]))
