"""Drawers, sliding and turning doors, shelves, obstacles, and hands that only rest or pass."""

import numpy as np

from scenes.hands import shapes
from scenes.hands.paths import AHEAD, LEFTWARD, NEAR, RIGHTWARD, UP, about, min_jerk
from scenes.hands.performer import Hand, travel
from scenes.hands.scene import at_table, performer
from scenes.hands.scenes_place import claw, fetch, finish
from scenes.hands.scenes_two_hands import both_leave, both_reach
from scenes.hands.shapes import Form, block
from scenes.hands.stage import Stage, other_names
from scenes.hands.things import Thing
from scenes.household import builders
from scenes.household.builders import (
    Rail,
    dresser,
    flap_cupboard,
    gate,
    glass,
    jar,
    oven,
    plum,
    sliding_cupboard,
    tin_box,
)
from scenes.household.scenes_vessels import narrow
from scenes.objects import forms
from scenes.objects.builders import (
    Grip,
    cupboard,
    floor,
    home_again,
    paused,
    pillar,
    seize,
    shelf,
    wall,
)
from scenes.objects.scenes_furniture import swing


def draw(hand: Hand, rail: Rail, by: float, duration: float) -> None:
    """Draw a drawer out by a length, or push it in by a negative one [m]."""
    travel(hand, "Open" if by > 0 else "Close", (-by, 0.0, 0.0), duration, rail.part, rail.body)


def stay(hand: Hand, rail: Rail, duration: float) -> None:
    """Keep hold of what was moved on its rail."""
    hand.hold(duration, rail.part, rail.body)


def two_handled(rail: Rail) -> Form:
    """A drawer's form with a second and a third handle near its ends."""
    *parts, handle = rail.part.form.parts
    low, high = handle.bounds
    ends = [block((low[0], y - 0.004, low[2]), (high[0], y + 0.004, high[2])) for y in (-0.2, 0.2)]
    return Form("drawer", (*parts, *ends))


def upper_drawer_then_lower_drawer(s: Stage) -> None:
    """The upper of two drawers is opened and shut; after a rest the lower one is opened."""
    at_table(s, height=0.68, yaw_deg=-24)
    low, high = dresser(s, (0.66, -0.12, s.height + 0.012), heights=(0.12, 0.12))
    right = s.right(narrow(), idle=0.2)
    seize(right, high.part, high.grip, 0.9, hold=0.3)
    draw(right, high, 0.2, 0.9)
    stay(right, high, 0.6)
    draw(right, high, -0.2, 0.8)
    stay(right, high, 0.3)
    right.leave(0.8)
    right.rest(0.7)
    seize(right, low.part, low.grip, 0.9)
    draw(right, low, 0.18, 0.8)
    stay(right, low, 0.8)


def lower_drawer_in_three_stages(s: Stage) -> None:
    """A low drawer is drawn out by eight, six and ten centimetres, with unequal holds between."""
    at_table(s, height=0.58, yaw_deg=113, size=0.9, agent="girl")
    low, _ = dresser(s, (0.64, 0.14, s.height + 0.012), heights=(0.14, 0.1))
    left = s.left(narrow(), idle=0.15)
    seize(left, low.part, low.grip, 0.9, hold=0.5)
    for by, rest in ((0.08, 0.4), (0.06, 1.1), (0.1, 0.5)):
        draw(left, low, by, 0.6)
        stay(left, low, rest)
    home_again(left, 0.8)


def drawer_out_and_half_way_back(s: Stage) -> None:
    """A shut drawer is drawn out fast, and pushed half of the way back before it is let go of."""
    at_table(s, height=0.83, yaw_deg=-139, size=1.07, agent="tall_man")
    (rail,) = dresser(s, (0.68, -0.08, s.height + 0.012), heights=(0.16,))
    right = s.right(narrow(), idle=0.15)
    seize(right, rail.part, rail.grip, 0.8)
    draw(right, rail, 0.28, 0.5)
    stay(right, rail, 0.4)
    draw(right, rail, -0.14, 0.6)
    stay(right, rail, 0.4)
    home_again(right, 0.8)


def drawer_opened_by_one_hand_and_shut_by_the_other(s: Stage) -> None:
    """The left hand opens a drawer and goes home; the right palm pushes it shut by its front."""
    at_table(s, height=0.74, yaw_deg=38)
    (rail,) = dresser(s, (0.7, 0.0, s.height + 0.012), heights=(0.15,), width=0.5)
    left, right = s.left(narrow()), s.right()
    left.idle(0.2)
    seize(left, rail.part, rail.grip, 0.9, hold=0.4)
    draw(left, rail, 0.24, 1.0)
    stay(left, rail, 0.3)
    left.leave(0.9)
    right.rest(left.clock)
    seize(right, rail.part, Grip((0.0, -0.15, 0.08), NEAR, LEFTWARD), 0.9, hold=0.3)
    draw(right, rail, -0.24, 0.9)
    stay(right, rail, 0.3)
    home_again(right, 0.9)
    left.rest(right.clock - left.clock)


def heavy_drawer_pushed_shut_with_the_palm(s: Stage) -> None:
    """A drawer with two tins is pushed slowly to half way, rests, and is pushed shut."""
    at_table(s, height=0.64, yaw_deg=-85, size=0.94, agent="old_man")
    (rail,) = dresser(s, (0.7, -0.06, s.height + 0.012), heights=(0.17,), width=0.44)
    rail.part.body.first[0, 3] -= 0.26
    x, y, z = rail.part.body.first[:3, 3]
    tins = [
        tin_box(s, (x + back, y + 0.06, z + 0.008), name, (0.07, 0.07, 0.11))
        for name, back in (("round_tin", 0.08), ("square_tin", 0.2))
    ]
    right = s.right(idle=0.2)
    seize(right, rail.part, Grip((0.0, -0.15, 0.08), NEAR, LEFTWARD), 1.3, hold=0.5)
    right.take_along(rail.part, *tins)
    draw(right, rail, -0.13, 1.8)
    stay(right, rail, 1.4)
    draw(right, rail, -0.13, 1.8)
    stay(right, rail, 0.6)
    home_again(right, 1.2)


def tin_out_of_a_drawer_and_drawer_shut(s: Stage) -> None:
    """The left hand opens a drawer, the right hand takes a tin out, then the left hand shuts it."""
    table = at_table(s, height=0.7, yaw_deg=160)
    (rail,) = dresser(s, (0.74, 0.06, s.height + 0.012), heights=(0.13,))
    x, y, z = rail.part.body.first[:3, 3]
    tin = tin_box(s, (x + 0.1, y - 0.03, z + 0.008), "tin", (0.06, 0.06, 0.12 - 0.012))
    left, right = s.left(narrow()), s.right(claw())
    left.idle(0.2)
    seize(left, rail.part, rail.grip, 0.9, hold=0.3)
    left.take_along(rail.part, tin)
    draw(left, rail, 0.22, 1.0)
    opened = left.clock
    right.rest(opened - 0.4)
    right.reach(tin, "+z", 1.0, up=1.0, fingers=LEFTWARD, when=opened, hold=0.4)
    left.held.pop().end = right.clock
    right.take(tin)
    down = 0.2 + 0.012 - 0.0003 + 0.008
    right.lift_carry_lower(tin, table, up=0.2, by=(-0.08, -0.42), down=down)
    right.hold(0.3, tin, table)
    right.leave(0.9)
    stay(left, rail, right.clock - opened - 0.5)
    draw(left, rail, -0.22, 0.9)
    stay(left, rail, 0.6)
    right.rest(left.clock - right.clock)


def plum_laid_in_an_open_drawer(s: Stage) -> None:
    """A plum is laid in a drawer that stands open, which nobody moves."""
    at_table(s, height=0.77, yaw_deg=-4, size=1.05)
    (rail,) = dresser(s, (0.72, -0.1, s.height + 0.012), heights=(0.1,))
    rail.part.body.first[0, 3] -= 0.24
    floor = 0.012 - 0.0003 + 0.008
    fruit = plum(s, (0.5, 0.35))
    left = s.left(claw(), idle=0.2)
    left.reach(fruit, "+z", 0.9, up=1.0, fingers=LEFTWARD, hold=0.3)
    left.take(fruit)
    left.lift_carry_lower(fruit, rail.part, up=0.24, by=(0.1, -0.45), down=0.24 - floor)
    finish(left, fruit, rail.part, 0.3, 1.2)


def wide_drawer_opened_with_both_hands(s: Stage) -> None:
    """Both hands take the two handles of a wide drawer and draw it out."""
    at_table(s, height=0.6, yaw_deg=71)
    (rail,) = dresser(s, (0.66, 0.0, s.height + 0.012), heights=(0.15,), width=0.6)
    rail.part.form = two_handled(rail)
    right, left = s.right(narrow()), s.left(narrow())
    for hand, y in ((right, -0.2), (left, 0.2)):
        hand.idle(0.2)
        grip = Grip((-0.06, y, 0.068), NEAR, (0.0, -1.0, 0.0))
        seize(hand, rail.part, grip, 0.9, hold=0.4, take=False)
    since = len(right.steps)
    left.join(rail.part)
    right.take(rail.part)
    draw(right, rail, 0.2, 1.1)
    stay(right, rail, 0.5)
    left.part(right, since)
    for hand in (right, left):
        home_again(hand, 0.8)


def sliding_door_pushed_aside(s: Stage) -> None:
    """A sideboard's door is slid to the left by its handle and let go of."""
    at_table(s, height=0.55, yaw_deg=-50)
    rail = sliding_cupboard(s, (0.68, 0.0, s.height + 0.05), way=1.0)
    right = s.right(narrow(), idle=0.2)
    seize(right, rail.part, rail.grip, 0.9, hold=0.4)
    travel(right, "Open", (0.0, 0.27, 0.0), 1.1, rail.part, rail.body)
    stay(right, rail, 0.4)
    home_again(right, 0.9)


def sliding_door_opened_and_shut(s: Stage) -> None:
    """The left hand slides a door to the right, waits, and slides it back in one contact."""
    at_table(s, height=0.62, yaw_deg=122, size=1.04)
    rail = sliding_cupboard(s, (0.66, 0.05, s.height + 0.05), way=-1.0, width=0.5, height=0.26)
    left = s.left(narrow(), idle=0.2)
    seize(left, rail.part, rail.grip, 1.0)
    travel(left, "Open", (0.0, -0.22, 0.0), 0.8, rail.part, rail.body)
    stay(left, rail, 1.5)
    travel(left, "Close", (0.0, 0.22, 0.0), 0.9, rail.part, rail.body)
    stay(left, rail, 0.5)


def sliding_door_shut_by_the_palm_at_its_edge(s: Stage) -> None:
    """A door is slid shut in two stages, with the palm at its handle's side."""
    at_table(s, height=0.6, yaw_deg=-100, size=0.98)
    rail = sliding_cupboard(s, (0.68, -0.02, s.height + 0.05), way=1.0)
    rail.part.body.first[1, 3] += 0.26
    left = s.left(idle=0.2)
    palm = Grip((-0.066, 0.004, 0.19), LEFTWARD, UP)
    seize(left, rail.part, palm, 1.0, hold=0.3)
    for by in (0.12, 0.14):
        travel(left, "Close", (0.0, -by, 0.0), 0.7, rail.part, rail.body)
        stay(left, rail, 0.6)
    home_again(left, 0.9)


def oven_opened_downwards(s: Stage) -> None:
    """An oven's door is turned down by its bar and stays in the hand."""
    performer(s, height=0.72, yaw_deg=-20)
    pillar(s, "plinth", (0.9, 0.0, 0.4), (0.5, 0.5), "plinth")
    stove = oven(s, (0.68, -0.05, 0.412))
    right = s.right(narrow(), idle=0.2)
    seize(right, stove.leaf, stove.grip, 1.0, hold=0.4)
    swing(right, stove, 68.0, 1.4)
    right.hold(0.9, stove.leaf, stove.body)


def oven_shut_upwards(s: Stage) -> None:
    """The left hand turns a hanging oven door up until it is shut, at once on contact."""
    performer(s, height=0.8, yaw_deg=137, size=1.05)
    pillar(s, "plinth", (0.9, 0.1, 0.45), (0.5, 0.5), "plinth")
    stove = oven(s, (0.68, 0.1, 0.462))
    stove.hinge.opened(stove.leaf, 60.0)
    left = s.left(narrow(), idle=0.2)
    seize(left, stove.leaf, stove.grip, 1.2)
    swing(left, stove, -60.0, 1.2)
    left.hold(0.4, stove.leaf, stove.body)
    home_again(left, 0.9)


def oven_opened_a_crack_and_shut(s: Stage) -> None:
    """An oven's door is opened by twenty degrees, held for two seconds, and shut."""
    performer(s, height=0.78, yaw_deg=70, size=0.95, agent="old_woman")
    pillar(s, "plinth", (0.92, -0.1, 0.5), (0.5, 0.5), "plinth")
    stove = oven(s, (0.68, -0.1, 0.512), width=0.4, height=0.3)
    right = s.right(narrow(), idle=0.25)
    seize(right, stove.leaf, stove.grip, 1.2, hold=0.6)
    swing(right, stove, 20.0, 1.0)
    right.hold(2.0, stove.leaf, stove.body)
    swing(right, stove, -20.0, 1.0)
    right.hold(0.5, stove.leaf, stove.body)
    home_again(right, 1.1)


def flap_turned_up(s: Stage) -> None:
    """A cupboard's flap over the table is turned up by its lip and held open."""
    at_table(s, height=0.7, yaw_deg=-107, size=1.06, agent="tall_man")
    press = flap_cupboard(s, (0.66, 0.1, s.height + 0.4))
    left = s.left(narrow(), idle=0.2)
    seize(left, press.leaf, press.grip, 1.1, hold=0.3)
    swing(left, press, 75.0, 1.3)
    left.hold(1.6, press.leaf, press.body)


def flap_let_down_in_two_stages(s: Stage) -> None:
    """A flap that stands up is turned half way down, held for a second, and shut."""
    at_table(s, height=0.68, yaw_deg=28, size=1.03)
    press = flap_cupboard(s, (0.66, -0.1, s.height + 0.38), width=0.44, height=0.26)
    press.hinge.opened(press.leaf, 64.0)
    right = s.right(narrow(), idle=0.2)
    seize(right, press.leaf, press.grip, 1.2, hold=0.4)
    swing(right, press, -30.0, 0.8)
    right.hold(1.0, press.leaf, press.body)
    swing(right, press, -34.0, 0.9)
    right.hold(0.4, press.leaf, press.body)
    home_again(right, 1.0)


def gate_opened(s: Stage) -> None:
    """A gate between two posts on the floor is drawn open by its handle, in a wide arc."""
    performer(s, height=0.5, yaw_deg=180, size=1.02)
    floor(s)
    port = gate(s, (0.75, -0.45, 0.0))
    right = s.right(narrow(), idle=0.2)
    seize(right, port.leaf, port.grip, 0.9, hold=0.3)
    swing(right, port, 42.0, 1.4)
    right.hold(0.5, port.leaf, port.body)
    home_again(right, 0.9)


def gate_shut_with_the_palm(s: Stage) -> None:
    """A gate that stands open is pressed shut with the left palm on its outer face."""
    performer(s, height=0.55, yaw_deg=-66)
    floor(s)
    port = gate(s, (0.78, -0.5, 0.0), width=0.56, height=0.9)
    port.hinge.opened(port.leaf, 35.0)
    left = s.left(idle=0.2)
    seize(left, port.leaf, port.face, 0.9)
    swing(left, port, -35.0, 0.9)
    left.hold(0.7, port.leaf, port.body)


def glass_out_and_door_shut(s: Stage) -> None:
    """The left hand opens a door, the right hand takes a glass out, and the left hand shuts it."""
    table = at_table(s, height=0.71, yaw_deg=49)
    press = cupboard(s, (0.7, 0.05, s.height + 0.012), side="left", width=0.4)
    ware = glass(s, (0.8, 0.0, s.height + 0.012))
    left, right = s.left(narrow()), s.right(claw())
    left.idle(0.2)
    seize(left, press.leaf, press.grip, 1.0, hold=0.3)
    swing(left, press, 88.0, 1.4)
    opened = left.clock
    right.rest(opened)
    seize(right, ware, Grip((-0.032, 0.0, 0.075), NEAR, LEFTWARD), 1.1, hold=0.3)
    paused(right, ware, table, up=0.08, by=(-0.32, -0.12), down=0.092, holds=(0.0, 0.4))
    right.hold(0.3, ware, table)
    right.leave(0.9)
    left.hold(right.clock - opened, press.leaf, press.body)
    swing(left, press, -88.0, 1.4)
    left.hold(0.5, press.leaf, press.body)
    right.rest(left.clock - right.clock)


def door_shut_in_two_pushes_with_a_rest_between(s: Stage) -> None:
    """A door is pressed half shut, let go of, and after a rest pressed shut with the same palm."""
    at_table(s, height=0.76, yaw_deg=-152, size=1.04)
    press = cupboard(s, (0.72, 0.0, s.height + 0.012), side="left", width=0.36)
    press.hinge.opened(press.leaf, 60.0)
    left = s.left(idle=0.2)
    seize(left, press.leaf, press.face, 1.0, hold=0.3)
    swing(left, press, -28.0, 0.8)
    left.hold(0.3, press.leaf, press.body)
    left.leave(0.8)
    left.rest(0.7)
    seize(left, press.leaf, press.face, 0.9)
    swing(left, press, -32.0, 0.8)
    left.hold(0.5, press.leaf, press.body)
    home_again(left, 0.9)


def beside_a_door_that_another_hand_opens(s: Stage) -> None:
    """The right hand opens a door; the left hand rests in the air near its path all the while."""
    at_table(s, height=0.73, yaw_deg=8)
    press = cupboard(s, (0.72, -0.15, s.height + 0.012), side="right")
    right = s.right(narrow())
    left = s.left(home=(0.6, 0.12, s.height + 0.2))
    right.idle(0.2)
    seize(right, press.leaf, press.grip, 1.0, hold=0.3)
    swing(right, press, 60.0, 1.2)
    right.hold(0.6, press.leaf, press.body)
    left.rest(right.clock)


def tin_pushed_up_to_a_shut_door(s: Stage) -> None:
    """A tin is pushed over the table until it meets a shut door, which does not move."""
    at_table(s, height=0.75, yaw_deg=-38)
    press = cupboard(s, (0.8, 0.0, s.height), side="right", width=0.4)
    tin = s.put("tin", shapes.box(0.12, 0.16, 0.14, "tin"), (0.5, -0.05))
    right = s.right(idle=0.2)
    right.reach(tin, "-x", 0.9, fingers=(0.0, 0.0, 1.0), hold=0.4)
    right.take(tin)
    front = 0.8 - 0.0157
    travel(right, "Push", (front - 0.56, 0.0, 0.0), 1.1, tin, press.leaf, hold=0.6)
    home_again(right, 0.9)


def round_a_corner(hand: Hand, thing: Thing, radius: float, duration: float) -> None:
    """Carry along a level quarter circle that sets out ahead and ends towards the left [m]."""

    def law(since: np.ndarray) -> np.ndarray:
        angle = np.pi / 2.0 * min_jerk(since / duration)
        return radius * np.stack([np.sin(angle), 1.0 - np.cos(angle), 0.0 * angle], axis=1)

    hand.body.shift(hand.clock, hand.clock + duration, law)
    hand.clock += duration
    hand.step("Carry", thing)


def vase_down_from_a_high_shelf(s: Stage) -> None:
    """A vase is lifted off a high shelf, brought forward and let down to a low table, slowly."""
    table = at_table(s, height=0.5, yaw_deg=7, size=1.08, agent="tall_man")
    shelf(s, (0.78, -0.1, 1.25), size=(0.3, 0.6))
    vase = jar(s, (0.72, -0.1, 1.25), "vase", 0.2)
    right = s.right(home=(0.2, -0.42, 1.3), idle=0.2)
    fetch(right, vase, "-y", 1.2, 0.5, 0.6)
    travel(right, "Lift", (0.0, 0.0, 0.08), 0.7, vase, hold=0.5)
    travel(right, "Carry", (-0.25, -0.05, 0.0), 1.1, vase, hold=0.5)
    travel(right, "Lower", (0.0, 0.0, -0.83), 2.2, vase, table)
    finish(right, vase, table, 0.5, 1.3)


def box_up_from_the_floor(s: Stage) -> None:
    """Both hands lift a box off the floor, bring it over a low table, set it down and stay."""
    performer(s, height=0.45, yaw_deg=-122, size=1.02)
    floor(s)
    table = s.put("low_table", shapes.box(0.5, 0.6, 0.45, "table"), (0.62, 0.7, 0.0), tag="fixed")
    box = tin_box(s, (0.45, -0.25, 0.0), "box", (0.24, 0.28, 0.22))
    hands = both_reach(s, box, 1.4, 0.7, 0.4)
    right, left = hands
    since = len(right.steps)
    left.join(box)
    right.take(box)
    paused(
        right,
        box,
        table,
        up=0.6,
        by=(0.17, 0.95),
        down=0.15,
        holds=(0.4, 0.0),
        times=(1.3, 1.6, 0.8),
    )
    right.hold(0.7, box, table)
    left.part(right, since)


def tin_round_a_corner(s: Stage) -> None:
    """A tin is lifted, held, carried round a quarter circle on the level, held, and set down."""
    table = at_table(s, height=0.71, yaw_deg=48)
    tin = tin_box(s, (0.45, -0.35), "tin", (0.07, 0.07, 0.13))
    right = s.right(idle=0.2)
    fetch(right, tin, "+z", 0.9, 1.0, 0.3)
    travel(right, "Lift", (0.0, 0.0, 0.16), 0.7, tin, hold=0.4)
    round_a_corner(right, tin, 0.32, 1.4)
    right.hold(0.4, tin)
    travel(right, "Lower", (0.0, 0.0, -0.16), 0.8, tin, table)
    finish(right, tin, table, 0.3, 1.0)


def bottle_up_and_down_in_the_air(s: Stage) -> None:
    """A bottle that is held in the air is raised, held for a second, lowered by half, and kept."""
    at_table(s, height=0.77, yaw_deg=-18, size=0.97)
    flask = s.put("bottle", shapes.bottle(0.035, 0.22), (0.5, 0.12, s.height + 0.15))
    left = s.left()
    left.begin_at(flask, "+y", up=0.35, fingers=AHEAD)
    left.take(flask)
    left.hold(0.6, flask)
    travel(left, "Raise", (0.0, 0.0, 0.32), 1.1, flask, hold=1.0)
    travel(left, "Lower", (0.0, 0.0, -0.16), 0.8, flask, hold=0.7)


def glass_moved_low_from_stool_to_stool(s: Stage) -> None:
    """A glass goes from one stool to another, ten centimetres over both, fast."""
    performer(s, height=0.6, yaw_deg=133)
    pillar(s, "near_stool", (0.45, -0.4, 0.55), (0.34, 0.34), "stool")
    far = pillar(s, "far_stool", (0.6, 0.3, 0.55), (0.34, 0.34), "stool")
    ware = glass(s, (0.45, -0.4, 0.55))
    right = s.right(idle=0.15)
    fetch(right, ware, "-y", 0.8, 0.65, 0.0)
    right.lift_carry_lower(ware, far, up=0.1, by=(0.15, 0.7), down=0.1, times=(0.55, 1.3, 0.55))
    home_again(right, 0.9)


def jar_held_and_stood_on_a_stool_and_taken_again(s: Stage) -> None:
    """A jar that hangs in the air is stood on a stool, rests in the hand, and is lifted again."""
    performer(s, height=0.7, yaw_deg=-45, size=1.04)
    stool = pillar(s, "stool", (0.48, 0.2, 0.5), (0.36, 0.36), "stool")
    tin = jar(s, (0.48, 0.2, 0.78), height=0.17)
    left = s.left()
    left.begin_at(tin, "+y", up=0.6, fingers=AHEAD)
    left.take(tin)
    left.hold(0.5, tin)
    travel(left, "Lower", (0.0, 0.0, -0.28), 1.0, tin, stool, hold=1.2)
    travel(left, "Lift", (0.0, 0.0, 0.22), 0.9, tin, hold=0.6)


def block_from_the_floor_by_a_child(s: Stage) -> None:
    """A child quickly takes a block from the floor and puts it on a low bench."""
    performer(s, height=0.32, yaw_deg=92, size=0.76, agent="child", offset=(-0.7, 1.1))
    floor(s)
    bench = pillar(s, "bench", (0.45, -0.2, 0.3), (0.3, 0.3), "bench")
    cube = s.put("block", shapes.box(0.055, 0.055, 0.055, "block"), (0.4, 0.25, 0.0))
    left = s.left(claw(), idle=0.1)
    fetch(left, cube, "+z", 0.7, 1.0, 0.0)
    left.lift_carry_lower(cube, bench, up=0.42, by=(0.05, -0.45), down=0.12, times=(0.7, 0.8, 0.5))
    finish(left, cube, bench, 0.3, 0.8)


def tin_up_a_step(s: Stage) -> None:
    """A tin goes up from the table onto a step in one motion that hardly sinks at its end."""
    at_table(s, height=0.74, yaw_deg=-150)
    step = s.put("step", shapes.box(0.3, 0.4, 0.15, "step"), (0.6, 0.2, s.height), tag="fixed")
    tin = tin_box(s, (0.5, -0.3), "tin", (0.06, 0.06, 0.14))
    right = s.right(idle=0.2)
    fetch(right, tin, "+z", 0.9, 1.0, 0.4)
    right.over(0.18, (0.08, 0.45), 0.03, times=(0.8, 1.0, 0.5), overlap=0.2)
    right.step("MoveObjTo", tin, step)
    finish(right, tin, step, 0.4, 1.0)
    right.alternative = other_names(right, MoveObjTo="PutDown")


def jar_carried_in_three_legs_with_a_long_stop(s: Stage) -> None:
    """A jar is carried in three legs on the level, with stops of half a second and five seconds."""
    table = at_table(s, height=0.65, yaw_deg=24, size=0.92, agent="old_woman")
    tin = jar(s, (0.45, -0.35))
    right = s.right(idle=0.2)
    fetch(right, tin, "-y", 1.3, 0.6, 0.8)
    travel(right, "Lift", (0.0, 0.0, 0.2), 1.1, tin, hold=0.5)
    for by, rest in (((0.2, 0.1), 0.5), ((0.0, 0.3), 5.0), ((-0.15, 0.1), 0.6)):
        travel(right, "Carry", (*by, 0.0), 1.4, tin)
        right.hold(rest, tin)
    travel(right, "Lower", (0.0, 0.0, -0.2), 1.2, tin, table)
    finish(right, tin, table, 0.4, 1.2)


def tin_swung_high_and_far(s: Stage) -> None:
    """The left hand swings a tin over a wall of books in a high arc, and fast."""
    table = at_table(s, height=0.82, yaw_deg=-77, size=1.07, agent="tall_man")
    s.put("books", shapes.box(0.24, 0.12, 0.22, "books"), (0.5, 0.0), tag="fixed")
    tin = tin_box(s, (0.5, 0.38), "tin", (0.07, 0.07, 0.12))
    left = s.left(idle=0.15)
    fetch(left, tin, "+z", 0.8, 1.0, 0.0)
    left.lift_carry_lower(tin, table, up=0.42, by=(0.0, -0.7), down=0.42, times=(0.75, 1.1, 0.8))
    left.hold(0.7, tin, table)


def box_lowered_to_the_floor(s: Stage) -> None:
    """Both hands hold a box in the air from the first frame and let it down to the floor."""
    performer(s, height=0.5, yaw_deg=159)
    ground = floor(s)
    box = tin_box(s, (0.45, 0.0, 0.55), "box", (0.26, 0.3, 0.2))
    right, left = s.right(), s.left()
    for hand, side in ((right, "-y"), (left, "+y")):
        hand.begin_at(box, side, up=0.6, fingers=AHEAD)
    left.join(box)
    right.take(box)
    right.hold(0.6, box)
    travel(right, "Lower", (0.0, 0.0, -0.55), 1.5, box, ground, hold=0.5)
    left.part(right, 0)
    both_leave([right, left], 0.9)


def jar_from_a_low_board_to_a_high_one(s: Stage) -> None:
    """A jar is lifted off a stool, carried over a shelf and lowered there, with two pauses."""
    performer(s, height=0.7, yaw_deg=-100, size=1.03)
    pillar(s, "stool", (0.5, -0.4, 0.6), (0.36, 0.36), "stool")
    board = shelf(s, (0.62, 0.2, 1.0), size=(0.36, 0.4))
    tin = jar(s, (0.5, -0.4, 0.6), height=0.18)
    right = s.right(idle=0.2)
    fetch(right, tin, "-y", 1.0, 0.6, 0.4)
    paused(
        right,
        tin,
        board,
        up=0.49,
        by=(0.1, 0.6),
        down=0.09,
        holds=(0.5, 0.5),
        times=(1.3, 1.3, 0.6),
    )
    finish(right, tin, board, 0.5, 1.2)


def crate_pushed_to_the_wall_by_both(s: Stage) -> None:
    """Both palms push a wide crate away until it meets the wall, and stay on it."""
    at_table(s, height=0.79, yaw_deg=22, size=1.05)
    behind = wall(s, 1.0)
    box = s.put("crate", forms.open_box(0.24, 0.5, 0.16, "crate"), (0.56, 0.0))
    hands = [s.right(), s.left()]
    for hand, aside in zip(hands, (-0.14, 0.14), strict=True):
        hand.idle(0.2)
        hand.reach(box, "-x", 0.9, fingers=UP, aside=(0.0, aside, 0.0), hold=0.5)
    right, left = hands
    since = len(right.steps)
    left.join(box)
    right.take(box)
    travel(right, "Push", (0.3202, 0.0, 0.0), 1.5, box, behind, hold=0.8)
    left.part(right, since)


def tin_pushed_sideways_to_a_partition(s: Stage) -> None:
    """The left palm pushes a tin to the right until it meets a low partition, and goes home."""
    at_table(s, height=0.7, yaw_deg=-99)
    board = s.put("partition", shapes.box(0.4, 0.02, 0.1, "partition"), (0.55, -0.25), tag="fixed")
    tin = tin_box(s, (0.52, 0.15), "tin", (0.12, 0.1, 0.13))
    left = s.left(idle=0.2)
    left.reach(tin, "+y", 0.9, up=0.55, hold=0.3)
    left.take(tin)
    travel(left, "Push", (0.0, -0.3402, 0.0), 1.2, tin, board, hold=0.4)
    home_again(left, 0.9)


def box_pushed_slowly_until_it_meets_a_pot(s: Stage) -> None:
    """A box is pushed slowly over the table until it touches a pot, which stays in its place."""
    at_table(s, height=0.83, yaw_deg=147, size=0.96, agent="old_man")
    pot = s.put("pot", forms.pot(0.12, 0.16), (0.88, -0.05))
    box = tin_box(s, (0.5, -0.05), "box", (0.14, 0.18, 0.15))
    right = s.right(idle=0.2)
    right.reach(box, "-x", 1.2, fingers=UP)
    right.take(box)
    travel(right, "Push", (0.88 - 0.12 - 0.07 - 0.5 + 0.0003, 0.0, 0.0), 2.6, box, pot, hold=0.8)
    home_again(right, 1.2)


def chair_pulled_over_the_floor(s: Stage) -> None:
    """Both hands take the uprights of a chair's back and draw it near over the floor."""
    performer(s, height=0.8, yaw_deg=-43, size=1.02)
    ground = floor(s)
    seat = [shapes.block((0.02, -0.2, 0.4), (0.4, 0.2, 0.44))]
    legs = [
        shapes.block((x, y, 0.0), (x + 0.04, y + 0.04, 0.4))
        for x in (0.02, 0.36)
        for y in (-0.2, 0.16)
    ]
    back = [shapes.block((0.0, y - 0.004, 0.42), (0.06, y + 0.004, 0.95)) for y in (-0.15, 0.15)]
    rail = [shapes.block((0.03, -0.2, 0.5), (0.05, 0.2, 0.62))]
    chair = s.put("chair", shapes.Form("chair", (*seat, *legs, *back, *rail)), (0.55, 0.0, 0.0))
    hands = [s.right(narrow()), s.left(narrow())]
    for hand, y in zip(hands, (-0.15, 0.15), strict=True):
        hand.idle(0.2)
        seize(hand, chair, Grip((0.0, y, 0.8), NEAR, RIGHTWARD), 0.9, hold=0.4, take=False)
    right, left = hands
    since = len(right.steps)
    left.join(chair)
    right.take(chair)
    travel(right, "Pull", (-0.25, 0.0, 0.0), 1.3, chair, ground, hold=0.5)
    left.part(right, since)
    both_leave(hands, 0.9)


def pot_with_a_lid_turned(s: Stage) -> None:
    """The right palm on a pot's side turns it by fifty degrees; its lid turns along."""
    table = at_table(s, height=0.76, yaw_deg=85)
    pot = s.put("pot", forms.pot(0.1, 0.14), (0.52, -0.05))
    lid = s.put("lid", forms.round_lid(0.103), (0.52, -0.05, s.height + 0.14))
    right = s.right(idle=0.2)
    right.reach(pot, "-y", 0.9, up=0.5, hold=0.4)
    right.take(pot, lid)
    right.spin((0.52, -0.05, 0.0), UP, 50.0, 1.4)
    right.step("Turn", pot, table)
    right.hold(0.6, pot, table)


def plate_slid_in_two_goes(s: Stage) -> None:
    """A palm slides a plate to the left, stops for a second, and slides it ahead."""
    table = at_table(s, height=0.87, yaw_deg=-167, size=1.07, agent="tall_man")
    plate = s.put("plate", shapes.Form("plate", (shapes.disc(0.12, 0.0, 0.025),)), (0.5, -0.2))
    right = s.right(idle=0.2)
    right.reach(plate, "+z", 0.9, up=1.0, hold=0.3)
    right.take(plate)
    travel(right, "Slide", (0.02, 0.28, 0.0), 1.0, plate, table, hold=1.0)
    travel(right, "Slide", (0.24, 0.0, 0.0), 0.9, plate, table, hold=0.4)
    home_again(right, 0.9)


def tray_pulled_off_the_wall_and_pushed_back(s: Stage) -> None:
    """A tray is drawn away from the wall by its handle, held, and pushed back until it meets it."""
    table = at_table(s, height=0.72, yaw_deg=38, size=0.98)
    behind = wall(s, 0.98)
    parts = forms.open_box(0.26, 0.3, 0.1, "tray").parts
    handle = shapes.block((-0.13 - forms.HANDLE_M, -0.004, 0.02), (-0.13, 0.004, 0.09))
    tray = s.put("tray", shapes.Form("tray", (*parts, handle)), (0.85 - 0.0002, 0.08))
    left = s.left(narrow(), idle=0.2)
    grip = Grip((-0.13 - forms.HANDLE_M, 0.0, 0.06), NEAR, RIGHTWARD)
    seize(left, tray, grip, 1.0, hold=0.4)
    travel(left, "Pull", (-0.24, 0.0, 0.0), 1.0, tray, table, hold=0.8)
    travel(left, "Push", (0.2402, 0.0, 0.0), 1.1, tray, behind, hold=0.6)


def bucket_pushed_over_the_floor_at_once(s: Stage) -> None:
    """A palm meets a bucket on the floor and pushes it ahead at once; a jar rides in it."""
    performer(s, height=0.4, yaw_deg=109, size=1.04)
    ground = floor(s)
    pail = s.put("bucket", forms.open_box(0.24, 0.24, 0.34, "bucket"), (0.5, -0.1, 0.0))
    tin = builders.jar(s, (0.52, -0.08, 0.008), height=0.2)
    right = s.right(idle=0.15)
    right.reach(pail, "-x", 0.8, up=0.75, fingers=UP)
    right.take(pail, tin)
    travel(right, "Push", (0.4, 0.0, 0.0), 1.0, pail, ground, hold=0.6)
    home_again(right, 0.9)


def tube_rolled_near(s: Stage) -> None:
    """A tube that lies across the table rolls near under the left palm, which goes twice as far."""
    performer(s, height=0.73, yaw_deg=-146, size=1.02)
    radius, far, duration = 0.065, 0.09, 1.0
    table = s.table()
    lying = shapes.disc(radius, -0.12, 0.12, 96).copy()
    lying.apply_transform([[1, 0, 0, 0], [0, 0, 1, 0], [0, -1, 0, 0], [0, 0, 0, 1]])
    tube = s.put("tube", shapes.Form("tube", (lying,)), (0.65, 0.15, s.height + radius))
    left = s.left(idle=0.2)
    left.reach(tube, "+z", 0.9, up=1.0, along=-0.05, hold=0.4)
    base, start = tube.body.at(left.clock), left.clock

    def rolled(since: np.ndarray) -> np.ndarray:
        way = -far * min_jerk(since / duration)
        out = about(base[:3, 3], (0.0, 1.0, 0.0), way / radius) @ base
        out[:, 0, 3] += way
        return out

    tube.body.play(start, start + duration, rolled)
    tube.free.append((start, start + duration))
    travel(left, "Roll", (-2.0 * far, 0.0, 0.0), duration, tube, table, hold=0.7)


def hand_goes_along_above_a_box_that_the_other_pulls(s: Stage) -> None:
    """The left hand pulls a box near; the right hand goes along over it and never touches it."""
    table = at_table(s, height=0.77, yaw_deg=-14)
    box = s.put("box", shapes.drawer_box(0.16, 0.24, 0.14), (0.82, 0.05))
    left, right = s.left(narrow()), s.right(home=(0.72, -0.05, s.height + 0.26))
    left.idle(0.2)
    seize(left, box, Grip((-0.08 - 0.06, 0.0, 0.084), NEAR, RIGHTWARD), 0.9, hold=0.4)
    right.rest(left.clock)
    travel(left, "Pull", (-0.26, 0.0, 0.0), 1.2, box, table)
    right.go((0.46, -0.05, s.height + 0.26), 1.2)
    left.hold(0.6, box, table)
    right.rest(left.clock - right.clock)


def over_an_open_drawer_and_back(s: Stage) -> None:
    """The hand goes over a drawer that stands open with a plum in it, rests, and goes home."""
    at_table(s, height=0.66, yaw_deg=27)
    (rail,) = dresser(s, (0.72, 0.1, s.height + 0.012), heights=(0.12,))
    rail.part.body.first[0, 3] -= 0.22
    plum(s, (0.6, 0.1, s.height + 0.012 - 0.0003 + 0.008))
    left = s.left(idle=0.2)
    left.go((0.5, 0.1, s.height + 0.3), 1.0)
    left.rest(0.9)
    left.go(None, 1.0)
    left.idle(0.2)


def into_a_sideboard_and_out(s: Stage) -> None:
    """The hand goes into a sideboard's open half, rests there for a second, and comes out."""
    at_table(s, height=0.58, yaw_deg=-117, size=0.95)
    sliding_cupboard(s, (0.66, 0.0, s.height + 0.05), way=-1.0, width=0.7, height=0.36)
    right = s.right(home=(0.3, -0.17, s.height + 0.22), idle=0.2)
    right.go((0.72, -0.17, s.height + 0.22), 0.9)
    right.rest(1.0)
    right.go(None, 0.9)
    right.idle(0.2)


def between_two_buckets(s: Stage) -> None:
    """The hand passes between two buckets without a halt and touches neither."""
    at_table(s, height=0.7, yaw_deg=64)
    builders.bucket(s, (0.6, 0.2), name="left_bucket")
    builders.bucket(s, (0.6, -0.2), name="right_bucket")
    right = s.right(home=(0.2, 0.0, s.height + 0.12), idle=0.2)
    right.go((0.78, 0.0, s.height + 0.12), 1.4)
    right.idle(0.2)


def lean_on_a_counter_and_fetch(s: Stage) -> None:
    """The left hand leans on the table's edge while the right hand moves a plum into a basin."""
    table = at_table(s, height=0.9, yaw_deg=-48, size=1.07, agent="tall_man")
    dish = builders.basin(s, (0.62, 0.1), radius=0.14)
    fruit = plum(s, (0.48, -0.3))
    left, right = s.left(), s.right(claw())
    left.idle(0.2)
    left.reach(table, "+z", 0.8, up=1.0, aside=(-0.22, 0.38, 0.0))
    right.rest(0.5)
    fetch(right, fruit, "+z", 0.9, 1.0, 0.3)
    right.lift_carry_lower(fruit, dish, up=0.22, by=(0.14, 0.4), down=0.214)
    finish(right, fruit, dish, 0.3, 1.1)
    left.hold(right.clock - left.clock, table)


def hand_on_a_stool_throughout(s: Stage) -> None:
    """The left hand lies on a stool from the first frame to the last; the right hand rests."""
    performer(s, height=0.45, yaw_deg=138, size=0.78, agent="child")
    stool = pillar(s, "stool", (0.35, 0.2, 0.42), (0.3, 0.3), "stool")
    left, right = s.left(), s.right()
    left.begin_at(stool, "+z", up=1.0, fingers=AHEAD)
    left.hold(2.4, stool)
    right.rest(2.4)


def palm_on_a_rack_and_on_a_wall(s: Stage) -> None:
    """The palm lies on a rack's side for a second, goes home, rests, and lies on the wall."""
    performer(s, height=0.76, yaw_deg=-22)
    behind = wall(s, 0.95)
    rack = s.put(
        "rack", builders.open_shelves(0.24, 0.4, (0.3, 0.7, 1.1)), (0.55, 0.35, 0.0), tag="fixed"
    )
    right = s.right(idle=0.2)
    right.reach(rack, "-y", 1.0, up=0.75, hold=1.0)
    right.leave(1.0)
    right.rest(0.7)
    right.reach(behind, "-x", 1.0, up=0.6, fingers=UP, aside=(0.0, -0.25, 0.0), hold=0.8)
    home_again(right, 1.0)


def dresser_touched_and_then_its_drawer(s: Stage) -> None:
    """The left palm lies on a dresser, and after a rest on the front of its shut lower drawer."""
    at_table(s, height=0.62, yaw_deg=90, size=1.02)
    low, _ = dresser(s, (0.64, 0.1, s.height + 0.012), heights=(0.18, 0.1), width=0.5)
    left = s.left(idle=0.2)
    left.reach(low.body, "+z", 1.1, up=1.0, aside=(-0.06, 0.0, 0.0), hold=0.7)
    left.leave(1.0)
    left.rest(0.6)
    front = Grip((0.0, 0.15, 0.09), NEAR, RIGHTWARD)
    seize(left, low.part, front, 1.0, hold=1.1, take=False)
    home_again(left, 0.9)


def oven_touched_and_hand_drawn_back(s: Stage) -> None:
    """The right palm lies on an oven's shut door for half a second and withdraws to a new place."""
    performer(s, height=0.75, yaw_deg=-7, size=1.06)
    pillar(s, "plinth", (0.94, 0.0, 0.45), (0.5, 0.5), "plinth")
    stove = oven(s, (0.72, -0.1, 0.462))
    right = s.right(idle=0.2)
    seize(right, stove.leaf, stove.face, 1.1, hold=0.5, take=False)
    right.leave(0.9, to=(0.35, 0.1, s.height + 0.35), name="Withdraw")
    right.idle(0.2)


def plum_over_a_basin_and_back(s: Stage) -> None:
    """A plum is held above a basin for two seconds, carried back and put where it was."""
    table = at_table(s, height=0.8, yaw_deg=-134, size=0.97)
    builders.basin(s, (0.62, 0.15))
    fruit = plum(s, (0.5, -0.3))
    right = s.right(claw(), idle=0.2)
    fetch(right, fruit, "+z", 0.9, 1.0, 0.3)
    travel(right, "Lift", (0.0, 0.0, 0.24), 0.8, fruit, hold=0.4)
    travel(right, "Carry", (0.12, 0.45, 0.0), 1.1, fruit, hold=2.0)
    travel(right, "Carry", (-0.12, -0.45, 0.0), 1.1, fruit, hold=0.4)
    travel(right, "Lower", (0.0, 0.0, -0.24), 0.8, fruit, table)
    finish(right, fruit, table, 0.3, 0.9)


def pot_kept_in_the_air_over_the_hob(s: Stage) -> None:
    """Both hands hold a pan still in the air over a hob from the first frame to the last."""
    performer(s, height=0.7, yaw_deg=31, size=1.01)
    pillar(s, "hob", (0.52, 0.0, 0.8), (0.44, 0.44), "hob")
    pan = s.put("pan", builders.stewpan(), (0.52, 0.0, 0.98))
    right, left = s.right(), s.left()
    for hand, side in ((right, "-y"), (left, "+y")):
        hand.begin_at(pan, side, up=0.88, fingers=AHEAD)
    left.join(pan)
    right.take(pan)
    right.hold(2.6, pan)
    left.part(right, 0)


def above_a_box_that_the_other_hand_lifts(s: Stage) -> None:
    """The right hand lifts a box by its side; the left hand rests far over it in the air."""
    table = at_table(s, height=0.6, yaw_deg=-62)
    box = s.put("box", forms.open_box(0.14, 0.14, 0.16, "box"), (0.5, -0.05))
    right, left = s.right(), s.left(home=(0.5, 0.02, s.height + 0.48))
    right.idle(0.2)
    fetch(right, box, "-y", 0.9, 0.6, 0.4)
    paused(right, box, table, up=0.15, by=(0.2, -0.2), down=0.15, holds=(0.6, 0.4))
    finish(right, box, table, 0.4, 0.9)
    left.rest(right.clock)


def shelf_felt_from_below_and_above(s: Stage) -> None:
    """The left palm lies under a shelf, and after a rest before it on top of it."""
    performer(s, height=0.65, yaw_deg=177, size=1.03)
    board = shelf(s, (0.6, 0.15, 1.05), size=(0.36, 0.5))
    left = s.left(home=(0.1, 0.3, 1.05), idle=0.2)
    left.reach(board, "-z", 1.0, up=0.0, hold=0.6)
    left.leave(1.0)
    left.rest(0.8)
    left.reach(board, "+z", 1.2, up=1.0, hold=0.9)
