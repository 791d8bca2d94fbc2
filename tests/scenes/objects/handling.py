"""What hands do with things that have handles, hinges and rails."""

from dataclasses import dataclass

import numpy as np

from scenes.hands.paths import Vector, about, facing, pose
from scenes.hands.performer import EASE, PRESS, Hand
from scenes.hands.things import Thing

UP = (0.0, 0.0, 1.0)
AHEAD = (1.0, 0.0, 0.0)
NEAR = (-1.0, 0.0, 0.0)
LEFTWARD = (0.0, 1.0, 0.0)
RIGHTWARD = (0.0, -1.0, 0.0)


@dataclass(frozen=True)
class Grip:
    """Where a palm lies on a thing, in the thing's frame."""

    point: Vector
    """A point of the surface [m]."""

    out: Vector
    """The direction out of the surface."""

    fingers: Vector
    """The direction in which the fingers point."""

    def on(self, thing: Thing, time: float) -> np.ndarray:
        """The hand's pose in the world at a time [s]."""
        matrix = thing.body.at(time)
        turn, place = matrix[:3, :3], matrix[:3, 3]
        out = turn @ np.asarray(self.out, dtype=float)
        spot = turn @ np.asarray(self.point, dtype=float) + place
        return pose(spot - PRESS * out, facing(-out, turn @ np.asarray(self.fingers, dtype=float)))


@dataclass(frozen=True)
class Hinge:
    """An axis about which a door or a lid turns, in the stage's frame."""

    point: Vector
    axis: Vector
    open_deg: float
    """The sense of opening: 1 or -1, times the angle [degrees]."""

    def opened(self, thing: Thing, angle_deg: float) -> None:
        """Let a thing stand open by an angle at the first frame."""
        angle = np.radians([np.sign(self.open_deg) * angle_deg])
        thing.body.first = about(self.point, self.axis, angle)[0] @ thing.body.first

    def turn(self, hand: Hand, angle_deg: float, duration: float) -> None:
        """Turn what a hand holds by an angle; positive opens."""
        hand.spin(self.point, self.axis, np.sign(self.open_deg) * angle_deg, duration)


def seize(
    hand: Hand, thing: Thing, grip: Grip, duration: float, *, hold: float = 0.0, take: bool = True
) -> None:
    """Reach a thing's grip, hold it if that has a duration, and take it."""
    hand.fly(grip.on(thing, hand.clock), duration, arrive=EASE)
    hand.meet(thing)
    hand.step("Reach", thing)
    if hold:
        hand.hold(hold, thing)
    if take:
        hand.take(thing)


def begin_with(hand: Hand, thing: Thing, grip: Grip) -> None:
    """Hold a thing from the first frame on."""
    hand.body.first = grip.on(thing, 0.0)
    hand.meet(thing)
    hand.take(thing)


def travel(hand: Hand, name: str, by: Vector, duration: float, *things: Thing) -> None:
    """One step straight from rest to rest."""
    hand.move(by, duration)
    hand.step(name, *things)


def paused(
    hand: Hand,
    thing: Thing,
    goal: Thing,
    *,
    up: float,
    by: Vector,
    down: float,
    holds: tuple[float, float],
    times: tuple[float, float, float] = (0.8, 1.0, 0.8),
) -> None:
    """Lift, carry and lower with two holds in the air between; a hold of no time is a mere stop."""
    travel(hand, "Lift", (0.0, 0.0, up), times[0], thing)
    if holds[0]:
        hand.hold(holds[0], thing)
    travel(hand, "Carry", (*by, 0.0), times[1], thing)
    if holds[1]:
        hand.hold(holds[1], thing)
    travel(hand, "Lower", (0.0, 0.0, -down), times[2], thing, goal)


def home_again(hand: Hand, duration: float) -> None:
    """Let go, go home and stay for a moment."""
    hand.leave(duration)
    hand.idle(0.2)
