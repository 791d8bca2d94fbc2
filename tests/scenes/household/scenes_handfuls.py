"""Scenes with several things in or on one hand: taken at once, one let go of, one taken away."""

from dataclasses import replace

from scenes.hands import shapes
from scenes.hands.performer import EASE, PRESS, Hand
from scenes.hands.scene import performer
from scenes.hands.scenes_place import claw
from scenes.hands.stage import Stage, other_names
from scenes.hands.things import Thing
from scenes.household.builders import scene
from scenes.objects.builders import AHEAD, LEFTWARD, Grip, home_again, paused, shelf, travel
from scenes.objects.scenes_several import FINGERS_M, PALM_M, also, hold_both

APART_M = FINGERS_M - PALM_M
"""How far two jars that lie along one hand are apart [m]."""


def slim_jar(s: Stage, name: str, at: tuple[float, ...]) -> Thing:
    """A slim closed jar."""
    return s.put(name, shapes.Form("jar", (shapes.disc(0.032, 0.0, 0.12),)), at)


def two_jars(s: Stage, x: float, y: float, sign: float) -> tuple[Thing, Thing]:
    """Two jars one behind the other on the table; the first is the nearer one.

    Args:
        s: The stage.
        x: Of the first jar [m].
        y: Of both [m].
        sign: 1 if the palm comes from the left, -1 if from the right; the second stands deeper.
    """
    first = slim_jar(s, "amber_jar", (x, y))
    return first, slim_jar(s, "blue_jar", (x + APART_M, y + sign * PRESS))


def meet_both(hand: Hand, first: Thing, second: Thing, side: str, duration: float) -> float:
    """Reach two jars at once; gives the time of contact [s]."""
    hand.reach(first, side, duration, up=0.6, aside=(-PALM_M, 0.0, 0.0), others=(second,))
    return hand.clock


def take_both(hand: Hand, first: Thing, second: Thing) -> None:
    """Carry both along from now on."""
    hand.take(first)
    hand.held.append(second.body.ride(hand.body, hand.clock))


@scene
def two_jars_carried_to_a_board(s: Stage) -> None:
    """The right hand lifts two jars at once, carries them to a low board, and lets go of both."""
    performer(s, height=0.72, yaw_deg=62)
    s.table()
    board = s.put("board", shapes.box(0.34, 0.4, 0.05, "board"), (0.52, 0.3), tag="fixed")
    first, second = two_jars(s, 0.46, -0.3, -1.0)
    right = s.right()
    right.idle(0.2)
    since = meet_both(right, first, second, "-y", 0.9)
    hold_both(right, 0.4, first, second)
    take_both(right, first, second)
    travel(right, "Lift", (0.0, 0.0, 0.17), 0.8, first, second)
    hold_both(right, 0.4, first, second)
    travel(right, "Carry", (0.0, 0.55, 0.0), 1.1, first, second)
    hold_both(right, 0.4, first, second)
    travel(right, "Lower", (0.0, 0.0, -0.12), 0.7, first, second, board)
    right.hold(0.4, first, second, board)
    also(right, second, since)
    right.let_go()
    right.fly(right.home, 1.0, depart=EASE)
    right.step("ResumePosture", first, second)
    right.idle(0.2)


@scene
def two_jars_pushed_at_once(s: Stage) -> None:
    """The left palm meets two jars at once and pushes both to the right over the table."""
    performer(s, height=0.8, yaw_deg=-134, size=1.0)
    table = s.table()
    first, second = two_jars(s, 0.5, 0.2, 1.0)
    left = s.left()
    left.idle(0.2)
    since = meet_both(left, first, second, "+y", 0.9)
    hold_both(left, 0.4, first, second)
    take_both(left, first, second)
    travel(left, "Push", (0.0, -0.28, 0.0), 1.2, first, second, table)
    left.hold(0.7, first, second, table)
    also(left, second, since)


@scene
def first_of_two_jars_let_go_first(s: Stage) -> None:
    """Two jars are lifted and put back; the hand goes up aslant with the far one and keeps it."""
    performer(s, height=0.69, yaw_deg=11)
    table = s.table()
    first, second = two_jars(s, 0.46, -0.12, -1.0)
    right = s.right()
    right.idle(0.2)
    since = meet_both(right, first, second, "-y", 0.9)
    hold_both(right, 0.4, first, second)
    take_both(right, first, second)
    travel(right, "Lift", (0.0, 0.0, 0.15), 0.8, first, second)
    hold_both(right, 0.6, first, second)
    travel(right, "Lower", (0.0, 0.0, -0.15), 0.8, first, second, table)
    right.hold(0.5, first, second, table)
    keep = right.held.pop()
    right.let_go()
    right.held.append(keep)
    right.touched, right.since = second, since
    travel(right, "Lift", (0.0, -0.2, 0.3), 0.9, second)
    right.hold(0.8, second)


@scene
def second_jar_taken_on_the_way(s: Stage) -> None:
    """A jar is lifted, held and carried on to another, which is taken too; both are lifted."""
    performer(s, height=0.75, yaw_deg=-71, size=1.02)
    s.table()
    gap = 0.22
    near = slim_jar(s, "white_jar", (0.46, 0.35))
    s.put("block", shapes.box(0.1, 0.1, 0.1, "block"), (0.46 + APART_M, 0.35 - gap), tag="fixed")
    far = slim_jar(s, "green_jar", (0.46 + APART_M, 0.35 - gap + PRESS, s.height + 0.1))
    left = s.left()
    left.idle(0.2)
    left.reach(near, "+y", 0.9, up=0.6, aside=(-PALM_M, 0.0, 0.0))
    left.hold(0.3, near)
    left.take(near)
    travel(left, "Lift", (0.0, 0.0, 0.11), 0.7, near)
    left.hold(0.5, near)
    left.move((0.0, -gap, 0.0), 0.9, arrive=EASE)
    left.step("Carry", near, far)
    since = left.clock
    hold_both(left, 0.5, near, far)
    left.held.append(far.body.ride(left.body, left.clock))
    travel(left, "Lift", (0.0, 0.0, 0.2), 0.9, near, far)
    hold_both(left, 0.8, near, far)
    also(left, far, since)
    left.alternative = tuple(
        replace(each, name="Reach", objects=(far.name, near.name))
        if each.objects == (near.name, far.name) and each.name == "Carry"
        else each
        for each in left.steps
    )


def on_the_palm(s: Stage, hand: Hand, name: str, height: float) -> Thing:
    """A block on a palm that faces up, from the first frame."""
    place = (0.42, 0.22, s.height + 0.15)
    block = s.put(name, shapes.box(0.07, 0.07, height, "block"), place)
    hand.body.first = Grip((0.0, 0.0, 0.0), (0.0, 0.0, -1.0), AHEAD).on(block, 0.0)
    hand.meet(block)
    hand.take(block)
    return block


@scene
def block_taken_off_the_other_palm(s: Stage) -> None:
    """A block lies on the left palm; the right hand takes it straight up off it and keeps it."""
    performer(s, height=0.7, yaw_deg=119)
    s.table()
    left, right = s.left(), s.right(claw())
    block = on_the_palm(s, left, "block", 0.08)
    right.rest(0.6)
    right.reach(block, "+z", 1.0, up=1.0, fingers=LEFTWARD, name="Receive")
    right.hold(0.5, block)
    left.hold(right.clock, block)
    left.let_go()
    right.take(block)
    travel(right, "Lift", (0.0, 0.0, 0.2), 0.9, block)
    right.hold(0.7, block)
    left.rest(right.clock - left.clock)
    right.alternative = other_names(right, Receive="Reach")


@scene
def cube_stacked_on_a_block_on_the_other_palm(s: Stage) -> None:
    """The right hand takes a cube and puts it on the block that the left palm bears."""
    performer(s, height=0.67, yaw_deg=-26, size=1.01)
    s.table()
    left, right = s.left(), s.right(claw())
    block = on_the_palm(s, left, "block", 0.06)
    cube = s.put("cube", shapes.box(0.05, 0.05, 0.06, "cube"), (0.48, -0.25))
    right.idle(0.2)
    right.reach(cube, "+z", 0.9, up=1.0, fingers=LEFTWARD)
    right.hold(0.3, cube)
    right.take(cube)
    paused(right, cube, block, up=0.36, by=(-0.06, 0.47), down=0.15, holds=(0.0, 0.4))
    right.hold(0.4, cube, block)
    home_again(right, 1.1)
    left.hold(right.clock, block)


@scene
def two_blocks_brought_to_a_shelf_on_the_palm(s: Stage) -> None:
    """Two blocks are carried ahead on the right palm; the left hand takes one to a shelf."""
    performer(s, height=0.64, yaw_deg=171)
    s.table()
    board = shelf(s, (0.6, 0.42, s.height + 0.1), size=(0.3, 0.3))
    right, left = s.right(), s.left(claw())
    place = (0.36, -0.12, s.height + 0.2)
    near = s.put("near_block", shapes.box(0.05, 0.05, 0.05, "block"), place)
    far = s.put("tall_block", shapes.box(0.045, 0.05, 0.1, "block"), (0.425, *place[1:]))
    right.body.first = Grip((0.01, 0.0, 0.0), (0.0, 0.0, -1.0), AHEAD).on(near, 0.0)
    right.meet(near)
    take_both(right, near, far)
    hold_both(right, 0.5, near, far)
    travel(right, "Carry", (0.14, 0.06, 0.0), 0.9, near, far)
    brought = right.clock
    left.rest(brought)
    left.reach(far, "+z", 1.1, up=1.0, fingers=LEFTWARD, name="Receive", when=brought)
    left.hold(0.4, far)
    right.held.pop().end = left.clock
    left.take(far)
    right.until(left.clock)
    right.step("Touch", near, far)
    also(right, far, 0.0)
    paused(left, far, board, up=0.15, by=(0.035, 0.48), down=0.25, holds=(0.4, 0.0))
    left.hold(0.4, far, board)
    home_again(left, 1.0)
    right.hold(left.clock - right.clock, near)
    left.alternative = other_names(left, Receive="Reach")
