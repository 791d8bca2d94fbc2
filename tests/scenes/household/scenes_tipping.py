"""Scenes in which a held vessel is tipped, shaken or tilted over others and over nothing."""

from scenes.hands import shapes
from scenes.hands.scene import performer
from scenes.hands.scenes_place import fetch, finish
from scenes.hands.stage import Stage
from scenes.household import builders
from scenes.household.builders import glass, jar, scene
from scenes.objects import forms
from scenes.objects.builders import AHEAD, Grip, begin_with, travel


@scene
def jug_into_two_glasses(s: Stage) -> None:
    """A jug is tipped over a first glass, carried on, tipped over a second, and put down."""
    performer(s, height=0.72, yaw_deg=-36)
    table, jug = s.table(), s.put("jug", forms.jug(0.05, 0.18), (0.45, -0.28))
    for name, x in (("near_glass", 0.45), ("far_glass", 0.75)):
        glass(s, (x, -0.08), name)
    right = s.right()
    right.idle(0.2)
    fetch(right, jug, "-y", 0.9, 0.5, 0.3)
    travel(right, "Lift", (0.0, 0.0, 0.24), 0.9, jug)
    right.hold(0.4, jug)
    for x, by in ((0.45, 0.3), (0.75, 0.0)):
        right.dip((x, -0.23, s.height + 0.4), AHEAD, -95.0, 2.0)
        right.step("Pour", jug)
        right.hold(0.5, jug)
        if by:
            travel(right, "Carry", (by, 0.0, 0.0), 1.0, jug)
            right.hold(0.4, jug)
    travel(right, "Lower", (0.0, 0.0, -0.24), 0.9, jug, table)
    finish(right, jug, table, 0.3, 1.0)


@scene
def bottle_into_a_glass_that_the_other_hand_holds(s: Stage) -> None:
    """The right hand holds a glass in the air; the left hand tips a bottle over it and back."""
    performer(s, height=0.74, yaw_deg=121, size=1.03)
    s.table()
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


@scene
def bucket_tipped_over_a_basin_by_both(s: Stage) -> None:
    """Both hands tip a bucket forward over a basin and back; they hold it in the air throughout."""
    performer(s, height=0.5, yaw_deg=-79, size=1.05, agent="tall_woman")
    s.table(depth=0.9)
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


@scene
def cup_emptied_quickly_over_a_bowl(s: Stage) -> None:
    """A cup is carried from the table over a bowl, tipped at once and back, and held."""
    performer(s, height=0.67, yaw_deg=3, size=0.94)
    s.table()
    s.put("bowl", shapes.vessel(0.11, 0.06, "bowl"), (0.55, -0.02))
    cup = s.put("cup", shapes.vessel(0.038, 0.09, "cup"), (0.5, 0.35))
    left = s.left()
    left.idle(0.15)
    fetch(left, cup, "+y", 0.9, 0.6, 0.0)
    travel(left, "Lift", (0.0, 0.0, 0.24), 0.8, cup)
    left.hold(0.4, cup)
    travel(left, "Carry", (0.05, -0.26, 0.0), 0.8, cup)
    left.hold(0.4, cup)
    left.dip((0.55, 0.06, s.height + 0.29), AHEAD, 120.0, 1.2)
    left.step("Pour", cup)
    left.hold(0.6, cup)


@scene
def shaker_shaken_above_a_pan(s: Stage) -> None:
    """A shaker is carried above a pan, shaken up and down, and brought back."""
    performer(s, height=0.78, yaw_deg=-155)
    table = s.table()
    s.put("pan", forms.pot(0.13, 0.08), (0.6, 0.12))
    tin = jar(s, (0.48, -0.28), "shaker", 0.14)
    right = s.right()
    right.idle(0.2)
    fetch(right, tin, "-y", 0.9, 0.6, 0.3)
    travel(right, "Lift", (0.0, 0.0, 0.26), 0.9, tin)
    right.hold(0.4, tin)
    travel(right, "Carry", (0.1, 0.38, 0.0), 1.0, tin)
    right.hold(0.5, tin)
    right.swing((0.0, 0.0, 0.045), 2.8, 6)
    right.step("Shake", tin)
    right.hold(0.5, tin)
    travel(right, "Carry", (-0.1, -0.38, 0.0), 1.0, tin)
    right.hold(0.4, tin)
    travel(right, "Lower", (0.0, 0.0, -0.26), 0.9, tin, table)
    finish(right, tin, table, 0.3, 0.9)


@scene
def bowl_tilted_and_kept_so(s: Stage) -> None:
    """A bowl on the palm is tilted by thirty-five degrees away from everything, and kept so."""
    performer(s, height=0.6, yaw_deg=55, size=0.98)
    s.table()
    dish = s.put("bowl", shapes.vessel(0.1, 0.07, "bowl"), (0.48, 0.1, s.height + 0.3))
    left = s.left()
    begin_with(left, dish, Grip((0.0, 0.0, 0.0), (0.0, 0.0, -1.0), AHEAD))
    left.hold(0.6, dish)
    left.spin((0.48, 0.1, s.height + 0.33), AHEAD, 35.0, 1.0)
    left.step("Tilt", dish)
    left.hold(1.0, dish)


@scene
def jar_turned_about_its_axis_in_the_air(s: Stage) -> None:
    """A jar that is held over a basin is turned by seventy degrees about its upright axis."""
    performer(s, height=0.7, yaw_deg=-3, size=1.04)
    s.table()
    builders.basin(s, (0.5, -0.05))
    tin = jar(s, (0.5, -0.05, s.height + 0.25), height=0.16)
    right = s.right()
    right.begin_at(tin, "-y", up=0.5, fingers=AHEAD)
    right.take(tin)
    right.hold(0.6, tin)
    right.spin((0.5, -0.05, 0.0), (0.0, 0.0, 1.0), 70.0, 1.2)
    right.step("Turn", tin)
    right.hold(0.8, tin)
