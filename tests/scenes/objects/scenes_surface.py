"""Scenes in which a thing is pushed, pulled, slid or turned where it stands."""

from scenes.hands import shapes
from scenes.hands.scene import performer
from scenes.hands.stage import Stage
from scenes.hands.things import Thing
from scenes.objects import forms
from scenes.objects.builders import (
    NEAR,
    RIGHTWARD,
    UP,
    Grip,
    home_again,
    scene,
    seize,
    travel,
    wall,
)
from scenes.objects.scenes_drawers import grip_hand

HANDLE = Grip((-0.08 - forms.HANDLE_M, 0.0, 0.096), NEAR, RIGHTWARD)
"""The handle of a box of sixteen centimetres."""


def handled_box(s: Stage, at: tuple[float, float]) -> Thing:
    """A box with an upright handle plate on its near side."""
    return s.put("box", shapes.drawer_box(0.16, 0.2, 0.16), at)


@scene
def box_pushed_against_a_wall(s: Stage) -> None:
    """A box is pushed over the table until it meets the wall, and held there."""
    performer(s, yaw_deg=5)
    s.table()
    behind = wall(s, 1.02)
    box = s.put("box", shapes.box(0.16, 0.2, 0.14), (0.7, -0.1))
    right = s.right()
    right.idle(0.2)
    right.reach(box, "-x", 0.9, fingers=UP)
    right.hold(0.4, box)
    right.take(box)
    travel(right, "Push", (0.2402, 0.0, 0.0), 1.0, box, behind)
    right.hold(0.6, box, behind)
    home_again(right, 0.9)


@scene
def box_pushed_against_a_wall_at_once(s: Stage) -> None:
    """The left hand pushes a carton to the wall at once on contact, fast, and stays on it."""
    performer(s, height=0.9, yaw_deg=-140, size=1.05)
    s.table()
    behind = wall(s, 1.0)
    box = s.put("carton", shapes.carton(0.18, 0.22, 0.16), (0.6, 0.1))
    left = s.left()
    left.idle(0.15)
    left.reach(box, "-x", 0.8, fingers=UP)
    left.take(box)
    travel(left, "Push", (0.3102, 0.0, 0.0), 0.7, box, behind)
    left.hold(0.7, box, behind)


@scene
def box_pulled_off_a_wall(s: Stage) -> None:
    """A box that stands against the wall is pulled away from it by its handle."""
    performer(s, height=0.78, yaw_deg=65)
    table = s.table()
    wall(s, 0.98)
    box = handled_box(s, (0.9, -0.1))
    right = s.right(grip_hand())
    right.idle(0.2)
    seize(right, box, HANDLE, 0.9, hold=0.4)
    travel(right, "Pull", (-0.28, 0.0, 0.0), 1.1, box, table)
    right.hold(0.5, box, table)
    home_again(right, 0.8)


@scene
def box_pulled_and_pushed_back(s: Stage) -> None:
    """A box is pulled near very slowly, held, and pushed back by its handle."""
    performer(s, height=0.7, yaw_deg=-80, size=0.95, agent="old_woman")
    table = s.table()
    box = handled_box(s, (0.8, 0.1))
    left = s.left(grip_hand())
    left.idle(0.2)
    seize(left, box, HANDLE, 1.2, hold=0.5)
    travel(left, "Pull", (-0.22, 0.0, 0.0), 3.8, box, table)
    left.hold(1.0, box, table)
    travel(left, "Push", (0.2, 0.0, 0.0), 2.5, box, table)
    left.hold(0.6, box, table)


@scene
def plate_slid_aside(s: Stage) -> None:
    """A palm on a plate slides it to the right and goes home."""
    performer(s, yaw_deg=170)
    table = s.table()
    plate = s.put("plate", shapes.box(0.2, 0.2, 0.03, "plate"), (0.55, 0.1))
    right = s.right()
    right.idle(0.2)
    right.reach(plate, "+z", 0.9, up=1.0)
    right.take(plate)
    travel(right, "Slide", (0.05, -0.35, 0.0), 1.0, plate, table)
    right.hold(0.4, plate, table)
    home_again(right, 0.9)


@scene
def pot_turned_on_the_table(s: Stage) -> None:
    """A pot is turned by sixty degrees where it stands; the hand stays on its side."""
    performer(s, height=0.86, yaw_deg=-30, size=1.03)
    table = s.table()
    pot = s.put("pot", forms.pot(), (0.5, 0.05))
    left = s.left()
    left.idle(0.2)
    left.reach(pot, "+y", 0.9, up=0.5)
    left.hold(0.4, pot)
    left.take(pot)
    left.spin((0.5, 0.05, 0.0), UP, -60.0, 1.3)
    left.step("Turn", pot, table)
    left.hold(0.6, pot, table)


@scene
def beside_a_box_that_another_hand_pulls(s: Stage) -> None:
    """The right hand pulls a box near; the left hand rests in the air five centimetres beside."""
    performer(s, yaw_deg=50)
    table = s.table()
    box = handled_box(s, (0.8, -0.05))
    right = s.right(grip_hand())
    left = s.left(home=(0.62, 0.1, s.height + 0.1))
    right.idle(0.2)
    seize(right, box, HANDLE, 0.9, hold=0.4)
    travel(right, "Pull", (-0.24, 0.0, 0.0), 1.2, box, table)
    right.hold(0.5, box, table)
    left.rest(right.clock)


@scene
def along_with_a_box_that_another_hand_pushes(s: Stage) -> None:
    """The left hand pushes a box; the right hand goes along beside it and never touches it."""
    performer(s, height=0.8, yaw_deg=-105)
    table = s.table()
    box = s.put("box", shapes.box(0.16, 0.2, 0.16), (0.5, 0.1))
    left, right = s.left(), s.right(home=(0.42, -0.07, s.height + 0.1))
    left.idle(0.2)
    left.reach(box, "-x", 0.9, fingers=UP)
    left.hold(0.4, box)
    right.rest(left.clock)
    left.take(box)
    travel(left, "Push", (0.3, 0.0, 0.0), 1.2, box, table)
    right.go((0.72, -0.07, s.height + 0.1), 1.2)
    left.hold(0.6, box, table)
    right.rest(left.clock - right.clock)
