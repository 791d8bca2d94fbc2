"""Scenes with blows, throws and catches."""

import numpy as np

from scenes.hands import shapes
from scenes.hands.paths import AHEAD, UP, facing, pose
from scenes.hands.performer import GRAVITY, PRESS
from scenes.hands.scene import at_table, performer
from scenes.hands.stage import Stage

SLOWING = 3.5
"""Deceleration of a block that slides on a table [m/s2]."""


def hit_the_table(s: Stage) -> None:
    """The flat hand comes down on the table at more than a metre a second and stays a while."""
    table = at_table(s, yaw_deg=22, depth=0.6, width=0.5)
    right = s.right(home=(0.12, -0.3, s.height + 0.25), idle=0.2)
    right.reach(table, "+z", 0.7, up=1.0, speed=1.2, name="Hit")
    right.hold(0.6, table)
    right.leave(0.9)
    right.idle(0.2)


def hit_a_board(s: Stage) -> None:
    """The left palm hits an upright board."""
    at_table(s, height=0.9, yaw_deg=-145, size=1.05)
    board = s.put("board", shapes.box(0.03, 0.5, 0.5, "board"), (0.7, 0.1), tag="fixed")
    left = s.left(idle=0.2)
    left.reach(board, "-x", 0.7, fingers=UP, speed=1.3, name="Hit")
    left.hold(0.5, board)
    left.leave(0.9)
    left.idle(0.2)


def tap_twice(s: Stage) -> None:
    """The hand slaps the table, rests above it and slaps it again."""
    table = at_table(s, yaw_deg=-100, depth=0.6, width=0.5)
    right = s.right(home=(0.12, -0.3, s.height + 0.3), idle=0.2)
    right.reach(table, "+z", 0.7, up=1.0, speed=1.1, name="Hit")
    right.hold(0.4, table)
    right.leave(0.6, to=(0.6, 0.0, s.height + 0.27), name="Withdraw")
    right.rest(0.7)
    right.reach(table, "+z", 0.55, up=1.0, speed=1.1, name="Hit")
    right.hold(0.4, table)
    right.leave(0.9)
    right.idle(0.2)


def hit_a_block_away(s: Stage) -> None:
    """The palm strikes a block at its side, which slides away over the table."""
    performer(s, yaw_deg=135)
    s.contact_minimum_s = 0.0
    s.table()
    toy = s.put("block", shapes.box(0.1, 0.1, 0.12, "block"), (0.5, -0.1))
    right = s.right(home=(0.2, -0.45, s.height + 0.15), idle=0.2)
    right.reach(toy, "-y", 0.7, speed=1.2, name="HitAway")
    start, contact, speed = right.clock, 0.02, 1.0

    def pushed(since: np.ndarray) -> np.ndarray:
        early = np.minimum(since, contact)
        late = np.clip(since - contact, 0.0, speed / SLOWING)
        way = speed / contact * early**2 / 2.0 + speed * late - SLOWING * late**2 / 2.0
        return np.outer(way, (0.0, 1.0, 0.0))

    toy.body.shift(start, start + contact + speed / SLOWING, pushed)
    toy.free.append((start, start + contact + speed / SLOWING))
    right.join(toy)
    right.idle(contact)
    right.leave(0.9, speed=0.3)
    right.idle(0.2)


def palm_up(place: np.ndarray) -> np.ndarray:
    """The pose of a hand that holds its palm up, fingers ahead."""
    return pose(place, facing(UP, AHEAD))


def throw_a_bag(s: Stage) -> None:
    """A bean bag on the palm is thrown up and ahead and lands on the table."""
    at_table(s, yaw_deg=-5, depth=1.2)
    bag = s.put("bag", shapes.box(0.07, 0.07, 0.03, "bag"), (0.2, -0.25, s.height + 0.15))
    right = s.right()
    right.begin_at(bag, "-z", up=0.0, fingers=AHEAD)
    right.home = right.body.first
    right.take(bag)
    right.hold(0.5, bag)
    swing, velocity = 0.4, (0.9, 0.0, 1.4)
    height = 0.15 + velocity[2] * swing / 2.0
    flight = (velocity[2] + np.sqrt(velocity[2] ** 2 + 2.0 * GRAVITY * height)) / GRAVITY
    right.throw(bag, velocity, swing, float(flight))
    right.fly(right.home, 0.9)
    right.step("ResumePosture", bag)
    right.idle(0.2)


def throw_and_catch(s: Stage) -> None:
    """The right hand tosses a bean bag, and the left hand catches it and keeps it."""
    at_table(s, height=0.8, yaw_deg=220)
    bag = s.put("bag", shapes.box(0.07, 0.07, 0.03, "bag"), (0.35, -0.3, s.height + 0.15))
    right, left = s.right(), s.left(home=(0.2, 0.3, s.height + 0.2))
    right.begin_at(bag, "-z", up=0.0, fingers=AHEAD)
    right.home = right.body.first
    right.take(bag)
    right.hold(0.5, bag)
    swing, velocity = 0.4, (0.0, 0.8, 1.5)
    flight = 2.0 * velocity[2] / GRAVITY
    right.throw(bag, velocity, swing, flight)
    right.fly(right.home, 0.9)
    right.step("ResumePosture", bag)
    right.idle(0.2)
    caught = 0.5 + swing + flight
    place = bag.body.at(caught)[:3, 3] + (0.0, 0.0, PRESS)
    left.idle(0.15)
    left.fly(palm_up(place), caught - 0.15)
    left.meet(bag)
    left.step("Catch", bag)
    left.take(bag)
    left.hold(right.clock - left.clock, bag)
