"""Scenes in which hands meet each other, the own head, a table that is leant on, or nothing."""

from scenes.hands import shapes
from scenes.hands.paths import facing, pose
from scenes.hands.performer import PRESS
from scenes.hands.scene import performer
from scenes.people.body import Person
from scenes.people.person import person
from scenes.people.registry import scene
from scenes.people.stage import PeopleStage

APART_M = 0.16
"""Half the distance of the palms between two claps [m]."""


def ready(p: Person, ahead: float, high: float) -> None:
    """Both palms come up before the chest, facing each other, apart."""
    for sign, hand in ((-1.0, p.right), (1.0, p.left)):
        hand.idle(0.2)
        turned = facing((0.0, -sign, 0.0), (0.5, 0.0, 1.0))
        hand.fly(pose((ahead, sign * APART_M, high), turned), 0.9)
        hand.step("PostureChange")
        hand.rest(0.6)


def clap(p: Person, *, contact: float, claps: int, beat_s: float) -> None:
    """Palms meet so many times; between two claps they go apart and come back."""
    right, left = p.right, p.left
    for number in range(claps):
        if number:
            for sign, hand in ((-1.0, right), (1.0, left)):
                hand.move((0.0, sign * 0.1, 0.0), beat_s / 2.0, depart=0.3)
                hand.move((0.0, -sign * 0.1, 0.0), beat_s / 2.0, arrive=0.7)
        else:
            for sign, hand in ((-1.0, right), (1.0, left)):
                hand.move((0.0, -sign * (APART_M + PRESS / 2.0), 0.0), 0.4, arrive=0.7)
        right.meet_hand(left, right.clock, right.clock + contact)
        right.step("Clap", left)
        left.step("Clap", right)
        for hand in (right, left):
            hand.idle(contact)


def hands_home(p: Person) -> None:
    """Both hands leave each other and go home."""
    for hand, other in ((p.right, p.left), (p.left, p.right)):
        hand.fly(hand.home, 1.0, depart=0.3)
        hand.step("ResumePosture", other)
        hand.idle(0.2)


@scene
def clap_once(s: PeopleStage) -> None:
    """Somebody claps the hands once."""
    performer(s, yaw_deg=10)
    s.contact_minimum_s = 0.0
    p = person(s)
    ready(p, 0.35, 1.15)
    clap(p, contact=0.08, claps=1, beat_s=0.0)
    hands_home(p)


@scene
def clap_three_times(s: PeopleStage) -> None:
    """A child claps three times."""
    performer(s, yaw_deg=-85)
    s.contact_minimum_s = 0.0
    p = person(s, size=0.8)
    ready(p, 0.3, 0.92)
    clap(p, contact=0.06, claps=3, beat_s=0.6)
    hands_home(p)


@scene
def touch_the_other_hand(s: PeopleStage) -> None:
    """The right palm is laid on the back of the left hand, which stays where it is."""
    performer(s, yaw_deg=140)
    p = person(s)
    right, left = p.right, p.left
    back = left.now
    out = -back[:3, 0]
    depth = shapes.HAND_DEPTH
    place = back[:3, 3] + (depth - PRESS) * out
    goal = pose(place, facing(-out, (0.3, 0.0, -1.0)))
    right.rest(0.6)
    right.go_without_step((0.2, 0.5, 1.35), 0.9)
    right.fly(goal, 0.9, arrive=0.12)
    right.step("Reach", left)
    start = right.clock
    left.wait(start)
    right.clock += 0.9
    right.meet_hand(left, start, right.clock)
    right.step("TouchOneself", left)
    left.clock = right.clock
    left.step("TouchOneself", right)
    right.fly(pose((0.2, 0.5, 1.35), facing(-out, (0.3, 0.0, -1.0))), 0.8, depart=0.12)
    right.fly(right.home, 1.0)
    right.step("ResumePosture", left)
    right.idle(0.2)
    p.finish(right.clock)


@scene
def touch_the_own_head(s: PeopleStage) -> None:
    """The left hand is laid on the own forehead and taken away."""
    performer(s, yaw_deg=-20)
    p = person(s, size=1.03)
    left = p.left
    left.rest(0.7)
    left.reach(p.head, "+x", 1.1, fingers=(0.0, -1.0, 0.4))
    left.clock += 1.0
    left.step("TouchOneself", p.head)
    left.leave(1.1)
    left.rest(0.6)
    p.finish(left.clock)


@scene
def lean_on_a_table(s: PeopleStage) -> None:
    """Both hands are laid on a table while the upper body bends over it, and come back with it."""
    performer(s, yaw_deg=75)
    p = person(s)
    table = s.desk((0.6, 0.0, 0.75))
    p.stand(0.6)
    p.bend(20.0, 1.1)
    for sign, hand in ((-1.0, p.right), (1.0, p.left)):
        hand.rest(0.6)
        goal = pose((0.45, sign * 0.24, 0.75 - PRESS), facing((0.0, 0.0, -1.0), (1.0, 0.0, 0.0)))
        hand.fly(goal, 1.1, arrive=0.12)
        hand.meet(table)
        hand.step("Reach", table)
        hand.hold(1.6, table)
    p.until(p.right)
    p.bend(-20.0, 1.1)
    for hand in p.hands.values():
        hand.leave(1.1)
        hand.rest(0.6)


@scene
def hands_on_the_table_one_after_the_other(s: PeopleStage) -> None:
    """The left hand is laid on a table, then the right one, and the left one is taken away."""
    performer(s, yaw_deg=-145)
    p = person(s, size=0.93)
    table = s.desk((0.6, 0.0, 0.7))
    for sign, hand, start in ((1.0, p.left, 0.6), (-1.0, p.right, 2.4)):
        hand.wait(start)
        goal = pose((0.42, sign * 0.22, 0.7 - PRESS), facing((0.0, 0.0, -1.0), (1.0, 0.0, 0.0)))
        hand.fly(goal, 1.0, arrive=0.12)
        hand.meet(table)
        hand.step("Reach", table)
    p.left.hold(p.right.clock + 0.5 - p.left.clock, table)
    p.left.leave(1.0)
    p.left.idle(0.2)
    p.finish(p.left.clock)
