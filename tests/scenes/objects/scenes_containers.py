"""Scenes in which things are put into, taken out of, stacked in and stood beside containers."""

import numpy as np

from scenes.hands import shapes
from scenes.hands.performer import GRAVITY
from scenes.hands.scene import performer
from scenes.hands.scenes_place import claw, fetch, finish
from scenes.hands.stage import Stage
from scenes.objects import forms
from scenes.objects.builders import (
    AHEAD,
    apple,
    bowl,
    can,
    crate,
    home_again,
    paused,
    scene,
    toy,
    travel,
)


@scene
def apple_into_a_bowl(s: Stage) -> None:
    """An apple is taken from the table and put into a bowl in one sweep."""
    performer(s, yaw_deg=20)
    s.table()
    dish, fruit = bowl(s, (0.6, 0.2)), apple(s, (0.5, -0.25))
    right = s.right(claw())
    right.idle(0.2)
    fetch(right, fruit, "+z", 0.9, 1.0, 0.0)
    right.lift_carry_lower(fruit, dish, up=0.2, by=(0.1, 0.45), down=0.195)
    finish(right, fruit, dish, 0.4, 1.1)


@scene
def apple_out_of_a_bowl(s: Stage) -> None:
    """The left hand takes an apple out of a bowl, pauses twice in the air and puts it down."""
    performer(s, height=0.9, yaw_deg=-65, size=1.07, agent="tall_man")
    table = s.table()
    bowl(s, (0.55, 0.25))
    fruit = apple(s, (0.55, 0.25, s.height + 0.005))
    left = s.left(claw())
    left.idle(0.2)
    fetch(left, fruit, "+z", 1.0, 1.0, 0.4)
    paused(left, fruit, table, up=0.2, by=(0.05, -0.4), down=0.205, holds=(0.6, 0.5))
    finish(left, fruit, table, 0.3, 1.0)


@scene
def can_into_a_crate(s: Stage) -> None:
    """A can is taken from above and stood in a crate, without any pause."""
    performer(s, height=0.7, yaw_deg=170, offset=(1.0, 0.5))
    s.table()
    box, tin = crate(s, (0.6, 0.25)), can(s, (0.48, -0.3))
    right = s.right()
    right.idle(0.2)
    fetch(right, tin, "+z", 0.9, 1.0, 0.0)
    right.lift_carry_lower(tin, box, up=0.24, by=(0.1, 0.5), down=0.232)
    finish(right, tin, box, 0.0, 1.1)


@scene
def can_out_of_a_crate(s: Stage) -> None:
    """The left hand lifts a can out of a crate and stands it on the table, slowly."""
    performer(s, height=0.72, yaw_deg=-140, size=0.94, agent="old_woman")
    table = s.table()
    crate(s, (0.6, 0.2))
    tin = can(s, (0.58, 0.18, s.height + 0.008), height=0.14)
    left = s.left()
    left.idle(0.2)
    fetch(left, tin, "+z", 1.5, 1.0, 1.2)
    left.lift_carry_lower(tin, table, up=0.2, by=(-0.1, -0.45), down=0.208, times=(1.6, 2.0, 1.6))
    finish(left, tin, table, 1.0, 1.5)


@scene
def cup_into_a_cup(s: Stage) -> None:
    """A narrow cup is stacked in a wide one."""
    performer(s, height=0.8, yaw_deg=75)
    s.table()
    wide = s.put("wide_cup", shapes.vessel(0.06, 0.06, "cup"), (0.6, 0.15))
    narrow = s.put("narrow_cup", shapes.vessel(0.035, 0.11, "cup"), (0.5, -0.25))
    right = s.right()
    right.idle(0.2)
    fetch(right, narrow, "+z", 0.9, 1.0, 0.3)
    right.lift_carry_lower(narrow, wide, up=0.16, by=(0.1, 0.4), down=0.155)
    finish(right, narrow, wide, 0.3, 1.0)


@scene
def cup_out_of_a_cup(s: Stage) -> None:
    """The narrow cup is pulled up out of the wide one and held in the air until the end."""
    performer(s, yaw_deg=255, size=1.03)
    s.table()
    s.put("wide_cup", shapes.vessel(0.06, 0.06, "cup"), (0.55, 0.1))
    place = (0.55, 0.1, s.height + 0.005)
    narrow = s.put("narrow_cup", shapes.vessel(0.035, 0.11, "cup"), place)
    left = s.left()
    left.idle(0.15)
    fetch(left, narrow, "+z", 0.9, 1.0, 0.35)
    travel(left, "Lift", (0.0, 0.0, 0.22), 0.9, narrow)
    left.hold(1.2, narrow)


@scene
def block_beside_a_bowl(s: Stage) -> None:
    """A block is carried to a bowl and stood beside it on the table."""
    performer(s, yaw_deg=-30)
    table = s.table()
    bowl(s, (0.6, 0.3))
    cube = toy(s, (0.48, -0.3))
    right = s.right(claw())
    right.idle(0.2)
    fetch(right, cube, "+z", 0.9, 1.0, 0.3)
    right.lift_carry_lower(cube, table, up=0.2, by=(0.1, 0.38), down=0.2)
    finish(right, cube, table, 0.3, 1.0)


@scene
def above_a_bowl_but_not_in(s: Stage) -> None:
    """An apple is held for a second above a bowl, then carried on and put on the table."""
    performer(s, height=0.78, yaw_deg=110)
    table = s.table()
    bowl(s, (0.6, 0.0))
    fruit = apple(s, (0.55, -0.35))
    right = s.right(claw())
    right.idle(0.2)
    fetch(right, fruit, "+z", 0.9, 1.0, 0.4)
    travel(right, "Lift", (0.0, 0.0, 0.22), 0.8, fruit)
    right.hold(0.3, fruit)
    travel(right, "Carry", (0.05, 0.35, 0.0), 0.9, fruit)
    right.hold(1.0, fruit)
    travel(right, "Carry", (-0.05, 0.33, 0.0), 0.9, fruit)
    right.hold(0.3, fruit)
    travel(right, "Lower", (0.0, 0.0, -0.22), 0.8, fruit, table)
    finish(right, fruit, table, 0.3, 1.1)


@scene
def from_a_bowl_to_a_crate(s: Stage) -> None:
    """An apple goes from a bowl straight to a crate."""
    performer(s, height=0.85, yaw_deg=-5, size=1.05)
    s.table()
    bowl(s, (0.5, -0.3))
    box = crate(s, (0.62, 0.25))
    fruit = apple(s, (0.5, -0.3, s.height + 0.005))
    right = s.right(claw())
    right.idle(0.2)
    fetch(right, fruit, "+z", 0.9, 1.0, 0.3)
    right.lift_carry_lower(fruit, box, up=0.26, by=(0.12, 0.55), down=0.257)
    finish(right, fruit, box, 0.4, 1.2)


@scene
def onto_a_stack(s: Stage) -> None:
    """A third block is put on a stack of two."""
    performer(s, yaw_deg=95)
    s.table()
    toy(s, (0.6, 0.2), "first_block")
    second = toy(s, (0.6, 0.2, s.height + 0.07), "second_block")
    third = toy(s, (0.5, -0.2), "third_block")
    right = s.right(claw())
    right.idle(0.2)
    fetch(right, third, "+z", 0.9, 1.0, 0.3)
    paused(right, third, second, up=0.24, by=(0.1, 0.4), down=0.1, holds=(0.0, 0.4))
    finish(right, third, second, 0.3, 1.0)


@scene
def off_a_stack(s: Stage) -> None:
    """A child takes the upper of two blocks and puts it on the table, quickly."""
    performer(s, height=0.5, yaw_deg=-100, size=0.78, agent="child", offset=(-1.0, 2.0))
    table = s.table()
    toy(s, (0.5, 0.2), "lower_block", 0.06)
    upper = toy(s, (0.5, 0.2, s.height + 0.06), "upper_block", 0.06)
    left = s.left()
    left.idle(0.1)
    fetch(left, upper, "+y", 0.7, 0.8, 0.0)
    left.lift_carry_lower(upper, table, up=0.1, by=(0.05, -0.3), down=0.16, times=(0.45, 0.65, 0.5))
    finish(left, upper, table, 0.3, 0.7)


@scene
def two_cans_into_a_crate(s: Stage) -> None:
    """One can after the other is stood in a crate, with a rest at home between."""
    performer(s, height=0.68, yaw_deg=130)
    s.table()
    box = crate(s, (0.62, 0.3))
    first, second = can(s, (0.48, -0.2), "first_can"), can(s, (0.65, -0.25), "second_can")
    right = s.right()
    right.idle(0.2)
    fetch(right, first, "+z", 0.8, 1.0, 0.0)
    right.lift_carry_lower(first, box, up=0.24, by=(0.07, 0.5), down=0.232)
    right.leave(1.0)
    right.rest(0.8)
    fetch(right, second, "+z", 0.9, 1.0, 0.3)
    right.lift_carry_lower(second, box, up=0.24, by=(0.05, 0.57), down=0.232)
    finish(right, second, box, 0.3, 1.1)


@scene
def apple_into_a_steadied_bowl(s: Stage) -> None:
    """The left hand keeps a bowl in its place while the right hand puts an apple in."""
    performer(s, yaw_deg=40)
    s.table()
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


@scene
def can_onto_a_tray(s: Stage) -> None:
    """The left hand takes a can from the table and stands it on a tray, slowly."""
    performer(s, height=0.64, yaw_deg=-15, size=0.94, agent="old_woman")
    s.table()
    tray, tin = s.put("tray", shapes.tray(0.3, 0.36), (0.55, -0.2)), can(s, (0.48, 0.3))
    left = s.left()
    left.idle(0.2)
    fetch(left, tin, "+z", 1.4, 1.0, 0.8)
    left.lift_carry_lower(tin, tray, up=0.18, by=(0.05, -0.45), down=0.172, times=(1.4, 1.8, 1.4))
    finish(left, tin, tray, 0.8, 1.4)


@scene
def apple_out_of_a_pot_and_beside_it(s: Stage) -> None:
    """An apple is taken out of a pot and put on the table close to it, in one sweep."""
    performer(s, yaw_deg=50)
    table = s.table()
    s.put("pot", forms.pot(0.13, 0.09), (0.6, 0.1))
    fruit = apple(s, (0.6, 0.1, s.height + 0.006))
    right = s.right(claw())
    right.idle(0.2)
    fetch(right, fruit, "+z", 1.0, 1.0, 0.0)
    right.lift_carry_lower(fruit, table, up=0.2, by=(-0.05, -0.28), down=0.206)
    finish(right, fruit, table, 0.3, 1.0)


@scene
def bag_thrown_into_a_crate(s: Stage) -> None:
    """A bean bag on the palm is thrown into a crate at the far end of the table."""
    performer(s, yaw_deg=-25)
    s.table(depth=1.2)
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
