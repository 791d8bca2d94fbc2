"""Vessels, lids, loads and tipping; several objects in one hand or passed on."""

from dataclasses import replace

from scenes.hands import shapes
from scenes.hands.paths import AHEAD, LEFTWARD, UP
from scenes.hands.performer import EASE, PRESS, Hand, travel
from scenes.hands.scene import at_table, performer
from scenes.hands.scenes_place import claw, fetch, finish
from scenes.hands.scenes_two_hands import both_leave, both_reach
from scenes.hands.stage import Stage, other_names
from scenes.hands.things import Thing
from scenes.household import builders
from scenes.household.builders import glass, jar, plum, tin_box
from scenes.objects import forms
from scenes.objects.builders import (
    Grip,
    begin_with,
    chest,
    floor,
    home_again,
    paused,
    pillar,
    seize,
    shelf,
)
from scenes.objects.scenes_containers import FINGERS_M, PALM_M, also, hold_both


def plum_from_a_bucket_to_a_basin(s: Stage) -> None:
    """A plum is taken straight up out of a bucket and laid in a wide basin, slowly."""
    at_table(s, height=0.62, yaw_deg=33, size=0.97)
    builders.bucket(s, (0.5, -0.28), height=0.08)
    fruit = plum(s, (0.5, -0.28, s.height + 0.006))
    basin = builders.basin(s, (0.62, 0.25))
    right = s.right(claw(), idle=0.25)
    fetch(right, fruit, "+z", 1.3, 1.0, 0.5)
    paused(
        right,
        fruit,
        basin,
        up=0.26,
        by=(0.12, 0.5),
        down=0.26,
        holds=(0.0, 0.8),
        times=(1.3, 1.7, 1.4),
    )
    finish(right, fruit, basin, 0.5, 1.3)


def roll_put_on_its_stand(s: Stage) -> None:
    """A paper roll is brought over a pole and lowered around it onto the foot of the stand."""
    at_table(s, height=0.8, yaw_deg=-72)
    stand = s.put("stand", builders.roll_stand(), (0.6, 0.22), tag="fixed")
    roll = s.put("roll", builders.paper_roll(), (0.52, -0.28))
    right = s.right(idle=0.2)
    fetch(right, roll, "-y", 0.9, 0.5, 0.4)
    paused(right, roll, stand, up=0.3, by=(0.08, 0.5), down=0.285, holds=(0.3, 0.5))
    finish(right, roll, stand, 0.4, 1.0)


def roll_taken_off_its_stand(s: Stage) -> None:
    """The left hand draws a paper roll up from its pole and keeps it in the air."""
    at_table(s, height=0.7, yaw_deg=128, size=1.05, agent="tall_woman")
    s.put("stand", builders.roll_stand(), (0.55, 0.12), tag="fixed")
    roll = s.put("roll", builders.paper_roll(), (0.55, 0.12, s.height + 0.015))
    left = s.left(idle=0.15)
    fetch(left, roll, "+y", 0.8, 0.6, 0.0)
    travel(left, "Lift", (0.0, 0.0, 0.31), 1.0, roll, hold=0.9)


def book_between_two_books(s: Stage) -> None:
    """A book is lowered into the gap between two others on a rack's lowest board."""
    at_table(s, height=0.66, yaw_deg=15)
    rack = s.put(
        "rack", builders.open_shelves(0.26, 0.4, (0.03,)), (0.6, 0.2, s.height), tag="fixed"
    )
    for name, y in (("red_book", 0.12), ("blue_book", 0.2)):
        s.put(name, shapes.box(0.16, 0.025, 0.2, "book"), (0.72, y, s.height + 0.03))
    book = s.put("green_book", shapes.box(0.15, 0.03, 0.27, "book"), (0.5, -0.28))
    right = s.right(shapes.gripping_hand(0.05, 0.04), idle=0.2)
    right.reach(book, "+z", 0.9, up=1.0, fingers=LEFTWARD, hold=0.3)
    right.take(book)
    paused(right, book, rack, up=0.33, by=(0.22, 0.44), down=0.3, holds=(0.0, 0.4))
    finish(right, book, rack, 0.3, 1.2)


def spoon_into_a_holder(s: Stage) -> None:
    """A long spoon that is held in the air is stood in a tall holder and let go of."""
    at_table(s, height=0.77, yaw_deg=-160)
    pot = s.put("holder", shapes.vessel(0.03, 0.16, "holder", 0.004), (0.55, 0.1))
    spoon = s.put("spoon", builders.tall_spoon(), (0.55, -0.18, s.height + 0.224))
    right = s.right(shapes.gripping_hand(0.05, 0.04))
    right.begin_at(spoon, "+z", up=1.0, fingers=AHEAD)
    right.take(spoon)
    right.hold(0.5, spoon)
    travel(right, "Carry", (0.0, 0.28, 0.0), 0.9, spoon, hold=0.4)
    travel(right, "Lower", (0.0, 0.0, -0.22), 1.0, spoon, pot)
    finish(right, spoon, pot, 0.3, 1.0)


def tower_taken_down_and_built_again(s: Stage) -> None:
    """The upper of two cubes is stood beside the lower one, which is then put on top of it."""
    table = at_table(s, yaw_deg=101, size=1.02)
    lower = s.put("white_cube", shapes.box(0.08, 0.08, 0.08, "cube"), (0.55, -0.2))
    upper = s.put(
        "black_cube", shapes.box(0.075, 0.075, 0.075, "cube"), (0.55, -0.2, s.height + 0.08)
    )
    right = s.right(claw(), idle=0.2)
    fetch(right, upper, "+z", 0.9, 1.0, 0.3)
    right.lift_carry_lower(upper, table, up=0.12, by=(0.05, 0.4), down=0.2)
    right.hold(0.3, upper, table)
    right.leave(1.0)
    right.rest(0.6)
    fetch(right, lower, "+z", 0.9, 1.0, 0.0)
    right.lift_carry_lower(lower, upper, up=0.2, by=(0.05, 0.4), down=0.125)
    finish(right, lower, upper, 0.4, 1.1)


def bowl_with_a_plum_out_of_a_box(s: Stage) -> None:
    """A bowl is lifted out of a low box by its side; a plum rides along in it."""
    table = at_table(s, height=0.73, yaw_deg=-28)
    s.put("box", forms.open_box(0.42, 0.42, 0.05, "box"), (0.58, 0.18))
    dish = s.put("bowl", shapes.vessel(0.08, 0.13, "bowl"), (0.55, 0.22, s.height + 0.008))
    fruit = plum(s, (0.55, 0.22, s.height + 0.013))
    left = s.left(idle=0.2)
    left.reach(dish, "+y", 1.0, up=0.75, hold=0.4)
    left.take(dish, fruit)
    left.lift_carry_lower(dish, table, up=0.16, by=(-0.02, -0.5), down=0.168)
    finish(left, dish, table, 0.3, 1.0)


def pan_set_in_a_sink(s: Stage) -> None:
    """Both hands take a pan by its lugs and sink it in a large basin, pausing over the opening."""
    at_table(s, height=0.86, yaw_deg=60, size=1.06, agent="tall_man")
    pan = s.put("pan", builders.stewpan(), (0.5, -0.28))
    sink = s.put("sink", forms.open_box(0.4, 0.5, 0.045, "sink"), (0.62, 0.3), tag="fixed")
    hands = both_reach(s, pan, 1.0, 0.88, 0.3)
    right, left = hands
    since = len(right.steps)
    left.join(pan)
    right.take(pan)
    paused(right, pan, sink, up=0.18, by=(0.12, 0.58), down=0.172, holds=(0.0, 1.1))
    right.hold(0.4, pan, sink)
    left.part(right, since)
    both_leave(hands, 1.0)


def jar_beside_a_bucket_after_a_stop_above_it(s: Stage) -> None:
    """A jar is held over a bucket for a second and a half, then stood on the table behind it."""
    table = at_table(s, height=0.7, yaw_deg=-118)
    builders.bucket(s, (0.5, 0.0), height=0.16)
    tin = jar(s, (0.5, 0.36), height=0.14)
    left = s.left(idle=0.2)
    fetch(left, tin, "+z", 0.9, 1.0, 0.0)
    travel(left, "Lift", (0.0, 0.0, 0.26), 0.9, tin, hold=0.4)
    travel(left, "Carry", (0.0, -0.36, 0.0), 1.1, tin, hold=1.5)
    travel(left, "Carry", (0.26, -0.08, 0.0), 0.9, tin, hold=0.4)
    travel(left, "Lower", (0.0, 0.0, -0.26), 0.9, tin, table)
    finish(left, tin, table, 0.4, 1.2)


def jar_off_a_rack_and_into_a_box(s: Stage) -> None:
    """A jar is lifted off a rack's upper board, held, and sunk into a box on a stool."""
    performer(s, height=0.75, yaw_deg=175)
    s.put("rack", builders.open_shelves(0.24, 0.6, (0.45, 0.9)), (0.55, 0.1, 0.0), tag="fixed")
    pillar(s, "stool", (0.4, -0.6, 0.42), (0.36, 0.36), "stool")
    box = s.put("box", forms.open_box(0.26, 0.26, 0.1, "box"), (0.4, -0.6, 0.42))
    tin = jar(s, (0.6, -0.1, 0.9), height=0.16)
    right = s.right(idle=0.2)
    fetch(right, tin, "+z", 1.0, 1.0, 0.4)
    travel(right, "Lift", (0.0, 0.0, 0.1), 0.7, tin, hold=0.5)
    travel(right, "Carry", (-0.2, -0.5, 0.0), 1.3, tin, hold=0.6)
    travel(right, "Lower", (0.0, 0.0, -0.572), 1.3, tin, box)
    finish(right, tin, box, 0.3, 1.2)


def plum_into_a_bowl_on_the_other_palm(s: Stage) -> None:
    """The left palm bears a bowl in the air throughout; the right hand puts a plum into it."""
    at_table(s, height=0.68, yaw_deg=-8, size=0.98)
    dish = s.put("bowl", shapes.vessel(0.12, 0.06, "bowl", 0.012), (0.5, 0.2, s.height + 0.15))
    fruit = plum(s, (0.5, -0.28))
    left, right = s.left(), s.right(claw())
    left.begin_at(dish, "-z", up=0.0, fingers=AHEAD)
    left.take(dish)
    right.idle(0.2)
    fetch(right, fruit, "+z", 0.9, 1.0, 0.3)
    paused(right, fruit, dish, up=0.35, by=(0.0, 0.48), down=0.188, holds=(0.4, 0.0))
    finish(right, fruit, dish, 0.4, 1.2)
    left.hold(right.clock, dish)


def plum_out_of_a_basin_into_a_dish(s: Stage) -> None:
    """The left hand takes a plum out of a basin and puts it into a dish, without any pause."""
    at_table(s, height=0.52, yaw_deg=84, size=0.8, agent="child", offset=(2.0, -0.4))
    builders.basin(s, (0.48, 0.25))
    fruit = plum(s, (0.48, 0.25, s.height + 0.006), radius=0.026)
    dish = s.put("dish", shapes.vessel(0.085, 0.045, "dish"), (0.5, -0.15))
    left = s.left(claw(), idle=0.1)
    left.reach(fruit, "+z", 0.8, up=1.0, fingers=LEFTWARD)
    left.take(fruit)
    left.lift_carry_lower(fruit, dish, up=0.2, by=(0.02, -0.4), down=0.201, times=(0.6, 0.8, 0.6))
    home_again(left, 0.9)


def tin_from_one_box_to_another_on_a_shelf(s: Stage) -> None:
    """A tin goes out of a low box on the table into a box on a shelf, with two short pauses."""
    at_table(s, height=0.74, yaw_deg=-142, size=1.07)
    shelf(s, (0.68, 0.32, s.height + 0.3))
    s.put("low_box", forms.open_box(0.24, 0.24, 0.06, "box"), (0.48, -0.2))
    high = s.put("high_box", forms.open_box(0.28, 0.28, 0.07, "box"), (0.68, 0.32, s.height + 0.3))
    tin = builders.tin_box(s, (0.48, -0.2, s.height + 0.008), "tin", (0.08, 0.08, 0.12))
    right = s.right(idle=0.2)
    fetch(right, tin, "+z", 0.9, 1.0, 0.3)
    paused(
        right,
        tin,
        high,
        up=0.48,
        by=(0.2, 0.52),
        down=0.18,
        holds=(0.4, 0.4),
        times=(1.1, 1.1, 0.8),
    )
    finish(right, tin, high, 0.4, 1.2)


def narrow() -> shapes.Form:
    """A hand bent around a lip or a handle."""
    return shapes.gripping_hand(0.04, 0.04)


def lid_from_one_pot_to_another(s: Stage) -> None:
    """The left hand takes a lid off a tall pot and puts it on a low one, without any pause."""
    at_table(s, height=0.69, yaw_deg=-33, size=1.03)
    s.put("tall_pot", forms.pot(0.1, 0.16), (0.52, 0.3))
    low = s.put("low_pot", forms.pot(0.1, 0.08), (0.6, -0.18))
    lid = s.put("lid", forms.round_lid(0.103), (0.52, 0.3, s.height + 0.16))
    left = s.left(idle=0.2)
    fetch(left, lid, "+z", 0.9, 1.0, 0.4)
    left.lift_carry_lower(lid, low, up=0.13, by=(0.08, -0.48), down=0.21)
    finish(left, lid, low, 0.3, 1.0)


def lid_slid_half_off_a_box(s: Stage) -> None:
    """A palm on a flat lid slides it over the rims of its box to the right, and goes home."""
    at_table(s, height=0.76, yaw_deg=97)
    box = s.put("box", forms.open_box(0.24, 0.3, 0.12, "box"), (0.55, 0.05))
    lid = s.put("lid", shapes.box(0.26, 0.32, 0.015, "lid"), (0.55, 0.05, s.height + 0.12))
    right = s.right(idle=0.2)
    fetch(right, lid, "+z", 0.9, 1.0, 0.4)
    travel(right, "Slide", (0.0, -0.13, 0.0), 0.8, lid, box)
    finish(right, lid, box, 0.5, 0.9)


def lid_put_on_and_pressed_later(s: Stage) -> None:
    """A lid is put on a pan; after a rest at home the hand comes back and only touches it."""
    at_table(s, height=0.82, yaw_deg=-95, size=0.96)
    pan = s.put("pan", forms.pot(0.12, 0.1), (0.56, 0.05))
    lid = s.put("lid", forms.round_lid(0.122), (0.5, -0.32))
    right = s.right(idle=0.2)
    fetch(right, lid, "+z", 1.0, 1.0, 0.0)
    right.lift_carry_lower(lid, pan, up=0.22, by=(0.06, 0.37), down=0.12)
    right.hold(0.3, lid, pan)
    right.leave(1.0)
    right.rest(0.9)
    right.reach(lid, "+z", 0.9, up=1.0, hold=0.8)
    home_again(right, 0.9)


def lid_off_plum_out_lid_on(s: Stage) -> None:
    """The left hand lifts a lid and puts it back; meanwhile the right hand takes a plum out."""
    table = at_table(s, height=0.72, yaw_deg=14)
    pot = s.put("pot", forms.pot(0.13, 0.08), (0.56, 0.05))
    lid = s.put("lid", forms.round_lid(0.132), (0.56, 0.05, s.height + 0.08))
    fruit = plum(s, (0.55, 0.04, s.height + 0.006))
    left, right = s.left(), s.right(claw())
    left.idle(0.2)
    fetch(left, lid, "+z", 1.0, 1.0, 0.3)
    travel(left, "Lift", (0.0, 0.0, 0.14), 0.8, lid, hold=0.4)
    travel(left, "Carry", (0.0, 0.42, 0.0), 1.0, lid)
    opened = left.clock
    right.rest(opened - 0.5)
    fetch(right, fruit, "+z", 1.1, 1.0, 0.0)
    right.lift_carry_lower(fruit, table, up=0.2, by=(-0.07, -0.42), down=0.206)
    right.hold(0.3, fruit, table)
    right.leave(0.9)
    left.hold(right.clock - opened - 0.6, lid)
    travel(left, "Carry", (0.0, -0.42, 0.0), 1.0, lid, hold=0.4)
    travel(left, "Lower", (0.0, 0.0, -0.14), 0.8, lid, pot, hold=0.5)
    right.rest(left.clock - right.clock)


def lid_held_in_the_air_and_laid_on_a_stool(s: Stage) -> None:
    """A lid that hangs in the air from the first frame is carried aside and laid on a stool."""
    at_table(s, height=0.75, yaw_deg=151, size=1.06, agent="tall_man", width=0.9)
    s.put("pot", forms.pot(), (0.5, 0.1))
    stool = pillar(s, "stool", (0.48, -0.72, 0.5), (0.34, 0.34), "stool")
    lid = s.put("lid", forms.round_lid(0.112), (0.5, 0.1, s.height + 0.3))
    right = s.right()
    right.begin_at(lid, "+z", up=1.0, fingers=AHEAD)
    right.take(lid)
    right.hold(0.6, lid)
    travel(right, "Carry", (-0.02, -0.82, 0.0), 1.4, lid, hold=0.5)
    travel(right, "Lower", (0.0, 0.0, -(s.height + 0.3 - 0.5)), 1.3, lid, stool)
    finish(right, lid, stool, 0.4, 1.0)


def square_lid_changed_over(s: Stage) -> None:
    """A square lid is taken off a box, laid on the table, and put on the box again after a rest."""
    table = at_table(s, height=0.79, yaw_deg=-61)
    box = s.put("box", forms.open_box(0.22, 0.18, 0.1, "box"), (0.58, -0.25))
    lid = s.put("lid", forms.square_lid(0.22, 0.18), (0.58, -0.25, s.height + 0.1))
    right = s.right(idle=0.2)
    fetch(right, lid, "+z", 0.8, 1.0, 0.0)
    right.lift_carry_lower(lid, table, up=0.12, by=(-0.05, 0.42), down=0.22)
    right.leave(1.0)
    right.rest(1.2)
    fetch(right, lid, "+z", 0.9, 1.0, 0.4)
    paused(right, lid, box, up=0.24, by=(0.05, -0.42), down=0.14, holds=(0.0, 0.4))
    finish(right, lid, box, 0.3, 0.9)


def trunk_opened_in_stages_by_the_left_hand(s: Stage) -> None:
    """The lid of a wide trunk is turned up by a third, by a second third, and let down by one."""
    at_table(s, height=0.42, yaw_deg=-11, size=1.04)
    trunk = chest(s, (0.72, 0.12, s.height), depth=0.3, width=0.56, height=0.3)
    left = s.left(narrow(), idle=0.2)
    seize(left, trunk.leaf, trunk.grip, 1.0, hold=0.4)
    for angle, name in ((28.0, "Open"), (30.0, "Open"), (-26.0, "Close")):
        trunk.hinge.turn(left, angle, 0.9)
        left.step(name, trunk.leaf, trunk.body)
        left.hold(0.7, trunk.leaf, trunk.body)


def trunk_shut_with_the_palm_on_top(s: Stage) -> None:
    """A lid that stands half open is pressed shut by a flat palm that keeps lying on it."""
    at_table(s, height=0.4, yaw_deg=203)
    trunk = chest(s, (0.7, -0.05, s.height), depth=0.32, width=0.4, height=0.2)
    trunk.hinge.opened(trunk.leaf, 38.0)
    right = s.right(idle=0.2)
    seize(right, trunk.leaf, trunk.face, 1.1, hold=0.4)
    trunk.hinge.turn(right, -38.0, 1.0)
    right.step("Close", trunk.leaf, trunk.body)
    right.hold(0.9, trunk.leaf, trunk.body)


def trunk_opened_by_one_hand_and_shut_by_the_other(s: Stage) -> None:
    """The right hand opens a lid, which stays so; the left hand takes its lip and shuts it."""
    at_table(s, height=0.45, yaw_deg=66, size=1.02)
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


def trunk_lid_only_leant_on(s: Stage) -> None:
    """Both palms lie on a trunk's shut lid for two and a half seconds."""
    at_table(s, height=0.41, yaw_deg=-170, size=0.93, agent="old_woman")
    trunk = chest(s, (0.62, 0.0, s.height), depth=0.34, width=0.6, height=0.26)
    for hand, aside in ((s.right(), -0.16), (s.left(), 0.16)):
        hand.idle(0.25)
        hand.reach(trunk.leaf, "+z", 1.2, up=1.0, aside=(0.0, aside, -0.002), hold=2.5)
        home_again(hand, 1.1)


def bucket_uncovered_and_looked_into(s: Stage) -> None:
    """A round lid is lifted off a bucket on the floor, held for two seconds, and put back."""
    performer(s, height=0.45, yaw_deg=44, size=1.0)
    floor(s)
    pail = builders.bucket(s, (0.45, -0.15, 0.0), height=0.3)
    lid = s.put("lid", forms.round_lid(0.114), (0.45, -0.15, 0.3))
    right = s.right(idle=0.2)
    fetch(right, lid, "+z", 0.9, 1.0, 0.3)
    travel(right, "Lift", (0.0, 0.0, 0.2), 0.8, lid, hold=2.0)
    travel(right, "Lower", (0.0, 0.0, -0.2), 0.8, lid, pail)
    finish(right, lid, pail, 0.0, 0.9)


def basket_with_a_bottle(s: Stage) -> None:
    """A basket with a bottle and a plum is carried to the right by its arch and stood down."""
    table = at_table(s, height=0.56, yaw_deg=19, size=1.01)
    pannier = s.put("basket", forms.basket(0.3, 0.28, 0.12, 0.34), (0.52, 0.3))
    flask = s.put("bottle", shapes.bottle(0.032, 0.2), (0.46, 0.3, s.height + 0.008))
    fruit = plum(s, (0.6, 0.32, s.height + 0.008))
    left = s.left(idle=0.2)
    left.reach(pannier, "+z", 1.0, up=1.0, fingers=(0.0, 1.0, 0.0), hold=0.4)
    left.take(pannier, flask, fruit)
    paused(left, pannier, table, up=0.16, by=(0.03, -0.5), down=0.16, holds=(0.5, 0.0))
    finish(left, pannier, table, 0.5, 1.0)


def tray_with_glasses_pushed_by_one_palm(s: Stage) -> None:
    """A tray with two glasses on it is pushed away over the table."""
    table = at_table(s, height=0.78, yaw_deg=-128)
    tray = s.put("tray", shapes.tray(0.24, 0.3), (0.5, -0.1))
    ware = [
        glass(s, (0.5, y, s.height + 0.008), name)
        for name, y in (("near_glass", -0.17), ("far_glass", -0.04))
    ]
    right = s.right(idle=0.2)
    right.reach(tray, "-x", 0.9, up=0.6, fingers=UP, hold=0.4)
    right.take(tray, *ware)
    travel(right, "Push", (0.28, 0.0, 0.0), 1.6, tray, table)
    finish(right, tray, table, 0.5, 0.9)


def carton_with_a_ball_up_to_a_shelf(s: Stage) -> None:
    """Both hands lift a carton with a ball, bring it over a shelf, set it down and stay."""
    at_table(s, height=0.66, yaw_deg=83, size=1.07, agent="tall_woman")
    board = shelf(s, (0.72, 0.3, s.height + 0.28), size=(0.4, 0.5))
    carton = s.put("carton", shapes.carton(0.22, 0.26, 0.16), (0.45, -0.2))
    ball = s.put("ball", shapes.ball(0.06), (0.45, -0.22, s.height + 0.066))
    hands = both_reach(s, carton, 1.0, 0.6, 0.4)
    right, left = hands
    since = len(right.steps)
    left.join(carton)
    right.take(carton, ball)
    paused(right, carton, board, up=0.4, by=(0.27, 0.5), down=0.12, holds=(0.4, 0.4))
    right.hold(0.9, carton, board)
    left.part(right, since)


def loaded_crate_stacked_on_another(s: Stage) -> None:
    """A crate with two jars in it is put on top of an empty one in a single sweep."""
    at_table(s, height=0.5, yaw_deg=-46, size=1.04)
    low = s.put("empty_crate", forms.open_box(0.3, 0.3, 0.14, "crate", 0.014), (0.76, 0.3))
    high = s.put("full_crate", forms.open_box(0.3, 0.3, 0.14, "crate", 0.014), (0.55, -0.28))
    jars = [
        jar(s, (0.55 + x, -0.28, s.height + 0.014), name, 0.12)
        for name, x in (("sweet_jar", -0.06), ("sour_jar", 0.06))
    ]
    hands = both_reach(s, high, 1.0, 0.6, 0.3)
    right, left = hands
    since = len(right.steps)
    left.join(high)
    right.take(high, *jars)
    right.lift_carry_lower(high, low, up=0.3, by=(0.21, 0.58), down=0.16, times=(1.0, 1.4, 0.9))
    right.hold(0.4, high, low)
    left.part(right, since)
    both_leave(hands, 1.0)


def tray_on_one_palm(s: Stage) -> None:
    """A tray with a glass lies on the palm; it is carried to the left, and on after a stop."""
    at_table(s, height=0.72, yaw_deg=105)
    tray = s.put("tray", shapes.box(0.3, 0.3, 0.014, "tray"), (0.42, -0.35, s.height + 0.3))
    ware = glass(s, (0.4, -0.38, s.height + 0.314))
    right = s.right()
    right.begin_at(tray, "-z", up=0.0, fingers=AHEAD)
    right.take(tray, ware)
    right.hold(0.7, tray)
    for far, duration, rest in ((0.3, 1.0, 0.9), (0.25, 0.9, 0.7)):
        travel(right, "Carry", (0.03, far, 0.0), duration, tray)
        right.hold(rest, tray)


def pan_with_its_lid(s: Stage) -> None:
    """Both hands carry a pan by its lugs to a higher plate; the lid rides on it."""
    at_table(s, height=0.76, yaw_deg=-15, size=0.99, width=0.8)
    hob = pillar(s, "hob", (0.55, 0.75, 0.88), (0.44, 0.44), "hob")
    pan = s.put("pan", builders.stewpan(), (0.5, 0.0))
    lid = s.put("lid", forms.round_lid(0.12), (0.5, 0.0, s.height + 0.11))
    hands = both_reach(s, pan, 1.0, 0.88, 0.0)
    right, left = hands
    since = len(right.steps)
    left.join(pan)
    right.take(pan, lid)
    right.lift_carry_lower(pan, hob, up=0.26, by=(0.05, 0.74), down=0.14, times=(0.9, 1.4, 0.9))
    right.hold(0.6, pan, hob)
    left.part(right, since)


def three_books_between_two_palms(s: Stage) -> None:
    """A stack of three books is lifted by the lowest one, held, and set down where it was."""
    table = at_table(s, height=0.67, yaw_deg=-172)
    low = s.put("thick_book", shapes.box(0.2, 0.28, 0.1, "book"), (0.52, 0.02))
    middle = s.put("thin_book", shapes.box(0.18, 0.24, 0.03, "book"), (0.53, 0.02, s.height + 0.1))
    top = s.put("small_book", shapes.box(0.12, 0.16, 0.04, "book"), (0.52, 0.03, s.height + 0.13))
    hands = both_reach(s, low, 0.9, 0.55, 0.5)
    right, left = hands
    since = len(right.steps)
    left.join(low)
    right.take(low, middle, top)
    travel(right, "Lift", (0.0, 0.0, 0.3), 1.1, low, hold=1.3)
    travel(right, "Lower", (0.0, 0.0, -0.3), 1.2, low, table, hold=0.4)
    left.part(right, since)
    both_leave(hands, 0.9)


def board_with_a_loaf_slid_aside(s: Stage) -> None:
    """A palm on a board with a loaf at its other end slides both to the left, and stays."""
    table = at_table(s, height=0.88, yaw_deg=57, size=1.06)
    board = s.put("board", shapes.box(0.22, 0.44, 0.045, "board"), (0.55, -0.15))
    loaf = s.put("loaf", shapes.box(0.12, 0.16, 0.1, "loaf"), (0.57, -0.25, s.height + 0.045))
    left = s.left(idle=0.2)
    left.reach(board, "+z", 1.0, up=1.0, aside=(-0.04, 0.15, 0.0), hold=0.3)
    left.take(board, loaf)
    travel(left, "Slide", (0.0, 0.3, 0.0), 1.2, board, table, hold=0.7)


def box_in_a_box_put_down_from_the_air(s: Stage) -> None:
    """Both hands hold an open box with a small box in it; they carry it ahead and put it down."""
    table = at_table(s, height=0.7, yaw_deg=142, size=0.95)
    outer = s.put("outer_box", shapes.carton(0.24, 0.3, 0.18), (0.42, 0.0, s.height + 0.22))
    inner = tin_box(s, (0.44, 0.04, s.height + 0.226), "inner_box", (0.1, 0.08, 0.07))
    right, left = s.right(), s.left()
    for hand, side in ((right, "-y"), (left, "+y")):
        hand.begin_at(outer, side, up=0.5, fingers=AHEAD)
    left.join(outer)
    right.take(outer, inner)
    right.hold(0.5, outer)
    travel(right, "Carry", (0.24, 0.0, 0.0), 1.0, outer, hold=0.5)
    travel(right, "Lower", (0.0, 0.0, -0.22), 0.9, outer, table, hold=0.4)
    left.part(right, 0)
    both_leave([right, left], 0.9)


def bucket_with_plums_swung_quickly(s: Stage) -> None:
    """A bucket with two plums is carried by the palm at its side at more than a metre a second."""
    table = at_table(s, height=0.6, yaw_deg=-80, size=1.03)
    pail = builders.bucket(s, (0.55, -0.3), height=0.2)
    fruits = [
        plum(s, (0.55 + x, -0.3, s.height + 0.006), name)
        for name, x in (("ripe_plum", -0.05), ("green_plum", 0.05))
    ]
    right = s.right(idle=0.15)
    fetch(right, pail, "-y", 0.8, 0.7, 0.0)
    right.release()
    right.take(pail, *fruits)
    right.lift_carry_lower(pail, table, up=0.18, by=(0.0, 0.55), down=0.18, times=(0.6, 0.9, 0.6))
    home_again(right, 0.9)


def jug_into_two_glasses(s: Stage) -> None:
    """A jug is tipped over a first glass, carried on, tipped over a second, and put down."""
    performer(s, height=0.72, yaw_deg=-36)
    table, jug = s.table(), s.put("jug", forms.jug(0.05, 0.18), (0.45, -0.28))
    for name, x in (("near_glass", 0.45), ("far_glass", 0.75)):
        glass(s, (x, -0.08), name)
    right = s.right(idle=0.2)
    fetch(right, jug, "-y", 0.9, 0.5, 0.3)
    travel(right, "Lift", (0.0, 0.0, 0.24), 0.9, jug, hold=0.4)
    for x, by in ((0.45, 0.3), (0.75, 0.0)):
        right.dip((x, -0.23, s.height + 0.4), AHEAD, -95.0, 2.0)
        right.step("Pour", jug)
        right.hold(0.5, jug)
        if by:
            travel(right, "Carry", (by, 0.0, 0.0), 1.0, jug, hold=0.4)
    travel(right, "Lower", (0.0, 0.0, -0.24), 0.9, jug, table)
    finish(right, jug, table, 0.3, 1.0)


def bottle_into_a_glass_that_the_other_hand_holds(s: Stage) -> None:
    """The right hand holds a glass in the air; the left hand tips a bottle over it and back."""
    at_table(s, height=0.74, yaw_deg=121, size=1.03)
    ware = glass(s, (0.5, -0.02, s.height + 0.12))
    flask = s.put("bottle", shapes.bottle(0.034, 0.22), (0.5, 0.22, s.height + 0.26))
    right, left = s.right(), s.left()
    right.begin_at(ware, "-y", up=0.45, fingers=AHEAD)
    right.take(ware)
    left.begin_at(flask, "+y", up=0.3, fingers=AHEAD)
    left.take(flask)
    left.hold(0.6, flask)
    left.dip((0.5, 0.18, s.height + 0.38), AHEAD, 105.0, 2.2)
    left.step("Pour", flask)
    left.hold(0.7, flask)
    right.hold(left.clock, ware)


def bucket_tipped_over_a_basin_by_both(s: Stage) -> None:
    """Both hands tip a bucket forward over a basin and back; they hold it in the air throughout."""
    at_table(s, height=0.5, yaw_deg=-79, size=1.05, agent="tall_woman", depth=0.9)
    builders.basin(s, (0.82, 0.0), radius=0.2)
    pail = builders.bucket(s, (0.52, 0.0, s.height + 0.22), height=0.22)
    right, left = s.right(), s.left()
    for hand, side in ((right, "-y"), (left, "+y")):
        hand.begin_at(pail, side, up=0.5, fingers=AHEAD)
    left.join(pail)
    right.take(pail)
    right.hold(0.7, pail)
    right.dip((0.55, 0.0, s.height + 0.36), (0.0, 1.0, 0.0), 100.0, 2.6)
    right.step("Pour", pail)
    right.hold(0.7, pail)
    left.part(right, 0)


def cup_emptied_quickly_over_a_bowl(s: Stage) -> None:
    """A cup is carried from the table over a bowl, tipped at once and back, and held."""
    at_table(s, height=0.67, yaw_deg=3, size=0.94)
    s.put("bowl", shapes.vessel(0.11, 0.06, "bowl"), (0.55, -0.02))
    cup = s.put("cup", shapes.vessel(0.038, 0.09, "cup"), (0.5, 0.35))
    left = s.left(idle=0.15)
    fetch(left, cup, "+y", 0.9, 0.6, 0.0)
    travel(left, "Lift", (0.0, 0.0, 0.24), 0.8, cup, hold=0.4)
    travel(left, "Carry", (0.05, -0.26, 0.0), 0.8, cup, hold=0.4)
    left.dip((0.55, 0.06, s.height + 0.29), AHEAD, 120.0, 1.2)
    left.step("Pour", cup)
    left.hold(0.6, cup)


def shaker_shaken_above_a_pan(s: Stage) -> None:
    """A shaker is carried above a pan, shaken up and down, and brought back."""
    table = at_table(s, height=0.78, yaw_deg=-155)
    s.put("pan", forms.pot(0.13, 0.08), (0.6, 0.12))
    tin = jar(s, (0.48, -0.28), "shaker", 0.14)
    right = s.right(idle=0.2)
    fetch(right, tin, "-y", 0.9, 0.6, 0.3)
    travel(right, "Lift", (0.0, 0.0, 0.26), 0.9, tin, hold=0.4)
    travel(right, "Carry", (0.1, 0.38, 0.0), 1.0, tin, hold=0.5)
    right.swing((0.0, 0.0, 0.045), 2.8, 6)
    right.step("Shake", tin)
    right.hold(0.5, tin)
    travel(right, "Carry", (-0.1, -0.38, 0.0), 1.0, tin, hold=0.4)
    travel(right, "Lower", (0.0, 0.0, -0.26), 0.9, tin, table)
    finish(right, tin, table, 0.3, 0.9)


def bowl_tilted_and_kept_so(s: Stage) -> None:
    """A bowl on the palm is tilted by thirty-five degrees away from everything, and kept so."""
    at_table(s, height=0.6, yaw_deg=55, size=0.98)
    dish = s.put("bowl", shapes.vessel(0.1, 0.07, "bowl"), (0.48, 0.1, s.height + 0.3))
    left = s.left()
    begin_with(left, dish, Grip((0.0, 0.0, 0.0), (0.0, 0.0, -1.0), AHEAD))
    left.hold(0.6, dish)
    left.spin((0.48, 0.1, s.height + 0.33), AHEAD, 35.0, 1.0)
    left.step("Tilt", dish)
    left.hold(1.0, dish)


def jar_turned_about_its_axis_in_the_air(s: Stage) -> None:
    """A jar that is held over a basin is turned by seventy degrees about its upright axis."""
    at_table(s, height=0.7, yaw_deg=-3, size=1.04)
    builders.basin(s, (0.5, -0.05))
    tin = jar(s, (0.5, -0.05, s.height + 0.25), height=0.16)
    right = s.right()
    right.begin_at(tin, "-y", up=0.5, fingers=AHEAD)
    right.take(tin)
    right.hold(0.6, tin)
    right.spin((0.5, -0.05, 0.0), (0.0, 0.0, 1.0), 70.0, 1.2)
    right.step("Turn", tin)
    right.hold(0.8, tin)


APART_M = FINGERS_M - PALM_M
"""How far two jars that lie along one hand are apart [m]."""


def slim_jar(s: Stage, name: str, at: tuple[float, ...]) -> Thing:
    """A slim closed jar."""
    return s.put(name, shapes.Form("jar", (shapes.disc(0.032, 0.0, 0.12),)), at)


def two_jars(s: Stage, x: float, y: float, sign: float) -> tuple[Thing, Thing]:
    """Two jars one behind the other on the table; the first is the nearer one.

    Args:
        s: The stage.
        x: Of the first jar [m].
        y: Of both [m].
        sign: 1 if the palm comes from the left, -1 if from the right; the second stands deeper.
    """
    first = slim_jar(s, "amber_jar", (x, y))
    return first, slim_jar(s, "blue_jar", (x + APART_M, y + sign * PRESS))


def meet_both(hand: Hand, first: Thing, second: Thing, side: str, duration: float) -> float:
    """Reach two jars at once; gives the time of contact [s]."""
    hand.reach(first, side, duration, up=0.6, aside=(-PALM_M, 0.0, 0.0), others=(second,))
    return hand.clock


def take_both(hand: Hand, first: Thing, second: Thing) -> None:
    """Carry both along from now on."""
    hand.take(first)
    hand.held.append(second.body.ride(hand.body, hand.clock))


def two_jars_carried_to_a_board(s: Stage) -> None:
    """The right hand lifts two jars at once, carries them to a low board, and lets go of both."""
    at_table(s, height=0.72, yaw_deg=62)
    board = s.put("board", shapes.box(0.34, 0.4, 0.05, "board"), (0.52, 0.3), tag="fixed")
    first, second = two_jars(s, 0.46, -0.3, -1.0)
    right = s.right(idle=0.2)
    since = meet_both(right, first, second, "-y", 0.9)
    hold_both(right, 0.4, first, second)
    take_both(right, first, second)
    travel(right, "Lift", (0.0, 0.0, 0.17), 0.8, first, second)
    hold_both(right, 0.4, first, second)
    travel(right, "Carry", (0.0, 0.55, 0.0), 1.1, first, second)
    hold_both(right, 0.4, first, second)
    travel(right, "Lower", (0.0, 0.0, -0.12), 0.7, first, second, board, hold=0.4)
    also(right, second, since)
    right.let_go()
    right.fly(right.home, 1.0, depart=EASE)
    right.step("ResumePosture", first, second)
    right.idle(0.2)


def two_jars_pushed_at_once(s: Stage) -> None:
    """The left palm meets two jars at once and pushes both to the right over the table."""
    table = at_table(s, height=0.8, yaw_deg=-134, size=1.0)
    first, second = two_jars(s, 0.5, 0.2, 1.0)
    left = s.left(idle=0.2)
    since = meet_both(left, first, second, "+y", 0.9)
    hold_both(left, 0.4, first, second)
    take_both(left, first, second)
    travel(left, "Push", (0.0, -0.28, 0.0), 1.2, first, second, table, hold=0.7)
    also(left, second, since)


def first_of_two_jars_let_go_first(s: Stage) -> None:
    """Two jars are lifted and put back; the hand goes up aslant with the far one and keeps it."""
    table = at_table(s, height=0.69, yaw_deg=11)
    first, second = two_jars(s, 0.46, -0.12, -1.0)
    right = s.right(idle=0.2)
    since = meet_both(right, first, second, "-y", 0.9)
    hold_both(right, 0.4, first, second)
    take_both(right, first, second)
    travel(right, "Lift", (0.0, 0.0, 0.15), 0.8, first, second)
    hold_both(right, 0.6, first, second)
    travel(right, "Lower", (0.0, 0.0, -0.15), 0.8, first, second, table, hold=0.5)
    keep = right.held.pop()
    right.let_go()
    right.held.append(keep)
    right.touched, right.since = second, since
    travel(right, "Lift", (0.0, -0.2, 0.3), 0.9, second, hold=0.8)


def second_jar_taken_on_the_way(s: Stage) -> None:
    """A jar is lifted, held and carried on to another, which is taken too; both are lifted."""
    at_table(s, height=0.75, yaw_deg=-71, size=1.02)
    gap = 0.22
    near = slim_jar(s, "white_jar", (0.46, 0.35))
    s.put("block", shapes.box(0.1, 0.1, 0.1, "block"), (0.46 + APART_M, 0.35 - gap), tag="fixed")
    far = slim_jar(s, "green_jar", (0.46 + APART_M, 0.35 - gap + PRESS, s.height + 0.1))
    left = s.left(idle=0.2)
    left.reach(near, "+y", 0.9, up=0.6, aside=(-PALM_M, 0.0, 0.0), hold=0.3)
    left.take(near)
    travel(left, "Lift", (0.0, 0.0, 0.11), 0.7, near, hold=0.5)
    travel(left, "Carry", (0.0, -gap, 0.0), 0.9, near, far, arrive=EASE)
    since = left.clock
    hold_both(left, 0.5, near, far)
    left.held.append(far.body.ride(left.body, left.clock))
    travel(left, "Lift", (0.0, 0.0, 0.2), 0.9, near, far)
    hold_both(left, 0.8, near, far)
    also(left, far, since)
    left.alternative = tuple(
        replace(each, name="Reach", objects=(far.name, near.name))
        if each.objects == (near.name, far.name) and each.name == "Carry"
        else each
        for each in left.steps
    )


def on_the_palm(s: Stage, hand: Hand, name: str, height: float) -> Thing:
    """A block on a palm that faces up, from the first frame."""
    place = (0.42, 0.22, s.height + 0.15)
    block = s.put(name, shapes.box(0.07, 0.07, height, "block"), place)
    hand.body.first = Grip((0.0, 0.0, 0.0), (0.0, 0.0, -1.0), AHEAD).on(block, 0.0)
    hand.meet(block)
    hand.take(block)
    return block


def block_taken_off_the_other_palm(s: Stage) -> None:
    """A block lies on the left palm; the right hand takes it straight up off it and keeps it."""
    at_table(s, height=0.7, yaw_deg=119)
    left, right = s.left(), s.right(claw())
    block = on_the_palm(s, left, "block", 0.08)
    right.rest(0.6)
    right.reach(block, "+z", 1.0, up=1.0, fingers=LEFTWARD, name="Receive")
    right.hold(0.5, block)
    left.hold(right.clock, block)
    left.let_go()
    right.take(block)
    travel(right, "Lift", (0.0, 0.0, 0.2), 0.9, block, hold=0.7)
    left.rest(right.clock - left.clock)
    right.alternative = other_names(right, Receive="Reach")


def cube_stacked_on_a_block_on_the_other_palm(s: Stage) -> None:
    """The right hand takes a cube and puts it on the block that the left palm bears."""
    at_table(s, height=0.67, yaw_deg=-26, size=1.01)
    left, right = s.left(), s.right(claw())
    block = on_the_palm(s, left, "block", 0.06)
    cube = s.put("cube", shapes.box(0.05, 0.05, 0.06, "cube"), (0.48, -0.25))
    right.idle(0.2)
    right.reach(cube, "+z", 0.9, up=1.0, fingers=LEFTWARD, hold=0.3)
    right.take(cube)
    paused(right, cube, block, up=0.36, by=(-0.06, 0.47), down=0.15, holds=(0.0, 0.4))
    right.hold(0.4, cube, block)
    home_again(right, 1.1)
    left.hold(right.clock, block)


def two_blocks_brought_to_a_shelf_on_the_palm(s: Stage) -> None:
    """Two blocks are carried ahead on the right palm; the left hand takes one to a shelf."""
    at_table(s, height=0.64, yaw_deg=171)
    board = shelf(s, (0.6, 0.42, s.height + 0.1), size=(0.3, 0.3))
    right, left = s.right(), s.left(claw())
    place = (0.36, -0.12, s.height + 0.2)
    near = s.put("near_block", shapes.box(0.05, 0.05, 0.05, "block"), place)
    far = s.put("tall_block", shapes.box(0.045, 0.05, 0.1, "block"), (0.425, *place[1:]))
    right.body.first = Grip((0.01, 0.0, 0.0), (0.0, 0.0, -1.0), AHEAD).on(near, 0.0)
    right.meet(near)
    take_both(right, near, far)
    hold_both(right, 0.5, near, far)
    travel(right, "Carry", (0.14, 0.06, 0.0), 0.9, near, far)
    brought = right.clock
    left.rest(brought)
    left.reach(far, "+z", 1.1, up=1.0, fingers=LEFTWARD, name="Receive", when=brought)
    left.hold(0.4, far)
    right.held.pop().end = left.clock
    left.take(far)
    right.until(left.clock)
    right.step("Touch", near, far)
    also(right, far, 0.0)
    paused(left, far, board, up=0.15, by=(0.035, 0.48), down=0.25, holds=(0.4, 0.0))
    left.hold(0.4, far, board)
    home_again(left, 1.0)
    right.hold(left.clock - right.clock, near)
    left.alternative = other_names(left, Receive="Reach")


def hand_on(giver: Hand, taker: Hand, thing: Thing, *, far: float, reach_s: float) -> None:
    """Carry a thing towards the other hand [m], which rests, comes, takes it and keeps it."""
    inward, side = (1.0, "+y") if giver.side == "right" else (-1.0, "-y")
    travel(giver, "Carry", (0.0, inward * far, 0.0), 0.9, thing)
    brought = giver.clock
    taker.rest(brought + 0.3 - reach_s)
    taker.reach(thing, side, reach_s, name="Receive", when=brought)
    giver.hold(taker.clock + 0.5 - brought, thing)
    giver.leave(1.2, name="Give")
    taker.hold(giver.clock - 0.8 - taker.clock, thing)
    taker.take(thing)


def either_way(giver: Hand, taker: Hand) -> None:
    """List the names of a plain return and a plain reach for what both did."""
    giver.alternative = other_names(giver, Give="ResumePosture")
    taker.alternative = other_names(taker, Receive="Reach")


def tin_passed_through_a_hatch_to_a_shelf(s: Stage) -> None:
    """The right hand gives a tin through a hatch; the left hand stands it on a shelf."""
    at_table(s, height=0.7, yaw_deg=-87, size=1.03)
    s.put("hatch", forms.frame(0.5, 0.55), (0.48, -0.06), tag="fixed")
    board = shelf(s, (0.5, 0.32, s.height + 0.1), size=(0.3, 0.3))
    tin = tin_box(s, (0.48, -0.34), "tin", (0.1, 0.12, 0.16))
    right, left = s.right(), s.left()
    right.idle(0.2)
    fetch(right, tin, "-y", 0.9, 0.6, 0.3)
    travel(right, "Lift", (0.0, 0.0, 0.22), 0.8, tin, hold=0.4)
    hand_on(right, left, tin, far=0.3, reach_s=1.3)
    travel(left, "Carry", (0.0, 0.36, 0.0), 0.9, tin, hold=0.4)
    travel(left, "Lower", (0.0, 0.0, -0.12), 0.7, tin, board, hold=0.4)
    right.rest(left.clock - right.clock)
    either_way(right, left)


def tin_passed_from_left_to_right_and_put_down(s: Stage) -> None:
    """The left hand brings a tin over; the right hand takes it, lowers it and leaves."""
    table = at_table(s, height=0.82, yaw_deg=16, size=0.96)
    tin = tin_box(s, (0.5, 0.3, s.height + 0.15), "tin", (0.12, 0.1, 0.14))
    left, right = s.left(), s.right()
    left.begin_at(tin, "+y", up=0.55, fingers=(1.0, 0.0, 0.0))
    left.take(tin)
    left.hold(0.7, tin)
    hand_on(left, right, tin, far=0.32, reach_s=1.1)
    travel(right, "Lower", (0.0, 0.0, -0.15), 0.8, tin, table, hold=0.4)
    home_again(right, 0.9)
    left.rest(right.clock - left.clock)
    either_way(left, right)
