"""Furniture with parts that move: cabinets with drawers, cupboards with doors, chests with lids."""

from dataclasses import dataclass

from scenes.hands.paths import Vector
from scenes.hands.stage import Stage
from scenes.hands.things import Thing
from scenes.objects import forms
from scenes.objects.handling import NEAR, RIGHTWARD, UP, Grip, Hinge

SINK = 0.0003
"""How deep a rail or a hinge stands in what bears it [m]."""


@dataclass(frozen=True)
class Cabinet:
    """A fixed body and a drawer in it that moves along x."""

    body: Thing
    drawer: Thing
    grip: Grip
    """On the drawer's handle."""


@dataclass(frozen=True)
class Cupboard:
    """A fixed body and what moves about its hinge: a door or a lid."""

    body: Thing
    leaf: Thing
    hinge: Hinge
    grip: Grip
    """On the handle or the lip."""

    face: Grip
    """For a flat palm on the outside."""


def cabinet(
    s: Stage,
    at: Vector,
    *,
    depth: float = 0.36,
    width: float = 0.32,
    height: float = 0.13,
    out: float = 0.0,
) -> Cabinet:
    """A cabinet whose drawer stands out by a length [m]; its front stands at a place."""
    x, y, z = at
    body = s.put("cabinet", forms.cabinet(depth, width, height), (x, y, z), tag="fixed")
    made = forms.drawer(depth - 0.02, width - 0.01, height - 0.015)
    drawer = s.put("drawer", made, (x - out, y, z - SINK))
    grip = Grip((-forms.HANDLE_M, 0.0, 0.5 * (height - 0.015)), NEAR, RIGHTWARD)
    return Cabinet(body, drawer, grip)


def cupboard(
    s: Stage,
    at: Vector,
    *,
    side: str,
    depth: float = 0.3,
    width: float = 0.34,
    height: float = 0.4,
) -> Cupboard:
    """A cupboard with its front at a place and its hinge at the right or left side."""
    x, y, z = at
    way = 1.0 if side == "right" else -1.0
    body = s.put("cupboard", forms.cabinet(depth, width, height, "cupboard"), at, tag="fixed")
    axis = (x - forms.HINGE_M + SINK, y - way * (width / 2.0 + 0.5 * forms.WALL_M), z)
    leaf = s.put("door", forms.door(width, height, way), axis)
    handle = way * (width - 0.05)
    middle = 0.4 * height + 0.06
    return Cupboard(
        body,
        leaf,
        Hinge(axis, UP, way),
        Grip((-0.008 - forms.HANDLE_M, handle, middle), NEAR, RIGHTWARD),
        Grip((-0.008, way * (width - 0.15), 0.7 * height), NEAR, UP),
    )


def chest(
    s: Stage, at: Vector, *, depth: float = 0.34, width: float = 0.44, height: float = 0.24
) -> Cupboard:
    """A chest that stands with its middle on a place, its lid shut; the hinge is at the back."""
    x, y, z = at
    body = s.put("chest", forms.open_box(depth, width, height, "chest", 0.014), at, tag="fixed")
    axis = (x + depth / 2.0 - 0.007, y, z + height + forms.HINGE_M - SINK)
    leaf = s.put("lid", forms.chest_lid(depth, width), axis)
    return Cupboard(
        body,
        leaf,
        Hinge(axis, (0.0, 1.0, 0.0), 1.0),
        Grip((-depth - forms.HANDLE_M, 0.0, 0.0), NEAR, UP),
        Grip((-0.6 * depth, 0.0, 0.006), UP, (1.0, 0.0, 0.0)),
    )
