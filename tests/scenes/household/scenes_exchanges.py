"""Scenes in which a thing goes from one hand of the performer to the other."""

from scenes.hands.performer import Hand
from scenes.hands.scene import performer
from scenes.hands.scenes_place import fetch
from scenes.hands.stage import Stage, other_names
from scenes.hands.things import Thing
from scenes.household.builders import scene, tin_box
from scenes.objects import forms
from scenes.objects.builders import home_again, shelf, travel


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


@scene
def tin_passed_through_a_hatch_to_a_shelf(s: Stage) -> None:
    """The right hand gives a tin through a hatch; the left hand stands it on a shelf."""
    performer(s, height=0.7, yaw_deg=-87, size=1.03)
    s.table()
    s.put("hatch", forms.frame(0.5, 0.55), (0.48, -0.06), tag="fixed")
    board = shelf(s, (0.5, 0.32, s.height + 0.1), size=(0.3, 0.3))
    tin = tin_box(s, (0.48, -0.34), "tin", (0.1, 0.12, 0.16))
    right, left = s.right(), s.left()
    right.idle(0.2)
    fetch(right, tin, "-y", 0.9, 0.6, 0.3)
    travel(right, "Lift", (0.0, 0.0, 0.22), 0.8, tin)
    right.hold(0.4, tin)
    hand_on(right, left, tin, far=0.3, reach_s=1.3)
    travel(left, "Carry", (0.0, 0.36, 0.0), 0.9, tin)
    left.hold(0.4, tin)
    travel(left, "Lower", (0.0, 0.0, -0.12), 0.7, tin, board)
    left.hold(0.4, tin, board)
    right.rest(left.clock - right.clock)
    either_way(right, left)


@scene
def tin_passed_from_left_to_right_and_put_down(s: Stage) -> None:
    """The left hand brings a tin over; the right hand takes it, lowers it and leaves."""
    performer(s, height=0.82, yaw_deg=16, size=0.96)
    table = s.table()
    tin = tin_box(s, (0.5, 0.3, s.height + 0.15), "tin", (0.12, 0.1, 0.14))
    left, right = s.left(), s.right()
    left.begin_at(tin, "+y", up=0.55, fingers=(1.0, 0.0, 0.0))
    left.take(tin)
    left.hold(0.7, tin)
    hand_on(left, right, tin, far=0.32, reach_s=1.1)
    travel(right, "Lower", (0.0, 0.0, -0.15), 0.8, tin, table)
    right.hold(0.4, tin, table)
    home_again(right, 0.9)
    left.rest(right.clock - left.clock)
    either_way(left, right)
