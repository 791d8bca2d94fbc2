"""Where bodies are, how far they have gone and turned, and in which rooms."""

from collections import defaultdict
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, field
from itertools import compress
from typing import cast
from weakref import WeakKeyDictionary

import numpy as np
from jaxtyping import Float
from scipy.spatial import ConvexHull, QhullError, cKDTree

from capar.model import geometry
from capar.model.capture import Shape
from capar.model.facts import (
    Distance,
    Fact,
    Leans,
    Place,
    Posture,
    Shapeless,
    Solid,
    SweptAzimuth,
    Swings,
    Touching,
    Travelled,
    TrunkPlace,
)
from capar.model.geometry import Series, Vector
from extractors.bodies.bodies import BodyGeometry, from_trunk, once
from extractors.motion.phases import lean, spin_steps
from extractors.relations.arrangement import beyond_shadow
from extractors.thresholds import Thresholds


@dataclass(frozen=True)
class Sums:
    """What was summed up to a frame of a window; by default its first one, and nothing."""

    anchor: int = 0
    """The frame of the window at which the sums are known."""

    ways: Mapping[str, tuple[float, float, float]] = field(default_factory=dict)
    """Path [m], rotation [rad] and turn about the vertical [rad], by body."""

    winds: Mapping[tuple[str, str], float] = field(default_factory=dict)
    """By how much a body has gone about another [rad]."""


FROM_THE_BEGINNING = Sums()


def summed(steps: Float[np.ndarray, "steps"], anchor: int, known: float) -> Series:
    """Running sum of the steps between frames that is ``known`` at a frame, before it backwards.

    From that frame on they are added in the order in which a whole recording would add them, so
    that the sums are the same to the last bit.
    """
    after = np.cumsum(np.concatenate(([known], steps[anchor:])))
    before = known - np.cumsum(steps[:anchor][::-1])
    return np.concatenate((before[::-1], after))


LEAST_SWEEP_RAD = 0.5 * np.pi
"""A body that never sweeps so large an angle about another [rad] goes about it nowhere: a quarter
of a turn. For every two bodies and frame there would be an azimuth else, half of all facts."""

_COMMON = tuple(range(1 << 13))
"""Numbers that all facts share: a long recording states hundreds of thousands of distances below
eight metres, and an integer of its own would take 32 bytes for each."""


def places(
    body: BodyGeometry, upright: Vector, frames: tuple[int, ...], since: Sums = FROM_THE_BEGINNING
) -> Iterator[Fact]:
    """Place, way, turn and posture of a body at some frames; lost frames are left out.

    ``upright``: the axis that points up while it stands, in its own frame. ``since``: how far it
    had gone and turned before.
    """
    if not frames:
        return
    way, turn, spin = turned_and_gone(body, since)
    at = np.asarray(frames)
    at = at[geometry.is_known(body.middles[at])]
    middles = _thousandths(body.middles[at])
    ways = _thousandths(np.stack([way[at], turn[at]], axis=1))
    postures = np.stack([lean(body.orientations[at], upright), spin[at]], axis=1)
    rows = zip(at.tolist(), middles, ways, _thousandths(postures), strict=True)
    for frame, middle, travelled, posture in rows:
        yield Place(body.name, frame, *middle)
        yield Travelled(body.name, frame, *travelled)
        yield Posture(body.name, frame, *posture)


def trunk_places(
    body: BodyGeometry, trunk: BodyGeometry, upright: Vector, frames: tuple[int, ...]
) -> Iterator[Fact]:
    """Place of an end-effector from its agent's trunk at some frames; lost ones are left out.

    ``trunk``: the trunk. ``upright``: the trunk's axis that points up while it stands, in its own
    frame.
    """
    if not frames:
        return
    at = np.asarray(frames)
    places_m = from_trunk(body, trunk, upright)[at]
    known = geometry.is_known(places_m)
    for frame, place in zip(at[known].tolist(), _thousandths(places_m[known]), strict=True):
        yield TrunkPlace(body.name, frame, *place)


def distances(
    body: BodyGeometry,
    other: BodyGeometry,
    frames: tuple[int, ...],
    since: Sums = FROM_THE_BEGINNING,
    *,
    whole: bool = False,
) -> Iterator[Fact]:
    """Distance of two bodies' middles, and the angle by which one has gone about the other.

    ``since``: by how much it had gone about the other before. ``whole``: whether this is a whole
    recording: angles that stay small in it are left out.
    """
    if not frames:
        return
    gone_about = wound(body, other, since)
    at = np.asarray(frames)
    apart = geometry.lengths((body.middles - other.middles)[at])
    known = ~np.isnan(apart)
    values = _thousandths(np.stack([apart[known], gone_about[at[known]]], axis=1))
    swept = [milliradians for _, milliradians in values]
    wide = max(swept, default=0) - min(swept, default=0) >= 1000.0 * LEAST_SWEEP_RAD
    sweeps = not whole or wide
    # The frames themselves, not copies: a long recording has hundreds of thousands of these facts.
    kept = compress(frames, known.tolist())
    for frame, (millimetres, milliradians) in zip(kept, values, strict=True):
        yield Distance(body.name, other.name, frame, millimetres)
        if sweeps:
            yield SweptAzimuth(body.name, other.name, frame, milliradians)


def turned_and_gone(
    body: BodyGeometry, since: Sums = FROM_THE_BEGINNING
) -> tuple[Series, Series, Series]:
    """Path [m], rotation [rad] and turn about the vertical [rad] up to each frame."""
    steps = geometry.lengths(np.diff(body.middles, axis=0))
    angles = geometry.angle_between(body.orientations[1:], body.orientations[:-1])
    parts = (steps, angles, spin_steps(body.orientations))
    way, turn, spin = (
        summed(np.nan_to_num(part), since.anchor, known)
        for part, known in zip(parts, since.ways.get(body.name, (0.0, 0.0, 0.0)), strict=True)
    )
    return way, turn, spin


def wound(body: BodyGeometry, other: BodyGeometry, since: Sums = FROM_THE_BEGINNING) -> Series:
    """Unwrapped azimuth of a body about another [rad].

    Nothing is added where it is lost, nor above or below the other, where it goes about nothing.
    """
    offset = body.middles - other.middles
    outside = beyond_shadow(body.middles, *other.boxes) > 0.0
    azimuth = np.arctan2(offset[:, 1], offset[:, 0])
    steps = np.nan_to_num(np.diff(azimuth))
    turns = (steps + np.pi) % (2.0 * np.pi) - np.pi
    known = since.winds.get((body.name, other.name), 0.0)
    return summed(np.where(outside[1:] & outside[:-1], turns, 0.0), since.anchor, known)


def sums_at(
    bodies: Iterable[BodyGeometry], others: Iterable[BodyGeometry], frame: int, since: Sums
) -> Sums:
    """What is summed up to a later frame of a window, which becomes the anchor.

    ``others``: what they may go about. ``since``: what is known.
    """
    own, about = list(bodies), list(others)
    ways, winds = {}, {}
    for one in own:
        way, turn, spin = turned_and_gone(one, since)
        ways[one.name] = float(way[frame]), float(turn[frame]), float(spin[frame])
        for other in about:
            if other.name != one.name:
                winds[one.name, other.name] = float(wound(one, other, since)[frame])
    return Sums(frame, ways, winds)


def _thousandths(values: Float[np.ndarray, "rows columns"]) -> list[list[int]]:
    """Metres as whole millimetres, radians as milliradians, row by row."""
    rounded: list[list[int]] = np.rint(1000.0 * values).astype(np.int64).tolist()
    return [[_COMMON[n] if 0 <= n < len(_COMMON) else n for n in row] for row in rounded]


RESOLUTION = 40
"""Into how many edges the longest side of a body is divided, to sample its surface [1]."""

SIGHTS = 200
"""In how many directions it is looked whether a body's own surface is there [1]."""

VESSELS = frozenset(
    (
        *("bottle", "bowl", "bucket", "carafe", "container", "cup", "decanter", "flask", "glass"),
        *("jar", "jug", "kettle", "ladle", "mug", "pan", "pitcher", "pot", "scoop", "spoon"),
        *("teapot", "vase"),
    )
)
"""Kinds of what is hollow, also where its shape is modelled without its hollow, or closed."""

_Pocket = tuple[Vector, float]
"""A point in a body's largest hollow, in the body's own frame [m], and how large that is [m]."""

_POCKETS: WeakKeyDictionary[Shape, _Pocket | None] = WeakKeyDictionary()
_ENCLOSURES: WeakKeyDictionary[Shape, float] = WeakKeyDictionary()
"""What was found of shapes: live windows ask about the same ones again and again."""


def rooms(
    things: Mapping[str, BodyGeometry],
    kinds: Mapping[str, str],
    touches: Iterable[Touching],
    known: Iterable[Fact],
    thresholds: Thresholds,
) -> Iterator[Fact]:
    """Where nothing fits in, and where that is not known.

    ``kinds``: what each is, where that is declared.
    """
    facts = tuple(known)
    swung = {each.body for each in facts if isinstance(each, Swings)}
    met = {each.other for each in touches if each.body in swung}
    # What leans, or leans otherwise at one time than at another by half of that.
    leans: dict[str, list[int]] = defaultdict(list)
    for each in facts:
        if isinstance(each, Posture):
            leans[each.body].append(each.lean)
    far = 500.0 * thresholds.lean_rad
    tipped = {each.object for each in facts if isinstance(each, Leans)}
    tipped |= {body for body, seen in leans.items() if max(seen) - min(seen) > far}
    for name in sorted((swung | met | tipped) & set(things)):
        shape = things[name].shape
        if shape is None:
            yield Shapeless(name)
        elif kinds.get(name) not in VESSELS and not has_room(shape, thresholds):
            yield Solid(name)


def has_room(shape: Shape, thresholds: Thresholds) -> bool:
    """Whether a body has a hollow in which something can be.

    Its surface is far from its convex hull there, and is seen from there in most directions: so a
    bowl has room, and a banana, which is only bent, has none.
    """
    found = once(_POCKETS, shape, _pocket)
    if found is None or found[1] <= thresholds.pocket_share * float(shape.size.max()):
        return False
    inside = found[0]
    enclosed = once(_ENCLOSURES, shape, lambda body: enclosure(body, inside))
    return enclosed > thresholds.enclosed_share


def seek_rooms(shapes: Iterable[Shape], thresholds: Thresholds) -> None:
    """Seek the hollows of shapes beforehand, which takes up to a second each, and keep them."""
    for shape in shapes:
        has_room(shape, thresholds)


def _pocket(shape: Shape) -> _Pocket | None:
    """Where the hull is furthest from the surface, half as far inside of it; and how far [m].

    Of a bowl it is how far the middle of its opening is from its wall; of a box nearly zero.
    """
    vertices = np.asarray(shape.vertices)
    try:
        hull = ConvexHull(vertices).simplices
    except (QhullError, ValueError):
        return None
    edge_m = float(np.max(shape.size)) / RESOLUTION
    own = _sampled(vertices, np.asarray(shape.faces), edge_m)
    around = _sampled(vertices, hull, edge_m)
    ways = cKDTree(own).query(around)[0]
    at = int(np.argmax(ways))
    inward = vertices.mean(axis=0) - around[at]
    inside = around[at] + 0.5 * ways[at] * inward / max(float(np.linalg.norm(inward)), 1e-9)
    return inside, float(ways[at])


def enclosure(shape: Shape, point: Vector) -> float:
    """In what share of all directions a body's surface is seen from a point [1].

    Rays meet triangles as Moeller and Trumbore (1997) tell.
    """
    corners = np.asarray(shape.vertices)[np.asarray(shape.faces)]
    first, one, other = corners[:, 0], corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]
    since = point - first
    across = np.cross(since, one)
    seen = 0
    for sight in _directions():
        normal = np.cross(sight, other)
        scale = np.einsum("ij,ij->i", one, normal)
        flat = np.abs(scale) < 1e-15
        scale = np.where(flat, 1.0, scale)
        u = np.einsum("ij,ij->i", since, normal) / scale
        v = across @ sight / scale
        far = np.einsum("ij,ij->i", other, across) / scale
        seen += bool((~flat & (u >= 0.0) & (v >= 0.0) & (u + v <= 1.0) & (far > 0.0)).any())
    return seen / SIGHTS


def _directions() -> Float[np.ndarray, "sights 3"]:
    """Directions that are spread evenly over the sphere, along a spiral (Fibonacci)."""
    places = np.arange(SIGHTS) + 0.5
    up, turn = 1.0 - 2.0 * places / SIGHTS, np.pi * (1.0 + np.sqrt(5.0)) * places
    level = np.sqrt(1.0 - up**2)
    return np.column_stack((level * np.cos(turn), level * np.sin(turn), up))


def _sampled(
    vertices: Float[np.ndarray, "vertices 3"], faces: np.ndarray, edge_m: float
) -> Float[np.ndarray, "points 3"]:
    """Points of a surface, no further apart than an edge; what no face uses is left out."""
    import trimesh  # takes long, and few captures have vessels

    mesh = trimesh.Trimesh(vertices, faces, process=False)
    fine = cast(trimesh.Trimesh, mesh.subdivide_to_size(edge_m, max_iter=20))
    return np.asarray(fine.vertices)[np.unique(fine.faces)]
