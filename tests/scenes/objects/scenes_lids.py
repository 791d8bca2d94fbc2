"""Scenes in which lids are taken off and put on, and a chest's lid is opened and shut."""

from scenes.hands import shapes
from scenes.hands.scene import performer
from scenes.hands.scenes_place import claw, fetch, finish
from scenes.hands.stage import Stage
from scenes.objects import forms
from scenes.objects.builders import (
    apple,
    can,
    chest,
    home_again,
    paused,
    pillar,
    scene,
    seize,
    travel,
)

POT_M = 0.12
"""Height of a pot [m]."""


@scene
def lid_off_a_pot(s: Stage) -> None:
    """A lid is lifted off a pot by its knob and laid beside it in one sweep."""
    performer(s, yaw_deg=-45)
    table = s.table()
    s.put("pot", forms.pot(), (0.55, 0.2))
    lid = s.put("lid", forms.round_lid(0.112), (0.55, 0.2, s.height + POT_M))
    right = s.right()
    right.idle(0.2)
    fetch(right, lid, "+z", 1.0, 1.0, 0.3)
    right.lift_carry_lower(lid, table, up=0.12, by=(0.0, -0.42), down=0.24)
    finish(right, lid, table, 0.3, 0.9)


@scene
def lid_onto_a_pot(s: Stage) -> None:
    """A lid is taken from the table and put on a pot, with pauses in the air."""
    performer(s, height=0.88, yaw_deg=150, size=1.06)
    s.table()
    vessel = s.put("pot", forms.pot(), (0.6, -0.1))
    lid = s.put("lid", forms.round_lid(0.112), (0.55, 0.35))
    left = s.left()
    left.idle(0.2)
    fetch(left, lid, "+z", 0.9, 1.0, 0.4)
    paused(left, lid, vessel, up=0.24, by=(0.05, -0.45), down=0.12, holds=(0.4, 0.5))
    finish(left, lid, vessel, 0.4, 1.0)


@scene
def look_into_a_pot(s: Stage) -> None:
    """A lid is lifted straight off a pot, held for a second and a half, and put back."""
    performer(s, height=0.8, yaw_deg=5)
    s.table()
    vessel = s.put("pot", forms.pot(), (0.55, -0.1))
    lid = s.put("lid", forms.round_lid(0.112), (0.55, -0.1, s.height + POT_M))
    right = s.right()
    right.idle(0.2)
    fetch(right, lid, "+z", 1.0, 1.0, 0.0)
    travel(right, "Lift", (0.0, 0.0, 0.16), 0.8, lid)
    right.hold(1.5, lid)
    travel(right, "Lower", (0.0, 0.0, -0.16), 0.9, lid, vessel)
    finish(right, lid, vessel, 0.3, 0.9)


@scene
def lid_held_while_a_pot_is_filled(s: Stage) -> None:
    """The left hand holds a lid in the air while the right hand puts an apple into the pot."""
    performer(s, yaw_deg=-120, size=1.02)
    s.table()
    vessel = s.put("pot", forms.pot(0.13), (0.55, 0.1))
    lid = s.put("lid", forms.round_lid(0.132), (0.55, 0.1, s.height + POT_M))
    fruit = apple(s, (0.5, -0.3))
    left, right = s.left(), s.right(claw())
    left.idle(0.2)
    fetch(left, lid, "+z", 1.0, 1.0, 0.3)
    travel(left, "Lift", (0.0, 0.0, 0.15), 0.8, lid)
    left.hold(0.3, lid)
    travel(left, "Carry", (0.0, 0.36, 0.0), 0.9, lid)
    opened = left.clock
    right.rest(opened - 1.2)
    fetch(right, fruit, "+z", 0.9, 1.0, 0.3)
    right.lift_carry_lower(fruit, vessel, up=0.26, by=(0.05, 0.4), down=0.254)
    finish(right, fruit, vessel, 0.3, 1.1)
    left.hold(right.clock - left.clock, lid)


@scene
def lid_off_a_box(s: Stage) -> None:
    """The left hand takes the lid off a square box and keeps it in the air."""
    performer(s, height=0.6, yaw_deg=65, size=0.9, agent="girl")
    s.table()
    s.put("box", forms.open_box(0.2, 0.2, 0.14, "box"), (0.5, 0.15))
    lid = s.put("lid", forms.square_lid(0.2, 0.2), (0.5, 0.15, s.height + 0.14))
    left = s.left()
    left.idle(0.15)
    fetch(left, lid, "+z", 0.8, 1.0, 0.5)
    travel(left, "Lift", (0.0, 0.0, 0.25), 0.8, lid)
    left.hold(1.0, lid)


@scene
def lid_onto_a_box(s: Stage) -> None:
    """A lid that is held in the air from the first frame is lowered onto its box and left."""
    performer(s, yaw_deg=215)
    s.table()
    box = s.put("box", forms.open_box(0.22, 0.22, 0.12, "box"), (0.55, -0.1))
    lid = s.put("lid", forms.square_lid(0.22, 0.22), (0.55, -0.1, s.height + 0.36))
    right = s.right()
    right.begin_at(lid, "+z", up=1.0, fingers=(1.0, 0.0, 0.0))
    right.take(lid)
    right.hold(0.6, lid)
    travel(right, "Lower", (0.0, 0.0, -0.24), 1.0, lid, box)
    finish(right, lid, box, 0.4, 0.9)


@scene
def chest_lid_opened(s: Stage) -> None:
    """A chest on the table is opened by the lip of its lid, which stays in the hand."""
    performer(s, height=0.55, yaw_deg=30)
    s.table()
    trunk = chest(s, (0.7, -0.1, s.height))
    right = s.right(shapes.gripping_hand(0.04, 0.04))
    right.idle(0.2)
    seize(right, trunk.leaf, trunk.grip, 0.9, hold=0.4)
    trunk.hinge.turn(right, 65.0, 1.3)
    right.step("Open", trunk.leaf, trunk.body)
    right.hold(0.8, trunk.leaf, trunk.body)


@scene
def chest_lid_shut(s: Stage) -> None:
    """A lid that stands open is shut and let go of."""
    performer(s, height=0.5, yaw_deg=-80, size=1.05)
    s.table()
    trunk = chest(s, (0.7, 0.1, s.height))
    trunk.hinge.opened(trunk.leaf, 60.0)
    left = s.left(shapes.gripping_hand(0.04, 0.04))
    left.idle(0.2)
    seize(left, trunk.leaf, trunk.grip, 1.1, hold=0.3)
    trunk.hinge.turn(left, -60.0, 1.2)
    left.step("Close", trunk.leaf, trunk.body)
    left.hold(0.4, trunk.leaf, trunk.body)
    home_again(left, 0.9)


@scene
def chest_lid_opened_and_shut(s: Stage) -> None:
    """A lid is opened at once on contact, held open for a second and shut again."""
    performer(s, height=0.52, yaw_deg=190)
    s.table()
    trunk = chest(s, (0.68, -0.05, s.height))
    right = s.right(shapes.gripping_hand(0.04, 0.04))
    right.idle(0.2)
    seize(right, trunk.leaf, trunk.grip, 0.9)
    trunk.hinge.turn(right, 50.0, 0.9)
    right.step("Open", trunk.leaf, trunk.body)
    right.hold(1.0, trunk.leaf, trunk.body)
    trunk.hinge.turn(right, -50.0, 0.9)
    right.step("Close", trunk.leaf, trunk.body)
    right.hold(0.3, trunk.leaf, trunk.body)
    home_again(right, 0.9)


@scene
def can_out_of_a_chest(s: Stage) -> None:
    """The left hand opens a chest and holds its lid; the right hand takes out a can."""
    performer(s, height=0.46, yaw_deg=100)
    s.table()
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
