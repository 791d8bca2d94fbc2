"""Scenes with a door on a hinge and a drawer on a rail, for virtual performers."""

import numpy as np
import trimesh

from capar.body.things import Scene, Thing, scene
from capar.model.capture import Shape, TagType

LEAF_M = (0.04, 0.60, 0.50)
"""A cupboard door: how thick, wide and high [m]."""

HINGE_M = 0.42
"""How far the hinge is to the left of where the door is pushed [m]."""

JAMB_M = 0.06
"""How thick the posts beside a door are [m]."""

GAP_M = 0.003
"""Between what moves and what guides it [m]."""

DRAWER_M = (0.36, 0.30, 0.12)
"""A drawer: how deep, wide and high [m]."""

BOARD_M = 0.02
"""How thick the boards of a chest are [m]."""


def door_scene(tall_m: float) -> Scene:
    """A closed door at chest height between two posts, its hinge to the left.

    The origin of the door's frame is below where it is pushed, a hand's length from its free edge.

    Args:
        tall_m: The performer's stature [m].
    """
    thick, wide, high = LEAF_M
    place = (0.30 * tall_m, -0.06 * tall_m, 0.55 * tall_m)
    middle = HINGE_M - 0.5 * wide
    leaf = _boxes([((thick, wide, high), (0.5 * thick, middle, 0.5 * high))], "door leaf")
    beside = 0.5 * (wide + JAMB_M) + GAP_M
    posts = [
        ((thick, JAMB_M, high), (0.5 * thick, middle + aside, 0.5 * high))
        for aside in (beside, -beside)
    ]
    beam = ((thick, wide + 2.0 * (JAMB_M + GAP_M), JAMB_M),
            (0.5 * thick, middle, high + GAP_M + 0.5 * JAMB_M))  # fmt: skip
    frame = _boxes([*posts, beam], "posts and beam")
    return scene(
        Thing("frame", frame, place, tag=TagType.FIXED, kind="frame"),
        Thing("door", leaf, place, kind="door"),
    )


def drawer_scene(tall_m: float) -> Scene:
    """A closed drawer in a chest without a top, which the drawer overlooks a little.

    Args:
        tall_m: The performer's stature [m].
    """
    deep, wide, high = DRAWER_M
    place = (0.32 * tall_m, -0.10 * tall_m, 0.50 * tall_m)
    drawer = _boxes([((deep, wide, high), (0.5 * deep - 0.1, 0.0, 0.5 * high))], "drawer")
    x, below = 0.5 * deep - 0.1, BOARD_M + GAP_M
    sides = [
        ((deep, BOARD_M, high), (x, sign * (0.5 * (wide + BOARD_M) + GAP_M), 0.5 * high - below))
        for sign in (1.0, -1.0)
    ]
    floor = ((deep, wide + 2.0 * (BOARD_M + GAP_M), BOARD_M), (x, 0.0, -0.5 * BOARD_M - GAP_M))
    back = ((BOARD_M, wide, high), (deep - 0.1 + 0.5 * BOARD_M + GAP_M, 0.0, 0.5 * high - below))
    chest = _boxes([*sides, floor, back], "chest without a top")
    return scene(
        Thing("chest", chest, place, tag=TagType.FIXED, kind="chest"),
        Thing("drawer", drawer, place, kind="drawer"),
    )


GUIDED = {"door": door_scene, "drawer": drawer_scene}
"""Scenes by the action that they are for, of the performer's stature [m]."""


def _boxes(
    parts: list[tuple[tuple[float, float, float], tuple[float, float, float]]], description: str
) -> Shape:
    """Boxes of some sizes with their middles somewhere, as one shape [m]."""
    vertices, faces = [], []
    for number, (extents, middle) in enumerate(parts):
        made = trimesh.creation.box(extents=extents)
        vertices.append(np.array(made.vertices) + middle)
        faces.append(np.array(made.faces) + number * len(made.vertices))
    return Shape(np.concatenate(vertices), np.concatenate(faces), description=description)
