"""Room in bodies: in which of those that are moved to and fro, or tipped, nothing can be."""

from collections import defaultdict
from collections.abc import Iterable, Iterator, Mapping
from typing import cast
from weakref import WeakKeyDictionary

import numpy as np
import trimesh
from jaxtyping import Float
from scipy.spatial import ConvexHull, QhullError, cKDTree

from capar.model.capture import Shape
from capar.model.facts import Fact, Leans, Posture, Shapeless, Solid, Swings, Touching
from extractors.bodies.body_geometry import BodyGeometry, once
from extractors.thresholds import Thresholds

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

_Pocket = tuple[Float[np.ndarray, "3"], float]
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

    Args:
        things: Bodies of all tag objects, by their names.
        kinds: What each is, where that is declared.
        touches: What touches what.
        known: Facts that say what moves to and fro and what is tipped; that, and what the first
            touches, is asked about.
        thresholds: How deep a hollow holds something.
    """
    facts = tuple(known)
    swung = {each.body for each in facts if isinstance(each, Swings)}
    met = {each.other for each in touches if each.body in swung}
    for name in sorted((swung | met | _tipped(facts, thresholds)) & set(things)):
        shape = things[name].shape
        if shape is None:
            yield Shapeless(name)
        elif kinds.get(name) not in VESSELS and not has_room(shape, thresholds):
            yield Solid(name)


def _tipped(facts: Iterable[Fact], thresholds: Thresholds) -> set[str]:
    """What leans, or leans otherwise at one time than at another by half of that."""
    leans: dict[str, list[int]] = defaultdict(list)
    out: set[str] = set()
    for each in facts:
        if isinstance(each, Leans):
            out.add(each.object)
        elif isinstance(each, Posture):
            leans[each.body].append(each.lean)
    far = 500.0 * thresholds.lean_rad
    return out | {body for body, seen in leans.items() if max(seen) - min(seen) > far}


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


def pocket_m(shape: Shape) -> float:
    """The largest distance of a body's convex hull from its own surface [m].

    Of a bowl it is how far the middle of its opening is from its wall or bottom; of a box or a loaf
    nearly zero. It is known to a fortieth of the body's size. Zero for what has no volume.
    """
    found = once(_POCKETS, shape, _pocket)
    return 0.0 if found is None else found[1]


def _pocket(shape: Shape) -> _Pocket | None:
    """Where the hull is furthest from the surface, half as far inside of it; and how far [m]."""
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


def enclosure(shape: Shape, point: Float[np.ndarray, "3"]) -> float:
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
    mesh = trimesh.Trimesh(vertices, faces, process=False)
    fine = cast(trimesh.Trimesh, mesh.subdivide_to_size(edge_m, max_iter=20))
    return np.asarray(fine.vertices)[np.unique(fine.faces)]
