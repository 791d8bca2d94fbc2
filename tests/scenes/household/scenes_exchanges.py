"""Scenes in which a thing goes from one hand of the performer to the other."""

from scenes.hands.scene import performer
from scenes.hands.scenes_place import fetch
from scenes.hands.stage import Stage
from scenes.household.registry import scene
from scenes.household.wares import tin_box
from scenes.objects import forms
from scenes.objects.handling import home_again, travel
from scenes.objects.scenes_passing import handed
from scenes.objects.things_at_hand import shelf


@scene
def tin_passed_through_a_hatch_to_a_shelf(s: Stage) -> None:
    """The right hand lifts a tin and gives it through a hatch; the left hand stands it on a shelf."""
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
    left.rest(0.8)
    handed(right, left, tin, far=0.3)
    travel(left, "Carry", (0.0, 0.36, 0.0), 0.9, tin)
    left.hold(0.4, tin)
    travel(left, "Lower", (0.0, 0.0, -0.12), 0.7, tin, board)
    left.hold(0.4, tin, board)
    right.rest(left.clock - right.clock)


@scene
def tin_passed_from_left_to_right_and_put_down(s: Stage) -> None:
    """The left hand brings a tin over; the right hand takes it, lowers it to the table and leaves."""
    performer(s, height=0.82, yaw_deg=16, size=0.96)
    table = s.table()
    tin = tin_box(s, (0.5, 0.3, s.height + 0.15), "tin", (0.12, 0.1, 0.14))
    left, right = s.left(), s.right()
    left.begin_at(tin, "+y", up=0.55, fingers=(1.0, 0.0, 0.0))
    left.take(tin)
    left.hold(0.7, tin)
    handed(left, right, tin, far=0.32)
    travel(right, "Lower", (0.0, 0.0, -0.15), 0.8, tin, table)
    right.hold(0.4, tin, table)
    home_again(right, 0.9)
    left.rest(right.clock - left.clock)
