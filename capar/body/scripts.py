"""What a performer does: phases of stated length, one after the other, and scripts of actions."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace

import numpy as np
from jaxtyping import Float
from scipy.spatial.transform import RigidTransform, Rotation

from extractors.readers.names import SIDES as SIDES

Vector = tuple[float, float, float]

GRAVITY_MPS2 = np.array([0.0, 0.0, -9.81])
"""Standard gravity, rounded [m/s^2]."""

THROWN_MPS: Vector = (0.0, 1.1, 1.4)
"""Velocity with which the right hand throws: to the left and upwards [m/s]."""

SWINGS_S, FLIES_S, STOPS_S = 0.3, 0.3, 0.25
"""How long a throw, the flight and the stop take [s]."""

THROW_FROM_M: Vector = (0.0, -0.08, 0.16)
"""From where the object stands to where the throw begins [m]."""

AWAITED_M = np.array([0.0, 0.04, -0.02])
"""From where the object is caught to where the hand waits as if it held it there [m]."""


@dataclass(frozen=True)
class Toss:
    """What moves an object in a phase in which it is thrown, flies or is caught."""

    start: Vector = (0.0, 0.0, 0.0)
    """Velocity with which it begins [m/s]."""

    end: Vector = (0.0, 0.0, 0.0)
    """Velocity with which it ends; ignored where it falls [m/s]."""

    falls: bool = False
    """Whether nothing but gravity moves it."""


@dataclass(frozen=True)
class Hand:
    """What one hand does in a phase."""

    does: str
    """``rests`` at the side, ``reaches`` for an object, ``holds`` on to it, ``awaits`` it where it
    will be, or ``lets_go`` of it and swings on a little."""

    thing: str = ""
    grip: str = "side"
    """``side``, ``top`` or ``back``, which is the side that faces the performer."""

    beside: tuple[str, ...] = ()
    """Other objects that lie in the same palm."""

    awaited: Vector = (0.0, 0.0, 0.0)
    """Where the object is awaited, from where it stands at first [m]."""

    velocity: Vector = (0.0, 0.0, 0.0)
    """With which an object is let go [m/s]."""


RESTS = Hand("rests")


@dataclass(frozen=True)
class Move:
    """Where a held object goes in a phase."""

    by: Vector = (0.0, 0.0, 0.0)
    """Displacement from where it is [m]."""

    turn: Vector = (0.0, 0.0, 0.0)
    """How it turns meanwhile about its frame's origin, in the world's axes [rad]."""

    about: Vector = (0.0, 0.0, 0.0)
    """A point of the object's frame about which it turns instead, as on a hinge [m]."""

    lift: float = 0.0
    """Height of the arc above the straight path [m]."""

    to_mouth: bool = False
    tilt: float = 0.0
    """Turn of its top towards the face at the mouth [rad]."""

    home: bool = False
    """Whether it goes back to where it stood at the beginning."""

    toss: Toss | None = None
    """How it is thrown, flies or is caught; an object that is moved otherwise begins at rest."""


@dataclass(frozen=True)
class Phase:
    """An interval in which hands and objects go from one place to another."""

    name: str
    seconds: float
    hands: Mapping[str, Hand] = field(default_factory=dict)
    """By side; a hand that is not named rests."""

    moves: Mapping[str, Move] = field(default_factory=dict)
    look: str = ""
    """An object's name, ``ahead``, or empty for where one looked before."""

    def hand(self, side: str) -> Hand:
        """What a hand does."""
        return self.hands.get(side, RESTS)


Script = tuple[Phase, ...]
Step = tuple[str, float, Mapping[str, Move]]
"""Name, length [s] and moves of a phase in which something is held."""

STAND = Phase("stand", 0.6, look="ahead")


def handling(
    hands: Mapping[str, Hand], steps: Sequence[Step], *, reach_s: float = 1.0, back_s: float = 1.0
) -> Script:
    """Stand, reach for an object, go through steps while it is held, and return.

    Args:
        hands: That hold it, by side.
        steps: What happens meanwhile; the gaze is on the object, or ahead if it is at the mouth.
        reach_s: How long reaching takes [s].
        back_s: How long the way back takes [s].
    """
    thing = next(iter(hands.values())).thing
    reaching = {side: replace(hand, does="reaches") for side, hand in hands.items()}

    def look(moves: Mapping[str, Move]) -> str:
        return "ahead" if any(move.to_mouth for move in moves.values()) else thing

    return (
        STAND,
        Phase("reach", reach_s, reaching, look=thing),
        *(Phase(name, seconds, hands, moves, look(moves)) for name, seconds, moves in steps),
        Phase("return", back_s, look="ahead"),
        STAND,
    )


def touch(thing: str, *, side: str = "right", grip: str = "top", seconds: float = 0.8) -> Script:
    """Lay a hand on an object, keep it there, and go back."""
    return handling({side: Hand("holds", thing, grip)}, [("touch", seconds, {})])


def touch_from_rest(
    thing: str, *, side: str = "right", grip: str = "top", seconds: float = 1.4
) -> Script:
    """Lay a hand on an object, and keep it there to the end (thesis 5.2.2)."""
    return touch(thing, side=side, grip=grip, seconds=seconds)[:3]


def slide(thing: str, by: Vector, *, side: str = "right") -> Script:
    """Take an object at its side and slide it along what it stands on, by so far [m]."""
    steps: list[Step] = [("grasp", 0.3, {}), ("slide", 0.9, {thing: Move(by)}), ("hold", 0.3, {})]
    return handling({side: Hand("holds", thing)}, steps)


def carry(thing: str, *, up_m: float = 0.2, left_m: float = 0.2, side: str = "right") -> Script:
    """Lift an object, carry it to the left and put it down."""
    steps: list[Step] = [
        ("grasp", 0.3, {}),
        ("lift", 0.8, {thing: Move((0.0, 0.0, up_m))}),
        ("carry", 0.9, {thing: Move((0.0, left_m, 0.0))}),
        ("lower", 0.8, {thing: Move((0.0, 0.0, -up_m))}),
        ("hold", 0.3, {}),
    ]
    return handling({side: Hand("holds", thing)}, steps)


def carry_tray(tray: str, load: str, *, up_m: float = 0.15, nearer_m: float = 0.12) -> Script:
    """Lift a tray with both hands, carry it nearer with what stands on it, and put it down."""

    def both(ahead_m: float, rise_m: float) -> dict[str, Move]:
        return {name: Move((ahead_m, 0.0, rise_m)) for name in (tray, load)}

    steps: list[Step] = [
        ("grasp", 0.3, {}),
        ("lift", 1.0, both(0.0, up_m)),
        ("carry", 1.1, both(-nearer_m, 0.0)),
        ("lower", 1.0, both(0.0, -up_m)),
        ("release", 0.3, {}),
    ]
    return handling({side: Hand("holds", tray) for side in SIDES}, steps, reach_s=1.1)


def carry_together(
    thing: str, beside: tuple[str, ...], by: Vector, *, side: str = "right"
) -> Script:
    """Take several objects in one palm, lift them, carry them aside and put them down together.

    Args:
        thing: On which the middle of the palm lies.
        beside: The others.
        by: How far they are carried, the height being that of the lift [m].
        side: Which hand.
    """
    x, y, up = by

    def all_move(*way: float) -> dict[str, Move]:
        return {name: Move((way[0], way[1], way[2])) for name in (thing, *beside)}

    steps: list[Step] = [
        ("grasp", 0.4, {}),
        ("lift", 0.9, all_move(0.0, 0.0, up)),
        ("carry", 0.9, all_move(x, y, 0.0)),
        ("lower", 0.9, all_move(0.0, 0.0, -up)),
        ("release", 0.4, {}),
    ]
    return handling({side: Hand("holds", thing, beside=beside)}, steps)


def push(thing: str, by: Vector, *, side: str = "right") -> Script:
    """Lay a palm on the near side of an object and push it away over what it stands on."""
    steps: list[Step] = [("touch", 0.4, {}), ("push", 0.9, {thing: Move(by)}), ("hold", 0.3, {})]
    return handling({side: Hand("holds", thing, "back")}, steps, reach_s=1.1)


def push_open(thing: str, angle: float, *, hinge: Vector, side: str = "right") -> Script:
    """Lay a palm on a door and push it away about its hinge.

    Args:
        thing: The door.
        angle: How far, seen from above against the clock [rad].
        hinge: A point of its upright hinge in its frame [m].
        side: Which hand.
    """
    move = Move(turn=(0.0, 0.0, angle), about=hinge)
    steps: list[Step] = [("touch", 0.4, {}), ("open", 1.2, {thing: move}), ("hold", 0.4, {})]
    return handling({side: Hand("holds", thing, "back")}, steps, reach_s=1.1, back_s=1.1)


def pull_open(thing: str, by_m: float, *, side: str = "right") -> Script:
    """Lay a hand on top of a drawer and pull it out, towards oneself [m]."""
    move = Move((-by_m, 0.0, 0.0))
    steps: list[Step] = [("touch", 0.4, {}), ("open", 1.0, {thing: move}), ("hold", 0.4, {})]
    return handling({side: Hand("holds", thing, "top")}, steps)


def wipe(thing: str, by_m: float, *, strokes: int = 6, side: str = "right") -> Script:
    """Lay a hand on an object and move it to and fro over what it lies on.

    Args:
        thing: What is wiped with.
        by_m: How far each stroke leads to a side [m].
        strokes: How many, there and back counted apart.
        side: Which hand.
    """
    moves = [Move((0.0, by_m if number % 2 == 0 else -by_m, 0.0)) for number in range(strokes)]
    steps: list[Step] = [("stroke", 0.5, {thing: move}) for move in moves]
    steps = [("touch", 0.4, {}), *steps, ("hold", 0.4, {})]
    return handling({side: Hand("holds", thing, "top")}, steps)


def turn(thing: str, angle: float, *, side: str = "right") -> Script:
    """Take an object at its side and turn it about the vertical where it stands, by [rad]."""
    move = Move(turn=(0.0, 0.0, angle))
    steps: list[Step] = [("grasp", 0.4, {}), ("turn", 0.9, {thing: move}), ("hold", 0.4, {})]
    return handling({side: Hand("holds", thing)}, steps)


def pour(thing: str, *, lift: float, over: Vector, angle: float, side: str = "right") -> Script:
    """Take an object, bring it to what it is emptied into, lean it over, and put it back.

    Args:
        thing: What is emptied.
        lift: How high it is lifted first [m].
        over: How far it then goes [m].
        angle: How far it leans over, away from the hand's palm [rad].
        side: Which hand.
    """
    leant = -angle if side == "right" else angle
    x, y, z = over
    steps: list[Step] = [
        ("grasp", 0.4, {}),
        ("lift", 0.9, {thing: Move((0.0, 0.0, lift))}),
        ("bring", 0.9, {thing: Move(over)}),
        ("stay", 0.4, {}),
        ("lean", 1.0, {thing: Move(turn=(leant, 0.0, 0.0))}),
        ("pour", 0.5, {}),
        ("right", 1.0, {thing: Move(turn=(-leant, -0.0, -0.0))}),
        ("stay", 0.4, {}),
        ("bring back", 0.9, {thing: Move((-x, -y, -z))}),
        ("stay", 0.4, {}),
        ("lower", 0.9, {thing: Move(home=True)}),
        ("release", 0.4, {}),
    ]
    return handling({side: Hand("holds", thing)}, steps)


def drink(thing: str, *, side: str = "right", tilt: float = float(np.radians(35.0))) -> Script:
    """Take a cup, drink, put it back, and go back."""
    mouth = {thing: Move(to_mouth=True, tilt=tilt)}
    steps: list[Step] = [
        ("grasp", 0.3, {}),
        ("raise", 1.1, mouth),
        ("drink", 0.8, mouth),
        ("lower", 1.2, {thing: Move(home=True)}),
        ("release", 0.3, {}),
    ]
    return handling({side: Hand("holds", thing)}, steps)


def sip(thing: str, *, side: str = "right", tilt: float = float(np.radians(40.0))) -> Script:
    """Drink from a cup in one go, in the six steps and about the times of thesis 5.2.1.

    The cup is raised as soon as it is held, tipped further at the mouth, put back and let go.
    """
    steps: list[Step] = [
        ("raise", 0.8, {thing: Move(to_mouth=True, tilt=0.4 * tilt)}),
        ("drink", 0.13, {thing: Move(to_mouth=True, tilt=tilt)}),
        ("lower", 0.58, {thing: Move(home=True)}),
        ("release", 0.19, {}),
    ]
    _, *phases, _ = handling({side: Hand("holds", thing)}, steps, back_s=0.75)
    return (replace(STAND, seconds=0.8), *phases)


def lift_with_both_hands(thing: str, *, height: float = 0.25) -> Script:
    """Take an object between both palms, lift it, hold it, and put it back."""
    steps: list[Step] = [
        ("grasp", 0.3, {}),
        ("lift", 1.0, {thing: Move((0.0, 0.0, height))}),
        ("hold", 0.5, {}),
        ("lower", 1.0, {thing: Move(home=True)}),
        ("release", 0.3, {}),
    ]
    return handling({side: Hand("holds", thing) for side in SIDES}, steps, reach_s=1.1)


def toss(thing: str) -> Script:
    """Take an object, throw it to the left hand, catch it there, and put it down."""
    thrown = np.array(THROWN_MPS)
    caught = thrown + GRAVITY_MPS2 * FLIES_S
    # A hand that speeds up or slows down evenly covers half of the speed times the time.
    swing, stop = 0.5 * SWINGS_S * thrown, 0.5 * STOPS_S * caught
    flight = FLIES_S * thrown + 0.5 * GRAVITY_MPS2 * FLIES_S**2
    meets = THROW_FROM_M + swing + flight
    down = -float((meets + stop)[2])
    right, left = {"right": Hand("holds", thing)}, {"left": Hand("holds", thing)}
    waits = {**right, "left": Hand("awaits", thing, awaited=vector(meets + AWAITED_M))}
    swings_on = {"right": Hand("lets_go", thing, velocity=THROWN_MPS)}
    flies = {**swings_on, "left": Hand("reaches", thing)}
    catches = {"right": Hand("lets_go", thing), **left}
    throws = Move(vector(swing), toss=Toss(end=THROWN_MPS))
    falls = Move(vector(flight), toss=Toss(THROWN_MPS, falls=True))
    stops = Move(vector(stop), toss=Toss(vector(caught)))
    return (
        STAND,
        Phase("reach", 1.0, {"right": Hand("reaches", thing)}, look=thing),
        Phase("grasp", 0.3, right, look=thing),
        Phase("lift", 0.9, waits, {thing: Move(THROW_FROM_M)}, look=thing),
        Phase("poise", 0.5, waits, look=thing),
        Phase("throw", SWINGS_S, waits, {thing: throws}, look=thing),
        Phase("fly", FLIES_S, flies, {thing: falls}, look=thing),
        Phase("catch", STOPS_S, catches, {thing: stops}, look=thing),
        Phase("hold", 0.4, catches, look=thing),
        Phase("lower", 0.9, catches, {thing: Move((0.0, 0.0, down))}, look=thing),
        Phase("release", 0.4, catches, look=thing),
        Phase("return", 1.0, look="ahead"),
        STAND,
    )


def hand_over(thing: str, thing_to_offer: Vector, offer_to_table: Vector) -> dict[str, Script]:
    """One takes an object from the table and holds it out, another takes it and puts it down.

    Args:
        thing: What is handed over.
        thing_to_offer: From where it stands to where it is handed over [m].
        offer_to_table: From there to where it is put down [m].

    Returns:
        The scripts of the ``giver`` and of the ``taker``.
    """
    held, reached = ({"right": Hand(does, thing)} for does in ("holds", "reaches"))
    out: dict[str, list[Phase]] = {"giver": [], "taker": []}
    for name, seconds, gives, takes in (
        ("stand", 0.6, {}, {}),
        ("reach", 1.0, reached, {}),
        ("grasp", 0.4, held, {}),
        ("offer", 1.1, held, {}),
        ("take", 1.1, held, reached),
        ("share", 0.5, held, held),
        ("leave", 1.0, {}, held),
        ("set down", 1.0, {}, held),
        ("let go", 0.4, {}, held),
        ("return", 1.0, {}, {}),
        ("end", 0.6, {}, {}),
    ):
        moves = {"giver": {"offer": thing_to_offer}, "taker": {"set down": offer_to_table}}
        for who, hands in (("giver", gives), ("taker", takes)):
            by = moves[who].get(name)
            watches = hands or (who, name) == ("taker", "offer")
            look = thing if watches else "ahead"
            out[who].append(Phase(name, seconds, hands, {thing: Move(by)} if by else {}, look))
    return {who: tuple(phases) for who, phases in out.items()}


def at_pace(script: Script, pace: float) -> Script:
    """The same, every phase that many times as fast."""
    return tuple(replace(each, seconds=each.seconds / pace) for each in script)


def vector(values: np.ndarray) -> Vector:
    """Three numbers of an array."""
    x, y, z = (float(value) for value in values)
    return x, y, z


def minimum_jerk(share: float) -> float:
    """How far along the path after a share of the time [1] (Flash & Hogan 1985)."""
    s = min(max(share, 0.0), 1.0)
    return s**3 * (10.0 - 15.0 * s + 6.0 * s * s)


def between(first: RigidTransform, last: RigidTransform, way: float) -> RigidTransform:
    """The pose part of the way from one to the other: straight, turning about one axis."""
    turn = (last.rotation * first.rotation.inv()).as_rotvec()
    spot = first.translation + way * (last.translation - first.translation)
    return RigidTransform.from_components(
        spot, type(first.rotation).from_rotvec(way * turn) * first.rotation
    )


def turned_about(pose: RigidTransform, point: Vector, turn: Rotation) -> RigidTransform:
    """A pose turned about a point of its own frame [m], in the world's axes."""
    there = RigidTransform.from_translation(pose.apply(point))
    return there * RigidTransform.from_rotation(turn) * there.inv() * pose


def tossed(toss: Toss, by: Vector, seconds: float, share: float) -> Float[np.ndarray, "3"]:
    """Displacement of an object since its phase began [m], in the world's axes.

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
