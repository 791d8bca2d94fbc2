"""Scenes with drawers and doors that move along rails: in stages, loaded, by one hand or two."""

from scenes.hands.performer import Hand
from scenes.hands.scene import performer
from scenes.hands.scenes_place import claw, finish
from scenes.hands.shapes import Form, block
from scenes.hands.stage import Stage
from scenes.household.builders import Rail, dresser, plum, scene, sliding_cupboard, tin_box
from scenes.household.scenes_covers import narrow
from scenes.objects.builders import LEFTWARD, NEAR, UP, Grip, home_again, seize, travel


def draw(hand: Hand, rail: Rail, by: float, duration: float) -> None:
    """Draw a drawer out by a length, or push it in by a negative one [m]."""
    travel(hand, "Open" if by > 0 else "Close", (-by, 0.0, 0.0), duration, rail.part, rail.body)


def stay(hand: Hand, rail: Rail, duration: float) -> None:
    """Keep hold of what was moved on its rail."""
    hand.hold(duration, rail.part, rail.body)


def two_handled(rail: Rail) -> Form:
    """A drawer's form with a second and a third handle near its ends."""
    *parts, handle = rail.part.form.parts
    low, high = handle.bounds
    ends = [block((low[0], y - 0.004, low[2]), (high[0], y + 0.004, high[2])) for y in (-0.2, 0.2)]
    return Form("drawer", (*parts, *ends))


@scene
def upper_drawer_then_lower_drawer(s: Stage) -> None:
    """The upper of two drawers is opened and shut; after a rest the lower one is opened."""
    performer(s, height=0.68, yaw_deg=-24)
    s.table()
    low, high = dresser(s, (0.66, -0.12, s.height + 0.012), heights=(0.12, 0.12))
    right = s.right(narrow())
    right.idle(0.2)
    seize(right, high.part, high.grip, 0.9, hold=0.3)
    draw(right, high, 0.2, 0.9)
    stay(right, high, 0.6)
    draw(right, high, -0.2, 0.8)
    stay(right, high, 0.3)
    right.leave(0.8)
    right.rest(0.7)
    seize(right, low.part, low.grip, 0.9)
    draw(right, low, 0.18, 0.8)
    stay(right, low, 0.8)


@scene
def lower_drawer_in_three_stages(s: Stage) -> None:
    """A low drawer is drawn out by eight, six and ten centimetres, with unequal holds between."""
    performer(s, height=0.58, yaw_deg=113, size=0.9, agent="girl")
    s.table()
    low, _ = dresser(s, (0.64, 0.14, s.height + 0.012), heights=(0.14, 0.1))
    left = s.left(narrow())
    left.idle(0.15)
    seize(left, low.part, low.grip, 0.9, hold=0.5)
    for by, rest in ((0.08, 0.4), (0.06, 1.1), (0.1, 0.5)):
        draw(left, low, by, 0.6)
        stay(left, low, rest)
    home_again(left, 0.8)


@scene
def drawer_out_and_half_way_back(s: Stage) -> None:
    """A shut drawer is drawn out fast, and pushed half of the way back before it is let go of."""
    performer(s, height=0.83, yaw_deg=-139, size=1.07, agent="tall_man")
    s.table()
    (rail,) = dresser(s, (0.68, -0.08, s.height + 0.012), heights=(0.16,))
    right = s.right(narrow())
    right.idle(0.15)
    seize(right, rail.part, rail.grip, 0.8)
    draw(right, rail, 0.28, 0.5)
    stay(right, rail, 0.4)
    draw(right, rail, -0.14, 0.6)
    stay(right, rail, 0.4)
    home_again(right, 0.8)


@scene
def drawer_opened_by_one_hand_and_shut_by_the_other(s: Stage) -> None:
    """The left hand opens a drawer and goes home; the right palm pushes it shut by its front."""
    performer(s, height=0.74, yaw_deg=38)
    s.table()
    (rail,) = dresser(s, (0.7, 0.0, s.height + 0.012), heights=(0.15,), width=0.5)
    left, right = s.left(narrow()), s.right()
    left.idle(0.2)
    seize(left, rail.part, rail.grip, 0.9, hold=0.4)
    draw(left, rail, 0.24, 1.0)
    stay(left, rail, 0.3)
    left.leave(0.9)
    right.rest(left.clock)
    seize(right, rail.part, Grip((0.0, -0.15, 0.08), NEAR, LEFTWARD), 0.9, hold=0.3)
    draw(right, rail, -0.24, 0.9)
    stay(right, rail, 0.3)
    home_again(right, 0.9)
    left.rest(right.clock - left.clock)


@scene
def heavy_drawer_pushed_shut_with_the_palm(s: Stage) -> None:
    """A drawer with two tins is pushed slowly to half way, rests, and is pushed shut."""
    performer(s, height=0.64, yaw_deg=-85, size=0.94, agent="old_man")
    s.table()
    (rail,) = dresser(s, (0.7, -0.06, s.height + 0.012), heights=(0.17,), width=0.44)
    rail.part.body.first[0, 3] -= 0.26
    x, y, z = rail.part.body.first[:3, 3]
    tins = [
        tin_box(s, (x + back, y + 0.06, z + 0.008), name, (0.07, 0.07, 0.11))
        for name, back in (("round_tin", 0.08), ("square_tin", 0.2))
    ]
    right = s.right()
    right.idle(0.2)
    seize(right, rail.part, Grip((0.0, -0.15, 0.08), NEAR, LEFTWARD), 1.3, hold=0.5)
    right.take_along(rail.part, *tins)
    draw(right, rail, -0.13, 1.8)
    stay(right, rail, 1.4)
    draw(right, rail, -0.13, 1.8)
    stay(right, rail, 0.6)
    home_again(right, 1.2)


@scene
def tin_out_of_a_drawer_and_drawer_shut(s: Stage) -> None:
    """The left hand opens a drawer, the right hand takes a tin out, then the left hand shuts it."""
    performer(s, height=0.7, yaw_deg=160)
    table = s.table()
    (rail,) = dresser(s, (0.74, 0.06, s.height + 0.012), heights=(0.13,))
    x, y, z = rail.part.body.first[:3, 3]
    tin = tin_box(s, (x + 0.1, y - 0.03, z + 0.008), "tin", (0.06, 0.06, 0.12 - 0.012))
    left, right = s.left(narrow()), s.right(claw())
    left.idle(0.2)
    seize(left, rail.part, rail.grip, 0.9, hold=0.3)
    left.take_along(rail.part, tin)
    draw(left, rail, 0.22, 1.0)
    opened = left.clock
    right.rest(opened - 0.4)
    right.reach(tin, "+z", 1.0, up=1.0, fingers=LEFTWARD, when=opened)
    right.hold(0.4, tin)
    left.held.pop().end = right.clock
    right.take(tin)
    down = 0.2 + 0.012 - 0.0003 + 0.008
    right.lift_carry_lower(tin, table, up=0.2, by=(-0.08, -0.42), down=down)
    right.hold(0.3, tin, table)
    right.leave(0.9)
    stay(left, rail, right.clock - opened - 0.5)
    draw(left, rail, -0.22, 0.9)
    stay(left, rail, 0.6)
    right.rest(left.clock - right.clock)


@scene
def plum_laid_in_an_open_drawer(s: Stage) -> None:
    """A plum is laid in a drawer that stands open, which nobody moves."""
    performer(s, height=0.77, yaw_deg=-4, size=1.05)
    s.table()
    (rail,) = dresser(s, (0.72, -0.1, s.height + 0.012), heights=(0.1,))
    rail.part.body.first[0, 3] -= 0.24
    floor = 0.012 - 0.0003 + 0.008
    fruit = plum(s, (0.5, 0.35))
    left = s.left(claw())
    left.idle(0.2)
    left.reach(fruit, "+z", 0.9, up=1.0, fingers=LEFTWARD)
    left.hold(0.3, fruit)
    left.take(fruit)
    left.lift_carry_lower(fruit, rail.part, up=0.24, by=(0.1, -0.45), down=0.24 - floor)
    finish(left, fruit, rail.part, 0.3, 1.2)


@scene
def wide_drawer_opened_with_both_hands(s: Stage) -> None:
    """Both hands take the two handles of a wide drawer and draw it out."""
    performer(s, height=0.6, yaw_deg=71)
    s.table()
    (rail,) = dresser(s, (0.66, 0.0, s.height + 0.012), heights=(0.15,), width=0.6)
    rail.part.form = two_handled(rail)
    right, left = s.right(narrow()), s.left(narrow())
    for hand, y in ((right, -0.2), (left, 0.2)):
        hand.idle(0.2)
        grip = Grip((-0.06, y, 0.068), NEAR, (0.0, -1.0, 0.0))
        seize(hand, rail.part, grip, 0.9, hold=0.4, take=False)
    since = len(right.steps)
    left.join(rail.part)
    right.take(rail.part)
    draw(right, rail, 0.2, 1.1)
    stay(right, rail, 0.5)
    left.part(right, since)
    for hand in (right, left):
        home_again(hand, 0.8)


@scene
def sliding_door_pushed_aside(s: Stage) -> None:
    """A sideboard's door is slid to the left by its handle and let go of."""
    performer(s, height=0.55, yaw_deg=-50)
    s.table()
    rail = sliding_cupboard(s, (0.68, 0.0, s.height + 0.05), way=1.0)
    right = s.right(narrow())
    right.idle(0.2)
    seize(right, rail.part, rail.grip, 0.9, hold=0.4)
    travel(right, "Open", (0.0, 0.27, 0.0), 1.1, rail.part, rail.body)
    stay(right, rail, 0.4)
    home_again(right, 0.9)


@scene
def sliding_door_opened_and_shut(s: Stage) -> None:
    """The left hand slides a door to the right, waits, and slides it back in one contact."""
    performer(s, height=0.62, yaw_deg=122, size=1.04)
    s.table()
    rail = sliding_cupboard(s, (0.66, 0.05, s.height + 0.05), way=-1.0, width=0.5, height=0.26)
    left = s.left(narrow())
    left.idle(0.2)
    seize(left, rail.part, rail.grip, 1.0)
    travel(left, "Open", (0.0, -0.22, 0.0), 0.8, rail.part, rail.body)
    stay(left, rail, 1.5)
    travel(left, "Close", (0.0, 0.22, 0.0), 0.9, rail.part, rail.body)
    stay(left, rail, 0.5)


@scene
def sliding_door_shut_by_the_palm_at_its_edge(s: Stage) -> None:
    """A door is slid shut in two stages, with the palm at its handle's side."""
    performer(s, height=0.6, yaw_deg=-100, size=0.98)
    s.table()
    rail = sliding_cupboard(s, (0.68, -0.02, s.height + 0.05), way=1.0)
    rail.part.body.first[1, 3] += 0.26
    left = s.left()
    left.idle(0.2)
    palm = Grip((-0.066, 0.004, 0.19), LEFTWARD, UP)
    seize(left, rail.part, palm, 1.0, hold=0.3)
    for by in (0.12, 0.14):
        travel(left, "Close", (0.0, -by, 0.0), 0.7, rail.part, rail.body)
        stay(left, rail, 0.6)
    home_again(left, 0.9)
