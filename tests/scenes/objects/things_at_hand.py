"""Usual things of these scenes, set on the table or where a scene wants them."""

from scenes.hands import shapes
from scenes.hands.paths import Vector
from scenes.hands.stage import Stage
from scenes.hands.things import Thing
from scenes.objects import forms


def apple(s: Stage, at: Vector, name: str = "apple", radius: float = 0.034) -> Thing:
    """An apple whose lowest point is at a place."""
    x, y, z = (*at, s.height)[:3]
    return s.put(name, shapes.ball(radius, "apple"), (x, y, z + radius))


def can(s: Stage, at: Vector, name: str = "can", height: float = 0.13) -> Thing:
    """A tall block that a flat hand can take from above."""
    return s.put(name, shapes.box(0.06, 0.06, height, "can"), at)


def toy(s: Stage, at: Vector, name: str = "block", size: float = 0.07) -> Thing:
    """A small block."""
    return s.put(name, shapes.box(size, size, size, "block"), at)


def crate(s: Stage, at: Vector, name: str = "crate", height: float = 0.1) -> Thing:
    """An open crate."""
    return s.put(name, forms.open_box(0.32, 0.28, height, "crate"), at)


def bowl(s: Stage, at: Vector, name: str = "bowl") -> Thing:
    """A wide bowl."""
    return s.put(name, shapes.vessel(0.12, 0.07, "bowl"), at)


def shelf(s: Stage, at: Vector, *, name: str = "shelf", size: Vector = (0.4, 0.4)) -> Thing:
    """A fixed board whose top is at a place."""
    x, y, z = at
    board = shapes.box(size[0], size[1], 0.02, "shelf")
    return s.put(name, board, (x, y, z - 0.02), tag="fixed")


def pillar(s: Stage, name: str, at: Vector, size: Vector, kind: str) -> Thing:
    """Fixed furniture that reaches from the floor up to a place: a stool, a side table."""
    x, y, z = at
    return s.put(name, shapes.box(size[0], size[1], z, kind), (x, y, 0.0), tag="fixed")


def floor(s: Stage) -> Thing:
    """The floor all around."""
    slab = shapes.Form("floor", (shapes.block((-2.0, -2.0, -0.05), (3.0, 2.0, 0.0)),))
    return s.put("floor", slab, (0.0, 0.0, 0.0), tag="fixed")


def wall(s: Stage, x: float, *, high: float = 0.6) -> Thing:
    """A wall behind the table, its near face at a distance [m]."""
    slab = shapes.Form("wall", (shapes.block((0.0, -1.0, -0.5), (0.1, 1.0, high)),))
    return s.put("wall", slab, (x, 0.0, s.height), tag="fixed")
