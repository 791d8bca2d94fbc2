"""Scenes with doors, gates and flaps about hinges at the side, below and above."""

from scenes.hands import shapes
from scenes.hands.scene import performer
from scenes.hands.scenes_place import claw
from scenes.hands.stage import Stage
from scenes.household.builders import flap_cupboard, gate, glass, oven, scene
from scenes.household.scenes_covers import narrow
from scenes.objects.builders import (
    LEFTWARD,
    NEAR,
    Grip,
    cupboard,
    floor,
    home_again,
    paused,
    pillar,
    seize,
    travel,
)
from scenes.objects.scenes_doors import swing


@scene
def oven_opened_downwards(s: Stage) -> None:
    """An oven's door is turned down by its bar and stays in the hand."""
    performer(s, height=0.72, yaw_deg=-20)
    pillar(s, "plinth", (0.9, 0.0, 0.4), (0.5, 0.5), "plinth")
    stove = oven(s, (0.68, -0.05, 0.412))
    right = s.right(narrow())
    right.idle(0.2)
    seize(right, stove.leaf, stove.grip, 1.0, hold=0.4)
    swing(right, stove, 68.0, 1.4)
    right.hold(0.9, stove.leaf, stove.body)


@scene
def oven_shut_upwards(s: Stage) -> None:
    """The left hand turns a hanging oven door up until it is shut, at once on contact."""
    performer(s, height=0.8, yaw_deg=137, size=1.05)
    pillar(s, "plinth", (0.9, 0.1, 0.45), (0.5, 0.5), "plinth")
    stove = oven(s, (0.68, 0.1, 0.462))
    stove.hinge.opened(stove.leaf, 60.0)
    left = s.left(narrow())
    left.idle(0.2)
    seize(left, stove.leaf, stove.grip, 1.2)
    swing(left, stove, -60.0, 1.2)
    left.hold(0.4, stove.leaf, stove.body)
    home_again(left, 0.9)


@scene
def oven_opened_a_crack_and_shut(s: Stage) -> None:
    """An oven's door is opened by twenty degrees, held for two seconds, and shut."""
    performer(s, height=0.78, yaw_deg=70, size=0.95, agent="old_woman")
    pillar(s, "plinth", (0.92, -0.1, 0.5), (0.5, 0.5), "plinth")
    stove = oven(s, (0.68, -0.1, 0.512), width=0.4, height=0.3)
    right = s.right(narrow())
    right.idle(0.25)
    seize(right, stove.leaf, stove.grip, 1.2, hold=0.6)
    swing(right, stove, 20.0, 1.0)
    right.hold(2.0, stove.leaf, stove.body)
    swing(right, stove, -20.0, 1.0)
    right.hold(0.5, stove.leaf, stove.body)
    home_again(right, 1.1)


@scene
def flap_turned_up(s: Stage) -> None:
    """A cupboard's flap over the table is turned up by its lip and held open."""
    performer(s, height=0.7, yaw_deg=-107, size=1.06, agent="tall_man")
    s.table()
    press = flap_cupboard(s, (0.66, 0.1, s.height + 0.4))
    left = s.left(narrow())
    left.idle(0.2)
    seize(left, press.leaf, press.grip, 1.1, hold=0.3)
    swing(left, press, 75.0, 1.3)
    left.hold(1.6, press.leaf, press.body)


@scene
def flap_let_down_in_two_stages(s: Stage) -> None:
    """A flap that stands up is turned half way down, held for a second, and shut."""
    performer(s, height=0.68, yaw_deg=28, size=1.03)
    s.table()
    press = flap_cupboard(s, (0.66, -0.1, s.height + 0.38), width=0.44, height=0.26)
    press.hinge.opened(press.leaf, 64.0)
    right = s.right(narrow())
    right.idle(0.2)
    seize(right, press.leaf, press.grip, 1.2, hold=0.4)
    swing(right, press, -30.0, 0.8)
    right.hold(1.0, press.leaf, press.body)
    swing(right, press, -34.0, 0.9)
    right.hold(0.4, press.leaf, press.body)
    home_again(right, 1.0)


@scene
def gate_opened(s: Stage) -> None:
    """A gate between two posts on the floor is drawn open by its handle, in a wide arc."""
    performer(s, height=0.5, yaw_deg=180, size=1.02)
    floor(s)
    port = gate(s, (0.75, -0.45, 0.0))
    right = s.right(narrow())
    right.idle(0.2)
    seize(right, port.leaf, port.grip, 0.9, hold=0.3)
    swing(right, port, 42.0, 1.4)
    right.hold(0.5, port.leaf, port.body)
    home_again(right, 0.9)


@scene
def gate_shut_with_the_palm(s: Stage) -> None:
    """A gate that stands open is pressed shut with the left palm on its outer face."""
    performer(s, height=0.55, yaw_deg=-66)
    floor(s)
    port = gate(s, (0.78, -0.5, 0.0), width=0.56, height=0.9)
    port.hinge.opened(port.leaf, 35.0)
    left = s.left()
    left.idle(0.2)
    seize(left, port.leaf, port.face, 0.9)
    swing(left, port, -35.0, 0.9)
    left.hold(0.7, port.leaf, port.body)


@scene
def glass_out_and_door_shut(s: Stage) -> None:
    """The left hand opens a door, the right hand takes a glass out, and the left hand shuts it."""
    performer(s, height=0.71, yaw_deg=49)
    table = s.table()
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


@scene
def door_shut_in_two_pushes_with_a_rest_between(s: Stage) -> None:
    """A door is pressed half shut, let go of, and after a rest pressed shut with the same palm."""
    performer(s, height=0.76, yaw_deg=-152, size=1.04)
    s.table()
    press = cupboard(s, (0.72, 0.0, s.height + 0.012), side="left", width=0.36)
    press.hinge.opened(press.leaf, 60.0)
    left = s.left()
    left.idle(0.2)
    seize(left, press.leaf, press.face, 1.0, hold=0.3)
    swing(left, press, -28.0, 0.8)
    left.hold(0.3, press.leaf, press.body)
    left.leave(0.8)
    left.rest(0.7)
    seize(left, press.leaf, press.face, 0.9)
    swing(left, press, -32.0, 0.8)
    left.hold(0.5, press.leaf, press.body)
    home_again(left, 0.9)


@scene
def beside_a_door_that_another_hand_opens(s: Stage) -> None:
    """The right hand opens a door; the left hand rests in the air near its path all the while."""
    performer(s, height=0.73, yaw_deg=8)
    s.table()
    press = cupboard(s, (0.72, -0.15, s.height + 0.012), side="right")
    right = s.right(narrow())
    left = s.left(home=(0.6, 0.12, s.height + 0.2))
    right.idle(0.2)
    seize(right, press.leaf, press.grip, 1.0, hold=0.3)
    swing(right, press, 60.0, 1.2)
    right.hold(0.6, press.leaf, press.body)
    left.rest(right.clock)


@scene
def tin_pushed_up_to_a_shut_door(s: Stage) -> None:
    """A tin is pushed over the table until it meets a shut door, which does not move."""
    performer(s, height=0.75, yaw_deg=-38)
    s.table()
    press = cupboard(s, (0.8, 0.0, s.height), side="right", width=0.4)
    tin = s.put("tin", shapes.box(0.12, 0.16, 0.14, "tin"), (0.5, -0.05))
    right = s.right()
    right.idle(0.2)
    right.reach(tin, "-x", 0.9, fingers=(0.0, 0.0, 1.0))
    right.hold(0.4, tin)
    right.take(tin)
    front = 0.8 - 0.0157
    travel(right, "Push", (front - 0.56, 0.0, 0.0), 1.1, tin, press.leaf)
    right.hold(0.6, tin, press.leaf)
    home_again(right, 0.9)
