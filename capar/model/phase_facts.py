"""Facts about the course of a motion: phases, guides, turning points, swings, falls."""

from dataclasses import dataclass

from capar.model.fact_kinds import Declaration, Observed, Span


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
        rdf=("Phase", "body", "phaseKind", "firstFrame", "lastFrame"),
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
    declaration = Declaration(
        about="object",
        span=Span.ALWAYS,
        border=False,
        has_sentence=True,
        rdf=("GuidedObject", "body", "guideKind", "other"),
    )
    object: str
    kind: str
    base: str


@dataclass(frozen=True, slots=True, order=True)
class Opening(Observed):
    """How far an object on a guide is from its closed place at a frame.

    In millimetres on a rail, in milliradians on a hinge.
    """

    predicate = "opening"
    declaration = Declaration(
        about="object",
        span=Span.INSTANT,
        border=False,
        has_sentence=False,
        rdf=("Openings", "body", "samples"),
    )
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
        about="object",
        span=Span.INSTANT,
        border=True,
        has_sentence=False,
        stretch="reverses",
        rdf=("Reversal", "body", "frame"),
    )
    object: str
    frame: int


@dataclass(frozen=True, slots=True, order=True)
class DrawsBack(Observed):
    """A moving object turns back on a level path, after a real way and before another one."""

    predicate = "draws_back"
    declaration = Declaration(
        about="object",
        span=Span.INSTANT,
        border=True,
        has_sentence=False,
        stretch="draws_back",
        rdf=("DrawingBack", "body", "frame"),
    )
    object: str
    frame: int


@dataclass(frozen=True, slots=True, order=True)
class Swings(Observed):
    """A body moves to and fro, again and again, from the first to the last frame."""

    predicate = "swings"
    declaration = Declaration(
        about="body",
        span=Span.INTERVAL,
        border=True,
        has_sentence=True,
        stretch="swings",
        rdf=("Swinging", "body", "firstFrame", "lastFrame"),
    )
    body: str
    first: int
    last: int


@dataclass(frozen=True, slots=True, order=True)
class Lengthwise(Observed):
    """A long, thin body moves to and fro along its own length, from the first to the last frame."""

    predicate = "lengthwise"
    declaration = Declaration(
        about="body",
        span=Span.INTERVAL,
        border=True,
        has_sentence=True,
        stretch="lengthwise",
        rdf=("LengthwiseSwinging", "body", "firstFrame", "lastFrame"),
    )
    body: str
    first: int
    last: int


@dataclass(frozen=True, slots=True, order=True)
class Leans(Observed):
    """An object's upright axis is far from the vertical, from the first to the last frame."""

    predicate = "leans"
    declaration = Declaration(
        about="object",
        span=Span.INTERVAL,
        border=True,
        has_sentence=True,
        stretch="leans",
        rdf=("Leaning", "body", "firstFrame", "lastFrame"),
    )
    object: str
    first: int
    last: int


@dataclass(frozen=True, slots=True, order=True)
class Flies(Observed):
    """An object falls freely, from the first to the last frame."""

    predicate = "flies"
    declaration = Declaration(
        about="object",
        span=Span.INTERVAL,
        border=True,
        has_sentence=True,
        stretch="flies",
        rdf=("Flying", "body", "firstFrame", "lastFrame"),
    )
    object: str
    first: int
    last: int


@dataclass(frozen=True, slots=True, order=True)
class Rolls(Observed):
    """An object goes and turns about a level axis without slipping below its middle."""

    predicate = "rolls"
    declaration = Declaration(
        about="object",
        span=Span.INTERVAL,
        border=False,
        has_sentence=True,
        stretch="rolls",
        rdf=("Rolling", "body", "firstFrame", "lastFrame"),
    )
    object: str
    first: int
    last: int


@dataclass(frozen=True, slots=True, order=True)
class Travels(Observed):
    """An object covers more way than a floor of motion in a moment, throughout."""

    predicate = "travels"
    declaration = Declaration(
        about="object",
        span=Span.INTERVAL,
        border=False,
        has_sentence=False,
        rdf=("Travelling", "body", "firstFrame", "lastFrame"),
    )
    object: str
    first: int
    last: int
