"""Facts about what is handled: its places and turns, and how bodies lie to each other."""

from dataclasses import dataclass

from capar.model.atoms import Fact


@dataclass(frozen=True, slots=True, order=True)
class Displaced(Fact):
    """An object that moves is elsewhere than where it rested, to a hair's width."""

    predicate = "displaced"
    object: str
    first: int
    last: int


@dataclass(frozen=True, slots=True, order=True)
class Resting(Fact):
    """An end-effector is at a place where it rests, from the first to the last frame."""

    predicate = "resting"
    ee: str
    first: int
    last: int


@dataclass(frozen=True, slots=True, order=True)
class Place(Fact):
    """Where the middle of a body is at a frame [millimetres]."""

    predicate = "place"
    body: str
    frame: int
    x: int
    y: int
    z: int


@dataclass(frozen=True, slots=True, order=True)
class Travelled(Fact):
    """How far a body has gone along its path, and turned, since the capture began.

    The way in millimetres, and the turn about any axis in milliradians.
    """

    predicate = "travelled"
    body: str
    frame: int
    way: int
    turn: int


@dataclass(frozen=True, slots=True, order=True)
class Posture(Fact):
    """How a body stands at a frame [milliradians].

    How far its upright axis is from the vertical, and the angle by which it has turned about the
    vertical since the capture began.
    """

    predicate = "posture"
    body: str
    frame: int
    lean: int
    spin: int


@dataclass(frozen=True, slots=True, order=True)
class Apart(Fact):
    """How far the middles of two bodies are apart at a frame [millimetres]."""

    predicate = "apart"
    body: str
    other: str
    frame: int
    millimetres: int


@dataclass(frozen=True, slots=True, order=True)
class Wound(Fact):
    """The angle by which a body has gone about another, seen from above [milliradians]."""

    predicate = "wound"
    body: str
    other: str
    frame: int
    milliradians: int


@dataclass(frozen=True, slots=True, order=True)
class Upward(Fact):
    """How far the normal of a contact points up, from the other to the body [1/1000].

    Stated at the contact's first frame; 1000 where the body lies on the other.
    """

    predicate = "upward"
    body: str
    other: str
    first: int
    permille: int


@dataclass(frozen=True, slots=True, order=True)
class Closing(Fact):
    """How fast two bodies approached each other when they began to touch [mm/s]."""

    predicate = "closing"
    body: str
    other: str
    first: int
    speed: int


@dataclass(frozen=True, slots=True, order=True)
class Reverses(Fact):
    """The height of a moving object has an extremum, with a real way before and after it."""

    predicate = "reverses"
    object: str
    frame: int


@dataclass(frozen=True, slots=True, order=True)
class Swings(Fact):
    """A body moves to and fro, again and again, from the first to the last frame."""

    predicate = "swings"
    body: str
    first: int
    last: int


@dataclass(frozen=True, slots=True, order=True)
class Leans(Fact):
    """An object's upright axis is far from the vertical, from the first to the last frame."""

    predicate = "leans"
    object: str
    first: int
    last: int


@dataclass(frozen=True, slots=True, order=True)
class Flies(Fact):
    """An object falls freely, from the first to the last frame."""

    predicate = "flies"
    object: str
    first: int
    last: int


@dataclass(frozen=True, slots=True, order=True)
class Rolls(Fact):
    """An object goes and turns about a level axis without slipping below its middle."""

    predicate = "rolls"
    object: str
    first: int
    last: int


@dataclass(frozen=True, slots=True, order=True)
class Bears(Fact):
    """A foot that is down bears the whole weight of the body, part of it, or none."""

    predicate = "bears"
    foot: str
    share: str
    first: int
    last: int


@dataclass(frozen=True, slots=True, order=True)
class Lies(Fact):
    """How a body lies to another.

    It is inside it, or dips into it with one end; it is above, below, beside or along it, or
    merely near. An end-effector that touches it ``shifts`` from one place on it to another.
    """

    predicate = "lies"
    body: str
    how: str
    other: str
    first: int
    last: int


@dataclass(frozen=True, slots=True, order=True)
class Between(Fact):
    """A body's middle is between two others, from the first to the last frame."""

    predicate = "between"
    body: str
    one: str
    other: str
    first: int
    last: int


@dataclass(frozen=True, slots=True, order=True)
class Passage(Fact):
    """A stretch of being inside or above another ends at another side than it began.

    The first frame names the stretch; the sides are opposite or merely other ones.
    """

    predicate = "passage"
    body: str
    how: str
    other: str
    first: int
    sides: str
