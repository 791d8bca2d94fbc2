"""Scenes in which things go into, out of, between and beside vessels, boxes and racks."""

from scenes.hands import shapes
from scenes.hands.scene import performer
from scenes.hands.scenes_place import claw, fetch, finish
from scenes.hands.scenes_two_hands import both_leave, both_reach
from scenes.hands.stage import Stage
from scenes.household import builders
from scenes.household.builders import jar, plum, scene
from scenes.objects import forms
from scenes.objects.builders import AHEAD, LEFTWARD, home_again, paused, pillar, shelf, travel


@scene
def plum_from_a_bucket_to_a_basin(s: Stage) -> None:
    """A plum is taken straight up out of a bucket and laid in a wide basin, slowly."""
    performer(s, height=0.62, yaw_deg=33, size=0.97)
    s.table()
    builders.bucket(s, (0.5, -0.28), height=0.08)
    fruit = plum(s, (0.5, -0.28, s.height + 0.006))
    basin = builders.basin(s, (0.62, 0.25))
    right = s.right(claw())
    right.idle(0.25)
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


@scene
def roll_put_on_its_stand(s: Stage) -> None:
    """A paper roll is brought over a pole and lowered around it onto the foot of the stand."""
    performer(s, height=0.8, yaw_deg=-72)
    s.table()
    stand = s.put("stand", builders.roll_stand(), (0.6, 0.22), tag="fixed")
    roll = s.put("roll", builders.paper_roll(), (0.52, -0.28))
    right = s.right()
    right.idle(0.2)
    fetch(right, roll, "-y", 0.9, 0.5, 0.4)
    paused(right, roll, stand, up=0.3, by=(0.08, 0.5), down=0.285, holds=(0.3, 0.5))
    finish(right, roll, stand, 0.4, 1.0)


@scene
def roll_taken_off_its_stand(s: Stage) -> None:
    """The left hand draws a paper roll up from its pole and keeps it in the air."""
    performer(s, height=0.7, yaw_deg=128, size=1.05, agent="tall_woman")
    s.table()
    s.put("stand", builders.roll_stand(), (0.55, 0.12), tag="fixed")
    roll = s.put("roll", builders.paper_roll(), (0.55, 0.12, s.height + 0.015))
    left = s.left()
    left.idle(0.15)
    fetch(left, roll, "+y", 0.8, 0.6, 0.0)
    travel(left, "Lift", (0.0, 0.0, 0.31), 1.0, roll)
    left.hold(0.9, roll)


@scene
def book_between_two_books(s: Stage) -> None:
    """A book is lowered into the gap between two others on a rack's lowest board."""
    performer(s, height=0.66, yaw_deg=15)
    s.table()
    rack = s.put(
        "rack", builders.open_shelves(0.26, 0.4, (0.03,)), (0.6, 0.2, s.height), tag="fixed"
    )
    for name, y in (("red_book", 0.12), ("blue_book", 0.2)):
        s.put(name, shapes.box(0.16, 0.025, 0.2, "book"), (0.72, y, s.height + 0.03))
    book = s.put("green_book", shapes.box(0.15, 0.03, 0.27, "book"), (0.5, -0.28))
    right = s.right(shapes.gripping_hand(0.05, 0.04))
    right.idle(0.2)
    right.reach(book, "+z", 0.9, up=1.0, fingers=LEFTWARD)
    right.hold(0.3, book)
    right.take(book)
    paused(right, book, rack, up=0.33, by=(0.22, 0.44), down=0.3, holds=(0.0, 0.4))
    finish(right, book, rack, 0.3, 1.2)


@scene
def spoon_into_a_holder(s: Stage) -> None:
    """A long spoon that is held in the air is stood in a tall holder and let go of."""
    performer(s, height=0.77, yaw_deg=-160)
    s.table()
    pot = s.put("holder", shapes.vessel(0.03, 0.16, "holder", 0.004), (0.55, 0.1))
    spoon = s.put("spoon", builders.tall_spoon(), (0.55, -0.18, s.height + 0.224))
    right = s.right(shapes.gripping_hand(0.05, 0.04))
    right.begin_at(spoon, "+z", up=1.0, fingers=AHEAD)
    right.take(spoon)
    right.hold(0.5, spoon)
    travel(right, "Carry", (0.0, 0.28, 0.0), 0.9, spoon)
    right.hold(0.4, spoon)
    travel(right, "Lower", (0.0, 0.0, -0.22), 1.0, spoon, pot)
    finish(right, spoon, pot, 0.3, 1.0)


@scene
def tower_taken_down_and_built_again(s: Stage) -> None:
    """The upper of two cubes is stood beside the lower one, which is then put on top of it."""
    performer(s, yaw_deg=101, size=1.02)
    table = s.table()
    lower = s.put("white_cube", shapes.box(0.08, 0.08, 0.08, "cube"), (0.55, -0.2))
    upper = s.put(
        "black_cube", shapes.box(0.075, 0.075, 0.075, "cube"), (0.55, -0.2, s.height + 0.08)
    )
    right = s.right(claw())
    right.idle(0.2)
    fetch(right, upper, "+z", 0.9, 1.0, 0.3)
    right.lift_carry_lower(upper, table, up=0.12, by=(0.05, 0.4), down=0.2)
    right.hold(0.3, upper, table)
    right.leave(1.0)
    right.rest(0.6)
    fetch(right, lower, "+z", 0.9, 1.0, 0.0)
    right.lift_carry_lower(lower, upper, up=0.2, by=(0.05, 0.4), down=0.125)
    finish(right, lower, upper, 0.4, 1.1)


@scene
def bowl_with_a_plum_out_of_a_box(s: Stage) -> None:
    """A bowl is lifted out of a low box by its side; a plum rides along in it."""
    performer(s, height=0.73, yaw_deg=-28)
    table = s.table()
    s.put("box", forms.open_box(0.42, 0.42, 0.05, "box"), (0.58, 0.18))
    dish = s.put("bowl", shapes.vessel(0.08, 0.13, "bowl"), (0.55, 0.22, s.height + 0.008))
    fruit = plum(s, (0.55, 0.22, s.height + 0.013))
    left = s.left()
    left.idle(0.2)
    left.reach(dish, "+y", 1.0, up=0.75)
    left.hold(0.4, dish)
    left.take(dish, fruit)
    left.lift_carry_lower(dish, table, up=0.16, by=(-0.02, -0.5), down=0.168)
    finish(left, dish, table, 0.3, 1.0)


@scene
def pan_set_in_a_sink(s: Stage) -> None:
    """Both hands take a pan by its lugs and sink it in a large basin, pausing over the opening."""
    performer(s, height=0.86, yaw_deg=60, size=1.06, agent="tall_man")
    s.table()
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


@scene
def jar_beside_a_bucket_after_a_stop_above_it(s: Stage) -> None:
    """A jar is held over a bucket for a second and a half, then stood on the table behind it."""
    performer(s, height=0.7, yaw_deg=-118)
    table = s.table()
    builders.bucket(s, (0.5, 0.0), height=0.16)
    tin = jar(s, (0.5, 0.36), height=0.14)
    left = s.left()
    left.idle(0.2)
    fetch(left, tin, "+z", 0.9, 1.0, 0.0)
    travel(left, "Lift", (0.0, 0.0, 0.26), 0.9, tin)
    left.hold(0.4, tin)
    travel(left, "Carry", (0.0, -0.36, 0.0), 1.1, tin)
    left.hold(1.5, tin)
    travel(left, "Carry", (0.26, -0.08, 0.0), 0.9, tin)
    left.hold(0.4, tin)
    travel(left, "Lower", (0.0, 0.0, -0.26), 0.9, tin, table)
    finish(left, tin, table, 0.4, 1.2)


@scene
def jar_off_a_rack_and_into_a_box(s: Stage) -> None:
    """A jar is lifted off a rack's upper board, held, and sunk into a box on a stool."""
    performer(s, height=0.75, yaw_deg=175)
    s.put("rack", builders.open_shelves(0.24, 0.6, (0.45, 0.9)), (0.55, 0.1, 0.0), tag="fixed")
    pillar(s, "stool", (0.4, -0.6, 0.42), (0.36, 0.36), "stool")
    box = s.put("box", forms.open_box(0.26, 0.26, 0.1, "box"), (0.4, -0.6, 0.42))
    tin = jar(s, (0.6, -0.1, 0.9), height=0.16)
    right = s.right()
    right.idle(0.2)
    fetch(right, tin, "+z", 1.0, 1.0, 0.4)
    travel(right, "Lift", (0.0, 0.0, 0.1), 0.7, tin)
    right.hold(0.5, tin)
    travel(right, "Carry", (-0.2, -0.5, 0.0), 1.3, tin)
    right.hold(0.6, tin)
    travel(right, "Lower", (0.0, 0.0, -0.572), 1.3, tin, box)
    finish(right, tin, box, 0.3, 1.2)


@scene
def plum_into_a_bowl_on_the_other_palm(s: Stage) -> None:
    """The left palm bears a bowl in the air throughout; the right hand puts a plum into it."""
    performer(s, height=0.68, yaw_deg=-8, size=0.98)
    s.table()
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


@scene
def plum_out_of_a_basin_into_a_dish(s: Stage) -> None:
    """The left hand takes a plum out of a basin and puts it into a dish, without any pause."""
    performer(s, height=0.52, yaw_deg=84, size=0.8, agent="child", offset=(2.0, -0.4))
    s.table()
    builders.basin(s, (0.48, 0.25))
    fruit = plum(s, (0.48, 0.25, s.height + 0.006), radius=0.026)
    dish = s.put("dish", shapes.vessel(0.085, 0.045, "dish"), (0.5, -0.15))
    left = s.left(claw())
    left.idle(0.1)
    left.reach(fruit, "+z", 0.8, up=1.0, fingers=LEFTWARD)
    left.take(fruit)
    left.lift_carry_lower(fruit, dish, up=0.2, by=(0.02, -0.4), down=0.201, times=(0.6, 0.8, 0.6))
    home_again(left, 0.9)


@scene
def tin_from_one_box_to_another_on_a_shelf(s: Stage) -> None:
    """A tin goes out of a low box on the table into a box on a shelf, with two short pauses."""
    performer(s, height=0.74, yaw_deg=-142, size=1.07)
    s.table()
    shelf(s, (0.68, 0.32, s.height + 0.3))
    s.put("low_box", forms.open_box(0.24, 0.24, 0.06, "box"), (0.48, -0.2))
    high = s.put("high_box", forms.open_box(0.28, 0.28, 0.07, "box"), (0.68, 0.32, s.height + 0.3))
    tin = builders.tin_box(s, (0.48, -0.2, s.height + 0.008), "tin", (0.08, 0.08, 0.12))
    right = s.right()
    right.idle(0.2)
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
