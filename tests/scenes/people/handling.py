"""What people do with things in several scenes."""

from scenes.hands import shapes
from scenes.hands.paths import Vector
from scenes.hands.performer import Hand
from scenes.hands.things import Thing
from scenes.people.body import Person
from scenes.people.stage import PeopleStage


def mug(s: PeopleStage, at: Vector, name: str = "mug") -> Thing:
    """A mug of usual size."""
    return s.put(name, shapes.vessel(0.042, 0.1), at)


def take_up(
    hand: Hand, thing: Thing, side: str, *, lift: float, after: float = 0.6, reach_s: float = 0.9,
    up: float = 0.6,
) -> None:  # fmt: skip
    """Reach, hold, lift and hold in the air."""
    hand.reach(thing, side, reach_s, up=up)
    hand.hold(0.4, thing)
    hand.take(thing)
    hand.move((0.0, 0.0, lift), 0.9)
    hand.step("Lift", thing)
    if after:
        hand.hold(after, thing)


def set_down(hand: Hand, thing: Thing, goal: Thing, down: float, *, hold: float = 0.5) -> None:
    """Lower onto a goal, hold, and go home."""
    hand.move((0.0, 0.0, -down), 0.9)
    hand.step("Lower", thing, goal)
    hand.hold(hold, thing, goal)
    hand.leave(0.9)


def hold_between(p: Person, thing: Thing, *, up: float = 0.5) -> None:
    """Hold a thing between both palms from the first frame on."""
    p.right.begin_at(thing, "-y", up=up, fingers=(1.0, 0.0, 0.0))
    p.left.begin_at(thing, "+y", up=up, fingers=(1.0, 0.0, 0.0))
    p.right.take(thing)
    p.left.join(thing)


def together(p: Person, thing: Thing, goal: Thing, *, down: float, hold: float) -> None:
    """Lower what both hands hold onto a goal, hold it there, and take both hands away."""
    right, left = p.right, p.left
    left.until(right.clock)
    since = len(right.steps)
    left.release()
    left.join(thing)
    right.move((0.0, 0.0, -down), 1.0)
    right.step("Lower", thing, goal)
    right.hold(hold, thing, goal)
    left.part(right, since)
    for hand in (right, left):
        hand.leave(0.9)
        hand.idle(0.2)
