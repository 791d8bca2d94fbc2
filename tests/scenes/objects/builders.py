"""Grips, furniture and usual objects of this battery."""

from dataclasses import dataclass

import numpy as np

from scenes.hands import shapes
from scenes.hands.paths import NEAR, RIGHTWARD, UP, Vector, about, facing, pose
from scenes.hands.performer import EASE, PRESS, Hand, travel
from scenes.hands.stage import Stage
from scenes.hands.things import Thing
from scenes.objects import forms


@dataclass(frozen=True)
class Grip:
    """Where a palm lies on a thing, in the thing's frame."""

    point: Vector
    """A point of the surface [m]."""

    out: Vector
    """The direction out of the surface."""

    fingers: Vector
    """The direction in which the fingers point."""

    def on(self, thing: Thing, time: float) -> np.ndarray:
        """The hand's pose in the world at a time [s]."""
        matrix = thing.body.at(time)
        turn, place = matrix[:3, :3], matrix[:3, 3]
        out = turn @ np.asarray(self.out, dtype=float)
        spot = turn @ np.asarray(self.point, dtype=float) + place
        return pose(spot - PRESS * out, facing(-out, turn @ np.asarray(self.fingers, dtype=float)))


@dataclass(frozen=True)
class Hinge:
    """An axis about which a door or a lid turns, in the stage's frame."""

    point: Vector
    axis: Vector
    open_deg: float
    """The sense of opening: 1 or -1, times the angle [degrees]."""

    def opened(self, thing: Thing, angle_deg: float) -> None:
        """Let a thing stand open by an angle at the first frame."""
        angle = np.radians([np.sign(self.open_deg) * angle_deg])
        thing.body.first = about(self.point, self.axis, angle)[0] @ thing.body.first

    def turn(self, hand: Hand, angle_deg: float, duration: float) -> None:
        """Turn what a hand holds by an angle; positive opens."""
        hand.spin(self.point, self.axis, np.sign(self.open_deg) * angle_deg, duration)


def seize(
    hand: Hand, thing: Thing, grip: Grip, duration: float, *, hold: float = 0.0, take: bool = True
) -> None:
    """Reach a thing's grip, hold it if that has a duration, and take it."""
    hand.fly(grip.on(thing, hand.clock), duration, arrive=EASE)
    hand.meet(thing)
    hand.step("Reach", thing)
    if hold:
        hand.hold(hold, thing)
    if take:
        hand.take(thing)


def begin_with(hand: Hand, thing: Thing, grip: Grip) -> None:
    """Hold a thing from the first frame on."""
    hand.body.first = grip.on(thing, 0.0)
    hand.meet(thing)
    hand.take(thing)


def paused(
    hand: Hand,
    thing: Thing,
    goal: Thing,
    *,
    up: float,
    by: Vector,
    down: float,
    holds: tuple[float, float],
    times: tuple[float, float, float] = (0.8, 1.0, 0.8),
) -> None:
    """Lift, carry and lower with two holds in the air between; a hold of no time is a mere stop."""
    travel(hand, "Lift", (0.0, 0.0, up), times[0], thing)
    if holds[0]:
        hand.hold(holds[0], thing)
    travel(hand, "Carry", (*by, 0.0), times[1], thing)
    if holds[1]:
        hand.hold(holds[1], thing)
    travel(hand, "Lower", (0.0, 0.0, -down), times[2], thing, goal)


def home_again(hand: Hand, duration: float) -> None:
    """Let go, go home and stay for a moment."""
    hand.leave(duration)
    hand.idle(0.2)


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
