"""What a performer does: phases of stated length, one after the other, and scripts of actions."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace

import numpy as np
from jaxtyping import Float
from scipy.spatial.transform import RigidTransform, Rotation

from extractors.readers.names import SIDES as SIDES

Vector = tuple[float, float, float]

GRAVITY_MPS2 = np.array([0.0, 0.0, -9.81])  # standard gravity, rounded [m/s^2]

#: Velocity with which the right hand throws: to the left and upwards [m/s]
THROWN_MPS: Vector = (0.0, 1.1, 1.4)
SWINGS_S, FLIES_S, STOPS_S = 0.3, 0.3, 0.25  # how long a throw, the flight and the stop take [s]

#: From where the object stands to where the throw begins [m]
THROW_FROM_M: Vector = (0.0, -0.08, 0.16)
#: From where the object is caught to where the hand waits as if it held it there [m]
AWAITED_M = np.array([0.0, 0.04, -0.02])


@dataclass(frozen=True)
class Toss:
    """What moves an object in a phase in which it is thrown, flies or is caught."""

    start: Vector = (0.0, 0.0, 0.0)  #: Velocity with which it begins [m/s]
    end: Vector = (0.0, 0.0, 0.0)  #: Velocity with which it ends; ignored where it falls [m/s]
    falls: bool = False  #: Whether nothing but gravity moves it


@dataclass(frozen=True)
class Hand:
    """What one hand does in a phase."""

    #: ``rests`` at the side, ``reaches`` for an object, ``holds`` on to it, ``awaits`` it where it
    #: will be, or ``lets_go`` of it and swings on a little
    does: str
    thing: str = ""
    grip: str = "side"  #: ``side``, ``top`` or ``back``, which is the side that faces the performer
    beside: tuple[str, ...] = ()  #: Other objects that lie in the same palm
    #: Where the object is awaited, from where it stands at first [m]
    awaited: Vector = (0.0, 0.0, 0.0)
    velocity: Vector = (0.0, 0.0, 0.0)  #: With which an object is let go [m/s]


RESTS = Hand("rests")


@dataclass(frozen=True)
class Move:
    """Where a held object goes in a phase."""

    by: Vector = (0.0, 0.0, 0.0)  #: Displacement from where it is [m]
    #: How it turns meanwhile about its frame's origin, in the world's axes [rad]
    turn: Vector = (0.0, 0.0, 0.0)
    #: A point of the object's frame about which it turns instead, as on a hinge [m]
    about: Vector = (0.0, 0.0, 0.0)
    lift: float = 0.0  #: Height of the arc above the straight path [m]
    to_mouth: bool = False
    tilt: float = 0.0  #: Turn of its top towards the face at the mouth [rad]
    home: bool = False  #: Whether it goes back to where it stood at the beginning
    #: How it is thrown, flies or is caught; an object that is moved otherwise begins at rest
    toss: Toss | None = None


@dataclass(frozen=True)
class Phase:
    """An interval in which hands and objects go from one place to another."""

    name: str
    seconds: float
    #: By side; a hand that is not named rests
    hands: Mapping[str, Hand] = field(default_factory=dict)
    moves: Mapping[str, Move] = field(default_factory=dict)
    look: str = ""  #: An object's name, ``ahead``, or empty for where one looked before

    def hand(self, side: str) -> Hand:
        """What a hand does."""
        return self.hands.get(side, RESTS)


Script = tuple[Phase, ...]
#: Name, length [s] and motion of the object in a phase in which it is held
Step = tuple[str, float, Move | None]
STAND = Phase("stand", 0.6, look="ahead")


def handling(
    thing: str,
    steps: Sequence[Step],
    *,
    sides: Sequence[str] = ("right",),
    grip: str = "side",
    beside: tuple[str, ...] = (),
    load: tuple[str, ...] = (),
    reach_s: float = 1.0,
    back_s: float = 1.0,
) -> Script:
    """Stand, reach for an object, go through steps while it is held, and return.

    What is beside it in the palm or loaded on it moves alike. The gaze is on it, or ahead while it
    is at the mouth. Reaching and returning take so long [s].
    """
    reaches, holds = (
        {side: Hand(does, thing, grip, beside) for side in sides} for does in ("reaches", "holds")
    )
    held = []
    for name, seconds, move in steps:
        moves = dict.fromkeys((thing, *beside, *load), move) if move else {}
        look = "ahead" if move and move.to_mouth else thing
        held.append(Phase(name, seconds, holds, moves, look))
    reach = Phase("reach", reach_s, reaches, look=thing)
    return (STAND, reach, *held, Phase("return", back_s, look="ahead"), STAND)


def touch(thing: str, *, side: str = "right", grip: str = "top", seconds: float = 0.8) -> Script:
    """Lay a hand on an object, keep it there, and go back."""
    return handling(thing, [("touch", seconds, None)], sides=(side,), grip=grip)


def slide(thing: str, by: Vector) -> Script:
    """Take an object at its side and slide it along what it stands on, by so far [m]."""
    return handling(thing, [("grasp", 0.3, None), ("slide", 0.9, Move(by)), ("hold", 0.3, None)])


def drink(thing: str) -> Script:
    """Take a cup, drink, put it back, and go back."""
    mouth = Move(to_mouth=True, tilt=float(np.radians(35.0)))
    return handling(
        thing,
        [
            ("grasp", 0.3, None),
            ("raise", 1.1, mouth),
            ("drink", 0.8, mouth),
            ("lower", 1.2, Move(home=True)),
            ("release", 0.3, None),
        ],
    )


def sip(
    thing: str, *, times_s: Sequence[float] = (0.8, 1.0, 0.8, 0.13, 0.58, 0.19, 0.75)
) -> Script:
    """Drink from a cup in one go, in the six steps of thesis 5.2.1.

    Standing, reaching, raising, drinking, lowering, releasing and returning take these times [s].
    """
    tilt = float(np.radians(40.0))
    stand_s, reach_s, raise_s, drink_s, lower_s, release_s, back_s = times_s
    steps: list[Step] = [
        ("raise", raise_s, Move(to_mouth=True, tilt=0.4 * tilt)),
        ("drink", drink_s, Move(to_mouth=True, tilt=tilt)),
        ("lower", lower_s, Move(home=True)),
        ("release", release_s, None),
    ]
    _, *phases, _ = handling(thing, steps, reach_s=reach_s, back_s=back_s)
    return (replace(STAND, seconds=stand_s), *phases)


def lift_with_both_hands(thing: str, *, height: float = 0.25) -> Script:
    """Take an object between both palms, lift it, hold it, and put it back."""
    steps: list[Step] = [
        ("grasp", 0.3, None),
        ("lift", 1.0, Move((0.0, 0.0, height))),
        ("hold", 0.5, None),
        ("lower", 1.0, Move(home=True)),
        ("release", 0.3, None),
    ]
    return handling(thing, steps, sides=SIDES, reach_s=1.1)


def toss(thing: str) -> Script:
    """Take an object, throw it to the left hand, catch it there, and put it down."""
    thrown = np.array(THROWN_MPS)
    caught = thrown + GRAVITY_MPS2 * FLIES_S
    # A hand that speeds up or slows down evenly covers half of the speed times the time.
    swing, stop = 0.5 * SWINGS_S * thrown, 0.5 * STOPS_S * caught
    flight = FLIES_S * thrown + 0.5 * GRAVITY_MPS2 * FLIES_S**2
    meets = THROW_FROM_M + swing + flight
    right, left = {"right": Hand("holds", thing)}, {"left": Hand("holds", thing)}
    waits = {**right, "left": Hand("awaits", thing, awaited=vector(meets + AWAITED_M))}
    swings_on = {"right": Hand("lets_go", thing, velocity=THROWN_MPS)}
    flies = {**swings_on, "left": Hand("reaches", thing)}
    catches = {"right": Hand("lets_go", thing), **left}
    rows: list[tuple[str, float, Mapping[str, Hand], Move | None]] = [
        ("reach", 1.0, {"right": Hand("reaches", thing)}, None),
        ("grasp", 0.3, right, None),
        ("lift", 0.9, waits, Move(THROW_FROM_M)),
        ("poise", 0.5, waits, None),
        ("throw", SWINGS_S, waits, Move(vector(swing), toss=Toss(end=THROWN_MPS))),
        ("fly", FLIES_S, flies, Move(vector(flight), toss=Toss(THROWN_MPS, falls=True))),
        ("catch", STOPS_S, catches, Move(vector(stop), toss=Toss(vector(caught)))),
        ("hold", 0.4, catches, None),
        ("lower", 0.9, catches, Move((0.0, 0.0, -float((meets + stop)[2])))),
        ("release", 0.4, catches, None),
    ]
    phases = (
        Phase(name, seconds, hands, {thing: move} if move else {}, thing)
        for name, seconds, hands, move in rows
    )
    return (STAND, *phases, Phase("return", 1.0, look="ahead"), STAND)


def hand_over(thing: str, thing_to_offer: Vector, offer_to_table: Vector) -> dict[str, Script]:
    """The ``giver`` takes an object and holds it out; the ``taker`` takes it and puts it down.

    It goes from the table to where it is offered, and from there to where it is put down [m].
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
    return RigidTransform.from_components(spot, Rotation.from_rotvec(way * turn) * first.rotation)


def turned_about(pose: RigidTransform, point: Vector, turn: Rotation) -> RigidTransform:
    """A pose turned about a point of its own frame [m], in the world's axes."""
    there = RigidTransform.from_translation(pose.apply(point))
    return there * RigidTransform.from_rotation(turn) * there.inv() * pose


def tossed(toss: Toss, by: Vector, seconds: float, share: float) -> Float[np.ndarray, "3"]:
    """Displacement of an object since its phase began [m], in the world's axes.

    In a hand along a cubic Hermite curve that has both velocities, else along the parabola of
    gravity; ``by`` is where a hand brings it [m], ``share`` how much of the phase has passed [1].
    """
    start, end, goal = np.array(toss.start), np.array(toss.end), np.array(by)
    if toss.falls:
        past = share * seconds
        return np.asarray(start * past + 0.5 * GRAVITY_MPS2 * past**2)
    leaving, arriving = share - 2.0 * share**2 + share**3, share**3 - share**2
    led = goal * (3.0 * share**2 - 2.0 * share**3)
    return np.asarray(led + seconds * (leaving * start + arriving * end))
