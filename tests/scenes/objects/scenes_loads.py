"""Scenes in which things ride along in or on what is carried, pushed or pulled."""

from scenes.hands import shapes
from scenes.hands.scene import performer
from scenes.hands.scenes_place import fetch, finish
from scenes.hands.scenes_two_hands import both_leave, both_reach
from scenes.hands.stage import Stage
from scenes.objects import forms
from scenes.objects.builders import (
    NEAR,
    RIGHTWARD,
    UP,
    Grip,
    apple,
    can,
    home_again,
    paused,
    scene,
    seize,
    toy,
    travel,
)
from scenes.objects.scenes_drawers import grip_hand

AHEAD = (1.0, 0.0, 0.0)


@scene
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


@scene
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


@scene
def basket_with_apples(s: Stage) -> None:
    """A basket with two apples is carried by its arched handle."""
    performer(s, height=0.6, yaw_deg=-5)
    table = s.table()
    pannier = s.put("basket", forms.basket(0.26, 0.3, 0.1, 0.26), (0.5, -0.25))
    fruits = [
        apple(s, (0.5 + x, -0.25, s.height + 0.008), name)
        for x, name in ((-0.06, "red_apple"), (0.06, "green_apple"))
    ]
    right = s.right()
    right.idle(0.2)
    right.reach(pannier, "+z", 1.0, up=1.0)
    right.hold(0.4, pannier)
    right.take(pannier, *fruits)
    right.lift_carry_lower(pannier, table, up=0.18, by=(0.05, 0.5), down=0.18)
    finish(right, pannier, table, 0.3, 1.0)


@scene
def empty_basket(s: Stage) -> None:
    """An empty basket is lifted by its handle with the left hand, held and set down again."""
    performer(s, height=0.5, yaw_deg=85, size=1.06)
    table = s.table()
    pannier = s.put("basket", forms.basket(0.24, 0.28, 0.1, 0.28), (0.5, 0.15))
    left = s.left()
    left.idle(0.2)
    fetch(left, pannier, "+z", 1.0, 1.0, 0.3)
    travel(left, "Lift", (0.0, 0.0, 0.25), 0.9, pannier)
    left.hold(1.0, pannier)
    travel(left, "Lower", (0.0, 0.0, -0.25), 1.0, pannier, table)
    finish(left, pannier, table, 0.3, 0.9)


@scene
def carton_with_cans(s: Stage) -> None:
    """Both hands carry a carton with two cans from the table to a higher side table and stay."""
    performer(s, height=0.78, yaw_deg=-170)
    s.table(width=0.7)
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


@scene
def plate_on_the_palm(s: Stage) -> None:
    """A plate with a cup on it lies on the palm from the first frame; it is raised and carried."""
    performer(s, height=0.75, yaw_deg=60)
    s.table()
    plate = s.put("plate", shapes.box(0.2, 0.2, 0.015, "plate"), (0.4, -0.3, s.height + 0.15))
    cup = s.put("cup", shapes.vessel(0.035, 0.08, "cup"), (0.42, -0.3, s.height + 0.165))
    right = s.right()
    right.begin_at(plate, "-z", up=0.0, fingers=AHEAD)
    right.take(plate, cup)
    right.hold(0.5, plate)
    travel(right, "Raise", (0.0, 0.0, 0.2), 0.9, plate)
    right.hold(0.5, plate)
    travel(right, "Carry", (0.1, 0.4, 0.0), 1.2, plate)
    right.hold(0.6, plate)


@scene
def block_with_a_block_on_top(s: Stage) -> None:
    """Two blocks, one on the other, are moved by the lower one with the left hand."""
    performer(s, height=0.9, yaw_deg=10)
    table = s.table()
    lower = s.put("lower_block", shapes.box(0.12, 0.1, 0.1, "block"), (0.5, 0.3))
    upper = toy(s, (0.5, 0.3, s.height + 0.1), "upper_block", 0.05)
    left = s.left()
    left.idle(0.2)
    left.reach(lower, "+y", 0.9)
    left.hold(0.3, lower)
    left.take(lower, upper)
    left.lift_carry_lower(lower, table, up=0.15, by=(0.1, -0.45), down=0.15, times=(0.9, 1.2, 0.9))
    finish(left, lower, table, 0.3, 1.0)


@scene
def loaded_crate_pulled(s: Stage) -> None:
    """A crate with a can in it is drawn near over the table by its handle."""
    performer(s, height=0.72, yaw_deg=-95)
    table = s.table()
    parts = forms.open_box(0.24, 0.24, 0.1, "crate").parts
    handle = shapes.block((-0.12 - forms.HANDLE_M, -0.004, 0.02), (-0.12, 0.004, 0.08))
    box = s.put("crate", shapes.Form("crate", (*parts, handle)), (0.8, -0.05))
    tin = can(s, (0.8, -0.02, s.height + 0.008))
    right = s.right(grip_hand())
    right.idle(0.2)
    grip = Grip((-0.12 - forms.HANDLE_M, 0.0, 0.05), NEAR, RIGHTWARD)
    seize(right, box, grip, 0.9, hold=0.4)
    right.take_along(box, tin)
    travel(right, "Pull", (-0.24, 0.0, 0.0), 1.0, box, table)
    right.hold(0.4, box, table)
    home_again(right, 0.7)


@scene
def loaded_crate_pushed_by_both(s: Stage) -> None:
    """Both palms push a crate with two cans away, at once on contact and slowly."""
    performer(s, height=0.85, yaw_deg=220, size=0.97)
    table = s.table()
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
    travel(right, "Push", (0.25, 0.0, 0.0), 2.2, box, table)
    right.hold(0.6, box, table)
    left.part(right, since)
    both_leave(hands, 0.9)


@scene
def tray_held_from_the_first_frame(s: Stage) -> None:
    """A tray with a can on it is held in the air by both hands, lowered on the table and kept."""
    performer(s, yaw_deg=25, offset=(1.5, 1.5))
    table = s.table()
    tray = s.put("tray", shapes.tray(0.28, 0.36), (0.5, 0.0, s.height + 0.25))
    tin = can(s, (0.5, 0.05, s.height + 0.258), height=0.1)
    right, left = s.right(), s.left()
    for hand, side in ((right, "-y"), (left, "+y")):
        hand.begin_at(tray, side, up=0.75, fingers=AHEAD)
    left.join(tray)
    right.take(tray, tin)
    right.hold(0.7, tray)
    travel(right, "Lower", (0.0, 0.0, -0.25), 1.1, tray, table)
    right.hold(0.8, tray, table)
    left.part(right, 0)
