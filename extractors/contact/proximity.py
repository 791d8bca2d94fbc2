"""Whether two moving bodies are within a distance, frame by frame, on their true surfaces."""

from dataclasses import dataclass

import fcl
import numpy as np
from jaxtyping import Bool, Float, Int

from capar.model.capture import Stream
from extractors.bodies.body_geometry import blocks
from extractors.bodies.poses import rotation_matrices
from extractors.contact.surfaces import Surface
from extractors.contact.sweep import sweep
from extractors.contact.triangle_intersection import meeting_points


@dataclass(frozen=True, eq=False)
class Body:
    """A surface and its pose at every frame, ready for questions."""

    surface: Surface
    positions: Float[np.ndarray, "frames 3"]
    """World positions [m]; NaN where lost."""

    orientations: Float[np.ndarray, "frames 4"]
    """Unit quaternions w x y z."""

    centres: Float[np.ndarray, "frames 3"]
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


def near(first: Body, second: Body, *, distance_m: float) -> Bool[np.ndarray, "frames"]:
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


def nearest(
    first: Body, second: Body, frame: int
) -> tuple[float, Float[np.ndarray, "3"], Float[np.ndarray, "3"]]:
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
    known = ~np.isnan(first.positions[frames] + second.positions[frames]).any(axis=1)
    turns, places = _relative(first, second, frames[known])
    inside = _nested(first.surface, second.surface, turns, places)
    out = np.full(len(frames), np.nan)
    apart = [distance(first, second, int(frame)) for frame in frames[known]]
    out[known] = np.where(inside, 0.0, apart)
    return out


def _apart(
    first: Surface, second: Surface, turn: Float[np.ndarray, "3 3"], place: Float[np.ndarray, "3"]
) -> tuple[float, Float[np.ndarray, "3"], Float[np.ndarray, "3"]]:
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
    first: Surface, second: Surface, turn: Float[np.ndarray, "3 3"], place: Float[np.ndarray, "3"]
) -> Float[np.ndarray, "3"] | None:
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
