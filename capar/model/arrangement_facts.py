"""Facts about how bodies lie to each other, and which of them keep together."""

from dataclasses import dataclass

from capar.model.fact_kinds import Declaration, Observed, Span


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
        rdf=("WeightBearing", "body", "weightShare", "firstFrame", "lastFrame"),
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
        rdf=("Arrangement", "body", "arrangement", "other", "firstFrame", "lastFrame"),
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
        rdf=("PlaceBetween", "body", "one", "other", "firstFrame", "lastFrame"),
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
        rdf=("Passage", "body", "arrangement", "other", "firstFrame", "sides"),
    )
    body: str
    how: str
    other: str
    first: int
    sides: str


@dataclass(frozen=True, slots=True, order=True)
class MovesWith(Observed):
    """A travelling object is steady in another body's frame, so far from touching it [mm].

    Of a hand or thing that is far away, at least so far.
    """

    predicate = "moves_with"
    declaration = Declaration(
        about="object",
        span=Span.INTERVAL,
        border=False,
        has_sentence=False,
        rdf=("CoMotion", "body", "other", "firstFrame", "lastFrame", "gap"),
        powers={"gap": -3},
    )
    object: str
    body: str
    first: int
    last: int
    gap: int
