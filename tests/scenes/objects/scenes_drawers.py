"""Scenes in which a drawer is pulled open and pushed shut, empty or with things in it."""

from scenes.hands import shapes
from scenes.hands.performer import Hand
from scenes.hands.scene import performer
from scenes.hands.scenes_place import claw
from scenes.hands.stage import Stage, other_names
from scenes.hands.things import Thing
from scenes.objects.builders import (
    LEFTWARD,
    SINK,
    Cabinet,
    apple,
    cabinet,
    home_again,
    paused,
    scene,
    seize,
    travel,
)

FLOOR_M = 0.008 - SINK
"""Height of a drawer's inner floor over the cabinet's [m]."""


def grip_hand() -> shapes.Form:
    """A hand bent around a handle."""
    return shapes.gripping_hand(0.04, 0.04)


def pull(hand: Hand, chest: Cabinet, far: float, duration: float) -> None:
    """Open a drawer further by a length [m]."""
    travel(hand, "Open", (-far, 0.0, 0.0), duration, chest.drawer, chest.body)


def push(hand: Hand, chest: Cabinet, far: float, duration: float) -> None:
    """Shut a drawer by a length [m]."""
    travel(hand, "Close", (far, 0.0, 0.0), duration, chest.drawer, chest.body)


def in_drawer(s: Stage, chest: Cabinet, back: float, name: str = "apple") -> Thing:
    """An apple in a drawer, so far behind its front [m]."""
    place = chest.drawer.body.first[:3, 3]
    return apple(s, (place[0] + back, place[1], place[2] + 0.008), name, 0.03)


@scene
def drawer_pulled_open(s: Stage) -> None:
    """A drawer that is shut is pulled open by its handle and let go of."""
    performer(s, height=0.76, yaw_deg=15)
    s.table()
    chest = cabinet(s, (0.62, -0.1, s.height + 0.012))
    right = s.right(grip_hand())
    right.idle(0.2)
    seize(right, chest.drawer, chest.grip, 0.9, hold=0.4)
    pull(right, chest, 0.2, 1.0)
    right.hold(0.5, chest.drawer, chest.body)
    home_again(right, 0.8)


@scene
def drawer_pushed_shut(s: Stage) -> None:
    """A drawer that stands open is pushed shut, and the hand stays on its handle."""
    performer(s, height=0.9, yaw_deg=-110, size=1.06, agent="tall_man")
    s.table()
    chest = cabinet(s, (0.65, 0.1, s.height + 0.012), out=0.22)
    left = s.left(grip_hand())
    left.idle(0.2)
    seize(left, chest.drawer, chest.grip, 0.8, hold=0.3)
    push(left, chest, 0.22, 0.9)
    left.hold(0.8, chest.drawer, chest.body)


@scene
def drawer_open_and_shut(s: Stage) -> None:
    """A drawer is pulled open, held for a second and pushed shut in one contact."""
    performer(s, yaw_deg=70)
    s.table()
    chest = cabinet(s, (0.64, -0.05, s.height + 0.012))
    right = s.right(grip_hand())
    right.idle(0.2)
    seize(right, chest.drawer, chest.grip, 0.9, hold=0.3)
    pull(right, chest, 0.24, 1.1)
    right.hold(1.0, chest.drawer, chest.body)
    push(right, chest, 0.24, 1.0)
    right.hold(0.4, chest.drawer, chest.body)
    home_again(right, 0.8)


@scene
def loaded_drawer_pulled_open(s: Stage) -> None:
    """Two apples ride in a drawer that is pulled open very slowly."""
    performer(s, height=0.7, yaw_deg=-35, size=0.95, agent="old_man")
    s.table()
    chest = cabinet(s, (0.64, -0.1, s.height + 0.012))
    fruits = [in_drawer(s, chest, 0.08, "red_apple"), in_drawer(s, chest, 0.18, "green_apple")]
    right = s.right(grip_hand())
    right.idle(0.2)
    seize(right, chest.drawer, chest.grip, 1.4, hold=0.8)
    right.take_along(chest.drawer, *fruits)
    pull(right, chest, 0.22, 3.5)
    right.hold(1.2, chest.drawer, chest.body)
    home_again(right, 1.3)


@scene
def loaded_drawer_pushed_shut(s: Stage) -> None:
    """A drawer with an apple in it is pushed shut quickly, at once on contact."""
    performer(s, height=0.82, yaw_deg=240)
    s.table()
    chest = cabinet(s, (0.66, -0.1, s.height + 0.012), out=0.25)
    fruit = in_drawer(s, chest, 0.12)
    right = s.right(grip_hand())
    right.idle(0.15)
    seize(right, chest.drawer, chest.grip, 0.7)
    right.take_along(chest.drawer, fruit)
    push(right, chest, 0.25, 0.5)
    right.hold(0.5, chest.drawer, chest.body)
    home_again(right, 0.8)


@scene
def drawer_in_two_pulls(s: Stage) -> None:
    """A drawer is pulled half open, held, and pulled on; the hand stays on it."""
    performer(s, yaw_deg=125, offset=(0.3, -2.0))
    s.table()
    chest = cabinet(s, (0.66, 0.15, s.height + 0.012))
    left = s.left(grip_hand())
    left.idle(0.2)
    seize(left, chest.drawer, chest.grip, 0.9, hold=0.4)
    for far in (0.11, 0.13):
        pull(left, chest, far, 0.8)
        left.hold(0.6, chest.drawer, chest.body)


@scene
def apple_out_of_a_drawer(s: Stage) -> None:
    """The right hand opens a drawer and holds it; the left hand takes an apple out of it."""
    performer(s, yaw_deg=-160)
    table = s.table()
    chest = cabinet(s, (0.72, -0.05, s.height + 0.012))
    fruit = in_drawer(s, chest, 0.12)
    right, left = s.right(grip_hand()), s.left(claw())
    right.idle(0.2)
    seize(right, chest.drawer, chest.grip, 0.9, hold=0.3)
    right.take_along(chest.drawer, fruit)
    pull(right, chest, 0.24, 1.0)
    right.release()
    left.rest(right.clock)
    left.reach(fruit, "+z", 1.0, up=1.0, fingers=LEFTWARD)
    left.hold(0.4, fruit)
    left.take(fruit)
    left.lift_carry_lower(fruit, table, up=0.18, by=(0.0, 0.4), down=0.2 - SINK)
    left.hold(0.3, fruit, table)
    home_again(left, 1.0)
    right.hold(left.clock - right.clock, chest.drawer, chest.body)


@scene
def apple_into_a_drawer(s: Stage) -> None:
    """An apple is put into an open drawer, and after a rest the same hand pushes it shut."""
    performer(s, height=0.72, yaw_deg=50)
    s.table()
    chest = cabinet(s, (0.74, 0.15, s.height + 0.012), out=0.24)
    fruit = apple(s, (0.5, -0.35))
    right = s.right(claw())
    right.idle(0.2)
    right.reach(fruit, "+z", 0.9, up=1.0, fingers=LEFTWARD)
    right.hold(0.3, fruit)
    right.take(fruit)
    down = 0.22 - 0.012 - FLOOR_M
    paused(right, fruit, chest.drawer, up=0.22, by=(0.12, 0.5), down=down, holds=(0.0, 0.4))
    right.hold(0.3, fruit, chest.drawer)
    right.leave(1.0)
    right.rest(0.8)
    seize(right, chest.drawer, chest.grip, 1.0, hold=0.3)
    right.take_along(chest.drawer, fruit)
    push(right, chest, 0.24, 1.0)
    right.hold(0.4, chest.drawer, chest.body)
    home_again(right, 0.9)


@scene
def drawer_ajar_pulled_further(s: Stage) -> None:
    """A drawer that is never seen shut is pulled further out."""
    performer(s, height=0.85, yaw_deg=-10)
    s.table()
    chest = cabinet(s, (0.68, -0.1, s.height + 0.012), out=0.06)
    right = s.right(grip_hand())
    right.idle(0.2)
    seize(right, chest.drawer, chest.grip, 0.9, hold=0.4)
    travel(right, "Pull", (-0.18, 0.0, 0.0), 0.9, chest.drawer, chest.body)
    right.hold(0.5, chest.drawer, chest.body)
    home_again(right, 0.8)
    right.alternative = other_names(right, Pull="Open")


@scene
def drawer_half_shut_and_shut(s: Stage) -> None:
    """A drawer is pushed half way, let go of, and after a rest pushed shut."""
    performer(s, yaw_deg=165, size=1.04)
    s.table()
    chest = cabinet(s, (0.68, 0.1, s.height + 0.012), out=0.24)
    left = s.left(grip_hand())
    left.idle(0.2)
    seize(left, chest.drawer, chest.grip, 0.9, hold=0.3)
    push(left, chest, 0.12, 0.7)
    left.hold(0.3, chest.drawer, chest.body)
    left.leave(0.8)
    left.rest(1.0)
    seize(left, chest.drawer, chest.grip, 0.9)
    push(left, chest, 0.12, 0.7)
    left.hold(0.6, chest.drawer, chest.body)


@scene
def drawer_handle_only_touched(s: Stage) -> None:
    """The handle of a shut drawer is held for a while, and nothing moves."""
    performer(s, yaw_deg=-75)
    s.table()
    chest = cabinet(s, (0.66, -0.1, s.height + 0.012))
    right = s.right(grip_hand())
    right.idle(0.2)
    seize(right, chest.drawer, chest.grip, 1.0, hold=1.5, take=False)
    home_again(right, 0.9)
