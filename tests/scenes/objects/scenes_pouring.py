"""Scenes in which a jug or a cup is tipped over another vessel, with and without contact."""

from scenes.hands import shapes
from scenes.hands.scene import performer
from scenes.hands.scenes_place import fetch, finish
from scenes.hands.stage import Stage
from scenes.hands.things import Thing
from scenes.objects import forms
from scenes.objects.builders import AHEAD, Grip, begin_with, scene, travel

RIGHT_SIDE = Grip((0.0, -0.045, 0.07), (0.0, -1.0, 0.0), AHEAD)
"""The right side of a jug."""


def raised_bowl(s: Stage) -> Thing:
    """A bowl on a fixed block, its rim twenty centimetres over the table."""
    s.put("block", shapes.box(0.12, 0.12, 0.14, "block"), (0.55, 0.15), tag="fixed")
    return s.put("bowl", shapes.vessel(0.09, 0.06, "bowl"), (0.55, 0.15, s.height + 0.14))


@scene
def jug_into_a_cup(s: Stage) -> None:
    """A jug is lifted beside a cup, tipped over it and back without touching it, and put down."""
    performer(s, yaw_deg=-20)
    table, jug = s.table(), s.put("jug", forms.jug(), (0.5, -0.25))
    s.put("cup", shapes.vessel(0.05, 0.08, "cup"), (0.5, -0.08))
    right = s.right()
    right.idle(0.2)
    fetch(right, jug, "-y", 0.9, 0.4, 0.3)
    travel(right, "Lift", (0.0, 0.0, 0.2), 0.8, jug)
    right.hold(0.5, jug)
    right.dip((0.5, -0.2, s.height + 0.34), AHEAD, -100.0, 2.4)
    right.step("Pour", jug)
    right.hold(0.4, jug)
    travel(right, "Lower", (0.0, 0.0, -0.2), 0.9, jug, table)
    finish(right, jug, table, 0.3, 0.9)


@scene
def jug_on_the_rim_of_a_bowl(s: Stage) -> None:
    """A jug is brought to a bowl until its lip meets the rim, tipped about it and back."""
    performer(s, height=0.65, yaw_deg=140)
    s.table()
    bowl = raised_bowl(s)
    lip = s.height + 0.195
    place = (0.55, 0.15 - 0.09 - 0.045 - 0.2, lip - 0.16)
    jug = s.put("jug", forms.jug(), place)
    right = s.right()
    begin_with(right, jug, RIGHT_SIDE)
    right.hold(0.5, jug)
    travel(right, "MoveObjTo", (0.0, 0.2002, 0.0), 1.0, jug, bowl)
    right.hold(0.4, jug, bowl)
    right.dip((0.55, 0.06, lip), AHEAD, -75.0, 2.2)
    right.step("Pour", jug, bowl)
    right.hold(0.5, jug, bowl)
    travel(right, "Carry", (0.0, -0.25, 0.0), 1.0, jug)
    right.hold(0.5, jug)


@scene
def cup_into_a_bowl(s: Stage) -> None:
    """The left hand empties a cup, which it holds in the air throughout, quickly over a bowl."""
    performer(s, height=0.84, yaw_deg=-115, size=0.98)
    s.table()
    s.put("bowl", shapes.vessel(0.11, 0.06, "bowl"), (0.5, -0.05))
    cup = s.put("cup", shapes.vessel(0.04, 0.09, "cup"), (0.5, 0.25, s.height + 0.22))
    left = s.left()
    left.begin_at(cup, "+y", up=0.6, fingers=AHEAD)
    left.take(cup)
    left.hold(0.6, cup)
    travel(left, "Carry", (0.0, -0.18, 0.0), 0.8, cup)
    left.hold(0.4, cup)
    left.dip((0.5, 0.07, s.height + 0.26), AHEAD, 115.0, 1.3)
    left.step("Pour", cup)
    left.hold(0.6, cup)


@scene
def jug_tilted_and_kept(s: Stage) -> None:
    """A jug that is held in the air is tilted by forty degrees away from everything, and kept."""
    performer(s, yaw_deg=75)
    s.table()
    jug = s.put("jug", forms.jug(), (0.5, -0.15, s.height + 0.2))
    right = s.right()
    begin_with(right, jug, RIGHT_SIDE)
    right.hold(0.6, jug)
    right.spin((0.5, -0.15, s.height + 0.28), AHEAD, -40.0, 1.1)
    right.step("Tilt", jug)
    right.hold(0.9, jug)
