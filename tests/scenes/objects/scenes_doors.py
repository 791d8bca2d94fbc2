"""Scenes in which a cupboard's door is opened and shut about its hinge."""

from scenes.hands.performer import Hand
from scenes.hands.scene import performer
from scenes.hands.scenes_place import claw, cup
from scenes.hands.stage import Stage
from scenes.objects.builders import (
    LEFTWARD,
    Cupboard,
    Grip,
    cupboard,
    home_again,
    paused,
    scene,
    seize,
)
from scenes.objects.scenes_drawers import grip_hand


def swing(hand: Hand, press: Cupboard, angle_deg: float, duration: float) -> None:
    """Open a door by an angle, or shut it by a negative one."""
    press.hinge.turn(hand, angle_deg, duration)
    hand.step("Open" if angle_deg > 0 else "Close", press.leaf, press.body)


@scene
def door_opened(s: Stage) -> None:
    """A cupboard's door is opened by its handle and let go of."""
    performer(s, yaw_deg=35)
    s.table()
    press = cupboard(s, (0.7, -0.1, s.height + 0.012), side="right")
    right = s.right(grip_hand())
    right.idle(0.2)
    seize(right, press.leaf, press.grip, 1.0, hold=0.4)
    swing(right, press, 70.0, 1.3)
    right.hold(0.4, press.leaf, press.body)
    home_again(right, 0.9)


@scene
def door_shut(s: Stage) -> None:
    """A door that stands open is shut; the hand stays on its handle."""
    performer(s, height=0.85, yaw_deg=-145, size=1.05)
    s.table()
    press = cupboard(s, (0.72, -0.1, s.height + 0.012), side="right")
    press.hinge.opened(press.leaf, 60.0)
    right = s.right(grip_hand())
    right.idle(0.2)
    seize(right, press.leaf, press.grip, 1.0, hold=0.3)
    swing(right, press, -60.0, 1.1)
    right.hold(0.7, press.leaf, press.body)


@scene
def door_opened_with_the_left_hand(s: Stage) -> None:
    """A door with its hinge on the left is opened quickly, at once on contact."""
    performer(s, height=0.66, yaw_deg=85, size=0.92, agent="boy")
    s.table()
    press = cupboard(s, (0.66, 0.1, s.height + 0.012), side="left", width=0.3)
    left = s.left(grip_hand())
    left.idle(0.15)
    seize(left, press.leaf, press.grip, 0.8)
    swing(left, press, 80.0, 0.9)
    left.hold(0.5, press.leaf, press.body)
    home_again(left, 0.8)


@scene
def door_opened_in_two_stages(s: Stage) -> None:
    """A door is opened a little, held for a second, and opened further."""
    performer(s, height=0.74, yaw_deg=200)
    s.table()
    press = cupboard(s, (0.7, -0.15, s.height + 0.012), side="right")
    right = s.right(grip_hand())
    right.idle(0.2)
    seize(right, press.leaf, press.grip, 0.9, hold=0.3)
    swing(right, press, 35.0, 1.0)
    right.hold(1.0, press.leaf, press.body)
    swing(right, press, 40.0, 1.0)
    right.hold(0.5, press.leaf, press.body)


@scene
def door_opened_and_shut_later(s: Stage) -> None:
    """A door is opened and let go of; after a rest at home the same hand shuts it."""
    performer(s, yaw_deg=-20)
    s.table()
    press = cupboard(s, (0.72, 0.1, s.height + 0.012), side="left")
    left = s.left(grip_hand())
    left.idle(0.2)
    seize(left, press.leaf, press.grip, 1.0, hold=0.3)
    swing(left, press, 55.0, 1.2)
    left.hold(0.3, press.leaf, press.body)
    left.leave(0.9)
    left.rest(1.5)
    seize(left, press.leaf, press.grip, 1.0, hold=0.3)
    swing(left, press, -55.0, 1.1)
    left.hold(0.3, press.leaf, press.body)
    home_again(left, 0.9)


@scene
def door_opened_and_shut_at_once(s: Stage) -> None:
    """A door is opened, held for half a second and shut in one contact, slowly."""
    performer(s, height=0.7, yaw_deg=110, size=0.96, agent="old_woman")
    s.table()
    press = cupboard(s, (0.7, -0.1, s.height + 0.012), side="right")
    right = s.right(grip_hand())
    right.idle(0.2)
    seize(right, press.leaf, press.grip, 1.3, hold=0.6)
    swing(right, press, 45.0, 2.2)
    right.hold(0.5, press.leaf, press.body)
    swing(right, press, -45.0, 2.0)
    right.hold(0.8, press.leaf, press.body)
    home_again(right, 1.2)


@scene
def door_pushed_shut_with_the_palm(s: Stage) -> None:
    """A door that stands open is shut with the flat palm on its outer face."""
    performer(s, yaw_deg=-60)
    s.table()
    press = cupboard(s, (0.72, 0.0, s.height + 0.012), side="right")
    press.hinge.opened(press.leaf, 50.0)
    right = s.right()
    right.idle(0.2)
    seize(right, press.leaf, press.face, 1.0)
    swing(right, press, -50.0, 1.0)
    right.hold(0.5, press.leaf, press.body)
    home_again(right, 0.9)


@scene
def mug_out_of_a_cupboard(s: Stage) -> None:
    """The right hand opens a door and holds it; the left hand takes a mug out to the table."""
    performer(s, height=0.78, yaw_deg=15)
    table = s.table()
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


@scene
def door_only_touched(s: Stage) -> None:
    """A palm lies on a shut door for two seconds."""
    performer(s, height=0.8, yaw_deg=175)
    s.table()
    press = cupboard(s, (0.7, 0.05, s.height + 0.012), side="left")
    left = s.left()
    left.idle(0.2)
    seize(left, press.leaf, press.face, 1.0, hold=2.0, take=False)
    home_again(left, 0.9)
