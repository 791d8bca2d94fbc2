"""Scenes in which both hands act, together or each on its own."""

from scenes.hands import shapes
from scenes.hands.paths import UP
from scenes.hands.performer import Hand, travel
from scenes.hands.scene import at_table, performer
from scenes.hands.scenes_place import brick, cup, fetch, finish
from scenes.hands.stage import Stage, other_names
from scenes.hands.things import Thing


def both_reach(s: Stage, thing: Thing, duration: float, up: float, hold: float) -> list[Hand]:
    """Both hands take a thing between them at the same time and hold it."""
    hands = [s.right(), s.left()]
    for hand, side in zip(hands, ("-y", "+y"), strict=True):
        hand.idle(0.2)
        hand.reach(thing, side, duration, up=up)
        if hold:
            hand.hold(hold, thing)
    return hands


def both_leave(hands: list[Hand], duration: float) -> None:
    """Both hands go home at the same time."""
    for hand in hands:
        hand.leave(duration)
        hand.idle(0.2)


def lift_a_box_with_both_hands(s: Stage) -> None:
    """A large box is lifted by both hands, held for half a second and put back."""
    table, box = at_table(s, yaw_deg=30), s.put("box", shapes.box(0.25, 0.35, 0.2), (0.55, 0.0))
    hands = both_reach(s, box, 0.9, 0.5, 0.4)
    right, left = hands
    since = len(right.steps)
    left.join(box)
    right.take(box)
    travel(right, "Lift", (0.0, 0.0, 0.25), 0.9, box, hold=0.6)
    travel(right, "Lower", (0.0, 0.0, -0.25), 1.0, box, table, hold=0.4)
    left.part(right, since)
    both_leave(hands, 0.9)


def move_a_box_with_both_hands(s: Stage) -> None:
    """A box is taken to the other end of the table in one sweep, without any hold."""
    performer(s, height=0.85, yaw_deg=-115, size=1.07)
    table, box = s.table(), s.put("box", shapes.box(0.2, 0.26, 0.16), (0.5, -0.2))
    hands = both_reach(s, box, 1.0, 0.5, 0.0)
    right, left = hands
    since = len(right.steps)
    left.join(box)
    right.take(box)
    right.lift_carry_lower(box, table, up=0.2, by=(0.1, 0.4), down=0.2)
    left.part(right, since)
    both_leave(hands, 1.0)


def carry_a_tray_with_cups(s: Stage) -> None:
    """Both hands carry a tray with two cups on it to the left."""
    table, tray = at_table(s, yaw_deg=160), s.put("tray", shapes.tray(0.28, 0.36), (0.55, -0.2))
    cups = [
        s.put(name, shapes.vessel(0.035, 0.08, "cup"), (0.55, y, s.height + 0.008))
        for name, y in (("first_cup", -0.28), ("second_cup", -0.12))
    ]
    hands = both_reach(s, tray, 1.05, 0.75, 0.4)
    right, left = hands
    since = len(right.steps)
    left.join(tray)
    right.take(tray, *cups)
    right.lift_carry_lower(tray, table, up=0.16, by=(0.05, 0.4), down=0.16, times=(0.9, 1.3, 0.9))
    right.hold(0.4, tray, table)
    left.part(right, since)
    both_leave(hands, 0.9)


def carry_a_carton_with_a_ball(s: Stage) -> None:
    """Both hands carry a carton with a ball in it away from the body, pausing in the air."""
    performer(s, height=0.65, yaw_deg=-40, size=0.95)
    table, carton = s.table(), s.put("carton", shapes.carton(0.22, 0.3, 0.15), (0.45, 0.0))
    ball = s.put("ball", shapes.ball(0.05), (0.48, 0.05, s.height + 0.056))
    hands = both_reach(s, carton, 0.9, 0.5, 0.5)
    right, left = hands
    since = len(right.steps)
    left.join(carton)
    right.take(carton, ball)
    travel(right, "Lift", (0.0, 0.0, 0.2), 0.9, carton, hold=0.5)
    travel(right, "Carry", (0.35, 0.0, 0.0), 1.1, carton, hold=0.4)
    travel(right, "Lower", (0.0, 0.0, -0.2), 0.9, carton, table, hold=0.4)
    left.part(right, since)
    both_leave(hands, 1.0)


def push_with_both_hands(s: Stage) -> None:
    """A wide box is pushed away by both palms behind it."""
    table, box = at_table(s, yaw_deg=85), s.put("box", shapes.box(0.2, 0.5, 0.18), (0.5, 0.0))
    hands = [s.right(), s.left()]
    for hand, aside in zip(hands, (-0.13, 0.13), strict=True):
        hand.idle(0.2)
        hand.reach(box, "-x", 0.8, fingers=UP, aside=(0.0, aside, 0.0), hold=0.4)
    right, left = hands
    since = len(right.steps)
    left.join(box)
    right.take(box)
    travel(right, "Push", (0.25, 0.0, 0.0), 1.0, box, table, hold=0.4)
    left.part(right, since)
    both_leave(hands, 0.9)


def two_things_at_once(s: Stage) -> None:
    """The right hand moves a mug, and the left a block, at the same time."""
    table, mug, toy = at_table(s, yaw_deg=-65), cup(s, (0.5, -0.45)), brick(s, (0.5, 0.45))
    right, left = s.right(), s.left()
    right.idle(0.2)
    fetch(right, mug, "-y", 0.9, 0.6, 0.3)
    right.lift_carry_lower(mug, table, up=0.16, by=(0.25, 0.25), down=0.16)
    finish(right, mug, table, 0.5, 0.9)
    left.idle(0.2)
    fetch(left, toy, "+y", 0.8, 0.7, 0.5)
    left.lift_carry_lower(toy, table, up=0.2, by=(0.25, -0.25), down=0.2)
    finish(left, toy, table, 0.3, 0.9)


def steady_a_carton_and_fill_it(s: Stage) -> None:
    """The left hand steadies a carton while the right hand puts a ball into it."""
    at_table(s, height=0.78, yaw_deg=210)
    carton = s.put("carton", shapes.carton(0.3, 0.28, 0.13), (0.6, 0.15))
    ball = s.put("ball", shapes.ball(0.035), (0.5, -0.25, s.height + 0.035))
    left, right = s.left(), s.right(shapes.gripping_hand(0.11, 0.05))
    right.idle(0.2)
    fetch(right, ball, "+z", 0.9, 1.0, 0.4)
    right.lift_carry_lower(ball, carton, up=0.28, by=(0.1, 0.4), down=0.274)
    finish(right, ball, carton, 0.4, 1.2)
    left.idle(0.2)
    left.reach(carton, "+y", 0.8)
    left.hold(right.clock - 1.15 - left.clock, carton)
    left.leave(0.7)
    left.idle(0.2)


def one_hand_acts_and_one_rests(s: Stage) -> None:
    """The right hand moves a block; the left hand rests in the air all the while."""
    table, toy = at_table(s, height=0.75, yaw_deg=-125), brick(s, (0.45, -0.3))
    right, left = s.right(), s.left()
    right.idle(0.2)
    fetch(right, toy, "-y", 0.9, 0.7, 0.3)
    right.lift_carry_lower(toy, table, up=0.2, by=(0.3, 0.2), down=0.2)
    finish(right, toy, table, 0.3, 0.9)
    left.rest(right.clock)


def one_hand_lies_and_one_lifts(s: Stage) -> None:
    """The left hand lies on the table throughout; the right hand lifts a mug and keeps it."""
    table, mug = at_table(s, height=0.74, yaw_deg=140), cup(s, (0.5, -0.2))
    right, left = s.right(), s.left()
    left.begin_at(table, "+z", up=1.0, fingers=(1.0, 0.0, 0.0), aside=(-0.15, 0.35, 0.0))
    right.idle(0.2)
    fetch(right, mug, "-y", 0.9, 0.6, 0.4)
    travel(right, "Lift", (0.0, 0.0, 0.2), 0.8, mug, hold=1.0)
    left.hold(right.clock, table)


def push_and_lift_at_once(s: Stage) -> None:
    """The left hand pushes a box away while the right hand takes a mug over to its side."""
    table, mug = at_table(s, yaw_deg=0, size=1.02), cup(s, (0.75, -0.5))
    box = s.put("box", shapes.box(0.14, 0.18, 0.14), (0.48, 0.35))
    right, left = s.right(), s.left()
    right.idle(0.2)
    fetch(right, mug, "-y", 0.9, 0.6, 0.3)
    right.lift_carry_lower(mug, table, up=0.15, by=(-0.2, 0.35), down=0.15)
    finish(right, mug, table, 0.3, 0.9)
    left.idle(0.2)
    left.reach(box, "-x", 0.9, fingers=UP, hold=0.6)
    left.take(box)
    travel(left, "Push", (0.3, 0.0, 0.0), 1.1, box, table, hold=1.1)
    left.leave(1.0)
    left.idle(0.2)


def raise_together(s: Stage) -> None:
    """Both hands hold a box in the air from the first frame, raise it and keep it."""
    at_table(s, height=0.7, yaw_deg=55)
    box = s.put("box", shapes.box(0.2, 0.24, 0.16), (0.5, 0.0, s.height + 0.1))
    right, left = s.right(), s.left()
    for hand, side in ((right, "-y"), (left, "+y")):
        hand.begin_at(box, side, up=0.5, fingers=(1.0, 0.0, 0.0))
    left.join(box)
    right.take(box)
    right.hold(0.6, box)
    travel(right, "Raise", (0.0, 0.0, 0.35), 1.1, box, hold=0.7)
    left.part(right, 0)


def pass_from_right_to_left(s: Stage) -> None:
    """The right hand carries a ball to the left hand, which takes it and puts it down."""
    performer(s, yaw_deg=-55)
    pass_over(s, s.right(), s.left())


def pass_from_left_to_right(s: Stage) -> None:
    """The left hand carries a ball to the right hand, which takes it and puts it down."""
    performer(s, height=0.9, yaw_deg=100, size=1.06)
    pass_over(s, s.left(), s.right())


def pass_over(s: Stage, giver: Hand, taker: Hand) -> None:
    """One hand gives the other a ball that it holds from the first frame."""
    sign = -1.0 if giver.side == "right" else 1.0
    table = s.table()
    ball = s.put("ball", shapes.ball(0.06), (0.45, sign * 0.3, s.height + 0.28))
    sides = ("-y", "+y") if giver.side == "right" else ("+y", "-y")
    giver.begin_at(ball, sides[0], up=0.5, fingers=(1.0, 0.0, 0.0))
    giver.take(ball)
    giver.hold(0.4, ball)
    travel(giver, "Carry", (0.0, -sign * 0.28, 0.0), 0.8, ball)
    giver.clock += 0.3
    taker.idle(0.2)
    taker.reach(ball, sides[1], giver.clock - 0.2, name="Receive", when=giver.clock)
    giver.border = giver.steps[-1].end_s
    giver.hold(0.5, ball)
    taker.until(giver.clock)
    giver.leave(1.2, name="Give")
    giver.idle(0.2)
    taker.hold(0.4, ball)
    taker.take(ball)
    travel(taker, "Lower", (0.0, 0.0, -0.22), 0.8, ball, table)
    taker.hold(giver.clock - taker.clock, ball, table)
    giver.alternative = other_names(giver, Give="ResumePosture")
    taker.alternative = other_names(taker, Receive="Reach")
