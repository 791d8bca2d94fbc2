"""Scenes with stools, shelves and tables of different heights: carried high, low and flat."""

from scenes.hands import shapes
from scenes.hands.scene import performer
from scenes.hands.scenes_place import claw, cup, fetch, finish
from scenes.hands.scenes_two_hands import both_leave
from scenes.hands.stage import Stage, other_names
from scenes.objects.builders import (
    UP,
    can,
    floor,
    home_again,
    paused,
    pillar,
    scene,
    shelf,
    toy,
    travel,
)


@scene
def from_a_stool_to_the_table(s: Stage) -> None:
    """A block is taken from a stool and put on the table in one sweep."""
    performer(s, yaw_deg=45)
    table = s.table()
    pillar(s, "stool", (0.4, -0.95, 0.5), (0.35, 0.35), "stool")
    cube = toy(s, (0.45, -0.95, 0.5))
    right = s.right(claw(), home=(0.12, -0.6, 0.86))
    right.idle(0.2)
    fetch(right, cube, "+z", 1.0, 1.0, 0.3)
    right.lift_carry_lower(cube, table, up=0.42, by=(0.05, 0.65), down=0.18, times=(1.0, 1.1, 0.8))
    finish(right, cube, table, 0.3, 1.2)


@scene
def from_the_table_to_a_stool(s: Stage) -> None:
    """The left hand takes a can from the table and stands it on a stool, pausing once."""
    performer(s, height=0.7, yaw_deg=-130, size=0.95)
    s.table(width=1.0)
    stool = pillar(s, "stool", (0.45, 0.85, 0.52), (0.35, 0.35), "stool")
    tin = can(s, (0.45, 0.3))
    left = s.left()
    left.idle(0.2)
    fetch(left, tin, "+z", 0.9, 1.0, 0.0)
    paused(left, tin, stool, up=0.1, by=(0.0, 0.55), down=0.28, holds=(0.0, 0.6))
    finish(left, tin, stool, 0.4, 1.2)


@scene
def down_from_a_shelf(s: Stage) -> None:
    """A can is drawn over the edge of a shelf, hardly lifted, and brought down on the table."""
    performer(s, height=0.74, yaw_deg=70, size=1.05)
    table = s.table()
    shelf(s, (0.75, -0.2, s.height + 0.3))
    tin = can(s, (0.65, -0.2, s.height + 0.3))
    right = s.right()
    right.idle(0.2)
    fetch(right, tin, "+z", 1.0, 1.0, 0.4)
    right.over(0.03, (-0.22, 0.45), 0.33, times=(0.5, 1.1, 1.0), overlap=0.3)
    right.step("MoveObjTo", tin, table)
    finish(right, tin, table, 0.4, 1.0)
    right.alternative = other_names(right, MoveObjTo="PutDown")


@scene
def up_onto_a_shelf(s: Stage) -> None:
    """A can is raised to a shelf and slipped onto it, with hardly any sinking at the end."""
    performer(s, height=0.72, yaw_deg=-15)
    s.table()
    board = shelf(s, (0.8, 0.25, s.height + 0.25))
    tin = can(s, (0.45, 0.2))
    left = s.left()
    left.idle(0.2)
    fetch(left, tin, "+z", 0.9, 1.0, 0.4)
    left.over(0.275, (0.3, 0.0), 0.025, times=(1.0, 0.9, 0.4), overlap=0.2)
    left.step("MoveObjTo", tin, board)
    finish(left, tin, board, 0.4, 1.1)
    left.alternative = other_names(left, MoveObjTo="PutDown")


@scene
def flat_over_a_gap(s: Stage) -> None:
    """A can goes from one table to another of the same height, three centimetres over both."""
    performer(s, height=0.8, yaw_deg=155)
    s.table(width=0.7)
    side = pillar(s, "side_table", (0.55, 0.75, 0.8), (0.5, 0.5), "side_table")
    tin = can(s, (0.5, 0.25))
    left = s.left()
    left.idle(0.2)
    fetch(left, tin, "+z", 0.8, 1.0, 0.3)
    left.hop(0.03, (0.0, 0.42, 0.0), 0.9)
    left.step("MoveObjTo", tin, side)
    finish(left, tin, side, 0.4, 0.9)
    left.alternative = other_names(left, MoveObjTo="PutDown")


@scene
def carried_low(s: Stage) -> None:
    """A mug is carried half a metre, seven centimetres over the table."""
    performer(s, yaw_deg=-85)
    table, mug = s.table(), cup(s, (0.5, -0.3))
    right = s.right()
    right.idle(0.2)
    fetch(right, mug, "-y", 0.9, 0.6, 0.4)
    right.lift_carry_lower(mug, table, up=0.07, by=(0.05, 0.5), down=0.07, times=(0.6, 1.3, 0.6))
    finish(right, mug, table, 0.4, 0.9)


@scene
def carried_high_and_fast(s: Stage) -> None:
    """A tall woman swings a can over in a high arc at more than a metre a second."""
    performer(s, height=0.88, yaw_deg=10, size=1.06, agent="tall_woman")
    table, tin = s.table(), can(s, (0.5, 0.35))
    left = s.left()
    left.idle(0.15)
    fetch(left, tin, "+z", 0.8, 1.0, 0.0)
    left.lift_carry_lower(tin, table, up=0.36, by=(0.1, -0.55), down=0.36, times=(0.65, 0.95, 0.7))
    finish(left, tin, table, 0.3, 0.9)


@scene
def up_and_down_past_a_rim(s: Stage) -> None:
    """A block hops over a low wall: up and down more than aside."""
    performer(s, yaw_deg=265)
    table, cube = s.table(), toy(s, (0.5, -0.15))
    s.put("partition", shapes.box(0.3, 0.01, 0.08, "partition"), (0.5, -0.08), tag="fixed")
    right = s.right(claw())
    right.idle(0.2)
    fetch(right, cube, "+z", 0.9, 1.0, 0.3)
    highest = right.hop(0.28, (0.0, 0.14, 0.0), 1.4)
    end, right.clock = right.clock, highest
    right.step("Lift", cube)
    right.clock = end
    right.step("Lower", cube, table)
    finish(right, cube, table, 0.4, 0.9)


@scene
def carried_with_a_long_pause(s: Stage) -> None:
    """A mug is lifted, carried half way, held for five seconds, carried on and put down."""
    performer(s, height=0.68, yaw_deg=100, size=0.93, agent="old_man")
    table, mug = s.table(), cup(s, (0.5, -0.35))
    right = s.right()
    right.idle(0.2)
    fetch(right, mug, "-y", 1.2, 0.6, 0.5)
    travel(right, "Lift", (0.0, 0.0, 0.18), 1.0, mug)
    right.hold(0.4, mug)
    travel(right, "Carry", (0.0, 0.3, 0.0), 1.6, mug)
    right.hold(5.0, mug)
    travel(right, "Carry", (0.05, 0.3, 0.0), 1.6, mug)
    right.hold(0.4, mug)
    travel(right, "Lower", (0.0, 0.0, -0.18), 1.0, mug, table)
    finish(right, mug, table, 0.5, 1.2)


@scene
def stool_pushed_over_the_floor(s: Stage) -> None:
    """Both palms push a stool away over the floor."""
    performer(s, height=0.42, yaw_deg=-40)
    ground = floor(s)
    stool = s.put("stool", shapes.box(0.34, 0.44, 0.5, "stool"), (0.5, 0.0, 0.0))
    hands = [s.right(), s.left()]
    for hand, aside in zip(hands, (-0.12, 0.12), strict=True):
        hand.idle(0.2)
        hand.reach(stool, "-x", 0.9, up=0.8, fingers=UP, aside=(0.0, aside, 0.0))
        hand.hold(0.5, stool)
    right, left = hands
    since = len(right.steps)
    left.join(stool)
    right.take(stool)
    travel(right, "Push", (0.35, 0.0, 0.0), 1.3, stool, ground)
    right.hold(0.5, stool, ground)
    left.part(right, since)
    both_leave(hands, 0.9)


@scene
def stool_lifted_and_set_down(s: Stage) -> None:
    """Both hands lift a stool off the floor, hold it for a second and set it down elsewhere."""
    performer(s, height=0.4, yaw_deg=185, size=1.08, agent="tall_man")
    ground = floor(s)
    stool = s.put("stool", shapes.box(0.3, 0.3, 0.45, "stool"), (0.5, 0.1, 0.0))
    hands = [s.right(), s.left()]
    for hand, side in zip(hands, ("-y", "+y"), strict=True):
        hand.idle(0.2)
        hand.reach(stool, side, 1.0, up=0.8)
        hand.hold(0.4, stool)
    right, left = hands
    since = len(right.steps)
    left.join(stool)
    right.take(stool)
    paused(right, stool, ground, up=0.2, by=(0.2, -0.3), down=0.2, holds=(1.0, 0.3))
    right.hold(0.4, stool, ground)
    left.part(right, since)
    both_leave(hands, 1.0)


@scene
def can_kept_on_a_stool(s: Stage) -> None:
    """A hand holds a can that stands on a stool for two seconds, and leaves it as it is."""
    performer(s, height=0.55, yaw_deg=-70)
    pillar(s, "stool", (0.5, -0.1, 0.55), (0.35, 0.35), "stool")
    tin = can(s, (0.5, -0.1, 0.55))
    right = s.right()
    right.idle(0.2)
    right.reach(tin, "-y", 0.9, up=0.6)
    right.hold(2.0, tin)
    home_again(right, 0.9)
