"""Facts about the scene: who acts, what there is, and what touches, moves and looks."""

from dataclasses import dataclass

from capar.model.fact_kinds import Declaration, Observed, Span


@dataclass(frozen=True, slots=True, order=True)
class Frames(Observed):
    """The capture's first and last frame."""

    predicate = "frames"
    declaration = Declaration(
        about=None,
        span=Span.ALWAYS,
        border=False,
        has_sentence=False,
        rdf=("FramesFact", "firstFrame", "lastFrame"),
    )
    first: int
    last: int


@dataclass(frozen=True, slots=True, order=True)
class RateMhz(Observed):
    """Frames in a thousand seconds."""

    predicate = "rate_mhz"
    declaration = Declaration(
        about=None, span=Span.ALWAYS, border=False, has_sentence=False, rdf=("RateFact", "rateMhz")
    )
    rate: int


@dataclass(frozen=True, slots=True, order=True)
class Link(Observed):
    """An end-effector that acts, its general type and its side."""

    predicate = "link"
    declaration = Declaration(
        about="ee",
        span=Span.ALWAYS,
        border=False,
        has_sentence=False,
        rdf=("LinkFact", "body", "effectorType", "side"),
    )
    ee: str
    kind: str
    side: str


@dataclass(frozen=True, slots=True, order=True)
class Tag(Observed):
    """An object or body part watched for contact: self, fixed or mobile."""

    predicate = "tag"
    declaration = Declaration(
        about="object",
        span=Span.ALWAYS,
        border=False,
        has_sentence=True,
        rdf=("TagFact", "body", "tagName"),
    )
    object: str
    type: str


@dataclass(frozen=True, slots=True, order=True)
class OfAgent(Observed):
    """Whose an end-effector or a body part is; stated where several agents perform."""

    predicate = "of_agent"
    declaration = Declaration(
        about="body",
        span=Span.ALWAYS,
        border=False,
        has_sentence=True,
        rdf=("Belonging", "body", "agent"),
    )
    body: str
    agent: str


@dataclass(frozen=True, slots=True, order=True)
class ZeroCrossing(Observed):
    """The end-effector's acceleration crosses zero at this frame (thesis 3.2.1)."""

    predicate = "zero_crossing"
    declaration = Declaration(
        about="ee",
        span=Span.INSTANT,
        border=False,
        has_sentence=False,
        rdf=("ZeroCrossings", "body", "samples"),
    )
    ee: str
    frame: int


@dataclass(frozen=True, slots=True, order=True)
class Pause(Observed):
    """A zero crossing at which the end-effector is slow: it starts, stops or turns."""

    predicate = "pause"
    declaration = Declaration(
        about="ee",
        span=Span.INSTANT,
        border=True,
        has_sentence=False,
        rdf=("Pause", "body", "frame"),
    )
    ee: str
    frame: int


@dataclass(frozen=True, slots=True, order=True)
class Touching(Observed):
    """Two bodies touch from the first to the last frame; an end-effector stands first."""

    predicate = "touching"
    declaration = Declaration(
        about="body",
        span=Span.INTERVAL,
        border=True,
        has_sentence=True,
        others=("other",),
        negated="apart",
        rdf=("Touching", "body", "other", "firstFrame", "lastFrame"),
    )
    body: str
    other: str
    first: int
    last: int


@dataclass(frozen=True, slots=True, order=True)
class Gap(Observed):
    """How far two bodies are apart when they begin to touch [micrometres]; zero where they cut."""

    predicate = "gap"
    declaration = Declaration(
        about="body",
        span=Touching,
        border=False,
        has_sentence=False,
        rdf=("Gap", "body", "other", "firstFrame", "gap"),
        powers={"micrometres": -6},
    )
    body: str
    other: str
    first: int
    micrometres: int


@dataclass(frozen=True, slots=True, order=True)
class Moving(Observed):
    """An object is away from each place where it rests, from the first to the last frame."""

    predicate = "moving"
    declaration = Declaration(
        about="object",
        span=Span.INTERVAL,
        border=True,
        has_sentence=True,
        negated="still",
        rdf=("Moving", "body", "firstFrame", "lastFrame"),
    )
    object: str
    first: int
    last: int


@dataclass(frozen=True, slots=True, order=True)
class LookingAt(Observed):
    """The line of sight of a sensor that attends, or of a head that acts, meets it first."""

    predicate = "looking_at"
    declaration = Declaration(
        about="sensor",
        span=Span.INTERVAL,
        border=True,
        has_sentence=True,
        stretch="looks",
        others=("object",),
        rdf=("LookingAt", "body", "seen", "firstFrame", "lastFrame"),
    )
    sensor: str
    object: str
    first: int
    last: int


@dataclass(frozen=True, slots=True, order=True)
class ForceTransfer(Observed):
    """The user says that force passes to objects in this trial (thesis 4.4.1)."""

    predicate = "force_transfer"
    declaration = Declaration(
        about=None, span=Span.ALWAYS, border=False, has_sentence=True, rdf=("ForceTransfer",)
    )


@dataclass(frozen=True, slots=True, order=True)
class Intended(Observed):
    """The user's purpose for steps of an action with an object and a goal; "any" fits all."""

    predicate = "intended"
    declaration = Declaration(
        about=None,
        span=Span.ALWAYS,
        border=False,
        has_sentence=False,
        rdf=("Intended", "rank", "actionName", "objectName", "goalName", "purpose"),
    )
    rank: int
    action: str
    object: str
    goal: str
    purpose: str


@dataclass(frozen=True, slots=True, order=True)
class Solid(Observed):
    """Neither an object's surface nor its kind leaves a hollow in it: nothing can be in it.

    It is measured of what moves to and fro, of what that touches, and of what is tipped.
    """

    predicate = "solid"
    declaration = Declaration(
        about="object",
        span=Span.ALWAYS,
        border=False,
        has_sentence=False,
        rdf=("SolidObject", "body"),
    )
    object: str


@dataclass(frozen=True, slots=True, order=True)
class Shapeless(Observed):
    """An object's shape is not known, so what is in it, or what it is in, is not known either.

    It is measured of what moves to and fro, of what that touches, and of what is tipped.
    """

    predicate = "shapeless"
    declaration = Declaration(
        about="object",
        span=Span.ALWAYS,
        border=False,
        has_sentence=False,
        rdf=("ShapelessObject", "body"),
    )
    object: str
