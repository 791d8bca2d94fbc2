"""Scenes in which furniture is touched or leant on, and hands pass near, over and into things."""

from scenes.hands.scene import performer
from scenes.hands.scenes_place import claw, fetch, finish
from scenes.hands.stage import Stage
from scenes.household import builders
from scenes.household.builders import dresser, oven, plum, scene, sliding_cupboard
from scenes.objects import forms
from scenes.objects.builders import (
    AHEAD,
    NEAR,
    RIGHTWARD,
    UP,
    Grip,
    home_again,
    paused,
    pillar,
    seize,
    shelf,
    travel,
    wall,
)


@scene
def over_an_open_drawer_and_back(s: Stage) -> None:
    """The hand goes over a drawer that stands open with a plum in it, rests, and goes home."""
    performer(s, height=0.66, yaw_deg=27)
    s.table()
    (rail,) = dresser(s, (0.72, 0.1, s.height + 0.012), heights=(0.12,))
    rail.part.body.first[0, 3] -= 0.22
    plum(s, (0.6, 0.1, s.height + 0.012 - 0.0003 + 0.008))
    left = s.left()
    left.idle(0.2)
    left.go((0.5, 0.1, s.height + 0.3), 1.0)
    left.rest(0.9)
    left.go(None, 1.0)
    left.idle(0.2)


@scene
def into_a_sideboard_and_out(s: Stage) -> None:
    """The hand goes into a sideboard's open half, rests there for a second, and comes out."""
    performer(s, height=0.58, yaw_deg=-117, size=0.95)
    s.table()
    sliding_cupboard(s, (0.66, 0.0, s.height + 0.05), way=-1.0, width=0.7, height=0.36)
    right = s.right(home=(0.3, -0.17, s.height + 0.22))
    right.idle(0.2)
    right.go((0.72, -0.17, s.height + 0.22), 0.9)
    right.rest(1.0)
    right.go(None, 0.9)
    right.idle(0.2)


@scene
def between_two_buckets(s: Stage) -> None:
    """The hand passes between two buckets without a halt and touches neither."""
    performer(s, height=0.7, yaw_deg=64)
    s.table()
    builders.bucket(s, (0.6, 0.2), name="left_bucket")
    builders.bucket(s, (0.6, -0.2), name="right_bucket")
    right = s.right(home=(0.2, 0.0, s.height + 0.12))
    right.idle(0.2)
    right.go((0.78, 0.0, s.height + 0.12), 1.4)
    right.idle(0.2)


@scene
def lean_on_a_counter_and_fetch(s: Stage) -> None:
    """The left hand leans on the table's edge while the right hand moves a plum into a basin."""
    performer(s, height=0.9, yaw_deg=-48, size=1.07, agent="tall_man")
    table = s.table()
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


@scene
def hand_on_a_stool_throughout(s: Stage) -> None:
    """The left hand lies on a stool from the first frame to the last; the right hand rests."""
    performer(s, height=0.45, yaw_deg=138, size=0.78, agent="child")
    stool = pillar(s, "stool", (0.35, 0.2, 0.42), (0.3, 0.3), "stool")
    left, right = s.left(), s.right()
    left.begin_at(stool, "+z", up=1.0, fingers=AHEAD)
    left.hold(2.4, stool)
    right.rest(2.4)


@scene
def palm_on_a_rack_and_on_a_wall(s: Stage) -> None:
    """The palm lies on a rack's side for a second, goes home, rests, and lies on the wall."""
    performer(s, height=0.76, yaw_deg=-22)
    behind = wall(s, 0.95)
    rack = s.put(
        "rack", builders.open_shelves(0.24, 0.4, (0.3, 0.7, 1.1)), (0.55, 0.35, 0.0), tag="fixed"
    )
    right = s.right()
    right.idle(0.2)
    right.reach(rack, "-y", 1.0, up=0.75)
    right.hold(1.0, rack)
    right.leave(1.0)
    right.rest(0.7)
    right.reach(behind, "-x", 1.0, up=0.6, fingers=UP, aside=(0.0, -0.25, 0.0))
    right.hold(0.8, behind)
    home_again(right, 1.0)


@scene
def dresser_touched_and_then_its_drawer(s: Stage) -> None:
    """The left palm lies on a dresser, and after a rest on the front of its shut lower drawer."""
    performer(s, height=0.62, yaw_deg=90, size=1.02)
    s.table()
    low, _ = dresser(s, (0.64, 0.1, s.height + 0.012), heights=(0.18, 0.1), width=0.5)
    left = s.left()
    left.idle(0.2)
    left.reach(low.body, "+z", 1.1, up=1.0, aside=(-0.06, 0.0, 0.0))
    left.hold(0.7, low.body)
    left.leave(1.0)
    left.rest(0.6)
    front = Grip((0.0, 0.15, 0.09), NEAR, RIGHTWARD)
    seize(left, low.part, front, 1.0, hold=1.1, take=False)
    home_again(left, 0.9)


@scene
def oven_touched_and_hand_drawn_back(s: Stage) -> None:
    """The right palm lies on an oven's shut door for half a second and withdraws to a new place."""
    performer(s, height=0.75, yaw_deg=-7, size=1.06)
    pillar(s, "plinth", (0.94, 0.0, 0.45), (0.5, 0.5), "plinth")
    stove = oven(s, (0.72, -0.1, 0.462))
    right = s.right()
    right.idle(0.2)
    seize(right, stove.leaf, stove.face, 1.1, hold=0.5, take=False)
    right.leave(0.9, to=(0.35, 0.1, s.height + 0.35), name="Withdraw")
    right.idle(0.2)


@scene
def plum_over_a_basin_and_back(s: Stage) -> None:
    """A plum is held above a basin for two seconds, carried back and put where it was."""
    performer(s, height=0.8, yaw_deg=-134, size=0.97)
    table = s.table()
    builders.basin(s, (0.62, 0.15))
    fruit = plum(s, (0.5, -0.3))
    right = s.right(claw())
    right.idle(0.2)
    fetch(right, fruit, "+z", 0.9, 1.0, 0.3)
    travel(right, "Lift", (0.0, 0.0, 0.24), 0.8, fruit)
    right.hold(0.4, fruit)
    travel(right, "Carry", (0.12, 0.45, 0.0), 1.1, fruit)
    right.hold(2.0, fruit)
    travel(right, "Carry", (-0.12, -0.45, 0.0), 1.1, fruit)
    right.hold(0.4, fruit)
    travel(right, "Lower", (0.0, 0.0, -0.24), 0.8, fruit, table)
    finish(right, fruit, table, 0.3, 0.9)


@scene
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


@scene
def above_a_box_that_the_other_hand_lifts(s: Stage) -> None:
    """The right hand lifts a box by its side; the left hand rests far over it in the air."""
    performer(s, height=0.6, yaw_deg=-62)
    table = s.table()
    box = s.put("box", forms.open_box(0.14, 0.14, 0.16, "box"), (0.5, -0.05))
    right, left = s.right(), s.left(home=(0.5, 0.02, s.height + 0.48))
    right.idle(0.2)
    fetch(right, box, "-y", 0.9, 0.6, 0.4)
    paused(right, box, table, up=0.15, by=(0.2, -0.2), down=0.15, holds=(0.6, 0.4))
    finish(right, box, table, 0.4, 0.9)
    left.rest(right.clock)


@scene
def shelf_felt_from_below_and_above(s: Stage) -> None:
    """The left palm lies under a shelf, and after a rest before it on top of it."""
    performer(s, height=0.65, yaw_deg=177, size=1.03)
    board = shelf(s, (0.6, 0.15, 1.05), size=(0.36, 0.5))
    left = s.left(home=(0.1, 0.3, 1.05))
    left.idle(0.2)
    left.reach(board, "-z", 1.0, up=0.0)
    left.hold(0.6, board)
    left.leave(1.0)
    left.rest(0.8)
    left.reach(board, "+z", 1.2, up=1.0)
    left.hold(0.9, board)
