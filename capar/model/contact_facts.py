"""Facts about contacts: from where bodies meet, press and are borne, and how fast they meet."""

from dataclasses import dataclass

from capar.model.fact_kinds import Declaration, Observed, Span
from capar.model.scene_facts import Touching


@dataclass(frozen=True, slots=True, order=True)
class ContactNormal(Observed):
    """How far the normal of a contact points up, from the other to the body [1/1000].

    Stated at the contact's first frame; 1000 where the body lies on the other.
    """

    predicate = "upward"
    declaration = Declaration(
        about="body",
        span=Touching,
        border=False,
        has_sentence=False,
        rdf=("ContactNormal", "body", "other", "firstFrame", "upward"),
        powers={"permille": -3},
    )
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
    declaration = Declaration(
        about="body",
        span=Touching,
        border=False,
        has_sentence=True,
        rdf=("PressDirection", "body", "other", "firstFrame", "pressX", "pressY"),
        powers={"x": -3, "y": -3},
    )
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
    declaration = Declaration(
        about="body",
        span=Touching,
        border=False,
        has_sentence=True,
        rdf=("SightNormal", "body", "other", "firstFrame", "sightward"),
        powers={"permille": -3},
    )
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
    declaration = Declaration(
        about="body",
        span=Touching,
        border=False,
        has_sentence=True,
        rdf=("Riding", "body", "other", "firstFrame"),
    )
    body: str
    other: str
    first: int


@dataclass(frozen=True, slots=True, order=True)
class ClosingSpeed(Observed):
    """How fast two bodies approached each other when they began to touch [mm/s]."""

    predicate = "closing"
    declaration = Declaration(
        about="body",
        span=Touching,
        border=False,
        has_sentence=True,
        rdf=("ClosingSpeed", "body", "other", "firstFrame", "contactSpeed"),
        powers={"speed": -3},
    )
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
    declaration = Declaration(
        about="body",
        span=Touching,
        border=False,
        has_sentence=True,
        rdf=("ReleaseSpeed", "body", "other", "firstFrame", "contactSpeed"),
        powers={"speed": -3},
    )
    body: str
    other: str
    first: int
    speed: int


@dataclass(frozen=True, slots=True, order=True)
class Seated(Observed):
    """A body is down on another one that bears it: in a contact, less its coming and going."""

    predicate = "seated"
    declaration = Declaration(
        about="body",
        span=Span.INTERVAL,
        border=True,
        has_sentence=False,
        rdf=("Seat", "body", "other", "firstFrame", "lastFrame"),
    )
    body: str
    other: str
    first: int
    last: int
