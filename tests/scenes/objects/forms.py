"""Forms of containers, furniture and tools, each as convex parts in metres."""

import numpy as np

from scenes.hands.shapes import Form, block, carton, disc, vessel

HANDLE_M = 0.06
"""How far a handle stands out [m]."""

WALL_M = 0.012
"""Thickness of furniture [m]."""

HINGE_M = 0.008
"""Radius of a hinge's barrel [m]."""


def round_lid(radius: float, knob: float = 0.045) -> Form:
    """A round plate with a knob on top, lying on its origin."""
    return Form("lid", (disc(radius, 0.0, 0.008), disc(0.02, 0.008, 0.008 + knob)))


def square_lid(length: float, width: float, knob: float = 0.045) -> Form:
    """A rectangular plate with a knob on top, lying on its origin."""
    x, y = length / 2.0, width / 2.0
    plate = block((-x, -y, 0.0), (x, y, 0.008))
    return Form("lid", (plate, block((-0.02, -0.02, 0.008), (0.02, 0.02, 0.008 + knob))))


def pot(radius: float = 0.11, height: float = 0.12) -> Form:
    """An open cooking pot, standing on its origin."""
    return vessel(radius, height, "pot", 0.006)


def jug(radius: float = 0.045, height: float = 0.16) -> Form:
    """An open jug whose sides are straight, standing on its origin."""
    return vessel(radius, height, "jug", 0.005)


def open_box(length: float, width: float, height: float, kind: str, wall: float = 0.008) -> Form:
    """A floor and four walls, standing on the origin: a crate, a chest."""
    return Form(kind, carton(length, width, height, wall).parts)


def basket(length: float, width: float, height: float, arch: float) -> Form:
    """A crate with an arched handle from side to side, so high over its origin [m]."""
    y = width / 2.0
    sides = open_box(length, width, height, "basket").parts
    uprights = [
        block((-0.015, low, 0.5 * height), (0.015, low + 0.01, arch)) for low in (-y, y - 0.01)
    ]
    return Form("basket", (*sides, *uprights, block((-0.015, -y, arch - 0.01), (0.015, y, arch))))


def cabinet(depth: float, width: float, height: float, kind: str = "cabinet") -> Form:
    """Furniture that is open towards negative x; its front is at x = 0, its floor at z = 0."""
    y = width / 2.0
    return Form(
        kind,
        (
            block((0.0, -y, -WALL_M), (depth, y, 0.0)),
            block((0.0, -y, height), (depth, y, height + WALL_M)),
            block((depth, -y, -WALL_M), (depth + WALL_M, y, height + WALL_M)),
            block((0.0, -y - WALL_M, -WALL_M), (depth, -y, height + WALL_M)),
            block((0.0, y, -WALL_M), (depth, y + WALL_M, height + WALL_M)),
        ),
    )


def drawer(depth: float, width: float, height: float) -> Form:
    """A drawer with an upright handle plate; its front is at x = 0, its lower side at z = 0."""
    handle = block((-HANDLE_M, -0.004, 0.2 * height), (0.0, 0.004, 0.8 * height))
    parts = [each.copy() for each in open_box(depth, width, height, "drawer").parts]
    for part in parts:
        part.apply_translation((depth / 2.0, 0.0, 0.0))
    return Form("drawer", (*parts, handle))


def door(width: float, height: float, way: float) -> Form:
    """A door about a hinge along its z axis, with a handle plate near its free edge.

    Args:
        width: From the hinge to the free edge [m].
        height: Of the panel [m].
        way: 1 if the panel lies towards positive y of the hinge, -1 if towards negative y.
    """
    near, far = sorted((way * 2.0 * HINGE_M, way * width))
    handle = way * (width - 0.05)
    panel = block((-0.008, near, 0.0), (0.008, far, height))
    arm = block((-0.006, min(0.0, near), 0.4 * height), (0.006, max(0.0, far), 0.6 * height))
    plate = block(
        (-0.008 - HANDLE_M, handle - 0.004, 0.4 * height),
        (-0.008, handle + 0.004, 0.4 * height + 0.12),
    )
    return Form("door", (panel, arm, plate, disc(HINGE_M, 0.1 * height, 0.9 * height, 48)))


def chest_lid(depth: float, width: float) -> Form:
    """A lid about a hinge along its y axis; it lies towards negative x, with a lip in front."""
    y = width / 2.0
    barrel = disc(HINGE_M, -0.4 * width, 0.4 * width, 48).copy()
    turn = np.eye(4)
    turn[:3, :3] = [[1.0, 0.0, 0.0], [0.0, 0.0, 1.0], [0.0, -1.0, 0.0]]
    barrel.apply_transform(turn)
    panel = block((-depth, -y, -0.006), (-HINGE_M / 2.0, y, 0.006))
    lip = block((-depth - HANDLE_M, -0.05, -0.004), (-depth, 0.05, 0.004))
    return Form("lid", (panel, lip, barrel))


def hammer(length: float = 0.26) -> Form:
    """A hammer: a handle along x from its origin, with the head at the far end."""
    handle = block((0.0, -0.012, -0.012), (length, 0.012, 0.012))
    head = block((length - 0.03, -0.015, -0.05), (length, 0.015, 0.03))
    return Form("hammer", (handle, head))


def nail() -> Form:
    """A thick nail that stands on its origin."""
    return Form("nail", (disc(0.004, 0.0, 0.05), disc(0.012, 0.047, 0.05)))


def knife() -> Form:
    """A knife: a handle along x from its origin, and a blade with its edge down."""
    handle = block((0.0, -0.01, -0.012), (0.12, 0.01, 0.012))
    return Form("knife", (handle, block((0.12, -0.0015, -0.02), (0.34, 0.0015, 0.012))))


def stick(length: float = 0.3) -> Form:
    """A stick along x from its origin."""
    return Form("stick", (block((0.0, -0.012, -0.012), (length, 0.012, 0.012)),))


def broom(height: float = 1.2) -> Form:
    """A broom: an upright stick with a wide head at its lower end, the origin."""
    head = block((-0.03, -0.14, 0.0), (0.03, 0.14, 0.08))
    return Form("broom", (head, block((-0.012, -0.012, 0.07), (0.012, 0.012, height))))


def ladle(length: float = 0.28) -> Form:
    """A ladle: a small cup on its origin, and an upright stem at its near side."""
    cup = vessel(0.032, 0.035, "ladle", 0.004).parts
    stem = block((-0.04, -0.005, 0.01), (-0.03, 0.005, length))
    return Form("ladle", (*cup, stem, block((-0.04, -0.02, length - 0.012), (0.0, 0.02, length))))


def frame(width: float, height: float, thickness: float = 0.03) -> Form:
    """An upright window frame in the plane y = 0, standing on its origin."""
    x, y = width / 2.0, thickness / 2.0
    return Form(
        "frame",
        (
            block((-x - 0.03, -y, 0.0), (-x, y, height + 0.03)),
            block((x, -y, 0.0), (x + 0.03, y, height + 0.03)),
            block((-x, -y, height), (x, y, height + 0.03)),
        ),
    )
