"""Scenes in which lids are taken off, put on, exchanged or slid, and hinged lids are turned."""

from scenes.hands import shapes
from scenes.hands.scene import performer
from scenes.hands.scenes_place import claw, fetch, finish
from scenes.hands.stage import Stage
from scenes.household import builders
from scenes.household.builders import plum, scene
from scenes.objects import forms
from scenes.objects.builders import AHEAD, chest, floor, home_again, paused, pillar, seize, travel


def narrow() -> shapes.Form:
    """A hand bent around a lip or a handle."""
    return shapes.gripping_hand(0.04, 0.04)


@scene
def lid_from_one_pot_to_another(s: Stage) -> None:
    """The left hand takes a lid off a tall pot and puts it on a low one, without any pause."""
    performer(s, height=0.69, yaw_deg=-33, size=1.03)
    s.table()
    s.put("tall_pot", forms.pot(0.1, 0.16), (0.52, 0.3))
    low = s.put("low_pot", forms.pot(0.1, 0.08), (0.6, -0.18))
    lid = s.put("lid", forms.round_lid(0.103), (0.52, 0.3, s.height + 0.16))
    left = s.left()
    left.idle(0.2)
    fetch(left, lid, "+z", 0.9, 1.0, 0.4)
    left.lift_carry_lower(lid, low, up=0.13, by=(0.08, -0.48), down=0.21)
    finish(left, lid, low, 0.3, 1.0)


@scene
def lid_slid_half_off_a_box(s: Stage) -> None:
    """A palm on a flat lid slides it over the rims of its box to the right, and goes home."""
    performer(s, height=0.76, yaw_deg=97)
    s.table()
    box = s.put("box", forms.open_box(0.24, 0.3, 0.12, "box"), (0.55, 0.05))
    lid = s.put("lid", shapes.box(0.26, 0.32, 0.015, "lid"), (0.55, 0.05, s.height + 0.12))
    right = s.right()
    right.idle(0.2)
    fetch(right, lid, "+z", 0.9, 1.0, 0.4)
    travel(right, "Slide", (0.0, -0.13, 0.0), 0.8, lid, box)
    finish(right, lid, box, 0.5, 0.9)


@scene
def lid_put_on_and_pressed_later(s: Stage) -> None:
    """A lid is put on a pan; after a rest at home the hand comes back and only touches it."""
    performer(s, height=0.82, yaw_deg=-95, size=0.96)
    s.table()
    pan = s.put("pan", forms.pot(0.12, 0.1), (0.56, 0.05))
    lid = s.put("lid", forms.round_lid(0.122), (0.5, -0.32))
    right = s.right()
    right.idle(0.2)
    fetch(right, lid, "+z", 1.0, 1.0, 0.0)
    right.lift_carry_lower(lid, pan, up=0.22, by=(0.06, 0.37), down=0.12)
    right.hold(0.3, lid, pan)
    right.leave(1.0)
    right.rest(0.9)
    right.reach(lid, "+z", 0.9, up=1.0)
    right.hold(0.8, lid)
    home_again(right, 0.9)


@scene
def lid_off_plum_out_lid_on(s: Stage) -> None:
    """The left hand lifts a lid and puts it back; meanwhile the right hand takes a plum out."""
    performer(s, height=0.72, yaw_deg=14)
    table = s.table()
    pot = s.put("pot", forms.pot(0.13, 0.08), (0.56, 0.05))
    lid = s.put("lid", forms.round_lid(0.132), (0.56, 0.05, s.height + 0.08))
    fruit = plum(s, (0.55, 0.04, s.height + 0.006))
    left, right = s.left(), s.right(claw())
    left.idle(0.2)
    fetch(left, lid, "+z", 1.0, 1.0, 0.3)
    travel(left, "Lift", (0.0, 0.0, 0.14), 0.8, lid)
    left.hold(0.4, lid)
    travel(left, "Carry", (0.0, 0.42, 0.0), 1.0, lid)
    opened = left.clock
    right.rest(opened - 0.5)
    fetch(right, fruit, "+z", 1.1, 1.0, 0.0)
    right.lift_carry_lower(fruit, table, up=0.2, by=(-0.07, -0.42), down=0.206)
    right.hold(0.3, fruit, table)
    right.leave(0.9)
    left.hold(right.clock - opened - 0.6, lid)
    travel(left, "Carry", (0.0, -0.42, 0.0), 1.0, lid)
    left.hold(0.4, lid)
    travel(left, "Lower", (0.0, 0.0, -0.14), 0.8, lid, pot)
    left.hold(0.5, lid, pot)
    right.rest(left.clock - right.clock)


@scene
def lid_held_in_the_air_and_laid_on_a_stool(s: Stage) -> None:
    """A lid that hangs in the air from the first frame is carried aside and laid on a stool."""
    performer(s, height=0.75, yaw_deg=151, size=1.06, agent="tall_man")
    s.table(width=0.9)
    s.put("pot", forms.pot(), (0.5, 0.1))
    stool = pillar(s, "stool", (0.48, -0.72, 0.5), (0.34, 0.34), "stool")
    lid = s.put("lid", forms.round_lid(0.112), (0.5, 0.1, s.height + 0.3))
    right = s.right()
    right.begin_at(lid, "+z", up=1.0, fingers=AHEAD)
    right.take(lid)
    right.hold(0.6, lid)
    travel(right, "Carry", (-0.02, -0.82, 0.0), 1.4, lid)
    right.hold(0.5, lid)
    travel(right, "Lower", (0.0, 0.0, -(s.height + 0.3 - 0.5)), 1.3, lid, stool)
    finish(right, lid, stool, 0.4, 1.0)


@scene
def square_lid_changed_over(s: Stage) -> None:
    """A square lid is taken off a box, laid on the table, and put on the box again after a rest."""
    performer(s, height=0.79, yaw_deg=-61)
    table = s.table()
    box = s.put("box", forms.open_box(0.22, 0.18, 0.1, "box"), (0.58, -0.25))
    lid = s.put("lid", forms.square_lid(0.22, 0.18), (0.58, -0.25, s.height + 0.1))
    right = s.right()
    right.idle(0.2)
    fetch(right, lid, "+z", 0.8, 1.0, 0.0)
    right.lift_carry_lower(lid, table, up=0.12, by=(-0.05, 0.42), down=0.22)
    right.leave(1.0)
    right.rest(1.2)
    fetch(right, lid, "+z", 0.9, 1.0, 0.4)
    paused(right, lid, box, up=0.24, by=(0.05, -0.42), down=0.14, holds=(0.0, 0.4))
    finish(right, lid, box, 0.3, 0.9)


@scene
def trunk_opened_in_stages_by_the_left_hand(s: Stage) -> None:
    """The lid of a wide trunk is turned up by a third, by a second third, and let down by one."""
    performer(s, height=0.42, yaw_deg=-11, size=1.04)
    s.table()
    trunk = chest(s, (0.72, 0.12, s.height), depth=0.3, width=0.56, height=0.3)
    left = s.left(narrow())
    left.idle(0.2)
    seize(left, trunk.leaf, trunk.grip, 1.0, hold=0.4)
    for angle, name in ((28.0, "Open"), (30.0, "Open"), (-26.0, "Close")):
        trunk.hinge.turn(left, angle, 0.9)
        left.step(name, trunk.leaf, trunk.body)
        left.hold(0.7, trunk.leaf, trunk.body)


@scene
def trunk_shut_with_the_palm_on_top(s: Stage) -> None:
    """A lid that stands half open is pressed shut by a flat palm that keeps lying on it."""
    performer(s, height=0.4, yaw_deg=203)
    s.table()
    trunk = chest(s, (0.7, -0.05, s.height), depth=0.32, width=0.4, height=0.2)
    trunk.hinge.opened(trunk.leaf, 38.0)
    right = s.right()
    right.idle(0.2)
    seize(right, trunk.leaf, trunk.face, 1.1, hold=0.4)
    trunk.hinge.turn(right, -38.0, 1.0)
    right.step("Close", trunk.leaf, trunk.body)
    right.hold(0.9, trunk.leaf, trunk.body)


@scene
def trunk_opened_by_one_hand_and_shut_by_the_other(s: Stage) -> None:
    """The right hand opens a lid, which stays so; the left hand takes its lip and shuts it."""
    performer(s, height=0.45, yaw_deg=66, size=1.02)
    s.table()
    trunk = chest(s, (0.72, 0.0, s.height), depth=0.3, width=0.5, height=0.22)
    right, left = s.right(narrow()), s.left(narrow())
    right.idle(0.2)
    seize(right, trunk.leaf, trunk.grip, 0.9, hold=0.3)
    trunk.hinge.turn(right, 55.0, 1.2)
    right.step("Open", trunk.leaf, trunk.body)
    right.hold(0.6, trunk.leaf, trunk.body)
    right.leave(0.9)
    left.rest(right.clock - 0.3)
    seize(left, trunk.leaf, trunk.grip, 1.2, hold=0.3)
    trunk.hinge.turn(left, -55.0, 1.2)
    left.step("Close", trunk.leaf, trunk.body)
    left.hold(0.5, trunk.leaf, trunk.body)
    home_again(left, 0.9)
    right.rest(left.clock - right.clock)


@scene
def trunk_lid_only_leant_on(s: Stage) -> None:
    """Both palms lie on a trunk's shut lid for two and a half seconds."""
    performer(s, height=0.41, yaw_deg=-170, size=0.93, agent="old_woman")
    s.table()
    trunk = chest(s, (0.62, 0.0, s.height), depth=0.34, width=0.6, height=0.26)
    for hand, aside in ((s.right(), -0.16), (s.left(), 0.16)):
        hand.idle(0.25)
        hand.reach(trunk.leaf, "+z", 1.2, up=1.0, aside=(0.0, aside, -0.002))
        hand.hold(2.5, trunk.leaf)
        home_again(hand, 1.1)


@scene
def bucket_uncovered_and_looked_into(s: Stage) -> None:
    """A round lid is lifted off a bucket on the floor, held for two seconds, and put back."""
    performer(s, height=0.45, yaw_deg=44, size=1.0)
    floor(s)
    pail = builders.bucket(s, (0.45, -0.15, 0.0), height=0.3)
    lid = s.put("lid", forms.round_lid(0.114), (0.45, -0.15, 0.3))
    right = s.right()
    right.idle(0.2)
    fetch(right, lid, "+z", 0.9, 1.0, 0.3)
    travel(right, "Lift", (0.0, 0.0, 0.2), 0.8, lid)
    right.hold(2.0, lid)
    travel(right, "Lower", (0.0, 0.0, -0.2), 0.8, lid, pail)
    finish(right, lid, pail, 0.0, 0.9)
