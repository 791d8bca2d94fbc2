"""Ground facts: what extractors measured, as typed values that are atoms of the rules."""

from dataclasses import astuple, dataclass, fields
from functools import cache
from typing import Any, ClassVar, Self, cast, get_type_hints

import clingo

from capar.model.capture import NAME
from capar.model.errors import FactError

LARGEST = 2**31 - 1
"""The largest integer of the solver, which wraps silently beyond."""


@dataclass(frozen=True, slots=True, order=True)
class Fact:
    """A relation with arguments; the predicate is a class's, the arguments are an instance's.

    Frames are numbered from zero; intervals are closed, [first, last].
    """

    predicate: ClassVar[str]

    def symbol(self) -> clingo.Symbol:
        """The fact as the solver's own value.

        Raises:
            FactError: An integer that the solver cannot hold.
        """
        return clingo.Function(self.predicate, [_symbol(each) for each in astuple(self)])

    @classmethod
    def from_symbol(cls, symbol: clingo.Symbol) -> Self:
        """The fact that a solver's value states.

        Raises:
            FactError: Another predicate, another number of arguments, or another type.
        """
        kinds: tuple[type, ...] = _kinds(cast(Any, cls))
        if symbol.name != cls.predicate or len(symbol.arguments) != len(kinds):
            raise FactError(f"{symbol} is no {cls.predicate}/{len(kinds)}")
        return cls(
            *(_value(each, kind) for each, kind in zip(symbol.arguments, kinds, strict=True))
        )

    def __str__(self) -> str:
        """The fact as a line of a logic program, without its full stop."""
        return str(self.symbol())


def _symbol(value: Any) -> clingo.Symbol:
    if isinstance(value, int):
        if abs(value) > LARGEST:
            raise FactError(f"{value} does not fit the solver's 32 bits")
        return clingo.Number(value)
    return clingo.Function(value) if NAME.fullmatch(value) else clingo.String(value)


def _value(symbol: clingo.Symbol, kind: type) -> Any:
    if symbol.type is clingo.SymbolType.Number and kind is int:
        return symbol.number
    if symbol.type is clingo.SymbolType.String and kind is str:
        return symbol.string
    if symbol.type is clingo.SymbolType.Function and kind is str and not symbol.arguments:
        return symbol.name
    raise FactError(f"{symbol} is no {kind.__name__}")


@cache
def _kinds(cls: Any) -> tuple[type, ...]:
    hints = get_type_hints(cls)
    return tuple(hints[each.name] for each in fields(cls))


def program(facts: "tuple[Fact, ...]") -> str:
    """The facts as a logic program, one a line, in their order."""
    return "".join(f"{fact}.\n" for fact in facts)


@dataclass(frozen=True, slots=True, order=True)
class Frames(Fact):
    """The capture's first and last frame."""

    predicate = "frames"
    first: int
    last: int


@dataclass(frozen=True, slots=True, order=True)
class RateMhz(Fact):
    """Frames in a thousand seconds."""

    predicate = "rate_mhz"
    rate: int


@dataclass(frozen=True, slots=True, order=True)
class Link(Fact):
    """An end-effector that acts, its general type and its side."""

    predicate = "link"
    ee: str
    kind: str
    side: str


@dataclass(frozen=True, slots=True, order=True)
class Tag(Fact):
    """An object or body part watched for contact: self, fixed or mobile."""

    predicate = "tag"
    object: str
    type: str


@dataclass(frozen=True, slots=True, order=True)
class ZeroCrossing(Fact):
    """The end-effector's acceleration crosses zero at this frame (thesis 3.2.1)."""

    predicate = "zero_crossing"
    ee: str
    frame: int


@dataclass(frozen=True, slots=True, order=True)
class Pause(Fact):
    """A zero crossing at which the end-effector is slow: it starts, stops or turns."""

    predicate = "pause"
    ee: str
    frame: int


@dataclass(frozen=True, slots=True, order=True)
class Touching(Fact):
    """Two bodies touch from the first to the last frame; an end-effector stands first."""

    predicate = "touching"
    body: str
    other: str
    first: int
    last: int


@dataclass(frozen=True, slots=True, order=True)
class Gap(Fact):
    """How far two bodies are apart when they begin to touch [micrometres]; negative: overlap."""

    predicate = "gap"
    body: str
    other: str
    first: int
    micrometres: int


@dataclass(frozen=True, slots=True, order=True)
class Moving(Fact):
    """An object is away from each place where it rests, from the first to the last frame."""

    predicate = "moving"
    object: str
    first: int
    last: int


@dataclass(frozen=True, slots=True, order=True)
class LookingAt(Fact):
    """The line of sight of a sensor that attends meets the object first."""

    predicate = "looking_at"
    sensor: str
    object: str
    first: int
    last: int


@dataclass(frozen=True, slots=True, order=True)
class ForceTransfer(Fact):
    """The user says that force passes to objects in this trial (thesis 4.4.1)."""

    predicate = "force_transfer"


@dataclass(frozen=True, slots=True, order=True)
class Intended(Fact):
    """The user's purpose for steps of an action with an object and a goal; "any" fits all."""

    predicate = "intended"
    rank: int
    action: str
    object: str
    goal: str
    purpose: str


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
class Lies(Fact):
    """How a body lies to another: inside, above, below, beside or along it, or merely near."""

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


MEASURED: tuple[type[Fact], ...] = (
    Frames,
    RateMhz,
    Link,
    Tag,
    ZeroCrossing,
    Pause,
    Touching,
    Gap,
    Moving,
    LookingAt,
    ForceTransfer,
    Intended,
    Displaced,
    Resting,
    Place,
    Travelled,
    Posture,
    Apart,
    Wound,
    Upward,
    Closing,
    Reverses,
    Swings,
    Leans,
    Flies,
    Lies,
    Between,
    Passage,
)
"""Every kind of fact that extractors state, in the order in which they are written."""


def read_fact(text: str) -> Fact:
    """The measured fact that an atom states, such as ``touching(right_hand,mug,118,335)``.

    Raises:
        FactError: No atom, or of no predicate that extractors state.
    """
    try:
        symbol = clingo.parse_term(text, logger=lambda code, message: None)
    except (RuntimeError, TypeError, AttributeError):
        raise FactError(f"expected an atom such as tag(mug,mobile), found {text!r}") from None
    if symbol.type is clingo.SymbolType.Function and symbol.positive:
        for kind in MEASURED:
            if kind.predicate == symbol.name:
                return kind.from_symbol(symbol)
    known = ", ".join(each.predicate for each in MEASURED)
    raise FactError(f"{text!r} is no measured fact; their predicates are {known}")
