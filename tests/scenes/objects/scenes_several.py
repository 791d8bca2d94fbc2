"""Scenes with more than one thing in a hand."""

from dataclasses import replace

from scenes.hands import shapes
from scenes.hands.performer import EASE, PRESS, Hand
from scenes.hands.scene import performer
from scenes.hands.scenes_place import claw
from scenes.hands.stage import Stage
from scenes.hands.things import Thing
from scenes.objects.builders import AHEAD, LEFTWARD, Grip, home_again, scene, travel

PALM_M, FINGERS_M = -0.01, 0.085
"""Where two cups lie along a hand, from its origin towards its fingers [m]."""

RADIUS_M = 0.03
"""Of these cups [m]."""


def also(hand: Hand, thing: Thing, since: float, until: float | None = None) -> None:
    """Note that a hand touches a second thing as well, from a time to another or to now [s]."""
    hand.contacts.append((thing, since, hand.clock if until is None else until))


def hold_both(hand: Hand, duration: float, *things: Thing) -> None:
    """Stay and touch two things with the hand itself: a Touch of both."""
    hand.clock += duration
    hand.step("Touch", *things)


def slim_cup(s: Stage, name: str, x: float, y: float, z: float) -> Thing:
    """A slim cup on the table or so far over it [m]."""
    form = shapes.vessel(RADIUS_M, 0.1, "cup")
    return s.put(name, form, (x, y, s.height + z))


@scene
def second_cup_taken(s: Stage) -> None:
    """A hand that holds a cup goes on to a second one, takes it too and lifts both."""
    performer(s, yaw_deg=-45)
    s.table()
    gap = 0.25
    first = slim_cup(s, "first_cup", 0.45, -0.2 - gap, 0.03)
    second = slim_cup(s, "second_cup", 0.45 + FINGERS_M - PALM_M, -0.2 - PRESS, 0.0)
    right = s.right()
    right.begin_at(first, "-y", up=0.6, fingers=AHEAD, aside=(-PALM_M, 0.0, 0.0))
    right.take(first)
    right.hold(0.5, first)
    right.move((0.0, gap, 0.0), 1.0, arrive=EASE)
    right.step("Carry", first, second)
    since = right.clock
    hold_both(right, 0.4, first, second)
    right.held.append(second.body.ride(right.body, right.clock))
    travel(right, "Lift", (0.0, 0.0, 0.2), 0.9, first, second)
    hold_both(right, 0.8, first, second)
    also(right, second, since)
    start, carry, *others = right.steps
    reach = replace(carry, name="Reach", objects=(second.name, first.name))
    right.alternative = (start, reach, *others)


@scene
def two_cups_lifted_at_once(s: Stage) -> None:
    """The left hand meets two cups at the same moment, lifts both and keeps them."""
    performer(s, height=0.85, yaw_deg=110, size=1.0)
    s.table()
    first = slim_cup(s, "first_cup", 0.45, 0.15, 0.0)
    second = slim_cup(s, "second_cup", 0.45 + FINGERS_M - PALM_M, 0.15 + PRESS, 0.0)
    left = s.left()
    left.idle(0.2)
    left.reach(first, "+y", 0.9, up=0.6, aside=(-PALM_M, 0.0, 0.0), others=(second,))
    since = left.clock
    hold_both(left, 0.4, first, second)
    left.take(first)
    left.held.append(second.body.ride(left.body, left.clock))
    travel(left, "Lift", (0.0, 0.0, 0.2), 0.9, first, second)
    hold_both(left, 0.9, first, second)
    also(left, second, since)


def blocks_on_the_palm(s: Stage, hand: Hand) -> tuple[Thing, Thing]:
    """Two blocks side by side on a palm that faces up, from the first frame."""
    place = (0.4, -0.2, s.height + 0.12)
    first = s.put("first_block", shapes.box(0.05, 0.05, 0.05, "block"), place)
    second = s.put("second_block", shapes.box(0.045, 0.05, 0.09, "block"), (0.465, *place[1:]))
    hand.body.first = Grip((0.01, 0.0, 0.0), (0.0, 0.0, -1.0), AHEAD).on(first, 0.0)
    hand.meet(first)
    hand.take(first)
    hand.held.append(second.body.ride(hand.body, 0.0))
    return first, second


@scene
def two_blocks_raised_on_the_palm(s: Stage) -> None:
    """Two blocks lie on the palm; both are raised, carried to the left and kept."""
    performer(s, height=0.7, yaw_deg=20)
    s.table()
    right = s.right()
    first, second = blocks_on_the_palm(s, right)
    hold_both(right, 0.5, first, second)
    travel(right, "Raise", (0.0, 0.0, 0.22), 0.9, first, second)
    hold_both(right, 0.5, first, second)
    travel(right, "Carry", (0.05, 0.3, 0.0), 1.0, first, second)
    hold_both(right, 0.6, first, second)
    also(right, second, 0.0)


@scene
def one_of_two_taken_away(s: Stage) -> None:
    """Two blocks are raised on the right palm; the left hand takes the taller one to the table."""
    performer(s, yaw_deg=-165)
    table = s.table()
    right, left = s.right(), s.left(claw())
    first, second = blocks_on_the_palm(s, right)
    hold_both(right, 0.5, first, second)
    travel(right, "Raise", (0.0, 0.0, 0.15), 0.8, first, second)
    raised = right.clock
    left.rest(raised + 0.3)
    left.reach(second, "+z", 1.1, up=1.0, fingers=LEFTWARD, name="Receive", when=raised)
    left.hold(0.5, second)
    right.held.pop().end = left.clock
    left.take(second)
    right.until(left.clock)
    right.step("Touch", first, second)
    also(right, second, 0.0)
    left.lift_carry_lower(second, table, up=0.15, by=(0.05, 0.4), down=0.42)
    left.hold(0.3, second, table)
    home_again(left, 1.0)
    right.hold(left.clock - right.clock, first)
    left.alternative = tuple(
        replace(each, name="Reach") if each.name == "Receive" else each for each in left.steps
    )
