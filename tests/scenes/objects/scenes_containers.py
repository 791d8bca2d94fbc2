"""Containers, lids, pouring and loads; things in one hand, and from one hand to the other."""

from dataclasses import replace

import numpy as np

from scenes.hands import shapes
from scenes.hands.paths import AHEAD, LEFTWARD, NEAR, RIGHTWARD, UP
from scenes.hands.performer import EASE, GRAVITY, PRESS, Hand, travel
from scenes.hands.scene import at_table, performer
from scenes.hands.scenes_place import claw, fetch, finish
from scenes.hands.scenes_two_hands import both_leave, both_reach
from scenes.hands.stage import Stage, other_names
from scenes.hands.things import Thing
from scenes.objects import forms
from scenes.objects.builders import (
    Grip,
    apple,
    begin_with,
    bowl,
    can,
    chest,
    crate,
    home_again,
    paused,
    pillar,
    seize,
    toy,
)
from scenes.objects.scenes_furniture import grip_hand


def apple_into_a_bowl(s: Stage) -> None:
    """An apple is taken from the table and put into a bowl in one sweep."""
    at_table(s, yaw_deg=20)
    dish, fruit = bowl(s, (0.6, 0.2)), apple(s, (0.5, -0.25))
    right = s.right(claw(), idle=0.2)
    fetch(right, fruit, "+z", 0.9, 1.0, 0.0)
    right.lift_carry_lower(fruit, dish, up=0.2, by=(0.1, 0.45), down=0.195)
    finish(right, fruit, dish, 0.4, 1.1)


def apple_out_of_a_bowl(s: Stage) -> None:
    """The left hand takes an apple out of a bowl, pauses twice in the air and puts it down."""
    table = at_table(s, height=0.9, yaw_deg=-65, size=1.07, agent="tall_man")
    bowl(s, (0.55, 0.25))
    fruit = apple(s, (0.55, 0.25, s.height + 0.005))
    left = s.left(claw(), idle=0.2)
    fetch(left, fruit, "+z", 1.0, 1.0, 0.4)
    paused(left, fruit, table, up=0.2, by=(0.05, -0.4), down=0.205, holds=(0.6, 0.5))
    finish(left, fruit, table, 0.3, 1.0)


def can_into_a_crate(s: Stage) -> None:
    """A can is taken from above and stood in a crate, without any pause."""
    at_table(s, height=0.7, yaw_deg=170, offset=(1.0, 0.5))
    box, tin = crate(s, (0.6, 0.25)), can(s, (0.48, -0.3))
    right = s.right(idle=0.2)
    fetch(right, tin, "+z", 0.9, 1.0, 0.0)
    right.lift_carry_lower(tin, box, up=0.24, by=(0.1, 0.5), down=0.232)
    finish(right, tin, box, 0.0, 1.1)


def can_out_of_a_crate(s: Stage) -> None:
    """The left hand lifts a can out of a crate and stands it on the table, slowly."""
    table = at_table(s, height=0.72, yaw_deg=-140, size=0.94, agent="old_woman")
    crate(s, (0.6, 0.2))
    tin = can(s, (0.58, 0.18, s.height + 0.008), height=0.14)
    left = s.left(idle=0.2)
    fetch(left, tin, "+z", 1.5, 1.0, 1.2)
    left.lift_carry_lower(tin, table, up=0.2, by=(-0.1, -0.45), down=0.208, times=(1.6, 2.0, 1.6))
    finish(left, tin, table, 1.0, 1.5)


def cup_into_a_cup(s: Stage) -> None:
    """A narrow cup is stacked in a wide one."""
    at_table(s, height=0.8, yaw_deg=75)
    wide = s.put("wide_cup", shapes.vessel(0.06, 0.06, "cup"), (0.6, 0.15))
    narrow = s.put("narrow_cup", shapes.vessel(0.035, 0.11, "cup"), (0.5, -0.25))
    right = s.right(idle=0.2)
    fetch(right, narrow, "+z", 0.9, 1.0, 0.3)
    right.lift_carry_lower(narrow, wide, up=0.16, by=(0.1, 0.4), down=0.155)
    finish(right, narrow, wide, 0.3, 1.0)


def cup_out_of_a_cup(s: Stage) -> None:
    """The narrow cup is pulled up out of the wide one and held in the air until the end."""
    at_table(s, yaw_deg=255, size=1.03)
    s.put("wide_cup", shapes.vessel(0.06, 0.06, "cup"), (0.55, 0.1))
    place = (0.55, 0.1, s.height + 0.005)
    narrow = s.put("narrow_cup", shapes.vessel(0.035, 0.11, "cup"), place)
    left = s.left(idle=0.15)
    fetch(left, narrow, "+z", 0.9, 1.0, 0.35)
    travel(left, "Lift", (0.0, 0.0, 0.22), 0.9, narrow, hold=1.2)


def block_beside_a_bowl(s: Stage) -> None:
    """A block is carried to a bowl and stood beside it on the table."""
    table = at_table(s, yaw_deg=-30)
    bowl(s, (0.6, 0.3))
    cube = toy(s, (0.48, -0.3))
    right = s.right(claw(), idle=0.2)
    fetch(right, cube, "+z", 0.9, 1.0, 0.3)
    right.lift_carry_lower(cube, table, up=0.2, by=(0.1, 0.38), down=0.2)
    finish(right, cube, table, 0.3, 1.0)


def above_a_bowl_but_not_in(s: Stage) -> None:
    """An apple is held for a second above a bowl, then carried on and put on the table."""
    table = at_table(s, height=0.78, yaw_deg=110)
    bowl(s, (0.6, 0.0))
    fruit = apple(s, (0.55, -0.35))
    right = s.right(claw(), idle=0.2)
    fetch(right, fruit, "+z", 0.9, 1.0, 0.4)
    travel(right, "Lift", (0.0, 0.0, 0.22), 0.8, fruit, hold=0.3)
    travel(right, "Carry", (0.05, 0.35, 0.0), 0.9, fruit, hold=1.0)
    travel(right, "Carry", (-0.05, 0.33, 0.0), 0.9, fruit, hold=0.3)
    travel(right, "Lower", (0.0, 0.0, -0.22), 0.8, fruit, table)
    finish(right, fruit, table, 0.3, 1.1)


def from_a_bowl_to_a_crate(s: Stage) -> None:
    """An apple goes from a bowl straight to a crate."""
    at_table(s, height=0.85, yaw_deg=-5, size=1.05)
    bowl(s, (0.5, -0.3))
    box = crate(s, (0.62, 0.25))
    fruit = apple(s, (0.5, -0.3, s.height + 0.005))
    right = s.right(claw(), idle=0.2)
    fetch(right, fruit, "+z", 0.9, 1.0, 0.3)
    right.lift_carry_lower(fruit, box, up=0.26, by=(0.12, 0.55), down=0.257)
    finish(right, fruit, box, 0.4, 1.2)


def onto_a_stack(s: Stage) -> None:
    """A third block is put on a stack of two."""
    at_table(s, yaw_deg=95)
    toy(s, (0.6, 0.2), "first_block")
    second = toy(s, (0.6, 0.2, s.height + 0.07), "second_block")
    third = toy(s, (0.5, -0.2), "third_block")
    right = s.right(claw(), idle=0.2)
    fetch(right, third, "+z", 0.9, 1.0, 0.3)
    paused(right, third, second, up=0.24, by=(0.1, 0.4), down=0.1, holds=(0.0, 0.4))
    finish(right, third, second, 0.3, 1.0)


def off_a_stack(s: Stage) -> None:
    """A child takes the upper of two blocks and puts it on the table, quickly."""
    table = at_table(s, height=0.5, yaw_deg=-100, size=0.78, agent="child", offset=(-1.0, 2.0))
    toy(s, (0.5, 0.2), "lower_block", 0.06)
    upper = toy(s, (0.5, 0.2, s.height + 0.06), "upper_block", 0.06)
    left = s.left(idle=0.1)
    fetch(left, upper, "+y", 0.7, 0.8, 0.0)
    left.lift_carry_lower(upper, table, up=0.1, by=(0.05, -0.3), down=0.16, times=(0.45, 0.65, 0.5))
    finish(left, upper, table, 0.3, 0.7)


def two_cans_into_a_crate(s: Stage) -> None:
    """One can after the other is stood in a crate, with a rest at home between."""
    at_table(s, height=0.68, yaw_deg=130)
    box = crate(s, (0.62, 0.3))
    first, second = can(s, (0.48, -0.2), "first_can"), can(s, (0.65, -0.25), "second_can")
    right = s.right(idle=0.2)
    fetch(right, first, "+z", 0.8, 1.0, 0.0)
    right.lift_carry_lower(first, box, up=0.24, by=(0.07, 0.5), down=0.232)
    right.leave(1.0)
    right.rest(0.8)
    fetch(right, second, "+z", 0.9, 1.0, 0.3)
    right.lift_carry_lower(second, box, up=0.24, by=(0.05, 0.57), down=0.232)
    finish(right, second, box, 0.3, 1.1)


def apple_into_a_steadied_bowl(s: Stage) -> None:
    """The left hand keeps a bowl in its place while the right hand puts an apple in."""
    at_table(s, yaw_deg=40)
    dish, fruit = bowl(s, (0.55, 0.15)), apple(s, (0.5, -0.3))
    right, left = s.right(claw()), s.left()
    right.idle(0.2)
    fetch(right, fruit, "+z", 0.9, 1.0, 0.3)
    paused(right, fruit, dish, up=0.18, by=(0.05, 0.45), down=0.175, holds=(0.4, 0.0))
    finish(right, fruit, dish, 0.3, 1.1)
    left.idle(0.2)
    left.reach(dish, "+y", 0.8, up=0.7)
    left.hold(right.clock - 1.1 - left.clock, dish)
    home_again(left, 0.8)


def can_onto_a_tray(s: Stage) -> None:
    """The left hand takes a can from the table and stands it on a tray, slowly."""
    at_table(s, height=0.64, yaw_deg=-15, size=0.94, agent="old_woman")
    tray, tin = s.put("tray", shapes.tray(0.3, 0.36), (0.55, -0.2)), can(s, (0.48, 0.3))
    left = s.left(idle=0.2)
    fetch(left, tin, "+z", 1.4, 1.0, 0.8)
    left.lift_carry_lower(tin, tray, up=0.18, by=(0.05, -0.45), down=0.172, times=(1.4, 1.8, 1.4))
    finish(left, tin, tray, 0.8, 1.4)


def apple_out_of_a_pot_and_beside_it(s: Stage) -> None:
    """An apple is taken out of a pot and put on the table close to it, in one sweep."""
    table = at_table(s, yaw_deg=50)
    s.put("pot", forms.pot(0.13, 0.09), (0.6, 0.1))
    fruit = apple(s, (0.6, 0.1, s.height + 0.006))
    right = s.right(claw(), idle=0.2)
    fetch(right, fruit, "+z", 1.0, 1.0, 0.0)
    right.lift_carry_lower(fruit, table, up=0.2, by=(-0.05, -0.28), down=0.206)
    finish(right, fruit, table, 0.3, 1.0)


def bag_thrown_into_a_crate(s: Stage) -> None:
    """A bean bag on the palm is thrown into a crate at the far end of the table."""
    at_table(s, yaw_deg=-25, depth=1.2)
    crate(s, (0.8, -0.25))
    bag = s.put("bag", shapes.box(0.07, 0.07, 0.03, "bag"), (0.2, -0.25, s.height + 0.15))
    right = s.right()
    right.begin_at(bag, "-z", up=0.0, fingers=AHEAD)
    right.home = right.body.first
    right.take(bag)
    right.hold(0.6, bag)
    swing, velocity = 0.4, (0.9, 0.0, 1.4)
    height = 0.15 - 0.008 + velocity[2] * swing / 2.0
    flight = (velocity[2] + np.sqrt(velocity[2] ** 2 + 2.0 * GRAVITY * height)) / GRAVITY
    right.throw(bag, velocity, swing, float(flight))
    right.fly(right.home, 0.9)
    right.step("ResumePosture", bag)
    right.idle(0.2)


POT_M = 0.12
"""Height of a pot [m]."""


def lid_off_a_pot(s: Stage) -> None:
    """A lid is lifted off a pot by its knob and laid beside it in one sweep."""
    table = at_table(s, yaw_deg=-45)
    s.put("pot", forms.pot(), (0.55, 0.2))
    lid = s.put("lid", forms.round_lid(0.112), (0.55, 0.2, s.height + POT_M))
    right = s.right(idle=0.2)
    fetch(right, lid, "+z", 1.0, 1.0, 0.3)
    right.lift_carry_lower(lid, table, up=0.12, by=(0.0, -0.42), down=0.24)
    finish(right, lid, table, 0.3, 0.9)


def lid_onto_a_pot(s: Stage) -> None:
    """A lid is taken from the table and put on a pot, with pauses in the air."""
    at_table(s, height=0.88, yaw_deg=150, size=1.06)
    vessel = s.put("pot", forms.pot(), (0.6, -0.1))
    lid = s.put("lid", forms.round_lid(0.112), (0.55, 0.35))
    left = s.left(idle=0.2)
    fetch(left, lid, "+z", 0.9, 1.0, 0.4)
    paused(left, lid, vessel, up=0.24, by=(0.05, -0.45), down=0.12, holds=(0.4, 0.5))
    finish(left, lid, vessel, 0.4, 1.0)


def look_into_a_pot(s: Stage) -> None:
    """A lid is lifted straight off a pot, held for a second and a half, and put back."""
    at_table(s, height=0.8, yaw_deg=5)
    vessel = s.put("pot", forms.pot(), (0.55, -0.1))
    lid = s.put("lid", forms.round_lid(0.112), (0.55, -0.1, s.height + POT_M))
    right = s.right(idle=0.2)
    fetch(right, lid, "+z", 1.0, 1.0, 0.0)
    travel(right, "Lift", (0.0, 0.0, 0.16), 0.8, lid, hold=1.5)
    travel(right, "Lower", (0.0, 0.0, -0.16), 0.9, lid, vessel)
    finish(right, lid, vessel, 0.3, 0.9)


def lid_held_while_a_pot_is_filled(s: Stage) -> None:
    """The left hand holds a lid in the air while the right hand puts an apple into the pot."""
    at_table(s, yaw_deg=-120, size=1.02)
    vessel = s.put("pot", forms.pot(0.13), (0.55, 0.1))
    lid = s.put("lid", forms.round_lid(0.132), (0.55, 0.1, s.height + POT_M))
    fruit = apple(s, (0.5, -0.3))
    left, right = s.left(), s.right(claw())
    left.idle(0.2)
    fetch(left, lid, "+z", 1.0, 1.0, 0.3)
    travel(left, "Lift", (0.0, 0.0, 0.15), 0.8, lid, hold=0.3)
    travel(left, "Carry", (0.0, 0.36, 0.0), 0.9, lid)
    opened = left.clock
    right.rest(opened - 1.2)
    fetch(right, fruit, "+z", 0.9, 1.0, 0.3)
    right.lift_carry_lower(fruit, vessel, up=0.26, by=(0.05, 0.4), down=0.254)
    finish(right, fruit, vessel, 0.3, 1.1)
    left.hold(right.clock - left.clock, lid)


def lid_off_a_box(s: Stage) -> None:
    """The left hand takes the lid off a square box and keeps it in the air."""
    at_table(s, height=0.6, yaw_deg=65, size=0.9, agent="girl")
    s.put("box", forms.open_box(0.2, 0.2, 0.14, "box"), (0.5, 0.15))
    lid = s.put("lid", forms.square_lid(0.2, 0.2), (0.5, 0.15, s.height + 0.14))
    left = s.left(idle=0.15)
    fetch(left, lid, "+z", 0.8, 1.0, 0.5)
    travel(left, "Lift", (0.0, 0.0, 0.25), 0.8, lid, hold=1.0)


def lid_onto_a_box(s: Stage) -> None:
    """A lid that is held in the air from the first frame is lowered onto its box and left."""
    at_table(s, yaw_deg=215)
    box = s.put("box", forms.open_box(0.22, 0.22, 0.12, "box"), (0.55, -0.1))
    lid = s.put("lid", forms.square_lid(0.22, 0.22), (0.55, -0.1, s.height + 0.36))
    right = s.right()
    right.begin_at(lid, "+z", up=1.0, fingers=(1.0, 0.0, 0.0))
    right.take(lid)
    right.hold(0.6, lid)
    travel(right, "Lower", (0.0, 0.0, -0.24), 1.0, lid, box)
    finish(right, lid, box, 0.4, 0.9)


def chest_lid_opened(s: Stage) -> None:
    """A chest on the table is opened by the lip of its lid, which stays in the hand."""
    at_table(s, height=0.55, yaw_deg=30)
    trunk = chest(s, (0.7, -0.1, s.height))
    right = s.right(shapes.gripping_hand(0.04, 0.04), idle=0.2)
    seize(right, trunk.leaf, trunk.grip, 0.9, hold=0.4)
    trunk.hinge.turn(right, 65.0, 1.3)
    right.step("Open", trunk.leaf, trunk.body)
    right.hold(0.8, trunk.leaf, trunk.body)


def chest_lid_shut(s: Stage) -> None:
    """A lid that stands open is shut and let go of."""
    at_table(s, height=0.5, yaw_deg=-80, size=1.05)
    trunk = chest(s, (0.7, 0.1, s.height))
    trunk.hinge.opened(trunk.leaf, 60.0)
    left = s.left(shapes.gripping_hand(0.04, 0.04), idle=0.2)
    seize(left, trunk.leaf, trunk.grip, 1.1, hold=0.3)
    trunk.hinge.turn(left, -60.0, 1.2)
    left.step("Close", trunk.leaf, trunk.body)
    left.hold(0.4, trunk.leaf, trunk.body)
    home_again(left, 0.9)


def chest_lid_opened_and_shut(s: Stage) -> None:
    """A lid is opened at once on contact, held open for a second and shut again."""
    at_table(s, height=0.52, yaw_deg=190)
    trunk = chest(s, (0.68, -0.05, s.height))
    right = s.right(shapes.gripping_hand(0.04, 0.04), idle=0.2)
    seize(right, trunk.leaf, trunk.grip, 0.9)
    trunk.hinge.turn(right, 50.0, 0.9)
    right.step("Open", trunk.leaf, trunk.body)
    right.hold(1.0, trunk.leaf, trunk.body)
    trunk.hinge.turn(right, -50.0, 0.9)
    right.step("Close", trunk.leaf, trunk.body)
    right.hold(0.3, trunk.leaf, trunk.body)
    home_again(right, 0.9)


def can_out_of_a_chest(s: Stage) -> None:
    """The left hand opens a chest and holds its lid; the right hand takes out a can."""
    at_table(s, height=0.46, yaw_deg=100)
    trunk = chest(s, (0.75, 0.0, s.height), width=0.6, height=0.12)
    side = pillar(s, "stool", (0.7, -0.7, 0.6), (0.3, 0.3), "stool")
    tin = can(s, (0.7, -0.12, s.height + 0.014), height=0.1)
    left, right = s.left(shapes.gripping_hand(0.04, 0.04)), s.right()
    left.idle(0.2)
    seize(left, trunk.leaf, trunk.grip, 0.9, hold=0.3)
    trunk.hinge.turn(left, 80.0, 1.3)
    left.step("Open", trunk.leaf, trunk.body)
    right.rest(left.clock)
    fetch(right, tin, "+z", 1.1, 1.0, 0.3)
    right.lift_carry_lower(tin, side, up=0.2, by=(0.0, -0.58), down=0.074, times=(1.0, 1.0, 0.9))
    finish(right, tin, side, 0.3, 1.0)
    left.hold(right.clock - left.clock, trunk.leaf, trunk.body)


RIGHT_SIDE = Grip((0.0, -0.045, 0.07), (0.0, -1.0, 0.0), AHEAD)
"""The right side of a jug."""


def _raised_bowl(s: Stage) -> Thing:
    """A bowl on a fixed block, its rim twenty centimetres over the table."""
    s.put("block", shapes.box(0.12, 0.12, 0.14, "block"), (0.55, 0.15), tag="fixed")
    return s.put("bowl", shapes.vessel(0.09, 0.06, "bowl"), (0.55, 0.15, s.height + 0.14))


def jug_into_a_cup(s: Stage) -> None:
    """A jug is lifted beside a cup, tipped over it and back without touching it, and put down."""
    table, jug = at_table(s, yaw_deg=-20), s.put("jug", forms.jug(), (0.5, -0.25))
    s.put("cup", shapes.vessel(0.05, 0.08, "cup"), (0.5, -0.08))
    right = s.right(idle=0.2)
    fetch(right, jug, "-y", 0.9, 0.4, 0.3)
    travel(right, "Lift", (0.0, 0.0, 0.2), 0.8, jug, hold=0.5)
    right.dip((0.5, -0.2, s.height + 0.34), AHEAD, -100.0, 2.4)
    right.step("Pour", jug)
    right.hold(0.4, jug)
    travel(right, "Lower", (0.0, 0.0, -0.2), 0.9, jug, table)
    finish(right, jug, table, 0.3, 0.9)


def jug_on_the_rim_of_a_bowl(s: Stage) -> None:
    """A jug is brought to a bowl until its lip meets the rim, tipped about it and back."""
    at_table(s, height=0.65, yaw_deg=140)
    bowl = _raised_bowl(s)
    lip = s.height + 0.195
    place = (0.55, 0.15 - 0.09 - 0.045 - 0.2, lip - 0.16)
    jug = s.put("jug", forms.jug(), place)
    right = s.right()
    begin_with(right, jug, RIGHT_SIDE)
    right.hold(0.5, jug)
    travel(right, "MoveObjTo", (0.0, 0.2002, 0.0), 1.0, jug, bowl, hold=0.4)
    right.dip((0.55, 0.06, lip), AHEAD, -75.0, 2.2)
    right.step("Pour", jug, bowl)
    right.hold(0.5, jug, bowl)
    travel(right, "Carry", (0.0, -0.25, 0.0), 1.0, jug, hold=0.5)


def cup_into_a_bowl(s: Stage) -> None:
    """The left hand empties a cup, which it holds in the air throughout, quickly over a bowl."""
    at_table(s, height=0.84, yaw_deg=-115, size=0.98)
    s.put("bowl", shapes.vessel(0.11, 0.06, "bowl"), (0.5, -0.05))
    cup = s.put("cup", shapes.vessel(0.04, 0.09, "cup"), (0.5, 0.25, s.height + 0.22))
    left = s.left()
    left.begin_at(cup, "+y", up=0.6, fingers=AHEAD)
    left.take(cup)
    left.hold(0.6, cup)
    travel(left, "Carry", (0.0, -0.18, 0.0), 0.8, cup, hold=0.4)
    left.dip((0.5, 0.07, s.height + 0.26), AHEAD, 115.0, 1.3)
    left.step("Pour", cup)
    left.hold(0.6, cup)


def jug_tilted_and_kept(s: Stage) -> None:
    """A jug that is held in the air is tilted by forty degrees away from everything, and kept."""
    at_table(s, yaw_deg=75)
    jug = s.put("jug", forms.jug(), (0.5, -0.15, s.height + 0.2))
    right = s.right()
    begin_with(right, jug, RIGHT_SIDE)
    right.hold(0.6, jug)
    right.spin((0.5, -0.15, s.height + 0.28), AHEAD, -40.0, 1.1)
    right.step("Tilt", jug)
    right.hold(0.9, jug)


def tray_with_a_jug(s: Stage) -> None:
    """Both hands carry a tray with a jug and a cup to the right, pausing twice in the air."""
    performer(s, height=0.8, yaw_deg=-55, size=1.04)
    table, tray = s.table(), s.put("tray", shapes.tray(0.3, 0.38), (0.55, 0.2))
    jug = s.put("jug", forms.jug(0.04, 0.15), (0.55, 0.12, s.height + 0.008))
    cup = s.put("cup", shapes.vessel(0.035, 0.08, "cup"), (0.55, 0.27, s.height + 0.008))
    hands = both_reach(s, tray, 1.05, 0.75, 0.5)
    right, left = hands
    since = len(right.steps)
    left.join(tray)
    right.take(tray, jug, cup)
    paused(right, tray, table, up=0.2, by=(0.05, -0.4), down=0.2, holds=(0.5, 0.4))
    right.hold(0.4, tray, table)
    left.part(right, since)
    both_leave(hands, 0.9)


def tray_with_apples_in_one_sweep(s: Stage) -> None:
    """A tray with three apples goes over to the left without any pause."""
    performer(s, height=0.7, yaw_deg=130)
    table, tray = s.table(), s.put("tray", shapes.tray(0.26, 0.34), (0.55, -0.25))
    fruits = [
        apple(s, (0.5 + 0.05 * k, -0.33 + 0.08 * k, s.height + 0.008), f"apple_{k}")
        for k in range(3)
    ]
    hands = both_reach(s, tray, 1.05, 0.75, 0.0)
    right, left = hands
    since = len(right.steps)
    left.join(tray)
    right.take(tray, *fruits)
    right.lift_carry_lower(tray, table, up=0.15, by=(0.0, 0.45), down=0.15, times=(0.9, 1.3, 0.9))
    left.part(right, since)
    both_leave(hands, 1.0)


def basket_with_apples(s: Stage) -> None:
    """A basket with two apples is carried by its arched handle."""
    table = at_table(s, height=0.6, yaw_deg=-5)
    pannier = s.put("basket", forms.basket(0.26, 0.3, 0.1, 0.26), (0.5, -0.25))
    fruits = [
        apple(s, (0.5 + x, -0.25, s.height + 0.008), name)
        for x, name in ((-0.06, "red_apple"), (0.06, "green_apple"))
    ]
    right = s.right(idle=0.2)
    right.reach(pannier, "+z", 1.0, up=1.0, hold=0.4)
    right.take(pannier, *fruits)
    right.lift_carry_lower(pannier, table, up=0.18, by=(0.05, 0.5), down=0.18)
    finish(right, pannier, table, 0.3, 1.0)


def empty_basket(s: Stage) -> None:
    """An empty basket is lifted by its handle with the left hand, held and set down again."""
    table = at_table(s, height=0.5, yaw_deg=85, size=1.06)
    pannier = s.put("basket", forms.basket(0.24, 0.28, 0.1, 0.28), (0.5, 0.15))
    left = s.left(idle=0.2)
    fetch(left, pannier, "+z", 1.0, 1.0, 0.3)
    travel(left, "Lift", (0.0, 0.0, 0.25), 0.9, pannier, hold=1.0)
    travel(left, "Lower", (0.0, 0.0, -0.25), 1.0, pannier, table)
    finish(left, pannier, table, 0.3, 0.9)


def carton_with_cans(s: Stage) -> None:
    """Both hands carry a carton with two cans from the table to a higher side table and stay."""
    at_table(s, height=0.78, yaw_deg=-170, width=0.7)
    side = s.put(
        "side_table", shapes.box(0.5, 0.5, 0.92, "side_table"), (0.5, 0.75, 0.0), tag="fixed"
    )
    carton = s.put("carton", shapes.carton(0.22, 0.28, 0.14), (0.5, 0.1))
    tins = [
        can(s, (0.5, y, s.height + 0.006), name, 0.11)
        for y, name in ((0.04, "first_can"), (0.16, "second_can"))
    ]
    hands = both_reach(s, carton, 1.0, 0.5, 0.4)
    right, left = hands
    since = len(right.steps)
    left.join(carton)
    right.take(carton, *tins)
    right.lift_carry_lower(carton, side, up=0.28, by=(0.1, 0.62), down=0.14, times=(0.8, 1.3, 1.0))
    right.hold(0.8, carton, side)
    left.part(right, since)


def plate_on_the_palm(s: Stage) -> None:
    """A plate with a cup on it lies on the palm from the first frame; it is raised and carried."""
    at_table(s, height=0.75, yaw_deg=60)
    plate = s.put("plate", shapes.box(0.2, 0.2, 0.015, "plate"), (0.4, -0.3, s.height + 0.15))
    cup = s.put("cup", shapes.vessel(0.035, 0.08, "cup"), (0.42, -0.3, s.height + 0.165))
    right = s.right()
    right.begin_at(plate, "-z", up=0.0, fingers=AHEAD)
    right.take(plate, cup)
    right.hold(0.5, plate)
    travel(right, "Raise", (0.0, 0.0, 0.2), 0.9, plate, hold=0.5)
    travel(right, "Carry", (0.1, 0.4, 0.0), 1.2, plate, hold=0.6)


def block_with_a_block_on_top(s: Stage) -> None:
    """Two blocks, one on the other, are moved by the lower one with the left hand."""
    table = at_table(s, height=0.9, yaw_deg=10)
    lower = s.put("lower_block", shapes.box(0.12, 0.1, 0.1, "block"), (0.5, 0.3))
    upper = toy(s, (0.5, 0.3, s.height + 0.1), "upper_block", 0.05)
    left = s.left(idle=0.2)
    left.reach(lower, "+y", 0.9, hold=0.3)
    left.take(lower, upper)
    left.lift_carry_lower(lower, table, up=0.15, by=(0.1, -0.45), down=0.15, times=(0.9, 1.2, 0.9))
    finish(left, lower, table, 0.3, 1.0)


def loaded_crate_pulled(s: Stage) -> None:
    """A crate with a can in it is drawn near over the table by its handle."""
    table = at_table(s, height=0.72, yaw_deg=-95)
    parts = forms.open_box(0.24, 0.24, 0.1, "crate").parts
    handle = shapes.block((-0.12 - forms.HANDLE_M, -0.004, 0.02), (-0.12, 0.004, 0.08))
    box = s.put("crate", shapes.Form("crate", (*parts, handle)), (0.8, -0.05))
    tin = can(s, (0.8, -0.02, s.height + 0.008))
    right = s.right(grip_hand(), idle=0.2)
    grip = Grip((-0.12 - forms.HANDLE_M, 0.0, 0.05), NEAR, RIGHTWARD)
    seize(right, box, grip, 0.9, hold=0.4)
    right.take_along(box, tin)
    travel(right, "Pull", (-0.24, 0.0, 0.0), 1.0, box, table, hold=0.4)
    home_again(right, 0.7)


def loaded_crate_pushed_by_both(s: Stage) -> None:
    """Both palms push a crate with two cans away, at once on contact and slowly."""
    table = at_table(s, height=0.85, yaw_deg=220, size=0.97)
    box = s.put("crate", forms.open_box(0.24, 0.5, 0.14, "crate"), (0.5, 0.0))
    tins = [
        can(s, (0.5, y, s.height + 0.008), name)
        for y, name in ((-0.12, "first_can"), (0.12, "second_can"))
    ]
    hands = [s.right(), s.left()]
    for hand, aside in zip(hands, (-0.13, 0.13), strict=True):
        hand.idle(0.2)
        hand.reach(box, "-x", 0.9, fingers=UP, aside=(0.0, aside, 0.0))
    right, left = hands
    since = len(right.steps)
    left.join(box)
    right.take(box, *tins)
    travel(right, "Push", (0.25, 0.0, 0.0), 2.2, box, table, hold=0.6)
    left.part(right, since)
    both_leave(hands, 0.9)


def tray_held_from_the_first_frame(s: Stage) -> None:
    """A tray with a can on it is held in the air by both hands, lowered on the table and kept."""
    table = at_table(s, yaw_deg=25, offset=(1.5, 1.5))
    tray = s.put("tray", shapes.tray(0.28, 0.36), (0.5, 0.0, s.height + 0.25))
    tin = can(s, (0.5, 0.05, s.height + 0.258), height=0.1)
    right, left = s.right(), s.left()
    for hand, side in ((right, "-y"), (left, "+y")):
        hand.begin_at(tray, side, up=0.75, fingers=AHEAD)
    left.join(tray)
    right.take(tray, tin)
    right.hold(0.7, tray)
    travel(right, "Lower", (0.0, 0.0, -0.25), 1.1, tray, table, hold=0.8)
    left.part(right, 0)


PALM_M, FINGERS_M = -0.01, 0.085
"""Where two cups lie along a hand, from its origin towards its fingers [m]."""

RADIUS_M = 0.03
"""Of these cups [m]."""


def also(hand: Hand, thing: Thing, since: float, until: float | None = None) -> None:
    """Note that a hand touches a second thing as well, from a time to another or to now [s]."""
    hand.contacts.append((thing, since, hand.clock if until is None else until))


def hold_both(hand: Hand, duration: float, *things: Thing) -> None:
    """Stay and touch two things with the hand itself: a Touch of both."""
    hand.clock += duration
    hand.step("Touch", *things)


def slim_cup(s: Stage, name: str, x: float, y: float, z: float) -> Thing:
    """A slim cup on the table or so far over it [m]."""
    form = shapes.vessel(RADIUS_M, 0.1, "cup")
    return s.put(name, form, (x, y, s.height + z))


def second_cup_taken(s: Stage) -> None:
    """A hand that holds a cup goes on to a second one, takes it too and lifts both."""
    at_table(s, yaw_deg=-45)
    gap = 0.25
    first = slim_cup(s, "first_cup", 0.45, -0.2 - gap, 0.03)
    second = slim_cup(s, "second_cup", 0.45 + FINGERS_M - PALM_M, -0.2 - PRESS, 0.0)
    right = s.right()
    right.begin_at(first, "-y", up=0.6, fingers=AHEAD, aside=(-PALM_M, 0.0, 0.0))
    right.take(first)
    right.hold(0.5, first)
    travel(right, "Carry", (0.0, gap, 0.0), 1.0, first, second, arrive=EASE)
    since = right.clock
    hold_both(right, 0.4, first, second)
    right.held.append(second.body.ride(right.body, right.clock))
    travel(right, "Lift", (0.0, 0.0, 0.2), 0.9, first, second)
    hold_both(right, 0.8, first, second)
    also(right, second, since)
    start, carry, *others = right.steps
    reach = replace(carry, name="Reach", objects=(second.name, first.name))
    right.alternative = (start, reach, *others)


def two_cups_lifted_at_once(s: Stage) -> None:
    """The left hand meets two cups at the same moment, lifts both and keeps them."""
    at_table(s, height=0.85, yaw_deg=110, size=1.0)
    first = slim_cup(s, "first_cup", 0.45, 0.15, 0.0)
    second = slim_cup(s, "second_cup", 0.45 + FINGERS_M - PALM_M, 0.15 + PRESS, 0.0)
    left = s.left(idle=0.2)
    left.reach(first, "+y", 0.9, up=0.6, aside=(-PALM_M, 0.0, 0.0), others=(second,))
    since = left.clock
    hold_both(left, 0.4, first, second)
    left.take(first)
    left.held.append(second.body.ride(left.body, left.clock))
    travel(left, "Lift", (0.0, 0.0, 0.2), 0.9, first, second)
    hold_both(left, 0.9, first, second)
    also(left, second, since)


def blocks_on_the_palm(s: Stage, hand: Hand) -> tuple[Thing, Thing]:
    """Two blocks side by side on a palm that faces up, from the first frame."""
    place = (0.4, -0.2, s.height + 0.12)
    first = s.put("first_block", shapes.box(0.05, 0.05, 0.05, "block"), place)
    second = s.put("second_block", shapes.box(0.045, 0.05, 0.09, "block"), (0.465, *place[1:]))
    hand.body.first = Grip((0.01, 0.0, 0.0), (0.0, 0.0, -1.0), AHEAD).on(first, 0.0)
    hand.meet(first)
    hand.take(first)
    hand.held.append(second.body.ride(hand.body, 0.0))
    return first, second


def two_blocks_raised_on_the_palm(s: Stage) -> None:
    """Two blocks lie on the palm; both are raised, carried to the left and kept."""
    at_table(s, height=0.7, yaw_deg=20)
    right = s.right()
    first, second = blocks_on_the_palm(s, right)
    hold_both(right, 0.5, first, second)
    travel(right, "Raise", (0.0, 0.0, 0.22), 0.9, first, second)
    hold_both(right, 0.5, first, second)
    travel(right, "Carry", (0.05, 0.3, 0.0), 1.0, first, second)
    hold_both(right, 0.6, first, second)
    also(right, second, 0.0)


def one_of_two_taken_away(s: Stage) -> None:
    """Two blocks are raised on the right palm; the left hand takes the taller one to the table."""
    table = at_table(s, yaw_deg=-165)
    right, left = s.right(), s.left(claw())
    first, second = blocks_on_the_palm(s, right)
    hold_both(right, 0.5, first, second)
    travel(right, "Raise", (0.0, 0.0, 0.15), 0.8, first, second)
    raised = right.clock
    left.rest(raised + 0.3)
    left.reach(second, "+z", 1.1, up=1.0, fingers=LEFTWARD, name="Receive", when=raised)
    left.hold(0.5, second)
    right.held.pop().end = left.clock
    left.take(second)
    right.until(left.clock)
    right.step("Touch", first, second)
    also(right, second, 0.0)
    left.lift_carry_lower(second, table, up=0.15, by=(0.05, 0.4), down=0.42)
    left.hold(0.3, second, table)
    home_again(left, 1.0)
    right.hold(left.clock - right.clock, first)
    left.alternative = tuple(
        replace(each, name="Reach") if each.name == "Receive" else each for each in left.steps
    )


def handed(giver: Hand, taker: Hand, thing: Thing, *, far: float) -> None:
    """Carry a thing to the other hand, which comes, takes it and keeps it."""
    sign = -1.0 if giver.side == "right" else 1.0
    travel(giver, "Carry", (0.0, -sign * far, 0.0), 0.9, thing)
    giver.clock += 0.35
    taker.idle(0.2)
    side = "+y" if giver.side == "right" else "-y"
    taker.reach(thing, side, giver.clock - 0.2, name="Receive", when=giver.clock)
    giver.hold(taker.clock + 0.5 - giver.clock, thing)
    taker.until(giver.clock)
    giver.leave(1.2, name="Give")
    giver.idle(0.2)
    taker.hold(0.4, thing)
    taker.take(thing)
    giver.alternative = other_names(giver, Give="ResumePosture")
    taker.alternative = other_names(taker, Receive="Reach")


def ball_passed_and_put_on_a_box(s: Stage) -> None:
    """The right hand gives a ball to the left hand, which lowers it onto a box."""
    at_table(s, yaw_deg=35)
    box = s.put("box", shapes.box(0.14, 0.14, 0.1), (0.45, -0.02))
    ball = s.put("ball", shapes.ball(0.06), (0.45, -0.3, s.height + 0.28))
    right, left = s.right(), s.left()
    right.begin_at(ball, "-y", up=0.5, fingers=(1.0, 0.0, 0.0))
    right.take(ball)
    right.hold(0.5, ball)
    handed(right, left, ball, far=0.28)
    travel(left, "Lower", (0.0, 0.0, -0.12), 0.7, ball, box, hold=0.4)


def ball_passed_through_a_frame(s: Stage) -> None:
    """The left hand passes a ball through a window frame to the right hand, which keeps it."""
    at_table(s, height=0.85, yaw_deg=-150, size=1.05)
    s.put("window", forms.frame(0.5, 0.5), (0.5, 0.1), tag="fixed")
    ball = s.put("ball", shapes.ball(0.06), (0.5, 0.36, s.height + 0.25))
    left, right = s.left(home=(0.15, 0.4, s.height + 0.15)), s.right()
    left.begin_at(ball, "+y", up=0.5, fingers=(1.0, 0.0, 0.0))
    left.take(ball)
    left.hold(0.5, ball)
    handed(left, right, ball, far=0.3)
    travel(right, "Carry", (0.0, -0.2, 0.0), 0.6, ball)
    right.hold(left.clock - right.clock, ball)
