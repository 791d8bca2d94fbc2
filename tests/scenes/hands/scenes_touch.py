"""Scenes in which nothing is moved: reaches, touches, rests, passing by, touching oneself."""

from dataclasses import replace

from scenes.hands import shapes
from scenes.hands.paths import LEFTWARD, RIGHTWARD, UP
from scenes.hands.scene import at_table
from scenes.hands.stage import Stage, other_names


def touch_and_stay(s: Stage) -> None:
    """The right hand goes to a box and stays there until the end."""
    s.table()
    box = s.put("box", shapes.box(0.16, 0.12, 0.14), (0.6, 0.0))
    right = s.right(idle=0.2)
    right.reach(box, "-x", 0.95, fingers=UP, hold=1.0)


def touch_and_return(s: Stage) -> None:
    """The right hand touches a mug at its side and goes home."""
    at_table(s, height=0.9, yaw_deg=35, size=1.06, agent="tall_man")
    mug = s.put("mug", shapes.vessel(0.042, 0.1), (0.58, 0.05))
    right = s.right(idle=0.2)
    right.reach(mug, "-y", 0.9, up=0.6, hold=0.7)
    right.leave(0.9)
    right.idle(0.2)


def touch_briefly(s: Stage) -> None:
    """A child's left hand touches a box for a quarter of a second."""
    at_table(s, height=0.5, yaw_deg=-60, size=0.75, agent="child")
    box = s.put("box", shapes.box(0.1, 0.1, 0.12), (0.5, 0.05))
    left = s.left(idle=0.15)
    left.reach(box, "+y", 0.6, up=0.6, hold=0.25)
    left.leave(0.6)
    left.idle(0.15)


def hold_for_long(s: Stage) -> None:
    """The right hand lies on a box for five seconds."""
    at_table(s, yaw_deg=150, offset=(2.0, -1.0))
    box = s.put("box", shapes.box(0.3, 0.2, 0.1), (0.55, -0.1))
    right = s.right(idle=0.2)
    right.reach(box, "+z", 1.1, up=1.0, hold=5.0)
    right.leave(1.0)
    right.idle(0.2)


def touch_the_table(s: Stage) -> None:
    """The right hand is laid on the table and taken home; a mug stands further away."""
    table = at_table(s, height=1.0, yaw_deg=90, size=1.05, depth=0.6, width=0.5)
    s.put("mug", shapes.vessel(0.04, 0.09), (0.8, 0.2))
    right = s.right(idle=0.2)
    right.reach(table, "+z", 1.0, up=1.0, hold=0.9)
    right.leave(1.0)
    right.idle(0.2)


def press_with_a_fingertip(s: Stage) -> None:
    """A fingertip is put on a box that does not give way."""
    at_table(s, yaw_deg=250)
    box = s.put("box", shapes.box(0.2, 0.2, 0.2), (0.65, -0.05))
    right = s.right(shapes.pointing_hand(), idle=0.2)
    right.reach(box, "-x", 0.9, fingers=RIGHTWARD, hold=0.5)
    right.leave(0.8)
    right.idle(0.2)


def touch_with_both_hands(s: Stage) -> None:
    """Both hands take a box between them, one after the other, and leave it as it is."""
    at_table(s, height=0.8, yaw_deg=-120)
    box = s.put("box", shapes.box(0.25, 0.3, 0.18), (0.55, 0.0))
    right, left = s.right(), s.left()
    right.idle(0.2)
    right.reach(box, "-y", 0.8, hold=1.0)
    right.leave(0.9)
    right.idle(0.2)
    left.idle(0.2)
    left.reach(box, "+y", 1.0, hold=0.8)
    left.leave(0.9)
    left.idle(0.2)


def touch_two_things_with_a_rest_between(s: Stage) -> None:
    """The hand touches a box, goes home, rests, and touches a bottle."""
    at_table(s, yaw_deg=20, offset=(-1.0, 0.5))
    box = s.put("box", shapes.box(0.12, 0.12, 0.15), (0.55, 0.15))
    flask = s.put("bottle", shapes.bottle(), (0.6, -0.3))
    right = s.right(idle=0.2)
    right.reach(box, "-y", 0.9, hold=0.5)
    right.leave(0.9)
    right.rest(0.8)
    right.reach(flask, "-y", 0.8, up=0.4, hold=0.6)
    right.leave(0.8)
    right.idle(0.2)


def from_one_thing_to_the_next(s: Stage) -> None:
    """The hand goes from one box straight to another without going home between."""
    at_table(s, yaw_deg=-30)
    first = s.put("first_box", shapes.box(0.12, 0.12, 0.14), (0.55, -0.15))
    second = s.put("second_box", shapes.box(0.12, 0.12, 0.14), (0.6, 0.35))
    right = s.right(idle=0.2)
    right.reach(first, "-x", 0.9, fingers=UP, hold=0.5)
    right.leave_to_reach(second, "-x", 1.1, fingers=UP)
    right.hold(0.5, second)
    right.leave(1.0)
    right.idle(0.2)
    right.alternative = tuple(replace(each, objects=each.objects[:1]) for each in right.steps)


def halt_on_the_way(s: Stage) -> None:
    """The hand stops in the air for most of a second before it goes on to the mug."""
    at_table(s, height=0.72, yaw_deg=75)
    mug = s.put("mug", shapes.vessel(0.045, 0.11), (0.62, 0.1))
    right = s.right(idle=0.2)
    right.go((0.32, -0.22, s.height + 0.25), 0.7)
    right.rest(0.8)
    right.reach(mug, "-y", 0.8, up=0.6, hold=0.5)
    right.leave(0.9)
    right.idle(0.2)


def short_halt_on_the_way(s: Stage) -> None:
    """The hand hesitates for a fifth of a second on its way, which parts nothing."""
    at_table(s, yaw_deg=200)
    mug = s.put("mug", shapes.vessel(0.045, 0.11), (0.62, 0.1))
    right = s.right(idle=0.2)
    right.go_without_step((0.32, -0.22, s.height + 0.25), 0.6)
    right.idle(0.1)
    right.reach(mug, "-y", 0.8, up=0.6, hold=0.6)
    right.leave(0.9)
    right.idle(0.2)


def halt_on_the_way_back(s: Stage) -> None:
    """After touching a box the hand stops half way, waits, and goes home."""
    at_table(s, height=0.85, yaw_deg=300, size=0.95)
    box = s.put("box", shapes.box(0.14, 0.14, 0.14), (0.6, -0.05))
    right = s.right(idle=0.2)
    right.reach(box, "-y", 0.9, hold=0.6)
    right.leave(0.8, to=(0.4, -0.45, s.height + 0.2), name="Withdraw")
    right.rest(0.9)
    right.go(None, 0.7)
    right.idle(0.2)
    right.alternative = other_names(right, Withdraw="ResumePosture")


def withdraw_to_another_place(s: Stage) -> None:
    """After touching a box the hand goes far from where it came from, and stays there."""
    at_table(s, yaw_deg=10)
    box = s.put("box", shapes.box(0.14, 0.14, 0.14), (0.55, -0.05))
    right = s.right(idle=0.2)
    right.reach(box, "-y", 0.9, hold=0.6)
    right.leave(1.0, to=(0.5, -0.6, s.height + 0.35), name="Withdraw")
    right.idle(0.2)


def wait_before_the_reach(s: Stage) -> None:
    """The hand waits for a second and a half before it does anything."""
    at_table(s, yaw_deg=-10)
    box = s.put("box", shapes.box(0.14, 0.14, 0.14), (0.6, -0.05))
    right = s.right()
    right.rest(1.5)
    right.reach(box, "-y", 0.9, hold=0.8)
    _, first, *others = right.steps
    right.alternative = (replace(first, start_s=0.0), *others)


def nothing_happens(s: Stage) -> None:
    """Both hands rest in the air in front of a mug and a box for three seconds."""
    at_table(s, height=0.7, yaw_deg=45)
    s.put("mug", shapes.vessel(0.042, 0.1), (0.55, -0.1))
    s.put("box", shapes.box(0.1, 0.1, 0.1), (0.6, 0.2))
    for hand in (s.right(), s.left()):
        hand.rest(3.0)


def hand_lies_on_the_table(s: Stage) -> None:
    """The hand lies on the table from the first frame to the last."""
    table = at_table(s, yaw_deg=110, depth=0.6, width=0.6)
    s.put("mug", shapes.vessel(0.042, 0.1), (0.8, 0.2))
    right = s.right()
    right.begin_at(table, "+z", up=1.0, fingers=(1.0, 0.0, 0.0))
    right.hold(2.5, table)


def pass_near_things(s: Stage) -> None:
    """The hand goes past a mug and over a box, five centimetres off, and touches neither."""
    at_table(s, yaw_deg=-75)
    s.put("mug", shapes.vessel(0.042, 0.1), (0.38, 0.02))
    s.put("box", shapes.box(0.12, 0.12, 0.06), (0.48, 0.18))
    right = s.right(home=(0.16, -0.3, s.height + 0.2), idle=0.2)
    right.go((0.4, 0.25, s.height + 0.21), 1.3)
    right.idle(0.2)


def there_and_back_in_the_air(s: Stage) -> None:
    """The left hand is held out in the air for a second and taken back; nothing is touched."""
    at_table(s, yaw_deg=170, size=1.05)
    s.put("bottle", shapes.bottle(), (0.7, 0.0))
    left = s.left(idle=0.2)
    left.go((0.5, 0.3, s.height + 0.3), 0.9)
    left.rest(1.0)
    left.go(None, 0.9)
    left.idle(0.2)


def touch_the_face(s: Stage) -> None:
    """The right hand touches the performer's own face."""
    at_table(s, yaw_deg=60)
    head = s.head()
    right = s.right(idle=0.2)
    right.reach(head, "+x", 0.9, fingers=UP)
    right.hold_oneself(0.8, head)
    right.leave(0.9)
    right.idle(0.2)


def hand_on_the_chest(s: Stage) -> None:
    """A hand is laid on the performer's own chest and stays there."""
    at_table(s, height=0.8, yaw_deg=-140)
    s.put("box", shapes.box(0.1, 0.1, 0.1), (0.6, 0.0))
    chest = s.chest()
    right = s.right(idle=0.2)
    right.reach(chest, "+x", 1.0, fingers=LEFTWARD)
    right.hold_oneself(1.2, chest)


def touch_a_shelf(s: Stage) -> None:
    """The left hand touches the front of a shelf above the table."""
    at_table(s, height=0.7, yaw_deg=330)
    shelf = s.put(
        "shelf", shapes.box(0.3, 0.8, 0.1, "shelf"), (0.75, 0.1, s.height + 0.35), tag="fixed"
    )
    left = s.left(idle=0.2)
    left.reach(shelf, "-x", 1.0, fingers=UP, hold=0.6)
    left.leave(1.0)
    left.idle(0.2)
