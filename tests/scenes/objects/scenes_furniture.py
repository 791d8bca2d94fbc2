"""Drawers, doors and shelves; objects on surfaces and furniture that is only touched."""

from scenes.hands import shapes
from scenes.hands.paths import LEFTWARD, NEAR, RIGHTWARD, UP
from scenes.hands.performer import Hand, travel
from scenes.hands.scene import at_table, performer
from scenes.hands.scenes_place import claw, cup, fetch, finish
from scenes.hands.scenes_two_hands import both_leave
from scenes.hands.stage import Stage, other_names
from scenes.hands.things import Thing
from scenes.objects import forms
from scenes.objects.builders import (
    SINK,
    Cabinet,
    Cupboard,
    Grip,
    apple,
    cabinet,
    can,
    crate,
    cupboard,
    floor,
    home_again,
    paused,
    pillar,
    seize,
    shelf,
    toy,
    wall,
)

FLOOR_M = 0.008 - SINK
"""Height of a drawer's inner floor over the cabinet's [m]."""


def grip_hand() -> shapes.Form:
    """A hand bent around a handle."""
    return shapes.gripping_hand(0.04, 0.04)


def pull(hand: Hand, chest: Cabinet, far: float, duration: float) -> None:
    """Open a drawer further by a length [m]."""
    travel(hand, "Open", (-far, 0.0, 0.0), duration, chest.drawer, chest.body)


def push(hand: Hand, chest: Cabinet, far: float, duration: float) -> None:
    """Shut a drawer by a length [m]."""
    travel(hand, "Close", (far, 0.0, 0.0), duration, chest.drawer, chest.body)


def in_drawer(s: Stage, chest: Cabinet, back: float, name: str = "apple") -> Thing:
    """An apple in a drawer, so far behind its front [m]."""
    place = chest.drawer.body.first[:3, 3]
    return apple(s, (place[0] + back, place[1], place[2] + 0.008), name, 0.03)


def drawer_pulled_open(s: Stage) -> None:
    """A drawer that is shut is pulled open by its handle and let go of."""
    at_table(s, height=0.76, yaw_deg=15)
    chest = cabinet(s, (0.62, -0.1, s.height + 0.012))
    right = s.right(grip_hand(), idle=0.2)
    seize(right, chest.drawer, chest.grip, 0.9, hold=0.4)
    pull(right, chest, 0.2, 1.0)
    right.hold(0.5, chest.drawer, chest.body)
    home_again(right, 0.8)


def drawer_pushed_shut(s: Stage) -> None:
    """A drawer that stands open is pushed shut, and the hand stays on its handle."""
    at_table(s, height=0.9, yaw_deg=-110, size=1.06, agent="tall_man")
    chest = cabinet(s, (0.65, 0.1, s.height + 0.012), out=0.22)
    left = s.left(grip_hand(), idle=0.2)
    seize(left, chest.drawer, chest.grip, 0.8, hold=0.3)
    push(left, chest, 0.22, 0.9)
    left.hold(0.8, chest.drawer, chest.body)


def drawer_open_and_shut(s: Stage) -> None:
    """A drawer is pulled open, held for a second and pushed shut in one contact."""
    at_table(s, yaw_deg=70)
    chest = cabinet(s, (0.64, -0.05, s.height + 0.012))
    right = s.right(grip_hand(), idle=0.2)
    seize(right, chest.drawer, chest.grip, 0.9, hold=0.3)
    pull(right, chest, 0.24, 1.1)
    right.hold(1.0, chest.drawer, chest.body)
    push(right, chest, 0.24, 1.0)
    right.hold(0.4, chest.drawer, chest.body)
    home_again(right, 0.8)


def loaded_drawer_pulled_open(s: Stage) -> None:
    """Two apples ride in a drawer that is pulled open very slowly."""
    at_table(s, height=0.7, yaw_deg=-35, size=0.95, agent="old_man")
    chest = cabinet(s, (0.64, -0.1, s.height + 0.012))
    fruits = [in_drawer(s, chest, 0.08, "red_apple"), in_drawer(s, chest, 0.18, "green_apple")]
    right = s.right(grip_hand(), idle=0.2)
    seize(right, chest.drawer, chest.grip, 1.4, hold=0.8)
    right.take_along(chest.drawer, *fruits)
    pull(right, chest, 0.22, 3.5)
    right.hold(1.2, chest.drawer, chest.body)
    home_again(right, 1.3)


def loaded_drawer_pushed_shut(s: Stage) -> None:
    """A drawer with an apple in it is pushed shut quickly, at once on contact."""
    at_table(s, height=0.82, yaw_deg=240)
    chest = cabinet(s, (0.66, -0.1, s.height + 0.012), out=0.25)
    fruit = in_drawer(s, chest, 0.12)
    right = s.right(grip_hand(), idle=0.15)
    seize(right, chest.drawer, chest.grip, 0.7)
    right.take_along(chest.drawer, fruit)
    push(right, chest, 0.25, 0.5)
    right.hold(0.5, chest.drawer, chest.body)
    home_again(right, 0.8)


def drawer_in_two_pulls(s: Stage) -> None:
    """A drawer is pulled half open, held, and pulled on; the hand stays on it."""
    at_table(s, yaw_deg=125, offset=(0.3, -2.0))
    chest = cabinet(s, (0.66, 0.15, s.height + 0.012))
    left = s.left(grip_hand(), idle=0.2)
    seize(left, chest.drawer, chest.grip, 0.9, hold=0.4)
    for far in (0.11, 0.13):
        pull(left, chest, far, 0.8)
        left.hold(0.6, chest.drawer, chest.body)


def apple_out_of_a_drawer(s: Stage) -> None:
    """The right hand opens a drawer and holds it; the left hand takes an apple out of it."""
    table = at_table(s, yaw_deg=-160)
    chest = cabinet(s, (0.72, -0.05, s.height + 0.012))
    fruit = in_drawer(s, chest, 0.12)
    right, left = s.right(grip_hand()), s.left(claw())
    right.idle(0.2)
    seize(right, chest.drawer, chest.grip, 0.9, hold=0.3)
    right.take_along(chest.drawer, fruit)
    pull(right, chest, 0.24, 1.0)
    right.release()
    left.rest(right.clock)
    left.reach(fruit, "+z", 1.0, up=1.0, fingers=LEFTWARD, hold=0.4)
    left.take(fruit)
    left.lift_carry_lower(fruit, table, up=0.18, by=(0.0, 0.4), down=0.2 - SINK)
    left.hold(0.3, fruit, table)
    home_again(left, 1.0)
    right.hold(left.clock - right.clock, chest.drawer, chest.body)


def apple_into_a_drawer(s: Stage) -> None:
    """An apple is put into an open drawer, and after a rest the same hand pushes it shut."""
    at_table(s, height=0.72, yaw_deg=50)
    chest = cabinet(s, (0.74, 0.15, s.height + 0.012), out=0.24)
    fruit = apple(s, (0.5, -0.35))
    right = s.right(claw(), idle=0.2)
    right.reach(fruit, "+z", 0.9, up=1.0, fingers=LEFTWARD, hold=0.3)
    right.take(fruit)
    down = 0.22 - 0.012 - FLOOR_M
    paused(right, fruit, chest.drawer, up=0.22, by=(0.12, 0.5), down=down, holds=(0.0, 0.4))
    right.hold(0.3, fruit, chest.drawer)
    right.leave(1.0)
    right.rest(0.8)
    seize(right, chest.drawer, chest.grip, 1.0, hold=0.3)
    right.take_along(chest.drawer, fruit)
    push(right, chest, 0.24, 1.0)
    right.hold(0.4, chest.drawer, chest.body)
    home_again(right, 0.9)


def drawer_ajar_pulled_further(s: Stage) -> None:
    """A drawer that is never seen shut is pulled further out."""
    at_table(s, height=0.85, yaw_deg=-10)
    chest = cabinet(s, (0.68, -0.1, s.height + 0.012), out=0.06)
    right = s.right(grip_hand(), idle=0.2)
    seize(right, chest.drawer, chest.grip, 0.9, hold=0.4)
    travel(right, "Pull", (-0.18, 0.0, 0.0), 0.9, chest.drawer, chest.body, hold=0.5)
    home_again(right, 0.8)
    right.alternative = other_names(right, Pull="Open")


def drawer_half_shut_and_shut(s: Stage) -> None:
    """A drawer is pushed half way, let go of, and after a rest pushed shut."""
    at_table(s, yaw_deg=165, size=1.04)
    chest = cabinet(s, (0.68, 0.1, s.height + 0.012), out=0.24)
    left = s.left(grip_hand(), idle=0.2)
    seize(left, chest.drawer, chest.grip, 0.9, hold=0.3)
    push(left, chest, 0.12, 0.7)
    left.hold(0.3, chest.drawer, chest.body)
    left.leave(0.8)
    left.rest(1.0)
    seize(left, chest.drawer, chest.grip, 0.9)
    push(left, chest, 0.12, 0.7)
    left.hold(0.6, chest.drawer, chest.body)


def drawer_handle_only_touched(s: Stage) -> None:
    """The handle of a shut drawer is held for a while, and nothing moves."""
    at_table(s, yaw_deg=-75)
    chest = cabinet(s, (0.66, -0.1, s.height + 0.012))
    right = s.right(grip_hand(), idle=0.2)
    seize(right, chest.drawer, chest.grip, 1.0, hold=1.5, take=False)
    home_again(right, 0.9)


def swing(hand: Hand, press: Cupboard, angle_deg: float, duration: float) -> None:
    """Open a door by an angle, or shut it by a negative one."""
    press.hinge.turn(hand, angle_deg, duration)
    hand.step("Open" if angle_deg > 0 else "Close", press.leaf, press.body)


def door_opened(s: Stage) -> None:
    """A cupboard's door is opened by its handle and let go of."""
    at_table(s, yaw_deg=35)
    press = cupboard(s, (0.7, -0.1, s.height + 0.012), side="right")
    right = s.right(grip_hand(), idle=0.2)
    seize(right, press.leaf, press.grip, 1.0, hold=0.4)
    swing(right, press, 70.0, 1.3)
    right.hold(0.4, press.leaf, press.body)
    home_again(right, 0.9)


def door_shut(s: Stage) -> None:
    """A door that stands open is shut; the hand stays on its handle."""
    at_table(s, height=0.85, yaw_deg=-145, size=1.05)
    press = cupboard(s, (0.72, -0.1, s.height + 0.012), side="right")
    press.hinge.opened(press.leaf, 60.0)
    right = s.right(grip_hand(), idle=0.2)
    seize(right, press.leaf, press.grip, 1.0, hold=0.3)
    swing(right, press, -60.0, 1.1)
    right.hold(0.7, press.leaf, press.body)


def door_opened_with_the_left_hand(s: Stage) -> None:
    """A door with its hinge on the left is opened quickly, at once on contact."""
    at_table(s, height=0.66, yaw_deg=85, size=0.92, agent="boy")
    press = cupboard(s, (0.66, 0.1, s.height + 0.012), side="left", width=0.3)
    left = s.left(grip_hand(), idle=0.15)
    seize(left, press.leaf, press.grip, 0.8)
    swing(left, press, 80.0, 0.9)
    left.hold(0.5, press.leaf, press.body)
    home_again(left, 0.8)


def door_opened_in_two_stages(s: Stage) -> None:
    """A door is opened a little, held for a second, and opened further."""
    at_table(s, height=0.74, yaw_deg=200)
    press = cupboard(s, (0.7, -0.15, s.height + 0.012), side="right")
    right = s.right(grip_hand(), idle=0.2)
    seize(right, press.leaf, press.grip, 0.9, hold=0.3)
    swing(right, press, 35.0, 1.0)
    right.hold(1.0, press.leaf, press.body)
    swing(right, press, 40.0, 1.0)
    right.hold(0.5, press.leaf, press.body)


def door_opened_and_shut_later(s: Stage) -> None:
    """A door is opened and let go of; after a rest at home the same hand shuts it."""
    at_table(s, yaw_deg=-20)
    press = cupboard(s, (0.72, 0.1, s.height + 0.012), side="left")
    left = s.left(grip_hand(), idle=0.2)
    seize(left, press.leaf, press.grip, 1.0, hold=0.3)
    swing(left, press, 55.0, 1.2)
    left.hold(0.3, press.leaf, press.body)
    left.leave(0.9)
    left.rest(1.5)
    seize(left, press.leaf, press.grip, 1.0, hold=0.3)
    swing(left, press, -55.0, 1.1)
    left.hold(0.3, press.leaf, press.body)
    home_again(left, 0.9)


def door_opened_and_shut_at_once(s: Stage) -> None:
    """A door is opened, held for half a second and shut in one contact, slowly."""
    at_table(s, height=0.7, yaw_deg=110, size=0.96, agent="old_woman")
    press = cupboard(s, (0.7, -0.1, s.height + 0.012), side="right")
    right = s.right(grip_hand(), idle=0.2)
    seize(right, press.leaf, press.grip, 1.3, hold=0.6)
    swing(right, press, 45.0, 2.2)
    right.hold(0.5, press.leaf, press.body)
    swing(right, press, -45.0, 2.0)
    right.hold(0.8, press.leaf, press.body)
    home_again(right, 1.2)


def door_pushed_shut_with_the_palm(s: Stage) -> None:
    """A door that stands open is shut with the flat palm on its outer face."""
    at_table(s, yaw_deg=-60)
    press = cupboard(s, (0.72, 0.0, s.height + 0.012), side="right")
    press.hinge.opened(press.leaf, 50.0)
    right = s.right(idle=0.2)
    seize(right, press.leaf, press.face, 1.0)
    swing(right, press, -50.0, 1.0)
    right.hold(0.5, press.leaf, press.body)
    home_again(right, 0.9)


def mug_out_of_a_cupboard(s: Stage) -> None:
    """The right hand opens a door and holds it; the left hand takes a mug out to the table."""
    table = at_table(s, height=0.78, yaw_deg=15)
    press = cupboard(s, (0.68, 0.0, s.height + 0.012), side="right")
    mug = cup(s, (0.77, 0.02, s.height + 0.012))
    right, left = s.right(grip_hand()), s.left(claw())
    right.idle(0.2)
    seize(right, press.leaf, press.grip, 1.0, hold=0.3)
    swing(right, press, 90.0, 1.4)
    left.rest(right.clock)
    seize(left, mug, Grip((-0.042, 0.0, 0.06), (-1.0, 0.0, 0.0), LEFTWARD), 1.0, hold=0.4)
    paused(left, mug, table, up=0.1, by=(-0.3, 0.05), down=0.112, holds=(0.0, 0.3))
    left.hold(0.3, mug, table)
    home_again(left, 0.9)
    right.hold(left.clock - right.clock, press.leaf, press.body)


def door_only_touched(s: Stage) -> None:
    """A palm lies on a shut door for two seconds."""
    at_table(s, height=0.8, yaw_deg=175)
    press = cupboard(s, (0.7, 0.05, s.height + 0.012), side="left")
    left = s.left(idle=0.2)
    seize(left, press.leaf, press.face, 1.0, hold=2.0, take=False)
    home_again(left, 0.9)


def from_a_stool_to_the_table(s: Stage) -> None:
    """A block is taken from a stool and put on the table in one sweep."""
    table = at_table(s, yaw_deg=45)
    pillar(s, "stool", (0.4, -0.95, 0.5), (0.35, 0.35), "stool")
    cube = toy(s, (0.45, -0.95, 0.5))
    right = s.right(claw(), home=(0.12, -0.6, 0.86), idle=0.2)
    fetch(right, cube, "+z", 1.0, 1.0, 0.3)
    right.lift_carry_lower(cube, table, up=0.42, by=(0.05, 0.65), down=0.18, times=(1.0, 1.1, 0.8))
    finish(right, cube, table, 0.3, 1.2)


def from_the_table_to_a_stool(s: Stage) -> None:
    """The left hand takes a can from the table and stands it on a stool, pausing once."""
    at_table(s, height=0.7, yaw_deg=-130, size=0.95, width=1.0)
    stool = pillar(s, "stool", (0.45, 0.85, 0.52), (0.35, 0.35), "stool")
    tin = can(s, (0.45, 0.3))
    left = s.left(idle=0.2)
    fetch(left, tin, "+z", 0.9, 1.0, 0.0)
    paused(left, tin, stool, up=0.1, by=(0.0, 0.55), down=0.28, holds=(0.0, 0.6))
    finish(left, tin, stool, 0.4, 1.2)


def down_from_a_shelf(s: Stage) -> None:
    """A can is drawn over the edge of a shelf, hardly lifted, and brought down on the table."""
    table = at_table(s, height=0.74, yaw_deg=70, size=1.05)
    shelf(s, (0.75, -0.2, s.height + 0.3))
    tin = can(s, (0.65, -0.2, s.height + 0.3))
    right = s.right(idle=0.2)
    fetch(right, tin, "+z", 1.0, 1.0, 0.4)
    right.over(0.03, (-0.22, 0.45), 0.33, times=(0.5, 1.1, 1.0), overlap=0.3)
    right.step("MoveObjTo", tin, table)
    finish(right, tin, table, 0.4, 1.0)
    right.alternative = other_names(right, MoveObjTo="PutDown")


def up_onto_a_shelf(s: Stage) -> None:
    """A can is raised to a shelf and slipped onto it, with hardly any sinking at the end."""
    at_table(s, height=0.72, yaw_deg=-15)
    board = shelf(s, (0.8, 0.25, s.height + 0.25))
    tin = can(s, (0.45, 0.2))
    left = s.left(idle=0.2)
    fetch(left, tin, "+z", 0.9, 1.0, 0.4)
    left.over(0.275, (0.3, 0.0), 0.025, times=(1.0, 0.9, 0.4), overlap=0.2)
    left.step("MoveObjTo", tin, board)
    finish(left, tin, board, 0.4, 1.1)
    left.alternative = other_names(left, MoveObjTo="PutDown")


def flat_over_a_gap(s: Stage) -> None:
    """A can goes from one table to another of the same height, three centimetres over both."""
    at_table(s, height=0.8, yaw_deg=155, width=0.7)
    side = pillar(s, "side_table", (0.55, 0.75, 0.8), (0.5, 0.5), "side_table")
    tin = can(s, (0.5, 0.25))
    left = s.left(idle=0.2)
    fetch(left, tin, "+z", 0.8, 1.0, 0.3)
    left.hop(0.03, (0.0, 0.42, 0.0), 0.9)
    left.step("MoveObjTo", tin, side)
    finish(left, tin, side, 0.4, 0.9)
    left.alternative = other_names(left, MoveObjTo="PutDown")


def carried_low(s: Stage) -> None:
    """A mug is carried half a metre, seven centimetres over the table."""
    table, mug = at_table(s, yaw_deg=-85), cup(s, (0.5, -0.3))
    right = s.right(idle=0.2)
    fetch(right, mug, "-y", 0.9, 0.6, 0.4)
    right.lift_carry_lower(mug, table, up=0.07, by=(0.05, 0.5), down=0.07, times=(0.6, 1.3, 0.6))
    finish(right, mug, table, 0.4, 0.9)


def carried_high_and_fast(s: Stage) -> None:
    """A tall woman swings a can over in a high arc at more than a metre a second."""
    performer(s, height=0.88, yaw_deg=10, size=1.06, agent="tall_woman")
    table, tin = s.table(), can(s, (0.5, 0.35))
    left = s.left(idle=0.15)
    fetch(left, tin, "+z", 0.8, 1.0, 0.0)
    left.lift_carry_lower(tin, table, up=0.36, by=(0.1, -0.55), down=0.36, times=(0.65, 0.95, 0.7))
    finish(left, tin, table, 0.3, 0.9)


def up_and_down_past_a_rim(s: Stage) -> None:
    """A block hops over a low wall: up and down more than aside."""
    table, cube = at_table(s, yaw_deg=265), toy(s, (0.5, -0.15))
    s.put("partition", shapes.box(0.3, 0.01, 0.08, "partition"), (0.5, -0.08), tag="fixed")
    right = s.right(claw(), idle=0.2)
    fetch(right, cube, "+z", 0.9, 1.0, 0.3)
    highest = right.hop(0.28, (0.0, 0.14, 0.0), 1.4)
    end, right.clock = right.clock, highest
    right.step("Lift", cube)
    right.clock = end
    right.step("Lower", cube, table)
    finish(right, cube, table, 0.4, 0.9)


def carried_with_a_long_pause(s: Stage) -> None:
    """A mug is lifted, carried half way, held for five seconds, carried on and put down."""
    performer(s, height=0.68, yaw_deg=100, size=0.93, agent="old_man")
    table, mug = s.table(), cup(s, (0.5, -0.35))
    right = s.right(idle=0.2)
    fetch(right, mug, "-y", 1.2, 0.6, 0.5)
    travel(right, "Lift", (0.0, 0.0, 0.18), 1.0, mug, hold=0.4)
    travel(right, "Carry", (0.0, 0.3, 0.0), 1.6, mug, hold=5.0)
    travel(right, "Carry", (0.05, 0.3, 0.0), 1.6, mug, hold=0.4)
    travel(right, "Lower", (0.0, 0.0, -0.18), 1.0, mug, table)
    finish(right, mug, table, 0.5, 1.2)


def stool_pushed_over_the_floor(s: Stage) -> None:
    """Both palms push a stool away over the floor."""
    performer(s, height=0.42, yaw_deg=-40)
    ground = floor(s)
    stool = s.put("stool", shapes.box(0.34, 0.44, 0.5, "stool"), (0.5, 0.0, 0.0))
    hands = [s.right(), s.left()]
    for hand, aside in zip(hands, (-0.12, 0.12), strict=True):
        hand.idle(0.2)
        hand.reach(stool, "-x", 0.9, up=0.8, fingers=UP, aside=(0.0, aside, 0.0), hold=0.5)
    right, left = hands
    since = len(right.steps)
    left.join(stool)
    right.take(stool)
    travel(right, "Push", (0.35, 0.0, 0.0), 1.3, stool, ground, hold=0.5)
    left.part(right, since)
    both_leave(hands, 0.9)


def stool_lifted_and_set_down(s: Stage) -> None:
    """Both hands lift a stool off the floor, hold it for a second and set it down elsewhere."""
    performer(s, height=0.4, yaw_deg=185, size=1.08, agent="tall_man")
    ground = floor(s)
    stool = s.put("stool", shapes.box(0.3, 0.3, 0.45, "stool"), (0.5, 0.1, 0.0))
    hands = [s.right(), s.left()]
    for hand, side in zip(hands, ("-y", "+y"), strict=True):
        hand.idle(0.2)
        hand.reach(stool, side, 1.0, up=0.8, hold=0.4)
    right, left = hands
    since = len(right.steps)
    left.join(stool)
    right.take(stool)
    paused(right, stool, ground, up=0.2, by=(0.2, -0.3), down=0.2, holds=(1.0, 0.3))
    right.hold(0.4, stool, ground)
    left.part(right, since)
    both_leave(hands, 1.0)


def can_kept_on_a_stool(s: Stage) -> None:
    """A hand holds a can that stands on a stool for two seconds, and leaves it as it is."""
    performer(s, height=0.55, yaw_deg=-70)
    pillar(s, "stool", (0.5, -0.1, 0.55), (0.35, 0.35), "stool")
    tin = can(s, (0.5, -0.1, 0.55))
    right = s.right(idle=0.2)
    right.reach(tin, "-y", 0.9, up=0.6, hold=2.0)
    home_again(right, 0.9)


HANDLE = Grip((-0.08 - forms.HANDLE_M, 0.0, 0.096), NEAR, RIGHTWARD)
"""The handle of a box of sixteen centimetres."""


def handled_box(s: Stage, at: tuple[float, float]) -> Thing:
    """A box with an upright handle plate on its near side."""
    return s.put("box", shapes.drawer_box(0.16, 0.2, 0.16), at)


def box_pushed_against_a_wall(s: Stage) -> None:
    """A box is pushed over the table until it meets the wall, and held there."""
    at_table(s, yaw_deg=5)
    behind = wall(s, 1.02)
    box = s.put("box", shapes.box(0.16, 0.2, 0.14), (0.7, -0.1))
    right = s.right(idle=0.2)
    right.reach(box, "-x", 0.9, fingers=UP, hold=0.4)
    right.take(box)
    travel(right, "Push", (0.2402, 0.0, 0.0), 1.0, box, behind, hold=0.6)
    home_again(right, 0.9)


def box_pushed_against_a_wall_at_once(s: Stage) -> None:
    """The left hand pushes a carton to the wall at once on contact, fast, and stays on it."""
    at_table(s, height=0.9, yaw_deg=-140, size=1.05)
    behind = wall(s, 1.0)
    box = s.put("carton", shapes.carton(0.18, 0.22, 0.16), (0.6, 0.1))
    left = s.left(idle=0.15)
    left.reach(box, "-x", 0.8, fingers=UP)
    left.take(box)
    travel(left, "Push", (0.3102, 0.0, 0.0), 0.7, box, behind, hold=0.7)


def box_pulled_off_a_wall(s: Stage) -> None:
    """A box that stands against the wall is pulled away from it by its handle."""
    table = at_table(s, height=0.78, yaw_deg=65)
    wall(s, 0.98)
    box = handled_box(s, (0.9, -0.1))
    right = s.right(grip_hand(), idle=0.2)
    seize(right, box, HANDLE, 0.9, hold=0.4)
    travel(right, "Pull", (-0.28, 0.0, 0.0), 1.1, box, table, hold=0.5)
    home_again(right, 0.8)


def box_pulled_and_pushed_back(s: Stage) -> None:
    """A box is pulled near very slowly, held, and pushed back by its handle."""
    table = at_table(s, height=0.7, yaw_deg=-80, size=0.95, agent="old_woman")
    box = handled_box(s, (0.8, 0.1))
    left = s.left(grip_hand(), idle=0.2)
    seize(left, box, HANDLE, 1.2, hold=0.5)
    travel(left, "Pull", (-0.22, 0.0, 0.0), 3.8, box, table, hold=1.0)
    travel(left, "Push", (0.2, 0.0, 0.0), 2.5, box, table, hold=0.6)


def plate_slid_aside(s: Stage) -> None:
    """A palm on a plate slides it to the right and goes home."""
    table = at_table(s, yaw_deg=170)
    plate = s.put("plate", shapes.box(0.2, 0.2, 0.03, "plate"), (0.55, 0.1))
    right = s.right(idle=0.2)
    right.reach(plate, "+z", 0.9, up=1.0)
    right.take(plate)
    travel(right, "Slide", (0.05, -0.35, 0.0), 1.0, plate, table, hold=0.4)
    home_again(right, 0.9)


def pot_turned_on_the_table(s: Stage) -> None:
    """A pot is turned by sixty degrees where it stands; the hand stays on its side."""
    table = at_table(s, height=0.86, yaw_deg=-30, size=1.03)
    pot = s.put("pot", forms.pot(), (0.5, 0.05))
    left = s.left(idle=0.2)
    left.reach(pot, "+y", 0.9, up=0.5, hold=0.4)
    left.take(pot)
    left.spin((0.5, 0.05, 0.0), UP, -60.0, 1.3)
    left.step("Turn", pot, table)
    left.hold(0.6, pot, table)


def beside_a_box_that_another_hand_pulls(s: Stage) -> None:
    """The right hand pulls a box near; the left hand rests in the air five centimetres beside."""
    table = at_table(s, yaw_deg=50)
    box = handled_box(s, (0.8, -0.05))
    right = s.right(grip_hand())
    left = s.left(home=(0.62, 0.1, s.height + 0.1))
    right.idle(0.2)
    seize(right, box, HANDLE, 0.9, hold=0.4)
    travel(right, "Pull", (-0.24, 0.0, 0.0), 1.2, box, table, hold=0.5)
    left.rest(right.clock)


def along_with_a_box_that_another_hand_pushes(s: Stage) -> None:
    """The left hand pushes a box; the right hand goes along beside it and never touches it."""
    table = at_table(s, height=0.8, yaw_deg=-105)
    box = s.put("box", shapes.box(0.16, 0.2, 0.16), (0.5, 0.1))
    left, right = s.left(), s.right(home=(0.42, -0.07, s.height + 0.1))
    left.idle(0.2)
    left.reach(box, "-x", 0.9, fingers=UP, hold=0.4)
    right.rest(left.clock)
    left.take(box)
    travel(left, "Push", (0.3, 0.0, 0.0), 1.2, box, table)
    right.go((0.72, -0.07, s.height + 0.1), 1.2)
    left.hold(0.6, box, table)
    right.rest(left.clock - right.clock)


def lean_on_the_table(s: Stage) -> None:
    """Both palms are laid on the table, stay for three seconds and are taken away."""
    table = at_table(s, yaw_deg=-60, depth=0.6)
    hands = [s.right(), s.left()]
    for hand, aside in zip(hands, (-0.25, 0.25), strict=True):
        hand.idle(0.2)
        hand.reach(table, "+z", 0.9, up=1.0, aside=(-0.1, aside, 0.0), hold=3.0)
        home_again(hand, 0.9)


def lean_on_a_wall(s: Stage) -> None:
    """The left palm leans on a wall for two seconds; an apple lies on the table."""
    at_table(s, height=0.8, yaw_deg=40, size=1.06)
    apple(s, (0.5, -0.3))
    behind = wall(s, 0.75)
    left = s.left(idle=0.2)
    left.reach(behind, "-x", 1.0, up=0.8, fingers=UP, aside=(0.0, 0.2, 0.0), hold=2.0)
    home_again(left, 1.0)


def touch_a_shelf_from_below(s: Stage) -> None:
    """The palm is put to a shelf from below and stays there."""
    performer(s, height=0.6, yaw_deg=150)
    board = shelf(s, (0.55, -0.15, 1.15))
    right = s.right(idle=0.2)
    right.reach(board, "-z", 1.1, up=0.0, hold=1.0)


def touch_a_cabinet(s: Stage) -> None:
    """The palm lies on top of a cabinet whose drawer is shut, and goes home."""
    at_table(s, height=0.7, yaw_deg=-15, size=0.96)
    chest = cabinet(s, (0.6, 0.1, s.height + 0.012))
    left = s.left(idle=0.2)
    left.reach(chest.body, "+z", 1.0, up=1.0, aside=(-0.05, 0.0, 0.0), hold=0.8)
    home_again(left, 1.0)


def touch_a_stool(s: Stage) -> None:
    """A child lays the left hand on a stool for a quarter of a second."""
    performer(s, height=0.4, yaw_deg=105, size=0.76, agent="child")
    stool = pillar(s, "stool", (0.4, 0.1, 0.4), (0.3, 0.3), "stool")
    left = s.left(idle=0.15)
    left.reach(stool, "+z", 0.7, up=1.0, hold=0.25)
    left.leave(0.7)
    left.idle(0.15)


def past_a_pot(s: Stage) -> None:
    """The hand goes past a pot with a lid, six centimetres from its side, and touches nothing."""
    at_table(s, yaw_deg=85)
    s.put("pot", forms.pot(), (0.62, 0.0))
    s.put("lid", forms.round_lid(0.112), (0.62, 0.0, s.height + 0.12))
    right = s.right(home=(0.3, -0.35, s.height + 0.12), idle=0.2)
    right.go((0.3, 0.3, s.height + 0.14), 1.3)
    right.idle(0.2)


def over_a_crate_and_back(s: Stage) -> None:
    """The hand goes over the opening of a crate, rests there for a second, and goes home."""
    at_table(s, height=0.76, yaw_deg=-120)
    crate(s, (0.6, -0.1))
    apple(s, (0.6, -0.1, s.height + 0.008))
    right = s.right(home=(0.12, -0.28, s.height + 0.25), idle=0.2)
    right.go((0.58, -0.1, s.height + 0.24), 1.0)
    right.rest(1.0)
    right.go(None, 1.0)
    right.idle(0.2)


def into_a_crate_and_out(s: Stage) -> None:
    """The hand is put into a large crate, rests in it without touching, and is taken out."""
    at_table(s, height=0.65, yaw_deg=25, size=1.02)
    s.put("crate", forms.open_box(0.5, 0.5, 0.2, "crate"), (0.62, 0.05))
    left = s.left(home=(0.55, 0.1, s.height + 0.4), idle=0.2)
    left.go((0.55, 0.1, s.height + 0.12), 0.9)
    left.rest(0.9)
    left.go(None, 0.9)
    left.idle(0.2)


def apple_kept_in_the_air(s: Stage) -> None:
    """An apple is held still above a bowl from the first frame to the last."""
    at_table(s, yaw_deg=-5)
    s.put("bowl", shapes.vessel(0.12, 0.07, "bowl"), (0.55, -0.1))
    fruit = apple(s, (0.55, -0.1, s.height + 0.2))
    right = s.right()
    right.begin_at(fruit, "-y", up=0.5, fingers=(1.0, 0.0, 0.0))
    right.take(fruit)
    right.hold(3.0, fruit)


def hands_rest_beside_furniture(s: Stage) -> None:
    """Both hands rest in the air before a cabinet and a bowl with an apple in it."""
    at_table(s, height=0.82, yaw_deg=135)
    cabinet(s, (0.65, 0.25, s.height + 0.012))
    s.put("bowl", shapes.vessel(0.12, 0.07, "bowl"), (0.5, -0.25))
    apple(s, (0.5, -0.25, s.height + 0.005))
    for hand in (s.right(), s.left()):
        hand.rest(2.5)
