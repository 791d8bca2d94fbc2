"""Facts about what is handled: its places and turns, and how bodies lie to each other."""

from dataclasses import dataclass

from capar.model.declarations import Declaration, Observed, Span
from capar.model.scene_facts import Touching


@dataclass(frozen=True, slots=True, order=True)
class Displaced(Observed):
    """An object moves, from when it truly set off until it truly stopped.

    That is where it was last within 1 mm and half a degree of a place of rest, or what noise makes,
    and the little before that by which a motion from rest grows so far.
    """

    predicate = "displaced"
    declaration = Declaration(about="object", span=Span.INTERVAL, border=True, has_sentence=False)
    object: str
    first: int
    last: int


@dataclass(frozen=True, slots=True, order=True)
class Resting(Observed):
    """An end-effector is at a place where it rests, from the first to the last frame."""

    predicate = "resting"
    declaration = Declaration(
        about="ee",
        span=Span.INTERVAL,
        border=True,
        has_sentence=True,
        stretch="resting",
        negated="going",
    )
    ee: str
    first: int
    last: int


@dataclass(frozen=True, slots=True, order=True)
class Place(Observed):
    """Where the middle of a body is at a frame [millimetres]."""

    predicate = "place"
    declaration = Declaration(about="body", span=Span.INSTANT, border=False, has_sentence=True)
    body: str
    frame: int
    x: int
    y: int
    z: int


@dataclass(frozen=True, slots=True, order=True)
class Travelled(Observed):
    """How far a body has gone along its path, and turned, since the capture began.

    The way in millimetres, and the turn about any axis in milliradians.
    """

    predicate = "travelled"
    declaration = Declaration(about="body", span=Span.INSTANT, border=False, has_sentence=False)
    body: str
    frame: int
    way: int
    turn: int


@dataclass(frozen=True, slots=True, order=True)
class Posture(Observed):
    """How a body stands at a frame [milliradians].

    How far its upright axis is from the vertical, and the angle by which it has turned about the
    vertical since the capture began.
    """

    predicate = "posture"
    declaration = Declaration(about="body", span=Span.INSTANT, border=False, has_sentence=False)
    body: str
    frame: int
    lean: int
    spin: int


@dataclass(frozen=True, slots=True, order=True)
class Distance(Observed):
    """How far the middles of two bodies are apart at a frame [millimetres]."""

    predicate = "apart"
    declaration = Declaration(about="body", span=Span.INSTANT, border=False, has_sentence=False)
    body: str
    other: str
    frame: int
    millimetres: int


@dataclass(frozen=True, slots=True, order=True)
class SweptAzimuth(Observed):
    """The angle by which a body has gone about another, seen from above [milliradians]."""

    predicate = "wound"
    declaration = Declaration(about="body", span=Span.INSTANT, border=False, has_sentence=False)
    body: str
    other: str
    frame: int
    milliradians: int


@dataclass(frozen=True, slots=True, order=True)
class ContactNormal(Observed):
    """How far the normal of a contact points up, from the other to the body [1/1000].

    Stated at the contact's first frame; 1000 where the body lies on the other.
    """

    predicate = "upward"
    declaration = Declaration(about="body", span=Touching, border=False, has_sentence=False)
    body: str
    other: str
    first: int
    permille: int


@dataclass(frozen=True, slots=True, order=True)
class PressDirection(Observed):
    """Which way an end-effector presses aside on an object: x and y of the unit vector [1/1000].

    That is the normal of the contact, from the end-effector to the object, in the world.
    """

    predicate = "presses"
    declaration = Declaration(about="body", span=Touching, border=False, has_sentence=True)
    body: str
    other: str
    first: int
    x: int
    y: int


@dataclass(frozen=True, slots=True, order=True)
class SightNormal(Observed):
    """How far the normal of a contact with a head points where the head looks [1/1000].

    1000 where the face is touched from before it, 0 at the temples, -1000 at the back.
    """

    predicate = "sighted"
    declaration = Declaration(about="body", span=Touching, border=False, has_sentence=True)
    body: str
    other: str
    first: int
    permille: int


@dataclass(frozen=True, slots=True, order=True)
class Rides(Observed):
    """A body is borne by another one, in or on it, and goes along when that one moves.

    Stated of the contact that begins at the first frame.
    """

    predicate = "rides"
    declaration = Declaration(about="body", span=Touching, border=False, has_sentence=True)
    body: str
    other: str
    first: int


@dataclass(frozen=True, slots=True, order=True)
class ClosingSpeed(Observed):
    """How fast two bodies approached each other when they began to touch [mm/s]."""

    predicate = "closing"
    declaration = Declaration(about="body", span=Touching, border=False, has_sentence=True)
    body: str
    other: str
    first: int
    speed: int


@dataclass(frozen=True, slots=True, order=True)
class ReleaseSpeed(Observed):
    """How fast an object goes when an end-effector's contact with it ends [mm/s].

    Stated of the contact that begins at the first frame.
    """

    predicate = "released"
    declaration = Declaration(about="body", span=Touching, border=False, has_sentence=True)
    body: str
    other: str
    first: int
    speed: int


@dataclass(frozen=True, slots=True, order=True)
class Seated(Observed):
    """A body is down on another one that bears it: in a contact, less its coming and going."""

    predicate = "seated"
    declaration = Declaration(about="body", span=Span.INTERVAL, border=True, has_sentence=False)
    body: str
    other: str
    first: int
    last: int


@dataclass(frozen=True, slots=True, order=True)
class Phase(Observed):
    """A part of an object's motion: rising, level or sinking, by its path; turning, or still."""

    predicate = "phase"
    declaration = Declaration(
        about="object",
        span=Span.INTERVAL,
        border=frozenset({"goes_level"}),
        has_sentence=False,
        stretch="goes_{kind}",
    )
    object: str
    kind: str
    first: int
    last: int


@dataclass(frozen=True, slots=True, order=True)
class Guided(Observed):
    """An object moves on one hinge or one rail of a fixed one, throughout the recording.

    The kind is ``hinge`` or ``rail``; the base is the fixed object, by which it can be closed.
    """

    predicate = "guided"
    declaration = Declaration(about="object", span=Span.ALWAYS, border=False, has_sentence=True)
    object: str
    kind: str
    base: str


@dataclass(frozen=True, slots=True, order=True)
class Opening(Observed):
    """How far an object on a guide is from its closed place at a frame.

    In millimetres on a rail, in milliradians on a hinge.
    """

    predicate = "opening"
    declaration = Declaration(about="object", span=Span.INSTANT, border=False, has_sentence=False)
    object: str
    frame: int
    amount: int


@dataclass(frozen=True, slots=True, order=True)
class Reverses(Observed):
    """A moving object that rose begins to sink, or one that sank after that to rise again.

    Both are real ways and steep; the frame lies in the middle between the two. What is on a hinge
    or a rail turns back on that instead.
    """

    predicate = "reverses"
    declaration = Declaration(
        about="object", span=Span.INSTANT, border=True, has_sentence=False, stretch="reverses"
    )
    object: str
    frame: int


@dataclass(frozen=True, slots=True, order=True)
class Swings(Observed):
    """A body moves to and fro, again and again, from the first to the last frame."""

    predicate = "swings"
    declaration = Declaration(
        about="body", span=Span.INTERVAL, border=True, has_sentence=True, stretch="swings"
    )
    body: str
    first: int
    last: int


@dataclass(frozen=True, slots=True, order=True)
class Lengthwise(Observed):
    """A long, thin body moves to and fro along its own length, from the first to the last frame."""

    predicate = "lengthwise"
    declaration = Declaration(
        about="body", span=Span.INTERVAL, border=True, has_sentence=True, stretch="lengthwise"
    )
    body: str
    first: int
    last: int


@dataclass(frozen=True, slots=True, order=True)
class Solid(Observed):
    """An object's surface leaves no room inside its convex hull: nothing can be in it.

    It is measured of what moves to and fro and of what that touches.
    """

    predicate = "solid"
    declaration = Declaration(about="object", span=Span.ALWAYS, border=False, has_sentence=False)
    object: str


@dataclass(frozen=True, slots=True, order=True)
class Shapeless(Observed):
    """An object's shape is not known, so what is in it, or what it is in, is not known either.

    It is measured of what moves to and fro and of what that touches.
    """

    predicate = "shapeless"
    declaration = Declaration(about="object", span=Span.ALWAYS, border=False, has_sentence=False)
    object: str


@dataclass(frozen=True, slots=True, order=True)
class Leans(Observed):
    """An object's upright axis is far from the vertical, from the first to the last frame."""

    predicate = "leans"
    declaration = Declaration(
        about="object", span=Span.INTERVAL, border=True, has_sentence=True, stretch="leans"
    )
    object: str
    first: int
    last: int


@dataclass(frozen=True, slots=True, order=True)
class Flies(Observed):
    """An object falls freely, from the first to the last frame."""

    predicate = "flies"
    declaration = Declaration(
        about="object", span=Span.INTERVAL, border=True, has_sentence=True, stretch="flies"
    )
    object: str
    first: int
    last: int


@dataclass(frozen=True, slots=True, order=True)
class Rolls(Observed):
    """An object goes and turns about a level axis without slipping below its middle."""

    predicate = "rolls"
    declaration = Declaration(
        about="object", span=Span.INTERVAL, border=False, has_sentence=True, stretch="rolls"
    )
    object: str
    first: int
    last: int


@dataclass(frozen=True, slots=True, order=True)
class Bears(Observed):
    """A foot that is down bears the whole weight of the body, part of it, or none."""

    predicate = "bears"
    declaration = Declaration(
        about="foot",
        span=Span.INTERVAL,
        border=frozenset({"bears_whole", "bears_none"}),
        has_sentence=True,
        stretch="bears_{share}",
    )
    foot: str
    share: str
    first: int
    last: int


@dataclass(frozen=True, slots=True, order=True)
class Lies(Observed):
    """How a body lies to another.

    It is inside it, or dips into it with one end; it is above, below, beside or along it, or
    merely near. An end-effector that touches it ``shifts`` from one place on it to another.
    """

    predicate = "lies"
    declaration = Declaration(
        about="body",
        span=Span.INTERVAL,
        border=False,
        has_sentence=False,
        stretch="{how}",
        others=("other",),
    )
    body: str
    how: str
    other: str
    first: int
    last: int


@dataclass(frozen=True, slots=True, order=True)
class Between(Observed):
    """A body's middle is between two others, from the first to the last frame."""

    predicate = "between"
    declaration = Declaration(
        about="body",
        span=Span.INTERVAL,
        border=False,
        has_sentence=False,
        stretch="between",
        others=("one", "other"),
    )
    body: str
    one: str
    other: str
    first: int
    last: int


@dataclass(frozen=True, slots=True, order=True)
class Passage(Observed):
    """A stretch of being inside or above another ends at another side than it began.

    The first frame names the stretch; the sides are opposite or merely other ones.
    """

    predicate = "passage"
    declaration = Declaration(
        about="body",
        span=Lies,
        border=False,
        has_sentence=False,
        stretch="{how}_{sides}",
        others=("other",),
    )
    body: str
    how: str
    other: str
    first: int
    sides: str


@dataclass(frozen=True, slots=True, order=True)
class Travels(Observed):
    """An object covers more way than a floor of motion in a moment, throughout."""

    predicate = "travels"
    declaration = Declaration(about="object", span=Span.INTERVAL, border=False, has_sentence=False)
    object: str
    first: int
    last: int


@dataclass(frozen=True, slots=True, order=True)
class MovesWith(Observed):
    """A travelling object is steady in another body's frame, so far from touching it [mm]."""

    predicate = "moves_with"
    declaration = Declaration(about="object", span=Span.INTERVAL, border=False, has_sentence=False)
    object: str
    body: str
    first: int
    last: int
    gap: int
