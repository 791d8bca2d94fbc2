"""Scenes in which a carrier goes with a load in or on it: trays, boxes, pans, stacks, a palm."""

from scenes.hands import shapes
from scenes.hands.scene import performer
from scenes.hands.scenes_place import fetch, finish
from scenes.hands.scenes_two_hands import both_leave, both_reach
from scenes.hands.stage import Stage
from scenes.household import builders
from scenes.household.builders import glass, jar, plum, scene, tin_box
from scenes.objects import forms
from scenes.objects.builders import AHEAD, UP, home_again, paused, pillar, shelf, travel


@scene
def basket_with_a_bottle(s: Stage) -> None:
    """A basket with a bottle and a plum is carried to the right by its arch and stood down."""
    performer(s, height=0.56, yaw_deg=19, size=1.01)
    table = s.table()
    pannier = s.put("basket", forms.basket(0.3, 0.28, 0.12, 0.34), (0.52, 0.3))
    flask = s.put("bottle", shapes.bottle(0.032, 0.2), (0.46, 0.3, s.height + 0.008))
    fruit = plum(s, (0.6, 0.32, s.height + 0.008))
    left = s.left()
    left.idle(0.2)
    left.reach(pannier, "+z", 1.0, up=1.0, fingers=(0.0, 1.0, 0.0))
    left.hold(0.4, pannier)
    left.take(pannier, flask, fruit)
    paused(left, pannier, table, up=0.16, by=(0.03, -0.5), down=0.16, holds=(0.5, 0.0))
    finish(left, pannier, table, 0.5, 1.0)


@scene
def tray_with_glasses_pushed_by_one_palm(s: Stage) -> None:
    """A tray with two glasses on it is pushed away over the table."""
    performer(s, height=0.78, yaw_deg=-128)
    table = s.table()
    tray = s.put("tray", shapes.tray(0.24, 0.3), (0.5, -0.1))
    ware = [
        glass(s, (0.5, y, s.height + 0.008), name)
        for name, y in (("near_glass", -0.17), ("far_glass", -0.04))
    ]
    right = s.right()
    right.idle(0.2)
    right.reach(tray, "-x", 0.9, up=0.6, fingers=UP)
    right.hold(0.4, tray)
    right.take(tray, *ware)
    travel(right, "Push", (0.28, 0.0, 0.0), 1.6, tray, table)
    finish(right, tray, table, 0.5, 0.9)


@scene
def carton_with_a_ball_up_to_a_shelf(s: Stage) -> None:
    """Both hands lift a carton with a ball, bring it over a shelf, set it down and stay."""
    performer(s, height=0.66, yaw_deg=83, size=1.07, agent="tall_woman")
    s.table()
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


@scene
def loaded_crate_stacked_on_another(s: Stage) -> None:
    """A crate with two jars in it is put on top of an empty one in a single sweep."""
    performer(s, height=0.5, yaw_deg=-46, size=1.04)
    s.table()
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


@scene
def tray_on_one_palm(s: Stage) -> None:
    """A tray with a glass lies on the palm; it is carried to the left, and on after a stop."""
    performer(s, height=0.72, yaw_deg=105)
    s.table()
    tray = s.put("tray", shapes.box(0.3, 0.3, 0.014, "tray"), (0.42, -0.35, s.height + 0.3))
    ware = glass(s, (0.4, -0.38, s.height + 0.314))
    right = s.right()
    right.begin_at(tray, "-z", up=0.0, fingers=AHEAD)
    right.take(tray, ware)
    right.hold(0.7, tray)
    for far, duration, rest in ((0.3, 1.0, 0.9), (0.25, 0.9, 0.7)):
        travel(right, "Carry", (0.03, far, 0.0), duration, tray)
        right.hold(rest, tray)


@scene
def pan_with_its_lid(s: Stage) -> None:
    """Both hands carry a pan by its lugs to a higher plate; the lid rides on it."""
    performer(s, height=0.76, yaw_deg=-15, size=0.99)
    s.table(width=0.8)
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


@scene
def three_books_between_two_palms(s: Stage) -> None:
    """A stack of three books is lifted by the lowest one, held, and set down where it was."""
    performer(s, height=0.67, yaw_deg=-172)
    table = s.table()
    low = s.put("thick_book", shapes.box(0.2, 0.28, 0.1, "book"), (0.52, 0.02))
    middle = s.put("thin_book", shapes.box(0.18, 0.24, 0.03, "book"), (0.53, 0.02, s.height + 0.1))
    top = s.put("small_book", shapes.box(0.12, 0.16, 0.04, "book"), (0.52, 0.03, s.height + 0.13))
    hands = both_reach(s, low, 0.9, 0.55, 0.5)
    right, left = hands
    since = len(right.steps)
    left.join(low)
    right.take(low, middle, top)
    travel(right, "Lift", (0.0, 0.0, 0.3), 1.1, low)
    right.hold(1.3, low)
    travel(right, "Lower", (0.0, 0.0, -0.3), 1.2, low, table)
    right.hold(0.4, low, table)
    left.part(right, since)
    both_leave(hands, 0.9)


@scene
def board_with_a_loaf_slid_aside(s: Stage) -> None:
    """A palm on a board with a loaf at its other end slides both to the left, and stays."""
    performer(s, height=0.88, yaw_deg=57, size=1.06)
    table = s.table()
    board = s.put("board", shapes.box(0.22, 0.44, 0.045, "board"), (0.55, -0.15))
    loaf = s.put("loaf", shapes.box(0.12, 0.16, 0.1, "loaf"), (0.57, -0.25, s.height + 0.045))
    left = s.left()
    left.idle(0.2)
    left.reach(board, "+z", 1.0, up=1.0, aside=(-0.04, 0.15, 0.0))
    left.hold(0.3, board)
    left.take(board, loaf)
    travel(left, "Slide", (0.0, 0.3, 0.0), 1.2, board, table)
    left.hold(0.7, board, table)


@scene
def box_in_a_box_put_down_from_the_air(s: Stage) -> None:
    """Both hands hold an open box with a small box in it; they carry it ahead and put it down."""
    performer(s, height=0.7, yaw_deg=142, size=0.95)
    table = s.table()
    outer = s.put("outer_box", shapes.carton(0.24, 0.3, 0.18), (0.42, 0.0, s.height + 0.22))
    inner = tin_box(s, (0.44, 0.04, s.height + 0.226), "inner_box", (0.1, 0.08, 0.07))
    right, left = s.right(), s.left()
    for hand, side in ((right, "-y"), (left, "+y")):
        hand.begin_at(outer, side, up=0.5, fingers=AHEAD)
    left.join(outer)
    right.take(outer, inner)
    right.hold(0.5, outer)
    travel(right, "Carry", (0.24, 0.0, 0.0), 1.0, outer)
    right.hold(0.5, outer)
    travel(right, "Lower", (0.0, 0.0, -0.22), 0.9, outer, table)
    right.hold(0.4, outer, table)
    left.part(right, 0)
    both_leave([right, left], 0.9)


@scene
def bucket_with_plums_swung_quickly(s: Stage) -> None:
    """A bucket with two plums is carried by the palm at its side at more than a metre a second."""
    performer(s, height=0.6, yaw_deg=-80, size=1.03)
    table = s.table()
    pail = builders.bucket(s, (0.55, -0.3), height=0.2)
    fruits = [
        plum(s, (0.55 + x, -0.3, s.height + 0.006), name)
        for name, x in (("ripe_plum", -0.05), ("green_plum", 0.05))
    ]
    right = s.right()
    right.idle(0.15)
    fetch(right, pail, "-y", 0.8, 0.7, 0.0)
    right.release()
    right.take(pail, *fruits)
    right.lift_carry_lower(pail, table, up=0.18, by=(0.0, 0.55), down=0.18, times=(0.6, 0.9, 0.6))
    home_again(right, 0.9)
