"""What a performer is told to do: phases of stated length, one after the other."""

from collections.abc import Mapping
from dataclasses import dataclass, field, replace

import numpy as np
from jaxtyping import Float
from scipy.spatial.transform import RigidTransform, Rotation

Vector = tuple[float, float, float]

GRAVITY_MPS2 = np.array([0.0, 0.0, -9.81])
"""Standard gravity, rounded [m/s^2]."""


@dataclass(frozen=True)
class Toss:
    """What moves a thing in a phase in which it is thrown, flies or is caught."""

    start: Vector = (0.0, 0.0, 0.0)
    """Velocity with which it begins [m/s]."""

    end: Vector = (0.0, 0.0, 0.0)
    """Velocity with which it ends; ignored where it falls [m/s]."""

    falls: bool = False
    """Whether nothing but gravity moves it."""


def tossed(toss: Toss, by: Vector, seconds: float, share: float) -> Float[np.ndarray, "3"]:
    """Displacement of a thing since its phase began [m], in the world's axes.

    In a hand along a cubic Hermite curve that has both velocities, else along the parabola of
    gravity.

    Args:
        toss: How it moves.
        by: Where a hand brings it, from where it was [m]; ignored where it falls.
        seconds: Length of the phase [s].
        share: Of the phase that has passed [1].
    """
    start, end, goal = np.array(toss.start), np.array(toss.end), np.array(by)
    if toss.falls:
        past = share * seconds
        return np.asarray(start * past + 0.5 * GRAVITY_MPS2 * past**2)
    leaving, arriving = share - 2.0 * share**2 + share**3, share**3 - share**2
    led = goal * (3.0 * share**2 - 2.0 * share**3)
    return np.asarray(led + seconds * (leaving * start + arriving * end))


def slowed(velocity: Vector, past_s: float, stops_s: float) -> Float[np.ndarray, "3"]:
    """How far something goes that decelerates evenly to rest [m].

    Args:
        velocity: With which it begins [m/s].
        past_s: Since then [s].
        stops_s: How long it takes to stop [s].
    """
    past = min(past_s, stops_s)
    return np.asarray(np.array(velocity) * (past - 0.5 * past**2 / stops_s))


SIDES = ("right", "left")


@dataclass(frozen=True)
class Hand:
    """What one hand does in a phase."""

    does: str
    """``rests`` at the side, ``reaches`` for a thing, ``holds`` on to it, ``awaits`` it where it
    will be, or ``lets_go`` of it and swings on a little."""

    thing: str = ""
    grip: str = "side"
    """``side``, ``top`` or ``back``, which is the side that faces the performer."""

    beside: tuple[str, ...] = ()
    """Other things that lie in the same palm."""

    awaited: Vector = (0.0, 0.0, 0.0)
    """Where the thing is awaited, from where it stands at first [m]."""

    velocity: Vector = (0.0, 0.0, 0.0)
    """With which a thing is let go [m/s]."""


RESTS = Hand("rests")


@dataclass(frozen=True)
class Move:
    """Where a held thing goes in a phase."""

    by: tuple[float, float, float] = (0.0, 0.0, 0.0)
    """Displacement from where it is [m]."""

    turn: tuple[float, float, float] = (0.0, 0.0, 0.0)
    """How it turns meanwhile about its frame's origin, in the world's axes [rad]."""

    about: tuple[float, float, float] = (0.0, 0.0, 0.0)
    """A point of the thing's frame about which it turns instead, as on a hinge [m]."""

    lift: float = 0.0
    """Height of the arc above the straight way [m]."""

    to_mouth: bool = False
    tilt: float = 0.0
    """Turn of its top towards the face at the mouth [rad]."""

    home: bool = False
    """Whether it goes back to where it stood at the beginning."""

    toss: Toss | None = None
    """How it is thrown, flies or is caught; a thing that is moved otherwise begins at rest."""


@dataclass(frozen=True)
class Phase:
    """A stretch of time in which hands and things go from one place to another."""

    name: str
    seconds: float
    hands: Mapping[str, Hand] = field(default_factory=dict)
    """By side; a hand that is not named rests."""

    moves: Mapping[str, Move] = field(default_factory=dict)
    look: str = ""
    """A thing's name, ``ahead``, or empty for where one looked before."""

    def hand(self, side: str) -> Hand:
        """What a hand does."""
        return self.hands.get(side, RESTS)


Script = tuple[Phase, ...]

STAND = Phase("stand", 0.6, look="ahead")


def reach_and_return(thing: str, *, side: str = "right", grip: str = "top") -> Script:
    """Reach for a thing, touch it for a moment, and let the hand sink."""
    return touch(thing, side=side, grip=grip, seconds=0.25)


def touch(thing: str, *, side: str = "right", grip: str = "top", seconds: float = 0.8) -> Script:
    """Lay a hand on a thing, keep it there, and go back."""
    return (
        STAND,
        Phase("reach", 1.0, {side: Hand("reaches", thing, grip)}, look=thing),
        Phase("touch", seconds, {side: Hand("holds", thing, grip)}, look=thing),
        Phase("return", 1.0, look="ahead"),
        Phase("stand", 0.6, look="ahead"),
    )


def touch_from_rest(
    thing: str, *, side: str = "right", grip: str = "top", seconds: float = 1.4
) -> Script:
    """Lay a hand on a thing, and keep it there to the end (thesis 5.2.2)."""
    return (
        STAND,
        Phase("reach", 1.0, {side: Hand("reaches", thing, grip)}, look=thing),
        Phase("touch", seconds, {side: Hand("holds", thing, grip)}, look=thing),
    )


def slide(thing: str, by: tuple[float, float, float], *, side: str = "right") -> Script:
    """Take a thing at its side and slide it along what it stands on."""
    held = {side: Hand("holds", thing)}
    return (
        STAND,
        Phase("reach", 1.0, {side: Hand("reaches", thing)}, look=thing),
        Phase("grasp", 0.3, held, look=thing),
        Phase("slide", 0.9, held, {thing: Move(by)}, look=thing),
        Phase("hold", 0.3, held, look=thing),
        Phase("return", 1.0, look="ahead"),
        Phase("stand", 0.6, look="ahead"),
    )


def carry_together(
    thing: str, beside: tuple[str, ...], by: tuple[float, float, float], *, side: str = "right"
) -> Script:
    """Take several things in one palm, lift them, carry them aside and put them down together.

    Args:
        thing: On which the middle of the palm lies.
        beside: The others.
        by: How far they are carried, the height being that of the lift [m].
        side: Which hand.
    """
    hand = Hand("holds", thing, beside=beside)
    held, (x, y, up) = {side: hand}, by

    def all_move(*way: float) -> dict[str, Move]:
        return {name: Move((way[0], way[1], way[2])) for name in (thing, *beside)}

    return (
        STAND,
        Phase("reach", 1.0, {side: replace(hand, does="reaches")}, look=thing),
        Phase("grasp", 0.4, held, look=thing),
        Phase("lift", 0.9, held, all_move(0.0, 0.0, up), look=thing),
        Phase("carry", 0.9, held, all_move(x, y, 0.0), look=thing),
        Phase("lower", 0.9, held, all_move(0.0, 0.0, -up), look=thing),
        Phase("release", 0.4, held, look=thing),
        Phase("return", 1.0, look="ahead"),
        Phase("stand", 0.6, look="ahead"),
    )


def push(thing: str, by: tuple[float, float, float], *, side: str = "right") -> Script:
    """Lay a palm on the near side of a thing and push it away over what it stands on."""
    held = {side: Hand("holds", thing, "back")}
    return (
        STAND,
        Phase("reach", 1.1, {side: Hand("reaches", thing, "back")}, look=thing),
        Phase("touch", 0.4, held, look=thing),
        Phase("push", 0.9, held, {thing: Move(by)}, look=thing),
        Phase("hold", 0.3, held, look=thing),
        Phase("return", 1.0, look="ahead"),
        Phase("stand", 0.6, look="ahead"),
    )


def push_open(
    thing: str, angle: float, *, hinge: tuple[float, float, float], side: str = "right"
) -> Script:
    """Lay a palm on a door and push it away about its hinge.

    Args:
        thing: The door.
        angle: How far, seen from above against the clock [rad].
        hinge: A point of its upright hinge in its frame [m].
        side: Which hand.
    """
    held = {side: Hand("holds", thing, "back")}
    move = Move(turn=(0.0, 0.0, angle), about=hinge)
    return (
        STAND,
        Phase("reach", 1.1, {side: Hand("reaches", thing, "back")}, look=thing),
        Phase("touch", 0.4, held, look=thing),
        Phase("open", 1.2, held, {thing: move}, look=thing),
        Phase("hold", 0.4, held, look=thing),
        Phase("return", 1.1, look="ahead"),
        Phase("stand", 0.6, look="ahead"),
    )


def pull_open(thing: str, by_m: float, *, side: str = "right") -> Script:
    """Lay a hand on top of a drawer and pull it out, towards oneself [m]."""
    held = {side: Hand("holds", thing, "top")}
    return (
        STAND,
        Phase("reach", 1.0, {side: Hand("reaches", thing, "top")}, look=thing),
        Phase("touch", 0.4, held, look=thing),
        Phase("open", 1.0, held, {thing: Move((-by_m, 0.0, 0.0))}, look=thing),
        Phase("hold", 0.4, held, look=thing),
        Phase("return", 1.0, look="ahead"),
        Phase("stand", 0.6, look="ahead"),
    )


def wipe(thing: str, by_m: float, *, strokes: int = 6, side: str = "right") -> Script:
    """Lay a hand on a thing and move it to and fro over what it lies on.

    Args:
        thing: What is wiped with.
        by_m: How far each stroke leads to a side [m].
        strokes: How many, there and back counted apart.
        side: Which hand.
    """
    held = {side: Hand("holds", thing, "top")}
    ways = [by_m if number % 2 == 0 else -by_m for number in range(strokes)]
    return (
        STAND,
        Phase("reach", 1.0, {side: Hand("reaches", thing, "top")}, look=thing),
        Phase("touch", 0.4, held, look=thing),
        *(Phase("stroke", 0.5, held, {thing: Move((0.0, way, 0.0))}, look=thing) for way in ways),
        Phase("hold", 0.4, held, look=thing),
        Phase("return", 1.0, look="ahead"),
        Phase("stand", 0.6, look="ahead"),
    )


def turn(thing: str, angle: float, *, side: str = "right") -> Script:
    """Take a thing at its side and turn it about the vertical where it stands.

    Args:
        thing: What is turned.
        angle: How far, seen from above against the clock [rad].
        side: Which hand.
    """
    held = {side: Hand("holds", thing)}
    return (
        STAND,
        Phase("reach", 1.0, {side: Hand("reaches", thing)}, look=thing),
        Phase("grasp", 0.4, held, look=thing),
        Phase("turn", 0.9, held, {thing: Move(turn=(0.0, 0.0, angle))}, look=thing),
        Phase("hold", 0.4, held, look=thing),
        Phase("return", 1.0, look="ahead"),
        Phase("stand", 0.6, look="ahead"),
    )


def pour(
    thing: str, *, lift: float, over: tuple[float, float, float], angle: float, side: str = "right"
) -> Script:
    """Take a thing, bring it to what it is emptied into, lean it over, and put it back.

    Args:
        thing: What is emptied.
        lift: How high it is lifted first [m].
        over: How far it then goes [m].
        angle: How far it leans over, away from the hand's palm [rad].
        side: Which hand.
    """
    held = {side: Hand("holds", thing)}
    leant = (-angle if side == "right" else angle, 0.0, 0.0)
    return (
        STAND,
        Phase("reach", 1.0, {side: Hand("reaches", thing)}, look=thing),
        Phase("grasp", 0.4, held, look=thing),
        Phase("lift", 0.9, held, {thing: Move((0.0, 0.0, lift))}, look=thing),
        Phase("bring", 0.9, held, {thing: Move(over)}, look=thing),
        Phase("stay", 0.4, held, look=thing),
        Phase("lean", 1.0, held, {thing: Move(turn=leant)}, look=thing),
        Phase("pour", 0.5, held, look=thing),
        Phase("right", 1.0, held, {thing: Move(turn=_reversed(leant))}, look=thing),
        Phase("stay", 0.4, held, look=thing),
        Phase("bring back", 0.9, held, {thing: Move(_reversed(over))}, look=thing),
        Phase("stay", 0.4, held, look=thing),
        Phase("lower", 0.9, held, {thing: Move(home=True)}, look=thing),
        Phase("release", 0.4, held, look=thing),
        Phase("return", 1.0, look="ahead"),
        Phase("stand", 0.6, look="ahead"),
    )


def _reversed(way: tuple[float, float, float]) -> tuple[float, float, float]:
    x, y, z = way
    return -x, -y, -z


def drink(thing: str, *, side: str = "right", tilt: float = float(np.radians(35.0))) -> Script:
    """Take a cup, drink, put it back, and go back."""
    held = {side: Hand("holds", thing)}
    mouth = Move(to_mouth=True, tilt=tilt)
    return (
        STAND,
        Phase("reach", 1.0, {side: Hand("reaches", thing)}, look=thing),
        Phase("grasp", 0.3, held, look=thing),
        Phase("raise", 1.1, held, {thing: mouth}, look="ahead"),
        Phase("drink", 0.8, held, {thing: mouth}, look="ahead"),
        Phase("lower", 1.2, held, {thing: Move(home=True)}, look=thing),
        Phase("release", 0.3, held, look=thing),
        Phase("return", 1.0, look="ahead"),
        Phase("stand", 0.6, look="ahead"),
    )


def sip(thing: str, *, side: str = "right", tilt: float = float(np.radians(40.0))) -> Script:
    """Drink from a cup in one go, in the six steps and about the times of thesis 5.2.1.

    The cup is raised as soon as it is held, tipped further at the mouth, put back and let go.
    """
    held = {side: Hand("holds", thing)}
    return (
        Phase("stand", 0.8, look="ahead"),
        Phase("reach", 1.0, {side: Hand("reaches", thing)}, look=thing),
        Phase("raise", 0.8, held, {thing: Move(to_mouth=True, tilt=0.4 * tilt)}, look="ahead"),
        Phase("drink", 0.13, held, {thing: Move(to_mouth=True, tilt=tilt)}, look="ahead"),
        Phase("lower", 0.58, held, {thing: Move(home=True)}, look=thing),
        Phase("release", 0.19, held, look=thing),
        Phase("return", 0.75, look="ahead"),
    )


def lift_with_both_hands(thing: str, *, height: float = 0.25) -> Script:
    """Take a thing between both palms, lift it, hold it, and put it back."""
    both = {side: Hand("holds", thing) for side in SIDES}
    return (
        STAND,
        Phase("reach", 1.1, {side: Hand("reaches", thing) for side in SIDES}, look=thing),
        Phase("grasp", 0.3, both, look=thing),
        Phase("lift", 1.0, both, {thing: Move((0.0, 0.0, height))}, look=thing),
        Phase("hold", 0.5, both, look=thing),
        Phase("lower", 1.0, both, {thing: Move(home=True)}, look=thing),
        Phase("release", 0.3, both, look=thing),
        Phase("return", 1.0, look="ahead"),
        Phase("stand", 0.6, look="ahead"),
    )


def at_pace(script: Script, pace: float) -> Script:
    """The same, every phase that many times as fast."""
    return tuple(replace(each, seconds=each.seconds / pace) for each in script)


def minimum_jerk(share: float) -> float:
    """How far along the way after a share of the time [1] (Flash & Hogan 1985)."""
    s = min(max(share, 0.0), 1.0)
    return s**3 * (10.0 - 15.0 * s + 6.0 * s * s)


def between(first: RigidTransform, last: RigidTransform, way: float) -> RigidTransform:
    """The pose part of the way from one to the other: straight, turning about one axis."""
    turn = (last.rotation * first.rotation.inv()).as_rotvec()
    spot = first.translation + way * (last.translation - first.translation)
    return RigidTransform.from_components(
        spot, type(first.rotation).from_rotvec(way * turn) * first.rotation
    )


def turned_about(
    pose: RigidTransform, point: tuple[float, float, float], turn: Rotation
) -> RigidTransform:
    """A pose turned about a point of its own frame [m], in the world's axes."""
    there = RigidTransform.from_translation(pose.apply(point))
    return there * RigidTransform.from_rotation(turn) * there.inv() * pose


VELOCITY: Vector = (0.0, 1.1, 1.4)
"""With which the right hand throws: to the left and upwards [m/s]."""

SWINGS_S, FLIES_S, STOPS_S = 0.3, 0.3, 0.25
"""How long the throw, the flight and the stop take [s]."""

LIFT: Vector = (0.0, -0.08, 0.16)
"""From where the thing stands to where the throw begins [m]."""

BESIDE = np.array([0.0, 0.04, -0.02])
"""From where the thing is caught to where the hand waits as if it held it there [m]."""


def toss(thing: str) -> Script:
    """Take a thing, throw it to the left hand, catch it there, and put it down.

    Args:
        thing: What is thrown.
    """
    thrown = np.array(VELOCITY)
    caught = thrown + GRAVITY_MPS2 * FLIES_S
    # A hand that speeds up or slows down evenly covers half of the speed times the time.
    swing, stop = 0.5 * SWINGS_S * thrown, 0.5 * STOPS_S * caught
    flight = FLIES_S * thrown + 0.5 * GRAVITY_MPS2 * FLIES_S**2
    meets = LIFT + swing + flight
    down = -float((meets + stop)[2])
    right, left = {"right": Hand("holds", thing)}, {"left": Hand("holds", thing)}
    waits = {**right, "left": Hand("awaits", thing, awaited=_vector(meets + BESIDE))}
    swings_on = {"right": Hand("lets_go", thing, velocity=VELOCITY)}
    flies = {**swings_on, "left": Hand("reaches", thing)}
    catches = {"right": Hand("lets_go", thing), **left}
    throws = Move(_vector(swing), toss=Toss(end=VELOCITY))
    falls = Move(_vector(flight), toss=Toss(VELOCITY, falls=True))
    stops = Move(_vector(stop), toss=Toss(_vector(caught)))
    return (
        STAND,
        Phase("reach", 1.0, {"right": Hand("reaches", thing)}, look=thing),
        Phase("grasp", 0.3, right, look=thing),
        Phase("lift", 0.9, waits, {thing: Move(LIFT)}, look=thing),
        Phase("poise", 0.5, waits, look=thing),
        Phase("throw", SWINGS_S, waits, {thing: throws}, look=thing),
        Phase("fly", FLIES_S, flies, {thing: falls}, look=thing),
        Phase("catch", STOPS_S, catches, {thing: stops}, look=thing),
        Phase("hold", 0.4, catches, look=thing),
        Phase("lower", 0.9, catches, {thing: Move((0.0, 0.0, down))}, look=thing),
        Phase("release", 0.4, catches, look=thing),
        Phase("return", 1.0, look="ahead"),
        Phase("stand", 0.6, look="ahead"),
    )


def _vector(values: np.ndarray) -> Vector:
    x, y, z = (float(value) for value in values)
    return x, y, z
