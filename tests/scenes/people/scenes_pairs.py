"""Scenes of two people: handing over, watching, carrying together, greeting."""

import numpy as np

from scenes.hands import shapes
from scenes.hands.paths import facing, pose
from scenes.hands.performer import PRESS
from scenes.hands.scene import performer
from scenes.hands.things import Thing
from scenes.people.body import START_S, Person
from scenes.people.handling import mug, set_down, take_up
from scenes.people.limbs import smooth
from scenes.people.person import person
from scenes.people.registry import scene
from scenes.people.stage import PeopleStage


def ends(*people: Person) -> None:
    """Everybody waits for whoever is last."""
    end = max(limb.clock for p in people for limb in (*p.hands.values(), *p.feet.values()))
    for each in people:
        each.finish(end)


def offered(giver: Person, taker: Person, thing: Thing, side: str, *, wait: float = 0.0) -> None:
    """The giver's right hand holds a thing still; the taker's right hand comes and takes it."""
    hand, other = giver.right, taker.right
    if wait:
        hand.hold(wait, thing)
    other.wait(hand.clock)
    begin = hand.clock
    ahead = taker.heading[:, 0]
    other.reach(thing, side, 1.0, fingers=ahead, name="Accept", when=begin)
    hand.hold(other.clock + 0.6 - hand.clock, thing)
    other.until(hand.clock)
    hand.leave(1.0, name="HandOver")
    hand.idle(0.2)
    other.hold(0.5, thing)
    other.take(thing)
    hand.aliases["HandOver"] = "Give"
    other.aliases["Accept"] = "Receive"


def face_to_face(s: PeopleStage, far: float, sizes: tuple[float, float]) -> tuple[Person, Person]:
    """Two people who look at each other."""
    anna = person(s, "anna", at=(-far / 2.0, 0.0), size=sizes[0])
    ben = person(s, "ben", at=(far / 2.0, 0.0), facing_deg=180.0, size=sizes[1])
    return anna, ben


def holding(s: PeopleStage, p: Person, name: str, form: shapes.Form, ahead: float) -> Thing:
    """A thing that somebody holds at its right side from the first frame on."""
    place = p.chest.at(0.0) @ pose((ahead, -0.15, 1.0 * p.size))
    thing = s.put(name, form, place[:3, 3])
    thing.body.first[:3, :3] = place[:3, :3]
    p.right.begin_at(thing, "-y", up=0.5, fingers=p.heading[:, 0])
    p.right.take(thing)
    return thing


@scene
def hand_a_ball_over(s: PeopleStage) -> None:
    """Anna holds a ball out to Ben, who takes it and keeps it."""
    performer(s, yaw_deg=20)
    anna, ben = face_to_face(s, 1.2, (1.0, 1.05))
    ball = holding(s, anna, "ball", shapes.ball(0.06), 0.4)
    anna.right.hold(0.8, ball)
    anna.right.move((0.15, 0.1, 0.0), 0.9)
    anna.right.step("Carry", ball)
    offered(anna, ben, ball, "+y", wait=0.5)
    ben.right.move((0.12, 0.0, 0.0), 0.8)
    ben.right.step("Carry", ball)
    ends(anna, ben)


@scene
def hand_a_box_over_to_a_child(s: PeopleStage) -> None:
    """A tall person holds a box; a child takes it, holds it for a second, and lifts it."""
    performer(s, yaw_deg=-110)
    anna, ben = face_to_face(s, 1.1, (1.04, 0.82))
    box = holding(s, anna, "box", shapes.box(0.12, 0.12, 0.12), 0.45)
    offered(anna, ben, box, "+y", wait=1.0)
    ben.right.move((0.0, 0.0, 0.12), 0.7)
    ben.right.step("Raise", box)
    ben.right.hold(0.6, box)
    ends(anna, ben)


@scene
def walk_up_and_take_what_is_offered(s: PeopleStage) -> None:
    """Ben walks up to Anna, stands, and takes the can that she holds out."""
    performer(s, yaw_deg=65)
    anna, ben = face_to_face(s, 2.4, (0.95, 1.0))
    can = holding(s, anna, "can", shapes.box(0.09, 0.09, 0.12, "can"), 0.5)
    ben.stand(0.7)
    ben.walk(1.25, speed=0.9)
    ben.right.rest(0.6)
    offered(anna, ben, can, "+y", wait=ben.right.clock)
    ends(anna, ben)


@scene
def bring_a_can_and_hand_it_over(s: PeopleStage) -> None:
    """Anna carries a can to Ben, who stands and waits, and gives it to him."""
    performer(s, yaw_deg=-30, offset=(0.3, 0.5))
    anna, ben = face_to_face(s, 2.6, (1.0, 0.92))
    can = holding(s, anna, "can", shapes.box(0.09, 0.09, 0.12, "can"), 0.5)
    anna.stand(0.8)
    anna.walk(1.4, speed=0.8, first="left")
    offered(anna, ben, can, "+y", wait=0.7)
    ends(anna, ben)


@scene
def one_works_and_one_watches(s: PeopleStage) -> None:
    """Anna lifts a mug and puts it back; Ben stands across the table and does nothing."""
    performer(s, yaw_deg=150)
    anna, ben = face_to_face(s, 1.7, (0.98, 1.02))
    table = s.desk((0.0, 0.0, 0.76), (0.7, 1.0))
    cup = mug(s, (-0.25, -0.1, 0.76))
    anna.right.rest(0.6)
    take_up(anna.right, cup, "-y", lift=0.2)
    set_down(anna.right, cup, table, 0.2)
    anna.right.idle(0.2)
    ends(anna, ben)


@scene
def one_walks_past_another(s: PeopleStage) -> None:
    """Anna walks past Ben, who stands aside."""
    performer(s, yaw_deg=-70)
    anna = person(s, "anna", at=(-1.2, 0.0), hang=True)
    ben = person(s, "ben", at=(0.0, 1.0), facing_deg=-90.0, hang=True, size=0.9)
    anna.stand(0.7)
    anna.walk(2.3, speed=1.2)
    anna.stand(0.7)
    anna.finish(anna.clock)
    ends(anna, ben)


@scene
def carry_a_board_together(s: PeopleStage) -> None:
    """Two people lift a board off two trestles, carry it six steps aside, and hold it."""
    performer(s, yaw_deg=35)
    board = s.put("board", shapes.box(1.2, 0.3, 0.06, "board"), (0.0, 0.0, 0.82))
    for name, x in (("first_trestle", -0.3), ("second_trestle", 0.3)):
        s.put(name, shapes.box(0.06, 0.5, 0.82, "trestle"), (x, 0.0, 0.0), tag="fixed")
    anna, ben = face_to_face(s, 1.95, (1.0, 1.0))
    hands = [anna.right, anna.left, ben.right, ben.left]
    for hand in hands:
        own = anna if hand in hands[:2] else ben
        hand.rest(0.6)
        side, aside = ("-x", 1.0) if own is anna else ("+x", -1.0)
        aside *= -0.1 if hand.side == "right" else 0.1
        hand.reach(board, side, 1.0, up=0.5, fingers=(0.0, 0.0, 1.0), aside=(0.0, aside, 0.0))
    latest = max(each.clock for each in hands)
    for hand in hands:
        hand.hold(latest + 0.5 - hand.clock, board)
    leader = hands[0]
    since = len(leader.steps)
    for hand in hands[1:]:
        hand.join(board)
    leader.take(board)
    leader.move((0.0, 0.0, 0.12), 0.9)
    leader.step("Lift", board)
    leader.hold(0.6, board)
    far, begin = 0.6, leader.clock
    for p, way in ((anna, far), (ben, -far)):
        p.clock = begin
        p.sidle(way, 3, pace=0.55)
    span = anna.clock - begin
    leader.body.shift(begin, anna.clock, lambda since: np.outer(
        smooth(since / span, START_S / span), (0.0, far, 0.0)))  # fmt: skip
    leader.clock = anna.clock
    leader.step("Carry", board)
    leader.hold(0.8, board)
    for hand in hands[1:]:
        hand.part(leader, since)


@scene
def greet_by_a_clap_of_hands(s: PeopleStage) -> None:
    """Anna and Ben raise their right hands, clap them together, and take them down."""
    performer(s, yaw_deg=-160)
    s.hands_as_objects = True
    s.contact_minimum_s = 0.0
    anna, ben = face_to_face(s, 1.2, (1.0, 1.0))
    high = 1.35
    for p, sign in ((anna, 1.0), (ben, -1.0)):
        hand = p.right
        hand.idle(0.2)
        turned = facing((sign, 0.0, 0.0), (0.0, 0.0, 1.0))
        hand.fly(pose((-sign * 0.2, 0.0, high), turned), 0.9)
        hand.step("PostureChange")
        hand.rest(0.6)
        hand.move((sign * (0.2 + PRESS / 2.0), 0.0, 0.0), 0.4, arrive=1.0)
    a, b = anna.right, ben.right
    a.meet_hand(b, a.clock, a.clock + 0.06)
    for p, hand, other in ((anna, a, b), (ben, b, a)):
        hand.step("Clap", other)
        hand.idle(0.06)
        hand.fly(p.chest.at(0.0) @ p.local["right"], 1.0, depart=0.3)
        hand.step("ResumePosture", other)
        hand.idle(0.2)
        hand.aliases["Clap"] = "Hit"
    ends(anna, ben)
