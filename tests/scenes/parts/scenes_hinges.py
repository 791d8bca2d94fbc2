"""Laptops, boxes with lids, waffle irons and folders: opened, shut, carried, pushed and touched."""

from scenes.hands import shapes
from scenes.hands.paths import AHEAD, LEFTWARD, UP
from scenes.hands.performer import Hand, travel
from scenes.hands.scene import at_table
from scenes.hands.scenes_place import claw, cup, fetch, finish
from scenes.hands.stage import Stage
from scenes.hands.things import Thing
from scenes.household.scenes_vessels import narrow
from scenes.objects.builders import Grip, apple, home_again, paused, seize
from scenes.parts import builders as parts

BELOW = Grip((0.0, 0.0, 0.0), (0.0, 0.0, -1.0), AHEAD)
"""For a palm under a thing."""

RIM = Grip((-0.02, 0.16, 0.022), (0.0, 0.7, 0.7), AHEAD)
"""The upper left edge of a laptop's base."""


def stand(s: Stage, at: tuple[float, float], name: str = "stand") -> Thing:
    """A fixed block on the table on which flat things stand free."""
    return s.put(name, shapes.box(0.2, 0.2, 0.12, "stand"), at, tag="fixed")


def steady(hand: Hand, other: Hand, thing: Thing, duration: float, site: Grip | str) -> None:
    """Lie on a thing from early on until the other hand, which has finished, goes home."""
    hand.idle(0.2)
    if isinstance(site, Grip):
        seize(hand, thing, site, duration, take=False)
    else:
        hand.reach(thing, site, duration, up=0.5)
    hand.hold(other.steps[-1].start_s - hand.clock, thing)
    hand.leave(0.8)
    late = hand.clock - other.clock
    if late < -0.3:
        hand.rest(max(-late, 0.45))
    elif late > 0.15:
        other.rest(max(late, 0.25))


def take_lid(hand: Hand, pair: parts.Pair, duration: float = 0.9, hold: float = 0.4) -> None:
    """Reach the part and hold it, if that has a duration."""
    seize(hand, pair.part, pair.grip, duration, hold=hold, take=False)


def laptop_opened_by_a_finger(s: Stage) -> None:
    """A shut laptop's lid is turned up by its tab with one finger."""
    at_table(s, height=0.73, yaw_deg=31)
    pair = parts.laptop(s, (0.55, -0.05))
    right = s.right(shapes.pointing_hand(), idle=0.2)
    take_lid(right, pair)
    parts.work(right, pair, 105.0, 1.4, hold=0.5)
    home_again(right, 0.9)


def laptop_opened_while_the_left_finger_steadies_it(s: Stage) -> None:
    """The left finger lies on the edge of a laptop's base while the right one opens the lid."""
    at_table(s, height=0.7, yaw_deg=-118, size=1.05, agent="tall_woman")
    pair = parts.laptop(s, (0.56, 0.0))
    right, left = s.right(shapes.pointing_hand()), s.left(shapes.pointing_hand())
    right.rest(0.9)
    take_lid(right, pair, hold=0.3)
    parts.work(right, pair, 95.0, 1.2, hold=0.4)
    home_again(right, 0.9)
    steady(left, right, pair.base, 0.9, RIM)


def laptop_opened_in_stages_and_half_shut(s: Stage) -> None:
    """The left finger opens a lid by 45 degrees, then to 100, and shuts it to 40."""
    at_table(s, height=0.78, yaw_deg=84, size=0.94, agent="old_man")
    pair = parts.laptop(s, (0.52, 0.1), deep=0.2, wide=0.28).stated(closed=True)
    left = s.left(shapes.pointing_hand(), idle=0.2)
    take_lid(left, pair, 1.1, 0.3)
    for angle, hold in ((45.0, 0.7), (100.0, 1.2), (40.0, 0.5)):
        parts.work(left, pair, angle, 1.1, hold=hold)
    home_again(left, 1.0)


def laptop_shut_at_once(s: Stage) -> None:
    """A lid that stands at 98 degrees is shut by a finger at once on contact, and fast."""
    at_table(s, height=0.76, yaw_deg=-20)
    pair = parts.laptop(s, (0.58, -0.12), start=98.0)
    right = s.right(shapes.pointing_hand(), home=(0.2, -0.3, 1.15), idle=0.2)
    take_lid(right, pair, 0.8, 0.0)
    parts.work(right, pair, 0.0, 0.7, hold=0.6)


def laptop_opened_and_carried_open(s: Stage) -> None:
    """The right palm opens a laptop on a stand; both palms carry it open to another stand."""
    at_table(s, height=0.66, yaw_deg=140, size=1.03)
    stand(s, (0.44, 0.0))
    goal = stand(s, (0.76, 0.0), "far_stand")
    pair = parts.laptop(s, (0.44, 0.0, s.height + 0.12))
    hands = right, left = s.right(), s.left()
    right.idle(0.2)
    take_lid(right, pair)
    parts.work(right, pair, 90.0, 1.2, hold=0.3)
    right.leave(1.0)
    right.idle(0.2)
    left.rest(right.clock)
    since = parts.both_palms(s, hands, pair.base, 1.0, 0.5)
    paused(right, pair.base, goal, up=0.15, by=(0.32, 0.0), down=0.15, holds=(0.4, 0.0))
    right.hold(0.4, pair.base, goal)
    parts.both_off(hands, since)


def laptop_with_a_mug_on_its_lid(s: Stage) -> None:
    """A mug is put on a shut laptop's lid and goes along when both palms carry the laptop."""
    at_table(s, height=0.72, yaw_deg=12, size=1.04)
    stand(s, (0.44, 0.02))
    goal = stand(s, (0.78, 0.02), "far_stand")
    pair = parts.laptop(s, (0.44, 0.02, s.height + 0.12)).stated()
    mug = cup(s, (0.4, -0.36))
    hands = right, left = s.right(), s.left()
    right.idle(0.2)
    fetch(right, mug, "-y", 0.9, 0.6, 0.3)
    lid = 0.12 + 0.022 + 0.008 - 0.0006
    right.lift_carry_lower(mug, pair.part, up=0.28, by=(0.06, 0.36), down=0.28 - lid)
    finish(right, mug, pair.part, 0.4, 1.0)
    left.rest(right.clock)
    since = parts.both_palms(s, hands, pair.base, 1.0, 0.5)
    parts.aboard(mug, pair.part, right.clock)
    paused(right, pair.base, goal, up=0.12, by=(0.34, 0.0), down=0.12, holds=(0.4, 0.5))
    right.hold(0.4, pair.base, goal)
    parts.both_off(hands, since)


def shut_box_pushed_away(s: Stage) -> None:
    """A fist at the near side of a shut box pushes it away over the table."""
    table = at_table(s, height=0.75, yaw_deg=-147)
    pair = parts.box(s, (0.5, -0.05)).stated()
    right = s.right(parts.fist(), idle=0.2)
    right.reach(pair.base, "-x", 0.9, up=0.45, fingers=LEFTWARD, hold=0.4)
    right.take(pair.base)
    travel(right, "Push", (0.22, 0.0, 0.0), 1.0, pair.base, table, hold=0.4)
    home_again(right, 1.0)


def box_opened_and_shut(s: Stage) -> None:
    """A box's lid is turned up by its lip, held for a second and let down again."""
    at_table(s, height=0.62, yaw_deg=55)
    pair = parts.box(s, (0.58, -0.1))
    right = s.right(narrow(), idle=0.2)
    take_lid(right, pair, 0.9, 0.3)
    parts.work(right, pair, 80.0, 1.2, hold=1.0)
    parts.work(right, pair, 0.0, 1.2, hold=0.4)
    home_again(right, 0.8)


def box_opened_while_the_other_palm_steadies_it(s: Stage) -> None:
    """The right palm lies on a box's side while the left hand opens the lid."""
    at_table(s, height=0.6, yaw_deg=-92, size=0.9, agent="girl")
    pair = parts.box(s, (0.55, 0.08), wide=0.26)
    left, right = s.left(narrow()), s.right()
    left.rest(0.8)
    take_lid(left, pair, 0.9, 0.4)
    parts.work(left, pair, 65.0, 1.1, hold=0.5)
    home_again(left, 0.9)
    steady(right, left, pair.base, 0.8, "-y")


def box_opened_by_one_hand_and_shut_by_the_other(s: Stage) -> None:
    """The right hand opens a box and goes home; the left palm presses the lid down from above."""
    at_table(s, height=0.64, yaw_deg=163, size=1.02)
    pair = parts.box(s, (0.6, 0.05), high=0.14).stated(closed=True)
    right, left = s.right(narrow(), idle=0.2), s.left(home=(0.15, 0.35, s.height + 0.45))
    take_lid(right, pair, 0.9, 0.3)
    parts.work(right, pair, 48.0, 1.0, hold=0.3)
    right.leave(0.9)
    left.rest(right.clock)
    seize(left, pair.part, pair.face, 1.1, hold=0.4, take=False)
    parts.work(left, pair, 0.0, 1.0, hold=0.4)
    home_again(left, 0.9)
    right.rest(left.clock - right.clock)


def box_opened_shut_and_carried_by_its_lip(s: Stage) -> None:
    """A lid is opened and shut, and by its lip the whole box is then carried aside."""
    table = at_table(s, height=0.58, yaw_deg=7)
    pair = parts.box(s, (0.56, -0.2), deep=0.18, wide=0.2, high=0.1)
    right = s.right(narrow(), idle=0.2)
    take_lid(right, pair, 0.9, 0.4)
    parts.work(right, pair, 60.0, 1.0, hold=0.4)
    parts.work(right, pair, 0.0, 1.0, hold=0.6)
    right.take(pair.base)
    right.lift_carry_lower(pair.base, table, up=0.15, by=(0.05, 0.4), down=0.15)
    right.hold(0.4, pair.base, table)
    home_again(right, 0.9)


def shut_box_carried_by_its_lip(s: Stage) -> None:
    """The left hand lifts a shut box by its lid's lip, pauses in the air and sets it down."""
    table = at_table(s, height=0.72, yaw_deg=-30, size=1.06, agent="tall_man")
    pair = parts.box(s, (0.6, 0.3), deep=0.16, wide=0.22, high=0.11).stated(closed=True)
    left = s.left(narrow(), idle=0.2)
    take_lid(left, pair, 0.9, 0.3)
    left.take(pair.base)
    paused(left, pair.base, table, up=0.18, by=(0.0, -0.4), down=0.18, holds=(0.5, 0.5))
    left.hold(0.5, pair.base, table)
    home_again(left, 1.0)


def box_on_one_palm_opened_by_the_other_hand(s: Stage) -> None:
    """The left palm bears a box in the air throughout; the right hand opens its lid and leaves."""
    at_table(s, height=0.66, yaw_deg=109)
    pair = parts.box(s, (0.52, 0.1, s.height + 0.2), deep=0.16, wide=0.22, high=0.09)
    left, right = s.left(), s.right(narrow())
    parts.bear(left, pair, BELOW)
    right.idle(0.2)
    take_lid(right, pair, 1.0, 0.5)
    parts.work(right, pair, 85.0, 1.1, hold=0.5)
    home_again(right, 0.9)
    left.hold(right.clock, pair.base)


def box_opened_while_it_is_carried(s: Stage) -> None:
    """The left palm carries a box to the right while the right hand opens it on the way."""
    at_table(s, height=0.7, yaw_deg=-48, size=0.98)
    pair = parts.box(s, (0.5, 0.25, s.height + 0.18), deep=0.16, wide=0.2, high=0.09).stated()
    left, right = s.left(), s.right(narrow())
    parts.bear(left, pair, BELOW)
    right.idle(0.2)
    take_lid(right, pair, 1.1, 0.4)
    left.hold(right.clock, pair.base)
    travel(left, "Carry", (0.03, -0.25, 0.0), 1.4, pair.base, hold=0.8)
    parts.work(right, pair, 75.0, 1.4, hold=0.8)


def apple_shut_in_a_box_and_carried(s: Stage) -> None:
    """The right hand lays an apple in an open box; the left palm shuts the box and carries it."""
    table = at_table(s, height=0.65, yaw_deg=71)
    pair = parts.box(s, (0.6, 0.12), start=82.0, deep=0.3, wide=0.3, high=0.13)
    fruit = apple(s, (0.42, -0.35))
    right, left = s.right(claw()), s.left(home=(0.15, 0.4, s.height + 0.4))
    right.idle(0.2)
    right.reach(fruit, "+z", 0.9, up=1.0, fingers=LEFTWARD, hold=0.3)
    right.take(fruit)
    right.lift_carry_lower(fruit, pair.base, up=0.3, by=(0.16, 0.47), down=0.3 - 0.016)
    finish(right, fruit, pair.base, 0.3, 1.2)
    left.rest(right.clock - 0.3)
    seize(left, pair.part, pair.face, 1.1, hold=0.3, take=False)
    parts.work(left, pair, 0.0, 1.1, hold=0.4)
    left.leave(1.0)
    left.idle(0.2)
    fetch(left, pair.base, "+y", 1.0, 0.45, 0.3)
    parts.aboard(fruit, pair.base, left.clock)
    left.lift_carry_lower(pair.base, table, up=0.18, by=(0.0, -0.3), down=0.18)
    left.hold(0.5, pair.base, table)
    home_again(left, 1.0)
    right.rest(left.clock - right.clock)


def open_box_turned_on_the_table(s: Stage) -> None:
    """The left hand opens a box; then both palms turn it by forty degrees where it stands."""
    table = at_table(s, height=0.63, yaw_deg=-5, size=1.05)
    pair = parts.box(s, (0.55, 0.0), wide=0.24)
    right, left = s.right(parts.fist()), s.left(parts.fist())
    left.idle(0.2)
    take_lid(left, pair, 0.9, 0.3)
    parts.work(left, pair, 70.0, 1.1, hold=0.3)
    left.leave(0.9)
    left.idle(0.2)
    right.rest(left.clock)
    since = parts.both_palms(s, (right, left), pair.base, 1.0, 0.5)
    right.spin((0.55, 0.0, 0.0), UP, 40.0, 1.3)
    right.step("Turn", pair.base, table)
    right.hold(0.6, pair.base, table)
    left.part(right, since)


def shut_box_tilted_in_the_air(s: Stage) -> None:
    """One palm at the side of a box lifts it, tilts it by forty degrees and keeps it so."""
    at_table(s, height=0.74, yaw_deg=178)
    pair = parts.box(s, (0.5, -0.1), deep=0.12, wide=0.14, high=0.1).stated(closed=True)
    right = s.right(idle=0.2)
    fetch(right, pair.base, "-y", 0.9, 0.5, 0.4)
    travel(right, "Lift", (0.0, 0.0, 0.22), 0.9, pair.base, hold=0.5)
    right.spin((0.5, -0.1, s.height + 0.27), AHEAD, -40.0, 1.0)
    right.step("Tilt", pair.base)
    right.hold(0.7, pair.base)


def lid_that_is_never_shut(s: Stage) -> None:
    """A lid that stands half open is turned up by fifty degrees, and back; it is never shut."""
    at_table(s, height=0.6, yaw_deg=-77)
    pair = parts.box(s, (0.58, 0.05), start=35.0)
    left = s.left(narrow(), idle=0.2)
    take_lid(left, pair, 1.0, 0.4)
    parts.work(left, pair, 85.0, 1.2, hold=0.8)
    parts.work(left, pair, 45.0, 1.0, hold=0.4)
    home_again(left, 0.9)


def lid_that_is_never_shut_but_known(s: Stage) -> None:
    """A lid is turned up from thirty degrees and back to fifty; the capture says where it shuts."""
    at_table(s, height=0.61, yaw_deg=44, size=0.97)
    pair = parts.box(s, (0.56, -0.1), start=30.0, wide=0.26).stated(closed=True)
    right = s.right(narrow(), idle=0.2)
    take_lid(right, pair, 0.9, 0.3)
    parts.work(right, pair, 90.0, 1.2, hold=0.5)
    parts.work(right, pair, 50.0, 0.9, hold=0.4)
    home_again(right, 0.9)


def wide_lid_opened_by_both_hands(s: Stage) -> None:
    """Both fists turn up the lid of a wide box by its front edge."""
    at_table(s, height=0.56, yaw_deg=-160)
    pair = parts.box(s, (0.6, 0.0), deep=0.24, wide=0.5, high=0.16).stated(closed=True)
    right, left = s.right(parts.fist()), s.left(parts.fist())
    for hand, y in ((right, -0.18), (left, 0.18)):
        hand.idle(0.2)
        edge = Grip((-0.24, y, 0.004), (-0.6, 0.0, 0.8), LEFTWARD)
        seize(hand, pair.part, edge, 1.0, hold=0.4, take=False)
    parts.work(right, pair, 55.0, 1.3, others=(left,), hold=0.5)
    for hand in (right, left):
        home_again(hand, 0.9)


def shut_lid_touched(s: Stage) -> None:
    """The left palm lies on a shut lid for a second and a half, and nothing moves."""
    at_table(s, height=0.55, yaw_deg=-111, size=0.86, agent="child")
    pair = parts.box(s, (0.5, 0.1)).stated()
    left = s.left(idle=0.2)
    seize(left, pair.part, pair.face, 0.9, hold=1.5, take=False)
    home_again(left, 0.9)


def box_pulled_near_by_its_lip(s: Stage) -> None:
    """A box is drawn near over the table by its lid's lip, and then opened."""
    table = at_table(s, height=0.6, yaw_deg=19)
    pair = parts.box(s, (0.74, -0.08), wide=0.24)
    right = s.right(narrow(), idle=0.2)
    take_lid(right, pair, 1.0, 0.4)
    right.take(pair.base)
    travel(right, "Pull", (-0.2, 0.0, 0.0), 1.0, pair.base, table)
    right.hold(0.5, pair.base, table)
    parts.free(right, pair.base)
    parts.work(right, pair, 60.0, 1.0, hold=0.5)
    home_again(right, 0.9)


def waffle_iron_opened_and_shut(s: Stage) -> None:
    """A waffle iron's cover is turned up by its handle, let go of, and shut after a rest."""
    at_table(s, height=0.69, yaw_deg=93, size=1.03)
    pair = parts.waffle_iron(s, (0.66, -0.05))
    right = s.right(narrow(), idle=0.2)
    take_lid(right, pair, 1.0, 0.3)
    parts.work(right, pair, 75.0, 1.4, hold=0.4)
    right.leave(1.0)
    right.rest(0.8)
    take_lid(right, pair, 1.0, 0.0)
    parts.work(right, pair, 0.0, 1.3, hold=0.5)


def folder_opened_to_the_left(s: Stage) -> None:
    """A finger at the right edge of a folder's cover turns it over to the left."""
    at_table(s, height=0.77, yaw_deg=-128)
    pair = parts.folder(s, (0.5, 0.0))
    right = s.right(shapes.pointing_hand(), idle=0.2)
    take_lid(right, pair, 0.9, 0.3)
    parts.work(right, pair, 125.0, 1.5, hold=0.4)
    home_again(right, 1.0)


def folder_on_one_palm_opened_and_shut(s: Stage) -> None:
    """The right palm bears a folder in the air; the left finger opens its cover and shuts it."""
    at_table(s, height=0.68, yaw_deg=150, size=1.06, agent="tall_man")
    pair = parts.folder(s, (0.5, -0.05, s.height + 0.25), way=-1.0).stated()
    right, left = s.right(), s.left(shapes.pointing_hand())
    parts.bear(right, pair, BELOW)
    left.idle(0.2)
    take_lid(left, pair, 0.9, 0.4)
    parts.work(left, pair, 100.0, 1.3, hold=0.9)
    parts.work(left, pair, 0.0, 1.2, hold=0.4)
    home_again(left, 0.9)
    right.hold(left.clock, pair.base)
