"""Scenes in which one hand takes something from one place to another, or holds it in the air."""

from scenes.hands import shapes
from scenes.hands.performer import Hand, travel
from scenes.hands.scene import at_table, performer
from scenes.hands.stage import Stage, other_names
from scenes.hands.things import Thing


def cup(s: Stage, at: tuple[float, ...], name: str = "mug") -> Thing:
    """A mug of the usual size."""
    return s.put(name, shapes.vessel(0.042, 0.1), at)


def brick(s: Stage, at: tuple[float, ...], name: str = "brick") -> Thing:
    """A block that a hand can take from above."""
    return s.put(name, shapes.box(0.07, 0.07, 0.09, "block"), at)


def claw() -> shapes.Form:
    """A hand that takes things of seven centimetres between fingers and thumb."""
    return shapes.gripping_hand(0.11, 0.05)


def fetch(hand: Hand, thing: Thing, side: str, duration: float, up: float, hold: float) -> None:
    """Reach a thing and take it, after a hold if that has a duration."""
    hand.reach(thing, side, duration, up=up)
    if hold:
        hand.hold(hold, thing)
    hand.take(thing)


def finish(hand: Hand, thing: Thing, goal: Thing, hold: float, duration: float) -> None:
    """Hold it where it was put, if that has a duration, and go home."""
    if hold:
        hand.hold(hold, thing, goal)
    hand.leave(duration)
    hand.idle(0.2)


def place_in_one_sweep(s: Stage) -> None:
    """The right hand takes a mug over to the left side, without any pause."""
    table, mug = s.table(), cup(s, (0.5, -0.3))
    right = s.right(idle=0.2)
    fetch(right, mug, "-y", 0.9, 0.6, 0.0)
    right.lift_carry_lower(mug, table, up=0.18, by=(0.05, 0.45), down=0.18)
    finish(right, mug, table, 0.0, 1.0)


def place_with_holds(s: Stage) -> None:
    """The mug is held for half a second before it is lifted and after it is put down."""
    performer(s, height=0.9, yaw_deg=130, size=1.06, agent="tall_man")
    table, mug = s.table(), cup(s, (0.55, -0.35))
    right = s.right(idle=0.2)
    fetch(right, mug, "-y", 0.9, 0.6, 0.5)
    right.lift_carry_lower(mug, table, up=0.15, by=(0.0, 0.5), down=0.15)
    finish(right, mug, table, 0.5, 1.0)


def place_with_pauses_in_the_air(s: Stage) -> None:
    """The mug is lifted, held, carried, held and lowered."""
    table, mug = at_table(s, yaw_deg=-45), cup(s, (0.5, -0.25))
    right = s.right(idle=0.2)
    fetch(right, mug, "-y", 0.9, 0.6, 0.4)
    travel(right, "Lift", (0.0, 0.0, 0.2), 0.8, mug, hold=0.5)
    travel(right, "Carry", (0.1, 0.4, 0.0), 0.9, mug, hold=0.5)
    travel(right, "Lower", (0.0, 0.0, -0.2), 0.8, mug, table)
    finish(right, mug, table, 0.4, 0.9)


def place_slowly_with_long_pauses(s: Stage) -> None:
    """An old woman pauses for one to two seconds wherever she can."""
    performer(s, height=0.7, yaw_deg=215, size=0.93, agent="old_woman")
    table, mug = s.table(), cup(s, (0.48, -0.2))
    right = s.right(idle=0.2)
    fetch(right, mug, "-y", 1.6, 0.6, 1.5)
    travel(right, "Lift", (0.0, 0.0, 0.16), 1.1, mug, hold=2.0)
    travel(right, "Carry", (0.05, 0.38, 0.0), 1.5, mug, hold=1.2)
    travel(right, "Lower", (0.0, 0.0, -0.16), 1.2, mug, table)
    finish(right, mug, table, 1.8, 1.6)


def child_places_quickly(s: Stage) -> None:
    """A child snatches a block with the left hand and puts it elsewhere on a low table."""
    performer(s, height=0.48, yaw_deg=80, size=0.75, agent="child", offset=(0.5, 3.0))
    table, toy = s.table(), s.put("brick", shapes.box(0.05, 0.05, 0.08, "block"), (0.5, 0.2))
    left = s.left(idle=0.1)
    fetch(left, toy, "+y", 0.6, 0.7, 0.0)
    left.lift_carry_lower(toy, table, up=0.14, by=(0.0, -0.32), down=0.14, times=(0.45, 0.6, 0.45))
    finish(left, toy, table, 0.0, 0.6)


def place_with_the_left_hand(s: Stage) -> None:
    """The left hand takes a bottle from the far to the near right; short holds."""
    performer(s, height=1.05, yaw_deg=-100, size=1.08)
    table, flask = s.table(), s.put("bottle", shapes.bottle(), (0.8, 0.3))
    left = s.left(idle=0.2)
    fetch(left, flask, "+y", 1.0, 0.4, 0.3)
    left.lift_carry_lower(flask, table, up=0.2, by=(-0.3, -0.3), down=0.2)
    finish(left, flask, table, 0.3, 1.0)


def take_from_above(s: Stage) -> None:
    """A block is taken from above, lifted high, carried away from the body and put down."""
    table, toy = at_table(s, yaw_deg=5), brick(s, (0.45, -0.25))
    right = s.right(claw(), idle=0.2)
    fetch(right, toy, "+z", 0.9, 1.0, 0.35)
    right.lift_carry_lower(toy, table, up=0.3, by=(0.35, 0.1), down=0.3, times=(0.9, 0.9, 0.9))
    finish(right, toy, table, 0.3, 1.0)


def lift_and_keep(s: Stage) -> None:
    """A mug is lifted and held in the air until the end."""
    at_table(s, height=0.76, yaw_deg=260)
    mug = cup(s, (0.55, -0.1))
    right = s.right(idle=0.2)
    fetch(right, mug, "-y", 0.9, 0.6, 0.5)
    travel(right, "Lift", (0.0, 0.0, 0.25), 0.9, mug, hold=1.0)


def lift_and_put_back(s: Stage) -> None:
    """A box is lifted straight up, held for a second and put back."""
    performer(s, height=0.6, yaw_deg=33)
    table, box = s.table(), s.put("box", shapes.box(0.1, 0.08, 0.12), (0.5, -0.1))
    right = s.right(idle=0.2)
    fetch(right, box, "-y", 0.8, 0.6, 0.3)
    travel(right, "Lift", (0.0, 0.0, 0.22), 0.8, box, hold=1.0)
    travel(right, "Lower", (0.0, 0.0, -0.22), 0.9, box, table)
    finish(right, box, table, 0.4, 0.8)


def up_and_down_in_one_arc(s: Stage) -> None:
    """A mug goes up thirty centimetres and down again at once, only eight to the side."""
    table, mug = at_table(s, yaw_deg=-20), cup(s, (0.5, -0.1))
    right = s.right(idle=0.2)
    fetch(right, mug, "-y", 0.9, 0.6, 0.4)
    highest = right.hop(0.3, (0.0, 0.08, 0.0), 1.4)
    end, right.clock = right.clock, highest
    right.step("Lift", mug)
    right.clock = end
    right.step("Lower", mug, table)
    finish(right, mug, table, 0.4, 0.9)


def flat_arc(s: Stage) -> None:
    """A mug is moved forty centimetres to the side and never rises above three."""
    table, mug = at_table(s, yaw_deg=145), cup(s, (0.5, -0.25))
    right = s.right(idle=0.2)
    fetch(right, mug, "-y", 0.9, 0.6, 0.4)
    right.hop(0.03, (0.05, 0.4, 0.0), 1.0)
    right.step("MoveObjTo", mug, table)
    finish(right, mug, table, 0.4, 0.9)
    right.alternative = other_names(right, MoveObjTo="PutDown")


def rounder_arc(s: Stage) -> None:
    """A block is moved forty-five centimetres away in an arc that rises eight."""
    table, toy = at_table(s, height=0.85, yaw_deg=-160), brick(s, (0.42, -0.15))
    right = s.right(idle=0.2)
    fetch(right, toy, "-y", 0.9, 0.7, 0.0)
    right.hop(0.08, (0.45, 0.1, 0.0), 1.1)
    right.step("MoveObjTo", toy, table)
    finish(right, toy, table, 0.3, 0.9)
    right.alternative = other_names(right, MoveObjTo="PutDown")


def put_on_a_shelf(s: Stage) -> None:
    """A mug goes from the table over the edge of a shelf and down on it."""
    at_table(s, height=0.7, yaw_deg=15, size=1.05)
    shelf = s.put(
        "shelf", shapes.box(0.4, 0.4, 0.02, "shelf"), (0.75, 0.4, s.height + 0.28), tag="fixed"
    )
    mug = cup(s, (0.5, -0.25))
    right = s.right(idle=0.2)
    fetch(right, mug, "-y", 0.9, 0.6, 0.4)
    right.lift_carry_lower(mug, shelf, up=0.42, by=(0.2, 0.6), down=0.12, times=(1.0, 1.1, 0.6))
    finish(right, mug, shelf, 0.4, 1.3)


def take_from_a_shelf(s: Stage) -> None:
    """A box is taken from a shelf and put on the table, with a pause in the air before it sinks."""
    table = at_table(s, height=0.72, yaw_deg=280)
    s.put("shelf", shapes.box(0.3, 0.3, 0.02, "shelf"), (0.7, 0.45, s.height + 0.3), tag="fixed")
    box = s.put("box", shapes.box(0.1, 0.08, 0.12), (0.68, 0.4, s.height + 0.32))
    right = s.right(idle=0.2)
    fetch(right, box, "-y", 1.1, 0.6, 0.4)
    travel(right, "Lift", (0.0, 0.0, 0.12), 0.6, box, hold=0.4)
    travel(right, "Carry", (-0.18, -0.5, 0.0), 1.0, box, hold=0.4)
    travel(right, "Lower", (0.0, 0.0, -0.44), 1.1, box, table)
    finish(right, box, table, 0.4, 0.9)


def stack_on_a_box(s: Stage) -> None:
    """A block is put on top of a box."""
    at_table(s, yaw_deg=120)
    box = s.put("box", shapes.box(0.18, 0.18, 0.12), (0.6, 0.2))
    toy = brick(s, (0.5, -0.25))
    right = s.right(idle=0.2)
    fetch(right, toy, "-y", 0.9, 0.7, 0.35)
    right.lift_carry_lower(toy, box, up=0.26, by=(0.1, 0.43), down=0.14)
    finish(right, toy, box, 0.35, 1.0)


def take_off_a_box(s: Stage) -> None:
    """A block is taken off a box with the left hand and put on the table."""
    table = at_table(s, height=0.95, yaw_deg=-15, size=1.05)
    s.put("box", shapes.box(0.2, 0.2, 0.1), (0.7, 0.3))
    toy = brick(s, (0.7, 0.3, s.height + 0.1))
    left = s.left(idle=0.2)
    fetch(left, toy, "+y", 0.9, 0.7, 0.3)
    left.lift_carry_lower(toy, table, up=0.12, by=(-0.2, -0.45), down=0.22)
    finish(left, toy, table, 0.3, 1.0)


def ball_into_a_carton(s: Stage) -> None:
    """A ball is lowered into an open carton and left there."""
    at_table(s, yaw_deg=190)
    box = s.put("carton", shapes.carton(0.3, 0.28, 0.12), (0.6, 0.2))
    ball = s.put("ball", shapes.ball(0.035), (0.5, -0.25, s.height + 0.035))
    right = s.right(claw(), idle=0.2)
    fetch(right, ball, "+z", 0.9, 1.0, 0.3)
    right.lift_carry_lower(ball, box, up=0.26, by=(0.1, 0.45), down=0.254)
    finish(right, ball, box, 0.4, 1.1)


def ball_out_of_a_carton(s: Stage) -> None:
    """A ball is taken out of a carton and put on the table."""
    table = at_table(s, height=0.8, yaw_deg=-170)
    s.put("carton", shapes.carton(0.3, 0.28, 0.1), (0.6, -0.25))
    ball = s.put("ball", shapes.ball(0.04), (0.6, -0.25, s.height + 0.046))
    right = s.right(claw(), idle=0.2)
    fetch(right, ball, "+z", 1.0, 1.0, 0.4)
    right.lift_carry_lower(ball, table, up=0.25, by=(0.0, 0.45), down=0.256)
    finish(right, ball, table, 0.4, 1.1)


def ball_into_a_bowl(s: Stage) -> None:
    """A ball is put into a bowl with a pause above the opening."""
    at_table(s, yaw_deg=95)
    bowl = s.put("bowl", shapes.vessel(0.12, 0.08, "bowl"), (0.55, 0.25))
    ball = s.put("ball", shapes.ball(0.03), (0.5, -0.2, s.height + 0.03))
    right = s.right(claw(), idle=0.2)
    fetch(right, ball, "+z", 0.9, 1.0, 0.0)
    travel(right, "Lift", (0.0, 0.0, 0.2), 0.8, ball, hold=0.3)
    travel(right, "Carry", (0.05, 0.45, 0.0), 1.0, ball, hold=0.7)
    travel(right, "Lower", (0.0, 0.0, -0.195), 0.8, ball, bowl)
    finish(right, ball, bowl, 0.3, 1.1)


def put_down_and_lift_again(s: Stage) -> None:
    """A mug is put down, kept in hand for half a second, and carried on to a third place."""
    table, mug = at_table(s, yaw_deg=62), cup(s, (0.5, -0.4))
    right = s.right(idle=0.2)
    fetch(right, mug, "-y", 0.9, 0.6, 0.3)
    right.lift_carry_lower(mug, table, up=0.15, by=(0.05, 0.35), down=0.15)
    right.hold(0.5, mug, table)
    right.lift_carry_lower(mug, table, up=0.2, by=(0.1, 0.4), down=0.2)
    finish(right, mug, table, 0.3, 1.1)


def two_things_one_after_the_other(s: Stage) -> None:
    """First the mug, then, after a rest at home, the block."""
    performer(s, height=0.88, yaw_deg=-80)
    table, mug, toy = s.table(), cup(s, (0.5, -0.3)), brick(s, (0.7, -0.35))
    right = s.right(idle=0.2)
    fetch(right, mug, "-y", 0.9, 0.6, 0.0)
    right.lift_carry_lower(mug, table, up=0.15, by=(0.0, 0.5), down=0.15)
    right.leave(1.0)
    right.rest(0.7)
    fetch(right, toy, "-y", 0.9, 0.7, 0.3)
    right.lift_carry_lower(toy, table, up=0.18, by=(-0.05, 0.4), down=0.18)
    finish(right, toy, table, 0.3, 1.0)


def among_other_things(s: Stage) -> None:
    """One of five things is moved; the others stand close by and are not touched."""
    table, mug = at_table(s, yaw_deg=230, offset=(-2.0, 2.0)), cup(s, (0.5, -0.2))
    cup(s, (0.7, -0.15), "other_mug")
    brick(s, (0.62, 0.05))
    s.put("bottle", shapes.bottle(), (0.75, 0.3))
    s.put("plate", shapes.box(0.16, 0.16, 0.015, "plate"), (0.9, 0.0))
    right = s.right(idle=0.2)
    fetch(right, mug, "-y", 0.9, 0.6, 0.3)
    right.lift_carry_lower(mug, table, up=0.24, by=(-0.05, 0.5), down=0.24)
    finish(right, mug, table, 0.3, 1.0)


def put_down_and_withdraw(s: Stage) -> None:
    """A block is put down, and the hand goes to a place where it never was."""
    table, toy = at_table(s, yaw_deg=-50), brick(s, (0.45, -0.25))
    right = s.right(claw(), idle=0.2)
    fetch(right, toy, "+z", 0.9, 1.0, 0.0)
    right.lift_carry_lower(toy, table, up=0.2, by=(0.15, 0.4), down=0.2)
    right.hold(0.3, toy, table)
    right.leave(0.9, to=(0.75, -0.2, s.height + 0.35), name="Withdraw")
    right.idle(0.2)


def raise_and_lower_in_the_air(s: Stage) -> None:
    """A mug that is held from the first frame is raised, held and lowered again in the air."""
    at_table(s, yaw_deg=40)
    mug = cup(s, (0.5, -0.1, s.height + 0.15))
    right = s.right()
    right.begin_at(mug, "-y", up=0.6, fingers=(1.0, 0.0, 0.0))
    right.take(mug)
    right.hold(0.5, mug)
    travel(right, "Raise", (0.0, 0.0, 0.3), 1.0, mug, hold=0.6)
    travel(right, "Lower", (0.0, 0.0, -0.25), 1.0, mug, hold=0.5)


def carry_in_the_air(s: Stage) -> None:
    """A bottle that is held from the first frame is carried to the left and back."""
    at_table(s, height=0.65, yaw_deg=-110)
    flask = s.put("bottle", shapes.bottle(), (0.5, -0.3, s.height + 0.2))
    right = s.right()
    right.begin_at(flask, "-y", up=0.4, fingers=(1.0, 0.0, 0.0))
    right.take(flask)
    right.hold(0.6, flask)
    travel(right, "Carry", (0.1, 0.45, 0.0), 1.0, flask, hold=0.8)
    travel(right, "Carry", (-0.1, -0.4, 0.0), 1.1, flask, hold=0.5)


def rest_on_the_way_to_a_mug(s: Stage) -> None:
    """The hand rests on its way to a mug, takes it over and goes home."""
    table, mug = at_table(s, height=0.77, yaw_deg=-5, size=0.97), cup(s, (0.6, -0.25))
    right = s.right(idle=0.2)
    right.go((0.3, -0.35, s.height + 0.25), 0.7)
    right.rest(0.6)
    fetch(right, mug, "-y", 0.8, 0.6, 0.3)
    right.lift_carry_lower(mug, table, up=0.16, by=(-0.05, 0.45), down=0.16)
    finish(right, mug, table, 0.3, 1.0)
