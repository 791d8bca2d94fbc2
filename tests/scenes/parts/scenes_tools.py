"""Bottles with caps, scissors, pliers and staplers; and things that are no parts of each other."""

from scenes.hands import shapes
from scenes.hands.paths import AHEAD, LEFTWARD, UP
from scenes.hands.performer import Hand, travel
from scenes.hands.scene import at_table
from scenes.hands.scenes_place import brick, claw, cup, fetch
from scenes.hands.stage import Finger, Stage
from scenes.hands.things import Thing
from scenes.objects.builders import Grip, home_again, seize
from scenes.parts import builders as parts
from scenes.parts.scenes_hinges import stand, steady, take_lid

TAB = Grip((-0.056, -0.008, -0.002), (0.0, -0.7, -0.7), AHEAD)
"""The lower right edge of a cap's tab, for the thumb of a right hand."""

LEFT_TAB = Grip((-0.056, 0.008, -0.002), (0.0, 0.7, -0.7), AHEAD)
"""Its lower left edge."""


def bottle_opened_while_the_other_hand_holds_it(s: Stage) -> None:
    """The left palm holds a bottle on the table; the right finger turns its cap up by the tab."""
    at_table(s, height=0.71, yaw_deg=-57)
    pair = parts.bottle(s, (0.52, 0.02)).stated(closed=True)
    right, left = s.right(shapes.pointing_hand()), s.left()
    right.rest(0.8)
    take_lid(right, pair, 0.9, 0.3)
    parts.work(right, pair, 80.0, 0.7, hold=0.4)
    home_again(right, 0.9)
    steady(left, right, pair.base, 0.8, Grip((0.0, 0.034, 0.07), LEFTWARD, AHEAD))


def bottle_lifted_opened_and_poured(s: Stage) -> None:
    """The left hand lifts a bottle, the right finger opens its cap, and the left hand pours."""
    at_table(s, height=0.74, yaw_deg=102, size=1.04)
    pair = parts.bottle(s, (0.5, 0.22)).stated()
    s.put("bowl", shapes.vessel(0.085, 0.06, "bowl"), (0.5, 0.02))
    left, right = s.left(), s.right(shapes.pointing_hand())
    left.idle(0.2)
    fetch(left, pair.base, "+y", 0.9, 0.4, 0.3)
    travel(left, "Lift", (0.0, 0.0, 0.2), 0.8, pair.base)
    right.rest(left.clock)
    take_lid(right, pair, 1.0, 0.3)
    parts.work(right, pair, 95.0, 0.8, hold=0.3)
    right.leave(1.0)
    left.hold(right.clock - left.clock - 0.2, pair.base)
    left.dip((0.5, 0.22, s.height + 0.28), AHEAD, 105.0, 1.8)
    left.step("Pour", pair.base)
    left.hold(0.6, pair.base)
    right.rest(left.clock - right.clock)


def cap_opened_by_the_thumb_of_the_hand_that_carries(s: Stage) -> None:
    """A bottle that hangs in the right hand is carried, its cap opened and shut by the thumb."""
    at_table(s, height=0.7, yaw_deg=-2)
    pair = parts.bottle(s, (0.45, -0.25, s.height + 0.2))
    right = s.right()
    parts.bear(right, pair, Grip((0.0, -0.034, 0.07), (0.0, -1.0, 0.0), AHEAD))
    tip = parts.thumb(s, right, pair, TAB, parts.stump())
    right.hold(0.5, pair.base)
    travel(right, "Carry", (0.05, 0.2, 0.0), 0.9, pair.base, hold=0.5)
    parts.squeeze(tip, pair, 75.0, 0.7, hold=0.7)
    parts.squeeze(tip, pair, 0.0, 0.7, hold=0.5)


def cap_opened_by_the_thumb_on_the_table(s: Stage) -> None:
    """The left hand holds a bottle where it stands, opens its cap with the thumb and leaves."""
    at_table(s, height=0.78, yaw_deg=133, size=0.96)
    pair = parts.bottle(s, (0.5, 0.12))
    left = s.left(idle=0.2)
    grip = Grip((0.0, 0.034, 0.07), LEFTWARD, AHEAD)
    seize(left, pair.base, grip, 0.9, take=False)
    tip = parts.thumb(s, left, pair, LEFT_TAB, parts.stump(), (0.0, 0.03, -0.03))
    left.hold(0.5, pair.base)
    parts.squeeze(tip, pair, 70.0, 0.8, hold=0.6)
    parts.leave_tool(tip, 0.9, (0.0, 0.03, -0.03))


def cap_pressed_shut_by_a_finger(s: Stage) -> None:
    """A cap that stands up is pressed shut by its tab with one finger."""
    at_table(s, height=0.69, yaw_deg=-88)
    pair = parts.bottle(s, (0.54, -0.05), start=60.0)
    right = s.right(shapes.pointing_hand(), home=(0.15, -0.28, s.height + 0.3), idle=0.2)
    top = Grip((-0.054, 0.0, 0.006), UP, LEFTWARD)
    seize(right, pair.part, top, 0.9, hold=0.3, take=False)
    parts.work(right, pair, 0.0, 0.7, hold=0.4)
    home_again(right, 0.9)


def held(s: Stage, hand: Hand, pair: parts.Pair, way: float, size: float = 1.0) -> Finger:
    """Crossed levers that hang in a hand from the first frame on, with the thumb on the part."""
    parts.bear(hand, pair, parts.on_handle(way, size))
    return parts.thumb(s, hand, pair, pair.grip, parts.pad())


def scissors_opened_and_shut(s: Stage) -> None:
    """Scissors in the right hand are opened, rest, and are shut, in the air."""
    at_table(s, height=0.75, yaw_deg=47)
    pair = parts.crossed(s, (0.5, -0.12, s.height + 0.25), ("scissors", "blade"))
    right = s.right(parts.fist())
    tip = held(s, right, pair, 1.0)
    right.hold(0.6, pair.base)
    parts.squeeze(tip, pair, 30.0, 0.8, hold=0.8)
    parts.squeeze(tip, pair, 0.0, 0.7, hold=0.6)


def scissors_snip_twice_without_a_pause(s: Stage) -> None:
    """Scissors in the left hand open and shut twice in turn without any rest between."""
    at_table(s, height=0.72, yaw_deg=-155, size=1.05)
    pair = parts.crossed(s, (0.48, 0.1, s.height + 0.3), ("scissors", "blade"), way=-1.0).stated()
    left = s.left(parts.fist())
    tip = held(s, left, pair, -1.0)
    left.hold(0.7, pair.base)
    for angle in (32.0, 0.0, 32.0, 0.0):
        parts.squeeze(tip, pair, angle, 0.6)
    left.hold(0.7, pair.part, pair.base)


def from_a_rack(s: Stage, at: tuple[float, float], high: float, size: float = 1.0) -> Thing:
    """A narrow fixed block under the pivot of crossed levers, up to their lower side [m]."""
    form = shapes.box(0.05, 0.06, high - 0.006 * size, "rack")
    return s.put("rack", form, (at[0] + 0.01, at[1]), tag="fixed")


def scissors_taken_from_a_rack_and_opened(s: Stage) -> None:
    """Scissors are taken from a rack by their handle, carried, opened and shut in the air."""
    at_table(s, height=0.7, yaw_deg=76)
    pair = parts.crossed(s, (0.52, -0.2, s.height + 0.15), ("scissors", "blade"))
    from_a_rack(s, (0.52, -0.2), 0.15)
    right = s.right(parts.fist(), idle=0.2)
    seize(right, pair.base, parts.on_handle(), 0.9)
    tip = parts.thumb(s, right, pair, pair.grip, parts.pad(), (0.0, 0.06, 0.05))
    travel(right, "Lift", (0.0, 0.0, 0.15), 0.8, pair.base, hold=0.4)
    travel(right, "Carry", (0.0, 0.25, 0.0), 0.9, pair.base, hold=0.5)
    parts.squeeze(tip, pair, 28.0, 0.7, hold=0.5)
    parts.squeeze(tip, pair, 0.0, 0.7, hold=0.5)


def scissors_opened_while_they_are_carried(s: Stage) -> None:
    """Scissors in the right hand are carried to the left and opened in the same motion."""
    at_table(s, height=0.77, yaw_deg=-16, size=1.03)
    pair = parts.crossed(s, (0.48, -0.3, s.height + 0.22), ("scissors", "blade"))
    right = s.right(parts.fist())
    tip = held(s, right, pair, 1.0)
    right.hold(0.6, pair.base)
    parts.squeeze(tip, pair, 30.0, 1.0, by=(0.05, 0.25, 0.0), hold=0.8)
    parts.squeeze(tip, pair, 0.0, 0.8, hold=0.5)


def pliers_that_are_never_shut(s: Stage) -> None:
    """Pliers in the left hand are opened further and closed a little; their jaws never meet."""
    at_table(s, height=0.73, yaw_deg=118, size=0.97)
    at = (0.5, 0.15, s.height + 0.2)
    pair = parts.crossed(s, at, ("pliers", "jaw"), way=-1.0, start=8.0, jaws=True, size=1.2)
    left = s.left(parts.fist())
    tip = held(s, left, pair, -1.0, 1.2)
    left.hold(0.6, pair.base)
    parts.squeeze(tip, pair, 34.0, 0.8, hold=0.7)
    parts.squeeze(tip, pair, 12.0, 0.8, hold=0.6)


def pliers_worked_and_put_on_a_rack(s: Stage) -> None:
    """Pliers are opened and shut in the air and then lowered onto a rack and let go of."""
    at_table(s, height=0.66, yaw_deg=-43)
    pair = parts.crossed(s, (0.5, -0.1, s.height + 0.3), ("pliers", "jaw"), jaws=True).stated(
        closed=True
    )
    rack = from_a_rack(s, (0.5, -0.1), 0.14)
    right = s.right(parts.fist())
    tip = held(s, right, pair, 1.0)
    right.hold(0.5, pair.base)
    parts.squeeze(tip, pair, 26.0, 0.7, hold=0.4)
    parts.squeeze(tip, pair, 0.0, 0.7, hold=0.5)
    travel(right, "Lower", (0.0, 0.0, -0.16), 0.9, pair.base, rack)
    right.hold(0.4, pair.base, rack)
    parts.leave_tool(tip, 0.9, (0.0, 0.06, 0.05))


def stapler_pressed_on_the_table(s: Stage) -> None:
    """A flat palm presses a stapler's arm down and lets it come up again."""
    at_table(s, height=0.76, yaw_deg=15)
    pair = parts.stapler(s, (0.5, -0.1))
    right = s.right(idle=0.2)
    take_lid(right, pair, 0.9, 0.3)
    parts.work(right, pair, 0.0, 0.6, hold=0.4)
    parts.work(right, pair, 25.0, 0.6, hold=0.3)
    home_again(right, 0.9)


def stapler_pressed_in_the_hand(s: Stage) -> None:
    """A stapler lies on the left palm in the air; the thumb of that hand presses its arm."""
    at_table(s, height=0.68, yaw_deg=165)
    pair = parts.stapler(s, (0.45, 0.1, s.height + 0.25)).stated()
    left = s.left()
    parts.bear(left, pair, Grip((-0.02, 0.0, 0.0), (0.0, 0.0, -1.0), AHEAD))
    tip = parts.thumb(s, left, pair, pair.grip, parts.pad())
    left.hold(0.8, pair.base)
    parts.squeeze(tip, pair, 0.0, 0.5, hold=0.5)
    parts.squeeze(tip, pair, 25.0, 0.6, hold=0.6)


def slab(s: Stage, at: tuple[float, ...], name: str, size: tuple[float, float, float]) -> Thing:
    """A flat thing on which others move."""
    return s.put(name, shapes.box(*size, name), at)


def cup_pushed_over_a_tray_that_is_carried(s: Stage) -> None:
    """A mug is pushed straight over a flat tray; then both palms carry the tray with the mug."""
    at_table(s, height=0.65, yaw_deg=-26)
    stand(s, (0.46, 0.0))
    goal = stand(s, (0.8, 0.0), "far_stand")
    board = slab(s, (0.46, 0.0, s.height + 0.12), "tray", (0.28, 0.32, 0.02))
    mug = cup(s, (0.4, -0.02, s.height + 0.14))
    hands = right, left = s.right(), s.left()
    right.idle(0.2)
    right.reach(mug, "-x", 0.9, up=0.55, fingers=UP, hold=0.3)
    right.take(mug)
    travel(right, "Push", (0.1, 0.0, 0.0), 0.8, mug, board, hold=0.4)
    right.leave(0.9)
    right.idle(0.2)
    left.rest(right.clock)
    since = parts.both_palms(s, hands, board, 1.0, 0.5)
    parts.aboard(mug, board, right.clock)
    right.lift_carry_lower(board, goal, up=0.16, by=(0.34, 0.0), down=0.16)
    right.hold(0.4, board, goal)
    parts.both_off(hands, since)


def block_turned_on_a_board_that_is_pushed(s: Stage) -> None:
    """A block is turned in place on a board; then the left fist pushes the board away with it."""
    table = at_table(s, height=0.74, yaw_deg=68, size=1.02)
    board = slab(s, (0.5, 0.05), "board", (0.24, 0.3, 0.1))
    toy = brick(s, (0.52, 0.05, s.height + 0.1), "block")
    right, left = s.right(claw()), s.left(parts.fist())
    right.idle(0.2)
    fetch(right, toy, "+z", 0.9, 1.0, 0.3)
    right.spin((0.52, 0.05, 0.0), UP, 60.0, 1.0)
    right.step("Turn", toy, board)
    right.hold(0.4, toy, board)
    right.leave(0.9)
    left.rest(right.clock)
    left.reach(board, "-x", 0.9, fingers=LEFTWARD, hold=0.3)
    left.take(board)
    parts.aboard(toy, board, left.clock)
    travel(left, "Push", (0.2, 0.0, 0.0), 0.9, board, table, hold=0.4)
    home_again(left, 0.9)
    right.rest(left.clock - right.clock)


def book_slid_over_a_box_and_lifted_off(s: Stage) -> None:
    """A book is slid straight over a box's top, and then lifted off and laid on the table."""
    table = at_table(s, height=0.67, yaw_deg=-134)
    base = slab(s, (0.55, -0.2), "box", (0.24, 0.36, 0.1))
    book = slab(s, (0.55, -0.24, s.height + 0.1), "book", (0.2, 0.16, 0.04))
    right = s.right(idle=0.2)
    fetch(right, book, "+z", 0.9, 1.0, 0.3)
    travel(right, "Slide", (0.0, 0.1, 0.0), 0.8, book, base, hold=0.5)
    right.lift_carry_lower(book, table, up=0.15, by=(0.0, 0.4), down=0.25)
    right.hold(0.4, book, table)
    home_again(right, 0.9)
