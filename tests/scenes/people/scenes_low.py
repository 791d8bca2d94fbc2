"""Scenes in which somebody squats, kneels, sits or stands up."""

import numpy as np

from scenes.hands import shapes
from scenes.hands.expectation import Step
from scenes.hands.performer import PRESS
from scenes.hands.scene import performer
from scenes.people.body import Person
from scenes.people.handling import mug
from scenes.people.person import person
from scenes.people.registry import scene
from scenes.people.stage import PeopleStage


def down_and_up(p: Person, hand: str) -> float:
    """The body sinks and bends in 1.4 s; the hand that does nothing goes along."""
    start = p.clock
    p.bend(35.0, 1.4)
    p.shift((-0.05, 0.0, -0.42 * p.size), 1.4)
    other = p.hands["left" if hand == "right" else "right"]
    other.wait(start)
    p.along(other, start, p.clock)
    other.step("PostureChange")
    return start


def rise(p: Person, hand: str, seconds: float = 1.4) -> None:
    """The body stands up again; the hand that does nothing goes along."""
    start = p.clock
    p.bend(-35.0, seconds)
    p.shift((0.05, 0.0, 0.42 * p.size), seconds)
    other = p.hands["left" if hand == "right" else "right"]
    other.wait(start)
    p.along(other, start, p.clock)
    other.step("PostureChange")


@scene
def pick_a_block_off_the_floor(s: PeopleStage) -> None:
    """Somebody squats, takes a block off the floor, and stands up with it."""
    performer(s, yaw_deg=55)
    p = person(s)
    block = s.put("block", shapes.box(0.1, 0.1, 0.16, "block"), (0.5, -0.15, 0.0))
    p.stand(0.7)
    p.right.rest(0.7)
    down_and_up(p, "right")
    p.right.reach(block, "-y", 1.4, up=0.6)
    p.right.hold(0.5, block)
    p.right.take(block)
    p.until(p.right)
    rise(p, "right")
    p.right.move((-0.12, 0.0, 0.85), 1.4)
    p.right.step("Lift", block)
    p.right.hold(0.7, block)
    p.finish(p.right.clock)


@scene
def put_a_bottle_on_the_floor(s: PeopleStage) -> None:
    """A tall left-hander squats, puts a bottle on the floor, and stands up without it."""
    performer(s, yaw_deg=-120)
    p = person(s, size=1.06)
    bottle = s.put("bottle", shapes.bottle(0.036, 0.24), (0.5, 0.18, 0.8))
    left = p.left
    left.begin_at(bottle, "+y", up=0.4, fingers=(1.0, 0.0, 0.0))
    left.take(bottle)
    left.hold(0.8, bottle)
    p.stand(0.8)
    down_and_up(p, "left")
    left.move((0.0, 0.0, -0.8), 1.4)
    left.step("Lower", bottle, s.floor)
    left.hold(0.6, bottle, s.floor)
    p.until(left)
    p.stand(0.35)
    rise(p, "left", 2.2)
    left.leave(1.4)
    left.wait(p.clock + 0.2)
    p.finish(left.clock)


@scene
def kneel_on_one_knee(s: PeopleStage) -> None:
    """The right foot steps back, the body sinks until the knee is on the floor, and stays low."""
    performer(s, yaw_deg=5)
    p = person(s)
    back = p.trunk.at(0.0).copy()
    back[:3, 3] += (-0.45, 0.0, 0.0)
    p.stand(0.8)
    p.stride("right", back, 0.8, 1.5)
    p.stand(0.7)
    start = p.clock
    p.shift((-0.1, 0.0, -0.4), 1.2)
    p.roll_heel("right", 55.0, start, p.clock)
    p.hands_along(start)
    p.stand(1.2)
    p.finish(p.clock)


def chair(s: PeopleStage, x: float, height: float) -> None:
    """A chair's seat behind somebody, with its front edge at x."""
    seat = shapes.box(0.4, 0.42, 0.04, "chair")
    s.put("chair", seat, (x - 0.2, 0.0, height - 0.04), tag="fixed")


@scene
def sit_down(s: PeopleStage) -> None:
    """Somebody sits down on a chair; the hands go along, the feet keep the floor."""
    performer(s, yaw_deg=-40)
    p = person(s)
    chair(s, -0.12, 0.44)
    p.stand(0.8)
    start = p.clock
    p.bend(25.0, 0.8)
    p.bend(-25.0, 0.7, start + 0.8)
    p.shift((-0.35, 0.0, -0.42), 1.5)
    p.hands_along(start)
    p.stand(1.5)
    p.finish(p.clock)
    seated(p, start + 1.5, p.clock)


def seated(p: Person, since: float, until: float) -> None:
    """The feet of somebody who sits stand too (spec 10); that they rest is the alternative."""
    borders = (("Stand", 0.0, since), ("RestFoot", since, until), ("Stand", until, p.clock))
    for foot in p.feet.values():
        foot.alternative = tuple(
            Step(name, ("floor",), start, end) for name, start, end in borders if start < end
        )


@scene
def stand_up_from_a_chair(s: PeopleStage) -> None:
    """A small person who sits stands up, and stays so."""
    performer(s, yaw_deg=115)
    p = person(s, size=0.9)
    chair(s, -0.1, 0.4)
    sitting(p, (-0.32, 0.0, -0.38))
    p.stand(1.0)
    start = p.clock
    p.shift((0.32, 0.0, 0.38), 1.4)
    p.hands_along(start)
    p.stand(0.9)
    p.finish(p.clock)
    seated(p, 0.0, start)


def sitting(p: Person, by: tuple[float, float, float]) -> None:
    """Let somebody sit at the first frame."""
    p.trunk.first[:3, 3] += by
    for hand in p.hands.values():
        hand.body.first[:3, 3] += by
        hand.home = hand.body.first


@scene
def drink_while_seated(s: PeopleStage) -> None:
    """Somebody who sits at a table takes a mug to the mouth, drinks, and puts it back."""
    performer(s, yaw_deg=-75)
    p = person(s)
    chair(s, -0.12, 0.44)
    sitting(p, (-0.3, 0.0, -0.42))
    table = s.desk((0.4, 0.0, 0.7), (0.6, 1.2))
    start = np.array((0.3, -0.1, 0.7))
    cup = mug(s, start)
    right = p.right
    for hand in p.hands.values():
        hand.body.first[:3, 3] += (0.0, 0.0, 0.25)
        hand.home = hand.body.first
    right.rest(0.6)
    right.reach(cup, "-y", 0.9, up=0.6, along=-0.025)
    right.hold(0.4, cup)
    right.take(cup)
    face = p.head.body.at(0.0)[:3, 3] + (0.1 * p.size, 0.0, 0.0)
    goal = np.add(face, (0.042 - PRESS, 0.0, -0.1))
    right.move(goal - start, 1.2, arrive=0.12)
    right.step("MoveObjTo", cup, p.head)
    right.dip(face, (0.0, 1.0, 0.0), -42.0, 1.3)
    right.step("Drink", cup, p.head)
    right.move(start - goal, 1.2, depart=0.12)
    right.step("MoveObjTo", cup, table)
    right.hold(0.5, cup, table)
    right.leave(0.9)
    right.rest(0.6)
    p.finish(right.clock)
    p.until(right)
    seated(p, 0.0, p.clock)
