"""Facts about when bodies move, where they are, how far they have gone, and how far apart."""

from dataclasses import dataclass

from capar.model.fact_kinds import Declaration, Observed, Span


@dataclass(frozen=True, slots=True, order=True)
class Displaced(Observed):
    """An object moves, from when it truly set off until it truly stopped.

    That is where it was last within 1 mm and half a degree of a place of rest, or what noise makes,
    and the little before that by which a motion from rest grows so far.
    """

    predicate = "displaced"
    declaration = Declaration(
        about="object",
        span=Span.INTERVAL,
        border=True,
        has_sentence=False,
        rdf=("Displacement", "body", "firstFrame", "lastFrame"),
    )
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
        rdf=("Resting", "body", "firstFrame", "lastFrame"),
    )
    ee: str
    first: int
    last: int


@dataclass(frozen=True, slots=True, order=True)
class Place(Observed):
    """Where the middle of a body is at a frame [millimetres]."""

    predicate = "place"
    declaration = Declaration(
        about="body",
        span=Span.INSTANT,
        border=False,
        has_sentence=True,
        rdf=("Places", "body", "samples"),
    )
    body: str
    frame: int
    x: int
    y: int
    z: int


@dataclass(frozen=True, slots=True, order=True)
class TrunkPlace(Observed):
    """Where the middle of an end-effector is at a frame, from its agent's trunk [millimetres].

    The axes turn with the trunk about the vertical, and do not lean.
    """

    predicate = "from_trunk"
    declaration = Declaration(
        about="body",
        span=Span.INSTANT,
        border=False,
        has_sentence=False,
        rdf=("TrunkPlaces", "body", "samples"),
    )
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
    declaration = Declaration(
        about="body",
        span=Span.INSTANT,
        border=False,
        has_sentence=False,
        rdf=("Ways", "body", "samples"),
    )
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
    declaration = Declaration(
        about="body",
        span=Span.INSTANT,
        border=False,
        has_sentence=False,
        rdf=("Postures", "body", "samples"),
    )
    body: str
    frame: int
    lean: int
    spin: int


@dataclass(frozen=True, slots=True, order=True)
class Distance(Observed):
    """How far the middles of two bodies are apart at a frame [millimetres]."""

    predicate = "apart"
    declaration = Declaration(
        about="body",
        span=Span.INSTANT,
        border=False,
        has_sentence=False,
        rdf=("Distances", "body", "other", "samples"),
    )
    body: str
    other: str
    frame: int
    millimetres: int


@dataclass(frozen=True, slots=True, order=True)
class SweptAzimuth(Observed):
    """The angle by which a body has gone about another, seen from above [milliradians]."""

    predicate = "wound"
    declaration = Declaration(
        about="body",
        span=Span.INSTANT,
        border=False,
        has_sentence=False,
        rdf=("SweptAzimuths", "body", "other", "samples"),
    )
    body: str
    other: str
    frame: int
    milliradians: int
